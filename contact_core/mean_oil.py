"""Friction and warmth of the oil under a Hertzian mean contact, for several operating points at once."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .laws.heat import TemperatureField
from .scene import Scene

Array = NDArray[np.float64]
Pair = tuple[Array, Array]  # of body 1 and 2
# laws take anything that broadcasts: plain floats, which are faster than arrays of one, and arrays of temperatures
Law = Callable[..., Any]

# quadrature over the Hertz ellipse: at the distance sqrt(1 - t^2) from its centre p is in proportion to t, dA to t dt
_T = 0.5 + 0.5 * np.polynomial.legendre.leggauss(10)[0][:, None]
_WEIGHTS = _T[:, 0] * np.polynomial.legendre.leggauss(10)[1]  # of the mean over the ellipse
_ROUNDS, _SETTLED = 30, 1e-7  # of the oil's temperature: at most, and the change [K] that ends them


def oil_shear(scene: Scene, pressures: Array, rates: Array, grips: Array, temperatures: Array) -> Array:
    """Mean shear stress [Pa] of oil under Hertz's semi-ellipsoids of largest `pressures`, one for each point; `grips`
    are the shares of the limiting stress (`FilmBlend.grip`).
    """
    local = _T * pressures
    viscosity: Law = scene.lubricant.viscosity
    newtonian = viscosity(local, temperatures) * rates
    shear: Array = _WEIGHTS @ scene.lubricant.rheology(newtonian, local * grips)
    return shear


class MeanHeat(NamedTuple):
    """Heat of friction that leaves through the Hertz ellipse; both surfaces as warm. Arrays have one row per point."""

    conductance_1: Array  # of the bodies [W/(m2 K)]
    conductance_2: Array
    body_1: Array  # bulk temperatures [K]
    body_2: Array
    areas: Array  # [m2]
    across: Array  # rise of the oil over the surfaces, per heat [m2 K/W]

    @staticmethod
    def of(
        law: TemperatureField, speeds: Pair, bodies: Pair, areas: Array, gaps: Array, oil_conductivity: float
    ) -> "MeanHeat":
        """Both bodies as half spaces at their speeds [m/s] under an even source that holds still, on a circle as large
        as the ellipse.
        """
        first, second = law.conductances(np.sqrt(areas / math.pi), speeds)
        return MeanHeat(first, second, *bodies, areas, gaps / (12.0 * oil_conductivity))

    def _surfaces(self, power: Array) -> Array:
        """Temperature [K] of the surfaces under a power [W]."""
        one, two = self.conductance_1, self.conductance_2
        return (power / self.areas + one * self.body_1 + two * self.body_2) / (one + two)

    def film(self, start: Array, power: Callable[[Array], Array]) -> Array:
        """Temperature [K] of the oil with which its friction makes it that warm, by Steffensen's method."""

        def warmed(film: Array) -> Array:
            heat = power(film)
            return self._surfaces(heat) + heat / self.areas * self.across

        film = start
        for _ in range(_ROUNDS):
            first = warmed(film)
            second = warmed(first)
            bend = second - 2.0 * first + film
            jump = np.divide((first - film) ** 2, bend, out=np.zeros_like(bend), where=np.abs(bend) > 1e-12)
            film, change = np.where(np.abs(bend) > 1e-12, film - jump, second), np.abs(second - first).max()
            film = np.clip(film, np.minimum(start, second), np.maximum(first, second) + np.abs(first - start))
            if change < _SETTLED:
                break
        return film

    def surface(self, power: float) -> tuple[float, float]:
        """Rise [K] of the surfaces over the bodies' mean and heat [W] into body 1, at the first point."""
        warm = float(self._surfaces(np.full_like(self.areas, power))[0])
        into_1 = float(self.areas[0] * self.conductance_1[0]) * (warm - float(self.body_1[0]))
        return warm - 0.5 * float(self.body_1[0] + self.body_2[0]), into_1
