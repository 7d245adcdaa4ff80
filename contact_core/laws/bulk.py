"""Bulk temperatures of the two bodies, above which the contact heats their surfaces."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..quantities import parameter
from .base import Bulk
from .equations import Equations

Pair = tuple[float, float]


@dataclass(frozen=True)
class OilBulk:
    """Both bodies have the temperature of the oil."""

    name: ClassVar[str] = "oil"
    source: ClassVar[str] = "assumed: bodies in thermal equilibrium with the oil"
    follows_oil: ClassVar[bool] = True
    from_inputs: ClassVar[bool] = False
    stores_heat: ClassVar[bool] = False
    equations: ClassVar[Equations] = Equations(
        ("T_{bulk,1} = T_{bulk,2} = T_{oil}",),
        symbols={
            "T_{bulk,1}": "bulk temperature of body 1 [K]",
            "T_{bulk,2}": "bulk temperature of body 2 [K]",
        },
        left_out="Warming of the bodies: both stay at the temperature of the oil, however much heat the contact makes.",
    )

    def bodies(self, oil: float, inputs: tuple[float | None, float | None], stored: Pair | None) -> Pair:
        """Return the bulk temperatures (T_1, T_2) [K]: the oil's."""
        return oil, oil

    def after(self, temperatures: Pair, heat: Pair, oil: float, dt: float) -> Pair:
        """Return the bulk temperatures [K] at the end of a step: the oil's."""
        return oil, oil


@dataclass(frozen=True)
class InputBulk:
    """The inputs body_temperature_1 and _2; a body without one has the temperature of the oil."""

    name: ClassVar[str] = "inputs"
    source: ClassVar[str] = "given by the inputs"
    follows_oil: ClassVar[bool] = False
    from_inputs: ClassVar[bool] = True
    stores_heat: ClassVar[bool] = False
    equations: ClassVar[Equations] = Equations(
        ("T_{bulk,i} = T_{b,i}",),
        "The inputs body_temperature_1 and _2; the heat flows are outputs.",
        symbols={
            "T_{b,i}": "inputs body_temperature_1 and body_temperature_2 [K]",
        },
    )

    def bodies(self, oil: float, inputs: tuple[float | None, float | None], stored: Pair | None) -> Pair:
        first, second = inputs
        return oil if first is None else first, oil if second is None else second

    def after(self, temperatures: Pair, heat: Pair, oil: float, dt: float) -> Pair:
        """Return the bulk temperatures [K] at the end of a step: those given."""
        return temperatures


@dataclass(frozen=True)
class LumpedBulk:
    """Each body is one heat capacity C: C dT/dt = Q - G (T - T_oil).

    It takes up the contact's heat Q and passes it on to the oil. Both bodies start at the temperature of the oil.
    """

    name: ClassVar[str] = "lumped"
    source: ClassVar[str] = "Incropera & DeWitt, Fundamentals of Heat and Mass Transfer, ISBN 9780471457282, chapter 5"
    follows_oil: ClassVar[bool] = False
    from_inputs: ClassVar[bool] = False
    stores_heat: ClassVar[bool] = True
    equations: ClassVar[Equations] = Equations(
        ("C_i ∂T_{bulk,i}/∂t = Q_i − G_i (T_{bulk,i} − T_{oil})",),
        "Exact over a step of constant heat.",
        symbols={
            "C_i": "heat capacity of body i, heat_capacity_1 and heat_capacity_2 [J/K]",
            "Q_i": "heat that the contact puts into body i [W]",
            "G_i": "conductance from body i to the oil, conductance_1 and conductance_2 [W/K]",
        },
    )

    heat_capacity_1: float = parameter("J/K", "C, heat capacity of body 1", least=1e-9, most=1e9)
    heat_capacity_2: float = parameter("J/K", "C, heat capacity of body 2", least=1e-9, most=1e9)
    conductance_1: float = parameter("W/K", "G, thermal conductance from body 1 to the oil", least=0.0, most=1e6)
    conductance_2: float = parameter("W/K", "G, thermal conductance from body 2 to the oil", least=0.0, most=1e6)

    def bodies(self, oil: float, inputs: tuple[float | None, float | None], stored: Pair | None) -> Pair:
        """Return the bulk temperatures (T_1, T_2) [K]: those stored, or the oil's if there are none yet."""
        return (oil, oil) if stored is None else stored

    def after(self, temperatures: Pair, heat: Pair, oil: float, dt: float) -> Pair:
        """Return the bulk temperatures [K] after `dt` [s] under constant heat [W] and oil temperature [K].

        Exact for any `dt`.
        """
        first, second = temperatures
        return (
            _warmed(first, heat[0], self.heat_capacity_1, self.conductance_1, oil, dt),
            _warmed(second, heat[1], self.heat_capacity_2, self.conductance_2, oil, dt),
        )


def _warmed(temperature: float, heat: float, capacity: float, conductance: float, oil: float, dt: float) -> float:
    decay = conductance * dt / capacity
    mean = -float(np.expm1(-decay)) / decay if decay > 0.0 else 1.0  # of exp(-decay) over the step
    return temperature + (heat - conductance * (temperature - oil)) * dt / capacity * mean


LAWS: tuple[type[Bulk], ...] = (OilBulk, InputBulk, LumpedBulk)
