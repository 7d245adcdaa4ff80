"""Oil in pockets of a steady film: each takes the pressure that balances its mass as a whole.

Within a pocket oil flows so easily that its pressure is all but one number, and what contacts and thin films around it
let through is little against that. Line by line this number hardly moves. It follows from the equation of
`corrections.relax_lines`, summed over the nodes of the pocket: what flows between them drops out.
"""

import numpy as np

from ..compiled import jit
from .corrections import lifts_of
from .edge import wrap


@jit
def fill_pockets(  # type: ignore[no-untyped-def]
    p, solid, stiff, h, mass, ex, ey, r, edge, floor, wedge, dx, near, least, part, wrapped, dp
):
    """Add to the step dp of every pocket a part of what balances its mass.

    A pocket: nodes off the stiff zone, joined by faces of at least the mobility `least`.
    """
    ny, nx = p.shape
    per_dx2, lifts = 1.0 / (dx * dx), lifts_of(near, wedge, dx)
    pocket = np.full((ny, nx), -1)  # its number; 0: of none yet, -1: no free node
    for j in range(1, ny - 1):
        for i in range(1, nx - 1):
            if not (stiff[j, i] or solid[j, i] or (p[j, i] <= 0.0 and r[j, i] <= 0.0)):
                pocket[j, i] = 0
    rows, columns = np.empty(ny * nx, np.int64), np.empty(ny * nx, np.int64)
    number = 0
    for start in range(nx, (ny - 1) * nx):
        if pocket.ravel()[start] != 0:
            continue
        number += 1
        rows[0], columns[0], size, done = start // nx, start % nx, 1, 0
        pocket[rows[0], columns[0]] = number
        while done < size:
            j, i = rows[done], columns[done]
            done += 1
            for side in range(4):
                y, x, face = _across(j, i, side, ex, ey, wrapped)
                if face >= least and pocket[y, x] == 0:
                    pocket[y, x], rows[size], columns[size] = number, y, x
                    size += 1
        gain, slope, lift = 0.0, 0.0, 0.0  # net inflow, and its fall with the pressure: by flow, by deformation
        for n in range(size):
            j, i = rows[n], columns[n]
            gain += r[j, i]
            for side in range(4):
                y, x, face = _across(j, i, side, ex, ey, wrapped)
                if pocket[y, x] != number:
                    beyond = 0.0 if solid[y, x] else dp[y, x]  # the fluid pressure of a contact stays
                    gain += per_dx2 * face * (beyond - dp[j, i])
                    slope += per_dx2 * face * (1.0 - edge[y, x])
            rho = mass[j, i] / h[j, i] if h[j, i] > floor else 0.0
            for m in range(6):
                x = i + m - 3
                if 0 <= x < nx:
                    gain -= rho * lifts[m] * dp[j, x]
                    lift += rho * lifts[m] if pocket[j, x] == number else 0.0
        slope += max(lift, 0.0)
        if slope > 0.0:
            for n in range(size):
                j, i = rows[n], columns[n]
                dp[j, i] = max(dp[j, i] + part * gain / slope, -p[j, i])
    if wrapped:
        wrap(dp)


@jit
def _across(j, i, side, ex, ey, wrapped):  # type: ignore[no-untyped-def]
    """Return row and column of the neighbour on a side, and the mobility of the face to it."""
    ny = ex.shape[0]
    if side == 0:
        return j, i - 1, ex[j, i - 1]
    if side == 1:
        return j, i + 1, ex[j, i]
    if side == 2:
        return ny - 2 if wrapped and j == 1 else j - 1, i, ey[j - 1, i]
    return 1 if wrapped and j == ny - 2 else j + 1, i, ey[j, i]
