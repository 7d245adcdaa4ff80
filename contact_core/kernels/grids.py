"""Transfer between a grid and that of half its nodes.

Every other node of an odd number, means of pairs of an even one.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .arrays import Array


def restrict(field: NDArray[Any]) -> NDArray[Any]:
    """Return a field [ny, nx], or coordinates [n], on the coarser grid."""
    for axis in range(field.ndim):
        field = np.moveaxis(field, axis, 0)
        even = field[0::2]
        field = np.moveaxis(even if field.shape[0] % 2 else 0.5 * (even + field[1::2]), 0, axis)
    return np.ascontiguousarray(field)


def prolong(field: NDArray[Any], shape: tuple[int, int]) -> Array:
    """Return a field of the coarser grid on one of `shape` [ny, nx], by linear interpolation."""
    for axis, n in enumerate(shape):
        if field.shape[axis] == n:
            continue
        coarse = np.arange(field.shape[axis]) * 2.0 + (0.0 if n % 2 else 0.5)
        at = np.clip(np.arange(n), coarse[0], coarse[-1])
        low = np.minimum(((at - coarse[0]) / 2.0).astype(np.int64), field.shape[axis] - 2)
        part = (at - coarse[low]) / 2.0
        field = np.moveaxis(field, axis, 0)
        part = part.reshape(-1, *([1] * (field.ndim - 1)))
        field = np.moveaxis((1.0 - part) * field[low] + part * field[low + 1], 0, axis)
    return np.ascontiguousarray(field)
