"""The shipped pin on disc: the scar of a worn cap, Archard's volume, no scar at the grid's edge, both levels."""

import numpy as np
import pytest
from comparison import approx
from test_resting import radius, volume_of_scar

from contact_core import RangeFlag, Scene, advance, initial_state

COARSE = {"film.points": "49"}
OF_HOUR = pytest.mark.long  # the same of a coarser pin: test_resting


@pytest.fixture(scope="module")
def hour():
    scene = Scene.from_toml("pin_on_disc", COARSE)
    state, rows = initial_state(scene), []
    for _ in range(12):
        state, outputs = advance(scene, scene.operation.point, state, 300.0)
        rows.append(outputs)
    return scene, state, rows


def test_the_scene_is_one_body_at_rest_on_a_track_of_its_radius():
    scene = Scene.from_toml("pin_on_disc")
    op, geometry = scene.operation.point, scene.geometry
    assert (op.speed_1, op.speed_2) == (0.0, 0.1)
    assert geometry.track_length_2 == approx(2.0 * np.pi * 16e-3, rel=1e-4)
    assert geometry.track_length_1 == approx(2.0 * np.pi * geometry.radius_x, rel=1e-4)
    assert scene.hertz(op.load).pressure_max == approx(1.0e9, rel=0.02)
    assert scene.operation.duration == 3600.0


@OF_HOUR
def test_the_scar_of_an_hour_stays_on_the_grid(hour):
    scene, state, rows = hour
    assert not any(RangeFlag(row.range_flags) & RangeFlag.DOMAIN_EDGE for row in rows)
    wear = state.bodies[0].wear
    worn = wear > 1e-3 * wear.max()
    edge = [worn[:3], worn[-3:], worn[:, :3], worn[:, -3:]]
    assert not any(part.any() for part in edge)
    assert state.rows == scene.rows


@OF_HOUR
def test_the_pin_loses_archards_volume_between_those_of_bare_and_of_covered_steel(hour):
    scene, _, rows = hour
    op, wear, hardness = scene.operation.point, scene.wear, scene.plasticity.hardness
    share = np.mean([row.contact_load_ratio for row in rows])
    bare, covered = (k * share * op.load * 0.1 * 3600.0 / hardness for k in (wear.bare, wear.film))
    assert covered < min(rows[-1].wear_volume_1, rows[-1].wear_volume_2)
    assert max(rows[-1].wear_volume_1, rows[-1].wear_volume_2) < bare


@OF_HOUR
def test_the_scar_is_the_cap_of_its_volume_under_an_even_pressure(hour):
    scene, state, rows = hour
    load = rows[-1].contact_load_ratio * scene.operation.load
    a = radius(scene, state.bodies[0].wear)
    assert a > 1.6 * scene.hertz(load).a
    assert volume_of_scar(a, scene, load) == approx(rows[-1].wear_volume_1, rel=0.06)


@pytest.mark.long
def test_bodies_of_one_wear_coefficient_lose_archards_volume_of_the_load_that_solids_carry():
    scene = Scene.from_toml("pin_on_disc", COARSE | {"tribofilm.model": "none"})
    state, op, expected, before = initial_state(scene), scene.operation.point, 0.0, None
    for _ in range(30):
        state, outputs = advance(scene, op, state, 20.0)
        share = outputs.contact_load_ratio
        expected += 1e-7 * 0.5 * (share + (before or share)) * op.load * 2.0 / scene.plasticity.hardness
        before = share
    assert outputs.wear_volume_1 == approx(outputs.wear_volume_2, rel=1e-9, abs=0.0)
    assert outputs.wear_volume_1 == approx(expected, rel=0.05)


@OF_HOUR
def test_the_regression_level_agrees_within_what_it_states_and_says_that_it_is_outside_its_fit(hour):
    rows = hour[2]
    scene = Scene.from_toml("pin_on_disc").at_level("regression")
    _, found = advance(scene, scene.operation.point, initial_state(scene), 3600.0)
    assert RangeFlag(found.range_flags) & RangeFlag.OUTSIDE_FIT
    last = rows[-1]
    for name, error in (
        ("friction_coefficient", "error_friction"),
        ("wear_volume_1", "error_wear"),
        ("tribofilm_2", "error_tribofilm_2"),
    ):
        mine, other = getattr(found, name), getattr(last, name)
        assert abs(mine - other) < getattr(found, error) * mine + getattr(last, error) * other, name
    assert found.wear_volume_1 == approx(last.wear_volume_1, rel=0.25)
