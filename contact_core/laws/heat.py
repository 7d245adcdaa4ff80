"""Temperature rise of the real contacts above the bulk."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..quantities import parameter


@dataclass(frozen=True)
class Temperatures:
    surface_1: Any
    surface_2: Any
    film: Any
    into_1: float
    into_2: float
    flash_rise: float
    solved: bool = True


class OilBulk:
    def bodies(self, oil, inputs, stored):
        return oil, oil

    def after(self, temperatures, heat, oil, dt):
        return None


class _S:
    bulk = OilBulk()
    warms_film = False

    def temperatures(self, q, gap, solid, inside, spacing, speeds, us, bodies, k):
        p = float(q.sum()) * spacing**2
        return Temperatures(bodies[0], bodies[1], sum(bodies) / 2, p / 2, p / 2, 0.0)


@dataclass(frozen=True)
class NoHeat(_S):
    """The contacts are as warm as the oil."""

    name: ClassVar[str] = "none"
    source: ClassVar[str] = ""

    def rise(
        self, radius: NDArray[np.float64], shear: NDArray[np.float64], sliding_speed: float
    ) -> NDArray[np.float64]:
        """Zeros in the shape of `radius`."""
        return np.zeros_like(radius)


@dataclass(frozen=True)
class FlashTemperature(_S):
    """Average rise over a circular spot that moves at the sliding speed over both bodies.

    Azam's equation (5-7), the Tian-Kennedy average for a uniform source:
    dT = 1.22 r tau u_s / { sqrt(pi) [ K1 sqrt(0.6575 + u_s r/(2 k1)) + K2 sqrt(0.6575 + u_s r/(2 k2)) ] }.
    """

    name: ClassVar[str] = "flash"
    source: ClassVar[str] = "Tian & Kennedy 1994, doi:10.1115/1.2927035"

    conductivity_1: float = parameter("W/(m K)", "thermal conductivity of body 1", above=0.0, most=1e4)
    conductivity_2: float = parameter("W/(m K)", "thermal conductivity of body 2", above=0.0, most=1e4)
    diffusivity_1: float = parameter("m2/s", "thermal diffusivity of body 1", above=0.0, most=1.0)
    diffusivity_2: float = parameter("m2/s", "thermal diffusivity of body 2", above=0.0, most=1.0)

    def rise(
        self, radius: NDArray[np.float64], shear: NDArray[np.float64], sliding_speed: float
    ) -> NDArray[np.float64]:
        """Temperature rise [K] of spots of `radius` [m] under a mean |shear stress| [Pa]."""
        speed = abs(sliding_speed)
        into_1 = self.conductivity_1 * np.sqrt(0.6575 + speed * radius / (2.0 * self.diffusivity_1))
        into_2 = self.conductivity_2 * np.sqrt(0.6575 + speed * radius / (2.0 * self.diffusivity_2))
        return 1.22 * radius * np.abs(shear) * speed / (np.sqrt(np.pi) * (into_1 + into_2))


LAWS = (NoHeat, FlashTemperature)
