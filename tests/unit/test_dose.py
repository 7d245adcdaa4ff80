"""How much a tribofilm gets of its contact: by time, sliding, load share, track length; and what the clock says."""

from dataclasses import replace

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap
from comparison import HARD, approx

from contact_core import RangeFlag, Scene, advance, initial_state
from contact_core.reference import slipping_share

DRY = {"control.driver": "dry"}
LEVELS = ("deterministic", "regression")
SECONDS = 20.0


def films(level: str, srr: float = 0.05, seconds: float = SECONDS, **changes: str) -> np.ndarray:
    """Mean tribofilms [m] of both bodies after a while at a slide-to-roll ratio."""
    scene = cheap(CHEAP | DRY, **changes)[0].at_level(level)
    point = scene.operation.point
    mean = point.entrainment_speed
    point = replace(point, speed_1=mean * (1.0 + 0.5 * srr), speed_2=mean * (1.0 - 0.5 * srr))
    _, out = advance(scene, point, initial_state(scene), seconds)
    return np.array([out.tribofilm_1, out.tribofilm_2])


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("dose", ["residence", "contact_length", "clock"])
def test_no_film_grows_in_pure_rolling_and_next_to_none_at_a_millionth_of_sliding(level, dose):
    assert not films(level, 0.0, tribofilm__dose=dose).any()
    assert np.all(films(level, 1e-6, tribofilm__dose=dose) < 2e-3 * films(level, 0.05, tribofilm__dose=dose))


@pytest.mark.parametrize("level", LEVELS)
def test_in_near_rolling_the_film_grows_on_the_part_that_slips(level):
    scene, _, point = cheap(CHEAP | DRY)
    hertz, friction = scene.hertz(point.load), scene.boundary_friction.bare
    full = friction * hertz.a / scene.geometry.radius_x
    for creep in (0.01 * full, 0.1 * full):
        share = slipping_share(creep, friction, hertz.a, scene.geometry.radius_x)
        slow, fast = (films(level, c, 0.1, tribofilm__supply_rate="1 m/s") for c in (creep, 2.0 * full))
        assert slow == approx(share * fast, rel=0.02, abs=0.0)


@pytest.mark.parametrize("level", LEVELS)
def test_a_longer_track_grows_its_film_slower_by_time_in_contact_and_as_fast_by_the_clock(level):
    length = cheap()[0].geometry.track_length_2
    longer = {"geometry__track_length_2": f"{2.0 * length:.17g} m"}
    short, long = films(level), films(level, **longer)
    assert long[0] == approx(short[0], rel=0.02)  # it faces another film
    assert long[1] == approx(0.5 * short[1], rel=0.05)
    by_clock = films(level, tribofilm__dose="clock", **longer) / films(level, tribofilm__dose="clock")
    assert by_clock == approx([1.0, 1.0], rel=1e-6)


@pytest.mark.parametrize("level", [pytest.param("deterministic", marks=pytest.mark.long), "regression"])
def test_contacts_alone_grow_nothing_under_a_full_film_which_shear_does(level):
    smooth = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm"} | HARD
    point = replace(cheap()[0].operation.point, speed_1=6.0, speed_2=4.0)
    by_contact, by_shear = (
        advance(scene, point, initial_state(scene), SECONDS)[1]
        for scene in (
            cheap(CHEAP | smooth)[0].at_level(level),
            cheap(CHEAP | smooth, tribofilm__set="zhang_spikes_80c_ethylhexyl", tribofilm__least_shear="1 MPa")[
                0
            ].at_level(level),
        )
    )
    assert by_contact.contact_load_ratio == by_shear.contact_load_ratio == 0.0
    assert by_contact.tribofilm_1 == 0.0 < by_shear.tribofilm_1


@pytest.mark.parametrize("level", LEVELS)
def test_the_result_says_that_films_age_by_the_clock(level):
    for dose in ("clock", "residence"):
        scene = cheap(CHEAP | DRY, tribofilm__dose=dose)[0].at_level(level)
        _, out = advance(scene, scene.operation.point, initial_state(scene), 0.0)
        assert bool(out.range_flags & RangeFlag.BY_THE_CLOCK) == (dose == "clock")


def test_the_supply_of_additive_bounds_every_point_s_growth():
    scene = cheap(CHEAP | DRY, tribofilm__supply_rate="2e-11 m/s")[0]
    state, _ = advance(scene, scene.operation.point, initial_state(scene), SECONDS)
    most = max(body.growth.max() for body in state.bodies)
    assert 0.99 * SECONDS * 2e-11 < most <= SECONDS * 2e-11


@pytest.mark.long
@pytest.mark.parametrize("name", ["mtm_zddp", "azam_case_a"])
def test_the_shipped_shares_are_those_of_the_balls_at_the_start(name):
    scene = Scene.from_toml(name, {"film.points": "65"})
    law, point = scene.tribofilm, scene.operation.point
    state, _ = advance(scene, point, initial_state(scene), 0.0)
    inside = np.abs(scene.grid(state.rows).y) < scene.hertz(point.load).b
    share = state.bodies[0].exposure[inside].mean() / law.rate(point.temperature) * law.contact_share
    assert share == approx(law.contact_share, rel=0.1)


@pytest.mark.parametrize("level", LEVELS)
def test_bodies_that_hardly_move_grow_next_to_nothing_at_any_slide_to_roll_ratio(level):
    scene = cheap(CHEAP | DRY)[0].at_level(level)
    point = replace(scene.operation.point, speed_1=1.05e-9, speed_2=0.95e-9)
    _, out = advance(scene, point, initial_state(scene), SECONDS)
    assert 0.0 < out.tribofilm_1 < 1e-3 * films(level)[0]


def test_the_regression_level_says_which_laws_of_nodes_it_leaves_out():
    given = {"plasticity.indentation": "iterated", "solids.film_modulus": "100 GPa"}
    assert not any("leaves out" in line for line in cheap(CHEAP | given)[0].warnings())
    said = [line for line in cheap(CHEAP | given)[0].at_level("regression").warnings() if "leaves out" in line]
    assert said == [
        "film.model = 'regression' leaves out plasticity.indentation = 'iterated' and solids.film_modulus: it has no "
        "nodes that yield."
    ]
