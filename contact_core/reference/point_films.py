"""Film thickness of smooth point contacts."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..kernels.arrays import Array
from .hertz import hertz_point

# of Moes' numbers: beyond them, where films are far from any other length, powers of theirs are no floats any more
_LEAST_LOAD, _LEAST_LUBRICANT, _LEAST_SPEED = 1e-30, 1e-20, 1e-200


def at_no_pressure(viscosity: Callable[[Array, float], Array], temperature: float) -> tuple[float, float]:
    """Return viscosity [Pa s] and pressure coefficient [1/Pa] at p = 0 of a law.

    It is a law of pressures [Pa] and a temperature [K].
    """
    low, high = viscosity(np.array([0.0, 1e6]), temperature)
    return float(low), max(float(np.log(high / low)) * 1e-6, 1e-12)


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
        viscosity: Callable[[Array, float], Array],
        temperature: float,
        radius_x: float,
        radius_y: float,
        reduced_modulus: float,
    ) -> "SmoothContact":
        """Return the contact with an oil whose `viscosity` [Pa s] is a law of pressures [Pa] and a temperature [K]."""
        low, rise = at_no_pressure(viscosity, temperature)
        return SmoothContact(load, abs(entrainment_speed), low, rise, radius_x, radius_y, reduced_modulus)

    @property
    def moes_parameters(self) -> tuple[float, float]:
        """Moes' parameters of load and lubricant (M, L), on the sum of surface speeds and radius_x."""
        oil, solids = (self.viscosity, self.pressure_coefficient), (self.radius_x, self.reduced_modulus)
        return _moes_numbers(self.load, self.entrainment_speed, *oil, *solids)[:2]

    @property
    def circular_load(self) -> float:
        """Moes' M of the circular contact that is as close to rigid.

        Films of rigid and of elastic, isoviscous bodies differ by the same factor.
        """
        rigid, elastic, *_ = _moes_factors(self.radius_x / self.radius_y)
        rigid_circle, elastic_circle, *_ = _moes_factors(1.0)
        return self.moes_parameters[0] * ((rigid_circle / elastic_circle) / (rigid / elastic)) ** (15 / 28)

    @property
    def film(self) -> float:
        """Central film thickness [m] by `nijenbanning_venner_moes`."""
        return nijenbanning_venner_moes(self)


def hamrock_dowson(contact: SmoothContact) -> tuple[float, float]:
    """Return central and minimum film thickness [m].

    h_c / R_x = 2.69 U^0.67 G^0.53 W^-0.067 (1 - 0.61 e^(-0.73 k)), h_min / R_x = 3.63 U^0.68 G^0.49 W^-0.073 (1 -
    e^(-0.68 k)), with U = eta_0 u_e / (E' R_x), G = alpha E', W = load / (E' R_x^2), k = b / a.

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
    """Return the central film thickness [m], over all regimes from rigid-isoviscous to elastic-piezoviscous.

    H = {[H_RI^1.5 + (H_EI^-4 + H_00^-4)^(-3/8)]^(2 s / 3) + (H_RP^-8 + H_EP^-8)^(-s / 8)}^(1 / s), s = 1.5 [1 +
    exp(-1.2 H_EI / H_RI)], H = (h / R_x) U^-0.5, U = 2 eta_0 u_e / (E' R_x), M = W / (E' R_x^2) U^-0.75, L = alpha E'
    U^0.25. Of a circle H_RI = 41.35 M^-2, H_EI = 2.419 M^(-2/15), H_RP = 0.9089 L^(2/3), H_EP = 1.247 M^(-1/12) L^0.75,
    H_00 = 1.8; factors of ellipses: `_moes_factors`.

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
    """Return the film of `nijenbanning_venner_moes` for plain numbers, as in `SmoothContact`, without a record."""
    m, lubricant, speed = _moes_numbers(
        load, entrainment_speed, viscosity, pressure_coefficient, radius_x, reduced_modulus
    )
    return moes_film(m, lubricant, radius_x / radius_y) * math.sqrt(speed) * radius_x


def _moes_numbers(
    load: float, speed: float, viscosity: float, pressure_coefficient: float, radius: float, modulus: float
) -> tuple[float, float, float]:
    """Return Moes' load M, lubricant L and speed U, on the sum of surface speeds and radius_x."""
    u = max(2.0 * viscosity * speed / (modulus * radius), _LEAST_SPEED)
    return load / (modulus * radius**2) * u**-0.75, pressure_coefficient * modulus * u**0.25, u


def moes_film(load: float, lubricant: float, ratio: float = 1.0) -> float:
    """Return the central film thickness in Moes' units, (h / radius_x) U^-0.5.

    Of Moes' M, L and radius_x / radius_y.

    Source: as `nijenbanning_venner_moes`.
    """
    rigid_iso, elastic_iso, rigid_piezo, elastic_piezo, unloaded = _moes_factors(ratio)
    load, lubricant = min(max(load, _LEAST_LOAD), 1.0 / _LEAST_LOAD), max(lubricant, _LEAST_LUBRICANT)
    rigid_iso /= load**2
    elastic_iso *= load ** (-2 / 15)
    rigid_piezo *= lubricant ** (2 / 3)
    elastic_piezo *= load ** (-1 / 12) * lubricant**0.75
    s = 1.5 * (1.0 + math.exp(-1.2 * elastic_iso / rigid_iso))
    iso = (rigid_iso**1.5 + (elastic_iso**-4 + unloaded**-4) ** (-3 / 8)) ** (2 * s / 3)
    return (iso + (rigid_piezo**-8 + elastic_piezo**-8) ** (-s / 8)) ** (1.0 / s)


@lru_cache(maxsize=64)
def _moes_factors(ratio: float) -> tuple[float, float, float, float, float]:
    """Return the films of the asymptotic contacts at M = L = 1.

    They are those of the rigid and of the elastic, isoviscous and piezoviscous contact, and of an unloaded one.
    """
    shape = 1.0 + 0.006 * math.log(ratio) + 0.63 * ratio ** (4 / 7)
    return (
        145.0 * (1.0 + 0.796 * ratio ** (14 / 15)) ** (-15 / 7) / ratio,
        3.18 * shape ** (-14 / 25) * ratio ** (-1 / 15),
        1.29 * (1.0 + 0.691 * ratio) ** (-2 / 3),
        1.48 * shape ** (-7 / 20) * ratio ** (-1 / 24),
        1.8 / ratio,
    )
