"""The regression level corrected by deterministic blocks where it is not sure enough, and only there."""

from dataclasses import replace
from typing import Any

import pytest
from comparison import approx

from contact_core import ContactState, OperatingPoint, Outputs, RangeFlag, Scene, advance, initial_state
from contact_core.corrections import blocks as by_blocks
from contact_core.corrections.correction import Deviation, moved
from contact_core.errors import ConvergenceError
from contact_core.regression.contact import evaluate
from contact_core.regression.surfaces import tribofilms_of
from contact_core.scene import Case
from contact_core.surfaces.track_means import means_of

SMALL = {
    "film.points": "17",
    "surface_1.correlation_length": "32 um",
    "surface_2.correlation_length": "32 um",
    "film.model": "regression",
    "film.correction": "blocks",
    "control.accuracy": "10 %",
}
OFF = {
    "friction_coefficient": 1.04,
    "h_c": 0.93,
    "contact_load_ratio": 1.02,
}  # of the blocks, from the regression level


def scene_of(**changes: str) -> Scene:
    named = {name.replace("__", "."): value for name, value in changes.items()}
    return Scene.from_toml("mtm_zddp", SMALL | named)


@pytest.fixture
def blocks(monkeypatch: pytest.MonkeyPatch) -> list[OperatingPoint]:
    """Operating points of the blocks, which are the regression level's answer times OFF."""
    solved = list[OperatingPoint]()

    def block(case: Case, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
        solved.append(case.op)
        _, fast = advance(case.scene.at_level("regression"), case.op, state, dt)
        off: dict[str, Any] = {name: factor * getattr(fast, name) for name, factor in OFF.items()}
        sure = dict.fromkeys(("error_friction", "error_film", "error_load_ratio"), 0.001)
        return state, replace(fast, **off, **sure, range_flags=0, blocks_mixed=fast.blocks_mixed + 1.0)

    monkeypatch.setattr(by_blocks.deterministic, "advance", block)
    return solved


def led(scene: Scene, steps: int, state: ContactState | None = None) -> tuple[ContactState, Outputs]:
    state, out = state or initial_state(scene), Outputs()
    for _ in range(steps):
        state, out = advance(scene, scene.operation.point, state, 60.0)
    return state, out


@pytest.mark.parametrize(
    "changes",
    [
        {"control__accuracy": "100 %"},
        {f"surface_{i}__{name}": "0 m" for i in (1, 2) for name in ("rq", "microroughness.rms")},
    ],
    ids=["asks for little", "smooth"],
)
def test_without_a_need_no_block_is_solved_and_all_is_that_of_the_regression_level_to_the_bit(
    changes: dict[str, str], blocks: list[OperatingPoint]
) -> None:
    scene = scene_of(**changes)
    state, out = led(scene, 3)
    fast, quick = led(scene.at_level("regression"), 3)
    assert not blocks
    assert out == quick
    assert state.to_bytes() == fast.to_bytes()


def test_a_block_corrects_the_place_and_narrows_its_errors(blocks: list[OperatingPoint]) -> None:
    scene = scene_of()
    _, out = led(scene, 1)
    _, quick = led(scene.at_level("regression"), 1)
    assert len(blocks) == 1
    assert out.blocks_mixed == 1.0
    for name, factor in OFF.items():
        toward = (getattr(out, name) / getattr(quick, name) - 1.0) / (factor - 1.0)
        assert 0.6 < toward < 1.05, name
    for name in ("error_friction", "error_film", "error_load_ratio"):
        assert getattr(out, name) < 0.7 * getattr(quick, name)
    assert out.friction_force / quick.friction_force == approx(out.friction_coefficient / quick.friction_coefficient)
    assert out.power_loss / quick.power_loss == approx(out.friction_coefficient / quick.friction_coefficient)
    assert out.wear_rate_2 > quick.wear_rate_2


def test_what_follows_from_friction_and_load_share_is_corrected_with_them(blocks: list[OperatingPoint]) -> None:
    """Solids press as hard as before on another area and keep their law; heat and temperatures follow friction."""
    scene = scene_of(heat__bulk__model="inputs")
    op = replace(scene.operation.point, spin=5.0, body_temperature_1=357.15, body_temperature_2=353.15)
    out, quick = (advance(each, op, initial_state(each), 0.0)[1] for each in (scene, scene.at_level("regression")))
    assert len(blocks) == 1

    def ratio(name: str, beside: float = 0.0) -> float:
        return (getattr(out, name) - beside) / (getattr(quick, name) - beside)

    share, friction = ratio("contact_load_ratio"), ratio("friction_coefficient")
    assert share > 1.005
    assert friction > 1.02
    assert ratio("contact_area_ratio") == approx(share)
    assert ratio("contact_temperature_max", beside=357.15) == approx(friction)
    assert ratio("friction_solid") == approx(share)
    assert ratio("flash_temperature_rise") == approx(friction)
    forces = ("friction_force", "spin_torque", "dfriction_dspeed_1", "dfriction_dload")
    for name in (*forces, "power_loss", "heat_flow_1", "heat_flow_2"):
        assert ratio(name) == approx(friction), name


def at_speed(scene: Scene, speed: float) -> OperatingPoint:
    return replace(scene.operation.point, speed_1=1.025 * speed, speed_2=0.975 * speed)


@pytest.mark.parametrize(
    ("speed", "accuracy", "surer", "asking"),
    [(0.01, 0.15, "error_friction", "error_film"), (10.0, 0.11, "error_film", "error_friction")],
)
def test_either_error_asks_for_a_block_by_itself_and_one_that_is_sure_then_raises_no_flag(
    speed: float, accuracy: float, surer: str, asking: str, blocks: list[OperatingPoint]
) -> None:
    scene = scene_of(control__accuracy=f"{accuracy}")
    quick, out = (
        advance(each, at_speed(scene, speed), initial_state(each), 0.0)[1]
        for each in (scene.at_level("regression"), scene)
    )
    assert getattr(quick, surer) < accuracy < getattr(quick, asking)
    assert RangeFlag.UNSURE in RangeFlag(quick.range_flags)
    assert len(blocks) == 1
    assert max(out.error_friction, out.error_film, out.error_load_ratio) < accuracy
    assert RangeFlag.UNSURE not in RangeFlag(out.range_flags)
    assert out.error_wear < 0.7 * quick.error_wear  # as that of the share that makes it


def test_a_scene_that_asks_for_no_accuracy_gets_ten_percent(blocks: list[OperatingPoint]) -> None:
    scene = Scene.from_toml("mtm_zddp", {name: value for name, value in SMALL.items() if name != "control.accuracy"})
    point = at_speed(scene, 10.0)
    _, quick = advance(scene.at_level("regression"), point, initial_state(scene), 0.0)
    assert 0.1 < max(quick.error_friction, quick.error_film) < 0.15
    advance(scene, point, initial_state(scene), 0.0)
    assert len(blocks) == 1


@pytest.mark.parametrize("deviation", [Deviation(1.1, 0.8, 0.9), Deviation(0.9, 1.2, 0.3), Deviation(0.3, 1.0, 1.0)])
def test_what_follows_from_friction_film_and_load_ratio_moves_with_them(deviation: Deviation) -> None:
    scene = scene_of().at_level("regression")
    case = Case.bind(scene, scene.operation.point)
    contact = evaluate(case, tribofilms_of(means_of(scene, initial_state(scene))))
    better, bulk = moved(contact, deviation, max(case.op.bodies)), max(case.op.bodies)
    force = deviation.friction * (contact.solid + contact.fluid)
    assert better.solid + better.fluid == approx(force)
    assert better.power == approx(abs(force * case.op.sliding_speed))  # what friction does is heat, and all of it
    assert (better.hottest - bulk) / (contact.hottest - bulk) == approx(deviation.friction)
    assert better.rise / contact.rise == approx(deviation.friction)
    assert better.area_ratio / better.load_ratio == approx(contact.area_ratio / contact.load_ratio)
    coefficient = contact.solid / (contact.load_ratio * case.op.load)
    lawful = coefficient * deviation.load_ratio * case.op.load
    assert better.solid == approx(lawful if abs(lawful) < abs(force) else force)  # that of its law, or all there is
    assert better.fluid_shear * contact.fluid == approx(contact.fluid_shear * better.fluid)


def test_near_a_block_no_other_is_solved_and_far_from_it_one_is(blocks: list[OperatingPoint]) -> None:
    scene = scene_of(control__accuracy="1 %")  # which one block cannot give
    state, out = led(scene, 4)
    assert len(blocks) == 1
    assert RangeFlag.UNSURE in RangeFlag(out.range_flags)
    for speed, solved in ((0.11, 1), (0.3, 2), (4.0, 3), (4.0, 3)):
        state, _ = advance(scene, at_speed(scene, speed), state, 1.0)
        assert len(blocks) == solved


@pytest.mark.parametrize(
    "flag",
    [None, RangeFlag.NOT_CONVERGED, RangeFlag.FALLBACK, RangeFlag.DOMAIN_EDGE],
    ids=["raises", "no convergence", "fallback", "edge"],
)
def test_a_block_that_fails_is_not_tried_again_and_changes_nothing(
    flag: RangeFlag | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    tried = list[float]()

    def fails(case: Case, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
        tried.append(dt)
        if flag is None:
            raise ConvergenceError("none")
        return state, Outputs(friction_coefficient=1.0, h_c=1e-6, contact_load_ratio=1.0, range_flags=int(flag))

    monkeypatch.setattr(by_blocks.deterministic, "advance", fails)
    scene = scene_of()
    state, out = led(scene, 3)
    _, quick = led(scene.at_level("regression"), 3)
    assert tried == [0.0]
    assert out.friction_coefficient == approx(quick.friction_coefficient, rel=1e-12)
    assert out.error_friction == approx(quick.error_friction, rel=1e-12)
    assert RangeFlag.UNSURE in RangeFlag(out.range_flags)
    assert state.solved is not None


def test_a_state_keeps_its_blocks_to_the_bit_through_bytes(blocks: list[OperatingPoint]) -> None:
    scene = scene_of()
    half, _ = led(scene, 2)
    stored = half.to_bytes()
    again = ContactState.from_bytes(stored, scene)
    assert again.to_bytes() == stored
    whole, out = led(scene, 3, half)
    resumed, same = led(scene, 3, again)
    assert len(blocks) == 1
    assert same == out
    assert resumed.to_bytes() == whole.to_bytes()


def test_a_step_leaves_its_state_as_it_was(blocks: list[OperatingPoint]) -> None:
    scene = scene_of()
    state = initial_state(scene)
    before = state.to_bytes()
    first = led(scene, 1, state)[0].to_bytes()
    assert state.to_bytes() == before
    assert led(scene, 1, state)[0].to_bytes() == first
    assert len(blocks) == 2  # going back forgets


def test_no_more_blocks_than_a_state_may_keep(blocks: list[OperatingPoint], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(by_blocks, "MOST", 2)
    scene, state = scene_of(control__accuracy="1 %"), None
    state = initial_state(scene)
    for speed in (0.02, 0.2, 1.0, 4.0):
        state, _ = advance(
            scene, replace(scene.operation.point, speed_1=1.05 * speed, speed_2=0.95 * speed), state, 1.0
        )
    assert len(blocks) == 2


def test_a_real_block_is_one_of_the_deterministic_level() -> None:
    scene = scene_of()
    state, out = advance(scene, scene.operation.point, initial_state(scene), 0.0)
    _, deep = advance(scene.at_level("deterministic"), scene.operation.point, initial_state(scene), 0.0)
    assert out.blocks_dry + out.blocks_mixed == 1.0
    assert abs(out.friction_coefficient / deep.friction_coefficient - 1.0) < out.error_friction
    assert state.solved is not None
