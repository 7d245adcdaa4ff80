"""Reduced peak height Spk of a surface (ISO 25178-2, ISO 13565-2) from its heights [m]."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

Array = NDArray[np.float64]

CORE = 0.4  # share of the area under the secant of least slope
LEVELS = 1001  # heights at which a bearing curve is known
BEYOND = 5.0  # rms heights below the grid that a curve goes on beyond the heights on it


@dataclass(frozen=True)
class BearingCurve:
    """Abbott's curve: the share of the area that is higher than a height [m], at rising heights."""

    heights: Array
    share: Array  # falls from 1 to 0

    @staticmethod
    def of(heights: Array, below: float = 0.0) -> "BearingCurve":
        """Return the curve of heights on a grid [m] with Gaussian roughness of rms `below` [m] beneath it.

        What the grid does not show is independent of what it shows, so the curve is the mean of Gaussian ones about
        the heights of the nodes.
        """
        z = np.sort(heights, axis=None)
        levels = np.linspace(z[0] - BEYOND * below, z[-1] + BEYOND * below, LEVELS)
        if below == 0.0:
            # a node stands for a cell, within which heights pass to its neighbour's in the order of heights
            return BearingCurve(levels, 1.0 - np.interp(levels, z, (np.arange(z.size) + 0.5) / z.size, 0.0, 1.0))
        nodes = np.quantile(z, (np.arange(LEVELS) + 0.5) / LEVELS)
        return BearingCurve(levels, ndtr((nodes - levels[:, None]) / below).mean(axis=1))

    def beside(self, other: "BearingCurve") -> "BearingCurve":
        """Return the curve of the sum of two surfaces that pass each other: every height of one meets every other's."""
        quantiles = self.at((np.arange(LEVELS) + 0.5) / LEVELS)
        levels = np.linspace(self.heights[0] + other.heights[0], self.heights[-1] + other.heights[-1], LEVELS)
        share = np.interp(levels[:, None] - quantiles, other.heights, other.share, 1.0, 0.0).mean(axis=1)
        return BearingCurve(levels, share)

    def at(self, share: Array | float) -> Array:
        """Return the heights [m] that these shares of the area exceed."""
        return np.interp(share, self.share[::-1], self.heights[::-1])

    @property
    def reduced_peak_height(self) -> float:
        """Spk [m]: the height of a triangle as large as the peaks above the core, on their share of the area.

        The core lies between the ends, at 0 and 1, of the secant over 40 % of the area whose slope is least.
        """
        starts = np.linspace(0.0, 1.0 - CORE, 1201)
        drops = self.at(starts) - self.at(starts + CORE)
        k = int(np.argmin(drops))
        top = float(self.at(starts[k]) + drops[k] / CORE * starts[k])
        above, share_at_top = self.heights > top, float(np.interp(top, self.heights, self.share))
        if share_at_top <= 0.0:
            return 0.0
        z, share = np.append(top, self.heights[above]), np.append(share_at_top, self.share[above])
        return 2.0 * float(np.trapezoid(share, z)) / share_at_top
