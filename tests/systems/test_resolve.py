"""States solved again: on the surfaces that they have, and judged by all that is known of them."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest
import xarray as xr
from comparison import approx

from contact_core import ContactState, OperatingPoint, Outputs, RangeFlag, advance, initial_state
from contact_core.scene import Scene, tunables, with_values
from system_models.machines import reading, resolve
from system_models.machines.assembly import Assembly
from system_models.machines.resolve import COMPARED, DEEP, FAST, Resolved, solved_again

SMALL = {
    "contact.film.points": "17",
    "contact.surface_1.correlation_length": "32 um",
    "contact.surface_2.correlation_length": "32 um",
}
MEAN, RATIO, LOAD, CELSIUS = 0.1, 0.05, 53.7, 273.15
CHANGES = {"speed_1": -0.2, "speed_2": 0.15, "load": 0.3, "temperature": 0.012}  # of each input over a run, relative
KEPT = ("tribofilm_1", "tribofilm_2", "wear_depth_1", "wear_volume_2", "load_cycles_1")  # with the surfaces
STEPS = (600.0, 300.0, 900.0, 600.0, 700.0, 500.0)  # [s]


class Run(NamedTuple):
    """A contact's recorded run, and what it ended with."""

    dataset: xr.Dataset
    scene: Scene
    point: OperatingPoint
    state: ContactState


def marched(assembly: Assembly, share: float = 0.0) -> Run:
    """The contact of the rig alone, under inputs that change: told of each step those of its begin, by this share."""
    contact = assembly.contacts["contact"]
    scene: Any = contact.scene
    scene = with_values(scene, {k: v for k, v in contact.parameters.items() if k in tunables(scene)}).at_level(FAST)
    times = np.concatenate([[0.0], np.cumsum(STEPS)])
    start = {"speed_1": MEAN * (1 + RATIO / 2), "speed_2": MEAN * (1 - RATIO / 2), "load": LOAD}
    start["temperature"] = 80.0 + CELSIUS
    inputs = {key: value * (1.0 + CHANGES[key] * times / times[-1]) for key, value in start.items()}
    state, rows = initial_state(scene), []
    for row, step in enumerate(STEPS, 1):
        told = {key: share * values[row - 1] + (1.0 - share) * values[row] for key, values in inputs.items()}
        point = replace(scene.operation.point, **{key: float(value) for key, value in told.items()})
        state, out = advance(scene, point, state, step)
        rows.append({name: getattr(out, name) for name in (*COMPARED, *KEPT)})
    columns = {name: np.array([row[name] for row in (rows[0], *rows)]) for name in rows[0]} | inputs
    columns["valid"], columns["fidelity_used"] = np.ones(len(times), dtype=bool), np.ones(len(times), dtype=int)
    named = {f"contact.{name}": ("time", values) for name, values in columns.items()}
    return Run(xr.Dataset(named, {"time": times}), scene, point, state)


@pytest.fixture(scope="module")
def assembly() -> Assembly:
    return reading.assemble(reading.read("mtm_rig", SMALL))


@pytest.fixture(scope="module")
def run(assembly: Assembly) -> Run:
    return marched(assembly)


@pytest.fixture
def shallow(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is solved again is so by the regression level, in no time."""
    monkeypatch.setattr(resolve, "DEEP", FAST)


def test_a_state_is_solved_on_the_surfaces_that_its_run_has_left(assembly: Assembly, run: Run) -> None:
    last = len(STEPS)
    found = solved_again(assembly, run.dataset, "contact", last)
    assert found.deep is not None
    for name in KEPT:
        recorded = float(run.dataset[f"contact.{name}"].values[last])
        assert recorded > 0.0
        assert getattr(found.deep, name) == approx(recorded, rel=1e-6)
    deep = run.scene.at_level(DEEP)
    _, same = advance(deep, run.point, run.state, 0.0)
    _, fresh = advance(deep, run.point, initial_state(deep), 0.0)
    for name in COMPARED:
        assert getattr(found.deep, name) == getattr(same, name)
        assert abs(getattr(fresh, name) / getattr(same, name) - 1.0) > 0.02


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_a_contact_is_led_again_to_what_its_run_has_recorded_whichever_inputs_it_was_told(
    share: float, assembly: Assembly, shallow: None
) -> None:
    run = marched(assembly, share)
    for row in (1, len(STEPS)):
        found = solved_again(assembly, run.dataset, "contact", row)
        assert found.replayed < 1e-12
        assert found.fast.h_c == approx(float(run.dataset["contact.h_c"].values[row]), rel=1e-12)
        assert found.time == run.dataset["time"].values[row]


@pytest.mark.parametrize("name", [*COMPARED, *CHANGES])
def test_a_record_that_is_not_of_this_run_is_told(name: str, assembly: Assembly, run: Run, shallow: None) -> None:
    """An output of the row, or an input of an earlier one."""
    last = len(STEPS)
    altered = run.dataset.copy(deep=True)
    altered[f"contact.{name}"].values[last if name in COMPARED else last - 1 :] *= 0.99
    found = solved_again(assembly, altered, "contact", last)
    if name in COMPARED:
        assert found.replayed == approx(0.01)
    assert 1e-3 < found.replayed < 0.5
    assert list(resolve.lines([found]))[-1].endswith(f"they agree with the run to {found.replayed:.1g}.")
    sound = solved_again(assembly, run.dataset, "contact", last)
    assert list(resolve.lines([sound, found, sound]))[-1] == list(resolve.lines([found]))[-1]


def judged(values: Mapping[str, float] | None = None, deep: Mapping[str, Any] | None = None) -> Resolved:
    """A state whose friction is off by a quarter and whose film by a half, and the errors of both stated larger."""
    given = {"friction_coefficient": 0.08, "h_c": 40e-9, "error_friction": 0.26, "error_film": 0.51, **(values or {})}
    solved = {"friction_coefficient": 0.10, "h_c": 20e-9, **(deep or {})}
    return Resolved("contact", 3, 1.0, replace(Outputs(), **given), replace(Outputs(), **solved), 0.0)


def test_errors_that_cover_make_a_state_valid() -> None:
    assert [judged().deviation(name) for name in COMPARED] == approx([0.25, 0.5])
    assert judged().valid
    assert judged().verdict == "yes"
    assert judged(deep={"friction_coefficient": 0.06, "h_c": 60e-9}).valid


@pytest.mark.parametrize("name", COMPARED)
@pytest.mark.parametrize("part", [0.1, 0.5, 0.95])
def test_one_error_that_does_not_cover_is_enough_to_make_it_invalid(name: str, part: float) -> None:
    less = judged({COMPARED[name]: part * judged().allowed(name)})
    assert not less.valid
    assert less.verdict == "NO"
    (said,) = less.shortfalls
    assert said.startswith(f"{name} of contact at 1 s deviates by {less.deviation(name):.1%}")


@pytest.mark.parametrize("flag", [RangeFlag.NOT_CONVERGED, RangeFlag.FALLBACK, RangeFlag.DOMAIN_EDGE])
def test_a_solution_that_missed_its_tolerance_judges_nothing(flag: RangeFlag) -> None:
    unsure = judged(deep={"range_flags": int(flag | RangeFlag.FEW_NODES)})
    assert not unsure.solved
    assert not unsure.valid
    assert unsure.verdict.startswith("not decided")
    assert judged(deep={"range_flags": int(RangeFlag.FEW_NODES)}).valid


@pytest.mark.parametrize("part", [1.0, 0.1])
def test_a_run_whose_stated_errors_are_a_tenth_is_found_not_to_be_covered(
    part: float, assembly: Assembly, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The errors of the regression level are given as 1.2 of what they are, and as a tenth of that."""
    whole, true = advance, {"friction_coefficient": 0.25, "h_c": 0.4}

    def stating(scene: Scene, point: OperatingPoint, state: ContactState, step: float) -> tuple[ContactState, Outputs]:
        after, out = whole(scene.at_level(FAST), point, state, step)
        if step == 0.0:  # solved again: off from the regression level by what is true
            return after, replace(out, **{name: getattr(out, name) * (1.0 + off) for name, off in true.items()})
        return after, replace(out, **{COMPARED[name]: 1.2 * part * off for name, off in true.items()})

    monkeypatch.setattr(resolve, "advance", stating)
    states = resolve.resolve(assembly, run.dataset, lambda done: None, count=3)
    assert len(states) >= 3
    assert all(state.solved for state in states)
    assert [state.valid for state in states] == [part == 1.0] * len(states)
    marked = resolve.marked(run.dataset, states)["contact.valid"].values.astype(bool)
    wrong = {state.row for state in states if not state.valid}
    assert np.flatnonzero(~marked).tolist() == sorted(wrong)
    assert run.dataset["contact.valid"].values.all()
    told = resolve.to_dataset(states)
    assert told["resolved.valid"].values.tolist() == [part == 1.0] * len(states)


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"load": 2.0},
        {"speed_1": -0.02, "speed_2": -0.02},
        {"speed_1": -1.0, "speed_2": 1.0},
        {"valid": 0.0},
        {"count": 0.0},
    ],
    ids=["works", "idle load", "idle speed", "pure sliding", "invalid", "stands for nothing"],
)
def test_a_row_at_which_a_contact_does_not_work_is_not_chosen_nor_the_one_after_it(
    changes: dict[str, float], assembly: Assembly, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The loads and speeds of the idle row are not zero, but a twentieth of the mean at most."""
    rows, idle = 20, 7
    start = {"load": 50.0, "speed_1": -1.0, "speed_2": -0.5, "valid": 1.0, "count": 3.0, "fidelity_used": 1.0}
    columns = {key: np.full(rows, value) for key, value in start.items()}
    for key, value in changes.items():
        columns[key][idle] = value
    named = {f"contact.{key}": ("time", values) for key, values in columns.items()}
    dataset = xr.Dataset(named, {"time": np.arange(float(rows))})
    contact = replace(assembly.contacts["contact"], count="contact.count")
    monkeypatch.setattr(resolve, "solved_again", lambda *given: replace(judged(), row=given[-1]))
    of_many = replace(assembly, contacts={"contact": contact})
    chosen = {state.row for state in resolve.resolve(of_many, dataset, lambda done: None, count=rows)}
    assert chosen == {*range(1, rows)} - ({idle, idle + 1} if changes else set())
