"""Steady film near the floor, where contacts, the oil under them and nodes at the floor do not settle otherwise.

Two things keep the iteration of `fixed_point` from settling there, however small its steps. Under a contact, flow
falls exponentially with the oil's pressure, and its mass balance may have no other term than what entrainment carries:
Gauss-Seidel on the flow of the iteration before jumps between no pressure and all of it. Here each of these nodes takes
a Newton step of its own balance. Where a film reaches the floor, the oil is carried along as it is (`flow`): such a
node gains mass at the floor and loses it above, without an end. Here it is held a little above the floor, under oil
alone, as long as it loses mass there; by the stopping rule, solids carry the rest. And pockets closed off by contacts
fill too slowly by lines. Here they fill as a whole (`pockets`), those within others first.

A film that is found satisfies the stopping rule with no node held, for changes of the pressure that are not damped.
"""

from dataclasses import replace

import numpy as np

from ..arrays import Mask
from ..compiled import jit
from ..half_space import HalfSpace
from . import corrections, reynolds
from .edge import wrap
from .fixed_point import Iteration
from .flow import properties
from .pockets import fill_pockets
from .problem import Iterate, Problem, Solution, failed
from .stopping_rule import excess

_LOOKS = 16  # at the undamped film, at most, without convergence before
_DEPTH, _DAMPING, _STIFF_STEP = 2, 0.2, 0.4  # of Anderson's memory; part of a step that is taken; of stiff nodes
_PASSES, _PART, _LARGEST_STEP = 3, 0.7, 0.1  # of the oil under contacts, in an iteration; its steps, in units of p
_OPEN, _REST = 1.001, 1.01  # gap in floors through which oil flows at a held node, at least; at which it rests
# mobilities of faces that join nodes to pockets, over that below which elasticity rules; part of what balances a pocket
# that it takes, as contacts around it give way only later
_JOINED, _FILLED = (1e3, 1e2, 10.0), 0.5
_UNTIL_HELD = 30  # iterations from the start, and from a release, to the hold of a node


@jit
def _open(held, p, f, solid, h, least, step, density, fluidity, potential, full, gap, rho, fluid, driven):  # type: ignore[no-untyped-def]
    """Give held nodes to the oil, with a gap of at least `least`: the flow through their faces is that of a film."""
    ny, nx = p.shape
    for j in range(ny):
        for i in range(nx):
            if held[j, i]:
                solid[j, i], f[j, i], gap[j, i] = False, p[j, i], max(h[j, i], least)
                rho[j, i], fluid[j, i], driven[j, i] = properties(f[j, i], step, density, fluidity, potential)
                full[j, i] = rho[j, i] * gap[j, i]


@jit
def _step_under_contacts(  # type: ignore[no-untyped-def]
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
    floor,
    step,
    density,
    fluidity,
    potential,
    gap,
    rho,
    fluid,
    driven,
    thinned,
    release,
):
    """Take part of a Newton step of the balance of each contact by its own fluid pressure; update its properties.

    release: contacts that the fluid alone carries are released, as in `reynolds.fluid_under_contacts`.
    """
    ny, nx = p.shape
    per_dx2 = 1.0 / (dx * dx)
    new = f.copy()
    for j in range(1, ny - 1):
        for i in range(1, nx - 1):
            if not solid[j, i]:
                continue
            here, own = f[j, i], fluid[j, i] + thinned[j, i]
            gain = reynolds.inflow(f, ex, ey, per_dx2, j, i)
            gain -= reynolds.transport(mass, flux, mass_old, per_dt, wedge, dx, j, i)
            slope = 0.0  # of the outflow by the pressure
            for side in range(4):
                dj, di = (-1, 0, 0, 1)[side], (0, -1, 1, 0)[side]
                face = ex[j, i + min(di, 0)] if dj == 0 else ey[j + min(dj, 0), i]
                drop = f[j + dj, i + di] - here
                mean = 0.5 * (fluid[j, i] + fluid[j + dj, i + di])
                if abs(drop) >= 0.5 * step:
                    mean = (driven[j + dj, i + di] - driven[j, i]) / drop
                mean += 0.5 * (thinned[j, i] + thinned[j + dj, i + di])
                slope += per_dx2 * face * own / max(mean, 1e-300)
            k = min(int(here / step), density.size - 2)
            slope += gap[j, i] * (density[k + 1] - density[k]) / step * (wedge / dx + per_dt)
            value = here + min(max(_PART * gain / slope, -_LARGEST_STEP), _LARGEST_STEP)
            if release and value > p[j, i] and h[j, i] > reynolds.DEEP * floor:
                solid[j, i] = False
                value = p[j, i]
            new[j, i] = min(max(value, 0.0), p[j, i])
    for j in range(1, ny - 1):
        for i in range(1, nx - 1):
            if new[j, i] != f[j, i]:
                f[j, i] = new[j, i]
                rho[j, i], fluid[j, i], driven[j, i] = properties(f[j, i], step, density, fluidity, potential)
                mass[j, i] = rho[j, i] * gap[j, i]


class _Held(Iteration):
    """An iteration in small steps, with oil under contacts in balance and nodes held above the floor."""

    sweeps = 10  # for each of _JOINED

    def __init__(self, half_space: HalfSpace, problem: Problem, start: Iterate) -> None:
        super().__init__(half_space, problem, start, _DEPTH, _STIFF_STEP)
        self.damping = _DAMPING
        self.held: Mask = np.zeros(self.p.shape, np.bool_)
        self.waits = np.full(self.p.shape, _UNTIL_HELD)

    def correct(self) -> None:
        super().correct()
        self.damping = _DAMPING
        self.change /= _DAMPING

    def _relax(self) -> None:
        q = self.problem
        film = (self.p, self.solid, self.stiff, self.h, self.mass, *self.flow.faces, self.r, q.edge, q.floor, q.wedge)
        for joined in _JOINED:
            super()._relax()
            least = joined * q.compliance * q.spacing**2
            fill_pockets(*film, q.spacing, self.half_space.near, least, _FILLED, q.wrapped, self.dp)

    def _film(self) -> None:
        q, flow = self.problem, self.flow
        self._gap()
        if self.held.any():
            full = (self.mass, *flow.nodes)
            _open(self.held, self.p, self.f, self.solid, self.h, _OPEN * q.floor, *q.tables, *full)
            self._wrap()
            flow.measure()
        self._carry(self.mass)
        oil = (*q.terms, q.floor, *q.tables, *flow.nodes, q.thinned)
        for n in range(_PASSES):
            film = (self.p, self.f, self.solid, self.h, self.mass, q.mass_old, *flow.through)
            _step_under_contacts(*film, *oil, n == _PASSES - 1)
            self._wrap()
            self._carry(self.mass)
        self._correct_gap()
        self._hold()

    def evaluate(self) -> None:
        """Compute the film of the present pressures, of solids and oil, with no node held."""
        self._gap()
        self._carry(self.mass)
        self._correct_gap()

    def _gap(self) -> None:
        q, p, flow = self.problem, self.p, self.flow
        bodies = (q.undeformed, self.half_space.deform_padded(p), self.rigid)
        self.solid[self.held] = False
        film = (self.h, self.pressing, self.mass, *flow.nodes)
        reynolds.film_pass(p, self.f, self.solid, *bodies, *q.layer, *q.tables, *film, False, None, 0.0)
        flow.measure()

    def _correct_gap(self) -> None:
        q, flow = self.problem, self.flow
        scales = (*q.layer, *q.terms, q.compliance, self.patch)
        state = (self.p, self.f, q.cap, self.solid, self.h, self.pressing, self.mass, q.mass_old, *flow.through)
        out = (self.r, self.stiff, self.dh, self.sums)
        self.zone = corrections.correct_gap(*state, *scales, self.stiff_of_unit, *out, True, None, 1)
        if q.wrapped:
            wrap(self.solid)

    def _wrap(self) -> None:
        if self.problem.wrapped:
            for field in (self.f, self.mass, self.solid, *self.flow.nodes):
                wrap(field)

    def _hold(self) -> None:
        """Choose the nodes that are held, and lead them to where they rest."""
        q, p, gain = self.problem, self.p, np.zeros_like(self.p)
        nowhere = np.zeros_like(self.solid)
        reynolds.residual(self.f, nowhere, self.mass, q.mass_old, *self.flow.through, *q.terms, gain, None, 1)
        within = (p > 0.0) & (p < q.cap)
        released = self.held & ((gain > 0.0) | ~within)
        self.waits = np.where(released, _UNTIL_HELD, np.maximum(self.waits - 1, 0))
        lifted = within & (self.h <= q.floor) & (self.f >= p) & (gain > 0.0)  # the gain is zero on the edge
        self.held = (self.held & ~released) | (lifted & (self.waits == 0))
        self.solid[self.held] = False
        self.stiff |= self.held
        self.dh[self.held] = _REST * q.floor - self.h[self.held]
        if q.wrapped:
            wrap(self.solid)
        rows, columns = np.nonzero(self.stiff)
        if rows.size:
            changed = int((self.stiff != self.stiff_of_unit).sum())
            ends = (int(rows.min()), int(rows.max()) + 1, int(columns.min()), int(columns.max()) + 1)
            self.zone = (*ends, rows.size, changed)


def solve_held(half_space: HalfSpace, problem: Problem, start: Iterate, tolerance: float, iterations: int) -> Solution:
    """Iterate from `start` until a steady film satisfies the stopping rule or all iterations are used up.

    `iterations`: from one look at the undamped film to the next. Without convergence the result is the best of
    these. Neither asperities below the grid nor `Problem.by_flux`.
    """
    best: Solution | None = None
    it = _Held(half_space, problem, start)
    for n in range(1, _LOOKS * iterations + 1):
        it.correct()
        found = it.assess(n, tolerance)
        if not np.isfinite(found.pressure_change):
            break
        if found.converged or n % iterations == 0:
            it.evaluate()
            found = it.assess(n, tolerance)
            if best is None or excess(found, tolerance, problem) < excess(best, tolerance, problem):
                best = it.kept(found)
            if found.converged:
                return it.kept(found)
        it.mix()
    if best is None:
        return failed(start, np.zeros_like(problem.cap), problem.mass_old, n, "no finite solution")
    return replace(best, iterations=n)
