"""Rating life of a ball bearing: ISO 281 by its equivalent load, ISO 16281 by the loads of its balls.

The formulas of the standards are in mm, N, rpm and mm2/s; SI goes in and comes out. Lives are in revolutions of the
inner ring, with a survival of 90 %; the load stands still and the inner ring turns.

Sources: ISO 281:2007 and ISO 16281:2025 (formerly ISO/TS 16281:2008), formulas (1) to (13) and of 281 (27) to (33) and
Annex B, by public programs that reproduce them; the factors X, Y, e of ISO 281, Table 3, from memory.
"""

import math
from dataclasses import dataclass

import numpy as np

from contact_core.errors import ContactError
from contact_core.kernels.arrays import Array
from contact_core.quantities import parameter

from .geometry import BallBearingGeometry, RaceName
from .textbook import catalogue_of

MILLION = 1e6  # revolutions that a bearing survives under its rating
TURNING, STANDING = 3.0, 10.0 / 3.0  # exponents of the mean load of balls: ring that turns under the load, at rest
WEIBULL = 10.0 / 9.0  # slope e of the lives of a contact
FATIGUE_PRESSURE = 1.5e9  # Pa: below Hertz's largest pressure of that good steel does not tire, ISO 281, B.3
LEAST_KAPPA, MOST_KAPPA = 0.1, 4.0
LEAST_FACTOR, MOST_FACTOR = 0.1, 50.0  # of a_ISO

# a_ISO = 0.1 [1 - (2.5671 - A / kappa^B)^0.83 (e_C C_u / P)^(1/3)]^-9.3: kappa up to, A, B
_A_ISO = ((0.4, 2.2649, 0.054381), (1.0, 1.9987, 0.19087), (math.inf, 1.9987, 0.071739))

# radial contact: F_a / (Z D^2) [N/mm2], which is f_0 F_a / C_0, e and Y; X = 0.56
_RADIAL = np.array([
    [0.172, 0.345, 0.689, 1.03, 1.38, 2.07, 3.45, 5.17, 6.89],
    [0.19, 0.22, 0.26, 0.28, 0.30, 0.34, 0.38, 0.42, 0.44],
    [2.30, 1.99, 1.71, 1.55, 1.45, 1.31, 1.15, 1.04, 1.00],
])  # fmt: skip
# angular contact: degrees, e, X and Y
_ANGULAR = np.array([
    [20.0, 25.0, 30.0, 35.0, 40.0, 45.0],
    [0.57, 0.68, 0.80, 0.95, 1.14, 1.34],
    [0.43, 0.41, 0.39, 0.37, 0.35, 0.33],
    [1.00, 0.87, 0.76, 0.66, 0.57, 0.50],
])  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Rating:
    """What the rating life is computed with, beside the bearing's dimensions: the table [rating] of its file."""

    contamination: float = parameter(
        "",
        "contamination factor e_C of ISO 281: 0.5 to 0.6 for normal cleanliness below 100 mm",
        least=0.0,
        most=1.0,
        default=0.55,
    )
    dynamic_rating: float = parameter(
        "N", "basic dynamic load rating C_r of the catalogue; 0: by ISO 281 from the dimensions", least=0.0, most=1e8,
        default=0.0,
    )  # fmt: skip

    def of(self, geometry: BallBearingGeometry) -> float:
        """Return the basic dynamic load rating [N] that counts."""
        return self.dynamic_rating or dynamic_rating(geometry)


def load_factor(geometry: BallBearingGeometry) -> float:
    """Return f_c of ISO 281, for N and mm, by the grooves that the bearing has.

    Lundberg & Palmgren's function of the dimensions, with the constant 38.2 that gives the standard's Table 2 within
    0.2 % for grooves of 0.52 of the ball. Source: ISO/TR 1281-1; Harris & Kotzalas 2006, chapter 11 (from memory).
    """
    gamma, inner = _gamma(geometry), geometry.conformity_inner
    share = (1.0 + _races(geometry, 1.04) ** STANDING) ** -0.3
    tracks = gamma**0.3 * (1.0 - gamma) ** 1.39 / (1.0 + gamma) ** (1.0 / 3.0)
    return float(38.2 * share * tracks * (2.0 * inner / (2.0 * inner - 1.0)) ** 0.41)


def dynamic_rating(geometry: BallBearingGeometry) -> float:
    """Return the basic dynamic radial load rating C_r [N] by ISO 281, with b_m = 1.3 of today's steel.

    The life is L10 = 10^6 (C_r / P)^3.
    """
    ball, balls = 1e3 * geometry.ball_diameter, geometry.balls
    grows = ball**1.8 if ball <= 25.4 else 3.647 * ball**1.4
    return float(1.3 * load_factor(geometry) * math.cos(geometry.contact_angle) ** 0.7 * balls ** (2 / 3) * grows)


def equivalent_load(geometry: BallBearingGeometry, radial: float, axial: float) -> float:
    """Return the dynamic equivalent load P [N] of ISO 281 for sizes of radial and axial load [N].

    Raises ContactError for contact angles that the table used here does not have.
    """
    angle = math.degrees(geometry.contact_angle)
    if angle == 0.0:
        per_area = axial / (geometry.balls * (1e3 * geometry.ball_diameter) ** 2)
        least, by_axial = (float(np.interp(per_area, _RADIAL[0], row)) for row in _RADIAL[1:])
        by_radial = 0.56
    elif _ANGULAR[0, 0] <= angle <= _ANGULAR[0, -1]:
        least, by_radial, by_axial = (float(np.interp(angle, _ANGULAR[0], row)) for row in _ANGULAR[1:])
    else:
        raise ContactError(
            f"contact_angle = {angle:g} degrees: ISO 281's factors X and Y are known here for 0 and from 20 to 45 "
            "degrees. The life by ISO 16281 needs none."
        )
    return radial if axial <= least * radial else by_radial * radial + by_axial * axial


def rating_life(rating: float, load: float) -> float:
    """Return the basic rating life L10 [revolutions] under an equivalent load [N]; infinite without."""
    return MILLION * (rating / load) ** 3 if load > 0.0 else math.inf


def contact_rating(geometry: BallBearingGeometry, rating: float, race: RaceName) -> float:
    """Return the load [N] of every ball under which its contacts on a race survive a million revolutions.

    Q_ci of the inner, turning race, Q_ce of the outer one: ISO 16281, (1) and (2).
    """
    constant, power = (0.407, STANDING) if race == "inner" else (0.389, -STANDING)
    whole = constant * geometry.balls * math.cos(geometry.contact_angle)
    return float(rating / whole * (1.0 + _races(geometry, 1.044) ** power) ** 0.3)


def mean_load(loads: Array, power: float) -> Array:
    """Return the dynamic equivalent rolling element load [N] of balls [..., Z] by ISO 16281, (5) to (8)."""
    return np.asarray(np.mean(np.maximum(loads, 0.0) ** power, axis=-1) ** (1.0 / power))


def race_lives(geometry: BallBearingGeometry, rating: float, inner: Array, outer: Array) -> tuple[Array, Array]:
    """Return lives [revolutions] of inner and outer race for loads [..., Z] of the balls [N]; infinite without load."""
    means = mean_load(inner, TURNING), mean_load(outer, STANDING)
    borne = contact_rating(geometry, rating, "inner"), contact_rating(geometry, rating, "outer")
    with np.errstate(divide="ignore"):
        first, second = (np.asarray(MILLION * (q / mean) ** 3) for q, mean in zip(borne, means, strict=True))
    return first, second


def both(inner: Array, outer: Array) -> Array:
    """Return the life of a bearing whose races have these: neither may fail."""
    with np.errstate(divide="ignore"):
        return np.asarray((inner**-WEIBULL + outer**-WEIBULL) ** (-1.0 / WEIBULL))


def reference_life(geometry: BallBearingGeometry, rating: float, inner: Array, outer: Array) -> Array:
    """Return the basic reference rating life L10r [revolutions] of ISO 16281 for loads [..., Z] of the balls [N].

    L10r = 10^6 [(Q_ci / Q_ei)^(-10/3) + (Q_ce / Q_ee)^(-10/3)]^(-9/10), Q_ei and Q_ee being the means of the balls'
    loads by their 3rd and 10/3th powers.
    """
    return both(*race_lives(geometry, rating, inner, outer))


def reference_load(rating: float, life: Array) -> Array:
    """Return the dynamic equivalent reference load P_ref [N] that gives a life [revolutions]."""
    return np.asarray(rating * np.cbrt(MILLION / life))


def fatigue_load_limit(geometry: BallBearingGeometry) -> float:
    """Return C_u [N], under which the most loaded ball has Hertz's pressure of 1500 MPa on one race.

    ISO 281, (B.1) and (B.9) to (B.11), Hertz's contact as everywhere here.
    """
    most = max(geometry.inner.unit.pressure_max, geometry.outer.unit.pressure_max)
    ball = (FATIGUE_PRESSURE / most) ** 3
    return 0.2288 * geometry.balls * ball * math.cos(geometry.contact_angle) * _large(geometry)


def simple_fatigue_load_limit(geometry: BallBearingGeometry) -> float:
    """Return C_u = C_0 / 22 [N]: ISO 281, (B.18) and (B.19), which give way to `fatigue_load_limit`."""
    return catalogue_of(geometry).static_rating / 22.0 * _large(geometry)


def reference_viscosity(pitch_diameter: float, speed: Array) -> Array:
    """Return the kinematic viscosity nu_1 [m2/s] that separates the surfaces, at speeds [rad/s] above 0."""
    rpm, pitch = np.abs(speed) * 30.0 / math.pi, 1e3 * pitch_diameter
    slow = 45000.0 * rpm**-0.83
    return np.asarray(1e-6 * np.where(rpm < 1000.0, slow, 4500.0 * rpm**-0.5) * pitch**-0.5)


def kappa_of_lambda(ratio: Array) -> Array:
    """Return the viscosity ratio that stands for film thickness over roughness, lambda^1.3; ISO 281, from memory."""
    return np.asarray(ratio**1.3)


def life_factor(kappa: Array, ratio: Array) -> Array:
    """Return a_ISO of radial ball bearings for viscosity ratios and e_C C_u / P: ISO 281, (31) to (33).

    L10mr = a_ISO L10r, a_ISO = 0.1 [1 - (2.5671 - A / kappa^B)^0.83 (e_C C_u / P)^(1/3)]^-9.3, kappa = nu / nu_1 or
    lambda^1.3.

    kappa counts as 0.1 to 4 at most; below 0.1 the standard has no factor. Between 0.1 and 50.
    """
    counted = np.clip(kappa, LEAST_KAPPA, MOST_KAPPA)
    below = [counted < end for end, *_ in _A_ISO[:-1]]
    lack = np.select(below, [a / counted**b for _, a, b in _A_ISO[:-1]], _A_ISO[-1][1] / counted ** _A_ISO[-1][2])
    left = 1.0 - (2.5671 - lack) ** 0.83 * np.cbrt(ratio)
    with np.errstate(divide="ignore", over="ignore"):
        factor = 0.1 * np.maximum(left, 0.0) ** -9.3
    return np.asarray(np.clip(factor, LEAST_FACTOR, MOST_FACTOR))


def consumed(time: Array, speed: Array, life: Array) -> float:
    """Return the share of the life that a duty takes, by Palmgren & Miner: sum of revolutions over lives.

    Rows of time [s] with speed [rad/s] and life [revolutions] from the row before. Palmgren 1924; Miner, J. Appl. Mech.
    12 (1945) A159, doi:10.1115/1.4009458 (from memory).
    """
    turns = np.abs(speed) * np.diff(time, prepend=time[0]) / (2.0 * math.pi)
    return float(np.sum(np.divide(turns, life, out=np.zeros_like(turns), where=turns > 0.0)))


def _gamma(geometry: BallBearingGeometry) -> float:
    return geometry.ratio * math.cos(geometry.contact_angle)


def _races(geometry: BallBearingGeometry, constant: float) -> float:
    """Return the ratio of what the inner and the outer race bear, which both standards build on."""
    gamma, inner, outer = _gamma(geometry), geometry.conformity_inner, geometry.conformity_outer
    grooves = (inner / outer) * (2.0 * outer - 1.0) / (2.0 * inner - 1.0)
    return float(constant * ((1.0 - gamma) / (1.0 + gamma)) ** 1.72 * grooves**0.41)


def _large(geometry: BallBearingGeometry) -> float:
    return min(1.0, math.sqrt(0.1 / geometry.pitch_diameter))
