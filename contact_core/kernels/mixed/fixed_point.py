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

from ..anderson import Anderson
from ..convergence import SolverConvergence
from ..half_space import HalfSpace
from . import cavities, reynolds

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_jit = njit(cache=True, nogil=True, error_model="numpy")

_DEPTH = 3  # of Anderson's memory: deeper does not help where contacts come and go
_SWEEPS_UNDER_CONTACTS = 6
_LINE_SWEEPS = 1
_STIFF_STEP = 0.4  # part of their correction that nodes in the stiff zone take
_RENEW = 0.02  # share of the stiff zone that changes before the lever of the load is computed anew
_CARRIED = 0.3  # pressure of smooth bodies above which the pattern of the rough ones moves along with them
_LOAD_TOLERANCE = 1e-4
_COMPLEMENTARITY_TOLERANCE = 0.2
_IMBALANCE_PER_TOLERANCE = 100.0  # what a time step still owes is made up for in the next one...
_STEADY_IMBALANCE_PER_TOLERANCE = 5.0  # ...but a steady film has no next one,
_OWED_PER_STEP = 6.0  # and a long step must not lose much of its film
_LEAST_PART = 0.1  # of the load, that the balance of a film that conserves its mass counts with
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
    mobility: Array  # pressure flow of a unit's gap, gradient and fluidity
    thinned: Array  # what shear adds to the fluidity
    per_dt: float  # 1 / time step, 0: steady
    wedge: float  # entrainment speed: 1, less where that would be too slow a unit for the time step
    mass_old: Array  # mass of the previous instant
    fluidity: Array  # table of 1 / viscosity
    density: Array  # table
    step: float
    compliance: float
    edge: Array  # ratio of the pressure on an edge node to that of its inner neighbour; zero elsewhere
    weight: Array  # of each node in the load: 1, on the edge also what lies beyond it
    lumped: bool = False  # one pressure for fluid and solids, as in the unified Reynolds equation: f = p everywhere
    # periodic along y: the first and the last row are images of the last and the first but one; edge and weight 0 there
    wrapped: bool = False
    conserving: bool = False  # cavities hold the oil that flows into them; else they count as full
    supply: float | Array | None = None  # conserving: mass [ny] that enters, None: as much as the first column can take
    first: int = 0  # first column in which oil has pressure; upstream of it none presses

    @property
    def by_flux(self) -> bool:
        """Whether the film is balanced by its flow through faces, as cavities and an inlet meniscus need it."""
        return self.conserving or self.first > 1


class Carried:
    """Oil of a film that cavities and an inlet meniscus leave not full: `cavities.carry` and its scratch arrays."""

    def __init__(self, problem: Problem) -> None:
        self.problem, shape = problem, problem.cap.shape
        self.full, self.flux, self.filling = np.zeros(shape), np.zeros(shape), np.ones(shape)
        supply = np.inf if problem.supply is None else problem.supply
        self.supply: Array = np.broadcast_to(np.asarray(supply, np.float64), shape[:1]).copy()
        self.first = max(problem.first, 1)

    def carry(self, f: Array, e: Array, mass: Array) -> None:
        """Mass of every node, and the flow between them, of a fluid pressure and what full nodes hold."""
        q = self.problem
        inlet = (q.conserving, self.supply, self.first)
        cavities.carry(f, self.full, q.mass_old, e, q.per_dt, q.wedge, q.spacing, *inlet, mass, self.flux, self.filling)
        if q.wrapped:
            for field in (mass, self.flux, self.filling):
                reynolds.wrap(field)


@dataclass(frozen=True)
class Iterate:
    """Where an iteration starts from and what it ends with. Arrays [ny, nx]."""

    pressure: Array
    fluid: Array
    solid: Mask
    rigid: float


@dataclass(frozen=True)
class Solution(SolverConvergence):
    """The end of an iteration and how good it is."""

    iterate: Iterate
    gap: Array  # may be below the floor where the pressure is capped: what is missing yields plastically
    mass: Array


def shortfall(
    tolerance: float, change: float, load_error: float, complementarity: float, imbalance: float, per_dt: float
) -> str:
    """The stopping rule of every film: what is short of it, in words, or nothing. `per_dt`: 1 / time step or 0."""
    rules = _rules(tolerance, change, load_error, complementarity, imbalance, per_dt)
    return "; ".join(f"{name} {value:.2g}, not below {most:.2g}" for name, value, most in rules if not value < most)


def excess(found: Solution, tolerance: float, per_dt: float) -> float:
    """How many times the stopping rule's worst number is above its limit."""
    numbers = (found.pressure_change, found.load_error, found.complementarity, found.imbalance)
    return max(value / most for _, value, most in _rules(tolerance, *numbers, per_dt))


def _rules(
    tolerance: float, change: float, load_error: float, complementarity: float, imbalance: float, per_dt: float
) -> tuple[tuple[str, float, float], ...]:
    least = _STEADY_IMBALANCE_PER_TOLERANCE
    owed = tolerance * min(max(_OWED_PER_STEP * per_dt, least), _IMBALANCE_PER_TOLERANCE)
    return (
        ("pressure change", change, tolerance),
        ("load error", abs(load_error), _LOAD_TOLERANCE),
        ("distance of contacts from the floor", complementarity, _COMPLEMENTARITY_TOLERANCE),
        ("mass imbalance", imbalance, owed),
    )


@_jit
def _place(field, top, bottom, left, right, out):  # type: ignore[no-untyped-def]
    """Put a part of a field into the corner of another one that is zero elsewhere."""
    out[:] = 0.0
    for j in range(top, bottom):
        for i in range(left, right):
            out[j - top, i - left] = field[j, i]


@_jit
def _begin(stiff, pressed, top, left, part, dp):  # type: ignore[no-untyped-def]
    """Step dp of the stiff zone, a part of the pressure that mends its film; `pressed` begins at node (top, left)."""
    ny, nx = dp.shape
    for j in range(ny):
        for i in range(nx):
            dp[j, i] = part * pressed[j - top, i - left] if stiff[j, i] else 0.0


@_jit
def set_edge(p, edge, wrapped):  # type: ignore[no-untyped-def]
    """Edge nodes follow their inner neighbours, or what they are images of."""
    ny, nx = p.shape
    for j in range(ny):
        p[j, 0] = edge[j, 0] * p[j, 1]
        p[j, nx - 1] = edge[j, nx - 1] * p[j, nx - 2]
    if wrapped:
        reynolds.wrap(p)
        return
    for i in range(nx):
        p[0, i] = edge[0, i] * p[1, i]
        p[ny - 1, i] = edge[ny - 1, i] * p[ny - 2, i]


@_jit
def _load_beyond(p, weight):  # type: ignore[no-untyped-def]
    """Load of the edge nodes and of what lies beyond them."""
    ny, nx = p.shape
    total = 0.0
    for j in range(1, ny - 1):
        total += weight[j, 0] * p[j, 0] + weight[j, nx - 1] * p[j, nx - 1]
    for i in range(nx):
        total += weight[0, i] * p[0, i] + weight[ny - 1, i] * p[ny - 1, i]
    return total


@_jit
def _next_pressure(  # type: ignore[no-untyped-def]
    p, cap, dh, stiff, unit, damping, load, edge, weight, wrapped, dp, image
):
    """Damp and bound the corrections dp, meet the load. Returns the rigid gap's change and sum |image - p|."""
    ny, nx = p.shape
    size = 0.0
    for j in range(1, ny - 1):
        for i in range(1, nx - 1):
            step, here = dp[j, i], p[j, i]
            if stiff[j, i] and here >= cap[j, i] and dh[j, i] >= 0.0:
                stiff[j, i] = False  # the solids yield to it: it stays at the cap until its gap opens too far
                step = 0.0
            bound = 0.2 + 0.5 * here
            step = min(max(step, -bound), bound)
            dp[j, i] = step
            size += abs(step)
    factor = min(damping, 0.1 * load / max(size, 1e-300))
    nodes, count, rest, change = np.empty(p.size, np.int64), 0, 0.0, 0.0
    for j in range(1, ny - 1):
        for i in range(1, nx - 1):
            value = p[j, i] + factor * dp[j, i]
            if stiff[j, i]:
                nodes[count] = j * nx + i
                count += 1
            else:
                value = min(max(value, 0.0), cap[j, i])
                rest += value
                change += abs(value - p[j, i])
            image[j, i] = value
    set_edge(image, edge, wrapped)
    rest += _load_beyond(image, weight)
    values, caps, units, old = image.ravel(), cap.ravel(), unit.ravel(), p.ravel()
    shift = 0.0
    for _ in range(4):  # nodes at a bound cannot take their part
        total, lever = rest, 0.0
        for n in range(count):
            k = nodes[n]
            value = values[k] - shift * units[k]
            total += min(max(value, 0.0), caps[k])
            if 0.0 < value < caps[k]:
                lever += units[k]
        if abs(total - load) <= 1e-10 * load or lever <= 1e-3 * load:
            break
        shift += (total - load) / lever
    for n in range(count):
        k = nodes[n]
        values[k] = min(max(values[k] - shift * units[k], 0.0), caps[k])
        change += abs(values[k] - old[k])
    if wrapped:
        reynolds.wrap(image)
    return shift, change


@_jit
def _bounded(p, image, cap, edge, weight, wrapped):  # type: ignore[no-untyped-def]
    """Keep a mixed pressure within its bounds; returns the load.

    What the image has at the cap stays there: mixed below it, it would be pushed against its overlap again.
    """
    ny, nx = p.shape
    total = 0.0
    for j in range(1, ny - 1):
        for i in range(1, nx - 1):
            value = cap[j, i] if image[j, i] >= cap[j, i] else min(max(p[j, i], 0.0), cap[j, i])
            p[j, i] = value
            total += value
    set_edge(p, edge, wrapped)
    return total + _load_beyond(p, weight)


class Iteration:
    """One fixed-point iteration and its scratch arrays."""

    def __init__(self, half_space: HalfSpace, problem: Problem, start: Iterate, depth: int, stiff_step: float) -> None:
        self.half_space, self.problem, self.start, self.stiff_step = half_space, problem, start, stiff_step
        shape = start.pressure.shape
        self.memory = Anderson(start.pressure.size + 1, depth)
        self.weight = float(max(shape))  # of the rigid gap among the pressures in Anderson's norm
        self.x = np.append(start.pressure.ravel(), self.weight * start.rigid)
        self.p = self.x[:-1].reshape(shape)
        self.f, self.solid = start.fluid.copy(), start.solid.copy()
        self.h, self.mass, self.e, self.r, self.dh, self.dp, self.unit = (np.zeros(shape) for _ in range(7))
        self.stiff, self.stiff_of_unit = (np.zeros(shape, np.bool_) for _ in range(2))
        self.sums = np.zeros(7)
        self.carried = Carried(problem) if problem.by_flux else None
        near = half_space.near
        self.patch = near[0, 0] + 2 * near[0, 1] + 2 * near[1, 0] + 4 * near[1, 1]
        self.patch_wide = 4 * near.sum() - 2 * near[0].sum() - 2 * near[:, 0].sum() + near[0, 0]
        self.share = self.change = self.least = np.inf
        self.damping = 1.0
        self.rows = slice(1, -1) if problem.wrapped else slice(None)  # that are no images
        self.load = _bounded(self.p, self.p, problem.cap, problem.edge, problem.weight, problem.wrapped)

    @property
    def rigid(self) -> float:
        """The rigid gap."""
        return float(self.x[-1]) / self.weight

    def correct(self) -> None:
        """Film of the present iterate; its image goes into Anderson's memory."""
        self._film()
        self._press()
        q, p = self.problem, self.p
        film = (self.h, self.mass, self.e, self.r, q.edge, q.floor, q.per_dt, q.wedge, q.spacing)
        near = (self.half_space.near, self.patch_wide)
        inlet = (None, 1) if self.carried is None else (self.carried.filling, self.carried.first)
        relaxation = (q.lumped, _LINE_SWEEPS, self.dp, *inlet, q.wrapped)
        reynolds.relax_lines(p, self.solid, self.stiff, *film, *near, *relaxation)
        lever = (self.stiff, self.unit, self.damping, q.load, q.edge, q.weight, q.wrapped)
        vector = self.memory.image
        shift, change = _next_pressure(p, q.cap, self.dh, *lever, self.dp, self._pressure_of(vector))
        vector[-1] = self.x[-1] + self.weight * shift
        self.change = change / q.load
        if self.change > 0.03 and self.change > 3.0 * self.least:  # it runs away
            self.memory.clear()
            self.damping = max(0.6 * self.damping, 0.2)
        self.least = min(self.least, self.change)

    def mix(self) -> None:
        """The next iterate."""
        q, image = self.problem, self._pressure_of(self.memory.image)
        self.memory.mix(self.x)
        self.load = _bounded(self.p, image, q.cap, q.edge, q.weight, q.wrapped)

    def _pressure_of(self, vector: Array) -> Array:
        return vector[:-1].reshape(self.p.shape)

    def _film(self) -> None:
        """Gap, contacts, fluid pressure under them, mass balance, and the change of the gap that mends it."""
        q, p, f, solid, carried = self.problem, self.p, self.f, self.solid, self.carried
        oil = (q.floor, q.mobility, q.thinned, q.fluidity, q.density, q.step)
        full = self.mass
        flow: tuple[Any, int] = (None, 1)
        inlet: tuple[Any, ...] = ()
        if carried is not None:
            full, flow = carried.full, (carried.flux, carried.first)
            inlet = (carried.flux, carried.filling, carried.first)
            cavities.close_inlet(p, f, solid, q.first)
        gap = (q.undeformed, self.half_space.deform_padded(p), self.rigid)
        reynolds.film_pass(p, f, solid, *gap, *oil, self.h, full, self.e, q.lumped)
        if carried is not None:
            carried.carry(f, self.e, self.mass)
        if not q.lumped:
            constants = (q.per_dt, q.wedge, q.spacing, _SWEEPS_UNDER_CONTACTS)
            film = (self.h, self.mass, q.mass_old, self.e)
            reynolds.fluid_under_contacts(p, f, solid, *film, *constants, *oil, full, *flow, q.wrapped)
            if carried is not None:
                carried.carry(f, self.e, self.mass)
        balance = (self.h, self.mass, q.mass_old, self.e)
        scales = (q.floor, q.per_dt, q.wedge, q.spacing, q.compliance, self.patch)
        out = (self.r, self.stiff, self.dh, self.sums)
        self.zone = reynolds.mend_film(p, f, q.cap, solid, *balance, *scales, self.stiff_of_unit, *out, *inlet)
        if q.wrapped:
            reynolds.wrap(solid)

    def _press(self) -> None:
        """Pressure that mends the film of the stiff zone into `dp`, and the lever of the load."""
        top, bottom, left, right, count, changed = self.zone
        if count == 0:
            self.dp[:] = 0.0
            return
        inverse = self.half_space.press_part(bottom - top, right - left)
        if changed > _RENEW * count:
            _place(self.stiff, top, bottom, left, right, inverse.field)
            self.unit[:] = 0.0
            self.unit[top:bottom, left:right] = inverse.run()[: bottom - top, : right - left]
            self.stiff_of_unit[:] = self.stiff
        _place(self.dh, top, bottom, left, right, inverse.field)
        _begin(self.stiff, inverse.run(), top, left, self.stiff_step, self.dp)

    def assess(self, n: int, tolerance: float) -> Solution:
        """How good the present pressure is; refers to the scratch arrays, so it holds until the next `correct`."""
        q = self.problem
        wrong, film, fluid, solids, complementarity, gained, held = (float(value) for value in self.sums)
        load_error, share = self.load / q.load - 1.0, solids / q.load
        complementarity /= q.floor * q.load
        imbalance = wrong / max(film, 1e-300) * fluid / q.load
        if q.conserving:  # pockets that still fill up carry little yet, but will
            imbalance = wrong / max(film, 1e-300) * max(fluid / q.load, _LEAST_PART) + gained / max(held, 1e-300)
        why = shortfall(tolerance, self.change, load_error, complementarity, imbalance, q.per_dt)
        if abs(share - self.share) >= _SHARE_TOLERANCE:
            why = "; ".join(filter(None, (why, "the share of the solids still changes")))
        self.share = share
        iterate = Iterate(self.p, self.f, self.solid, self.rigid)
        return Solution(
            iterate,
            self.h,
            self.mass,
            converged=not why,
            shortfall=why,
            iterations=n,
            pressure_change=self.change,
            load_error=load_error,
            complementarity=complementarity,
            imbalance=imbalance,
        )

    def _owed(self) -> Array:
        """Mass that nodes have taken in by their balance and do not hold."""
        if not self.problem.conserving:
            return np.where(self.solid | (self.p <= 0.0), 0.0, self.r)
        q, carried, owed, nowhere = self.problem, self.carried, np.zeros_like(self.r), np.zeros_like(self.solid)
        assert carried is not None
        balance = (self.mass, q.mass_old, self.e, q.per_dt, q.wedge, q.spacing)
        reynolds.residual(self.f, nowhere, *balance, owed, carried.flux, carried.filling, carried.first)
        return owed

    def kept(self, found: Solution) -> Solution:
        """A copy of an assessed solution that outlives the scratch arrays."""
        mass = self.mass.copy()
        if self.problem.per_dt > 0.0:
            # what the film still lacks of its mass balance goes into its history: the next instant makes up for it
            owed = self._owed() / self.problem.per_dt
            mass += np.clip(owed, -0.5 * mass, 0.5 * mass)
            if self.problem.wrapped:
                reynolds.wrap(mass)
        fluid = np.where(self.solid, 0.0, self.f) if self.problem.lumped else self.f.copy()
        iterate = Iterate(self.p.copy(), fluid, self.solid.copy(), self.rigid)
        return replace(found, iterate=iterate, gap=self.h.copy(), mass=mass)


def solve_mixed(half_space: HalfSpace, problem: Problem, start: Iterate, tolerance: float, iterations: int) -> Solution:
    """Iterate from `start` until the relative pressure change is below `tolerance` or `iterations` are spent.

    What is not converged is the best of the last quarter, in the pressure's change. Non-finite values never leave: what
    is returned is finite, or its `pressure_change` is infinite.
    """
    return iterate_on(Iteration(half_space, problem, start, _DEPTH, _STIFF_STEP), tolerance, iterations)


def iterate_on(it: Iteration, tolerance: float, iterations: int) -> Solution:
    """Iterate until the stopping rule holds or `iterations` are spent."""
    problem = it.problem
    best: Solution | None = None
    n = 0
    for n in range(1, iterations + 1):
        it.correct()
        found = it.assess(n, tolerance)
        if not np.isfinite(found.pressure_change):
            break
        if found.converged:
            return it.kept(found)
        if 4 * n >= 3 * iterations and (best is None or found.pressure_change < best.pressure_change):
            best = it.kept(found)
        it.mix()
    if best is None:
        return failed(it.start, np.zeros_like(problem.cap), problem.mass_old, n, "no finite solution")
    return replace(best, iterations=n)


def failed(start: Iterate, gap: Array, mass: Array, iterations: int, why: str) -> Solution:
    """Return the start of an iteration that found nothing, with infinite errors."""
    return Solution(
        start,
        gap,
        mass,
        converged=False,
        shortfall=why,
        iterations=iterations,
        pressure_change=np.inf,
        load_error=np.inf,
        complementarity=np.inf,
        imbalance=np.inf,
    )


def advected(start: Iterate, smooth: Array, nodes: int) -> Iterate:
    """Predict the iterate after the rough surface has moved by `nodes` along +x: its pressure pattern moves along.

    smooth [ny, nx] is the pressure of the smooth bodies; where it is high, the ratio to it is what moves.
    """
    if nodes == 0:
        return start
    pressure, fluid, solid = start.pressure.copy(), start.pressure.copy(), start.solid.copy()
    _advect(start.pressure, start.fluid, start.solid, smooth, nodes, pressure, fluid, solid)
    return Iterate(pressure, fluid, solid, start.rigid)


@_jit
def _advect(p_old, f_old, solid_old, smooth, nodes, p, f, solid):  # type: ignore[no-untyped-def]
    ny, nx = p.shape
    for j in range(ny):
        for i in range(nx):
            k = i - nodes if 0 <= i - nodes < nx and smooth[j, i] > _CARRIED < smooth[j, i - nodes] else i
            p[j, i] = p_old[j, k] * (smooth[j, i] / smooth[j, k] if k != i else 1.0)
            solid[j, i] = solid_old[j, k]
            f[j, i] = p[j, i] * (f_old[j, k] / p_old[j, k] if solid[j, i] and p_old[j, k] > 0.0 else 1.0)
