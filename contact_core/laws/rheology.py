"""Shear stress of the film between the surfaces.

A law maps the stress that a Newtonian oil would have, viscosity times shear rate, to the stress of this one. No film
carries more than `limiting_coefficient` times its pressure, of which `limiting_left` is left in a warm oil.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import scipy

from ..kernels.arrays import Array
from ..quantities import parameter
from ..reference import bair_thinning_factor
from .base import Rheology
from .elementary import Numbers, exp
from .equations import Equations

_LIMIT_AT = 313.15  # K, temperature to which a limiting coefficient belongs
_LIMIT = "τ_L = Λ p_f exp[β_L (T_L − T)]"
_OF_THE_LIMIT = "Λ: limiting_coefficient; 0 means no limit."
_SYMBOLS_OF_THE_LIMIT = {
    "Λ": "limiting_coefficient",
    "β_L": "limiting_fall",
    "T": "temperature of the oil [K]",
    "T_L": "40 degC, to which Λ belongs [K]",
    "τ_L": "limiting shear stress [Pa]",
}
_EASIEST = 500.0  # at e^500 times the Newtonian shear rate a film slips: no need to overflow


def _limiting_coefficient() -> Any:
    return parameter("", "limiting shear stress / pressure at 40 degC; 0: no limit", least=0.0, most=1.0, default=0.0)


def _limiting_fall() -> Any:
    return parameter(
        "1/K", "relative fall of the limiting shear stress with temperature", least=0.0, most=0.02, default=0.0
    )


class _Limited(ABC):
    """Laws that are odd in the shear and cut at the limiting stress.

    Bair & Winer, J. Lubr. Technol. 101 (1979) 258. A law gives its `_stress` [Pa] of a Newtonian stress >= 0 and the
    `_slope` of that.
    """

    inlet_thinning: ClassVar[Equations | None] = None  # of the film by shear in the inlet, where a formula is known

    limiting_coefficient: float
    limiting_fall: float

    @abstractmethod
    def _stress(self, newtonian: Array) -> Array: ...

    @abstractmethod
    def _slope(self, newtonian: Array) -> Array: ...

    def __call__(self, newtonian: Array, pressure: Array) -> Array:
        """Return the shear stress [Pa] with the sign of `newtonian`, under a pressure [Pa].

        `newtonian` is viscosity times shear rate [Pa]. The pressure is that of an oil of 40 degC with the same limit.
        """
        stress = self._stress(np.abs(newtonian))
        if self.limiting_coefficient > 0.0:
            stress = np.minimum(stress, self.limiting_coefficient * pressure)
        return np.copysign(stress, newtonian)

    def limiting_left(self, temperature: Numbers) -> Numbers:
        return 1.0 if self.limiting_fall == 0.0 else exp(self.limiting_fall * (_LIMIT_AT - temperature))

    def film_factor(self, newtonian_film: float, speed: float, viscosity: float, slide_roll_ratio: float) -> float:
        return 1.0

    def slopes(self, newtonian: Array, pressure: Array) -> tuple[Array, Array]:
        size = np.abs(newtonian)
        slope = self._slope(size)
        if self.limiting_coefficient == 0.0:
            return slope, np.zeros_like(slope)
        limited = self._stress(size) > self.limiting_coefficient * pressure
        return np.where(limited, 0.0, slope), np.where(limited, np.sign(newtonian) * self.limiting_coefficient, 0.0)


@dataclass(frozen=True)
class Newtonian(_Limited):
    """tau = eta rate."""

    name: ClassVar[str] = "newtonian"
    source: ClassVar[str] = "limit: Bair & Winer, J. Lubr. Technol. 101 (1979) 258, doi:10.1115/1.3453342"
    equations: ClassVar[Equations] = Equations(
        ("τ_{oil} = τ_N,   at most τ_L", _LIMIT),
        _OF_THE_LIMIT,
        symbols=_SYMBOLS_OF_THE_LIMIT,
        left_out=(
            "Shear thinning of the oil: thin films that slide fast rub more than they would, once the Newtonian "
            "stress exceeds some MPa."
        ),
    )
    thins: ClassVar[bool] = False

    limiting_coefficient: float = _limiting_coefficient()
    limiting_fall: float = _limiting_fall()

    def _stress(self, newtonian: Array) -> Array:
        return newtonian

    def _slope(self, newtonian: Array) -> Array:
        return np.ones_like(newtonian)

    def ease(self, stress: Array) -> Array:
        return np.ones_like(stress)


@dataclass(frozen=True)
class Eyring(_Limited):
    """tau = tau_E asinh(eta rate / tau_E)."""

    name: ClassVar[str] = "eyring"
    source: ClassVar[str] = (
        "Johnson & Tevaarwerk 1977, doi:10.1098/rspa.1977.0129; limit: Bair & Winer 1979, doi:10.1115/1.3453342"
    )
    equations: ClassVar[Equations] = Equations(
        ("τ_{oil} = τ_E arsinh(τ_N/τ_E),   at most τ_L", _LIMIT),
        _OF_THE_LIMIT,
        symbols={**_SYMBOLS_OF_THE_LIMIT, "τ_E": "eyring_stress"},
    )
    thins: ClassVar[bool] = True

    eyring_stress: float = parameter(
        "Pa", "shear stress at which the fluid begins to thin", least=1.0, most=1e12, quantity="Stress"
    )
    limiting_coefficient: float = _limiting_coefficient()
    limiting_fall: float = _limiting_fall()

    def _stress(self, newtonian: Array) -> Array:
        return self.eyring_stress * np.arcsinh(newtonian / self.eyring_stress)

    def _slope(self, newtonian: Array) -> Array:
        return 1.0 / np.hypot(1.0, newtonian / self.eyring_stress)

    def ease(self, stress: Array) -> Array:
        x = np.minimum(np.abs(stress) / self.eyring_stress, _EASIEST)
        return np.where(x > 1e-4, np.sinh(x) / np.maximum(x, 1e-300), 1.0 + x * x / 6.0)


@dataclass(frozen=True)
class Carreau(_Limited):
    """tau = eta rate [1 + (eta rate / G)^2]^((n - 1) / 2)."""

    name: ClassVar[str] = "carreau"
    source: ClassVar[str] = (
        "Carreau 1972, doi:10.1122/1.549276; in elastohydrodynamics Bair 2007, ISBN 9780444528803; limit: Bair & Winer "
        "1979, doi:10.1115/1.3453342"
    )
    equations: ClassVar[Equations] = Equations(
        ("τ_{oil} = τ_N [1 + (τ_N/G)^2]^{(n − 1)/2},   at most τ_L", _LIMIT),
        _OF_THE_LIMIT,
        symbols={**_SYMBOLS_OF_THE_LIMIT, "G": "critical_stress", "n": "exponent"},
    )
    inlet_thinning: ClassVar[Equations] = Equations(
        (
            "φ = [1 + 0.79 X^m]^{−q},   X = (1 + |S|) u_e η_0/(h_s G)",
            "m = 1/(1 + 0.2 |S|),   q = 3.6 (1 − n)^{1.7},   S = (u_1 − u_2)/u_e",
        ),
        "Shear thins the oil in the inlet: the film is φ of the Newtonian one.",
        title="Shear thinning in the inlet: lubricant.flow = local",
        source="Bair, Proc. IMechE J 219 (2005) 69",
        symbols={
            "φ": "film thickness over that of a Newtonian oil [1]",
            "S": "slide-to-roll ratio [1]",
            "G": "critical_stress",
            "n": "exponent",
        },
    )
    thins: ClassVar[bool] = True

    critical_stress: float = parameter(
        "Pa", "G, Newtonian stress at which the fluid begins to thin", least=1.0, most=1e12, quantity="Stress"
    )
    exponent: float = parameter("", "n, power of the shear rate in a thin fluid", above=0.0, most=1.0)
    limiting_coefficient: float = _limiting_coefficient()
    limiting_fall: float = _limiting_fall()

    def _stress(self, newtonian: Array) -> Array:
        return newtonian * np.hypot(1.0, newtonian / self.critical_stress) ** (self.exponent - 1.0)

    def _slope(self, newtonian: Array) -> Array:
        root = np.hypot(1.0, newtonian / self.critical_stress)
        return root ** (self.exponent - 1.0) * (self.exponent + (1.0 - self.exponent) / root / root)

    def film_factor(self, newtonian_film: float, speed: float, viscosity: float, slide_roll_ratio: float) -> float:
        """Return the central film thickness over that of a Newtonian oil [m], by Bair's formula.

        At an entrainment speed [m/s] and the viscosity [Pa s] at p = 0.
        """
        oil = (viscosity, self.critical_stress, self.exponent)
        return bair_thinning_factor(newtonian_film, speed, *oil, slide_roll_ratio)

    def ease(self, stress: Array) -> Array:
        """Return the shear rate at a stress [Pa] over that of a Newtonian oil.

        With y = x (1 + x^2)^((n - 1) / 2), v = ln(x / y) solves v = (1 - n) / 2 ln(1 + x^2), x = y e^v. The slope of
        ln y by ln x falls from 1 to n as x rises, so that Newton's method from v = 0 rises to the root of any y.
        """
        target = np.log(np.maximum(np.abs(stress) / self.critical_stress, 1e-9))  # below that it is Newtonian
        v = np.zeros_like(target)
        for _ in range(100):
            u = target + v
            missing = 0.5 * (1.0 - self.exponent) * np.logaddexp(0.0, 2.0 * u) - v
            slope = self.exponent + (1.0 - self.exponent) * scipy.special.expit(-2.0 * u)
            v = np.minimum(v + missing / np.maximum(slope, 1e-12), _EASIEST)
            if np.all((missing <= 1e-15 * (4.0 + np.abs(u))) | (v == _EASIEST)):
                break
        return np.exp(v)


LAWS: tuple[type[Rheology], ...] = (Newtonian, Eyring, Carreau)
