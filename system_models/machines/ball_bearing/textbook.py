"""Values of catalogues and textbooks to compare a ball bearing with.

The formulas for the torque are fits to measurements, in mm, N, rpm and mm2/s; SI goes in and comes out.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

from .geometry import BallBearingGeometry


@dataclass(frozen=True)
class Series:
    """Constants of the formulas for a series of bearings."""

    angular: bool  # angular contact at 40 degrees, else deep groove
    r: tuple[float, float, float]  # R_1, R_2, R_3 of SKF's rolling torque
    s: tuple[float, float, float]  # S_1, S_2, S_3 of its sliding torque
    k_z: float  # SKF's geometric constant
    f_0: float  # Palmgren's, in an oil bath
    f_1: tuple[float, float]  # Palmgren's: factor and exponent of the equivalent static load over its rating


# R and S of series 62: from memory, and alike in two public programs that took them from the catalogue; of angular
# contact bearings and all of Palmgren's: from memory
DEEP_GROOVE_62 = Series(False, (3.9e-7, 1.7, 0.0), (3.23e-3, 36.5, 0.0), 3.1, 2.0, (6e-4, 0.55))
ANGULAR_CONTACT = Series(True, (5.03e-7, 1.97, 1.90e-12), (1.30e-2, 0.68, 1.91e-12), 4.4, 3.3, (1e-3, 0.33))


@dataclass(frozen=True)
class CatalogueBearing:
    """A bearing as its catalogue has it."""

    series: Series
    bore: float  # [m]
    outside: float  # [m]
    static_rating: float  # C_0 [N]

    @property
    def mean_diameter(self) -> float:
        """[mm]."""
        return 500.0 * (self.bore + self.outside)

    def static_load(self, radial: float, axial: float) -> float:
        """Return the equivalent static load P_0 [N]; ISO 76, from memory."""
        by_radial, by_axial = (0.5, 0.26) if self.series.angular else (0.6, 0.5)
        return max(by_radial * radial + by_axial * axial, 0.0 if self.series.angular else radial)


# ratings of 6209 and 7218: from memory
CATALOGUE_209 = CatalogueBearing(DEEP_GROOVE_62, 45e-3, 85e-3, 21.6e3)
CATALOGUE_218 = CatalogueBearing(ANGULAR_CONTACT, 90e-3, 160e-3, 104e3)
_BALL_SHARE = 0.635  # of the ring section's height: that of the ball in both of these
_STATIC_PRESSURE = 4.2e9  # Pa: at the static rating of ball bearings, ISO 76 (from memory)


def catalogue_of(geometry: BallBearingGeometry) -> CatalogueBearing:
    """Return a bearing of which only the inner geometry is known, proportioned as 209 and 218 are.

    Its static rating is the load at which the most loaded ball, with 5 times the mean load of all, has ISO 76's
    pressure on the inner race.
    """
    angle, section = geometry.contact_angle, geometry.ball_diameter / _BALL_SHARE
    largest = (_STATIC_PRESSURE / geometry.inner.unit.pressure_max) ** 3
    return CatalogueBearing(
        ANGULAR_CONTACT if angle > 0.0 else DEEP_GROOVE_62,
        geometry.pitch_diameter - section,
        geometry.pitch_diameter + section,
        largest * geometry.balls * math.cos(angle) / 5.0,
    )


class Torque(NamedTuple):
    """Parts of the friction torque [N m]."""

    speed_dependent: float  # SKF: rolling; Palmgren: M_0
    load_dependent: float  # SKF: sliding; Palmgren: M_1

    @property
    def total(self) -> float:
        """Their sum [N m]."""
        return self.speed_dependent + self.load_dependent


def skf_torque(
    bearing: CatalogueBearing,
    radial: float,
    axial: float,
    speed: float,
    viscosity: float,
    friction_film: float = 0.05,
    starvation: float = 3e-8,
) -> Torque:
    """Return rolling and sliding friction torque after SKF, without seals and drag.

    M = phi_heat phi_supply G_rr (nu n)^0.6 + mu_sl G_sl.

    radial, axial [N] >= 0, speed [rad/s], kinematic viscosity [m2/s] at the bearing's temperature; friction_film: of a
    full film, 0.05 for mineral and 0.04 for synthetic oil; starvation: 3e-8 for an oil bath or jet, 6e-8 for grease, 0
    where there is always enough.
    Source: SKF, Rolling Bearings, catalogue 10000 EN, chapter Friction (the form of 2008 and later).
    """
    dm, n, nu = bearing.mean_diameter, speed * 30.0 / math.pi, viscosity * 1e6
    bore, outside, k_z = 1e3 * bearing.bore, 1e3 * bearing.outside, bearing.series.k_z
    rolling, sliding = _skf_geometry(bearing, radial, axial, n)
    heating = 1.0 / (1.0 + 1.84e-9 * (n * dm) ** 1.28 * nu**0.64)
    supply = math.exp(-starvation * nu * n * (bore + outside) * math.sqrt(k_z / (2.0 * (outside - bore))))
    mixed = math.exp(-2.6e-8 * (n * nu) ** 1.4 * dm)
    friction = mixed * (0.12 if n > 0.0 else 0.15) + (1.0 - mixed) * friction_film
    return Torque(1e-3 * heating * supply * rolling * (nu * n) ** 0.6, 1e-3 * friction * sliding)


def _skf_geometry(bearing: CatalogueBearing, radial: float, axial: float, n: float) -> tuple[float, float]:
    """Return G_rr and G_sl at n [rpm]."""
    series, dm = bearing.series, bearing.mean_diameter
    (r1, r2, r3), (s1, s2, s3) = series.r, series.s
    if series.angular:
        by_rolling, by_sliding = r3 * dm**4 * n**2, s3 * dm**4 * n**2  # centrifugal loads
        return (
            r1 * dm**1.97 * (radial + by_rolling + r2 * axial) ** 0.54,
            s1 * dm**0.26 * ((radial + by_sliding) ** (4 / 3) + s2 * axial ** (4 / 3)),
        )
    if axial == 0.0:
        return r1 * dm**1.96 * radial**0.54, s1 * dm**-0.26 * radial ** (5 / 3)
    sine = math.sin(math.radians(24.6 * (axial / bearing.static_rating) ** 0.24))
    return (
        r1 * dm**1.96 * (radial + r2 / sine * axial) ** 0.54,
        s1 * dm**-0.145 * (radial**5 + s2 * dm**1.5 / sine * axial**4) ** (1 / 3),
    )


def palmgren_torque(bearing: CatalogueBearing, radial: float, axial: float, speed: float, viscosity: float) -> Torque:
    """Return M_0 of the oil and M_1 of the load after Palmgren.

    M_0 = 10^-7 f_0 (nu n)^(2/3) d_m^3 for nu n > 2000, M_1 = f_1 P_1 d_m.

    radial, axial [N] >= 0, speed [rad/s], kinematic viscosity [m2/s].
    Source: Palmgren, Ball and Roller Bearing Engineering, 3rd ed., 1959, in the form of Harris & Kotzalas, Essential
    Concepts of Bearing Technology, 5th ed., 2006, chapter 10 (from memory).
    """
    dm, moved, series = bearing.mean_diameter, viscosity * 1e6 * speed * 30.0 / math.pi, bearing.series
    oil = 1e-7 * series.f_0 * dm**3 * (moved ** (2 / 3) if moved > 2000.0 else 160.0)
    lever = 0.9 / math.tan(math.radians(40.0)) if series.angular else 3.0
    equivalent = max(lever * axial - 0.1 * radial, radial)
    factor, exponent = series.f_1
    share = bearing.static_load(radial, axial) / bearing.static_rating
    return Torque(1e-3 * oil, 1e-3 * factor * share**exponent * equivalent * dm)
