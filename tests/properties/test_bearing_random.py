"""Ball bearings under any loads and speeds: they come to rest, in balance with their loads."""

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from system_models.machines.ball_bearing.equilibrium import RingLoads, solve
from system_models.machines.ball_bearing.geometry import BEARING_209, BEARING_218
from system_models.machines.ball_bearing.kinematics import motion
from system_models.machines.ball_bearing.load_classes import classify

BEARINGS = st.sampled_from([BEARING_209, BEARING_218])


def sizes(largest):
    """Zero, or any size over five decades, of either sign."""
    some = st.builds(
        lambda sign, decades: sign * largest * 10.0**-decades, st.sampled_from([-1.0, 1.0]), st.floats(0, 5)
    )
    return st.one_of(st.just(0.0), some)


LOADS = st.builds(RingLoads, sizes(1e4), sizes(2e4), sizes(2e4), sizes(200.0), sizes(200.0))
SPEEDS = st.one_of(st.just(0.0), st.floats(-1048.0, 1048.0))


@given(BEARINGS, LOADS, SPEEDS)
def test_any_bearing_comes_to_rest_in_balance(bearing, loads, speed):
    found = solve(bearing, loads, speed)
    assert found.converged
    again = solve(bearing, loads, speed, found.start)
    assert again.converged
    assert np.abs(again.load_outer - found.load_outer).max() <= 1e-7 * max(found.load_outer.max(), 1.0)
    radial = np.stack([np.cos(found.azimuth), np.sin(found.azimuth)])
    axial, outward = (found.load_inner * f(found.angle_inner) for f in (np.sin, np.cos))
    carried = np.array([axial.sum(), *(radial @ outward), *(radial[::-1] @ axial) * np.array([1.0, -1.0])])
    carried[3:] *= bearing.groove_centre_radius
    largest = max(np.abs(loads).max(), found.load_outer.max(), 1.0)
    assert np.abs(carried - loads).max() <= 1e-8 * largest + 1e-4
    assert np.all(found.load_inner >= 0.0)
    assert np.all(found.load_outer >= 0.0)


def hardly(largest):
    """Zero, or next to nothing down to the smallest number there is."""
    some = st.builds(
        lambda sign, decades: sign * largest * 10.0**-decades, st.sampled_from([-1.0, 1.0]), st.floats(5, 330)
    )
    return st.one_of(st.just(0.0), some)


def rocking(loads, speed):
    """Whether next to nothing but a moment holds a ring at rest: its balance is not found, which `residual` says."""
    return max(abs(loads.x), abs(loads.y), abs(loads.z), abs(speed)) < 1e-3


PAUSES = st.builds(RingLoads, hardly(1e4), hardly(2e4), hardly(2e4), hardly(200.0), hardly(200.0))


@given(BEARINGS, st.lists(st.tuples(PAUSES, hardly(1e3)), max_size=4), LOADS, st.floats(1.0, 1048.0))
def test_a_bearing_is_after_any_pause_as_it_was_before(bearing, pauses, loads, speed):
    before = solve(bearing, loads, speed)
    start = before.start
    for now in pauses:
        found = solve(bearing, *now, start)
        assert found.converged or rocking(*now)
        assert np.isfinite(found.load_inner).all()
        start = found.start
    after = solve(bearing, loads, speed, start)
    assert np.abs(after.load_outer - before.load_outer).max() <= 1e-7 * max(before.load_outer.max(), 1.0)


@given(BEARINGS, LOADS, SPEEDS, st.integers(0, 20), st.sampled_from([math.nan, math.inf, -1e9, 1e7, 0.5]))
def test_a_start_that_cannot_be_is_left_for_none(bearing, loads, speed, place, spoilt):
    start = list(solve(bearing, loads, speed).start)
    start[place] = spoilt
    found, right = solve(bearing, loads, speed, tuple(start)), solve(bearing, loads, speed)
    assert found.converged
    assert np.abs(found.load_outer - right.load_outer).max() <= 1e-7 * max(right.load_outer.max(), 1.0)


@given(BEARINGS, LOADS, SPEEDS, st.sampled_from([1, 2, 3, 5]))
def test_classes_are_contacts_that_can_be_solved_and_carry_what_the_balls_carry(bearing, loads, speed, levels):
    found = solve(bearing, loads, speed)
    for race, carried in (("inner", found.load_inner), ("outer", found.load_outer)):
        c = classify(bearing, bearing.race(race), carried, motion(bearing, found, race), levels)
        # each ball is a cloud of half width 1e-4, and counts on the outer race as if it carried a billionth of the
        # largest load: parts of some 1e-8; a single class has two of the three sums that loads would ask for
        if levels > 1:
            assert math.isclose(c.count @ c.load, carried.sum(), rel_tol=3e-8, abs_tol=0.0)
        assert c.count.sum() <= bearing.balls * (1.0 + 1e-8)
        for values in (c.entrainment, c.sliding, c.spin, c.radius_x):
            assert np.all(np.isfinite(values))
        assert np.all(c.radius_x > 0.2 * bearing.ball_diameter)
        assert np.all(np.abs(c.spin) < 10.0)
