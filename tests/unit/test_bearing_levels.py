import math

import numpy as np
import pytest
from comparison import approx

from system_models.machines.ball_bearing.equilibrium import RingLoads, solve
from system_models.machines.ball_bearing.geometry import BEARING_209, BEARING_218
from system_models.machines.ball_bearing.kinematics import motion
from system_models.machines.ball_bearing.load_classes import classify, gathered, track_lengths

LOADS = np.array([4526.6, 2840.6, 2840.6, 61.4, 61.4, 0.0, 0.0, 900.0, 1508.9])
LEVELS = (1, 2, 3, 5, 9)
CLOUD = 3.1e-4  # three times the half width of a ball's cloud, which is that of its load


def classes(bearing, loads, speed, race, levels):
    found = solve(bearing, loads, speed)
    carried = found.load_inner if race == "inner" else found.load_outer
    moving = motion(bearing, found, race)
    return classify(bearing, bearing.race(race), carried, moving, levels), carried, moving


@pytest.mark.parametrize("levels", LEVELS)
def test_sums_of_powers_of_the_load_are_those_of_the_balls(levels):
    load, count, _ = gathered(LOADS, levels)
    for third in range(1, 2 * levels + 1):
        exact = (LOADS ** (third / 3.0)).sum()
        assert count @ load ** (third / 3.0) == approx(exact, rel=2e-9 * third**2)
    assert np.all(count >= 0.0)
    assert np.all(load > 0.0)
    assert load.max() <= (1.0 + CLOUD) * LOADS.max()
    assert list(load) == sorted(load)


@pytest.mark.parametrize("levels", LEVELS)
def test_means_over_a_class_are_exact_for_what_goes_with_the_ellipse(levels):
    load, _, weights = gathered(LOADS, levels)
    assert weights.sum(axis=1) == approx(1.0)
    assert np.all(weights >= 0.0)
    assert np.all(weights[:, LOADS == 0.0] == 0.0)
    size = 3.0 + 0.5 * np.cbrt(LOADS)
    assert weights @ size == approx(
        3.0 + 0.5 * np.cbrt(load), rel=1e-4 if levels > 6 else 1e-7
    )  # more classes than loads lie within clouds


def test_as_many_classes_as_different_loads_are_these_loads():
    load, count, _ = gathered(np.array([4526.6, 2840.6, 2840.6, 61.4, 61.4, 0.0, 0.0, 0.0, 0.0]), 3)
    assert load == approx([61.4, 2840.6, 4526.6], rel=1e-6)
    assert count == approx([2.0, 2.0, 1.0], rel=1e-6)


def test_more_levels_make_other_sums_better():
    for power in (0.1, 2.5):
        errors = []
        for levels in (1, 2, 3, 5):
            load, count, _ = gathered(LOADS, levels)
            errors.append(abs(count @ load**power / (LOADS[LOADS > 0.0] ** power).sum() - 1.0))
        assert errors == sorted(errors, reverse=True)
        assert errors[-1] < 0.01 * errors[0]


@pytest.mark.parametrize("levels", LEVELS)
@pytest.mark.parametrize("touching", [1, 2, 16])
def test_equal_balls_make_equal_classes(touching, levels):
    load, count, weights = gathered(np.array([250.0] * touching + [0.0] * (16 - touching)), levels)
    assert load == approx(250.0, rel=CLOUD)
    assert count.sum() == approx(touching, rel=1e-8)
    assert weights[:, :touching] == approx(1.0 / touching)


def test_without_load_there_are_no_balls_in_any_class():
    load, count, weights = gathered(np.zeros(5), 3)
    assert np.all(load == 0.0)
    assert np.all(count == 0.0)
    assert weights == approx(0.2)


def test_classes_of_an_angular_contact_bearing_move_as_its_balls():
    found, carried, moving = classes(BEARING_218, RingLoads(x=17800.0), 500.0, "inner", 3)
    assert found.load == approx(carried[0], rel=CLOUD)
    assert found.count.sum() == approx(16.0, rel=1e-8)
    assert found.spin == approx(abs(moving.spin[0]), rel=1e-9)
    assert found.entrainment == approx(moving.entrainment[0], rel=1e-9)
    b = BEARING_218.inner.ellipse(carried[0]).b
    assert found.sliding == approx(0.16114 * moving.bend[0] * b**2, rel=CLOUD)
    assert found.ring - found.ball == approx(found.sliding)


@pytest.mark.parametrize("race", ["inner", "outer"])
@pytest.mark.parametrize(
    ("bearing", "loads", "speed"),
    [
        (BEARING_209, RingLoads(y=8900.0), 0.0),
        (BEARING_218, RingLoads(x=17800.0), 0.0),
        (BEARING_218, RingLoads(x=17800.0), 1500.0),
    ],
)
def test_a_ball_rolls_in_the_outer_ring_and_on_the_inner_one(bearing, loads, speed, race):
    """Curvatures across the axis of the contact: a ball's, and that of a cone about the bearing's axis, which is hollow
    on the outer race; at the angles to which a fast shaft drives the two contacts apart."""
    found, carried, moving = classes(bearing, loads, speed, race, 2)
    ball, angle = 0.5 * bearing.ball_diameter, moving.angle[carried > 0.0].mean()
    pitch = 0.5 * bearing.pitch_diameter / math.cos(angle)  # from the ball's centre along the normal to the axis
    ring = 1.0 / (pitch - ball) if race == "inner" else -1.0 / (pitch + ball)
    assert found.radius_x == approx(1.0 / (1.0 / ball + ring), rel=1e-3)
    if speed == 0.0:
        assert found.radius_x == approx(bearing.race(race).radius_x, rel=2e-2)


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
    assert np.all(found.load_inner > 0.0)
    sorted_in = classify(BEARING_209, BEARING_209.inner, found.load_inner, moving, 4)
    ways = track_lengths(BEARING_209, BEARING_209.inner, sorted_in.count, moving)
    ring = sum(speed / way for speed, (_, way) in zip(sorted_in.ring, ways, strict=True))
    met = BEARING_209.balls * (1.0 - found.cage) / (2.0 * math.pi)  # per angular speed
    assert ring == approx(met, rel=0.02)  # gross slip is none, differential sliding little
    ball = sum(speed / way for speed, (way, _) in zip(sorted_in.ball, ways, strict=True))
    assert ball == approx(found.rolling[:, 1].mean() / (2.0 * math.pi), rel=0.02)


def test_a_place_of_the_outer_ring_meets_every_ball():
    found = solve(BEARING_209, RingLoads(y=8900.0), 300.0)
    moving = motion(BEARING_209, found, "outer")
    ways = track_lengths(BEARING_209, BEARING_209.outer, np.array([2.0, 1.0, 0.0]), moving)
    assert [way for _, way in ways] == approx([math.pi * (65e-3 + 12.7e-3) / 9.0] * 3, rel=1e-12)
    # a ball meets the class once in 9 / count turns, at least in 900
    assert [way for way, _ in ways] == approx([math.pi * 12.7e-3 * n for n in (4.5, 9.0, 900.0)], rel=1e-4)


def test_classes_of_the_outer_race_stay_as_the_shaft_stops():
    """Balls without load press on it by their centrifugal force only."""
    turning, *_ = classes(BEARING_209, RingLoads(y=4000.0), 1e-3, "outer", 3)
    still, *_ = classes(BEARING_209, RingLoads(y=4000.0), 0.0, "outer", 3)
    assert still.count == approx(turning.count, rel=1e-3)
    assert still.count.sum() == approx(9.0, abs=0.1)
    assert still.load == approx(turning.load, rel=1e-3)
    assert still.load[0] < 1e-5 * still.load[-1]
