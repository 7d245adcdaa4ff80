"""Semi-smooth Newton method for steady or transient films, from the rigid, flooded ball to a few rough contacts.

Unknowns are the total pressure of every node and the rigid gap. Equations are those of `fixed_point`: no net inflow
where fluid carries the load (p > 0), the gap at the floor on solid contacts, the load. Sets (cavity, contacts, cap) are
guessed anew in every step. A step solves the linear system by GMRES with the full elastic coupling (FFT), in which the
change of the net inflow is a difference of two flows (Knoll & Keyes, J. Comput. Phys. 193 (2004) 357,
doi:10.1016/j.jcp.2003.08.010). It is preconditioned by a sparse LU of the local part: Reynolds' equation and a 3 x 3
patch of the deformation, bordered by rigid gap and load. A contact of one row, repeated for ever, has a band instead
(`band`).

Where cavities hold oil, or an inlet meniscus keeps nodes from pressing, masses and flows are those of `cavities`: a
node that is full and gains mass joins those with pressure, one whose pressure falls to zero becomes a cavity.

Source of the active sets: Hintermueller, Ito & Kunisch, SIAM J. Optim. 13 (2003) 865, doi:10.1137/S1052623401383558.
"""

from collections.abc import Callable

import numpy as np
import scipy

from ..arrays import Array, Indices, Mask
from ..compiled import jit
from ..half_space import HalfSpace
from . import cavities, linearisation, reynolds
from .asperities import REACH, sort_nodes
from .band import band_inverse
from .cavities import Carried
from .edge import set_edge, wrap
from .flow import Flow, node_pass
from .linear_solver import elimination_order, gmres
from .problem import Iterate, Problem, Solution, failed
from .stopping_rule import allowed_imbalance, shortfall

_SWEEPS_UNDER_CONTACTS = 6
_SWEEPS_AT_CAVITY = 30
_LIGHT = 1e-2  # share of the largest pressure below which the cavity's edge is sought
_FALL = 0.75  # rms relative fall of the film in a step, weighted by pressure
_FELT = 0.05  # share of the pressure on asperities above which they limit a step
_RISE = (2.0, 1.0)  # largest rise of a fluid pressure in a step, and by how much more if it is high already
_TOUCH = 0.95  # gap in floors below which a node becomes solid
_TRIAL = 1e-6  # largest relative change of a gap, or change of a pressure, of a difference of flows
_RELEASES = 1  # a contact that returns after so many releases stays: some would change for ever
# from this step on, if the pressure has last changed by less, nodes that asperities have held and let go twice of late
# take half of a correction: else some would be held and let go in turn for ever, each time with its neighbours
_CALM_FROM, _NEAR = 6, 0.05
_KEPT = 0.8  # weight of a turn in the next step
_LEAST_SCALE = 1e-3  # rise of the inflow by the own pressure, over that of the oil that moves with the gap


@jit
def _seek_cavity(  # type: ignore[no-untyped-def]
    f, p, solid, ex, ey, flux, mass, mass_old, per_dt, wedge, dx, rigid, light, sweeps, wrapped
):
    """Relax light pressures on a given film by projected over-relaxation.

    This moves the edge of the cavity by many nodes, where a Newton step frees one row.
    """
    ny, nx = f.shape
    per_dx2 = 1.0 / (dx * dx)
    for sweep in range(sweeps):
        for row in range(1, ny - 1):
            j = row if sweep % 2 == 0 else ny - 1 - row
            for node in range(1, nx - 1):
                i = node if sweep % 2 == 0 else nx - 1 - node
                if solid[j, i] or f[j, i] > light:
                    continue
                west, east = per_dx2 * ex[j, i - 1], per_dx2 * ex[j, i]
                south, north = per_dx2 * ey[j - 1, i], per_dx2 * ey[j, i]
                total = west + east + south + north
                inflow = west * f[j, i - 1] + east * f[j, i + 1] + south * f[j - 1, i] + north * f[j + 1, i]
                if total < rigid or (f[j, i] <= 0.0 and inflow <= 0.0):
                    continue
                value = (inflow - reynolds.transport(mass, flux, mass_old, per_dt, wedge, dx, j, i)) / total
                f[j, i] = min(max(f[j, i] + 1.6 * (value - f[j, i]), 0.0), light)
                p[j, i] = f[j, i]
        if wrapped:
            wrap(f)


def _inner_weight(weight: Array, edge: Array) -> Array:
    """Return the weight of the inner nodes in the load, including the edge nodes that follow them."""
    w = weight.copy()
    w[1] += edge[0] * w[0]
    w[-2] += edge[-1] * w[-1]
    w[:, 1] += edge[:, 0] * w[:, 0]
    w[:, -2] += edge[:, -1] * w[:, -1]
    return w


class _Trial:
    """Change of the net inflow with fluid pressure and gap, as the difference of two flows."""

    def __init__(self, problem: Problem) -> None:
        self.problem, shape = problem, problem.cap.shape
        self.flow = Flow.of(problem)
        self.carried = Carried(problem) if problem.by_flux else None
        self.full, self.mass, self.f, self.base, self.r = (np.zeros(shape) for _ in range(5))

    def start(self, f: Array, solid: Mask, h: Array, gap: Array, r: Array) -> None:
        """Take the film around which changes are sought, with its net inflow."""
        self.at, self.solid, self.gap, self.base = f, solid, gap, r
        self.fixed = solid | (h <= self.problem.floor)

    def change(self, df: Array, dh: Array) -> Array:
        """Return the change of the net inflow [ny, nx] with those of fluid pressure and gap, in full nodes."""
        q, flow, carried = self.problem, self.flow, self.carried
        largest = max(float(np.abs(df).max()), float((np.abs(dh) / self.gap).max()), 1e-300)
        part = _TRIAL / largest
        full = self.full if carried is None else carried.full
        node_pass(self.at, self.gap, self.fixed, df, dh, part, q.floor, *q.tables, self.f, full, *flow.nodes)
        flow.measure()
        flow.drive(self.f, full, q.mobility, q.thinned)
        mass, flux, filling, first = full, flow.carried, None, 1
        if carried is not None:
            mass, flux, filling, first = self.mass, carried.flux, carried.filling, carried.first
            carried.carry(self.f, flow, mass)
        balance = (mass, q.mass_old, *flow.faces, flux, *q.terms)
        reynolds.residual(self.f, self.solid, *balance, self.r, filling, first)
        return (self.r - self.base) / part


class _Film:
    """Present iterate, its film and its linearisation."""

    def __init__(self, half_space: HalfSpace, problem: Problem, start: Iterate) -> None:
        self.half_space, self.problem = half_space, problem
        self.carried = Carried(problem) if problem.by_flux else None
        self.p, self.f = np.clip(start.pressure, 0.0, problem.cap), start.fluid.copy()
        self.solid, self.rigid = start.solid.copy(), start.rigid
        set_edge(self.p, problem.edge, problem.wrapped)
        shape = self.p.shape
        self.h, self.pressing, self.mass, self.r, self.scale = (np.zeros(shape) for _ in range(5))
        self.slope, self.by_f, self.by_h = np.zeros((2, *shape)), np.zeros((6, *shape)), np.zeros((6, *shape))
        self.held: Mask = np.zeros(shape, np.bool_)
        self.rest, self.give, self.gain, self.lack = (np.zeros(shape) for _ in range(4))
        self.flow, self.trial = Flow.of(problem), _Trial(problem)
        self.inner_weight = _inner_weight(problem.weight, problem.edge)
        self.order = elimination_order(*shape, problem.wrapped)
        self.rows = slice(1, -1) if problem.wrapped else slice(None)  # that are no images
        self.inner = np.zeros(shape, np.bool_)
        self.inner[1:-1, 1:-1] = True
        self.releases, self.turns = np.zeros(shape, np.int64), np.zeros(shape)
        self.response: Array | None = None  # of a single row, by distance
        if problem.wrapped and shape[0] == 3:
            unit = np.zeros(shape)
            unit[:, 0] = 1.0
            self.response = half_space.respond(np.zeros(shape), unit)[1]
        near = half_space.near
        apart_j, apart_i = (np.abs(d[:, None] - d[None, :6]) for d in (linearisation.DJ, linearisation.DI))
        self.patch = np.where((apart_j < 2) & (apart_i < 2), near[np.minimum(apart_j, 1), np.minimum(apart_i, 1)], 0.0)

    def evaluate(self) -> None:
        """Compute gap, contacts, fluid pressure under them, cavity edge and mass balance of the present pressure."""
        q, before, old, held = self.problem, self.solid.copy(), self.p.copy(), self.held.copy()
        self._pass()
        if self.carried is None:
            rigid = 30.0 * self.half_space.near[0, 0] / q.spacing  # there light pressures do not change the gap
            balance = (*self.flow.faces, self.flow.carried, self.mass, q.mass_old, *q.terms)
            light = _LIGHT * self.p.max()
            pressed = self.solid | (self.h < q.floor + REACH * q.depth) if q.depth > 0.0 else self.solid
            _seek_cavity(self.f, self.p, pressed, *balance, rigid, light, _SWEEPS_AT_CAVITY, q.wrapped)
            set_edge(self.p, q.edge, q.wrapped)
            self._pass()
        self.sought = float(np.abs(self.p - old)[self.rows].sum())
        self._residual(self.solid, self.r)
        self.releases += before & ~self.solid
        sorted_into = self.held, self.rest, self.give, self.gain, self.lack
        sort_nodes(self.p, self.f, self.r, self.h, self.solid, *q.layer, *sorted_into)
        self.turns = _KEPT * self.turns + (self.held != held)

    def _residual(self, solid: Mask, out: Array) -> None:
        """Compute the net inflow of every node that is full and not `solid`."""
        q, carried = self.problem, self.carried
        flux = self.flow.carried if carried is None else carried.flux
        filling = (None, 1) if carried is None else (carried.filling, carried.first)
        reynolds.residual(self.f, solid, self.mass, q.mass_old, *self.flow.faces, flux, *q.terms, out, *filling)

    def _pass(self) -> None:
        q, p, f, solid, flow = self.problem, self.p, self.f, self.solid, self.flow
        oil = (*q.layer, *q.tables)
        deformation, room = self.half_space.deform(p), p
        gap = self.rigid + q.undeformed + deformation
        solid |= self.inner & (gap < _TOUCH * q.floor)
        if q.depth > 0.0:  # solids themselves touch where asperities carry all they can
            room = np.maximum(p - q.stress, 0.0)
            solid &= (gap <= q.floor) & (room > 0.0)
        if q.wrapped:
            wrap(solid)
        full, flux, first = self.mass, flow.carried, 1
        if (carried := self.carried) is not None:
            full, flux, first = carried.full, carried.flux, carried.first
            cavities.close_inlet(p, f, solid, q.first)
        bodies = (q.undeformed, deformation, self.rigid)
        film = (self.h, self.pressing, full, *flow.nodes)
        reynolds.film_pass(p, f, solid, *bodies, *oil, *film, False, None, 0.0)
        solid &= self.inner & (room > 0.0) if q.depth > 0.0 else self.inner  # the edge does not touch
        if q.wrapped:
            wrap(solid)
        settled = solid & (self.releases >= _RELEASES)
        flow.measure()
        self._carry(full)
        balance = (self.h, self.mass, q.mass_old, *flow.faces, flux, *q.terms, _SWEEPS_UNDER_CONTACTS)
        inner = (q.floor, *q.tables, full, *flow.nodes, first, q.wrapped)
        if reynolds.fluid_under_contacts(room, f, solid, *balance, *inner):
            self._carry(full)
        solid |= settled

    def _carry(self, full: Array) -> None:
        """Compute what flows through the faces, from properties of the nodes."""
        self.flow.drive(self.f, full, self.problem.mobility, self.problem.thinned)
        if self.carried is not None:
            self.carried.carry(self.f, self.flow, self.mass)

    def correction(self) -> tuple[Array, Array, float] | None:
        """Return Newton's changes of pressure, gap [ny, nx] and rigid gap; None if there are none."""
        q, solid, held, near = self.problem, self.solid, self.held, self.half_space.near
        rest, give, gain, lack = self.rest, self.give, self.gain, self.lack
        by_f, by_h, scale, flow = self.by_f, self.by_h, self.scale, self.flow
        linearisation.slopes(self.f, solid, self.h, q.floor, q.step, q.density, self.slope)
        wedge = q.wedge if flow.slow is None else 0.0  # what M carries does not depend on the mass of now
        film = (self.f, flow.gap, flow.fluid, q.thinned, *flow.faces, flow.share, q.fitted)
        terms = (q.per_dt, wedge, q.spacing, self.slope)
        filling, first = (None, 1) if self.carried is None else (self.carried.filling, self.carried.first)
        linearisation.linearise(*film, *terms, first, filling, by_f, by_h)
        linearisation.follow_gap(by_f, gain, by_h)
        yields = held & (self.p >= q.cap) & (self.h < rest)
        wet = ((self.f > 0.0) | (self.r > 0.0)) & ~((self.p >= q.cap) & (self.r >= 0.0))
        nodes = self.order[np.where(held, ~yields, wet).ravel()[self.order]]
        size, shape = nodes.size, solid.shape
        if size == 0:
            return None
        own = -(by_f[0] + by_h[0] * near[0, 0] + by_h[1] * near[0, 1])
        # what a node loses may not depend on its own gap: then the oil that moves with it gives the scale
        least = _LEAST_SCALE * near[0, 0] * (q.wedge / q.spacing + q.per_dt) + 1e-300
        scale[:] = np.where(held, -1.0 / (near[0, 0] + give), 1.0 / np.maximum(own, least - by_f[0]))
        inverse = self._local_inverse(nodes)
        if inverse is None:
            return None

        self.trial.start(self.f, solid, self.h, flow.gap, self.r)
        own_scale = scale.ravel()[nodes]  # of the others, which may have no flow at all, nothing is used

        def product(dp: Array, dh: Array, out: Array) -> None:
            change = self.trial.change(np.where(held, 0.0, dp + gain * dh), dh)
            out[:] = np.where(held, dh + give * dp, change).ravel()[nodes] * own_scale

        lift = np.empty(size)
        product(np.zeros(shape), np.ones(shape), lift)
        lifted = inverse(lift)
        weight = self.inner_weight.ravel()[nodes] / np.sqrt(q.load)
        lever = weight @ lifted

        def spread(x: Array) -> tuple[Array, Array]:
            dp = np.zeros(shape)
            dp.ravel()[nodes] = x[:-1]
            set_edge(dp, q.edge, q.wrapped)
            return dp, self.half_space.respond(self.p, dp) + x[-1]

        def operator(x: Array) -> Array:
            dp, dh = spread(x)
            out = np.empty(size + 1)
            product(dp, dh, out[:-1])
            out[-1] = weight @ x[:-1]
            return out

        def invert(b: Array) -> Array:
            y = inverse(b[:-1])
            rigid = (weight @ y - b[-1]) / lever
            return np.append(y - rigid * lifted, rigid)

        missing = self.trial.change(lack, np.zeros(shape)) if lack.any() else 0.0
        wanted = np.where(held, rest - self.h, -self.r - missing).ravel()[nodes] * own_scale
        short = (q.load - float((q.weight * self.p).sum())) / np.sqrt(q.load)
        x = gmres(operator, invert, np.append(wanted, short))
        return *spread(x), float(x[-1])

    def _local_inverse(self, nodes: Indices) -> Callable[[Array], Array] | None:
        """Return a function that solves the local system of the nodes; None if it is singular."""
        q, held, give, by_f, by_h, scale = self.problem, self.held, self.give, self.by_f, self.by_h, self.scale
        size, shape = nodes.size, held.shape
        if self.response is not None:
            row = (by_f[:, 1], by_h[:, 1], scale[1], self.response, nodes - shape[1], held[1], give[1], q.edge[1])
            return band_inverse(*row)
        column = np.full(shape, -1, np.int32)
        column.ravel()[nodes] = np.arange(size)
        if q.wrapped:
            wrap(column)
        start, index, value = np.empty(size + 1, np.int32), np.empty(10 * size, np.int32), np.empty(10 * size)
        args = (by_f, by_h, scale, self.patch, nodes, column, held, give, q.edge, q.wrapped)
        count = linearisation.assemble(*args, start, index, value)
        # the transpose, by columns
        rows = scipy.sparse.csc_matrix((value[:count], index[:count], start), shape=(size, size))
        how = {"SymmetricMode": True}
        try:
            lu = scipy.sparse.linalg.splu(rows, permc_spec="NATURAL", diag_pivot_thresh=0.01, options=how)
        except RuntimeError:  # singular
            return None
        return lambda b: np.asarray(lu.solve(b, "T"))

    def advance(self, dp: Array, dh: Array, d_rigid: float, calm: bool) -> tuple[float, float]:
        """Take as much of a correction as is safe; return the relative change of the pressure and that share.

        `calm`: nodes that keep being sorted anew take half of it; their change counts as if they took all.
        """
        q, old = self.problem, self.p
        wet = self.inner & ~self.solid & (old > 0.0)
        weight = np.where(wet, old, 0.0)
        thinner = np.maximum(-dh, 0.0) / np.maximum(self.h, q.floor)
        if q.depth > 0.0:  # what asperities carry changes by the factor e over their depth, up or down
            thinner = np.where(self.gain * q.depth > _FELT * old, np.abs(dh) / q.depth, thinner)
        fall = float(np.sqrt((weight * thinner**2).sum() / max(float(weight.sum()), 1e-300))) / _FALL
        rise = float((np.where(wet, np.minimum(dp, q.cap - old), 0.0) / (_RISE[0] + _RISE[1] * old)).max())
        share = 1.0 / max(fall, rise, 1.0)
        part = np.where(self.turns > 1.0, 0.5, 1.0) if calm else np.ones(1)
        self.p = np.clip(old + share * part * dp, 0.0, q.cap)
        set_edge(self.p, q.edge, q.wrapped)
        self.rigid += share * d_rigid
        self.solid &= self.p > 0.0
        return float((np.abs(self.p - old) / part)[self.rows].sum()) / q.load, share

    def assess(self, n: int, change: float, whole: bool, tolerance: float) -> Solution:
        """Return the present pressure with its convergence.

        `change` is that of the last step, `whole` is True if that step was taken in full.
        """
        q, p = self.problem, self.p
        load_error = float((q.weight * p).sum()) / q.load - 1.0
        below_cap = self.held & (p < q.cap)
        total = max(float(p.sum()), 1e-300)
        complementarity = float((p * np.abs(self.rest - self.h))[below_cap].sum()) / (q.floor * total)
        inflow, nowhere = np.zeros_like(p), np.zeros_like(self.solid)
        self._residual(nowhere, inflow)
        film = (self.solid, self.h, self.mass, inflow, *q.layer, q.spacing)
        imbalance = float(reynolds.imbalance(p, self.f, q.cap, *film))
        if q.conserving:  # where the film forms, it carries nothing yet
            light = np.abs(self.r[self.rows][p[self.rows] < _LIGHT * p.max()]).sum()
            mean = float((p * self.mass).sum()) / total
            imbalance += float(light) * q.spacing / (mean * self.r[self.rows].shape[0])
        change += self.sought / q.load
        allowed, change_seen = allowed_imbalance(q), change if whole else np.inf
        why = shortfall(tolerance, change_seen, load_error, complementarity, imbalance, allowed)
        iterate = Iterate(p, self.f, self.held, self.rigid)
        return Solution(
            iterate,
            self.h,
            self.mass,
            converged=not why,
            shortfall=why,
            iterations=n,
            pressure_change=change,
            load_error=load_error,
            complementarity=complementarity,
            imbalance=imbalance,
        )


def solve_newton(
    half_space: HalfSpace, problem: Problem, start: Iterate, tolerance: float, iterations: int
) -> Solution:
    """Take Newton steps from `start` until a full step satisfies the stopping rule or `iterations` are used up.

    The result is finite, or its `pressure_change` is infinite.
    """
    film = _Film(half_space, problem, start)
    layered = problem.depth > 0.0 and film.response is None  # a single row comes to rest by itself
    film.evaluate()
    found = film.assess(0, np.inf, False, tolerance)
    for n in range(1, iterations + 1):
        correction = film.correction()
        if correction is None or not np.isfinite(correction[0]).all():
            return failed(start, np.zeros_like(film.p), problem.mass_old, n, "no Newton step")
        calm = layered and n >= _CALM_FROM and found.pressure_change < _NEAR
        change, share = film.advance(*correction, calm)
        film.evaluate()
        found = film.assess(n, change, share == 1.0, tolerance)
        if found.converged:
            break
    return found
