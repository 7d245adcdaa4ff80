"""Eigenvalues of small symmetric matrices by loops of bounded length, where no library can be: in C.

Jacobi's rotations: Golub & Van Loan, Matrix Computations, section 8.5 (from memory).
"""

import numpy as np

from contact_core.kernels.compiled import jit

_SWEEPS = 30  # far more than any matrix needs


@jit
def symmetric_eigen(given):  # type: ignore[no-untyped-def]
    """Return eigenvalues [n], the smallest first, and eigenvectors [n, n] in columns of a symmetric matrix [n, n]."""
    n = given.shape[0]
    matrix, vectors = np.empty((n, n)), np.zeros((n, n))
    for i in range(n):
        vectors[i, i] = 1.0
        for j in range(n):
            matrix[i, j] = given[i, j]
    for _ in range(_SWEEPS):
        for p in range(n - 1):
            for q in range(p + 1, n):
                if matrix[p, q] != 0.0:
                    _turn(matrix, vectors, p, q)
    values = np.empty(n)
    for i in range(n):
        values[i] = matrix[i, i]
    for last in range(n - 1, 0, -1):
        for i in range(last):
            if values[i + 1] < values[i]:
                values[i], values[i + 1] = values[i + 1], values[i]
                for k in range(n):
                    vectors[k, i], vectors[k, i + 1] = vectors[k, i + 1], vectors[k, i]
    return values, vectors


@jit
def _turn(matrix, vectors, p, q):  # type: ignore[no-untyped-def]
    """Turn rows and columns p and q so that their common element vanishes."""
    theta = (matrix[q, q] - matrix[p, p]) / (2.0 * matrix[p, q])
    size = 1.0 / (abs(theta) + np.sqrt(theta * theta + 1.0))
    tan = size if theta >= 0.0 else -size
    cos = 1.0 / np.sqrt(tan * tan + 1.0)
    sin = tan * cos
    for k in range(matrix.shape[0]):
        a, b = matrix[k, p], matrix[k, q]
        matrix[k, p], matrix[k, q] = cos * a - sin * b, sin * a + cos * b
    for k in range(matrix.shape[0]):
        a, b = matrix[p, k], matrix[q, k]
        matrix[p, k], matrix[q, k] = cos * a - sin * b, sin * a + cos * b
    for k in range(matrix.shape[0]):
        a, b = vectors[k, p], vectors[k, q]
        vectors[k, p], vectors[k, q] = cos * a - sin * b, sin * a + cos * b
    matrix[p, q] = matrix[q, p] = 0.0
