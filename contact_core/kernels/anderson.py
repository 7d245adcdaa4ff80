"""Anderson acceleration of a fixed point x -> g(x), with a ring of at most `depth` differences.

Source: Walker & Ni, SIAM J. Numer. Anal. 49 (2011) 1715, doi:10.1137/10078356X. Sums are in a fixed order.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]


@njit(cache=True, nogil=True)
def _store(residual, residual_old, image, image_old, d_residual, d_image, gram, slot, used):  # type: ignore[no-untyped-def]
    for i in range(residual.size):
        d_residual[slot, i] = residual[i] - residual_old[i]
        d_image[slot, i] = image[i] - image_old[i]
    for k in range(used):
        total = 0.0
        for i in range(residual.size):
            total += d_residual[slot, i] * d_residual[k, i]
        gram[slot, k] = total
        gram[k, slot] = total


@njit(cache=True, nogil=True)
def _project(residual, d_residual, used):  # type: ignore[no-untyped-def]
    right = np.zeros(used)
    for k in range(used):
        total = 0.0
        for i in range(residual.size):
            total += residual[i] * d_residual[k, i]
        right[k] = total
    return right


@njit(cache=True, nogil=True)
def _combine(image, d_image, theta):  # type: ignore[no-untyped-def]
    mixed = image.copy()
    for k in range(theta.size):
        for i in range(image.size):
            mixed[i] -= theta[k] * d_image[k, i]
    return mixed


class Anderson:
    """Memory of one fixed-point iteration."""

    def __init__(self, size: int, depth: int) -> None:
        self._d_residual = np.zeros((depth, size))
        self._d_image = np.zeros((depth, size))
        self._gram = np.zeros((depth, depth))
        self.clear()

    def clear(self) -> None:
        """Forget everything."""
        self._old: tuple[Array, Array] | None = None
        self._stored = 0

    def mix(self, x: Array, image: Array) -> Array:
        """Return the next iterate from `x` and its image g(x) (1-D, not changed); the image itself where mixing is
        unsafe.
        """
        residual, depth = image - x, self._gram.shape[0]
        if self._old is not None:
            slot = self._stored % depth
            self._stored += 1
            _store(
                residual,
                self._old[0],
                image,
                self._old[1],
                self._d_residual,
                self._d_image,
                self._gram,
                slot,
                min(self._stored, depth),
            )
        self._old = (residual, image)
        used = min(self._stored, depth)
        if used == 0:
            return image
        gram = self._gram[:used, :used].copy()
        gram[np.diag_indices(used)] *= 1.0 + 1e-6
        gram[np.diag_indices(used)] += 1e-300
        theta = np.linalg.solve(gram, _project(residual, self._d_residual, used))
        if not np.all(np.isfinite(theta)) or np.abs(theta).sum() > 3.0:
            return image
        return _combine(image, self._d_image, theta)
