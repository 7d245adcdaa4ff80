"""Motion of balls and raceways in their contacts.

Every ball rolls without gross slip on both races: at the centre of a contact both surfaces have one speed. The tilt of
its axis lies between those of Jones' outer and inner race control, at which the one or the other contact does not spin:
the contact whose friction resists spin with the smaller moment spins; where the moments are about equal both do, in
shares by the fourth power of the moments. Race control, which jumps from one race to the other, has the least
Coulomb power; this has at most 8.3 % more and is smooth in the loads. A ball takes its own orbit here, as a cage with
play in its pockets allows; only its inertia is that of the common one.

Across the rolling direction a contact is as curved as the deformed groove, with the radius R = 2 f D / (2 f + 1), so
that at y from its centre the surfaces differ by bend (y0^2 - y^2), bend = rolling / (2 R) (Heathcote). No net force is
left where they roll freely, which decides y0. The contact's FMU knows one sliding speed; it is given the mean of
|y0^2 - y^2| bend, weighted with the pressure, which makes the power right for friction that does not depend on speed:
0.161 bend b^2, with y0 = 0.347 b. Friction in proportion to speed would ask for the rms, 0.214 bend b^2. The former is
chosen: ball bearings of 1-3 GPa that slide this much, near 1 % of their speed, shear the oil at stresses that hardly
grow with speed, and solids rub like that too. For a thin oil under light load, where the latter holds, the power of
this sliding is 43 % too low.

Sources: Harris & Kotzalas, Advanced Concepts of Bearing Technology, 5th ed., 2006, chapters 2 and 3; Heathcote, Proc.
Inst. Automob. Eng. 15 (1921) 569, doi:10.1243/PIME_AUTO_1920_015_032_02 (both from memory).
"""

import math
from dataclasses import dataclass

import numpy as np

from contact_core.kernels.arrays import Array

from .equilibrium import Equilibrium
from .geometry import BallBearingGeometry, RaceName

NEUTRAL_COULOMB = 2.0 * math.sin(math.pi / 18.0)  # y0 / b that halves the load: 3 s - s^3 = 1
# mean of |y0^2 - y^2| / b^2, weighted with the pressure
SLIDE_COULOMB = 0.2 - NEUTRAL_COULOMB**2 + 2.0 * NEUTRAL_COULOMB**3 - 0.4 * NEUTRAL_COULOMB**5


@dataclass(frozen=True)
class Motion:
    """Ball on a race, each over the angular speed of the inner ring; arrays [balls]."""

    entrainment: Array  # speed of both surfaces past the contact's centre [m]
    bend: Array  # of the difference of their speeds across the contact: bend (y0^2 - y^2) [1/m]
    spin: Array  # of the ball relative to the race about the normal that points outward [1]
    angle: Array  # contact angle [rad]
    ball_track: Array  # circumference of the circle that the contact runs along on the ball [m]


def motion(geometry: BallBearingGeometry, rest: Equilibrium, race: RaceName) -> Motion:
    """Return the motion of the balls of an equilibrium on a race."""
    _, roll, tilt, rolling_inner, rolling_outer, spin_inner, spin_outer = rest.rolling.T
    if race == "inner":
        groove, angle, rolling, spin = geometry.inner.groove, rest.angle_inner, rolling_inner, spin_inner
    else:
        groove, angle, rolling, spin = geometry.outer.groove, rest.angle_outer, rolling_outer, spin_outer
    circle = 0.5 * geometry.ball_diameter * np.cos(angle - tilt)
    curvature = 0.5 * (1.0 / groove + 2.0 / geometry.ball_diameter)
    return Motion(roll * circle, 0.5 * rolling * curvature, spin, angle, 2.0 * math.pi * circle)
