"""Surfaces that give way node by node under their own pressure, on top of the half space: soft layers that yield.

    u(p) = soft p + slope [max(p - first, 0) + max(p - second, 0)]

u never falls with p, so that a dry contact still minimises a convex energy: it has one solution, however steep u is.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .arrays import Array


@dataclass(frozen=True)
class SurfaceGive:
    """By how much nodes give way. Arrays [ny, nx]; units of the caller."""

    soft: Array  # elastic depth per pressure
    first: Array  # pressure above which a node yields
    second: Array  # pressure above which it yields twice as much; at least `first`
    slope: float  # plastic depth per pressure above each of them

    def at(self, pressure: Array) -> Array:
        """Return the depth, elastic and plastic, under a pressure."""
        return self.soft * pressure + self.yielded(pressure)

    def yielded(self, pressure: Array) -> Array:
        """Return the plastic depth under a pressure."""
        both = np.maximum(pressure - self.first, 0.0) + np.maximum(pressure - self.second, 0.0)
        return np.asarray(self.slope * both)

    def slope_at(self, pressure: Array) -> Array:
        """Return the derivative of the depth by the pressure."""
        yields = (pressure > self.first).astype(np.float64) + (pressure > self.second)
        return np.asarray(self.soft + self.slope * yields)

    def energy(self, pressure: Array) -> float:
        """Return the sum over the nodes of the integral of the depth over the pressure."""
        beyond = np.maximum(pressure - self.first, 0.0) ** 2 + np.maximum(pressure - self.second, 0.0) ** 2
        return 0.5 * float((self.soft * pressure**2 + self.slope * beyond).sum())

    def above(self, pressure: Array) -> "SurfaceGive":
        """Return the give under a pressure that adds to another one, less the elastic part of that one's depth."""
        return SurfaceGive(self.soft, self.first - pressure, self.second - pressure, self.slope)

    def scaled(self, pressure: float, depth: float) -> "SurfaceGive":
        """Return the give in other units of pressure and depth, given in those at hand."""
        per = pressure / depth
        return SurfaceGive(self.soft * per, self.first / pressure, self.second / pressure, self.slope * per)

    def mapped(self, change: Callable[[Array], Array]) -> "SurfaceGive":
        """Return the give with every array changed alike, such as mirrored or restricted."""
        return SurfaceGive(change(self.soft), change(self.first), change(self.second), self.slope)
