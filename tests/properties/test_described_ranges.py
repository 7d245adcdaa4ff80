"""Any number in the range that an FMU describes is taken, or refused by name, within a bounded time."""

import math
import shutil
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import fmpy
import numpy as np
import pytest
from comparison import approx

from benchmarks.fmu import native_scenes
from benchmarks.fmu.native_contact import NativeContact
from contact_core import (
    ContactError,
    ContactState,
    ConvergenceError,
    OperatingPointError,
    Scene,
    advance,
    initial_state,
)
from contact_core.regression import evolution, fatigue
from contact_core.scene import with_values
from contact_core.state import parts
from fmu_src.flavours import Flavour
from fmu_src.package.describe import variables_of
from fmu_src.package.usable import usable
from fmu_src.variables import SPECIAL, Variable, first_point, variables
from tests.unit.cheap_scene import cheap

NEAR = 1e-4  # relative: beyond an end by so much
INPUTS = {"heat.bulk.model": "inputs", "operation.body_temperature_1": "350 K"}
RADII = ("radius_x", "radius_y")
MENISCUS = {"lubricant.supply.model": "meniscus", "lubricant.supply.distance": "0.2 mm"}
LIMIT = 240.0  # s: of one step of 20 000 parts of 2 ms, on a busy machine
FEW = 50  # parts
LUMPED = {
    "heat.bulk.model": "lumped",
    **{f"heat.bulk.heat_capacity_{i}": "50 J/K" for i in (1, 2)},
    **{f"heat.bulk.conductance_{i}": "1 W/K" for i in (1, 2)},
}


@pytest.fixture
def mtm() -> Scene:
    return Scene.from_toml("mtm_zddp").at_level("regression")


@contextmanager
def limited() -> Iterator[None]:
    def late(*_: object) -> None:
        raise TimeoutError("It takes too long.")

    before = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, LIMIT)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def parameters(scene: Scene) -> list[Variable]:
    return [v for v in variables(scene) if v.causality == "parameter" and v.name not in SPECIAL]


def between(v: Variable, count: int) -> list[float | int]:
    """Both ends of a described range and `count` numbers between, as their logarithms are spaced evenly."""
    inner = np.geomspace(max(v.minimum, 1e-12 * v.maximum), v.maximum, count + 2)[1:-1].tolist()
    kind = int if v.kind == "Integer" else float
    return [kind(value) for value in (v.minimum, *inner, v.maximum)]


def wrong(scene: Scene, v: Variable, value: float, *steps: float) -> str:
    """What a number does that it may not do."""
    try:
        given = with_values(scene, {v.name: value})
        state = initial_state(given)
        for dt in steps:
            with limited():
                state, outputs = advance(given, given.operation.point, state, dt)
    except ConvergenceError:
        return ""  # the contact has no solution, or its step too many parts
    except ContactError as error:
        allowed = v.name in str(error) or "warmed to" in str(error)
        return "" if allowed else f"{v.name} = {value:g}: {error}"
    except (ArithmeticError, ValueError, TimeoutError) as error:
        return f"{v.name} = {value:g}: {error!r}"
    broken = [name for name, found in vars(outputs).items() if isinstance(found, float) and not math.isfinite(found)]
    return f"{v.name} = {value:g}: no finite {broken}" if broken else ""


def test_what_is_described_is_taken_or_refused_by_name(mtm: Scene) -> None:
    tried = [(v, value) for v in parameters(mtm) for value in between(v, 0)]
    assert len(tried) > 100
    assert [said for v, value in tried if (said := wrong(mtm, v, value, 0.1))] == []


@pytest.mark.long
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_what_is_described_is_taken_with_every_law(seed: int) -> None:
    found = []
    for _, changes in native_scenes.selection(seed):
        scene = native_scenes.scene_of(changes)
        tried = [(v, value) for v in parameters(scene) for value in between(v, 5)]
        found += [said for v, value in tried if (said := wrong(scene, v, value, 0.0, 0.1, 1.0))]
    assert found == []


@pytest.mark.parametrize("heat", [{}, LUMPED], ids=["", "bodies that store heat"])
def test_a_step_of_too_many_parts_is_refused_and_the_state_goes_on(heat: dict, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = Scene.from_toml("mtm_zddp", heat | {"control.change": "0.01 nm"}).at_level("regression")
    monkeypatch.setattr(parts, "MOST_PARTS", FEW)
    state = initial_state(scene)
    with pytest.raises(ConvergenceError, match=r"more than 50 parts.*control\.change = 1e-11.*control\.input_change"):
        advance(scene, scene.operation.point, state, 10.0)
    after, _ = advance(scene, scene.operation.point, state, 1e-3)
    assert after.time == 1e-3


def test_a_step_in_which_heat_has_long_settled_takes_few_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = Scene.from_toml("mtm_zddp", LUMPED).at_level("regression")
    monkeypatch.setattr(parts, "MOST_PARTS", 3000)  # 1900 are taken
    after, _ = advance(scene, scene.operation.point, initial_state(scene), 1e6)
    assert after.time == approx(1e6)


@pytest.mark.parametrize("damage", [0.0, 0.5])
def test_next_to_no_damage_a_cycle_never_breaks_anything(damage: float) -> None:
    assert fatigue._first(np.array([damage, 0.0]), np.array([5e-324, 0.0])) == math.inf


def test_changes_that_are_no_numbers_are_refused(mtm: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(evolution, "_distance", lambda *_: math.nan)
    with pytest.raises(ConvergenceError, match=r"what is no number.*sliding speed"):
        advance(mtm, mtm.operation.point, initial_state(mtm), 1.0)


def test_blocks_without_end_are_refused_before_they_are_solved(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parts, "MOST_PARTS", 2)  # where they are counted one by one
    scene, state, op = cheap(control__longest="1e-20 s")
    with pytest.raises(OperatingPointError, match=r"control\.longest = 1e-20 s.*Raise it"):
        advance(scene, op, state, 0.1)


@pytest.mark.long
def test_blocks_of_too_many_parts_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    scene, state, op = cheap(control__longest="10 s", control__driver="dry")
    monkeypatch.setattr(parts, "MOST_PARTS", 2)
    with pytest.raises(ConvergenceError, match="more than 2 parts"):
        advance(scene, op, state, 60.0)


def narrowed(scene: Scene, flavour: Flavour = "isolated") -> list[tuple[Variable, Variable]]:
    """Each input as contacts have it, and as the FMU of the scene describes it."""
    pairs = zip(variables(scene), variables_of(scene, flavour), strict=True)
    return [(wide, own) for wide, own in pairs if wide.causality == "input"]


def answer(scene: Scene, state: ContactState, name: str, value: float) -> str:
    """The error of a step with an input, if there is one."""
    try:
        advance(scene, replace(first_point(scene), **{name: value}), state, scene.operation.interval)
    except ContactError as error:
        return str(error)
    return ""


@pytest.mark.parametrize(
    ("name", "level", "changes", "limited"),
    [
        pytest.param("mtm_zddp", "regression", {}, {"load", "temperature", *RADII}, marks=pytest.mark.long),
        pytest.param("mtm_zddp", "map", {}, {"load", "temperature", *RADII}, marks=pytest.mark.long),
        ("mtm_zddp", "regression", INPUTS, {"load", "body_temperature_1", "body_temperature_2", *RADII}),
        ("pin_on_disc", "regression", MENISCUS, {"load", "temperature", *RADII}),
        ("fzg_flank", "regression", {}, {"temperature", "radius_x"}),
        pytest.param("dimple_rolling", "regression", {}, {"load", *RADII}, marks=pytest.mark.long),
    ],
)
def test_inputs_are_described_as_far_as_the_scene_can_use_them(
    name: str, level: str, changes: dict[str, str], limited: set[str]
) -> None:
    scene = Scene.from_toml(name, changes).at_level(level)
    found, state = narrowed(scene), initial_state(scene)
    assert {own.name for wide, own in found if wide != own} == limited
    for wide, own in found:
        assert wide.minimum <= own.minimum <= own.start <= own.maximum <= wide.maximum
        for end, widest, out in ((own.minimum, wide.minimum, -NEAR), (own.maximum, wide.maximum, NEAR)):
            assert answer(scene, state, own.name, end) == ""
            assert end == widest or answer(scene, state, own.name, end * (1.0 + out)) != ""


def test_the_grid_of_the_deterministic_level_limits_load_and_radii() -> None:
    scene = Scene.from_toml("azam_case_a").at_level("deterministic")
    found = {own.name: own for _, own in narrowed(scene)}
    assert scene.hertz(found["load"].maximum).a == approx(scene.room[0], rel=NEAR)
    assert (found["temperature"].minimum, found["temperature"].maximum) == (358.15, 368.15)
    wider = replace(first_point(scene), radius_x=(1.0 + NEAR) * found["radius_x"].maximum)
    assert "film.domain" in scene.refusal(wider)


@pytest.mark.long
def test_the_level_auto_uses_what_the_regression_level_uses(mtm: Scene) -> None:
    assert narrowed(mtm.at_level("auto")) == narrowed(mtm)  # a block that has no solution tells it nothing


def test_a_scene_that_cannot_use_its_start_values_is_described_as_all_contacts(mtm: Scene) -> None:
    cold = replace(mtm, operation=replace(mtm.operation, temperature=300.0))
    assert usable(cold, variables(cold)) == variables(cold)


@pytest.mark.long
def test_solved_contacts_take_the_ends_of_described_inputs() -> None:
    scene, state, _ = cheap()
    for _, own in narrowed(scene):
        for end in (own.minimum, own.maximum):
            assert answer(scene, state, own.name, end) == ""


@pytest.mark.long
@pytest.mark.fmu
@pytest.mark.parametrize("flavour", ["embedded", "isolated", "native"])
def test_steps_with_the_ends_of_described_inputs_are_valid(flavour, mtm, built, monkeypatch) -> None:
    monkeypatch.setenv("TRIBOFMU_PYTHON", shutil.which("python") or "")
    file = str(built.fmu(mtm, flavour))
    for v in fmpy.read_model_description(file).modelVariables:
        for end in (v.min, v.max) if v.causality == "input" else ():
            found = fmpy.simulate_fmu(
                file, stop_time=0.2, output_interval=0.1, start_values={v.name: float(end)}, output=["valid"]
            )
            assert found["valid"].all(), (v.name, end)


@pytest.mark.long
@pytest.mark.fmu
@pytest.mark.parametrize("flavour", ["embedded", "isolated"])
def test_fmus_take_the_ends_of_what_they_describe(flavour, mtm, built, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TRIBOFMU_PYTHON", shutil.which("python") or "")
    file = built.fmu(mtm, flavour)
    fmpy.simulate_fmu(str(file), stop_time=0.1, output_interval=0.1)  # kernels compile once
    for v in parameters(mtm):
        for value in between(v, 0):
            with limited():
                found = fmpy.simulate_fmu(str(file), stop_time=0.1, output_interval=0.1, start_values={v.name: value})
            assert np.isfinite(found["friction_force"]).all()


@pytest.mark.long
@pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")
@pytest.mark.parametrize("heat", [{}, LUMPED], ids=["", "bodies that store heat"])
def test_native_steps_of_too_many_parts_are_refused(heat: dict[str, str], tmp_path) -> None:
    scene = native_scenes.scene_of(heat | {"control.change": "0.01 nm"})
    contact, inputs = NativeContact(scene, tmp_path), native_scenes.inputs_of(scene)
    with limited():
        assert not contact.initialise(inputs)
        assert "more than 20000 parts" in contact.step(inputs, 1e9)
        assert "control.change" in contact.step(inputs, 1e9)
        assert not contact.step(inputs, 1e-3)
