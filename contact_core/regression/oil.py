"""Friction and temperature of the oil in a Hertzian mean contact, for several operating points at once."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..arrays import Array
from ..errors import ConvergenceError
from ..laws.base import Heat
from ..reference import Hertz
from ..scene import Scene

Pair = tuple[Array, Array]  # of body 1 and 2
# laws take anything that broadcasts: plain floats, which are faster than arrays of one, and arrays of temperatures
Law = Callable[..., Any]

_ROUNDS = 100  # of the oil's temperature, at most
# largest rise over that of smooth bodies: geometric mean of 25 contacts of the deterministic level, docs/physics.md
_ROUGH = 1.28
_SETTLED = 1e-8  # misfit that ends them, over the rise and 1 K


def oil_shear(scene: Scene, hertz: Hertz, pressures: Array, rates: Array, grips: Array, temperatures: Array) -> Array:
    """Return the mean shear stress [Pa] of oil under Hertz's pressure.

    `pressures` are the largest at each point, `grips` the shares of the limiting stress (`FilmBlend.grip`).
    """
    parts, weights = hertz.pressure_nodes
    local = parts * pressures
    viscosity: Law = scene.lubricant.viscosity
    rheology = scene.lubricant.rheology
    newtonian = viscosity(local, temperatures) * rates
    shear: Array = weights @ rheology(newtonian, local * grips * rheology.limiting_left(temperatures))
    return shear


class MeanHeat(NamedTuple):
    """Heat of friction that leaves through Hertz's contact; both surfaces as warm. Arrays have one row per point."""

    conductance_1: Array  # of the bodies [W/(m2 K)]
    conductance_2: Array
    body_1: Array  # bulk temperatures [K]
    body_2: Array
    areas: Array  # [m2]
    across: Array  # rise of the oil over the surfaces, per heat [m2 K/W]
    at_peak: float  # conductance of both bodies by their largest rise, at the first point [W/(m2 K)]

    @staticmethod
    def of(
        law: Heat,
        hertz: Hertz,
        speeds: Pair,
        bodies: Pair,
        areas: Array,
        gaps: Array,
        oil_conductivity: Array | float,
    ) -> "MeanHeat":
        """Return the heat of both bodies, half spaces at their speeds [m/s] under an even source that holds still.

        The source lies on a circle of the ellipse's area, or on the strip.
        """
        first, second = hertz.conductances(law, areas, speeds)
        peak = hertz.conductances(law, areas[:1], (speeds[0][:1], speeds[1][:1]), hottest=True)
        at_peak = float(peak[0][0] + peak[1][0])
        return MeanHeat(first, second, *bodies, areas, gaps / (12.0 * oil_conductivity), at_peak)

    def _surfaces(self, power: Array) -> Array:
        """Return the temperature [K] of the surfaces under a power [W]."""
        one, two = self.conductance_1, self.conductance_2
        return (power / self.areas + one * self.body_1 + two * self.body_2) / (one + two)

    def film(self, start: Array, power: Callable[[Array], Array]) -> Array:
        """Return the temperature [K] of the oil at which its own friction makes it that warm, from a guess.

        By secants in a bracket: the warmer, the less friction. Raises ConvergenceError if it cannot be found.
        """
        low = self._surfaces(np.zeros_like(start))
        high = np.full_like(start, np.inf)
        film, before, missing_before = start, start, np.zeros_like(start)
        for count in range(_ROUNDS):
            heat = power(film)
            missing = self._surfaces(heat) + heat / self.areas * self.across - film
            if np.abs(missing).max() <= _SETTLED * (1.0 + float(np.abs(film - start).max())):
                return film
            low, high = np.where(missing > 0.0, film, low), np.where(missing < 0.0, film, high)
            # warmer oil makes less heat: the answer lies between a guess and what it makes of the oil
            high = np.minimum(high, film + np.maximum(missing, 0.0))
            low = np.maximum(low, film + np.minimum(missing, 0.0))
            step = film - before
            slope = np.divide(missing - missing_before, step, out=np.full_like(step, -1.0), where=step != 0.0)
            before, missing_before = film, missing
            film = film - missing / np.minimum(slope, -1e-12)
            outside = (film <= low) | (film >= high) | (count % 4 == 3)
            film = np.where(outside & (missing != 0.0), 0.5 * (low + high), film)
        raise ConvergenceError(
            f"The temperature of the oil that its own friction warms was not found in {_ROUNDS} rounds. Give the oil a "
            "limiting stress (lubricant.rheology.limiting_coefficient), or lower load or sliding speed."
        )

    def surface(self, power: float) -> tuple[float, float]:
        """Return the rise [K] of the surfaces over the bodies' mean and heat [W] into body 1, at the first point."""
        warm = float(self._surfaces(np.full_like(self.areas, power))[0])
        into_1 = float(self.areas[0] * self.conductance_1[0]) * (warm - float(self.body_1[0]))
        return warm - 0.5 * float(self.body_1[0] + self.body_2[0]), into_1

    def hottest(self, power: float) -> float:
        """Return the largest temperature [K] of the surfaces at the first point, of heat spread as Hertz's pressure."""
        unheated = float(self._surfaces(np.zeros_like(self.areas))[0])
        return unheated + _ROUGH * power / (float(self.areas[0]) * self.at_peak)
