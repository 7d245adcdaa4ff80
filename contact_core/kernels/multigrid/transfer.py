"""Transfer between grid levels: restriction and interpolation of fields [rows, nx], as in `relaxation`.

The finer grid has 2 m - 1 rows and columns where the coarser one has m.
"""

import numpy as np

from ..compiled import jit


@jit
def inject(fine, out):  # type: ignore[no-untyped-def]
    """Copy the values of the finer grid at the nodes of the coarser."""
    for j in range(out.shape[0]):
        for i in range(out.shape[1]):
            out[j, i] = fine[2 * j, 2 * i]


@jit
def add_weighted(fine, mirror, out):  # type: ignore[no-untyped-def]
    """Add the full weighting of a field of the finer grid to the inner nodes of the coarser."""
    rows, nx = out.shape
    for j in range(1, rows if mirror else rows - 1):
        m = 2 * j
        up = m + 1 if m + 1 < fine.shape[0] else m - 1
        for i in range(1, nx - 1):
            n = 2 * i
            corners = fine[m - 1, n - 1] + fine[m - 1, n + 1] + fine[up, n - 1] + fine[up, n + 1]
            sides = fine[m, n - 1] + fine[m, n + 1] + fine[m - 1, n] + fine[up, n]
            out[j, i] += (corners + 2.0 * sides + 4.0 * fine[m, n]) / 16.0


@jit
def undeformed_gap(h, deformation, scale, rigid, base):  # type: ignore[no-untyped-def]
    """Compute the undeformed gap from gap, rigid gap and deformation."""
    for j in range(h.shape[0]):
        for i in range(h.shape[1]):
            base[j, i] = h[j, i] - rigid - scale * deformation[j, i]


@jit
def edge_offset(p, edge, mirror, offset):  # type: ignore[no-untyped-def]
    """Compute the difference of edge pressures from those of `set_edges`."""
    rows, nx = p.shape
    for j in range(rows):
        offset[j, 0] = p[j, 0] - edge[j, 0] * p[j, 1]
    for i in range(nx):
        offset[0, i] = p[0, i] - edge[0, i] * p[1, i]
        if not mirror:
            offset[rows - 1, i] = p[rows - 1, i] - edge[rows - 1, i] * p[rows - 2, i]


@jit
def add_interpolated(new, old, p, steep):  # type: ignore[no-untyped-def]
    """Add the bilinear interpolation of new - old of the coarser grid to p where it is positive; p >= 0.

    steep: nodes whose p is less than the interpolation of old take as much less of it: beside the outlet, where the
    pressure ends within a cell of the coarser grid, they would overshoot.
    """
    rows, nx = p.shape
    for j in range(rows):
        low, high = j // 2, (j + 1) // 2
        for i in range(nx):
            if p[j, i] > 0.0:
                left, right = i // 2, (i + 1) // 2
                change = new[low, left] - old[low, left] + new[low, right] - old[low, right]
                change += new[high, left] - old[high, left] + new[high, right] - old[high, right]
                if steep:
                    around = old[low, left] + old[low, right] + old[high, left] + old[high, right]
                    change *= min(1.0, 4.0 * p[j, i] / max(around, 1e-300))
                p[j, i] = max(p[j, i] + 0.25 * change, 0.0)


@jit
def interpolate_cubic(coarse, mirror, fine):  # type: ignore[no-untyped-def]
    """Interpolate the coarser grid by cubics, at least zero; linearly in the cells at the edge."""
    rows, nx = fine.shape
    half = np.empty((coarse.shape[0], nx))
    cols = coarse.shape[1]
    for j in range(coarse.shape[0]):
        for i in range(nx):
            k = i // 2
            if i % 2 == 0:
                half[j, i] = coarse[j, k]
            elif 0 < k < cols - 2:
                inner = coarse[j, k] + coarse[j, k + 1]
                half[j, i] = (9.0 * inner - coarse[j, k - 1] - coarse[j, k + 2]) / 16.0
            else:
                half[j, i] = 0.5 * (coarse[j, k] + coarse[j, k + 1])
    top = coarse.shape[0] - 1
    for j in range(rows):
        k = j // 2
        for i in range(nx):
            if j % 2 == 0:
                value = half[k, i]
            elif k > 0 and (mirror or k < top - 1):
                beyond = half[k + 2, i] if k + 2 <= top else half[2 * top - k - 2, i]
                value = (9.0 * (half[k, i] + half[k + 1, i]) - half[k - 1, i] - beyond) / 16.0
            else:
                value = 0.5 * (half[k, i] + half[k + 1, i])
            fine[j, i] = max(value, 0.0)


@jit
def extrapolate(coarser, p):  # type: ignore[no-untyped-def]
    """Add a quarter of p - coarser to p where it is positive; p >= 0.

    `coarser` is the solution of twice the spacing: a scheme of second order changes by this much on the next finer
    grid.
    """
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            if p[j, i] > 0.0:
                p[j, i] = max(p[j, i] + 0.25 * (p[j, i] - coarser[j, i]), 0.0)


@jit
def weighted_sum(weight, p):  # type: ignore[no-untyped-def]
    """Return the sum of weight * p."""
    out = 0.0
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            out += weight[j, i] * p[j, i]
    return out


@jit
def distance(weight, a, b):  # type: ignore[no-untyped-def]
    """Return the sum of weight * |a - b|."""
    out = 0.0
    for j in range(a.shape[0]):
        for i in range(a.shape[1]):
            out += weight[j, i] * abs(a[j, i] - b[j, i])
    return out
