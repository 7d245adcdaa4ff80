"""The level `map` at random operating points and on random surfaces, far beyond its ranges too."""

import math
from pathlib import Path

import pytest
from comparison import approx
from hypothesis import assume, given
from hypothesis import strategies as st
from mapped_scene import mapped_scene

from contact_core import OperatingPoint, Outputs, RangeFlag, Scene, advance, initial_state
from contact_core.corrections.map import STEEPEST
from contact_core.quantities import TABLE, value_out_of_range

ERRORS = ("error_friction", "error_film", "error_load_ratio")


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Scene:
    return mapped_scene(Path(tmp_path_factory.mktemp("map")))


def logarithmic(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(math.log(low), math.log(high)).map(math.exp)


@given(logarithmic(1e-3, 120.0), logarithmic(1e-4, 30.0), logarithmic(1e-6, 2.0), st.sampled_from([0.0, 5.0, 3600.0]))
def test_outputs_stay_physical_and_between_what_the_map_may_say(
    scene: Scene, load: float, speed: float, slip: float, seconds: float
) -> None:
    point = OperatingPoint(load, speed * (1.0 + 0.5 * slip), speed * (1.0 - 0.5 * slip), 353.15)
    state = advance(scene, scene.operation.point, initial_state(scene), seconds)[0]
    out, quick = (advance(each, point, state, 0.0)[1] for each in (scene, scene.at_level("regression")))
    assert 0.0 <= out.contact_load_ratio <= 1.0
    for name in ("h_c", "friction_coefficient"):
        assert abs(math.log(getattr(out, name) / getattr(quick, name))) <= STEEPEST
    assert out.friction_coefficient > 0.0
    for name, value in vars(out).items():
        assert list(value_out_of_range(TABLE[name], value)) == []
    for error in ERRORS:
        assert 0.0 <= getattr(out, error) < math.inf


@given(logarithmic(30.0, 75.0), logarithmic(0.04, 0.25), st.floats(1.01, 1.2))
def test_within_its_ranges_the_film_grows_with_the_speed(scene: Scene, load: float, speed: float, more: float) -> None:
    slow, fast = (_at(scene, load, factor * speed) for factor in (1.0, more))
    assume(not (slow.range_flags | fast.range_flags) & RangeFlag.OUTSIDE_FIT)
    assert fast.h_c > slow.h_c
    assert fast.contact_load_ratio <= slow.contact_load_ratio


def _at(scene: Scene, load: float, speed: float) -> Outputs:
    return advance(scene, OperatingPoint(load, 1.025 * speed, 0.975 * speed, 353.15), initial_state(scene), 0.0)[1]


@given(logarithmic(5.0, 100.0), logarithmic(0.005, 1.0), st.floats(-1.0, 1.0))
def test_the_direction_of_all_motion_turns_friction_and_nothing_else(
    scene: Scene, load: float, speed: float, slip: float
) -> None:
    forth, back = (
        advance(
            scene,
            OperatingPoint(load, sign * speed * (1.0 + 0.5 * slip), sign * speed * (1.0 - 0.5 * slip), 353.15),
            initial_state(scene),
            0.0,
        )[1]
        for sign in (1.0, -1.0)
    )
    assert forth.friction_force == approx(-back.friction_force, rel=1e-9)
    assert forth.h_c == approx(back.h_c, rel=1e-9)


def test_a_step_in_two_halves_is_near_the_whole(scene: Scene) -> None:
    whole = advance(scene, scene.operation.point, initial_state(scene), 60.0)[1]
    state = initial_state(scene)
    for _ in range(2):
        state, out = advance(scene, scene.operation.point, state, 30.0)
    assert out.tribofilm_2 == approx(whole.tribofilm_2, rel=0.02)
    assert out.wear_volume_2 == approx(whole.wear_volume_2, rel=0.02)
