"""Closed forms and formulas of textbooks that only tests compare with."""

import math

import numpy as np
import scipy

from contact_core.reference import Hertz, SmoothContact
from system_models.machines.gear_pair.geometry import SpurGearPair
from system_models.machines.gear_pair.path import Numbers, surface_speeds


def palmgren_approach(load: float, length: float, reduced_modulus: float) -> float:
    """Return the approach [m] of a crowned roller and a raceway, 1.36 (2 load / E')^0.9 / length^0.8, load in N.

    A fit to measurements, in which the radii do not appear; for steel it is 3.84e-5 load^0.9 / length^0.8 in mm.
    Source: Palmgren, Ball and Roller Bearing Engineering, 3rd ed., 1959, in the form of Eschmann, Hasbargen & Weigand,
    Ball and Roller Bearings, 1985.
    """
    return 1.36 * (2.0 * load / reduced_modulus) ** 0.9 / length**0.8


def brewe_hamrock(load: float, radius_x: float, radius_y: float, reduced_modulus: float) -> Hertz:
    """Return the contact of `hertz_point` by powers and logarithms in place of elliptic integrals, as a check.

    With the ratio r > 1 of the radii: long over short half width 1.0339 r^0.636, E = 1.0003 + 0.5968 / r, K = 1.5277 +
    0.6023 ln r.

    For radii in a ratio of up to 100 half widths are within 4.5 % of the exact ones, the pressure within 2.5 %, the
    approach within 5.5 %, least sure near the circle; half widths and pressure are within 2 % from 1.3 to 50.
    Source: Brewe & Hamrock, J. Lubr. Technol. 99 (1977) 485, doi:10.1115/1.3453245.
    """
    small, large = sorted((radius_x, radius_y))
    ratio, curvature = large / small, 1.0 / small + 1.0 / large
    k = 1.0339 * ratio**0.636  # long half width over the short one
    ellipe, ellipk = 1.0003 + 0.5968 / ratio, 1.5277 + 0.6023 * math.log(ratio)
    long = (6.0 * k * k * ellipe * load / (math.pi * reduced_modulus * curvature)) ** (1 / 3)
    approach = ellipk * (4.5 * curvature / ellipe * (load / (math.pi * k * reduced_modulus)) ** 2) ** (1 / 3)
    a, b = (long / k, long) if radius_x == small else (long, long / k)
    return Hertz(a, b, 1.5 * load / (math.pi * a * b), approach)


def chittenden(contact: SmoothContact) -> tuple[float, float]:
    """Return central and minimum film thickness [m] of ellipses with either axis along the entrainment.

    h / R_x = C U^0.68 G^0.49 W^-0.073 {1 - exp[-d (R_y / R_x)^(2/3)]}, with C = 4.31 and d = 1.23 for h_c, 3.68 and
    0.67 for h_min; U, G and W as in `hamrock_dowson`.

    Source: Chittenden, Dowson, Dunn & Taylor, Proc. R. Soc. A 397 (1985) 245 and 271.
    """
    speed = contact.viscosity * contact.entrainment_speed / (contact.reduced_modulus * contact.radius_x)
    material = contact.pressure_coefficient * contact.reduced_modulus
    load = contact.load / (contact.reduced_modulus * contact.radius_x**2)
    unleaked = speed**0.68 * material**0.49 * load**-0.073 * contact.radius_x
    width = (contact.radius_y / contact.radius_x) ** (2 / 3)
    return (
        4.31 * unleaked * (1.0 - math.exp(-1.23 * width)),
        3.68 * unleaked * (1.0 - math.exp(-0.67 * width)),
    )


def lundberg_depth(load: float, length: float, reduced_modulus: float) -> float:
    """Return the depth [m] of the logarithmic drop that spreads a load [N] evenly, 2 load / (pi E' length)."""
    return 2.0 * load / (math.pi * reduced_modulus * length)


# Rigid bodies that approach each other through oil of constant viscosity, the gap between them full of it: with
# p = c / h^2 Reynolds' equation is met by every parabolic gap, so these are exact for thin films. Receding bodies
# have the same forces with the other sign, if the oil bears tension.


def squeeze_point(speed: float, gap: float, radius_x: float, radius_y: float, viscosity: float) -> float:
    """Return the force [N] that opposes an approach at a speed [m/s] at a smallest gap [m].

    Radii [m], viscosity eta [Pa s].

    12 pi eta V sqrt(R_x R_y) / [(1 / R_x + 1 / R_y) h_0]; of a ball on a plane 6 pi eta V R^2 / h_0.
    Source: ball: Brenner, Chem. Eng. Sci. 16 (1961) 242, doi:10.1016/0009-2509(61)80035-3, near the wall.
    """
    curvature = 1.0 / radius_x + 1.0 / radius_y
    return 12.0 * math.pi * viscosity * speed * math.sqrt(radius_x * radius_y) / (curvature * gap)


def squeeze_line(speed: float, gap: float, radius: float, viscosity: float) -> float:
    """Return the force per length [N/m] that opposes the approach of a cylinder to a plane.

    It is 3 sqrt(2) pi eta V (R / h_0)^1.5.
    """
    return 3.0 * math.sqrt(2.0) * math.pi * viscosity * speed * (radius / gap) ** 1.5


def squeezed_point(time: float, gap: float, load: float, radius_x: float, radius_y: float, viscosity: float) -> float:
    """Return the smallest gap [m] after a time [s] under a constant load [N], from `gap` [m] on: an exponential."""
    return gap * math.exp(-load * time / (gap * squeeze_point(1.0, gap, radius_x, radius_y, viscosity)))


def squeezed_line(time: float, gap: float, load: float, radius: float, viscosity: float) -> float:
    """Return the smallest gap [m] under a cylinder after a time [s], from `gap` [m] on.

    The load per length [N/m] is constant.
    """
    speed = load / squeeze_line(1.0, gap, radius, viscosity)
    return gap / (1.0 + 0.5 * speed * time / gap) ** 2


def jaeger_band(x: float, peclet: float) -> float:
    """Return the steady rise under a band of uniform flux q, endless across, at x in half widths downstream.

    x is zero at the centre. In units of q b / K, b half width; peclet = u b / (2 k).
    Source: Jaeger, Proc. R. Soc. N. S. W. 76 (1942) 203.
    """
    k0e, k1e = scipy.special.k0e, scipy.special.k1e

    def integral(v: float) -> float:  # of exp(w) K0(|w|) from w = 0 to v, in closed form
        if v == 0.0:
            return 0.0
        if v > 0.0:
            return float(v * (k0e(v) + k1e(v)) - 1.0)
        return float(-1.0 - v * np.exp(2.0 * v) * (k1e(-v) - k0e(-v)))

    return (integral(peclet * (x + 1.0)) - integral(peclet * (x - 1.0))) / (np.pi * peclet)


def sjovall(extent: float) -> tuple[float, float]:
    """Return the radial and axial load integral J_r, J_a of point contacts for an extent epsilon > 0 of the load zone.

    J_r = (1 / pi) times the integral of [1 - (1 - cos(psi)) / (2 epsilon)]^1.5 cos(psi) over psi, J_a without cos(psi).

    With many balls the most loaded one carries F_r / (Z J_r cos a) = F_a / (Z J_a sin a).
    Source: Sjovall, Teknisk Tidskrift (1933), in the form of Harris & Kotzalas, Essential Concepts of Bearing
    Technology, 5th ed., 2006, chapter 7.
    """
    last = math.acos(1.0 - 2.0 * extent) if extent < 1.0 else math.pi

    def carried(angle: float) -> float:
        return float(max(1.0 - (1.0 - math.cos(angle)) / (2.0 * extent), 0.0) ** 1.5)

    quad = scipy.integrate.quad
    radial, _ = quad(lambda angle: carried(angle) * math.cos(angle), 0.0, last, epsabs=1e-12)
    axial, _ = quad(carried, 0.0, last, epsabs=1e-12)
    return radial / math.pi, axial / math.pi


def blok_line(
    load: float, length: float, friction: float, speed_1: float, speed_2: float, half_width: float, effusivity: float
) -> float:
    """Return the largest flash temperature rise [K] of a line contact moving fast over both bodies, of one material.

    1.11 mu w |sqrt(u_1) - sqrt(u_2)| / [B sqrt(2 a)], w being the load per length and B the effusivity.

    load [N] on a length [m], coefficient of friction, surface speeds [m/s], Hertz's half width [m], effusivity
    sqrt(conductivity * density * heat capacity) [W s^0.5 / (m2 K)]. The factor is that of Hertz's pressure, and heat
    goes to each body so that both become equally hot.
    Source: Blok, Proc. General Discussion on Lubrication, IMechE 1937, vol. 2, p. 222.
    """
    rubbing = friction * load / length * abs(math.sqrt(abs(speed_1)) - math.sqrt(abs(speed_2)))
    return 1.11 * rubbing / (effusivity * math.sqrt(2.0 * half_width))


def slide_to_roll(pair: SpurGearPair, position: Numbers) -> Numbers:
    """Return 2 (u1 - u2) / (u1 + u2) of gears in mesh."""
    first, second = surface_speeds(pair, position, pair.ratio, 1.0)
    return 2.0 * (first - second) / (first + second)
