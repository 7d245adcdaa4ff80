"""Hertz: dry contact of smooth elastic bodies."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy  # its parts are loaded at their first use
from numpy.typing import NDArray

Array = NDArray[np.float64]


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

    def inside(self, x: Array, y: Array, share: float) -> NDArray[np.bool_]:
        """Which nodes at x [nx], y [ny] about the centre [m] lie within `share` of the half widths, [ny, nx]."""
        within: NDArray[np.bool_] = (x[None, :] / self.a) ** 2 + (y[:, None] / self.b) ** 2 < share**2
        return within


@dataclass(frozen=True)
class HertzLine(Hertz):
    """Dry contact of a smooth cylinder; b is half its length."""

    @property
    def area(self) -> float:
        """Contact area [m2]."""
        return 4.0 * self.a * self.b

    def inside(self, x: Array, y: Array, share: float) -> NDArray[np.bool_]:
        """Which nodes at x [nx], y [ny] about the centre [m] lie within `share` of the half widths, [ny, nx]."""
        within: NDArray[np.bool_] = (np.abs(x) < share * self.a)[None, :] & (np.abs(y) < share * self.b)[:, None]
        return within


def hertz_line(load: float, radius: float, length: float, reduced_modulus: float) -> HertzLine:
    """Hertz's line contact.

    load per length [N/m] > 0, radius of combined curvature [m], length [m], reduced_modulus E' = 2 / sum (1 - v^2)/E
    [Pa]. The approach is that at the middle of an even load on the length: a^2 / (2 R) [ln(2 length / a) + 1/2].
    Source: Johnson, Contact Mechanics, 1985, doi:10.1017/CBO9781139171731, sections 4.2 and 5.6.
    """
    a = float(np.sqrt(8.0 * load * radius / (np.pi * reduced_modulus)))
    approach = a * a / (2.0 * radius) * (float(np.log(2.0 * length / a)) + 0.5)
    return HertzLine(a, 0.5 * length, 2.0 * load / (np.pi * a), approach)


def hertz_point(load: float, radius_x: float, radius_y: float, reduced_modulus: float) -> Hertz:
    """Hertz's point contact, circular or elliptical.

    load [N] > 0, radii of combined curvature [m], reduced_modulus E' = 2 / sum (1 - v^2)/E [Pa].
    Source: Johnson, Contact Mechanics, 1985, doi:10.1017/CBO9781139171731, section 4.2.
    """
    if radius_x == radius_y:
        a = (1.5 * load * radius_x / reduced_modulus) ** (1 / 3)
        return Hertz(a, a, 1.5 * load / (np.pi * a * a), a * a / radius_x)
    small, large = sorted((radius_x, radius_y))
    k, ellipk, ellipe = _ellipse(large / small)
    curvature = 0.5 * (1.0 / small + 1.0 / large)
    long = (3.0 * load * ellipe / (np.pi * k * k * reduced_modulus * curvature)) ** (1 / 3)
    short = k * long
    pressure = 1.5 * load / (np.pi * long * short)
    approach = 2.0 * pressure * short * ellipk / reduced_modulus
    a, b = (short, long) if radius_x == small else (long, short)
    return Hertz(float(a), float(b), float(pressure), float(approach))


@lru_cache(maxsize=64)
def _ellipse(ratio: float) -> tuple[float, float, float]:
    """Short over long half width of Hertz's ellipse, and the complete elliptic integrals K and E of its eccentricity,
    for a ratio > 1 of the radii.
    """
    special = scipy.special

    def mismatch(log_ratio: float) -> float:
        k2 = np.exp(2.0 * log_ratio)  # (short half width / long half width)^2
        return float(special.elliprd(0.0, 1.0, k2) / special.elliprd(0.0, k2, 1.0) - ratio)

    # Carlson's integrals, because E/k^2 - K and K - E lose their digits near the circle
    k = float(np.exp(scipy.optimize.brentq(mismatch, np.log(1e-12), 0.0, xtol=1e-15)))
    return k, float(special.elliprf(0.0, k * k, 1.0)), 2.0 * float(special.elliprg(0.0, k * k, 1.0))
