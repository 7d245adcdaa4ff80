"""Passes over one grid level for smooth, fully flooded films: film, mass balance, line relaxation.

    div(e grad p) - d(m)/dx = f where p > 0,   p >= 0,   m = rho h,   e = mobility rho h^3 (1 / eta(p) + thinned)

What flows through the faces between nodes is said in `mixed.flow`. Fields are [rows, nx]. With `mirror` they are one
half of a contact that is symmetric about its last row: what lies beyond it is the image of the row before it. Where the
film of a coarse grid is negative nothing flows under pressure, but its mass is carried along as it is.

Source of the relaxation: Venner & Lubrecht, Multilevel Methods in Lubrication, Elsevier 2000; lines along x, Gauss-
Seidel where pressure flow rules, changes that leave the total pressure as it is (a node up, its neighbours down by a
quarter each) where elasticity does.
"""

import numpy as np

from ..compiled import jit
from ..mixed.flow import properties

CLOSED = 1e-12  # gap through which nothing flows
_STIFF = 0.3  # e / dx^2, in compliances, below which elasticity rules
_LOWER, _UPPER = 3, 2  # neighbours upstream and downstream in a line's equations
_SINGLE, _SPREAD, _STAYS = 0, 1, 2  # change of a node: alone, with its neighbours, none


def line_kernels(near, dx, weights):  # type: ignore[no-untyped-def]
    """Return the change of d(m)/dx at i by a unit change at i + m, m = -3...2.

    Per rho and per h d(rho)/dp; [3, 6] each.

    Row 0 for a single node, row 1 for a node with its four neighbours, row 2 for none. near: influence coefficients
    times scale.
    """
    n = 7
    single = near[0, :n]
    across = near[1, :n]
    spread = np.array([single[k] - 0.25 * (single[abs(k - 1)] + single[k + 1] + 2.0 * across[k]) for k in range(n - 1)])
    unit = np.zeros(n - 1)
    unit[0] = 1.0
    unit_spread = np.zeros(n - 1)
    unit_spread[:2] = 1.0, -0.25

    def wedge(c):  # type: ignore[no-untyped-def]
        m = range(-_LOWER, _UPPER + 1)
        return np.array([sum(w * c[abs(k + n)] for n, w in enumerate(weights, -1)) / dx for k in m])

    none = np.zeros(_LOWER + 1 + _UPPER)
    return np.array([wedge(single), wedge(spread), none]), np.array([wedge(unit), wedge(unit_spread), none])


@jit
def gap_pass(base, deformation, scale, rigid, h):  # type: ignore[no-untyped-def]
    """Compute the gap of every node from the deformation."""
    for j in range(h.shape[0]):
        for i in range(h.shape[1]):
            h[j, i] = rigid + base[j, i] + scale * deformation[j, i]


@jit
def oil_pass(p, h, step, density, fluidity, potential, mass, soft, gap, rho, fluid, driven):  # type: ignore[no-untyped-def]
    """Compute mass, h d(rho)/dp and the nodes' properties of `mixed.flow` from pressure and gap."""
    last = fluidity.size - 1
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            here = max(p[j, i], 0.0)
            gap[j, i] = max(h[j, i], CLOSED)
            rho[j, i], fluid[j, i], driven[j, i] = properties(here, step, density, fluidity, potential)
            mass[j, i] = rho[j, i] * h[j, i]
            k = int(here / step)
            rise = density[k + 1] - density[k] if here > 0.0 and k < last else 0.0
            soft[j, i] = gap[j, i] * rise / step


@jit
def balance(p, ex, ey, carried, dx, mirror, out):  # type: ignore[no-untyped-def]
    """Compute the net inflow of mass per area at every inner node."""
    rows, nx = p.shape
    per_dx2 = 1.0 / (dx * dx)
    for j in range(1, rows if mirror else rows - 1):
        up, face = (j + 1, j) if j + 1 < rows else (j - 1, j - 1)
        for i in range(1, nx - 1):
            here = p[j, i]
            flow = ex[j, i - 1] * (p[j, i - 1] - here) + ex[j, i] * (p[j, i + 1] - here)
            flow += ey[j - 1, i] * (p[j - 1, i] - here) + ey[face, i] * (p[up, i] - here)
            out[j, i] = per_dx2 * flow - (carried[j, i] - carried[j, i - 1]) / dx


@jit
def defect(p, mass, ex, ey, carried, f, dx, mirror, out):  # type: ignore[no-untyped-def]
    """Compute the defect of the balance where there is pressure, zero elsewhere.

    Returns the sums of |defect| p and of mass p.
    """
    balance(p, ex, ey, carried, dx, mirror, out)
    rows, nx = p.shape
    wrong, film = 0.0, 1e-300
    for j in range(1, rows if mirror else rows - 1):
        share = 1.0 if mirror and j == rows - 1 else 2.0
        for i in range(1, nx - 1):
            if p[j, i] > 0.0:
                out[j, i] = f[j, i] - out[j, i]
                wrong += share * p[j, i] * abs(out[j, i])
                film += share * p[j, i] * mass[j, i]
            else:
                out[j, i] = 0.0
    return wrong, film


@jit
def set_edges(p, edge, offset, mirror):  # type: ignore[no-untyped-def]
    """Set the pressure of the edge nodes from that of their inner neighbours."""
    rows, nx = p.shape
    for j in range(rows):
        p[j, 0] = max(edge[j, 0] * p[j, 1] + offset[j, 0], 0.0)
        p[j, nx - 1] = 0.0
    for i in range(nx):
        p[0, i] = max(edge[0, i] * p[1, i] + offset[0, i], 0.0)
        if not mirror:
            p[rows - 1, i] = max(edge[rows - 1, i] * p[rows - 2, i] + offset[rows - 1, i], 0.0)


@jit
def _line_balance(p, ex, ey, carried, f, dx, j, up, face, limit, faces, r, kind):  # type: ignore[no-untyped-def]
    """Compute face mobilities, excess inflow and kind of change of a row's nodes.

    Returns the first and the last node that changes.
    """
    nx = p.shape[1]
    per_dx2 = 1.0 / (dx * dx)
    for i in range(1, nx - 1):
        here = p[j, i]
        west, east = per_dx2 * ex[j, i - 1], per_dx2 * ex[j, i]
        south, north = per_dx2 * ey[j - 1, i], per_dx2 * ey[face, i]
        faces[0, i], faces[1, i], faces[2, i], faces[3, i] = west, east, south, north
        flow = west * (p[j, i - 1] - here) + east * (p[j, i + 1] - here)
        flow += south * (p[j - 1, i] - here) + north * (p[up, i] - here)
        r[i] = flow - f[j, i] - (carried[j, i] - carried[j, i - 1]) / dx
    kind[:] = _STAYS
    first, final = nx, 0
    for i in range(1, nx - 1):
        if p[j, i] > 0.0 or r[i] > 0.0:
            most = max(max(faces[0, i], faces[1, i]), max(faces[2, i], faces[3, i]))
            kind[i + _LOWER] = _SPREAD if most < limit and p[j, i] > 0.0 else _SINGLE
            first = min(first, i)
            final = i
    return first, final


@jit
def _line_changes(faces, r, kind, rho, soft, wedge, wedge_soft, j, first, final, a, b):  # type: ignore[no-untyped-def]
    """Solve a row's equations for the changes b; they are zero on the two nodes beyond the last.

    `faces` [4, nx], 0: west, 1: east, 2: all four, 3: those whose pressure moves along on the edge. kind[i + 3] is that
    of node i. Without pivoting: upstream of a node the equations are nearly triangular.
    """
    for i in range(max(first - _LOWER, 0), first):
        a[i, 0], a[i, 1], b[i] = 0.0, 0.0, 0.0
    for i in range(first, final + 1):
        own = kind[i + 3]
        if own == _STAYS:
            a[i, 0], a[i, 1], b[i] = 0.0, 0.0, 0.0
            continue
        west, east, total = faces[0, i], faces[1, i], faces[2, i]
        k3, k2, k1, k4, k5 = kind[i], kind[i + 1], kind[i + 2], kind[i + 4], kind[i + 5]
        dense, give = rho[j, i], soft[j, i]
        c3 = dense * wedge[k3, 0] + give * wedge_soft[k3, 0]
        c2 = dense * wedge[k2, 1] + give * wedge_soft[k2, 1]
        c1 = dense * wedge[k1, 2] + give * wedge_soft[k1, 2]
        c0 = dense * wedge[own, 3] + give * wedge_soft[own, 3]
        c4 = dense * wedge[k4, 4] + give * wedge_soft[k4, 4]
        c5 = dense * wedge[k5, 5] + give * wedge_soft[k5, 5]
        if k2 == _SPREAD:
            c2 += 0.25 * west
        if k1 == _SINGLE:
            c1 -= west
        elif k1 == _SPREAD:
            c1 -= west + 0.25 * total
        c0 += (total if own == _SINGLE else 1.25 * total) - faces[3, i]
        if k4 == _SINGLE:
            c4 -= east
        elif k4 == _SPREAD:
            c4 -= east + 0.25 * total
        if k5 == _SPREAD:
            c5 += 0.25 * east
        # rows before are x_k + a[k, 0] x_(k + 1) + a[k, 1] x_(k + 2) = b[k]
        right = r[i]
        if i > 2:
            c2 -= c3 * a[i - 3, 0]
            c1 -= c3 * a[i - 3, 1]
            right -= c3 * b[i - 3]
        if i > 1:
            c1 -= c2 * a[i - 2, 0]
            c0 -= c2 * a[i - 2, 1]
            right -= c2 * b[i - 2]
        c0 -= c1 * a[i - 1, 0]
        c4 -= c1 * a[i - 1, 1]
        right -= c1 * b[i - 1]
        pivot = 1.0 / c0
        a[i, 0], a[i, 1], b[i] = c4 * pivot, c5 * pivot, right * pivot
    b[final + 1], b[final + 2] = 0.0, 0.0
    for i in range(final, first - 1, -1):
        b[i] -= a[i, 0] * b[i + 1] + a[i, 1] * b[i + 2]


@jit
def relax(  # type: ignore[no-untyped-def]
    p, ex, ey, carried, rho, soft, f, edge, offset, wedge, wedge_soft, dx, compliance, mirror, single, spread, dp
):
    """Relax the rows by lines once. `single`, `spread`: damping of the two kinds of changes.

    `wedge`, `wedge_soft`: `line_kernels`. Changes p; dp is scratch of its shape.
    """
    rows, nx = p.shape
    end = rows if mirror else rows - 1
    limit = _STIFF * compliance
    a, b, r = np.zeros((nx + 2, 2)), np.zeros(nx + 2), np.empty(nx)
    kind, faces = np.empty(nx + 5, np.int64), np.empty((4, nx))
    dp[:] = 0.0
    for j in range(1, end):
        up, face = (j + 1, j) if j + 1 < rows else (j - 1, j - 1)
        first, final = _line_balance(p, ex, ey, carried, f, dx, j, up, face, limit, faces, r, kind)
        if first > final:
            continue
        for i in range(first, final + 1):
            south, north = faces[2, i], faces[3, i]
            faces[2, i] = faces[0, i] + faces[1, i] + south + north
            faces[3, i] = (south * edge[0, i] if j == 1 else 0.0) + (faces[0, i] * edge[j, 0] if i == 1 else 0.0)
            if j == rows - 2 and not mirror:
                faces[3, i] += north * edge[rows - 1, i]
        _line_changes(faces, r, kind, rho, soft, wedge, wedge_soft, j, first, final, a, b)
        for i in range(first, final + 1):
            if kind[i + _LOWER] == _SINGLE:
                p[j, i] = max(p[j, i] + single * b[i], 0.0)
            elif kind[i + _LOWER] == _SPREAD:
                change = spread * b[i]
                dp[j, i] += change
                change *= -0.25
                dp[j, i - 1] += change
                dp[j, i + 1] += change
                dp[j - 1, i] += change
                if j + 1 < rows:
                    dp[j + 1, i] += 2.0 * change if mirror and j + 2 == rows else change  # also from its image
        if j == 1:
            for i in range(nx):
                p[0, i] = max(edge[0, i] * p[1, i] + offset[0, i], 0.0)
        p[j, 0] = max(edge[j, 0] * p[j, 1] + offset[j, 0], 0.0)
    for j in range(1, end):
        for i in range(1, nx - 1):
            p[j, i] = max(p[j, i] + dp[j, i], 0.0)
    set_edges(p, edge, offset, mirror)
