"""Mixed lubrication: one fixed point for fluid and solid pressure from full film to dry contact.

Unknowns are the total pressure p, the fluid's share f, the set of solid contacts and the rigid gap. On solid contacts
the gap is the floor and p >= f; elsewhere p = f; 0 <= p <= cap everywhere. An iteration corrects the film residual in
the stiff zone by the inverse of the half space, elsewhere by lines, and satisfies the load exactly. Anderson's method
accelerates it.
"""

from dataclasses import replace

import numpy as np

from ..anderson import Anderson
from ..arrays import Array
from ..compiled import jit
from ..giving_half_space import GivingHalfSpace
from ..half_space import HalfSpace
from . import cavities, corrections, reynolds
from .asperities import share_out
from .cavities import Carried
from .edge import load_beyond, set_edge, wrap
from .flow import Flow
from .problem import Iterate, Problem, Solution, failed
from .stopping_rule import allowed_imbalance, shortfall

_DEPTH = 3  # of Anderson's memory: more does not help where contacts change
_SWEEPS_UNDER_CONTACTS = 6
# part of their correction that nodes in the stiff zone take, and in a march with more sweeps than _SWEEPS, where the
# larger one takes more iterations
_STIFF_STEP, _FINE_STEP, _SWEEPS = 0.4, 0.3, 3
# nodes per unit of length, from which on an iteration of a march takes two more sweeps of the lines, and two more at
# each multiple: a sweep reaches a few nodes, and oil flows as far as on a coarser grid
_NODES_PER_SWEEPS, _MOST_SWEEPS = 30.0, 9
# share of the stiff zone that changes before the lever of the load is computed anew, in steady films and in marches
_RENEW, _RENEW_MARCHING = 0.02, 0.3
_LEAST_PART = 0.1  # of the load, that the balance of a film that conserves its mass counts with
# oil of this part of what asperities carry is none where cavities hold oil: p - s(h) is a small difference there, and
# its sign would decide between a cavity and a full node anew in every iteration
_TRACE = 0.02
_EMPTIEST, _FULLEST = 0.98, 5.0  # mass that a step may take from a node, or add to it, over what it holds
_SHARE_TOLERANCE = 0.02  # nodes at the floor with a fluid pressure of about p change sides for ever, p unchanged


@jit
def _place(field, top, bottom, left, right, out):  # type: ignore[no-untyped-def]
    """Put a part of a field into the corner of another one that is zero elsewhere."""
    out[:] = 0.0
    for j in range(top, bottom):
        for i in range(left, right):
            out[j - top, i - left] = field[j, i]


@jit
def _begin(stiff, pressed, top, left, part, dp):  # type: ignore[no-untyped-def]
    """Set the step dp of the stiff zone: a part of the pressure that corrects its film.

    `pressed` begins at node (top, left).
    """
    ny, nx = dp.shape
    for j in range(ny):
        for i in range(nx):
            dp[j, i] = part * pressed[j - top, i - left] if stiff[j, i] else 0.0


@jit
def _next_pressure(  # type: ignore[no-untyped-def]
    p, cap, dh, stiff, unit, damping, load, edge, weight, wrapped, dp, image
):
    """Damp and bound the corrections dp, satisfy the load; return the change of the rigid gap and sum |image - p|."""
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
    rest += load_beyond(image, weight)
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
        wrap(image)
    return shift, change


@jit
def _bounded(p, image, cap, edge, weight, wrapped):  # type: ignore[no-untyped-def]
    """Keep a mixed pressure within its bounds; return the load.

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
    return total + load_beyond(p, weight)


class Iteration:
    """One fixed-point iteration and its scratch arrays."""

    sweeps = 1  # of the lines, in an iteration
    renew = _RENEW

    def __init__(self, half_space: HalfSpace, problem: Problem, start: Iterate, depth: int, stiff_step: float) -> None:
        self.half_space, self.problem, self.start, self.stiff_step = half_space, problem, start, stiff_step
        shape = start.pressure.shape
        self.memory = Anderson(start.pressure.size + 1, depth)
        self.weight = float(max(shape))  # of the rigid gap among the pressures in Anderson's norm
        self.x = np.append(start.pressure.ravel(), self.weight * start.rigid)
        self.p = self.x[:-1].reshape(shape)
        self.f, self.solid = start.fluid.copy(), start.solid.copy()
        self.h, self.pressing, self.mass, self.r, self.dh, self.dp, self.unit = (np.zeros(shape) for _ in range(7))
        self.flow = Flow.of(problem)
        self.marching = problem.slow_mass is not None
        if self.marching:
            self.renew = _RENEW_MARCHING
            self.sweeps = min(1 + 2 * int(1.0 / (_NODES_PER_SWEEPS * problem.spacing)), _MOST_SWEEPS)
            if self.sweeps > _SWEEPS:
                self.stiff_step = _FINE_STEP
        self.stiff, self.stiff_of_unit = (np.zeros(shape, np.bool_) for _ in range(2))
        self.over_oil, self.lack = np.zeros(shape), np.zeros(shape)
        self.free, self.lines = np.zeros(shape, np.bool_), [np.zeros(shape) for _ in range(7)]
        self.ruled = self.solid.copy() if problem.depth > 0.0 else None
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
        """Rigid gap."""
        return float(self.x[-1]) / self.weight

    def correct(self) -> None:
        """Compute the film of the present iterate; put its image into Anderson's memory."""
        self._film()
        self._press()
        self._relax()
        q, p = self.problem, self.p
        lever = (self.stiff, self.unit, self.damping, q.load, q.edge, q.weight, q.wrapped)
        vector = self.memory.image
        shift, change = _next_pressure(p, q.cap, self.dh, *lever, self.dp, self._pressure_of(vector))
        vector[-1] = self.x[-1] + self.weight * shift
        self.change = change / q.load
        if self.change > 0.03 and self.change > 3.0 * self.least:  # it diverges
            self.memory.clear()
            self.damping = max(0.6 * self.damping, 0.2)
        self.least = min(self.least, self.change)

    def mix(self) -> None:
        """Move to the next iterate."""
        q, image = self.problem, self._pressure_of(self.memory.image)
        self.memory.mix(self.x)
        self.load = _bounded(self.p, image, q.cap, q.edge, q.weight, q.wrapped)

    def _pressure_of(self, vector: Array) -> Array:
        return vector[:-1].reshape(self.p.shape)

    def _film(self) -> None:
        """Compute gap, contacts, fluid pressure under them, mass balance, and the change of gap that corrects it."""
        q, p, f, solid, carried, flow = self.problem, self.p, self.f, self.solid, self.carried, self.flow
        oil = (*q.layer, *q.tables)
        full, flux, first, filling = self.mass, flow.carried, 1, None
        if carried is not None:
            full, flux, first, filling = carried.full, carried.flux, carried.first, carried.filling
            cavities.close_inlet(p, f, solid, q.first)
        bodies = (q.undeformed, self.half_space.deform_padded(p), self.rigid)
        trace = _TRACE if q.conserving else 0.0
        film = (self.h, self.pressing, full, *flow.nodes)
        reynolds.film_pass(p, f, solid, *bodies, *oil, *film, q.lumped, self.ruled, trace)
        flow.measure()
        self._carry(full)
        balance = (self.h, self.mass, q.mass_old, *flow.faces, flux)
        if not q.lumped:
            constants = (*q.terms, _SWEEPS_UNDER_CONTACTS, q.floor, *q.tables)
            if reynolds.fluid_under_contacts(p, f, solid, *balance, *constants, full, *flow.nodes, first, q.wrapped):
                self._carry(full)
        scales = (*q.layer, *q.terms, q.compliance, self.patch)
        out = (self.r, self.stiff, self.dh, self.sums, not self.marching)
        state = (p, f, q.cap, solid, self.h, self.pressing, *balance[1:])
        self.zone = corrections.correct_gap(*state, *scales, self.stiff_of_unit, *out, filling, first)
        if isinstance(self.half_space, GivingHalfSpace):  # the node itself gives way by a part of the change
            self.dh /= 1.0 + self.half_space.give.slope_at(p) / self.patch
        if q.wrapped:
            wrap(solid)

    def _carry(self, full: Array) -> None:
        """Compute what flows through the faces, from properties of the nodes."""
        self.flow.drive(self.f, full, self.problem.mobility, self.problem.thinned)
        if self.carried is not None:
            self.carried.carry(self.f, self.flow, self.mass)

    def _press(self) -> None:
        """Put the pressure that corrects the film of the stiff zone into `dp`; renew the lever of the load."""
        top, bottom, left, right, count, changed = self.zone
        if count == 0:
            self.dp[:] = 0.0
            return
        inverse = self.half_space.press_part(bottom - top, right - left)
        if changed > self.renew * count:
            _place(self.stiff, top, bottom, left, right, inverse.field)
            self.unit[:] = 0.0
            self.unit[top:bottom, left:right] = inverse.run()[: bottom - top, : right - left]
            self.stiff_of_unit[:] = self.stiff
        _place(self.dh, top, bottom, left, right, inverse.field)
        _begin(self.stiff, inverse.run(), top, left, self.stiff_step, self.dp)

    def _relax(self) -> None:
        """Relax the pressure off the stiff zone by lines."""
        q, p, near, faces = self.problem, self.p, self.half_space.near, self.flow.faces
        flows, alone = not self.marching, q.wrapped and q.cap.shape[0] == 3
        layer = (self.over_oil, self.lack)
        filling, first = (None, 1) if self.carried is None else (self.carried.filling, self.carried.first)
        if self.ruled is not None:
            softness = (near[0, 0], self.patch, q.compliance * q.spacing**2)
            share_out(p, self.pressing, self.solid, *faces, q.depth, *softness, self.ruled, *layer)
        film = (p, self.solid, self.stiff, self.h, self.mass, *faces, self.r, q.edge, q.floor, q.depth)
        scales = (*q.terms, near, self.patch_wide, q.lumped, flows)
        out = (self.free, *self.lines)
        corrections.line_factors(*film, *scales, *layer, filling, first, alone, *out)
        lines = (q.depth, q.wedge, q.spacing, near, flows, self.sweeps, self.dp, self.over_oil, alone, q.wrapped)
        corrections.relax_lines(p, self.f, *lines, *out)

    def assess(self, n: int, tolerance: float) -> Solution:
        """Return the present pressure with its convergence.

        It refers to the scratch arrays and holds until the next `correct`.
        """
        q = self.problem
        wrong, film, fluid, solids, complementarity, gained, held = (float(value) for value in self.sums)
        load_error, share = self.load / q.load - 1.0, solids / q.load
        complementarity /= q.floor * q.load
        imbalance = wrong / max(film, 1e-300) * fluid / q.load
        if q.conserving:  # pockets that fill up carry little now, and more later
            imbalance = wrong / max(film, 1e-300) * max(fluid / q.load, _LEAST_PART) + gained / max(held, 1e-300)
        why = shortfall(tolerance, self.change, load_error, complementarity, imbalance, allowed_imbalance(q))
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

    def _missing_mass(self) -> Array:
        """Return the mass that nodes have taken in by their balance and do not hold, contacts and cavities included.

        An iteration stops before the oil between asperities is in balance, and what is out of balance there has mostly
        one sign. Left out, it would add up from step to step: the film would depend on their number. A node whose oil
        has no pressure holds what its balance leaves it.
        """
        q, missing, nowhere = self.problem, np.zeros_like(self.r), np.zeros_like(self.solid)
        if q.lumped or (self.carried is not None and not (q.conserving or self.marching)):
            return np.where(self.solid | (self.p <= 0.0), 0.0, self.r)
        balance = (self.mass, q.mass_old, *self.flow.faces)
        if self.carried is not None:
            cavities_and_inlet = self.carried.filling, self.carried.first
            reynolds.residual(self.f, nowhere, *balance, self.carried.flux, *q.terms, missing, *cavities_and_inlet)
            return missing
        reynolds.residual(self.f, nowhere, *balance, self.flow.carried, *q.terms, missing, None, 1)
        return missing if self.marching else np.where(self.p <= 0.0, 0.0, missing)

    def kept(self, found: Solution) -> Solution:
        """Return a copy of an assessed solution that is independent of the scratch arrays."""
        q, mass = self.problem, self.mass.copy()
        if q.per_dt > 0.0:
            # the residual of the mass balance goes into the history of the film: the next instant corrects it
            missing, most = self._missing_mass() / q.per_dt, _EMPTIEST * mass
            if self.marching and q.supply is not None:  # it may be far thinner than the gap that it moves through
                most = np.maximum(most, mass - np.maximum(q.mass_old, 0.0))
            mass += np.clip(missing, -most, _FULLEST * mass)
            if q.wrapped:
                wrap(mass)
        fluid = np.where(self.solid, 0.0, self.f) if q.lumped else self.f.copy()
        iterate = Iterate(self.p.copy(), fluid, self.solid.copy(), self.rigid)
        return replace(found, iterate=iterate, gap=self.h.copy(), mass=mass)


def solve_mixed(half_space: HalfSpace, problem: Problem, start: Iterate, tolerance: float, iterations: int) -> Solution:
    """Iterate from `start` until the stopping rule holds at `tolerance` or `iterations` are used up.

    Without convergence the result is the one of least pressure change in the last quarter. It is finite, or its
    `pressure_change` is infinite.
    """
    it = Iteration(half_space, problem, start, _DEPTH, _STIFF_STEP)
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
