"""Motion in ball bearings against vectors in space and race control."""

import math

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import quad

from system_models.machines.ball_bearing import kinematics
from system_models.machines.ball_bearing.equilibrium import RingLoads, solve
from system_models.machines.ball_bearing.geometry import BEARING_218
from system_models.machines.ball_bearing.kernels import rolling

ANGLES = [(0.7, 0.7), (0.9, 0.3), (1.1, 0.05), (-0.6, -0.4), (0.0, 0.0)]
RATIO, MUCH = 0.18, 1e9


@pytest.mark.parametrize(("inner", "outer"), ANGLES)
def test_race_control_is_the_limit(inner, outer):
    """Orbit by outer and by inner race control, in the textbook's form."""
    both = 1.0 + math.cos(inner - outer)
    by_outer = (1.0 - RATIO * math.cos(inner)) / both
    by_inner = (math.cos(inner - outer) - RATIO * math.cos(outer)) / both
    orbit, _, tilt, _, _, _, spin = rolling(inner, outer, 1.0, MUCH, RATIO)
    assert orbit == approx(by_outer, rel=1e-12)
    assert math.tan(tilt) == approx(math.sin(outer) / (math.cos(outer) + RATIO), rel=1e-12)
    assert spin == approx(0.0, abs=1e-14)
    orbit, _, tilt, _, _, spin, _ = rolling(inner, outer, MUCH, 1.0, RATIO)
    assert orbit == approx(by_inner, rel=1e-12)
    assert math.tan(tilt) == approx(math.sin(inner) / (math.cos(inner) - RATIO), rel=1e-12)
    assert spin == approx(0.0, abs=1e-14)


def velocities(inner, outer, held, y=0.0, groove=0.52):
    """Velocity of ball less race across the contact's centre line at a distance `y` (in ball diameters), and their
    relative angular velocities, in a frame that turns with the cage at an angular speed 1 of the inner ring; axes:
    axial, radial, tangential. The ball's diameter is 1, the pitch diameter 1 / RATIO.
    """
    orbit, roll, tilt, *_ = rolling(inner, outer, *held, RATIO)
    ball = -roll * np.array([math.cos(tilt), -math.sin(tilt), 0.0])
    centre = np.array([0.0, 0.5 / RATIO, 0.0])
    curved = 2.0 * groove / (2.0 * groove + 1.0)  # radius of the deformed groove
    found = []
    for angle, side, race in ((inner, -1.0, 1.0 - orbit), (outer, 1.0, -orbit)):
        normal = side * np.array([math.sin(angle), math.cos(angle), 0.0])
        across = np.array([math.cos(angle), -math.sin(angle), 0.0])
        arm = (0.5 - curved + math.sqrt(curved**2 - y**2)) * normal + y * across
        ring = race * np.array([1.0, 0.0, 0.0])
        slip = np.cross(ball, arm) - np.cross(ring, centre + arm)
        found.append((slip, ball - ring, normal * side))
    return found


@pytest.mark.parametrize(("inner", "outer"), ANGLES)
@pytest.mark.parametrize("held", [(1.0, 2.0), (1.3, 1.0), (1.0, 1.0), (0.0, 1.0)])
def test_balls_do_not_slip_at_the_centres_and_spin_as_told(inner, outer, held):
    *_, spin_inner, spin_outer = rolling(inner, outer, *held, RATIO)
    for (slip, relative, outward), spin in zip(velocities(inner, outer, held), (spin_inner, spin_outer), strict=True):
        assert slip == approx(np.zeros(3), abs=1e-14)
        assert relative @ outward == approx(spin, rel=1e-12, abs=1e-13)


@pytest.mark.parametrize(("inner", "outer"), ANGLES)
def test_sliding_bends_across_the_contact_as_the_square_of_the_distance(inner, outer):
    """Ball less race at y is spin times y plus -bend y^2, up to the fourth power of y over the groove's radius."""
    held, groove = (1.0, 1.5), 0.52
    _, _, _, roll_inner, roll_outer, *_ = rolling(inner, outer, *held, RATIO)
    for i, roll in enumerate((roll_inner, roll_outer)):
        bend = 0.5 * roll * 0.5 * (1.0 / groove + 2.0)
        for y in (0.02, 0.01):
            there, here, back = (velocities(inner, outer, held, y=s * y)[i][0][2] for s in (1.0, 0.0, -1.0))
            bent = 0.5 * (there + back) - here
            sense = -1.0 if i == 0 else 1.0  # the ball's surface runs the other way past the outer race
            assert abs(bent) == approx(bend * y**2, rel=2.0 * y**2)
            assert sense * bent * roll > 0.0


def pressed(of):
    return 1.5 * quad(lambda s: (1.0 - s * s) * of(s), 0.0, 1.0, epsabs=1e-13, points=[kinematics.NEUTRAL_COULOMB])[0]


def test_shares_of_differential_sliding_are_those_of_no_net_force():
    coulomb = kinematics.NEUTRAL_COULOMB
    assert pressed(lambda s: math.copysign(1.0, s - coulomb)) == approx(0.0, abs=1e-12)
    assert pressed(lambda s: abs(s * s - coulomb**2)) == approx(kinematics.SLIDE_COULOMB, rel=1e-12)
    assert (coulomb, kinematics.SLIDE_COULOMB) == approx((0.347, 0.161), abs=5e-4)


def test_spin_is_shared_near_race_control_at_little_more_power():
    """Coulomb spin power, held moment times spin, over the least, that of control by the race that is held more."""
    worst = 0.0
    for share in np.geomspace(0.1, 10.0, 81):
        *_, spin_inner, spin_outer = rolling(0.7, 0.7, share, 1.0, RATIO)
        power = share * abs(spin_inner) + abs(spin_outer)
        controlled = []
        for held in ((1.0, MUCH), (MUCH, 1.0)):
            *_, one, other = rolling(0.7, 0.7, *held, RATIO)
            controlled.append(share * abs(one) + abs(other))
        worst = max(worst, power / min(controlled))
    assert 1.05 < worst < 1.09


def test_motion_of_an_angular_contact_bearing_is_that_of_its_equilibrium():
    found = solve(BEARING_218, RingLoads(x=17800.0), 0.0)
    race = BEARING_218.inner
    moving = kinematics.motion(BEARING_218, found, "inner")
    angle, bend = found.angle_inner[0], moving.bend[0]
    track = 0.5 * BEARING_218.pitch_diameter * (1.0 - BEARING_218.ratio * math.cos(angle))
    assert moving.entrainment[0] == approx((1.0 - found.cage) * track, rel=1e-7)
    b = race.ellipse(found.load_inner[0]).b
    slide = kinematics.SLIDE_COULOMB * bend * b**2 / moving.entrainment[0]
    assert 0.001 < slide < 0.02
    # both contacts share the ring's spin about their normal
    spin = abs(moving.spin[0]) + abs(kinematics.motion(BEARING_218, found, "outer").spin[0])
    assert spin == approx(math.sin(angle), rel=1e-12)
