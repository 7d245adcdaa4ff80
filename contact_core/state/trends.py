"""Outputs of blocks without their noise, and how sure they are: those with a `trend` in the quantity table.

A fading-memory filter of level and slope follows each from block to block: its residuals give the sampling error, its
slope the error of time steps. A slope that would carry a level beyond zero is cut, for all parts of a sum alike.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ..kernels.arrays import Array
from ..quantities import OUTPUTS

_OF = {kind: [q for q in OUTPUTS if q.trend == kind] for kind in ("level", "slope", "rate")}
SMOOTHED = tuple(q.name for q in _OF["level"])
SLOPES = tuple(q.name for q in _OF["slope"])
RATES = tuple(q.name for q in _OF["rate"])
RATES_FOLLOWED = tuple(f"{name}_rate" for name in RATES)
NAMES = (*SMOOTHED, *SLOPES, *RATES_FOLLOWED)
_LEAST, _MOST = (
    np.array([getattr(q, bound) for q in _OF["level"]] + [beyond] * (len(NAMES) - len(SMOOTHED)))
    for bound, beyond in (("minimum", -np.inf), ("maximum", np.inf))
)
_FRICTION = np.isin(
    NAMES,
    ["friction_force", "friction_solid", "friction_fluid", "spin_torque", "power_loss", "heat_flow_1", "heat_flow_2"],
)
_MEMORY_OF_SPREAD = 0.1
_NEAREST = 0.5  # part of what is seen: no slope carries a level nearer to zero, unless it has been there
_UNKNOWN = 0.05  # error of time steps, relative, while fewer than two blocks say nothing of a drift


@dataclass(frozen=True)
class Trends:
    """Filter of `SMOOTHED` outputs and of `RATES`, in this order, and the errors the rates have led to so far."""

    level: Array  # [NAMES]
    slope: Array  # per block
    variance: Array  # of one block's mean; before the first block, relative to the level squared
    gain: float  # share of the last block in the level
    lag: float  # by how many blocks the quantities are late
    blocks: int  # since the filter began
    time_error: Array  # [RATES] of the depth so far, by time steps [m], signed
    sampling: Array  # [RATES] variance of the depth so far by sampling [m2]

    def __post_init__(self) -> None:
        for array in (self.level, self.slope, self.variance, self.time_error, self.sampling):
            array.setflags(write=False)

    @staticmethod
    def fresh() -> "Trends":
        """Return a filter before its first block."""
        n, rates = len(NAMES), np.zeros(len(RATES))
        return Trends(np.zeros(n), np.zeros(n), np.zeros(n), 1.0, 0.5, 0, rates, rates)

    def restarted(self) -> "Trends":
        """Return the filter without levels and slopes, for another operating point. Errors so far remain."""
        known = np.divide(self.variance, self.level**2, out=np.zeros_like(self.level), where=self.level != 0.0)
        return replace(Trends.fresh(), variance=known, time_error=self.time_error, sampling=self.sampling)

    def followed(self, seen: Mapping[str, float], spread: Mapping[str, float], memory: float, lag: float) -> "Trends":
        """Return the filter after one more block's means `seen`.

        `spread` is their standard deviation within the block, `memory` (0 to 1) how slowly the filter forgets, `lag` by
        how many blocks the means are late.

        Gains as in Morrison, Introduction to Sequential Smoothing and Prediction, McGraw-Hill 1969: least squares
        over all blocks at first, fading memory later.
        """
        if seen.keys() != set(NAMES):
            wrong = ", ".join(sorted(seen.keys() ^ set(NAMES)))
            raise ValueError(f"{wrong}: an output of a block has a trend in the quantity table, and is computed.")
        x = np.array([seen[name] for name in NAMES])
        n = self.blocks
        if n == 0:
            own = np.array([spread.get(name, 0.0) for name in NAMES])
            variance = np.maximum(own**2, self.variance * x**2)  # as far as known from another operating point
            return replace(self, level=x, slope=np.zeros_like(x), variance=variance, gain=1.0, lag=lag, blocks=1)
        first = max(1.0 - memory**2, 2.0 * (2 * n + 1) / ((n + 1) * (n + 2)))
        second = max((1.0 - memory) ** 2, 6.0 / ((n + 1) * (n + 2)))
        carried = self.slope * self._kept(x, first)
        missed = x - self.level - carried
        level, slope = self.level + carried + first * missed, carried + second * missed
        variance = self.variance
        if n >= 2:  # before that the line goes through all there is
            learn = max(_MEMORY_OF_SPREAD, 1.0 / n)
            variance = variance + learn * (missed**2 * (1.0 - first) - variance)
        return replace(
            self,
            level=np.clip(level, _LEAST, _MOST),
            slope=slope,
            variance=variance,
            gain=first,
            lag=lag,
            blocks=n + 1,
        )

    def _kept(self, x: Array, first: float) -> Array:
        """Return the shares of the slopes, 0 to 1, that carry no level across zero where neither it nor `x` has been.

        They leave a level half of `x`, or itself if it is smaller, and nothing of the slope if one of both is zero;
        those of friction and heat are alike.
        """
        level = self.level
        alike = level * x >= 0.0
        without = np.abs(level + first * (x - level))
        carried = np.sign(level + x) * (1.0 - first) * self.slope
        least = np.minimum(np.abs(level), _NEAREST * np.abs(x))
        crosses = alike & (without + carried < least)
        share = np.divide(least - without, carried, out=np.ones_like(x), where=crosses)
        share[(least == 0.0) & (crosses | ((level == x) & (self.slope != 0.0)))] = 0.0
        share[len(SMOOTHED) :] = 1.0
        share[_FRICTION] = share[_FRICTION].min()
        return share

    def over(self, step: float, block: float) -> "Trends":
        """Return the filter with the errors of a step [s] of a block that is `block` [s] old, if rates are held in it.

        A mean that is late by some blocks is wrong by the slope times these. The rate's own scatter adds up within a
        block and at random between blocks.
        """
        n = len(NAMES) - len(RATES)
        return replace(
            self,
            time_error=self.time_error + self._late()[n:] * step,
            sampling=self.sampling + self.variance[n:] * ((block + step) ** 2 - block**2),
        )

    def slope_of(self, name: str) -> float:
        """Return the change of one of `SMOOTHED` from block to block."""
        return float(self.slope[SMOOTHED.index(name)])

    def values(self) -> dict[str, float]:
        """Return the smoothed outputs."""
        return {name: float(value) for name, value in zip(SMOOTHED, self.level, strict=False)}

    def _late(self) -> Array:
        """Return by how much the means lag behind the present, [NAMES]."""
        late: Array = self.lag * self.slope if self.blocks > 1 else _UNKNOWN * self.level
        return late

    def half_widths(self) -> dict[str, tuple[float, float]]:
        """Return the errors by time steps and by sampling, as half widths (two sigma), of all names followed."""
        sampling = 2.0 * np.sqrt(self.gain * self.variance)
        late = np.abs(self._late())
        found = {name: (float(late[k]), float(sampling[k])) for k, name in enumerate((*SMOOTHED, *SLOPES))}
        for k, name in enumerate(RATES):
            found[name] = abs(float(self.time_error[k])), 2.0 * float(np.sqrt(self.sampling[k]))
        return found
