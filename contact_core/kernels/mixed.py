"""Mixed lubrication: one fixed point for fluid and solid pressure from full film to dry contact.

Unknowns are the total pressure p, the fluid's share f, the set of solid contacts and the rigid gap. On solid
contacts the gap is the
floor and p >= f; elsewhere p = f; 0 <= p <= cap everywhere. An iteration mends the film residual in the stiff zone
through the inverse of the half space, the rest by lines, and meets the load exactly; Anderson's method accelerates it.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from . import reynolds
from .anderson import Anderson
from .half_space import HalfSpace

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_DEPTH = 5  # of Anderson's memory: deeper does not help where contacts come and go
_SWEEPS_UNDER_CONTACTS = 6
_LINE_SWEEPS = 1
_LOAD_TOLERANCE = 1e-4
_INTRUSION_TOLERANCE = 0.1


@dataclass(frozen=True)
class Problem:
    """One instant in Hertz units, entrainment along +x. Arrays [ny, nx]; tables over p = 0, step, 2 step..."""

    undeformed: Array  # gap of the undeformed bodies, roughness included, up to a constant
    cap: Array  # largest pressure
    floor: float
    spacing: float
    load: float  # sum of p over the nodes
    mobility: float
    per_dt: float  # 1 / time step, 0: steady
    mass_old: Array  # mass of the previous instant
    fluidity: Array  # table of 1 / viscosity
    density: Array  # table
    step: float


@dataclass(frozen=True)
class Iterate:
    """Where an iteration starts from and what it ends with. Arrays [ny, nx]."""

    pressure: Array
    fluid: Array
    solid: Mask
    rigid: float


@dataclass(frozen=True)
class Solution:
    """The end of an iteration and how good it is."""

    iterate: Iterate
    gap: Array  # may be below the floor where the pressure is capped: what is missing yields plastically
    mass: Array
    converged: bool
    iterations: int
    change: float  # last relative change of the pressure by an iteration
    load_error: float  # relative
    intrusion: float  # mean distance of solid contacts below the cap from the floor, weighted by pressure, in floors


@njit(cache=True, nogil=True)
def _combine_corrections(p, cap, h, floor, stiff, dz, dp, unit, damping, load):  # type: ignore[no-untyped-def]
    """Damp and bound the corrections, meet the load; dp becomes the next pressure. Returns the change of the rigid
    gap.
    """
    size = 0.0
    ny, nx = p.shape
    for j in range(ny):
        for i in range(nx):
            if stiff[j, i] and p[j, i] >= cap[j, i] and h[j, i] < floor:
                stiff[j, i] = False  # yields: stays at the cap until its gap opens
                dp[j, i] = 0.0
                continue
            step = 0.5 * dz[j, i] if stiff[j, i] else 0.7 * dp[j, i]
            bound = 0.2 + 0.5 * p[j, i]
            step = min(max(step, -bound), bound)
            dp[j, i] = step
            size += abs(step)
    factor = min(damping, 0.1 * load / max(size, 1e-300))
    for j in range(ny):
        for i in range(nx):
            dp[j, i] = p[j, i] + factor * dp[j, i]
    shift = 0.0
    for _ in range(4):  # nodes at a bound cannot take their part
        total, lever = 0.0, 0.0
        for j in range(ny):
            for i in range(nx):
                value = dp[j, i] - (shift * unit[j, i] if stiff[j, i] else 0.0)
                total += min(max(value, 0.0), cap[j, i])
                if stiff[j, i] and 0.0 < value < cap[j, i]:
                    lever += unit[j, i]
        if abs(total - load) <= 1e-10 * load or lever <= 1e-3 * load:
            break
        shift += (total - load) / lever
    for j in range(ny):
        for i in range(nx):
            value = dp[j, i] - (shift * unit[j, i] if stiff[j, i] else 0.0)
            dp[j, i] = min(max(value, 0.0), cap[j, i])
    return shift


@njit(cache=True, nogil=True)
def _distance(a, b):  # type: ignore[no-untyped-def]
    total = 0.0
    for j in range(a.shape[0]):
        for i in range(a.shape[1]):
            total += abs(a[j, i] - b[j, i])
    return total


@njit(cache=True, nogil=True)
def _quality(p, f, cap, solid, h, floor):  # type: ignore[no-untyped-def]
    """Load carried by solids, total load, mean distance of solid contacts below the cap from the floor, weighted
    by load.
    """
    solids, total, intrusion = 0.0, 0.0, 0.0
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            total += p[j, i]
            if solid[j, i]:
                solids += p[j, i] - f[j, i]
                if p[j, i] < cap[j, i]:
                    intrusion += p[j, i] * abs(floor - h[j, i])
    return solids, total, intrusion / (floor * total)


def solve_mixed(half_space: HalfSpace, problem: Problem, start: Iterate, tolerance: float, iterations: int) -> Solution:
    """Iterate from `start` until the relative pressure change is below `tolerance` or `iterations` are spent.

    Non-finite values never leave: the last finite iterate is returned, not converged.
    """
    q, dx = problem, problem.spacing
    p, f, solid, rigid = start.pressure.copy(), start.fluid.copy(), start.solid.copy(), start.rigid
    shape = p.shape
    h, mass, e, r, dh, dp = (np.zeros(shape) for _ in range(6))
    stiff = np.zeros(shape, np.bool_)
    unit = np.zeros(shape)
    near = half_space.near
    patch = near[0, 0] + 2 * near[0, 1] + 2 * near[1, 0] + 4 * near[1, 1]
    patch_wide = 4 * near.sum() - 2 * near[0].sum() - 2 * near[:, 0].sum() + near[0, 0]
    weight = float(max(shape))  # of the rigid gap among the pressures in Anderson's norm
    memory = Anderson(p.size + 1, _DEPTH)
    change, best, share_old, converged, n = np.inf, np.inf, np.inf, False, 0
    load_error, intrusion, damping = np.inf, np.inf, 1.0

    def film() -> None:
        deformation = half_space.deform(p)
        reynolds.film_pass(
            p,
            f,
            solid,
            q.undeformed,
            deformation,
            rigid,
            q.floor,
            q.mobility,
            q.fluidity,
            q.density,
            q.step,
            h,
            mass,
            e,
        )
        reynolds.fluid_under_contacts(
            p,
            f,
            solid,
            mass,
            q.mass_old,
            e,
            q.per_dt,
            dx,
            _SWEEPS_UNDER_CONTACTS,
            q.floor,
            q.mobility,
            q.fluidity,
            q.density,
            q.step,
        )

    for n in range(1, iterations + 1):
        film()
        reynolds.residual(f, solid, mass, q.mass_old, e, q.per_dt, dx, r)
        reynolds.stiff_zone(p, solid, e, dx, stiff)
        reynolds.film_correction(p, q.cap, solid, stiff, h, mass, e, r, q.floor, q.per_dt, dx, patch, dh)
        dz = half_space.press(dh)
        if n % 5 == 1:
            unit = half_space.press(stiff.astype(np.float64))
        dp[:] = np.where(stiff, 0.5 * dz, 0.0)
        reynolds.pressure_correction(
            p, f, solid, stiff, h, mass, e, r, q.floor, q.per_dt, dx, near, patch_wide, _LINE_SWEEPS, dp
        )
        shift = _combine_corrections(p, q.cap, h, q.floor, stiff, dz, dp, unit, damping, q.load)
        change = _distance(dp, p) / q.load
        solids, total, intrusion = _quality(p, f, q.cap, solid, h, q.floor)
        load_error = total / q.load - 1.0
        share = solids / q.load
        if not np.isfinite(change):
            break
        converged = (
            change < tolerance
            and abs(load_error) < _LOAD_TOLERANCE
            and intrusion < _INTRUSION_TOLERANCE
            and abs(share - share_old) < tolerance
        )
        if converged:
            break
        share_old = share
        if change > 0.03 and change > 3.0 * best:
            memory.clear()
            damping = max(0.6 * damping, 0.2)
        best = min(best, change)
        x = np.append(p.ravel(), weight * rigid)
        mixed = memory.mix(x, np.append(dp.ravel(), weight * (rigid + shift)))
        # what an iteration puts at the cap stays there: mixed below it, it would be pushed against its overlap again
        p = np.where(dp >= q.cap, q.cap, np.clip(mixed[:-1].reshape(shape), 0.0, q.cap))
        rigid = float(mixed[-1]) / weight
    return Solution(Iterate(p, f, solid, rigid), h, mass, converged, n, change, load_error, intrusion)


def advected(start: Iterate, smooth: Array, nodes: int) -> Iterate:
    """Predict the iterate after the rough surface has moved by `nodes` along +x: its pressure pattern moves along.

    smooth [ny, nx] is the pressure of the smooth bodies; where it is high, the ratio to it is what moves.
    """
    if nodes == 0:
        return start
    shape = np.where(smooth > 0.3, smooth, 1.0)
    inside = (smooth > 0.3) & (_moved(smooth, nodes) > 0.3)
    pressure = np.where(inside, smooth * _moved(start.pressure / shape, nodes), start.pressure)
    share = np.where(start.pressure > 0.0, start.fluid / np.maximum(start.pressure, 1e-300), 1.0)
    share = np.where(inside, _moved(share, nodes), share)
    solid = np.where(inside, _moved(start.solid, nodes), start.solid)
    return Iterate(pressure, np.where(solid, share, 1.0) * pressure, solid, start.rigid)


def _moved(field: NDArray[Any], nodes: int) -> NDArray[Any]:
    out = np.zeros_like(field)
    if nodes > 0:
        out[:, nodes:] = field[:, :-nodes]
    else:
        out[:, :nodes] = field[:, -nodes:]
    return out
