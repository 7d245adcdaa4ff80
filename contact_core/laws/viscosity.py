"""Viscosity as a function of pressure and temperature."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..quantities import parameter

_P0 = 1.0 / 5.1e-9  # Pa
_LN_ETA_INF = -9.67  # ln(6.31e-5 Pa s)
_STIFF = 500.0  # an oil e^500 times stiffer than at p = 0 does not flow: no need to overflow


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

    viscosity: float = parameter("Pa s", "viscosity at p = 0 and the reference temperature", above=6.4e-5, most=1e3)
    reference_temperature: float = parameter("K", "temperature of that viscosity", least=200.0, most=600.0)
    pressure_coefficient: float = parameter("Pa^-1", "d ln(eta)/dp at p = 0", least=0.0, most=1e-7)
    temperature_coefficient: float = parameter("K^-1", "-d ln(eta)/dT at p = 0", least=0.0, most=0.2)

    def __call__(self, pressure: NDArray[np.float64], temperature: NDArray[np.float64] | float) -> NDArray[np.float64]:
        """Viscosity [Pa s] at pressures [Pa] and temperatures [K], arrays or one for all."""
        log_range = np.log(self.viscosity) - _LN_ETA_INF
        z = self.pressure_coefficient * _P0 / log_range
        s0 = self.temperature_coefficient * (self.reference_temperature - 138.0) / log_range
        thermal = ((temperature - 138.0) / (self.reference_temperature - 138.0)) ** -s0
        exponent = log_range * (-1.0 + (1.0 + pressure / _P0) ** z * thermal)
        return self.viscosity * np.exp(np.minimum(exponent, _STIFF))


@dataclass(frozen=True)
class Barus:
    """eta = eta0 exp(alpha p - beta (T - T0))."""

    name: ClassVar[str] = "barus"
    source: ClassVar[str] = "Barus, Am. J. Sci. 45 (1893) 87, doi:10.2475/ajs.s3-45.266.87"

    viscosity: float = parameter("Pa s", "viscosity at p = 0 and the reference temperature", above=0.0, most=1e3)
    reference_temperature: float = parameter("K", "temperature of that viscosity", least=200.0, most=600.0)
    pressure_coefficient: float = parameter("Pa^-1", "d ln(eta)/dp", least=0.0, most=1e-7)
    temperature_coefficient: float = parameter("K^-1", "-d ln(eta)/dT", least=0.0, most=0.2)

    def __call__(self, pressure: NDArray[np.float64], temperature: NDArray[np.float64] | float) -> NDArray[np.float64]:
        """Viscosity [Pa s] at pressures [Pa] and temperatures [K], arrays or one for all."""
        exponent = self.pressure_coefficient * pressure
        exponent = exponent - self.temperature_coefficient * (temperature - self.reference_temperature)
        return self.viscosity * np.exp(np.minimum(exponent, _STIFF))


LAWS = (Roelands, Barus)
