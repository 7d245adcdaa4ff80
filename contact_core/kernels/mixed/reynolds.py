"""Passes over the film, in the units of `problem`.

    div(e grad f) - wedge d(m)/dx - d(m)/dt = 0,   m = rho max(h, floor),
    e = mobility rho max(h, floor)^3 (1 / eta(f) + thinned)

f is the fluid pressure, solved everywhere; entrainment is along +x, `wedge` its speed in the unit of speeds: 1, less
where a time step is so short that squeezing rules, 0 at rest. Second order: central in pressure, upwind (1.5, -2,
0.5) in the wedge. On nodes in solid contact (solid[j, i]) the gap is the floor and the total pressure p is at least
f; elsewhere p = f. Viscosity and density come as tables over pressure (relative to those at p = 0). All arrays are
[ny, nx] unless stated otherwise.

`flux`, `filling`: from `cavities.carry`; masses are less than m where the film is not full. None: it is full
everywhere. With them, `first` is the first column in which the oil has pressure.
"""

import numpy as np

from ..compiled import jit
from .edge import wrap

_TOUCH = 0.5  # gap in floors below which a node becomes solid at once; below 1, where its film loses mass
_DEEP = 0.5  # gap in floors below which a contact is not released: it has to rise first


@jit
def interpolate(table, step, p):  # type: ignore[no-untyped-def]
    """Interpolate linearly in a table over p = 0, step, 2 step...; clamped at its end."""
    at = p / step
    k = int(at)
    if k >= table.size - 1:
        return table[table.size - 1]
    return table[k] + (at - k) * (table[k + 1] - table[k])


@jit
def _properties(p, per_step, density, fluidity):  # type: ignore[no-untyped-def]
    """Return density and fluidity at a pressure, as `interpolate`."""
    at = p * per_step
    k = int(at)
    if k >= density.size - 1:
        return density[density.size - 1], fluidity[density.size - 1]
    part = at - k
    rho, flow = density[k], fluidity[k]
    return rho + part * (density[k + 1] - rho), flow + part * (fluidity[k + 1] - flow)


@jit
def film_pass(  # type: ignore[no-untyped-def]
    p,
    f,
    solid,
    undeformed,
    deformation,
    rigid,
    floor,
    mobility,
    thinned,
    fluidity,
    density,
    step,
    h,
    mass,
    e,
    lumped=False,
):
    """Compute gap, new solid contacts, mass and mobility of every node from the pressure.

    `deformation` may have more columns than there are nodes. lumped: f = p on solid contacts, too; where that is zero
    they are released.
    """
    ny, nx = p.shape
    per_step = 1.0 / step
    touch = _TOUCH * floor
    for j in range(ny):
        for i in range(nx):
            gap = rigid + undeformed[j, i] + deformation[j, i]
            h[j, i] = gap
            touches = solid[j, i]
            if touches and p[j, i] <= 0.0 and (lumped or gap > floor):
                touches = False  # it carries no load
            elif not touches:
                touches = gap < touch
            if lumped or not (solid[j, i] and touches):
                f[j, i] = p[j, i]
            solid[j, i] = touches
            flow = floor if touches else max(gap, floor)
            rho, fluid = _properties(f[j, i], per_step, density, fluidity)
            mass[j, i] = rho * flow
            e[j, i] = mobility[j, i] * rho * (fluid + thinned[j, i]) * (flow * flow * flow) + 1e-300


@jit
def transport(mass, flux, mass_old, per_dt, wedge, dx, j, i):  # type: ignore[no-untyped-def]
    """Return the mass carried away and squeezed out at a node: wedge d(m)/dx + d(m)/dt."""
    if flux is not None:
        slope = (flux[j, i] - flux[j, i - 1]) / dx
    elif i > 1:
        slope = (1.5 * mass[j, i] - 2.0 * mass[j, i - 1] + 0.5 * mass[j, i - 2]) / dx
    else:
        slope = (mass[j, i] - mass[j, i - 1]) / dx
    return wedge * slope + (mass[j, i] - mass_old[j, i]) * per_dt


@jit
def returned(filling, first, per_dt, wedge, dx, j, i):  # type: ignore[no-untyped-def]
    """Return the share of a node's upstream pressure flow that comes back: in time all of it, from a cavity."""
    return wedge / (wedge + per_dt * dx) if i > first and filling[j, i - 1] < 1.0 else 0.0


@jit
def fluid_under_contacts(  # type: ignore[no-untyped-def]
    p,
    f,
    solid,
    h,
    mass,
    mass_old,
    e,
    per_dt,
    wedge,
    dx,
    sweeps,
    floor,
    mobility,
    thinned,
    fluidity,
    density,
    step,
    full,
    flux=None,
    first=1,
    wrapped=False,
):
    """Solve for the fluid pressure on solid contacts by Gauss-Seidel; release contacts that the fluid alone carries.

    full: what nodes hold if they are full, which changes with that pressure; `mass` itself where none is a cavity.
    """
    ny, nx = p.shape
    count = 0
    for j in range(1, ny - 1):
        for i in range(first, nx - 1):
            if solid[j, i]:
                count += 1
    at, c = np.empty(count, np.int64), np.empty((count, 5))
    half, n = 0.5 / (dx * dx), 0
    for j in range(1, ny - 1):
        for i in range(first, nx - 1):
            if solid[j, i]:
                here = e[j, i]
                west, east, south, north = (
                    here + e[j, i - 1],
                    here + e[j, i + 1],
                    here + e[j - 1, i],
                    here + e[j + 1, i],
                )
                part = 1.0 / (west + east + south + north)
                at[n] = j * nx + i
                c[n, 0], c[n, 1], c[n, 2], c[n, 3] = west * part, east * part, south * part, north * part
                c[n, 4] = -transport(mass, flux, mass_old, per_dt, wedge, dx, j, i) * part / half
                n += 1
    pp, ff, hh, ee, mm, ss = p.ravel(), f.ravel(), h.ravel(), e.ravel(), full.ravel(), solid.ravel()
    ease, more = mobility.ravel(), thinned.ravel()
    for sweep in range(sweeps):
        last = sweep == sweeps - 1
        for m in range(count):
            n = m if sweep % 2 == 0 else count - 1 - m
            k = at[n]
            across = c[n, 2] * ff[k - nx] + c[n, 3] * ff[k + nx] + c[n, 4]
            value = across + c[n, 1] * ff[k + 1] + c[n, 0] * ff[k - 1]
            if last and value > pp[k] and hh[k] > _DEEP * floor:
                ss[k] = False
            ff[k] = min(max(value, 0.0), pp[k])
        if wrapped:
            wrap(f)
    cube, per_step = floor * floor * floor, 1.0 / step
    for n in range(count):
        k = at[n]
        if not ss[k]:
            ff[k] = pp[k]
        rho, fluid = _properties(ff[k], per_step, density, fluidity)
        mm[k] = rho * floor
        ee[k] = ease[k] * cube * rho * (fluid + more[k]) + 1e-300
    if wrapped:
        wrap(f)
        wrap(mass)
        wrap(e)
        wrap(solid)


@jit
def residual(f, solid, mass, mass_old, e, per_dt, wedge, dx, r, flux=None, filling=None, first=1):  # type: ignore[no-untyped-def]
    """Compute the net inflow of mass per area at inner nodes; zero on solid contacts, in cavities and on the edge."""
    ny, nx = f.shape
    half = 0.5 / (dx * dx)
    r[:] = 0.0
    for j in range(1, ny - 1):
        for i in range(first, nx - 1):
            if filling is not None and filling[j, i] < 1.0:
                continue
            if not solid[j, i]:
                here, ej = f[j, i], e[j, i]
                flow = (
                    (ej + e[j, i - 1]) * (f[j, i - 1] - here)
                    + (ej + e[j, i + 1]) * (f[j, i + 1] - here)
                    + (ej + e[j - 1, i]) * (f[j - 1, i] - here)
                    + (ej + e[j + 1, i]) * (f[j + 1, i] - here)
                )
                r[j, i] = half * flow - transport(mass, flux, mass_old, per_dt, wedge, dx, j, i)


@jit
def imbalance(p, f, cap, solid, h, mass, r, floor, dx):  # type: ignore[no-untyped-def]
    """Return the mass that the film gains or loses without a cause.

    It is relative to the film, weighted by pressure, and multiplied by the oil's share of the load.

    r: net inflow at every node, contacts included. The rules are those of `corrections.correct_gap`.
    """
    wrong, film, fluid, total = 0.0, 1e-300, 0.0, 1e-300
    for j in range(1, p.shape[0] - 1):
        for i in range(1, p.shape[1] - 1):
            here, lack = p[j, i], abs(r[j, i])
            total += here
            if solid[j, i]:
                if r[j, i] > 0.0 and f[j, i] >= here and here < cap[j, i]:
                    wrong += lack * here
                continue
            if r[j, i] < 0.0:
                lack = min(lack, mass[j, i] * max(h[j, i] / floor - 1.0, 0.0) / dx)
            elif here >= cap[j, i]:
                lack = 0.0
            wrong += lack * here
            film += mass[j, i] * here
            fluid += here
    return wrong / film * fluid / total
