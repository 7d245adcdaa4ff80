"""Viscosity as a function of pressure and temperature.

A law takes pressures [Pa] and temperatures [K], numbers or arrays that broadcast.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from ..quantities import CELSIUS, parameter
from .base import Viscosity
from .elementary import Numbers, exp, log, log10, maximum, minimum
from .equations import Equations

_P0 = 1.0 / 5.1e-9  # Pa
_LN_ETA_INF = -9.67  # ln(6.31e-5 Pa s)
_STIFF = 500.0  # an oil e^500 times stiffer than at p = 0 does not flow: no need to overflow
_STIFFEST_DOUBLE_LOG = 2.3  # log10 log10 of e^459 mm2/s, for the same reason
_ASSUMED_DENSITY = 870.0  # kg/m3, of oils whose law has none
_FIFTEEN = 288.15  # K


def _expansion() -> Any:
    return parameter(
        "K^-1", "thermal expansion, relative to the density at 15 degC; assumed 7e-4 if not given",
        least=0.0, most=1e-3, default=7e-4,
    )  # fmt: skip


# exponents beyond which powers of pressures and temperatures are no numbers any more; oils have 0.7 and 1.5
_LARGEST_Z, _LARGEST_S0 = 30.0, 100.0


@dataclass(frozen=True)
class Roelands:
    """Roelands' law of pressure and temperature.

    eta = eta0 exp{ (ln eta0 + 9.67) [ -1 + (1 + p/p0)^z ((T - 138)/(T0 - 138))^-S0 ] }, p0 = 196 MPa; z and S0 follow
    from the pressure and the temperature coefficient at p = 0, T = T0.
    """

    name: ClassVar[str] = "roelands"
    source: ClassVar[str] = (
        "Roelands, Correlational aspects of the viscosity-temperature-pressure relationship of oils, TU Delft 1966"
    )
    equations: ClassVar[Equations] = Equations(
        (
            "η = η_0 exp{(ln η_0 + 9.67) [(1 + p/p_0)^z ((T − 138)/(T_0 − 138))^{−S} − 1]}",
            "p_0 = 196 MPa,   η in pascal seconds,   T in kelvin",
        ),
        "z and S follow from the pressure and temperature coefficients at p = 0 and T0.",
        symbols={
            "η_0": "viscosity",
            "T_0": "reference_temperature",
            "z": "exponent of the pressure, pressure_coefficient p_0/(ln η_0 + 9.67) [1]",
            "S": "exponent of the temperature, temperature_coefficient (T_0 − 138)/(ln η_0 + 9.67) [1]",
        },
    )

    viscosity: float = parameter("Pa s", "viscosity at p = 0 and the reference temperature", above=6.4e-5, most=1e3)
    reference_temperature: float = parameter("K", "temperature of that viscosity", least=200.0, most=600.0)
    pressure_coefficient: float = parameter("Pa^-1", "d ln(eta)/dp at p = 0", least=0.0, most=1e-7)
    temperature_coefficient: float = parameter("K^-1", "-d ln(eta)/dT at p = 0", least=0.0, most=0.2)

    @property
    def error(self) -> str:
        """A sentence if the exponents are too large for numbers, as those of oils next to 6.3e-5 Pa s are."""
        _, z, s0 = self._exponents
        if z <= _LARGEST_Z and s0 <= _LARGEST_S0:
            return ""
        return (
            f"lubricant.viscosity.viscosity = {self.viscosity:g} Pa s with pressure_coefficient = "
            f"{self.pressure_coefficient:g} Pa^-1 and temperature_coefficient = {self.temperature_coefficient:g} K^-1 "
            f"gives Roelands' exponents z = {z:.3g} and S = {s0:.3g}; at most {_LARGEST_Z:g} and {_LARGEST_S0:g} are "
            "allowed. Raise the viscosity, or lower the coefficients."
        )

    def __call__(self, pressure: Numbers, temperature: Numbers) -> Numbers:
        scale, z, s0 = self._constants
        exponent = scale * (temperature - 138.0) ** -s0 * (pressure + _P0) ** z
        return exp(minimum(_LN_ETA_INF + exponent, _STIFF))

    @cached_property
    def _constants(self) -> tuple[float, float, float]:
        """ln(eta0 / eta_inf) p0^-z (T0 - 138)^S0, z and S0."""
        log_range, z, s0 = self._exponents
        return log_range * _P0**-z * (self.reference_temperature - 138.0) ** s0, z, s0

    @property
    def _exponents(self) -> tuple[float, float, float]:
        """ln(eta0 / eta_inf), z and S0."""
        log_range, warmth = math.log(self.viscosity) - _LN_ETA_INF, self.reference_temperature - 138.0
        z = self.pressure_coefficient * _P0 / log_range
        s0 = self.temperature_coefficient * warmth / log_range
        return log_range, z, s0


@dataclass(frozen=True)
class Barus:
    """eta = eta0 exp(alpha p - beta (T - T0))."""

    name: ClassVar[str] = "barus"
    error: ClassVar[str] = ""
    source: ClassVar[str] = "Barus, Am. J. Sci. 45 (1893) 87, doi:10.2475/ajs.s3-45.266.87"
    equations: ClassVar[Equations] = Equations(
        ("η = η_0 exp[α p − β (T − T_0)]",),
        symbols={
            "η_0": "viscosity",
            "T_0": "reference_temperature",
            "α": "pressure_coefficient",
            "β": "temperature_coefficient",
        },
    )

    viscosity: float = parameter("Pa s", "viscosity at p = 0 and the reference temperature", least=1e-9, most=1e3)
    reference_temperature: float = parameter("K", "temperature of that viscosity", least=200.0, most=600.0)
    pressure_coefficient: float = parameter("Pa^-1", "d ln(eta)/dp", least=0.0, most=1e-7)
    temperature_coefficient: float = parameter("K^-1", "-d ln(eta)/dT", least=0.0, most=0.2)

    def __call__(self, pressure: Numbers, temperature: Numbers) -> Numbers:
        exponent = self.pressure_coefficient * pressure
        exponent = exponent - self.temperature_coefficient * (temperature - self.reference_temperature)
        return self.viscosity * exp(minimum(exponent, _STIFF))


@dataclass(frozen=True)
class Modulus:
    """The modulus equation: eta = K exp[C / (D + T)] exp{p / [a1 + a2 T + (b1 + b2 T) p]}.

    Vogel's law at p = 0; a1 + a2 T is the inverse of the pressure coefficient, and b1 + b2 T bends ln(eta) downward
    where it is positive. Where the denominator, with or without pressure, is zero or less, beyond any pressure and
    temperature the constants were fitted at, the oil counts as too stiff to flow.
    """

    name: ClassVar[str] = "modulus"
    error: ClassVar[str] = ""
    source: ClassVar[str] = (
        "Gold et al., J. Synth. Lubr. 18 (2001) 51; as in Arana, Larranaga & Ulacia 2019, doi:10.1177/1350650118778655"
    )
    equations: ClassVar[Equations] = Equations(
        ("η = K exp[C/(D + T)] exp{p/[a_1 + a_2 T + (b_1 + b_2 T) p]}",),
        "Vogel's law without pressure, the modulus equation with it.",
        symbols={
            "K": "vogel_viscosity",
            "C": "vogel_slope",
            "D": "vogel_offset",
            "a_1": "modulus",
            "a_2": "modulus_slope",
            "b_1": "bend",
            "b_2": "bend_slope",
        },
    )

    vogel_viscosity: float = parameter("Pa s", "K, viscosity of the hot oil", least=1e-12, most=1.0)
    vogel_slope: float = parameter(
        "K", "C, fall of ln(viscosity) by 1 / (D + T)", least=0.0, most=1e4, quantity="TemperatureDifference"
    )
    vogel_offset: float = parameter(
        "K", "D, minus the temperature of solidification", least=-225.0, most=CELSIUS, quantity="TemperatureDifference"
    )
    modulus: float = parameter("Pa", "a1, inverse of the pressure coefficient, at T = 0 K", least=-1e9, most=1e9)
    modulus_slope: float = parameter("Pa/K", "a2, rise of that with temperature", least=0.0, most=1e7)
    bend: float = parameter("", "b1, rise of the modulus with pressure, at T = 0 K", least=-1.0, most=1.0)
    bend_slope: float = parameter("K^-1", "b2, rise of that with temperature", least=-1e-2, most=1e-2)
    density: float = parameter(
        "kg/m3", "density at 15 degC, p = 0; assumed 870 kg/m3 if not given", least=600.0, most=2500.0,
        default=_ASSUMED_DENSITY,
    )  # fmt: skip
    expansion: float = _expansion()

    def __call__(self, pressure: Numbers, temperature: Numbers) -> Numbers:
        modulus = self.modulus + self.modulus_slope * temperature
        bent = modulus + (self.bend + self.bend_slope * temperature) * pressure
        modulus = np.where(modulus > 0.0, bent, 0.0)
        exponent = pressure / maximum(modulus, pressure / _STIFF + 1.0)  # 1 Pa: no 0 / 0 without pressure
        exponent = exponent + self.vogel_slope / (self.vogel_offset + temperature)
        return self.vogel_viscosity * exp(minimum(exponent, _STIFF))

    def density_at(self, temperature: Numbers) -> Numbers:
        """Return the density [kg/m3] at p = 0."""
        return _density_at(self, temperature)


@dataclass(frozen=True)
class AstmD341:
    """An oil from its data sheet: kinematic viscosities at 40 and 100 degC, density, one pressure coefficient.

    log10 log10(nu + 0.7) = A - B log10 T, nu in mm2/s, for nu above 2 mm2/s; the density falls linearly with
    temperature. Under pressure the modulus equation, eta = eta(0, T) exp{p / [1/alpha + b p]}: the pressure coefficient
    alpha at p = 0 falls with temperature as Roelands' does, as ln(eta(0, T) / 63.1 uPa s), and the bend b grows
    linearly with temperature.
    """

    name: ClassVar[str] = "astm_d341"
    source: ClassVar[str] = (
        "ASTM D341, Standard Practice for Viscosity-Temperature Charts for Liquid Petroleum Products; under pressure "
        "Gold et al., J. Synth. Lubr. 18 (2001) 51; the coefficient's fall with temperature: Roelands, Correlational "
        "aspects of the viscosity-temperature-pressure relationship of oils, TU Delft 1966"
    )
    equations: ClassVar[Equations] = Equations(
        (
            "log_{10} log_{10}(ν + 0.7) = A − B log_{10} T,   ν in mm^2/s",
            "η(0, T) = ν ρ,   ρ = ρ_{15} [1 − ε (T − 288.15)]",
            "η = η(0, T) exp{p/[1/α + b p]}",
            "α = α_0 ln[η(0, T)/η_∞]/ln[η(0, T_0)/η_∞],   b = b_{40} + (b_{100} − b_{40}) (T − 313.15)/60",
        ),
        "A straight line through the data sheet's two viscosities; the density falls linearly "
        "with temperature. Under pressure the modulus equation, with Roelands' fall of the coefficient.",
        symbols={
            "ν": "kinematic viscosity [mm2/s]",
            "A": "constant of the line through viscosity_40 and viscosity_100 [1]",
            "B": "slope of that line [1]",
            "ρ_{15}": "density",
            "ε": "expansion",
            "α_0": "pressure_coefficient",
            "T_0": "reference_temperature",
            "η_∞": "63.1 µPa s [Pa s]",
            "b_{40}": "bend_40",
            "b_{100}": "bend_100",
        },
    )

    viscosity_40: float = parameter(
        "m2/s", "kinematic viscosity at 40 degC, p = 0", least=2e-6, most=0.1, quantity="KinematicViscosity"
    )
    viscosity_100: float = parameter(
        "m2/s", "kinematic viscosity at 100 degC, p = 0", least=1e-6, most=0.1, quantity="KinematicViscosity"
    )
    density: float = parameter("kg/m3", "density at 15 degC, p = 0", least=600.0, most=2500.0)
    pressure_coefficient: float = parameter(
        "Pa^-1", "d ln(viscosity)/dp at p = 0 and the reference temperature", least=0.0, most=1e-7
    )
    reference_temperature: float = parameter("K", "temperature of the pressure coefficient", least=230.0, most=500.0)
    expansion: float = _expansion()
    bend_40: float = parameter(
        "", "rise of the modulus (inverse pressure coefficient) with pressure at 40 degC; assumed that of paraffinic "
        "mineral oils", least=0.0, most=1.0, default=0.0175,
    )  # fmt: skip
    bend_100: float = parameter("", "the same at 100 degC", least=0.0, most=1.0, default=0.0348)

    @property
    def error(self) -> str:
        if self.viscosity_100 >= self.viscosity_40:
            return (
                f"lubricant.viscosity.viscosity_100 = {self.viscosity_100:g} m2/s must be below viscosity_40 = "
                f"{self.viscosity_40:g} m2/s: oils thin when they warm. Exchange the two if they were mixed up."
            )
        if self.bend_100 < self.bend_40:
            return (
                f"lubricant.viscosity.bend_100 = {self.bend_100:g} must be at least bend_40 = {self.bend_40:g}: under "
                "pressure the oil would thicken when it warms. Give both."
            )
        return ""

    def log_viscosity(self, temperature: Numbers) -> Numbers:
        """Return ln(viscosity / 63.1 uPa s) at p = 0."""
        at_40, slope = self._chart
        double_log = minimum(at_40 - slope * log10(temperature / 313.15), _STIFFEST_DOUBLE_LOG)
        kinematic = 1e-6 * (10.0 ** (10.0**double_log) - 0.7)
        return log(kinematic * self.density_at(temperature)) - _LN_ETA_INF

    def density_at(self, temperature: Numbers) -> Numbers:
        """Return the density [kg/m3] at p = 0."""
        return _density_at(self, temperature)

    @cached_property
    def _chart(self) -> tuple[float, float]:
        """A - B log10(313.15) and B of the straight line."""
        at_40, at_100 = (math.log10(math.log10(1e6 * nu + 0.7)) for nu in (self.viscosity_40, self.viscosity_100))
        return at_40, (at_40 - at_100) / math.log10(373.15 / 313.15)

    @cached_property
    def _steepness(self) -> float:
        """Pressure coefficient [1/Pa] per ln(viscosity / eta_inf)."""
        return float(self.pressure_coefficient / self.log_viscosity(self.reference_temperature))

    def __call__(self, pressure: Numbers, temperature: Numbers) -> Numbers:
        thickness = self.log_viscosity(temperature)
        stiffening = maximum(self._steepness * thickness, 0.0) * pressure
        bend = self.bend_40 + (self.bend_100 - self.bend_40) * (temperature - 313.15) / 60.0
        exponent = stiffening / (1.0 + maximum(bend, 0.0) * stiffening)
        return exp(minimum(_LN_ETA_INF + thickness + exponent, _STIFF))


def _density_at(law: Modulus | AstmD341, temperature: Numbers) -> Numbers:
    return law.density * maximum(1.0 - law.expansion * (temperature - _FIFTEEN), 0.1)  # far beyond any oil


def kinematic_viscosity(law: Viscosity, temperature: Numbers) -> Numbers:
    """Return the kinematic viscosity [m2/s] of an oil at p = 0 and temperatures [K].

    Of laws that know no density it is that of an oil of 870 kg/m3.
    """
    density = law.density_at(temperature) if isinstance(law, Modulus | AstmD341) else _ASSUMED_DENSITY
    return law(0.0, temperature) / density


LAWS: tuple[type[Viscosity], ...] = (Roelands, Barus, Modulus, AstmD341)
