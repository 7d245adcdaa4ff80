"""Apparent viscosity of films as thin as the electric double layers on both surfaces."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..kernels.arrays import Array
from ..quantities import parameter
from ..reference.constants import BOLTZMANN, ELEMENTARY_CHARGE, VACUUM_PERMITTIVITY
from .base import DoubleLayer
from .equations import Equations

_THIN = 0.03  # half the gap over Debye's length, below which series replace differences of nearly equal numbers


@dataclass(frozen=True)
class NoDoubleLayer:
    """No charge on the surfaces: the viscosity does not depend on the gap."""

    name: ClassVar[str] = "none"
    source: ClassVar[str] = ""
    equations: ClassVar[Equations] = Equations(
        ("η_a = η",),
        "The viscosity does not depend on the gap.",
        symbols={
            "η_a": "apparent viscosity [Pa s]",
        },
        left_out=(
            "Electric double layers: some 2 % of the viscosity of thin films of oil at most, but up to 29 % of that of "
            "water."
        ),
    )
    acts: ClassVar[bool] = False

    def __call__(self, gap: Array, temperature: float) -> Array:
        return np.ones_like(gap)


@dataclass(frozen=True)
class Electroviscous:
    """Flow between charged surfaces carries the ions of their double layers along, and their field holds it back.

    The current of a flow under pressure and that of the streaming potential cancel. Ions follow Stokes' law, so that
    viscosity times conductivity is the same under all pressures (Walden's rule) and the effect one of the gap alone.
    For low potentials (Debye & Hueckel), equal on both surfaces, and ions of one radius. The flow is exact for that;
    that the shear stress has the apparent viscosity of the flow is assumed.
    """

    name: ClassVar[str] = "electroviscous"
    source: ClassVar[str] = (
        "flow without a net current as in Jing, Pan & Wang 2017, doi:10.3762/bjnano.8.152, here for low potentials"
    )
    equations: ClassVar[Equations] = Equations(
        (
            "η_a/η = 1/{1 − 3 z G^2/[k^2 (1 + z B)]},   k = h/(2 λ_D)",
            "G = 1 − tanh k/k,   B = (tanh k/k − 1/cosh^2 k)/2,   z = 6 π a ε ζ^2/(k_B T)",
        ),
        "λ D is Debye's length, ζ the potential of the surfaces, ε the permittivity of the oil, a the radius of the "
        "ions. For e ζ up to k_B T.",
        symbols={
            "η_a": "apparent viscosity [Pa s]",
            "λ_D": "debye_length",
            "a": "ion_radius",
            "ε": "permittivity of the oil, relative_permittivity times that of vacuum [F/m]",
            "ζ": "zeta potential of both surfaces, zeta_energy over the elementary charge [V]",
        },
    )
    acts: ClassVar[bool] = True

    zeta_energy: float = parameter(
        "J", "e zeta: energy of an elementary charge at the zeta potential of both surfaces", least=0.0, most=8.02e-21
    )
    debye_length: float = parameter("m", "thickness of the double layers", above=0.0, most=1e-5)
    relative_permittivity: float = parameter("", "permittivity of the oil over that of vacuum", least=1.0, most=200.0)
    ion_radius: float = parameter("m", "radius of the ions and what moves with them, by Stokes", above=0.0, most=1e-7)

    def strength(self, temperature: float) -> float:
        """Return z, the drag of the ions over the pull of the surfaces' potential, at a temperature [K]."""
        permittivity = self.relative_permittivity * VACUUM_PERMITTIVITY
        zeta = self.zeta_energy / ELEMENTARY_CHARGE
        return 6.0 * math.pi * self.ion_radius * permittivity * zeta**2 / (BOLTZMANN * temperature)

    def __call__(self, gap: Array, temperature: float) -> Array:
        k = np.asarray(gap) / (2.0 * self.debye_length)
        z = self.strength(temperature)
        tanh, square = np.tanh(k), k * k
        wide = np.maximum(k, _THIN)
        carried = np.where(k < _THIN, square / 3.0 - square**2 / 7.5, 1.0 - tanh / wide)
        spent = np.where(k < _THIN, square / 3.0 - square**2 / 3.75, 0.5 * (tanh / wide - 1.0 + tanh * tanh))
        return np.asarray(1.0 / (1.0 - 3.0 * z * carried**2 / (square * (1.0 + z * spent))))


LAWS: tuple[type[DoubleLayer], ...] = (NoDoubleLayer, Electroviscous)
