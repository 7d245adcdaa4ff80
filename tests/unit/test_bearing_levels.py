import math

import numpy as np
import pytest

from system_models.bearing.equilibrium import RingLoads, solve
from system_models.bearing.geometry import BEARING_209, BEARING_218
from system_models.bearing.kinematics import motion
from system_models.bearing.levels import classify, memberships, track_lengths

LOADS = np.array([4526.6, 2840.6, 2840.6, 61.4, 61.4, 0.0, 0.0, 900.0, 1508.9])
LEVELS = (1, 2, 3, 5, 9)


def classes(bearing, loads, speed, race, levels):
    found = solve(bearing, loads, speed)
    carried = found.load_inner if race == "inner" else found.load_outer
    moving = motion(bearing, found, race)
    return classify(bearing, bearing.race(race), carried, moving, levels), carried, moving


@pytest.mark.parametrize("levels", LEVELS)
def test_classes_carry_the_load_of_the_balls(levels):
    shares = memberships(LOADS, levels)
    nodes = LOADS.max() * np.arange(1, levels + 1) / levels
    assert nodes @ shares == pytest.approx(LOADS, rel=1e-12)  # of every ball, so of all
    assert np.all(shares >= 0.0)
    assert np.all(shares.sum(axis=0) <= 1.0 + 1e-12)
    assert shares.sum(axis=0)[nodes[0] <= LOADS] == pytest.approx(1.0)
    assert np.all(memberships(np.zeros(4), levels) == 0.0)


def test_more_levels_make_other_sums_better():
    for power, least in ((4.0 / 3.0, 4.0), (5.0 / 3.0, 4.0)):
        errors = []
        for levels in (1, 2, 4, 8):
            nodes = LOADS.max() * np.arange(1, levels + 1) / levels
            errors.append(nodes**power @ memberships(LOADS, levels).sum(axis=1) / (LOADS**power).sum() - 1.0)
        assert errors == sorted(errors, reverse=True)
        assert errors[-1] >= 0.0  # what bends upward is too large
        assert errors[0] / errors[-1] > least


def test_equal_balls_are_one_class():
    found, carried, moving = classes(BEARING_218, RingLoads(x=17800.0), 500.0, "inner", 3)
    assert found.count == pytest.approx((0.0, 0.0, 16.0), abs=1e-9)
    assert found.load[2] == pytest.approx(carried[0], rel=1e-12)
    assert found.spin == pytest.approx(abs(moving.spin[0]), rel=1e-9)  # also of the classes without balls
    assert found.entrainment == pytest.approx(moving.entrainment[0], rel=1e-9)
    b = BEARING_218.inner.ellipse(carried[0]).b
    assert found.sliding[2] == pytest.approx(0.16114 * moving.bend[0] * b**2, rel=1e-4)
    assert found.sliding[0] == pytest.approx(found.sliding[2] * 3.0 ** (-2 / 3), rel=1e-9)
    assert found.ring - found.ball == pytest.approx(found.sliding)


@pytest.mark.parametrize("race", ["inner", "outer"])
def test_classes_go_continuously_with_the_load(race):
    """Counts, loads and speeds of classes that have balls change by less than a per mille where the load does."""
    before, *_ = classes(BEARING_209, RingLoads(y=1000.0), 300.0, race, 3)
    for load in 1000.0 * 1.0001 ** np.arange(1, 60):
        now, *_ = classes(BEARING_209, RingLoads(y=load), 300.0, race, 3)
        for name in ("load", "count", "entrainment", "sliding", "radius_x"):
            one, other = getattr(before, name), getattr(now, name)
            assert np.abs(other - one).max() < 1e-3 * max(np.abs(one).max(), 1e-9)
        before = now


def test_all_passes_of_the_inner_ring_are_in_some_class():
    """Passes a second of a point, speed over track length, of all classes together: those of the balls that touch."""
    found = solve(BEARING_209, RingLoads(x=3000.0, y=1000.0), 300.0)
    moving = motion(BEARING_209, found, "inner")
    sorted_in = classify(BEARING_209, BEARING_209.inner, found.load_inner, moving, 4)
    assert np.all(found.load_inner > found.load_inner.max() / 4.0)
    ways = track_lengths(BEARING_209, BEARING_209.inner, sorted_in.count, moving)
    present = sorted_in.count > 0.01
    ring = sum(speed / way for speed, (_, way), here in zip(sorted_in.ring, ways, present, strict=True) if here)
    met = BEARING_209.balls * (1.0 - found.cage) / (2.0 * math.pi)  # per angular speed
    assert ring == pytest.approx(met, rel=0.02)  # gross slip is none, differential sliding little
    ball = sum(speed / way for speed, (way, _), here in zip(sorted_in.ball, ways, present, strict=True) if here)
    assert ball == pytest.approx(found.rolling[:, 1].mean() / (2.0 * math.pi), rel=0.02)


def test_a_place_of_the_outer_ring_meets_every_ball():
    found = solve(BEARING_209, RingLoads(y=8900.0), 300.0)
    moving = motion(BEARING_209, found, "outer")
    ways = track_lengths(BEARING_209, BEARING_209.outer, np.array([2.0, 1.0, 0.0]), moving)
    assert [way for _, way in ways] == pytest.approx([math.pi * (65e-3 + 12.7e-3) / 9.0] * 3, rel=1e-12)
    # a ball meets the class once in 9 / count turns, at least in 900
    assert [way for way, _ in ways] == pytest.approx([math.pi * 12.7e-3 * n for n in (4.5, 9.0, 900.0)], rel=1e-4)
