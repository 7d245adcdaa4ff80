"""Load cycles and von Mises stress below the smooth bodies of a contact with friction: a table, made once.

In the largest pressure and Hertz's half widths: by depth, place across the track, friction, shape of the ellipse.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..kernels.arrays import Array, Indices
from ..kernels.load_cycle import cycle_of
from ..kernels.stress_measures import von_mises
from ..scene.records import POISSON

_DEPTHS = np.geomspace(0.004, 12.0, 48)  # over the half width along x
_LOGS = np.log(_DEPTHS)
_FRICTION = np.linspace(0.0, 0.4, 6)
_ROWS = np.linspace(0.0, 1.5, 16)  # over the half width along y
_WAY = 1.5  # on either side of the contact, over its half width: the load beyond is next to none
_NODES = 24  # of a half width, of the shorter one
_MOST = 481  # rows or columns
_ALIKE = 0.02  # of the logarithm of the ratio of half widths: as far apart two ellipses share a table


@dataclass(frozen=True)
class SmoothCycles:
    """Stresses over Hertz's largest pressure by friction, place across the track and depth."""

    cycles: Array  # of a `Cycle`, [3, friction, depths, rows]
    von_mises: Array  # largest of a depth, [friction, depths]

    def at(self, friction: float, rows: Array, depths: Array) -> tuple[Array, Array]:
        """Return cycles at rows over b and depths over a, [3, depths, rows], and the largest von Mises stress [depths].

        Friction, depths and rows beyond the table count as its ends.
        """
        m, part = _place(friction / _FRICTION[1], _FRICTION.size)
        cycles, largest = self.cycles[:, m], self.von_mises[m]
        if part != 0.0:
            cycles = cycles + part * (self.cycles[:, m + 1] - cycles)
            largest = largest + part * (self.von_mises[m + 1] - largest)
        k, share = _places((np.log(depths) - _LOGS[0]) / (_LOGS[1] - _LOGS[0]), _DEPTHS.size)
        low = largest[k]
        peak = low + share * (largest[k + 1] - low)
        layers = cycles[:, k]
        layers = layers + share[:, None] * (cycles[:, k + 1] - layers)
        j, share = _places(rows / _ROWS[1], _ROWS.size)
        low = layers[:, :, j]
        return low + share * (layers[:, :, j + 1] - low), peak


def _place(place: float, size: int) -> tuple[int, float]:
    """Return the entry of a table before a place, and how far beyond it that is."""
    k = min(max(int(place), 0), size - 2)
    return k, min(max(place - k, 0.0), 1.0)


def _places(places: Array, size: int) -> tuple[Indices, Array]:
    k = np.minimum(np.maximum(places, 0.0).astype(np.int64), size - 2)
    return k, np.minimum(np.maximum(places - k, 0.0), 1.0)


def smooth_cycles(ratio: float | None, slope: float, residual: float) -> SmoothCycles:
    """Return the table of an ellipse of b / a = `ratio`, None: of a line; made at the first call.

    Parameters
    ----------
    ratio
        Half width along y over that along x.
    slope
        Weight of the hydrostatic stress in Dang Van's criterion.
    residual
        Residual stress along the surface over Hertz's largest pressure. Von Mises' stress is that beside it; the cycles
        are without it: it adds 2/3 of itself to hydrostatic stresses.

    """
    shape = None if ratio is None else round(math.log(ratio) / _ALIKE)
    return _table(shape, slope, residual)


@lru_cache(maxsize=16)
def _table(shape: int | None, slope: float, residual: float) -> SmoothCycles:
    from ..kernels.subsurface import Subsurface  # the compiler: loaded where stresses are asked for

    ratio = None if shape is None else math.exp(shape * _ALIKE)
    if ratio is None:
        spacing, rows, across = 1.0 / _NODES, np.zeros(_ROWS.size, np.int64), np.zeros(1)
    else:
        fine = max(min(1.0, ratio) / _NODES, 2.0 * _WAY * max(1.0, ratio) / _MOST)
        apart = math.ceil(_ROWS[1] * ratio / fine)  # nodes between the rows of the table
        spacing, rows = _ROWS[1] * ratio / apart, apart * np.arange(_ROWS.size)
        across = spacing * np.arange(-rows[-1], rows[-1] + 1) / ratio
    along = spacing * np.arange(-math.ceil(_WAY / spacing), math.ceil(_WAY / spacing) + 1)
    pressure = np.sqrt(np.maximum(1.0 - along[None, :] ** 2 - across[:, None] ** 2, 0.0))
    kernel = Subsurface(pressure.shape, spacing, _DEPTHS, POISSON, "scipy", periodic=ratio is None)
    unloaded = residual * np.array([1.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    found, largest = np.empty((3, _FRICTION.size, _DEPTHS.size, _ROWS.size)), np.empty((_FRICTION.size, _DEPTHS.size))
    both = zip(kernel.layers(pressure), kernel.layers(np.zeros_like(pressure), pressure), strict=True)
    for z, (pressed_, sheared) in enumerate(both):
        for m, friction in enumerate(_FRICTION):
            stress = pressed_ + friction * sheared
            largest[m, z] = von_mises(stress + unloaded[:, None, None]).max()
            history = np.ascontiguousarray(np.moveaxis(stress[:, rows[-1] + rows], 2, 0))
            found[:, m, z] = cycle_of(history, np.zeros(6), slope)
    for table in (found, largest):
        table.setflags(write=False)
    return SmoothCycles(found, largest)
