"""Linearisation of a film that is full everywhere, for `newton`: derivatives on a stencil, products, a local matrix."""

import numpy as np

from ..compiled import jit
from . import reynolds

# stencil of Reynolds' equation: centre, west, east, south, north, second west; then the corners of the patch
DJ = np.array([0, 0, 0, -1, 1, 0, -1, -1, 1, 1])
DI = np.array([0, -1, 1, 0, 0, -2, -1, 1, -1, 1])


@jit
def slopes(f, solid, h, floor, mobility, thinned, fluidity, density, step, slope):  # type: ignore[no-untyped-def]
    """Compute the derivatives of mass and mobility of full nodes, slope [4, ny, nx]: dm/df, dm/dh, de/df, de/dh."""
    ny, nx = f.shape
    for j in range(ny):
        for i in range(nx):
            k = min(int(f[j, i] / step), density.size - 2)
            rho = reynolds.interpolate(density, step, f[j, i])
            phi = reynolds.interpolate(fluidity, step, f[j, i]) + thinned[j, i]
            d_rho, d_phi = (density[k + 1] - density[k]) / step, (fluidity[k + 1] - fluidity[k]) / step
            lift = 0.0 if solid[j, i] or h[j, i] <= floor else 1.0
            flow = floor if solid[j, i] else max(h[j, i], floor)
            slope[0, j, i], slope[1, j, i] = d_rho * flow, rho * lift
            slope[2, j, i] = mobility[j, i] * flow**3 * (d_rho * phi + rho * d_phi)
            slope[3, j, i] = 3.0 * mobility[j, i] * rho * flow**2 * phi * lift


@jit
def linearise(f, e, dx, rate, wedge, slope, by_f, by_h):  # type: ignore[no-untyped-def]
    """Compute the derivatives of the net inflow by fluid pressure and gap on the stencil: by_f, by_h [6, ny, nx]."""
    ny, nx = f.shape
    half = 0.5 / (dx * dx)
    by_f[:], by_h[:] = 0.0, 0.0
    for j in range(1, ny - 1):
        for i in range(1, nx - 1):
            a0, a1, a2 = (1.5 / dx, -2.0 / dx, 0.5 / dx) if i > 1 else (1.0 / dx, -1.0 / dx, 0.0)
            a0, a1, a2 = wedge * a0, wedge * a1, wedge * a2
            faces, fall = 0.0, 0.0
            for n in range(1, 5):
                jn, im = j + DJ[n], i + DI[n]
                d = f[jn, im] - f[j, i]
                face = half * (e[j, i] + e[jn, im])
                by_f[n, j, i] = face + half * slope[2, jn, im] * d
                by_h[n, j, i] = half * slope[3, jn, im] * d
                faces += face
                fall += d
            by_f[0, j, i] = -faces + half * slope[2, j, i] * fall - (a0 + rate) * slope[0, j, i]
            by_h[0, j, i] = half * slope[3, j, i] * fall - (a0 + rate) * slope[1, j, i]
            by_f[1, j, i] -= a1 * slope[0, j, i - 1]
            by_h[1, j, i] -= a1 * slope[1, j, i - 1]
            if i > 1:
                by_f[5, j, i] = -a2 * slope[0, j, i - 2]
                by_h[5, j, i] = -a2 * slope[1, j, i - 2]


@jit
def product(by_f, by_h, scale, nodes, solid, df, dh, out):  # type: ignore[no-untyped-def]
    """Multiply the rows of the Jacobian of all `nodes` by a change of fluid pressure and gap."""
    nx = df.shape[1]
    for k in range(nodes.size):
        j, i = nodes[k] // nx, nodes[k] % nx
        if solid[j, i]:
            out[k] = dh[j, i] * scale[j, i]
            continue
        total = 0.0
        for n in range(6 if i > 1 else 5):
            jn, im = j + DJ[n], i + DI[n]
            total += by_f[n, j, i] * df[jn, im] + by_h[n, j, i] * dh[jn, im]
        out[k] = total * scale[j, i]


@jit
def assemble(by_f, by_h, scale, patch, nodes, column, solid, edge, wrapped, start, index, value):  # type: ignore[no-untyped-def]
    """Assemble compressed rows of the local Jacobian of `nodes`.

    patch [10, 6]: deformation of the stencil by the patch.

    An image has the column of its node: of few rows, some columns stand in a row more than once, and add up.
    """
    ny, nx = solid.shape
    row = np.empty(10)
    count = 0
    start[0] = 0
    for k in range(nodes.size):
        j, i = nodes[k] // nx, nodes[k] % nx
        for o in range(10):
            if solid[j, i]:
                row[o] = patch[o, 0]
                continue
            row[o] = 0.0
            for n in range(6):
                row[o] += by_h[n, j, i] * patch[o, n]
        if not solid[j, i]:
            for n in range(6 if i > 1 else 5):
                jn, im = j + DJ[n], i + DI[n]
                if (wrapped or 0 < jn < ny - 1) and 0 < im < nx - 1:
                    if not solid[jn, im]:
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
