"""Passes over the film, in the units of `problem`.

    div(e grad f) - wedge d(m)/dx - d(m)/dt = 0,   m = rho max(h, floor),
    e = mobility rho max(h, floor)^3 (1 / eta(f) + thinned)

f is the fluid pressure, solved everywhere; entrainment is along +x, `wedge` its speed in the unit of speeds: 1, less
where a time step is so short that squeezing rules, 0 at rest. What flows through the faces between nodes is said in
`flow`: their mobilities ex and ey, and the mass `flux` that is carried along. On nodes in solid contact (solid[j, i])
the gap is the floor and the total pressure p is at least f; elsewhere f is p less what asperities below the grid carry
(`asperities`). In a march the h of e is the mean gap of the step (`flow.gap_of_step`). Viscosity and density come as
tables over pressure (relative to those at p = 0). All arrays are [ny, nx] unless stated otherwise.

`filling`: from `cavities.carry`; masses are less than m where the film is not full. None: it is full everywhere. With
it, `first` is the first column in which the oil has pressure.
"""

import numpy as np

from ..compiled import jit
from .asperities import carried_at, rest_gap
from .edge import wrap
from .flow import properties

_TOUCH = 0.5  # gap in floors below which a node becomes solid at once; below 1, where its film loses mass
DEEP = 0.5  # gap in floors below which a contact is not released: it has to rise first


@jit
def film_pass(  # type: ignore[no-untyped-def]
    p,
    f,
    solid,
    undeformed,
    deformation,
    rigid,
    floor,
    stress,
    depth,
    step,
    density,
    fluidity,
    potential,
    h,
    pressing,
    mass,
    gap,
    rho,
    fluid,
    driven,
    lumped,
    ruled,
    trace,
):
    """Compute gap, new solid contacts, full mass and the nodes' properties of `flow` from the pressure.

    `deformation` may have more columns than there are nodes. pressing: what asperities carry at the gap. lumped: f = p
    on solid contacts, too; where that is zero they are released. ruled: nodes that count as solid contacts although
    asperities share the load with oil there, see `asperities.share_out`; None: there are none. trace: part of what
    asperities carry, below which oil counts as none.
    """
    ny, nx = p.shape
    touch = _TOUCH * floor
    for j in range(ny):
        for i in range(nx):
            here = rigid + undeformed[j, i] + deformation[j, i]
            touches, own = solid[j, i], carried_at(here, floor, stress, depth)
            h[j, i], pressing[j, i] = here, own
            if touches and p[j, i] <= 0.0 and own <= 0.0 and (lumped or here > floor):
                touches = False  # it carries no load
            elif touches and depth > 0.0 and own < p[j, i] and here > floor:
                touches = ruled is not None and ruled[j, i]  # else asperities share the load with the oil
            elif not touches:
                touches = here < touch or (ruled is not None and ruled[j, i])
            if lumped:
                f[j, i] = p[j, i]
            elif not (solid[j, i] and touches):
                f[j, i] = max(p[j, i] - own, 0.0)
                if f[j, i] < trace * own:
                    f[j, i] = 0.0
            solid[j, i] = touches
            open_gap = floor if touches and depth <= 0.0 else max(here, floor)
            gap[j, i] = open_gap
            rho[j, i], fluid[j, i], driven[j, i] = properties(f[j, i], step, density, fluidity, potential)
            mass[j, i] = rho[j, i] * open_gap


@jit
def transport(mass, flux, mass_old, per_dt, wedge, dx, j, i):  # type: ignore[no-untyped-def]
    """Return the mass carried away and squeezed out at a node: wedge d(m)/dx + d(m)/dt."""
    return wedge * ((flux[j, i] - flux[j, i - 1]) / dx) + (mass[j, i] - mass_old[j, i]) * per_dt


@jit
def inflow(f, ex, ey, per_dx2, j, i):  # type: ignore[no-untyped-def]
    """Return the mass that pressure drives into a node: div(e grad f)."""
    here = f[j, i]
    along = ex[j, i - 1] * (f[j, i - 1] - here) + ex[j, i] * (f[j, i + 1] - here)
    return per_dx2 * (along + ey[j - 1, i] * (f[j - 1, i] - here) + ey[j, i] * (f[j + 1, i] - here))


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
    ex,
    ey,
    flux,
    per_dt,
    wedge,
    dx,
    sweeps,
    floor,
    step,
    density,
    fluidity,
    potential,
    full,
    gap,
    rho,
    fluid,
    driven,
    first=1,
    wrapped=False,
):
    """Solve for the fluid pressure on solid contacts by Gauss-Seidel; release contacts that the fluid alone carries.

    full: what nodes hold if they are full, which changes with that pressure as rho, fluid and driven do; `mass` itself
    where none is a cavity. Returns True if there is a contact.
    """
    ny, nx = p.shape
    count = 0
    for j in range(1, ny - 1):
        for i in range(first, nx - 1):
            if solid[j, i]:
                count += 1
    if count == 0:
        return False
    at, c = np.empty(count, np.int64), np.empty((count, 5))
    n = 0
    for j in range(1, ny - 1):
        for i in range(first, nx - 1):
            if solid[j, i]:
                west, east, south, north = ex[j, i - 1], ex[j, i], ey[j - 1, i], ey[j, i]
                part = 1.0 / (west + east + south + north)
                at[n] = j * nx + i
                c[n, 0], c[n, 1], c[n, 2], c[n, 3] = west * part, east * part, south * part, north * part
                c[n, 4] = -transport(mass, flux, mass_old, per_dt, wedge, dx, j, i) * part * dx * dx
                n += 1
    pp, ff, hh, mm, ss = p.ravel(), f.ravel(), h.ravel(), full.ravel(), solid.ravel()
    for sweep in range(sweeps):
        last = sweep == sweeps - 1
        for m in range(count):
            n = m if sweep % 2 == 0 else count - 1 - m
            k = at[n]
            across = c[n, 2] * ff[k - nx] + c[n, 3] * ff[k + nx] + c[n, 4]
            value = across + c[n, 1] * ff[k + 1] + c[n, 0] * ff[k - 1]
            if last and value > pp[k] and hh[k] > DEEP * floor:
                ss[k] = False
            ff[k] = min(max(value, 0.0), pp[k])
        if wrapped:
            wrap(f)
    rr, flu, dd, gg = rho.ravel(), fluid.ravel(), driven.ravel(), gap.ravel()
    for n in range(count):
        k = at[n]
        if not ss[k]:
            ff[k] = pp[k]
        rr[k], flu[k], dd[k] = properties(ff[k], step, density, fluidity, potential)
        mm[k] = rr[k] * gg[k]
    if wrapped:
        for field in (f, full, rho, fluid, driven):
            wrap(field)
        wrap(solid)
    return True


@jit
def residual(f, solid, mass, mass_old, ex, ey, flux, per_dt, wedge, dx, r, filling, first):  # type: ignore[no-untyped-def]
    """Compute the net inflow of mass per area at inner nodes; zero on solid contacts, in cavities and on the edge."""
    ny, nx = f.shape
    per_dx2 = 1.0 / (dx * dx)
    r[:] = 0.0
    for j in range(1, ny - 1):
        for i in range(first, nx - 1):
            if filling is not None and filling[j, i] < 1.0:
                continue
            if not solid[j, i]:
                r[j, i] = inflow(f, ex, ey, per_dx2, j, i) - transport(mass, flux, mass_old, per_dt, wedge, dx, j, i)


@jit
def imbalance(p, f, cap, solid, h, mass, r, floor, stress, depth, dx):  # type: ignore[no-untyped-def]
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
                rest = rest_gap(here, floor, stress, depth)
                lack = min(lack, mass[j, i] * max(h[j, i] / rest - 1.0, 0.0) / dx)
            elif here >= cap[j, i]:
                lack = 0.0
            wrong += lack * f[j, i]
            film += mass[j, i] * f[j, i]
            fluid += f[j, i]
    return wrong / film * fluid / total
