"""Passes over the film, in Hertz units: x by a, p by p_H, h by a^2/R, t by a/u_e.

    div(e grad f) - d(m)/dx - d(m)/dt = 0,   m = rho max(h, floor),   e = mobility rho max(h, floor)^3 / eta(f)

f is the fluid pressure, solved everywhere; entrainment is along +x. Second order: central in pressure, upwind (1.5, -2,
0.5) in the wedge. On nodes in solid contact (solid[j, i]) the gap is the floor and the total pressure p is at least
f; elsewhere p = f. Viscosity and density come as tables over pressure (relative to those at p = 0).
"""

import numpy as np
from numba import njit

_jit = njit(cache=True, nogil=True, error_model="numpy")


@_jit
def interpolate(table, step, p):  # type: ignore[no-untyped-def]
    """Linear interpolation in a table over p = 0, step, 2 step...; clamped at its end."""
    at = p / step
    k = int(at)
    if k >= table.size - 1:
        return table[table.size - 1]
    return table[k] + (at - k) * (table[k + 1] - table[k])


@_jit
def film_pass(p, f, solid, undeformed, deformation, rigid, floor, mobility, fluidity, density, step, h, mass, e):  # type: ignore[no-untyped-def]
    """Gap, new solid contacts, mass and mobility of every node, from the pressure."""
    ny, nx = p.shape
    for j in range(ny):
        for i in range(nx):
            gap = rigid + undeformed[j, i] + deformation[j, i]
            h[j, i] = gap
            if not solid[j, i]:
                f[j, i] = p[j, i]
                if gap < 0.95 * floor:  # the 5 % (and those on release) keep nodes from flipping
                    solid[j, i] = True
            flow = floor if solid[j, i] else max(gap, floor)
            rho = interpolate(density, step, f[j, i])
            mass[j, i] = rho * flow
            e[j, i] = mobility * rho * flow**3 * interpolate(fluidity, step, f[j, i]) + 1e-300


@_jit
def transport(mass, mass_old, per_dt, dx, j, i):  # type: ignore[no-untyped-def]
    """d(m)/dx + d(m)/dt at a node."""
    if i > 1:
        wedge = (1.5 * mass[j, i] - 2.0 * mass[j, i - 1] + 0.5 * mass[j, i - 2]) / dx
    else:
        wedge = (mass[j, i] - mass[j, i - 1]) / dx
    return wedge + (mass[j, i] - mass_old[j, i]) * per_dt


@_jit
def fluid_under_contacts(  # type: ignore[no-untyped-def]
    p, f, solid, h, mass, mass_old, e, per_dt, dx, sweeps, floor, mobility, fluidity, density, step
):
    """Gauss-Seidel for the fluid pressure on solid contacts; releases those the fluid alone carries."""
    ny, nx = p.shape
    count = 0
    for j in range(1, ny - 1):
        for i in range(1, nx - 1):
            if solid[j, i]:
                count += 1
    at = np.empty((count, 2), np.int64)
    c = np.empty((count, 5))
    k = 0
    half = 0.5 / (dx * dx)
    for j in range(1, ny - 1):
        for i in range(1, nx - 1):
            if solid[j, i]:
                at[k, 0], at[k, 1] = j, i
                west, east = half * (e[j, i] + e[j, i - 1]), half * (e[j, i] + e[j, i + 1])
                south, north = half * (e[j, i] + e[j - 1, i]), half * (e[j, i] + e[j + 1, i])
                total = west + east + south + north
                c[k, 0], c[k, 1], c[k, 2], c[k, 3] = west / total, east / total, south / total, north / total
                c[k, 4] = -transport(mass, mass_old, per_dt, dx, j, i) / total
                k += 1
    for sweep in range(sweeps):
        last = sweep == sweeps - 1
        for n in range(count):
            k = n if sweep % 2 == 0 else count - 1 - n
            j, i = at[k, 0], at[k, 1]
            value = (
                c[k, 0] * f[j, i - 1] + c[k, 1] * f[j, i + 1] + c[k, 2] * f[j - 1, i] + c[k, 3] * f[j + 1, i] + c[k, 4]
            )
            if last and value > 1.05 * p[j, i] and h[j, i] > 0.9 * floor:  # deeper ones have to come up first
                solid[j, i] = False
            f[j, i] = min(max(value, 0.0), p[j, i])
    for k in range(count):
        j, i = at[k, 0], at[k, 1]
        if not solid[j, i]:
            f[j, i] = p[j, i]
        rho = interpolate(density, step, f[j, i])
        mass[j, i] = rho * floor
        e[j, i] = mobility * rho * floor**3 * interpolate(fluidity, step, f[j, i]) + 1e-300


@_jit
def residual(f, solid, mass, mass_old, e, per_dt, dx, r):  # type: ignore[no-untyped-def]
    """Net inflow of mass per area at every interior node, zero on solid contacts and on the edge."""
    ny, nx = f.shape
    half = 0.5 / (dx * dx)
    r[:] = 0.0
    for j in range(1, ny - 1):
        for i in range(1, nx - 1):
            if not solid[j, i]:
                here, ej = f[j, i], e[j, i]
                flow = (
                    (ej + e[j, i - 1]) * (f[j, i - 1] - here)
                    + (ej + e[j, i + 1]) * (f[j, i + 1] - here)
                    + (ej + e[j - 1, i]) * (f[j - 1, i] - here)
                    + (ej + e[j + 1, i]) * (f[j + 1, i] - here)
                )
                r[j, i] = half * flow - transport(mass, mass_old, per_dt, dx, j, i)


@_jit
def imbalance(p, solid, mass, r):  # type: ignore[no-untyped-def]
    """Mean |residual| / mean mass where fluid alone carries load, weighted by pressure, times its share of the load."""
    wrong, film, fluid, total = 0.0, 1e-300, 0.0, 1e-300
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            total += p[j, i]
            if not solid[j, i]:
                wrong += abs(r[j, i]) * p[j, i]
                film += mass[j, i] * p[j, i]
                fluid += p[j, i]
    return wrong / film * fluid / total


@_jit
def stiff_zone(p, solid, e, dx, compliance, stiff):  # type: ignore[no-untyped-def]
    """Mark where elasticity rules: solid contacts, and fluid nodes whose faces hardly pass any pressure flow."""
    ny, nx = p.shape
    limit = 2.0 * dx * dx * compliance
    stiff[:] = False
    for j in range(1, ny - 1):
        for i in range(1, nx - 1):
            if solid[j, i]:
                stiff[j, i] = True
            elif p[j, i] > 0.0:
                around = max(max(e[j, i - 1], e[j, i + 1]), max(e[j - 1, i], e[j + 1, i]))
                stiff[j, i] = e[j, i] + around < limit


@_jit
def film_correction(p, cap, solid, stiff, h, mass, e, r, floor, per_dt, dx, patch, dh):  # type: ignore[no-untyped-def]
    """Change of the gap that mends the residual in the stiff zone, marched downstream; on solid contacts, to the
    floor.
    """
    ny, nx = p.shape
    half = 0.5 / (dx * dx)
    a0, a1, a2 = 1.5 / dx, -2.0 / dx, 0.5 / dx
    dh[:] = 0.0
    for j in range(1, ny - 1):
        for i in range(1, nx - 1):
            if not stiff[j, i]:
                continue
            if solid[j, i]:
                change = floor - h[j, i]
                dh[j, i] = 0.0 if change > 0.0 and p[j, i] >= cap[j, i] else change
                continue
            rho = mass[j, i] / max(h[j, i], floor)
            before = dh[j, i - 2] if i > 1 else 0.0
            faces = half * (4.0 * e[j, i] + e[j, i - 1] + e[j, i + 1] + e[j - 1, i] + e[j + 1, i])
            dh[j, i] = (r[j, i] / rho - a1 * dh[j, i - 1] - a2 * before) / (a0 + per_dt + faces / (rho * patch))


@_jit
def pressure_correction(p, f, solid, stiff, h, mass, e, r, floor, per_dt, dx, near, patch_wide, sweeps, dp):  # type: ignore[no-untyped-def]
    """Line over-relaxation of the linearised equation outside the stiff zone, dp given inside it. Updates dp, p +
    dp >= 0.
    """
    ny, nx = p.shape
    half = 0.5 / (dx * dx)
    k0, k1, k2, k3, k4 = near[0, 0], near[0, 1], near[0, 2], near[0, 3], near[0, 4]
    # d(deformation wedge)_i / dp_(i + m)
    w_3 = (1.5 * k3 - 2.0 * k2 + 0.5 * k1) / dx
    w_2 = (1.5 * k2 - 2.0 * k1 + 0.5 * k0) / dx
    w_1 = (1.5 * k1 - 2.0 * k0 + 0.5 * k1) / dx
    w0 = (1.5 * k0 - 2.0 * k1 + 0.5 * k2) / dx
    w1 = (1.5 * k1 - 2.0 * k2 + 0.5 * k3) / dx
    w2 = (1.5 * k2 - 2.0 * k3 + 0.5 * k4) / dx
    squeeze = per_dt * patch_wide
    lower, diag, upper, rhs = np.empty(nx), np.empty(nx), np.empty(nx), np.empty(nx)
    for sweep in range(sweeps):
        for row in range(1, ny - 1):
            j = row if sweep % 2 == 0 else ny - 1 - row
            work = False
            for i in range(1, nx - 1):
                lower[i], upper[i], diag[i], rhs[i] = 0.0, 0.0, 1.0, dp[j, i]
                if stiff[j, i]:
                    continue
                dead = p[j, i] <= 0.0 and r[j, i] <= 0.0 and p[j, i - 1] <= 0.0 and p[j, i + 1] <= 0.0
                if dead and p[j - 1, i] <= 0.0 and p[j + 1, i] <= 0.0 and dp[j - 1, i] <= 0.0 and dp[j + 1, i] <= 0.0:
                    rhs[i] = 0.0
                    continue
                work = True
                west, east = half * (e[j, i] + e[j, i - 1]), half * (e[j, i] + e[j, i + 1])
                south, north = half * (e[j, i] + e[j - 1, i]), half * (e[j, i] + e[j + 1, i])
                rho = mass[j, i] / max(h[j, i], floor)
                lift = 1.0 if h[j, i] > floor else 0.0  # at the floor the flow does not feel the deformation
                free_w = 0.0 if solid[j, i - 1] else west  # the fluid pressure of a solid contact stays in this step
                free_e = 0.0 if solid[j, i + 1] else east
                d_south = 0.0 if solid[j - 1, i] else dp[j - 1, i]
                d_north = 0.0 if solid[j + 1, i] else dp[j + 1, i]
                far = w_2 * (dp[j, i - 2] if i > 1 else 0.0) + w2 * (dp[j, i + 2] if i < nx - 2 else 0.0)
                far += w_3 * (dp[j, i - 3] if i > 2 else 0.0)
                diag[i] = west + east + south + north + rho * lift * (w0 + squeeze)
                lower[i] = -free_w + rho * lift * w_1
                upper[i] = -free_e + rho * lift * w1
                rhs[i] = r[j, i] + south * d_south + north * d_north - rho * lift * far
            if not work:
                continue
            for i in range(2, nx - 1):
                factor = lower[i] / diag[i - 1]
                diag[i] -= factor * upper[i - 1]
                rhs[i] -= factor * rhs[i - 1]
            value = 0.0
            for i in range(nx - 2, 0, -1):
                value = (rhs[i] - upper[i] * value) / diag[i]
                if not stiff[j, i]:
                    dp[j, i] = max(dp[j, i] + 1.6 * (value - dp[j, i]), -p[j, i])
