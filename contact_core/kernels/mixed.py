"""Mixed lubrication: one fixed point for fluid and solid pressure from full film to dry contact.

Unknowns are the total pressure p, the fluid's share f, the set of solid contacts and the rigid gap. On solid contacts
the gap is the floor and p >= f; elsewhere p = f; 0 <= p <= cap everywhere. An iteration mends the film residual in
the stiff zone through the inverse of the half space, the rest by lines, and meets the load exactly; Anderson's method
accelerates it.
"""

from dataclasses import dataclass, replace
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
_INTRUSION_TOLERANCE = 0.2
_IMBALANCE_PER_TOLERANCE = 100.0  # what a time step still owes is made up for in the next one...
_STEADY_IMBALANCE = 0.05  # ...but a steady film has no next one
_SHARE_TOLERANCE = 0.02  # nodes at the floor whose fluid pressure is about p change sides for ever, p unchanged


@dataclass(frozen=True)
class Problem:
    """One instant, entrainment along +x, in units of length l, pressure q and gap l^2 / radius. Arrays [ny, nx]; tables
    over p = 0, step, 2 step...

    In Hertz units (l = a, q = p_H) the deformation is 2 / pi^2 * integral p / r; `compliance` is the factor on that in
    the units at hand. Units are chosen so that pressures and lengths of the solution are of order one.
    """

    undeformed: Array  # gap of the undeformed bodies, roughness included, up to a constant
    cap: Array  # largest pressure
    floor: float
    spacing: float
    load: float  # sum of weight * p over the nodes
    mobility: float
    per_dt: float  # 1 / time step, 0: steady
    mass_old: Array  # mass of the previous instant
    fluidity: Array  # table of 1 / viscosity
    density: Array  # table
    step: float
    compliance: float
    edge: Array  # ratio of the pressure on an edge node to that of its inner neighbour; zero elsewhere
    weight: Array  # of each node in the load: 1, on the edge also what lies beyond it


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
    imbalance: float  # mass that the film gains or loses unasked in a / u_e, relative, weighted by the load it carries


@njit(cache=True, nogil=True)
def _combine_corrections(p, cap, h, floor, stiff, dz, dp, unit, damping, load):  # type: ignore[no-untyped-def]
    """Damp and bound the corrections, meet the load; dp becomes the next pressure. Returns the rigid gap's change."""
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
    return solids, total, intrusion / (floor * max(total, 1e-300))


class _Iteration:
    """One fixed-point iteration and its scratch arrays."""

    def __init__(self, half_space: HalfSpace, problem: Problem, start: Iterate) -> None:
        self.half_space, self.problem = half_space, problem
        self.p, self.f = start.pressure.copy(), start.fluid.copy()
        self.solid, self.rigid = start.solid.copy(), start.rigid
        shape = self.p.shape
        self.h, self.mass, self.e, self.r, self.dh, self.dp, self.unit = (np.zeros(shape) for _ in range(7))
        self.stiff = np.zeros(shape, np.bool_)
        near = half_space.near
        self.patch = near[0, 0] + 2 * near[0, 1] + 2 * near[1, 0] + 4 * near[1, 1]
        self.patch_wide = 4 * near.sum() - 2 * near[0].sum() - 2 * near[:, 0].sum() + near[0, 0]
        self.share = np.inf

    def film(self) -> None:
        """Gap, contacts, fluid pressure under them and mass balance of the present pressure."""
        q, p, f, solid = self.problem, self.p, self.f, self.solid
        oil = (q.floor, q.mobility, q.fluidity, q.density, q.step)
        deformation = self.half_space.deform(p)
        reynolds.film_pass(p, f, solid, q.undeformed, deformation, self.rigid, *oil, self.h, self.mass, self.e)
        balance = (self.mass, q.mass_old, self.e, q.per_dt, q.spacing)
        reynolds.fluid_under_contacts(p, f, solid, self.h, *balance, _SWEEPS_UNDER_CONTACTS, *oil)
        reynolds.residual(f, solid, *balance, self.r)

    def correct(self, damping: float, renew: bool) -> float:
        """Put the next pressure into `dp`; return the change of the rigid gap. `renew` the lever of the load."""
        q, p, solid, stiff = self.problem, self.p, self.solid, self.stiff
        film = (self.h, self.mass, self.e, self.r, q.floor, q.per_dt, q.spacing)
        reynolds.stiff_zone(p, solid, self.e, q.spacing, q.compliance, stiff)
        reynolds.film_correction(p, q.cap, solid, stiff, *film, self.patch, self.dh)
        dz = self.half_space.press(self.dh)
        if renew:
            self.unit = self.half_space.press(stiff.astype(np.float64))
        self.dp[:] = np.where(stiff, 0.5 * dz, 0.0)
        near = self.half_space.near
        reynolds.pressure_correction(p, self.f, solid, stiff, *film, near, self.patch_wide, _LINE_SWEEPS, self.dp)
        return float(_combine_corrections(p, q.cap, self.h, q.floor, stiff, dz, self.dp, self.unit, damping, q.load))

    def assess(self, n: int, tolerance: float) -> Solution:
        """How good the present pressure is; refers to the scratch arrays, so it holds until the next `film`."""
        q = self.problem
        change = float(_distance(self.dp, self.p)) / q.load
        solids, total, intrusion = _quality(self.p, self.f, q.cap, self.solid, self.h, q.floor)
        imbalance = float(reynolds.imbalance(self.p, self.solid, self.mass, self.r))
        owed = _IMBALANCE_PER_TOLERANCE * tolerance if q.per_dt > 0.0 else _STEADY_IMBALANCE
        share, load_error = solids / q.load, float(total) / q.load - 1.0
        converged = (
            change < tolerance
            and abs(load_error) < _LOAD_TOLERANCE
            and intrusion < _INTRUSION_TOLERANCE
            and imbalance < owed
            and abs(share - self.share) < _SHARE_TOLERANCE
        )
        self.share = share
        iterate = Iterate(self.p, self.f, self.solid, self.rigid)
        return Solution(iterate, self.h, self.mass, converged, n, change, load_error, float(intrusion), imbalance)

    def kept(self, found: Solution) -> Solution:
        """A copy of an assessed solution that outlives the scratch arrays."""
        mass = self.mass.copy()
        if self.problem.per_dt > 0.0:
            # what the film still lacks of its mass balance goes into its history: the next instant makes up for it
            owed = np.where(self.solid | (self.p <= 0.0), 0.0, self.r / self.problem.per_dt)
            mass += np.clip(owed, -0.5 * mass, 0.5 * mass)
        iterate = Iterate(self.p.copy(), self.f.copy(), self.solid.copy(), self.rigid)
        return replace(found, iterate=iterate, gap=self.h.copy(), mass=mass)


def solve_mixed(half_space: HalfSpace, problem: Problem, start: Iterate, tolerance: float, iterations: int) -> Solution:
    """Iterate from `start` until the relative pressure change is below `tolerance` or `iterations` are spent.

    What is not converged is the best of the second half, in the pressure's change. Non-finite values never leave: what
    is returned is finite, or its `change` is infinite.
    """
    it = _Iteration(half_space, problem, start)
    memory = Anderson(it.p.size + 1, _DEPTH)
    weight = float(max(it.p.shape))  # of the rigid gap among the pressures in Anderson's norm
    best: Solution | None = None
    damping, least, n = 1.0, np.inf, 0
    for n in range(1, iterations + 1):
        it.film()
        shift = it.correct(damping, renew=n % 5 == 1)
        found = it.assess(n, tolerance)
        if not np.isfinite(found.change):
            break
        if found.converged:
            return it.kept(found)
        if 2 * n >= iterations and (best is None or found.change < best.change):
            best = it.kept(found)
        if found.change > 0.03 and found.change > 3.0 * least:
            memory.clear()
            damping = max(0.6 * damping, 0.2)
        least = min(least, found.change)
        x = np.append(it.p.ravel(), weight * it.rigid)
        mixed = memory.mix(x, np.append(it.dp.ravel(), weight * (it.rigid + shift)))
        # what an iteration puts at the cap stays there: mixed below it, it would be pushed against its overlap again
        bounded = np.clip(mixed[:-1].reshape(it.p.shape), 0.0, problem.cap)
        it.p = np.where(it.dp >= problem.cap, problem.cap, bounded)
        it.rigid = float(mixed[-1]) / weight
    if best is None:
        return Solution(start, np.zeros_like(it.p), problem.mass_old, False, n, np.inf, np.inf, np.inf, np.inf)
    return replace(best, iterations=n)


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
