"""Closed forms, as library code: what solvers are tested against and what engineers compare with."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy  # its parts are loaded at their first use
from numpy.typing import NDArray

from .constants import BOLTZMANN, PLANCK


@dataclass(frozen=True)
class Hertz:
    """Dry contact of smooth elastic bodies."""

    a: float  # half width along x [m]
    b: float  # half width along y [m]
    pressure_max: float  # [Pa]
    approach: float  # [m]

    @property
    def area(self) -> float:
        """Contact area [m2]."""
        return float(np.pi * self.a * self.b)


def hertz_point(load: float, radius_x: float, radius_y: float, reduced_modulus: float) -> Hertz:
    """Hertz's point contact, circular or elliptical.

    load [N] > 0, radii of combined curvature [m], reduced_modulus E' = 2 / sum (1 - v^2)/E [Pa].
    Source: Johnson, Contact Mechanics, 1985, doi:10.1017/CBO9781139171731, section 4.2.
    """
    if radius_x == radius_y:
        a = (1.5 * load * radius_x / reduced_modulus) ** (1 / 3)
        return Hertz(a, a, 1.5 * load / (np.pi * a * a), a * a / radius_x)
    small, large = sorted((radius_x, radius_y))

    special = scipy.special

    def mismatch(log_ratio: float) -> float:
        k2 = np.exp(2.0 * log_ratio)  # (short half width / long half width)^2
        return float(special.elliprd(0.0, 1.0, k2) / special.elliprd(0.0, k2, 1.0) - large / small)

    # Carlson's integrals, because E/k^2 - K and K - E lose their digits near the circle
    k = float(np.exp(scipy.optimize.brentq(mismatch, np.log(1e-12), 0.0, xtol=1e-15)))
    ellipk, ellipe = float(special.elliprf(0.0, k * k, 1.0)), 2.0 * float(special.elliprg(0.0, k * k, 1.0))
    curvature = 0.5 * (1.0 / small + 1.0 / large)
    long = (3.0 * load * ellipe / (np.pi * k * k * reduced_modulus * curvature)) ** (1 / 3)
    short = k * long
    pressure = 1.5 * load / (np.pi * long * short)
    approach = 2.0 * pressure * short * ellipk / reduced_modulus
    a, b = (short, long) if radius_x == small else (long, short)
    return Hertz(float(a), float(b), float(pressure), float(approach))


@dataclass(frozen=True)
class SmoothContact:
    """A smooth, isothermal, Newtonian, fully flooded elastohydrodynamic point contact."""

    load: float  # [N]
    entrainment_speed: float  # u_e = (u1 + u2) / 2 [m/s], along x
    viscosity: float  # at p = 0 [Pa s]
    pressure_coefficient: float  # d ln(viscosity)/dp at p = 0 [Pa^-1]
    radius_x: float  # of combined curvature, along x [m]
    radius_y: float  # along y [m]
    reduced_modulus: float  # E' = 2 / sum (1 - v^2)/E [Pa]

    @staticmethod
    def of(
        load: float,
        entrainment_speed: float,
        viscosity: Callable[[NDArray[np.float64], float], NDArray[np.float64]],
        temperature: float,
        radius_x: float,
        radius_y: float,
        reduced_modulus: float,
    ) -> "SmoothContact":
        """The contact with an oil whose `viscosity` [Pa s] is a law of pressures [Pa] and a temperature [K]."""
        low, high = viscosity(np.array([0.0, 1e6]), temperature)
        rise = max(float(np.log(high / low)) * 1e-6, 1e-12)
        return SmoothContact(load, abs(entrainment_speed), float(low), rise, radius_x, radius_y, reduced_modulus)

    @property
    def moes_parameters(self) -> tuple[float, float]:
        """Moes' parameters of load and lubricant (M, L), on the sum of surface speeds and radius_x."""
        oil, solids = (self.viscosity, self.pressure_coefficient), (self.radius_x, self.reduced_modulus)
        return _moes_numbers(self.load, self.entrainment_speed, *oil, *solids)[:2]

    @property
    def circular_load(self) -> float:
        """Moes' M of the circular contact that is as near to rigid: films of rigid and of elastic, isoviscous bodies
        are alike in both at the same share of it.
        """
        rigid, elastic, *_ = _moes_factors(self.radius_x / self.radius_y)
        rigid_circle, elastic_circle, *_ = _moes_factors(1.0)
        return self.moes_parameters[0] * ((rigid_circle / elastic_circle) / (rigid / elastic)) ** (15 / 28)


def hamrock_dowson(contact: SmoothContact) -> tuple[float, float]:
    """Central and minimum film thickness [m].

    Source: Hamrock & Dowson, J. Lubr. Technol. 99 (1977) 264, doi:10.1115/1.3453074. Fitted to circles
    and to ellipses with the long axis across the entrainment; the ellipticity is that of Hertz's contact.
    """
    speed = contact.viscosity * contact.entrainment_speed / (contact.reduced_modulus * contact.radius_x)
    material = contact.pressure_coefficient * contact.reduced_modulus
    load = contact.load / (contact.reduced_modulus * contact.radius_x**2)
    hertz = hertz_point(contact.load, contact.radius_x, contact.radius_y, contact.reduced_modulus)
    k = hertz.b / hertz.a
    central = 2.69 * speed**0.67 * material**0.53 * load**-0.067 * (1.0 - 0.61 * np.exp(-0.73 * k))
    minimum = 3.63 * speed**0.68 * material**0.49 * load**-0.073 * (1.0 - np.exp(-0.68 * k))
    return float(central * contact.radius_x), float(minimum * contact.radius_x)


def nijenbanning_venner_moes(contact: SmoothContact) -> float:
    """Central film thickness [m], over all regimes from rigid-isoviscous to elastic-piezoviscous.

    Source: Nijenbanning, Venner & Moes, Wear 176 (1994) 217, doi:10.1016/0043-1648(94)90150-3.
    """
    c = contact
    return nvm_film(
        c.load, c.entrainment_speed, c.viscosity, c.pressure_coefficient, c.radius_x, c.radius_y, c.reduced_modulus
    )


def nvm_film(
    load: float,
    entrainment_speed: float,
    viscosity: float,
    pressure_coefficient: float,
    radius_x: float,
    radius_y: float,
    reduced_modulus: float,
) -> float:
    """`nijenbanning_venner_moes` of plain numbers, as in `SmoothContact`: no record to make."""
    m, lubricant, speed = _moes_numbers(
        load, entrainment_speed, viscosity, pressure_coefficient, radius_x, reduced_modulus
    )
    return moes_film(m, lubricant, radius_x / radius_y) * math.sqrt(speed) * radius_x


def _moes_numbers(
    load: float, speed: float, viscosity: float, pressure_coefficient: float, radius: float, modulus: float
) -> tuple[float, float, float]:
    """Moes' load M, lubricant L and speed U, on the sum of surface speeds and radius_x."""
    u = 2.0 * viscosity * speed / (modulus * radius)
    return load / (modulus * radius**2) * u**-0.75, pressure_coefficient * modulus * u**0.25, u


def moes_film(load: float, lubricant: float, ratio: float = 1.0) -> float:
    """Central film thickness in Moes' units, (h / radius_x) U^-0.5, of Moes' M, L and radius_x / radius_y.

    Source: as `nijenbanning_venner_moes`.
    """
    rigid_iso, elastic_iso, rigid_piezo, elastic_piezo, unloaded = _moes_factors(ratio)
    rigid_iso /= load**2
    elastic_iso *= load ** (-2 / 15)
    rigid_piezo *= lubricant ** (2 / 3)
    elastic_piezo *= load ** (-1 / 12) * lubricant**0.75
    s = 1.5 * (1.0 + math.exp(-1.2 * elastic_iso / rigid_iso))
    iso = (rigid_iso**1.5 + (elastic_iso**-4 + unloaded**-4) ** (-3 / 8)) ** (2 * s / 3)
    return (iso + (rigid_piezo**-8 + elastic_piezo**-8) ** (-s / 8)) ** (1.0 / s)


@lru_cache(maxsize=64)
def _moes_factors(ratio: float) -> tuple[float, float, float, float, float]:
    """Films of the rigid and of the elastic, isoviscous and piezoviscous contact at M = L = 1, and of one unloaded."""
    shape = 1.0 + 0.006 * math.log(ratio) + 0.63 * ratio ** (4 / 7)
    return (
        145.0 * (1.0 + 0.796 * ratio ** (14 / 15)) ** (-15 / 7) / ratio,
        3.18 * shape ** (-14 / 25) * ratio ** (-1 / 15),
        1.29 * (1.0 + 0.691 * ratio) ** (-2 / 3),
        1.48 * shape ** (-7 / 20) * ratio ** (-1 / 24),
        1.8 / ratio,
    )


@dataclass(frozen=True)
class SmoothLine:
    """A smooth, isothermal, Newtonian, fully flooded elastohydrodynamic line contact."""

    load: float  # per length [N/m]
    entrainment_speed: float  # u_e = (u1 + u2) / 2 [m/s], along x
    viscosity: float  # at p = 0 [Pa s]
    pressure_coefficient: float  # d ln(viscosity)/dp at p = 0 [Pa^-1]
    radius: float  # of combined curvature, along x [m]
    reduced_modulus: float  # E' = 2 / sum (1 - v^2)/E [Pa]

    @property
    def moes_parameters(self) -> tuple[float, float]:
        """Moes' parameters of load and lubricant (M, L) of line contacts, on the sum of surface speeds."""
        speed = 2.0 * self.viscosity * self.entrainment_speed / (self.reduced_modulus * self.radius)
        load = self.load / (self.reduced_modulus * self.radius)
        return load * speed**-0.5, self.pressure_coefficient * self.reduced_modulus * speed**0.25


def dowson_line(contact: SmoothLine) -> tuple[float, float]:
    """Central and minimum film thickness [m] of a line contact in the elastic-piezoviscous regime.

    Source: central Dowson & Toyoda, Proc. 5th Leeds-Lyon Symposium on Tribology (1979) 60; minimum Dowson, Proc. IMechE
    182 (1967) 151.
    """
    speed = contact.viscosity * contact.entrainment_speed / (contact.reduced_modulus * contact.radius)
    material = contact.pressure_coefficient * contact.reduced_modulus
    load = contact.load / (contact.reduced_modulus * contact.radius)
    central = 3.06 * speed**0.69 * material**0.56 * load**-0.10
    minimum = 2.65 * speed**0.70 * material**0.54 * load**-0.13
    return float(central * contact.radius), float(minimum * contact.radius)


def moes_line(contact: SmoothLine) -> float:
    """Central film thickness [m] of a line contact, over all regimes as `moes_line_film`."""
    speed = 2.0 * contact.viscosity * contact.entrainment_speed / (contact.reduced_modulus * contact.radius)
    return float(moes_line_film(*contact.moes_parameters) * np.sqrt(speed) * contact.radius)


def moes_line_film(load: float, lubricant: float) -> float:
    """Central film thickness of a line contact in Moes' units, (h / radius) U^-0.5, of Moes' M and L.

    Source: Moes, Wear 159 (1992) 57; Venner & Lubrecht, Multilevel Methods in Lubrication, Elsevier 2000.
    """
    rigid_iso = 3.0 / load
    elastic_iso = 2.621 * load ** (-1 / 5)
    rigid_piezo = 1.287 * lubricant ** (2 / 3)
    elastic_piezo = 1.311 * load ** (-1 / 8) * lubricant**0.75
    s = (7.0 + 8.0 * np.exp(-2.0 * elastic_iso / rigid_iso)) / 5.0
    iso = (rigid_iso ** (7 / 3) + elastic_iso ** (7 / 3)) ** (3 * s / 7)
    return float((iso + (rigid_piezo**-3.5 + elastic_piezo**-3.5) ** (-2 * s / 7)) ** (1.0 / s))


def inlet_shear_factor(
    viscosity: float,
    temperature_coefficient: float,
    entrainment_speed: float,
    slide_roll_ratio: float,
    conductivity: float,
    pressure_max: float,
    reduced_modulus: float,
) -> float:
    """Film thickness of a contact whose inlet is heated by shear, relative to the isothermal one; 0.01 to 1.

    (1 - 13.2 (p_H / E') Q^0.42) / [1 + 0.213 (1 + 2.23 |SRR|^0.83) Q^0.64], Q = eta0 beta u_e^2 / k, with viscosity
    eta0 [Pa s] and its temperature_coefficient beta = -d ln(eta)/dT [1/K] at the inlet, conductivity k of the oil
    [W/(m K)], slide_roll_ratio (u1 - u2) / u_e, Hertz pressure p_H [Pa] and E' [Pa]. Beyond any contact, where the
    numerator would vanish, it is 0.01.
    Source: Gupta, Cheng, Zhu, Forster & Schrand, Tribol. Trans. 35 (1992) 269, doi:10.1080/10402009208982117.
    """
    heat = viscosity * temperature_coefficient * entrainment_speed**2 / conductivity
    film = 1.0 - 13.2 * pressure_max / reduced_modulus * heat**0.42
    factor = film / (1.0 + 0.213 * (1.0 + 2.23 * abs(slide_roll_ratio) ** 0.83) * heat**0.64)
    return max(factor, 0.01)


def bair_thinning_factor(
    newtonian_film: float,
    entrainment_speed: float,
    viscosity: float,
    critical_stress: float,
    exponent: float,
    slide_roll_ratio: float = 0.0,
) -> float:
    """Central film thickness of a Carreau oil relative to the newtonian_film h_N [m]; 0 to 1.

    {1 + 0.79 [(1 + S) u_e eta0 / (h_N G)]^[1 / (1 + 0.2 S)]}^[-3.6 (1 - n)^1.7], viscosity eta0 [Pa s] at p = 0,
    critical_stress G [Pa] and exponent n of Carreau's law, S = |u1 - u2| / u_e; fitted for n from 0.3 to 0.8.
    Source: Bair, Proc. IMechE J 219 (2005) 69.
    """
    slip = abs(slide_roll_ratio)
    shear = (1.0 + slip) * abs(entrainment_speed) * viscosity / (newtonian_film * critical_stress)
    return float((1.0 + 0.79 * shear ** (1.0 / (1.0 + 0.2 * slip))) ** (-3.6 * (1.0 - exponent) ** 1.7))


def ghanbarzadeh_thickness(
    time: float | NDArray[np.float64],
    temperature: float,
    full_thickness: float,
    rate_factor: float,
    removal_thickness: float,
    removal_rate: float,
) -> NDArray[np.float64]:
    """Tribofilm [m] on a point rubbed for `time` [s] from bare: h_max (1 - e^-kt) - C3 (1 - e^-C4 t).

    k = (k_B T / h) rate_factor [1/s] at `temperature` [K]; h_max and C3 [m]; C4 = removal_rate [1/s].
    Source: Ghanbarzadeh et al., Tribol. Int. 93 (2016) 573, doi:10.1016/j.triboint.2014.12.018.
    """
    rate = BOLTZMANN * temperature / PLANCK * rate_factor
    formed = full_thickness * (1.0 - np.exp(-rate * np.asarray(time)))
    return formed - removal_thickness * (1.0 - np.exp(-removal_rate * np.asarray(time)))


def archard_depth(coefficient: float, hardness: float, pressure: float, sliding_distance: float) -> float:
    """Wear depth [m], K p s / H, under a pressure [Pa] over a sliding distance [m]; K dimensionless, H [Pa].

    Source: Archard, J. Appl. Phys. 24 (1953) 981, doi:10.1063/1.1721448.
    """
    return coefficient * pressure * sliding_distance / hardness


def load_cycles(speed: float, time: float, track_length: float) -> float:
    """Passes of a surface point through the contact in `time` [s]: |speed| [m/s] time / track length [m]."""
    return abs(speed) * time / track_length


def jaeger_circle(peclet: float) -> tuple[float, float]:
    """Largest and mean steady rise of a half space that moves at a speed u under a circle of uniform flux q.

    In units of q r / K, K conductivity; peclet = u r / (2 k) >= 0, k diffusivity. At rest 1 and 8 / (3 pi). By
    quadrature of Jaeger's point source, in polar coordinates around the point that is warmed.
    Source: Jaeger, Proc. R. Soc. N. S. W. 76 (1942) 203.
    """
    quad, minimize_scalar = scipy.integrate.quad, scipy.optimize.minimize_scalar

    def mean_part(distance: float) -> float:  # weighted by what a circle shares with its copy at this distance
        shared = 2.0 * np.arccos(0.5 * distance) - 0.5 * distance * np.sqrt(4.0 - distance**2)
        return float(shared * scipy.special.i0e(peclet * distance))

    def rise(x: float) -> float:  # on the axis, at x downstream of the centre
        def part(angle: float) -> float:  # between upstream and the direction to the source
            reach = x * np.cos(angle) + np.sqrt(max(1.0 - (x * np.sin(angle)) ** 2, 0.0))
            rate = 2.0 * peclet * np.sin(0.5 * angle) ** 2
            return float(-np.expm1(-rate * reach) / rate if rate * reach > 1e-12 else reach)

        narrow = min(4.0 / np.sqrt(1.0 + peclet), 3.0)
        return float(quad(part, 0.0, np.pi, points=[narrow], limit=400, epsabs=0.0, epsrel=1e-10)[0]) / np.pi

    mean = quad(mean_part, 0.0, 2.0, limit=400, epsabs=0.0, epsrel=1e-10)[0] / np.pi
    found = minimize_scalar(lambda x: -rise(x), bounds=(0.0, 1.0), method="bounded", options={"xatol": 1e-7})
    return float(-found.fun), float(mean)


def tian_kennedy_circle(peclet: float) -> tuple[float, float]:
    """Largest and mean rise as in `jaeger_circle`, by formulas that are exact at rest and at high speed.

    Source: Tian & Kennedy, J. Tribol. 116 (1994) 167, doi:10.1115/1.2927035.
    """
    return float(2.0 / np.sqrt(np.pi * (1.273 + peclet))), float(1.22 / np.sqrt(np.pi * (0.6575 + peclet)))


def jaeger_band(x: float, peclet: float) -> float:
    """Steady rise at x, in half widths downstream of the centre, under a band of uniform flux q, without end across.

    In units of q b / K, b half width; peclet = u b / (2 k). Source: Jaeger, Proc. R. Soc. N. S. W. 76 (1942) 203.
    """
    k0e, k1e = scipy.special.k0e, scipy.special.k1e

    def integral(v: float) -> float:  # of exp(w) K0(|w|) from w = 0 to v, in closed form
        if v == 0.0:
            return 0.0
        if v > 0.0:
            return float(v * (k0e(v) + k1e(v)) - 1.0)
        return float(-1.0 - v * np.exp(2.0 * v) * (k1e(-v) - k0e(-v)))

    return (integral(peclet * (x + 1.0)) - integral(peclet * (x - 1.0))) / (np.pi * peclet)
