"""Linearisation of `cavities.carry` for `newton`: derivatives of a film that is not full everywhere.

Which nodes are full is held. What flows through a cavity is marched downstream, as the flow itself is, so that the
product with the Jacobian is exact; its local part holds only the share of a cavity's flow that comes back at once.
"""

from ..compiled import jit
from . import cavities, reynolds


@jit
def _most(full, before, j, i):  # type: ignore[no-untyped-def]
    """Return the derivatives of a full node's flow, behind a filling `before`: by both masses and by that filling."""
    if i == 0:
        return 0.5, 0.5, 0.0  # of the first two nodes
    own, rise = full[j, i], full[j, i] - full[j, i - 1]
    order = max(1.0 - cavities.FADE * (1.0 - before), 0.0)
    if own + 0.5 * order * rise < cavities.LEAST * own:
        return cavities.LEAST, 0.0, 0.0
    return 1.0 + 0.5 * order, -0.5 * order, 0.5 * cavities.FADE * rise if order > 0.0 else 0.0


@jit
def change(  # type: ignore[no-untyped-def]
    f, full, e, slope, flux, filling, df, dh, per_dt, wedge, dx, conserving, first, dr
):
    """Compute the change dr [ny, nx] of the net inflow with fluid pressure and gap; slope [4, ny, nx] of `newton`."""
    ny, nx = f.shape
    half, wedge_per_dx = 0.5 / (dx * dx), wedge / dx
    dr[:] = 0.0
    for j in range(ny):
        inner_row = 0 < j < ny - 1
        before, d_before, d_held, d_flow = 1.0, 0.0, 0.0, 0.0  # of the node upstream
        for i in range(nx):
            held = slope[0, j, i] * df[j, i] + slope[1, j, i] * dh[j, i]
            inner, pressed = inner_row and 0 < i < nx - 1, 0.0
            if inner:
                mine, de = e[j, i], slope[2, j, i] * df[j, i] + slope[3, j, i] * dh[j, i]
                for n in range(4):
                    jn, im = j + (0, 0, -1, 1)[n], i + (-1, 1, 0, 0)[n]
                    their = slope[2, jn, im] * df[jn, im] + slope[3, jn, im] * dh[jn, im]
                    pressed += (mine + e[jn, im]) * (df[jn, im] - df[j, i]) + (de + their) * (f[jn, im] - f[j, i])
                pressed *= half
            own, other, by_filling = _most(full, before, j, i)
            if i == 0:
                d_most = own * held + other * (slope[0, j, 1] * df[j, 1] + slope[1, j, 1] * dh[j, 1])
            else:
                d_most = own * held + other * d_held + by_filling * d_before
            theta, d_theta = filling[j, i], 0.0
            if theta < 1.0:
                most = flux[j, i] / theta if theta > 0.0 else full[j, i]
                if conserving and (i == 0 or i < first):
                    d_theta = -theta * d_most / most
                elif theta > 0.0:
                    kept = wedge_per_dx * d_most + per_dt * held
                    d_theta = wedge_per_dx * d_flow + pressed - theta * kept
                    d_theta /= wedge_per_dx * most + per_dt * full[j, i]
                d_next = d_theta * most + theta * d_most
            else:
                d_next = d_most
            if inner and i >= first and theta >= 1.0:
                dr[j, i] = pressed - wedge_per_dx * (d_next - d_flow) - per_dt * held
            before, d_before, d_held, d_flow = theta, d_theta, held, d_next


@jit
def linearise(f, full, e, slope, filling, per_dt, wedge, dx, first, by_f, by_h):  # type: ignore[no-untyped-def]
    """Compute the local part of `change`: derivatives by_f, by_h [6, ny, nx] on the stencil of `newton`."""
    ny, nx = f.shape
    half, wedge_per_dx = 0.5 / (dx * dx), wedge / dx
    by_f[:], by_h[:] = 0.0, 0.0
    for j in range(1, ny - 1):
        for i in range(first, nx - 1):
            if filling[j, i] < 1.0:
                continue
            part = 1.0 - reynolds.returned(filling, first, per_dt, wedge, dx, j, i)
            for n in range(1, 5):
                jn, im = j + (0, 0, 0, -1, 1)[n], i + (0, -1, 1, 0, 0)[n]
                share = half * (part if n == 1 else 1.0)
                d, face = f[jn, im] - f[j, i], share * (e[j, i] + e[jn, im])
                by_f[n, j, i] = face + share * slope[2, jn, im] * d
                by_h[n, j, i] = share * slope[3, jn, im] * d
                by_f[0, j, i] += share * slope[2, j, i] * d - face
                by_h[0, j, i] += share * slope[3, j, i] * d
            a0, a1, _ = _most(full, filling[j, i - 1], j, i)
            a2 = 0.0
            if filling[j, i - 1] >= 1.0:
                b0, b1, _ = _most(full, filling[j, i - 2] if i > 1 else 1.0, j, i - 1)
                a1 -= b0
                if i > 1:
                    a2 = -b1
                else:
                    a0 -= b1
            a0, a1, a2 = wedge_per_dx * a0 + per_dt, wedge_per_dx * a1, wedge_per_dx * a2
            by_f[0, j, i] -= a0 * slope[0, j, i]
            by_h[0, j, i] -= a0 * slope[1, j, i]
            by_f[1, j, i] -= a1 * slope[0, j, i - 1]
            by_h[1, j, i] -= a1 * slope[1, j, i - 1]
            if i > 1:
                by_f[5, j, i] = -a2 * slope[0, j, i - 2]
                by_h[5, j, i] = -a2 * slope[1, j, i - 2]
