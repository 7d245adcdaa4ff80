"""Radii of curvature as inputs: the contact is that of a scene with these radii, the state remembers none of it."""

import math
import re
from dataclasses import asdict, replace

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap, settled
from comparison import HARD, approx

from contact_core import ContactState, OperatingPointError, RangeFlag, Scene, advance, initial_state, solve
from contact_core.reference import SmoothContact, nijenbanning_venner_moes

LEVELS = ("deterministic", "regression")
SMOOTH = HARD | {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm"}
RADII = [(11e-3, 11e-3), (8e-3, 6e-3), (5e-3, 9e-3)]


def at_level(level, changes=CHEAP):
    scene, fresh, op = cheap(changes)
    return scene.at_level(level), fresh, op


def at(op, radius_x, radius_y=None, **changes):
    return replace(op, radius_x=radius_x, radius_y=radius_y or radius_x, **changes)


def made_with(scene, radius_x, radius_y):
    """The scene as if it had been written with these radii."""
    return replace(scene, geometry=replace(scene.geometry, radius_x=radius_x, radius_y=radius_y))


@pytest.mark.parametrize("radii", RADII)
@pytest.mark.parametrize("changes", [{}, {"load": 0.0}, {"speed_1": 0.0, "speed_2": 0.0}], ids=str)
def test_a_solution_at_given_radii_is_that_of_a_scene_with_these_radii(radii, changes):
    scene, fresh, op = cheap()
    op = replace(op, **changes)
    given, own = solve(scene, at(op, *radii), fresh), solve(made_with(scene, *radii), op, fresh)
    for name in ("pressure", "fluid_pressure", "solid_pressure", "gap", "shear"):
        np.testing.assert_array_equal(getattr(given, name), getattr(own, name))
    assert given.film.rigid_gap == own.film.rigid_gap != solve(scene, op, fresh).film.rigid_gap


@pytest.mark.parametrize(
    "radii", [RADII[1], *(pytest.param(each, marks=pytest.mark.long) for each in (RADII[0], RADII[2]))]
)
@pytest.mark.parametrize("level", LEVELS)
def test_the_contacts_outputs_are_those_of_a_scene_with_these_radii(level, radii):
    scene, fresh, op = at_level(level, CHEAP | {"heat.inlet_shear": "gupta"})
    state, before = advance(scene, op, fresh, 1.0)
    state = replace(state, solved_for=None)  # a scene of other radii would take the contact for solved
    given, own = advance(scene, at(op, *radii), state, 0.0)[1], advance(made_with(scene, *radii), op, state, 0.0)[1]
    of_contact = {
        name
        for name in asdict(given)
        if not name.startswith(
            ("error", "roughness", "tribofilm", "coverage", "wear_depth", "profile_loss", "suggested")
        )
    }  # the rest are means over the track, which is that of the scene's own radii
    assert {name: getattr(given, name) for name in of_contact} == {name: getattr(own, name) for name in of_contact}
    assert given.approach != before.approach
    assert given.tribofilm_2 == before.tribofilm_2 > 0.0


@pytest.mark.parametrize("radii", [(5e-3, 5e-3), (7e-3, 14e-3), (12e-3, 6e-3)])
def test_pressure_approach_and_film_of_smooth_bodies_go_with_the_radii_as_the_formulas_say(radii):
    scene, fresh, op = cheap(SMOOTH | {"film.points": "129", "film.domain": "0.6 mm"})
    op = replace(op, speed_1=20.0, speed_2=20.0)
    dry, hertz = solve(scene, at(op, *radii), fresh, dry=True), scene.hertz_at(at(op, *radii))
    assert dry.pressure.max() == approx(hertz.pressure_max, rel=0.01)
    assert -dry.film.rigid_gap == approx(hertz.approach, rel=0.01)

    def film_over_formulas(radius_x, radius_y):
        oil = scene.lubricant.viscosity, op.temperature, radius_x, radius_y, scene.solids.reduced_modulus
        found = solve(scene, at(op, radius_x, radius_y), fresh)
        assert found.converged
        formula = nijenbanning_venner_moes(SmoothContact.of(op.load, op.entrainment_speed, *oil))
        return found.gap[64, 64] / formula

    own = scene.radii(scene.operation.point)
    assert film_over_formulas(*radii) == approx(film_over_formulas(*own), rel=0.06)


@pytest.mark.parametrize("level", LEVELS)
def test_the_scenes_own_radii_are_as_good_as_none(level):
    scene, fresh, op = at_level(level)
    named = at(op, *scene.radii(scene.operation.point))
    one, other = fresh, fresh
    for dt, load in ((0.0, 70.0), (5.0, 70.0)):
        one, said = advance(scene, replace(op, load=load), one, dt)
        other, again = advance(scene, replace(named, load=load), other, dt)
        assert said == again
    assert replace(one, solved_for=None).to_bytes() == replace(other, solved_for=None).to_bytes()


@pytest.mark.parametrize("level", LEVELS)
def test_a_state_alone_decides_what_follows_however_radii_change(level):
    scene, fresh, op = at_level(level)
    points = [at(op, radius) for radius in (6e-3, 10e-3)]
    saved, _ = advance(scene, points[0], fresh, 1.0)
    data = saved.to_bytes()
    first = [advance(scene, point, saved, 5.0) for point in points]
    second = [advance(scene, point, ContactState.from_bytes(data, scene), 5.0) for point in reversed(points)]
    for (state, outputs), (again, outputs_again) in zip(first, reversed(second), strict=True):
        assert outputs == outputs_again
        assert state.to_bytes() == again.to_bytes()
    assert len({outputs.approach for _, outputs in first}) == 2


def test_a_contact_is_solved_again_when_radii_have_changed_by_more_than_the_scene_tolerates():
    scene, state, op = settled()
    tolerated, before = scene.control.input_change, state.outputs
    radius = scene.geometry.radius_x
    for name, change in (("radius_x", tolerated), ("radius_y", -tolerated)):
        little, more = (replace(op, **{name: (1.0 + part * change) * radius}) for part in (0.9, 1.1))
        assert advance(scene, little, state, 0.0)[1] == before
        assert advance(scene, more, state, 0.0)[1].blocks_mixed == before.blocks_mixed + 1.0


@pytest.mark.parametrize("factor", [0.4, pytest.param(1.2, marks=pytest.mark.long)])
def test_the_march_goes_on_through_a_jump_of_the_radii(factor):
    scene, state, op = settled()
    radii = (factor * radius for radius in scene.radii(scene.operation.point))
    state, jumped = advance(scene, at(op, *radii), state, 1.0)
    back = advance(scene, op, state, 1.0)[1]
    assert jumped.unconverged == jumped.blocks_fallback == back.unconverged == back.blocks_fallback == 0.0
    assert jumped.approach == approx(scene.hertz_at(at(op, factor * 0.01)).approach, rel=0.1)


@pytest.mark.parametrize("radii", RADII)
def test_areas_are_shares_of_the_hertz_area_of_the_radii_given(radii):
    scene, fresh, op = cheap(SMOOTH | {"film.points": "65"})
    _, outputs = advance(scene, at(op, *radii, speed_1=0.0, speed_2=0.0), fresh, 0.0)
    assert outputs.contact_area_ratio == approx(1.0, abs=0.08)


def test_a_contact_that_small_radii_make_too_small_for_the_grid_is_flagged():
    scene, fresh, op = cheap(control__driver="dry")
    few = [advance(scene, at(op, radius, load=10.0), fresh, 0.0)[1].range_flags for radius in (10e-3, 3e-3)]
    assert [bool(flags & RangeFlag.FEW_NODES) for flags in few] == [False, True]


@pytest.mark.parametrize("radius", [0.0, -5e-3, math.nan, math.inf, 200.0])
@pytest.mark.parametrize("name", ["radius_x", "radius_y"])
@pytest.mark.parametrize("level", LEVELS)
def test_radii_that_no_body_has_are_refused_by_name(level, name, radius):
    scene, fresh, op = at_level(level)
    with pytest.raises(OperatingPointError, match=rf"^{name} = .* m \(combined radius .*must be "):
        advance(scene, replace(op, **{name: radius}), fresh, 1.0)


@pytest.mark.parametrize(
    ("radii", "said"),
    [
        ((50e-3, 40e-3), r"radius_x = 0\.05 m and radius_y = 0\.04 m .* film\.domain = 0\.0005 m\. .*at most"),
        ((0.2e-3, 0.3e-3), r"radius_x = 0\.0002 m and radius_y = 0\.0003 m .* plasticity\.hardness .*at least"),
    ],
)
def test_radii_whose_contact_the_grid_cannot_hold_are_refused_with_the_nearest_that_it_can(radii, said):
    scene, fresh, op = cheap()
    wrong = at(op, *radii)
    for call in (lambda op: advance(scene, op, fresh, 1.0), lambda op: solve(scene, op, fresh)):
        with pytest.raises(OperatingPointError, match=said) as error:
            call(wrong)
    allowed = [float(number) for number in re.findall(r"(?:most|least) (\S+) m and (\S+) m", str(error.value))[0]]
    assert allowed[0] / allowed[1] == approx(radii[0] / radii[1], rel=0.01)
    inside, outside = ([factor * radius for radius in allowed] for factor in _either_side(radii, allowed))
    assert scene.refusal(at(op, *inside)) == ""
    assert scene.refusal(at(op, *outside)) != ""
    assert scene.refusal(replace(wrong, load=0.0)) == ""


def _either_side(radii, allowed):
    return (0.98, 1.02) if radii[0] > allowed[0] else (1.02, 0.98)


def test_the_load_is_not_blamed_on_radii_that_ease_it():
    scene, _, op = cheap()
    heavy = replace(op, load=400.0)
    hertz = scene.hertz_at(heavy)
    assert scene.film.domain < 2.4 * hertz.a
    assert scene.refusal(at(heavy, 9.9e-3)) == scene.refusal(heavy) == ""
    assert scene.refusal(at(heavy, 10.1e-3)) != ""


def test_the_regression_level_needs_no_grid_but_bodies_that_do_not_yield():
    scene, fresh, op = at_level("regression")
    assert advance(scene, at(op, 50e-3), fresh, 1.0)[1].approach > 0.0
    with pytest.raises(OperatingPointError, match="Lower the load or enlarge the radii"):
        advance(scene, at(op, 0.2e-3), fresh, 1.0)


def test_the_regression_level_goes_on_from_patches_and_back_under_other_radii():
    scene, state, op = settled()
    state, before = advance(scene, op, state, 20.0)
    quick = scene.at_level("regression")
    quickly, told = advance(quick, at(op, 7e-3), state, 0.0)
    assert told.tribofilm_2 == approx(before.tribofilm_2, rel=1e-12)
    slowly, after = advance(scene, at(op, 7e-3), quickly, 0.0)
    for body, same in zip(state.bodies, slowly.bodies, strict=True):
        np.testing.assert_array_equal(body.growth, same.growth)
        np.testing.assert_array_equal(body.wear, same.wear)
    assert after.approach == approx(scene.hertz_at(at(op, 7e-3)).approach, rel=0.1)


def test_a_scenes_state_is_its_own_whatever_the_radii_were():
    scene = Scene.from_toml("mtm_zddp").at_level("regression")
    state, _ = advance(scene, at(scene.operation.point, 7e-3), initial_state(scene), 10.0)
    data = state.to_bytes()
    assert ContactState.from_bytes(data, scene).to_bytes() == data
