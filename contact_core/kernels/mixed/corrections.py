"""Corrections of one iteration of `fixed_point`: of the gap in the stiff zone, of the pressure by lines elsewhere.

Equation, arrays and units are those of `reynolds`.
"""

import numpy as np

from ..compiled import jit
from .asperities import REACH, rest_gap
from .edge import wrap
from .reynolds import inflow, returned, transport

_OVER = 1.6  # relaxation of the lines


@jit
def correct_gap(  # type: ignore[no-untyped-def]
    p,
    f,
    cap,
    solid,
    h,
    pressing,
    mass,
    mass_old,
    ex,
    ey,
    flux,
    floor,
    stress,
    depth,
    per_dt,
    wedge,
    dx,
    compliance,
    patch,
    stiff_before,
    r,
    stiff,
    dh,
    sums,
    flows,
    filling,
    first,
):
    """Compute the residual r, the stiff zone, and the change of gap dh in it that removes the residual.

    dh is marched downstream. flows: True if what is carried depends on the mass of now.

    r: net inflow of mass per area, zero on solid contacts and on the edge. stiff: where elasticity rules, solid
    contacts and fluid nodes whose faces hardly pass any pressure flow. dh: on solid contacts, to the floor; zero
    off the stiff zone. `pressing`: what asperities carry at the gap h. `patch`: opening of a gap by a unit pressure
    on it and its eight neighbours.

    Returns the first row, the row after the last, first column and column after the last of dh, and how many nodes are
    stiff and how many of them differ from `stiff_before`. sums [7]: of |r| f, m f and f over nodes that fluid carries
    or shares with asperities; of p - f and, below the cap, of p |floor - h| over solid contacts; with `filling`, of r
    over nodes that are full and have no pressure yet, and of what all others gain together, and of m over nodes that
    have some.
    """
    ny, nx = p.shape
    per_dx2, per_dx, wedge_per_dx = 1.0 / (dx * dx), 1.0 / dx, wedge / dx
    limit = dx * dx * compliance
    a0, a1, a2 = 1.5 * wedge_per_dx + per_dt, -2.0 * wedge_per_dx, 0.5 * wedge_per_dx
    per_patch, per_depth = 1.0 / patch, 1.0 / depth if depth > 0.0 else 0.0
    clear = floor + REACH * depth  # of the asperities: the gap at which a node rests is at most so wide
    wrong, film, fluid, solids, intrusion, gained, held = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    net = 0.0
    top, bottom, left, right, count, changed = ny, 0, nx, 0, 0, 0
    for j in range(1, ny - 1):
        before, before_2 = 0.0, 0.0  # change of the film that flows at the two nodes upstream
        for i in range(1, nx - 1):
            here, own, m = p[j, i], h[j, i], mass[j, i]
            touches, value, change, is_stiff, own_rest = solid[j, i], 0.0, 0.0, False, floor
            if not touches:
                squeezed = per_dt * (m - mass_old[j, i])
                value = inflow(f, ex, ey, per_dx2, j, i) - wedge_per_dx * (flux[j, i] - flux[j, i - 1]) - squeezed
                sinks = value < 0.0
                if filling is not None and (filling[j, i] < 1.0 or i < first):  # no residual there
                    sinks, value = True, 0.0
                own_rest = clear
                if own < clear:
                    own_rest = rest_gap(here, floor, stress, depth)
                    if own < own_rest and sinks:
                        touches, value = True, 0.0  # the film sinks further: solids carry the rest
                        solid[j, i] = True
            if touches:
                is_stiff = True
                alone = here - f[j, i]
                if pressing[j, i] > alone:  # the asperities press the bodies apart
                    change = (pressing[j, i] - alone) / (per_patch + pressing[j, i] * per_depth)
                    change += max(floor - own, 0.0)
                else:
                    change = rest_gap(alone, floor, stress, depth) - own
                    change /= 1.0 + depth * per_patch / max(alone, 1e-300)
                solids += alone
                if depth > 0.0 and 0.0 < f[j, i] < here:  # its oil has to be in balance, too
                    gain = inflow(f, ex, ey, per_dx2, j, i)
                    wrong += abs(gain - transport(mass, flux, mass_old, per_dt, wedge, dx, j, i)) * f[j, i]
                    film += m * f[j, i]
                    fluid += f[j, i]
                if here > 0.0 and f[j, i] >= here and here < cap[j, i]:  # oil alone carries it and should lift it
                    gain = inflow(f, ex, ey, per_dx2, j, i)
                    wrong += max(gain - transport(mass, flux, mass_old, per_dt, wedge, dx, j, i), 0.0) * here
                if here < cap[j, i]:
                    intrusion += here * abs(change)
                elif change > 0.0:
                    change = 0.0
            elif here > 0.0:
                gap, pressed = max(own, floor), f[j, i]
                west, east, south, north = ex[j, i - 1], ex[j, i], ey[j - 1, i], ey[j, i]
                is_stiff = max(max(west, east), max(south, north)) < limit
                # a film that loses mass sinks at most until solids carry all: near that, the residual is no larger
                if own >= clear and (-value > m * (gap / clear - 1.0) * per_dx or is_stiff):
                    own_rest = rest_gap(here, floor, stress, depth)
                loss = min(-value, m * (max(gap / own_rest, 1.0) - 1.0) * per_dx)
                gain = value if here < cap[j, i] else 0.0  # the solids yield to the film
                wrong += max(loss, gain) * pressed
                film += m * pressed
                fluid += pressed
                solids += here - pressed
                if is_stiff:
                    faces = (west + east + south + north) * per_dx2
                    give = per_patch + pressing[j, i] * per_depth
                    upstream = a1 * before + a2 * before_2 if flows else 0.0
                    own_lift = a0 if flows else per_dt
                    change = (value * gap - m * upstream) / (m * own_lift + faces * give * gap)
                    change = max(change, min(own_rest - own, 0.0))  # solids stop it there
                    if here >= cap[j, i]:
                        change = min(change, 0.0)  # the solids yield, the gap does not open
            if filling is not None:
                if here > 0.0:
                    held += m
                    net += value
                elif value > 0.0:
                    gained += value
            r[j, i], stiff[j, i], dh[j, i] = value, is_stiff, change
            before_2 = before
            before = 0.0 if solid[j, i] and depth <= 0.0 else max(h[j, i] + change, floor) - max(h[j, i], floor)
            if is_stiff:
                count += 1
                top, bottom = min(top, j), max(bottom, j + 1)
                left, right = min(left, i), max(right, i + 1)
            if is_stiff != stiff_before[j, i]:
                changed += 1
    sums[0], sums[1], sums[2], sums[3], sums[4], sums[5], sums[6] = (
        wrong,
        film,
        fluid,
        solids,
        intrusion,
        gained + abs(net),
        held,
    )
    return top, bottom, left, right, count, changed


@jit
def lifts_of(near, wedge, dx):  # type: ignore[no-untyped-def]
    """Return d(deformation wedge)_i / dp_(i + m), m = -3 ... 2."""
    k0, k1, k2, k3, k4 = near[0, 0], near[0, 1], near[0, 2], near[0, 3], near[0, 4]
    return (
        wedge * ((1.5 * k3 - 2.0 * k2 + 0.5 * k1) / dx),
        wedge * ((1.5 * k2 - 2.0 * k1 + 0.5 * k0) / dx),
        wedge * ((1.5 * k1 - 2.0 * k0 + 0.5 * k1) / dx),
        wedge * ((1.5 * k0 - 2.0 * k1 + 0.5 * k2) / dx),
        wedge * ((1.5 * k1 - 2.0 * k2 + 0.5 * k3) / dx),
        wedge * ((1.5 * k2 - 2.0 * k3 + 0.5 * k4) / dx),
    )


@jit
def line_factors(  # type: ignore[no-untyped-def]
    p, solid, stiff, h, mass, ex, ey, r, edge, floor, depth, per_dt, wedge, dx, near, patch_wide, lumped, flows,
    over_oil, lack, filling, first, alone, free, lower, pivot, ratio, rhs, south, north, rho,
):  # fmt: skip
    """Compute the linearised equation of the nodes outside the stiff zone, [ny, nx], and its factors along lines.

    At node i: lower x_(i-1) + diagonal x_i + upper x_(i+1) = rhs + south x_(j-1) + north x_(j+1) - rho `_far_lift`;
    eliminated from left to right, pivot is one over what the diagonal becomes, ratio is upper times that. flows: as in
    `correct_gap`. over_oil, lack: from `asperities.share_out`, of no meaning where depth is 0. alone: a row that
    is its own neighbour.
    """
    ny, nx = p.shape
    per_dx2 = 1.0 / (dx * dx)
    lifts = lifts_of(near, wedge if flows else 0.0, dx)
    w_1, w0, w1 = lifts[2], lifts[3] + per_dt * patch_wide, lifts[4]
    for j in range(1, ny - 1):
        for i in range(1, nx - 1):
            ratio[j, i] = 0.0
            # a cavity stays one: its pressure would go below zero with its neighbours'
            free[j, i] = not stiff[j, i] and (p[j, i] > 0.0 or r[j, i] > 0.0)
            if not free[j, i]:
                continue
            west, east = per_dx2 * ex[j, i - 1], per_dx2 * ex[j, i]
            below, above = (0.0, 0.0) if alone else (per_dx2 * ey[j - 1, i], per_dx2 * ey[j, i])
            back = 0.0 if filling is None else returned(filling, first, per_dt, wedge, dx, j, i)
            # of an asperity that presses less as the bodies part, the oil takes over
            over_west, over_east, over_below, over_above, over_own = 1.0, 1.0, 1.0, 1.0, 1.0
            value = r[j, i]
            if depth > 0.0:
                over_own, over_west, over_east = over_oil[j, i], over_oil[j, i - 1], over_oil[j, i + 1]
                over_below, over_above = over_oil[j - 1, i], over_oil[j + 1, i]
                own = (1.0 - back) * west + east + below + above
                value += west * lack[j, i - 1] + east * lack[j, i + 1] - own * lack[j, i]
                value += below * lack[j - 1, i] + above * lack[j + 1, i]
            # at the floor the flow does not depend on the deformation
            dense = mass[j, i] / h[j, i] if h[j, i] > floor else 0.0
            diag = (west + east + below + above - back * west) * over_own + dense * w0
            before, after = dense * w_1, dense * w1
            # the fluid pressure of a solid contact stays in this step
            if lumped or not solid[j, i - 1]:
                before -= west * over_west
            if lumped or not solid[j, i + 1]:
                after -= east * over_east
            south[j, i] = below * over_below if lumped or not solid[j - 1, i] else 0.0
            north[j, i] = above * over_above if lumped or not solid[j + 1, i] else 0.0
            if i == 1:
                diag += before * edge[j, 0]
            if i == nx - 2:
                diag += after * edge[j, nx - 1]
            if j == 1:
                diag -= below * over_below * edge[0, i]
            if j == ny - 2:
                diag -= above * over_above * edge[ny - 1, i]
            lower[j, i], rhs[j, i], rho[j, i] = before, value, dense
            pivot[j, i] = 1.0 / (diag - before * ratio[j, i - 1])
            ratio[j, i] = after * pivot[j, i]


@jit
def _far_lift(dp, j, i, w_3, w_2, w2):  # type: ignore[no-untyped-def]
    """Return what dp of nodes two and three away on the line lifts."""
    nx = dp.shape[1]
    far = w2 * dp[j, i + 2] if i < nx - 2 else 0.0
    far += w_2 * dp[j, i - 2] if i > 1 else 0.0
    return far + (w_3 * dp[j, i - 3] if i > 2 else 0.0)


@jit
def relax_lines(  # type: ignore[no-untyped-def]
    p, f, depth, wedge, dx, near, flows, sweeps, dp, over_oil, alone, wrapped,
    free, lower, pivot, ratio, rhs, south, north, rho,
):  # fmt: skip
    """Relax the equation of `line_factors` by lines, dp given where nodes are not free.

    Updates dp; keeps p + dp >= 0, and so the fluid pressure f of nodes at which asperities carry some.
    """
    ny, nx = p.shape
    w_3, w_2, _, _, _, w2 = lifts_of(near, wedge, dx)
    known = np.zeros(nx)
    over = 1.0 if alone else _OVER
    if wrapped:
        wrap(dp)
    for sweep in range(sweeps):
        for row in range(1, ny - 1):
            j = row if sweep % 2 == 0 else ny - 1 - row
            first, last = nx, 0
            for i in range(1, nx - 1):
                known[i] = dp[j, i]
                if not free[j, i]:
                    continue
                first, last = min(first, i), i
                value = rhs[j, i] + south[j, i] * dp[j - 1, i] + north[j, i] * dp[j + 1, i]
                if flows:
                    value -= rho[j, i] * _far_lift(dp, j, i, w_3, w_2, w2)
                known[i] = (value - lower[j, i] * known[i - 1]) * pivot[j, i]
            value = known[last + 1] if last < nx - 2 else 0.0
            for i in range(last, first - 1, -1):
                value = known[i] - ratio[j, i] * value
                if free[j, i]:
                    least = -p[j, i]
                    if depth > 0.0 and f[j, i] < p[j, i]:
                        least = -f[j, i] / over_oil[j, i]
                    dp[j, i] = max(dp[j, i] + over * (value - dp[j, i]), least)
            if wrapped and (j == 1 or j == ny - 2):
                wrap(dp)
