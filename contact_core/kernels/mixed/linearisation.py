"""Local linearisation of a film for the preconditioner of `newton`: derivatives on a stencil, and a sparse matrix.

They are those of gaps and pressures that change little from node to node; `newton` corrects what they leave out.
"""

import numpy as np

from ..compiled import jit
from . import reynolds
from .cavities import FADE

# stencil of Reynolds' equation: centre, west, east, south, north, second west; then the corners of the patch
DJ = np.array([0, 0, 0, -1, 1, 0, -1, -1, 1, 1])
DI = np.array([0, -1, 1, 0, 0, -2, -1, 1, -1, 1])


@jit
def slopes(f, solid, h, floor, step, density, slope):  # type: ignore[no-untyped-def]
    """Compute the derivatives of the mass of full nodes, slope [2, ny, nx]: dm/df, dm/dh."""
    ny, nx = f.shape
    for j in range(ny):
        for i in range(nx):
            k = min(int(f[j, i] / step), density.size - 2)
            rise = density[k + 1] - density[k]
            fixed = solid[j, i] or h[j, i] <= floor
            slope[0, j, i] = rise / step * (floor if fixed else h[j, i])
            slope[1, j, i] = 0.0 if fixed else density[k] + (f[j, i] / step - k) * rise


@jit
def _weights(share, fitted):  # type: ignore[no-untyped-def]
    """Return the parts of the masses of the nodes upstream of, before and behind a face in what is carried through."""
    if not fitted:
        return -0.5, 1.5, 0.0
    rest = 1.0 - share
    return -0.125 * rest, 0.5 * share + 0.75 * rest, 0.5 * share + 0.375 * rest


@jit
def linearise(  # type: ignore[no-untyped-def]
    f, gap, fluid, thinned, ex, ey, share, fitted, per_dt, wedge, dx, slope, first, filling, by_f, by_h
):
    """Compute the derivatives of the net inflow by fluid pressure and gap on the stencil: by_f, by_h [6, ny, nx]."""
    ny, nx = f.shape
    per_dx2, per_dx = 1.0 / (dx * dx), wedge / dx
    by_f[:], by_h[:] = 0.0, 0.0
    for j in range(1, ny - 1):
        for i in range(first, nx - 1):
            if filling is not None and filling[j, i] < 1.0:
                continue
            own, here = fluid[j, i] + thinned[j, i], gap[j, i]
            for n in range(1, 5):
                jn, im = j + DJ[n], i + DI[n]
                e = per_dx2 * (ex[j, min(i, im)] if DJ[n] == 0 else ey[min(j, jn), i])
                if filling is not None and n == 1:
                    e *= 1.0 - reynolds.returned(filling, first, per_dt, wedge, dx, j, i)
                drop, their, there = f[jn, im] - f[j, i], fluid[jn, im] + thinned[jn, im], gap[jn, im]
                mean = 0.5 * (own + their) + 1e-300
                by_f[n, j, i] = e * their / mean
                by_f[0, j, i] -= e * own / mean
                by_h[n, j, i] = e * drop * (2.0 / there - 1.0 / (here + there)) * (slope[1, jn, im] > 0.0)
                by_h[0, j, i] += e * drop * (2.0 / here - 1.0 / (here + there)) * (slope[1, j, i] > 0.0)
            far, near, behind = _weights(share[j, i], fitted)
            far_2, near_2, behind_2 = _weights(share[j, i - 1], fitted)
            if filling is not None:
                order = max(1.0 - FADE * (1.0 - filling[j, i - 1]), 0.0)
                far, near, behind = order * far, 1.0 - order + order * near, order * behind
                if filling[j, i - 1] < 1.0:  # what flows in does not depend on the gap there
                    far_2, near_2, behind_2 = 0.0, 0.0, 0.0
            if i == 1 and (filling is None or filling[j, 0] >= 1.0):
                far_2, near_2, behind_2 = 0.0, 0.5, 0.5
            part = (near - behind_2, far - near_2, behind, 0.0, 0.0, -far_2)
            for n in range(6):
                if part[n] != 0.0 and i + DI[n] >= 0:
                    m = per_dx * part[n] + (per_dt if n == 0 else 0.0)
                    jn, im = j + DJ[n], i + DI[n]
                    by_f[n, j, i] -= m * slope[0, jn, im]
                    by_h[n, j, i] -= m * slope[1, jn, im]


@jit
def follow_gap(by_f, gain, by_h):  # type: ignore[no-untyped-def]
    """Add to by_h what the fluid pressure changes as the gap does, by `gain`: asperities leave it more or less."""
    ny, nx = gain.shape
    for j in range(1, ny - 1):
        for i in range(1, nx - 1):
            for n in range(6 if i > 1 else 5):
                by_h[n, j, i] += by_f[n, j, i] * gain[j + DJ[n], i + DI[n]]


@jit
def assemble(by_f, by_h, scale, patch, nodes, column, held, give, edge, wrapped, start, index, value):  # type: ignore[no-untyped-def]
    """Assemble compressed rows of the local Jacobian of `nodes`.

    patch [10, 6]: deformation of the stencil by the patch. held, give: as by `asperities.sort_nodes`.

    An image has the column of its node: of few rows, some columns stand in a row more than once, and add up.
    """
    ny, nx = held.shape
    row = np.empty(10)
    count = 0
    start[0] = 0
    for k in range(nodes.size):
        j, i = nodes[k] // nx, nodes[k] % nx
        for o in range(10):
            if held[j, i]:
                row[o] = patch[o, 0] + (give[j, i] if o == 0 else 0.0)
                continue
            row[o] = 0.0
            for n in range(6):
                row[o] += by_h[n, j, i] * patch[o, n]
        if not held[j, i]:
            for n in range(6 if i > 1 else 5):
                jn, im = j + DJ[n], i + DI[n]
                if (wrapped or 0 < jn < ny - 1) and 0 < im < nx - 1:
                    if not held[jn, im]:
                        row[n] += by_f[n, j, i]
                else:  # an edge follows its inner neighbour
                    row[1 if n == 5 else 0] += by_f[n, j, i] * edge[jn, im]
        for o in range(10):
            jn, im = j + DJ[o], i + DI[o]
            if (wrapped or 0 < jn < ny - 1) and 0 < im < nx - 1 and column[jn, im] >= 0 and row[o] != 0.0:
                index[count], value[count] = column[jn, im], row[o] * scale[j, i]
                count += 1
        start[k + 1] = count
    return count
