"""Film thickness of smooth line contacts."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from .point_films import at_no_pressure


@dataclass(frozen=True)
class SmoothLine:
    """A smooth, isothermal, Newtonian, fully flooded elastohydrodynamic line contact."""

    load: float  # per length [N/m]
    entrainment_speed: float  # u_e = (u1 + u2) / 2 [m/s], along x
    viscosity: float  # at p = 0 [Pa s]
    pressure_coefficient: float  # d ln(viscosity)/dp at p = 0 [Pa^-1]
    radius: float  # of combined curvature, along x [m]
    reduced_modulus: float  # E' = 2 / sum (1 - v^2)/E [Pa]

    @staticmethod
    def of(
        load: float,
        entrainment_speed: float,
        viscosity: Callable[[Array, float], Array],
        temperature: float,
        radius: float,
        reduced_modulus: float,
    ) -> "SmoothLine":
        """Return the contact with an oil whose `viscosity` [Pa s] is a law of pressures [Pa] and a temperature [K]."""
        low, rise = at_no_pressure(viscosity, temperature)
        return SmoothLine(load, abs(entrainment_speed), low, rise, radius, reduced_modulus)

    @property
    def moes_parameters(self) -> tuple[float, float]:
        """Moes' parameters of load and lubricant (M, L) of line contacts, on the sum of surface speeds."""
        oil, solids = (self.viscosity, self.pressure_coefficient), (self.radius, self.reduced_modulus)
        return _moes_numbers(self.load, self.entrainment_speed, *oil, *solids)[:2]

    @property
    def circular_load(self) -> float:
        """Moes' M of the circular contact whose Hertz contact is as deep, a^2 / R, in units of U^0.5 R."""
        load, _ = self.moes_parameters
        return float((8.0 * load / np.pi) ** 1.5 / 1.5)

    @property
    def film(self) -> float:
        """Central film thickness [m] by `moes_line`."""
        return moes_line(self)


def dowson_line(contact: SmoothLine) -> tuple[float, float]:
    """Return central and minimum film thickness [m] of a line contact in the elastic-piezoviscous regime.

    h_c / R = 3.06 U^0.69 G^0.56 W^-0.10, h_min / R = 2.65 U^0.70 G^0.54 W^-0.13, with U = eta_0 u_e / (E' R), G = alpha
    E', W = w / (E' R), w being the load per length.

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
    """Return the central film thickness [m] of a line contact, over all regimes as `moes_line_film`."""
    c = contact
    return line_film(c.load, c.entrainment_speed, c.viscosity, c.pressure_coefficient, c.radius, c.reduced_modulus)


def line_film(
    load: float,
    entrainment_speed: float,
    viscosity: float,
    pressure_coefficient: float,
    radius: float,
    reduced_modulus: float,
) -> float:
    """Return the film of `moes_line` for plain numbers, as in `SmoothLine`, without a record."""
    m, lubricant, speed = _moes_numbers(
        load, entrainment_speed, viscosity, pressure_coefficient, radius, reduced_modulus
    )
    return moes_line_film(m, lubricant) * math.sqrt(speed) * radius


def _moes_numbers(
    load: float, speed: float, viscosity: float, pressure_coefficient: float, radius: float, modulus: float
) -> tuple[float, float, float]:
    """Return Moes' load M, lubricant L and speed U of line contacts, on the sum of surface speeds."""
    u = 2.0 * viscosity * speed / (modulus * radius)
    return load / (modulus * radius) * u**-0.5, pressure_coefficient * modulus * u**0.25, u


def moes_line_film(load: float, lubricant: float) -> float:
    """Return the central film thickness in Moes' units, (h / radius) U^-0.5, of Moes' M and L.

    H = {[H_RI^(7/3) + H_EI^(7/3)]^(3 s / 7) + [H_RP^-3.5 + H_EP^-3.5]^(-2 s / 7)}^(1 / s), s = [7 + 8 exp(-2 H_EI /
    H_RI)] / 5, H_RI = 3 / M, H_EI = 2.621 M^-0.2, H_RP = 1.287 L^(2/3), H_EP = 1.311 M^(-1/8) L^0.75, with M = w / (E'
    R) U^-0.5, w being the load per length, L = alpha E' U^0.25 and U = 2 eta_0 u_e / (E' R).

    Of an incompressible oil whose viscosity rises by Barus' law: `line_contact` finds it within 3 %. The flow of oil is
    the same if it can be compressed, and the film is the thinner by its density.
    Source: Moes, Wear 159 (1992) 57; Venner & Lubrecht, Multilevel Methods in Lubrication, Elsevier 2000.
    """
    rigid_iso = 3.0 / load
    elastic_iso = 2.621 * load ** (-1 / 5)
    rigid_piezo = 1.287 * lubricant ** (2 / 3)
    elastic_piezo = 1.311 * load ** (-1 / 8) * lubricant**0.75
    s = (7.0 + 8.0 * math.exp(-2.0 * elastic_iso / rigid_iso)) / 5.0
    iso = (rigid_iso ** (7 / 3) + elastic_iso ** (7 / 3)) ** (3 * s / 7)
    return (iso + (rigid_piezo**-3.5 + elastic_piezo**-3.5) ** (-2 * s / 7)) ** (1.0 / s)
