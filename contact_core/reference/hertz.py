"""Hertz: dry contact of smooth elastic bodies."""

from dataclasses import dataclass

import numpy as np
import scipy  # its parts are loaded at their first use


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
