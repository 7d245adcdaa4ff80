"""x' = A x + B u under held u, over any step: x(h) = exp(A h) x(0) + integral of exp(A s) ds B u.

Source: Van Loan, IEEE Trans. Autom. Control 23 (1978) 395, doi:10.1109/TAC.1978.1101743.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
import scipy  # its parts are loaded at their first use

from contact_core.arrays import Array

Matrix = tuple[tuple[float, ...], ...]  # rows


def advance(
    matrix: Matrix, entry: Matrix, state: Sequence[float], inputs: Sequence[float], step: float
) -> tuple[float, ...]:
    """Return the state [n] after a step [s] > 0, exact; `matrix` is A [n, n] and `entry` is B [n, m].

    No eigenvalue of A may have a real part above zero. Any number of steps is as good as one.
    """
    decay, gain = _propagators(matrix, entry, step)
    return tuple((decay @ np.asarray(state) + gain @ np.asarray(inputs)).tolist())


@lru_cache(maxsize=64)
def _propagators(matrix: Matrix, entry: Matrix, step: float) -> tuple[Array, Array]:
    """Return exp(A h) and its integral times B: blocks of the exponential of [[A, B], [0, 0]] h."""
    size = len(matrix)
    found = exponential(_block(matrix, entry) * step)
    return found[:size, :size], found[:size, size:]


def _block(matrix: Matrix, entry: Matrix) -> Array:
    size, width = len(matrix), len(entry[0])
    whole = np.zeros((size + width, size + width))
    whole[:size] = np.hstack([matrix, entry])
    return whole


def exponential(matrix: Array) -> Array:
    """Return the exponential of a matrix [n, n]."""
    found: Array = scipy.linalg.expm(matrix)
    return found
