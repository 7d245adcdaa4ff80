"""Frictionless contact of rough, elastic-perfectly-plastic bodies without a fluid.

Constrained conjugate gradients of Polonsky & Keer, Wear 231 (1999) 206, doi:10.1016/S0043-1648(99)00113-1, with the
pressure also bounded from above: nodes at the bound leave the active set and come back when their gap opens.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from .half_space import HalfSpace

Array = NDArray[np.float64]


@njit(cache=True, nogil=True)
def _active_mean(field, p, cap):  # type: ignore[no-untyped-def]
    total, count = 0.0, 0
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            if 0.0 < p[j, i] < cap[j, i]:
                total += field[j, i]
                count += 1
    return total / max(count, 1), count


@njit(cache=True, nogil=True)
def _direction(g, t, p, cap, mean, ratio):  # type: ignore[no-untyped-def]
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            g[j, i] -= mean
            t[j, i] = g[j, i] + ratio * t[j, i] if 0.0 < p[j, i] < cap[j, i] else 0.0


@njit(cache=True, nogil=True)
def _norm(g, p, cap, mean):  # type: ignore[no-untyped-def]
    total = 0.0
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            if 0.0 < p[j, i] < cap[j, i]:
                total += (g[j, i] - mean) ** 2
    return total


@njit(cache=True, nogil=True)
def _step(g, t, r, p, cap, mean_r, load):  # type: ignore[no-untyped-def]
    """Move p along t, keep it in [0, cap], let nodes in, meet the load. Returns the relative change and whether
    nodes came in.
    """
    num, den = 0.0, 0.0
    ny, nx = p.shape
    for j in range(ny):
        for i in range(nx):
            if 0.0 < p[j, i] < cap[j, i]:
                num += g[j, i] * t[j, i]
                den += (r[j, i] - mean_r) * t[j, i]
    tau = num / den if den > 0.0 else 0.0
    came_in = False
    old = p.copy()
    for j in range(ny):
        for i in range(nx):
            active = 0.0 < p[j, i] < cap[j, i]
            if active:
                p[j, i] = min(max(p[j, i] - tau * t[j, i], 0.0), cap[j, i])
            elif (p[j, i] <= 0.0 and g[j, i] < 0.0) or (p[j, i] >= cap[j, i] and g[j, i] > 0.0):
                p[j, i] = min(max(p[j, i] - tau * g[j, i], 0.0), cap[j, i])
                came_in = True
    for _ in range(50):  # scaling may push further nodes to the bound
        free, held = 0.0, 0.0
        for j in range(ny):
            for i in range(nx):
                if p[j, i] < cap[j, i]:
                    free += p[j, i]
                else:
                    held += p[j, i]
        if abs(free + held - load) <= 1e-14 * load or (free <= 0.0 and held <= load):
            break
        all_give = held >= load  # too much at the bound: it gives way, too
        factor = load / (free + held) if all_give else (load - held) / free
        for j in range(ny):
            for i in range(nx):
                if all_give or p[j, i] < cap[j, i]:
                    p[j, i] = min(max(p[j, i] * factor, 0.0), cap[j, i])
    change = 0.0
    for j in range(ny):
        for i in range(nx):
            change += abs(p[j, i] - old[j, i])
    return change / load, came_in


def solve_dry(
    half_space: HalfSpace, gap: Array, cap: Array, load: float, start: Array, tolerance: float, iterations: int
) -> tuple[Array, float, bool, int]:
    """Pressure [ny, nx] that carries `load` (its sum) with 0 <= p <= cap, and the rigid gap that goes with it.

    gap [ny, nx] is that of the undeformed bodies up to a constant; start is any pressure of about the right place.
    Returns (pressure, constant to add to `gap` + deformation so that it vanishes in contact, converged, iterations).
    """
    p = np.clip(start, 0.0, cap)
    if not p.any():  # a contact smaller than the spacing begins at the node that touches first
        p.flat[np.argmin(gap)] = 1.0
    p *= load / p.sum()
    np.minimum(p, cap, out=p)
    t = np.zeros_like(p)
    old_norm, keep = 1.0, 0.0
    converged, n = False, 0
    while n < iterations and not converged:
        n += 1
        g = gap + half_space.deform(p)
        mean, count = _active_mean(g, p, cap)
        if count == 0:
            break
        norm = _norm(g, p, cap, mean)
        _direction(g, t, p, cap, mean, keep * norm / old_norm)
        old_norm = max(norm, 1e-300)
        r = half_space.deform(t)
        mean_r, _ = _active_mean(r, p, cap)
        change, came_in = _step(g, t, r, p, cap, mean_r, load)
        keep = 0.0 if came_in else 1.0
        converged = change < tolerance
    mean, _ = _active_mean(gap + half_space.deform(p), p, cap)
    return p, -mean, converged, n
