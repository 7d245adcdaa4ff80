"""Anderson acceleration of a fixed point x -> g(x), with at most `depth` differences.

Source: Walker & Ni, SIAM J. Numer. Anal. 49 (2011) 1715, doi:10.1137/10078356X. Sums are in a fixed order.
"""

import numpy as np

from .arrays import Array
from .compiled import jit

_CHUNK = 512  # entries of the vectors that are treated together, so that they stay in the fastest cache
_REGULAR = 1e-6
_LARGEST = 3.0  # sum of the magnitudes of the mixing weights


@jit
def _dot(a, b):  # type: ignore[no-untyped-def]
    """Return the dot product, as four sums side by side: no addition waits for the one before."""
    s0, s1, s2, s3 = 0.0, 0.0, 0.0, 0.0
    whole = a.size - a.size % 4
    for i in range(0, whole, 4):
        s0 += a[i] * b[i]
        s1 += a[i + 1] * b[i + 1]
        s2 += a[i + 2] * b[i + 2]
        s3 += a[i + 3] * b[i + 3]
    for i in range(whole, a.size):
        s0 += a[i] * b[i]
    return (s0 + s1) + (s2 + s3)


@jit
def _remember(x, images, residuals, gram, slot, used):  # type: ignore[no-untyped-def]
    """Compute the residual of the newest image and its products with all residuals that are held."""
    for k in range(used):
        gram[slot, k] = 0.0
    for first in range(0, x.size, _CHUNK):
        part = slice(first, min(first + _CHUNK, x.size))
        new, image, old = residuals[slot, part], images[slot, part], x[part]
        for i in range(new.size):
            new[i] = image[i] - old[i]
        for k in range(used):
            gram[slot, k] += _dot(new, residuals[k, part])
    for k in range(used):
        gram[k, slot] = gram[slot, k]


@jit
def _weights(gram, slot, used):  # type: ignore[no-untyped-def]
    """Return the weights of the images, with sum 1, that minimise the residual.

    Where mixing is unsafe, all weight is on the newest image.
    """
    rows, n = gram.shape[0], used - 1
    at = np.empty(used, np.int64)  # oldest first
    for k in range(used):
        at[k] = (slot + 1 + k) % rows if used == rows else k
    a, b = np.empty((n, n)), np.empty(n)
    for k in range(n):
        k0, k1 = at[k], at[k + 1]
        b[k] = gram[slot, k1] - gram[slot, k0]
        for m in range(n):
            m0, m1 = at[m], at[m + 1]
            a[k, m] = (gram[k1, m1] - gram[k1, m0]) - (gram[k0, m1] - gram[k0, m0])
        a[k, k] += _REGULAR * a[k, k] + 1e-300
    for k in range(n):  # positive definite: no pivoting
        for m in range(k + 1, n):
            factor = a[m, k] / a[k, k]
            for q in range(k, n):
                a[m, q] -= factor * a[k, q]
            b[m] -= factor * b[k]
    size = 0.0
    for k in range(n - 1, -1, -1):
        for m in range(k + 1, n):
            b[k] -= a[k, m] * b[m]
        b[k] /= a[k, k]
        size += abs(b[k])
    weights = np.zeros(rows)
    weights[slot] = 1.0
    if size <= _LARGEST:  # false for NaN
        for k in range(n):
            weights[at[k + 1]] -= b[k]
            weights[at[k]] += b[k]
    return weights


@jit
def _combine(images, weights, used, x):  # type: ignore[no-untyped-def]
    for first in range(0, x.size, _CHUNK):
        part = slice(first, min(first + _CHUNK, x.size))
        new = x[part]
        new[:] = 0.0
        for k in range(used):
            image, weight = images[k, part], weights[k]
            if weight != 0.0:
                for i in range(new.size):
                    new[i] += weight * image[i]


class Anderson:
    """Memory of one fixed-point iteration of vectors [size].

    Each round the caller writes the image of x into `image` and calls `mix`.
    """

    def __init__(self, size: int, depth: int) -> None:
        self._images = np.zeros((depth + 1, size))
        self._residuals = np.zeros((depth + 1, size))
        self._gram = np.zeros((depth + 1, depth + 1))
        self._stored = 0

    def clear(self) -> None:
        """Discard all stored images."""
        self._stored = 0

    @property
    def image(self) -> Array:
        """Array that takes the next image g(x)."""
        return self._images[self._slot]

    @property
    def _slot(self) -> int:
        return self._stored % len(self._gram)

    def mix(self, x: Array) -> None:
        """Replace x, whose image has been written, by the next iterate."""
        slot = self._slot
        self._stored += 1
        used = min(self._stored, len(self._gram))
        _remember(x, self._images, self._residuals, self._gram, slot, used)
        _combine(self._images, _weights(self._gram, slot, used), used, x)
