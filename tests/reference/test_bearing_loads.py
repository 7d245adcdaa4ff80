"""Loads in ball bearings against textbook examples, closed forms, and sums of forces that share nothing with them."""

import math

import numpy as np
import pytest
from comparison import approx
from scipy.optimize import brentq

from system_models.machines.ball_bearing.equilibrium import RingLoads, solve
from system_models.machines.ball_bearing.geometry import BEARING_209, BEARING_218
from system_models.machines.ball_bearing.kinematics import motion

MM = 10**4.5  # N/m^1.5 per N/mm^1.5
RPM = math.pi / 30.0


@pytest.mark.parametrize(
    ("race", "total", "difference", "stiffness"),
    [("inner", 201.78, 0.93996, 1.0184e6), ("outer", 137.80, 0.91209, 1.0766e6)],
)
def test_curvatures_and_stiffness_of_the_209(race, total, difference, stiffness):
    shape = BEARING_209.race(race)
    assert shape.curvature_sum == approx(total, rel=5e-5)
    assert (1.0 / shape.radius_x - 1.0 / shape.radius_y) / shape.curvature_sum == approx(difference, rel=1e-5)
    assert shape.stiffness == approx(stiffness * MM, rel=1e-4)


def test_play_of_the_209_and_stiffness_of_both_bearings():
    assert BEARING_209.stiffness == approx(3.701e5 * MM, rel=1e-4)
    assert math.degrees(BEARING_209.free_angle) == approx(9.858, abs=1e-3)
    endplay = 2.0 * BEARING_209.separation * math.sin(BEARING_209.free_angle)
    assert endplay == approx(0.1739e-3, rel=5e-4)
    assert BEARING_218.stiffness == approx(4.659e5 * MM, rel=5e-4)
    assert BEARING_218.separation == approx(1.0312e-3, rel=5e-5)


def test_the_209_under_8900_newton():
    found = solve(BEARING_209, RingLoads(y=8900.0), 0.0)
    assert found.converged
    assert found.load_inner == approx([4526.6, 2840.6, 61.4, 0.0, 0.0, 0.0, 0.0, 61.4, 2840.6], rel=5e-4)
    assert found.load_outer == approx(found.load_inner, rel=1e-12)
    assert found.displacement[1] == approx(0.06058e-3, rel=1e-4)
    extent = 0.5 * (1.0 - BEARING_209.clearance / (2.0 * found.displacement[1]))
    assert extent == approx(0.438, abs=5e-4)
    for race, long, short, pressure in (("inner", 2.548, 0.2744, 3091.0), ("outer", 2.471, 0.3387, 2582.0)):
        ellipse = BEARING_209.race(race).ellipse(found.load_inner.max())
        assert (ellipse.b * 1e3, ellipse.a * 1e3, ellipse.pressure_max * 1e-6) == approx(
            (long, short, pressure), rel=3e-4
        )


def test_the_218_under_a_thrust_of_17800_newton():
    found = solve(BEARING_218, RingLoads(x=17800.0), 0.0)
    assert np.degrees(found.angle_inner) == approx(41.50, abs=5e-3)
    assert found.load_inner == approx(1679.0, rel=1e-4)
    assert found.displacement[0] == approx(0.0360e-3, rel=1e-3)
    for race, pressure in (("inner", 1525.0), ("outer", 1348.0)):
        assert BEARING_218.race(race).ellipse(1679.0).pressure_max * 1e-6 == approx(pressure, rel=5e-3)


@pytest.mark.parametrize("bearing", [BEARING_209, BEARING_218])
@pytest.mark.parametrize("thrust", [10.0, 1000.0, 10000.0])
def test_thrust_makes_the_contact_angle_of_the_closed_form(bearing, thrust):
    """F_a / (Z K_n A^1.5) = sin a (cos a0 / cos a - 1)^1.5 with the free angle a0."""
    scale, free = bearing.balls * bearing.stiffness * bearing.separation**1.5, bearing.free_angle

    def missing(angle):
        return math.sin(angle) * (math.cos(free) / math.cos(angle) - 1.0) ** 1.5 - thrust / scale

    found = solve(bearing, RingLoads(x=thrust), 0.0)
    assert found.angle_inner == approx(brentq(missing, free, 1.5, xtol=1e-14), rel=1e-8)
    assert found.tilt == approx((0.0, 0.0), abs=1e-12)


def balance(bearing, loads, speed, found):
    """Forces left over on the ring [N, N m], on the balls [N], and gaps of their chains of contacts [m].

    By vectors in space, Hertz's ellipses and Newton's law; nothing of the solver but its answer.
    """
    x, mass, diameter = np.array([1.0, 0.0, 0.0]), bearing.mass, bearing.ball_diameter
    radial = np.stack([np.zeros(bearing.balls), np.cos(found.azimuth), np.sin(found.azimuth)], axis=1)

    def direction(angle):
        return np.sin(angle)[:, None] * x + np.cos(angle)[:, None] * radial

    def stretch(race, loads):
        return np.array([race.ellipse(load).approach if load > 0.0 else 0.0 for load in loads])

    inner, outer = direction(found.angle_inner), direction(found.angle_outer)
    pull = found.load_inner[:, None] * inner
    arms = bearing.groove_centre_radius * radial
    ring = np.array(loads[:3]) - pull.sum(axis=0)
    moments = np.array([0.0, *loads[3:]]) - np.cross(arms, pull).sum(axis=0)

    orbit = found.cage * speed
    centrifugal = mass * 0.5 * bearing.pitch_diameter * orbit**2 * radial
    # gyroscopic: rate of change of the spin's angular momentum, supplied by a force tangential to the outer race, on
    # which the ball does not spin
    tilt = np.arctan2(np.sin(found.angle_outer), np.cos(found.angle_outer) + bearing.ratio)
    axis = np.cos(tilt)[:, None] * x - np.sin(tilt)[:, None] * radial
    contact_speed = orbit * (0.5 * bearing.pitch_diameter + 0.5 * diameter * np.cos(found.angle_outer))
    roll = contact_speed / (0.5 * diameter * np.cos(found.angle_outer - tilt))
    momentum = -0.1 * mass * diameter**2 * roll[:, None] * axis
    needed = np.cross(orbit * x, momentum)
    friction = np.cross(needed, outer) / (0.5 * diameter)
    balls = pull - found.load_outer[:, None] * outer + centrifugal + friction

    turn = np.array([0.0, *found.tilt])
    moved = np.array(found.displacement) + np.cross(turn, arms)
    start = bearing.groove_centre[0] * x + bearing.groove_centre[1] * radial
    reach_inner = bearing.inner.groove - 0.5 * diameter + stretch(bearing.inner, found.load_inner)
    reach_outer = bearing.outer.groove - 0.5 * diameter + stretch(bearing.outer, found.load_outer)
    chain = reach_outer[:, None] * outer + reach_inner[:, None] * inner
    across = start + moved - (moved * np.cross(x, radial)).sum(axis=1)[:, None] * np.cross(x, radial)
    gap = np.linalg.norm(chain - across, axis=1)[(found.load_inner > 0.0) & (found.load_outer > 0.0)]
    return ring, moments[1:], balls[found.load_outer > 0.0], gap


CASES = [
    (BEARING_209, RingLoads(y=8900.0), 0.0),
    (BEARING_209, RingLoads(500.0, 2000.0, -700.0, 8.0, -5.0), 3000 * RPM),
    (BEARING_209, RingLoads(moment_y=20.0, moment_z=-3.0), 0.0),
    (BEARING_209, RingLoads(1000.0, 20000.0), 10000 * RPM),
    (BEARING_218, RingLoads(17800.0), 10000 * RPM),
    (BEARING_218, RingLoads(10000.0, 5000.0, 0.0, 50.0, 100.0), 10000 * RPM),
    (BEARING_218, RingLoads(10.0, 20000.0), -6000 * RPM),
]


@pytest.mark.parametrize(("bearing", "loads", "speed"), CASES)
def test_forces_moments_and_gaps_close(bearing, loads, speed):
    found = solve(bearing, loads, speed)
    ring, moments, balls, gap = balance(bearing, loads, speed, found)
    largest = max(np.abs(loads).max(), found.load_outer.max())
    weak = 2e-5  # N: the weak spring that holds the ring where no ball does
    assert np.abs(ring).max() <= 1e-11 * largest + weak
    assert np.abs(moments).max() <= (1e-11 * largest + weak) * bearing.groove_centre_radius
    assert np.abs(balls).max() <= 1e-9 * largest
    assert gap.size > 0
    assert gap.max() <= 1e-14


@pytest.mark.parametrize("angle", [0.3, 2.0 * math.pi / 9.0, -2.5])
@pytest.mark.parametrize("speed", [0.0, 800.0])
def test_a_turned_bearing_under_turned_loads_is_the_same(angle, speed):
    loads, c, s = RingLoads(800.0, 5000.0, -300.0, 4.0, 6.0), math.cos(angle), math.sin(angle)
    turned = RingLoads(
        loads.x,
        c * loads.y - s * loads.z,
        s * loads.y + c * loads.z,
        c * loads.moment_y - s * loads.moment_z,
        s * loads.moment_y + c * loads.moment_z,
    )
    one, other = solve(BEARING_209, loads, speed), solve(BEARING_209, turned, speed, first_ball=angle)
    assert other.load_inner == approx(one.load_inner, rel=1e-11, abs=1e-10)
    assert other.angle_outer == approx(one.angle_outer, rel=1e-11, abs=1e-12)
    y, z = one.displacement[1:]
    assert other.displacement == approx((one.displacement[0], c * y - s * z, s * y + c * z), rel=1e-10)


def test_zero_load_at_speed_presses_balls_on_the_outer_race_only():
    speed = 10000 * RPM
    found = solve(BEARING_209, RingLoads(), speed)
    orbit = 0.5 * (1.0 - BEARING_209.ratio * math.cos(BEARING_209.free_angle)) * speed
    centrifugal = BEARING_209.mass * 0.5 * BEARING_209.pitch_diameter * orbit**2
    assert found.load_outer == approx(centrifugal, rel=1e-12)
    assert np.all(found.load_inner == 0.0)
    assert np.all(found.angle_outer == 0.0)
    assert found.displacement == (0.0, 0.0, 0.0)


def test_nothing_moves_an_unloaded_bearing_at_rest():
    for bearing in (BEARING_209, BEARING_218):
        found = solve(bearing, RingLoads(), 0.0)
        assert found.converged
        assert found.displacement == approx((0.0, 0.0, 0.0), abs=1e-15)
        assert found.load_outer == approx(0.0, abs=1e-15)


@pytest.mark.parametrize(("bearing", "loads", "speed"), CASES)
def test_the_answer_does_not_depend_on_where_the_search_starts(bearing, loads, speed):
    one = solve(bearing, loads, speed)
    for before, at in ((RingLoads(x=5000.0), 0.0), (RingLoads(z=9000.0, moment_y=30.0), 500.0)):
        other = solve(bearing, loads, speed, solve(bearing, before, at).start)
        assert other.load_inner == approx(one.load_inner, rel=1e-10, abs=1e-9)
        assert other.load_outer == approx(one.load_outer, rel=1e-10, abs=1e-9)


def test_a_stiff_shaft_holds_the_tilt():
    loads, stiff = RingLoads(1000.0, 5000.0), 1e7
    free, held = solve(BEARING_209, loads, 0.0), solve(BEARING_209, loads, 0.0, tilt_stiffness=stiff)
    assert abs(held.tilt[1]) < 1e-3 * abs(free.tilt[1])
    _, moments, _, _ = balance(BEARING_209, loads, 0.0, held)
    assert moments == approx(stiff * np.array(held.tilt), rel=1e-6, abs=1e-4)


@pytest.mark.parametrize("bearing", [BEARING_209, BEARING_218])
def test_speed_raises_outer_loads_and_parts_the_angles(bearing):
    found = [solve(bearing, RingLoads(x=2000.0), n * RPM) for n in (0, 3000, 6000, 10000)]
    inner, outer = ([float(f.angle_inner[0]) for f in found], [float(f.angle_outer[0]) for f in found])
    assert inner[0] == approx(outer[0], rel=1e-12)
    assert inner == sorted(inner)
    assert outer == sorted(outer, reverse=True)
    loads = [float(f.load_outer[0]) for f in found]
    assert loads[1:] == sorted(loads[1:])
    for f in found:  # the thrust of each race
        assert f.load_inner @ np.sin(f.angle_inner) == approx(2000.0, rel=1e-9)


def test_slow_bearings_turn_as_epicyclic_gears():
    found, ratio = solve(BEARING_209, RingLoads(y=8900.0), 1e-3), BEARING_209.ratio
    pitch, ball = BEARING_209.pitch_diameter, BEARING_209.ball_diameter
    assert found.cage == approx(0.5 * (1.0 - ratio), rel=1e-7)
    assert found.rolling[0, 1] == approx(pitch / (2.0 * ball) * (1.0 - ratio**2), rel=1e-12)
    for race in ("inner", "outer"):
        moving = motion(BEARING_209, found, race)
        assert moving.entrainment == approx(0.25 * pitch * (1.0 - ratio**2), rel=1e-12)
        assert np.all(moving.spin[found.load_inner > 0.0] == 0.0)
