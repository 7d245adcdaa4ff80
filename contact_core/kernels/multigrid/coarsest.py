"""Newton's method for pressure and rigid gap together, for the coarsest grid level.

Fields are [rows, nx] as in `relaxation`; the unknowns are the pressures of the inner nodes, row by row, and the rigid
gap. Nodes that would fall below zero are held at zero, the others satisfy their balance (semi-smooth, as in
Hintermueller, Ito & Kunisch, SIAM J. Optim. 13 (2003) 865, doi:10.1137/S1052623401383558).
"""

import numpy as np

from ..arrays import Array
from ..compiled import jit
from ..half_space import influence

ACROSS, ALONG = 3, 5  # rows and columns of the nodes that a node's balance looks at


def dense_deformation(ny: int, nx: int, mirror: bool) -> Array:
    """Return the matrix [nodes, nodes] of the deformation by unit pressures, for unit scale."""
    kernel = influence(ny, nx)
    across = np.abs(np.arange(nx)[:, None] - np.arange(nx)[None, :])
    j = np.arange((ny + 1) // 2 if mirror else ny)
    matrix = kernel[np.abs(j[:, None] - j[None, :])][:, :, across]
    if mirror:
        matrix[:, :-1] += kernel[ny - 1 - j[:, None] - j[None, :-1]][:, :, across]
    nodes = j.size * nx
    return np.ascontiguousarray(matrix.transpose(0, 2, 1, 3).reshape(nodes, nodes))


@jit
def _inner(j, i, edge, mirror):  # type: ignore[no-untyped-def]
    """Return the unknown that the pressure of a node follows, and the ratio to it."""
    rows, nx = edge.shape
    ratio = 1.0
    if j == 0 or (j == rows - 1 and not mirror):
        ratio *= edge[j, i]
        j = 1 if j == 0 else rows - 2
    if i == 0 or i == nx - 1:
        ratio *= edge[j, i]
        i = 1 if i == 0 else nx - 2
    return (j - 1) * (nx - 2) + i - 1, ratio


@jit
def condensed(matrix, edge, mirror):  # type: ignore[no-untyped-def]
    """Return the deformation [nodes, unknowns] by the unknowns; edges follow them."""
    rows, nx = edge.shape
    out = np.zeros((rows * nx, (rows - (1 if mirror else 2)) * (nx - 2)))
    for j in range(rows):
        for i in range(nx):
            at, ratio = _inner(j, i, edge, mirror)
            if ratio != 0.0:
                for k in range(rows * nx):
                    out[k, at] += ratio * matrix[k, j * nx + i]
    return out


@jit
def assemble(p, by_p, by_h, excess, edge, weight, missing, lift, mirror, jacobian, right):  # type: ignore[no-untyped-def]
    """Assemble Jacobian and right side of the next change of pressures and rigid gap, scaled by the diagonal.

    by_p, by_h [colours, rows, nx]: derivatives of the net inflow, see `Level`; excess [rows, nx] of it; `lift` [nodes,
    unknowns]: gap by unit pressures, see `condensed`; `missing`: sum of weight * p still to come.
    """
    rows, nx = p.shape
    n = right.size - 1
    jacobian[:] = 0.0
    for j in range(1, rows if mirror else rows - 1):
        for i in range(1, nx - 1):
            at, own = (j - 1) * (nx - 2) + i - 1, (j % ACROSS) * ALONG + i % ALONG
            diagonal = -by_p[own, j, i] - by_h[own, j, i] * lift[j * nx + i, at]
            if not diagonal > 0.0:
                diagonal = max(-by_p[own, j, i], 1e-300)
            right[at] = excess[j, i] / diagonal
            if p[j, i] + right[at] <= 0.0:
                jacobian[at, at], right[at] = 1.0, -p[j, i]
                continue
            for row in range(max(j - 1, 0), min(j + 2, rows)):
                for column in range(max(i - 2, 0), min(i + 3, nx)):
                    colour, node = (row % ACROSS) * ALONG + column % ALONG, row * nx + column
                    by_gap = by_h[colour, j, i] / diagonal
                    if by_gap != 0.0:
                        for m in range(n):
                            jacobian[at, m] -= by_gap * lift[node, m]
                        jacobian[at, n] -= by_gap
                    m, ratio = _inner(row, column, edge, mirror)
                    jacobian[at, m] -= ratio * by_p[colour, j, i] / diagonal
    for j in range(rows):
        for i in range(nx):
            m, ratio = _inner(j, i, edge, mirror)
            jacobian[n, m] += ratio * weight[j, i]
    right[n] = missing


@jit
def solve_dense(a, b):  # type: ignore[no-untyped-def]
    """Put the solution of a x = b into b by elimination with row pivoting; overwrite a. Return False if a is singular.

    Not LAPACK's: its threads make small systems slow on a busy machine, and its bits depend on their number.
    """
    n = b.size
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(a[i, k]) > abs(a[best, k]):
                best = i
        if not abs(a[best, k]) > 0.0:
            return False
        if best != k:
            for m in range(k, n):
                a[k, m], a[best, m] = a[best, m], a[k, m]
            b[k], b[best] = b[best], b[k]
        inverse = 1.0 / a[k, k]
        for i in range(k + 1, n):
            factor = a[i, k] * inverse
            if factor != 0.0:
                for m in range(k + 1, n):
                    a[i, m] -= factor * a[k, m]
                b[i] -= factor * b[k]
    for k in range(n - 1, -1, -1):
        value = b[k]
        for m in range(k + 1, n):
            value -= a[k, m] * b[m]
        b[k] = value / a[k, k]
    return True


@jit
def advance(p, change, part, mirror):  # type: ignore[no-untyped-def]
    """Take a part of a change of the inner pressures; none falls below zero."""
    rows, nx = p.shape
    for j in range(1, rows if mirror else rows - 1):
        for i in range(1, nx - 1):
            p[j, i] = max(p[j, i] + part * change[(j - 1) * (nx - 2) + i - 1], 0.0)
