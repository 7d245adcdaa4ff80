"""One grid level of the multigrid solver: a grid, its fields and its share of the problem."""

import threading
from functools import cached_property

import numpy as np

from ..arrays import Array
from ..half_space import HalfSpace, influence
from ..mixed.flow import Flow
from ..mixed.problem import Problem
from . import blended, coarsest, relaxation, transfer
from .mirrored import MirroredHalfSpace

_KEPT = 32  # grids whose plans and scratch are kept
_LARGEST_STEP = 0.5  # of a pressure by Newton's method
_TRIAL = 1e-7  # change of pressures and, relative to the mean one, of gaps, of a difference of flows
# of the masses at i + 1, i, i - 1, i - 2 in the wedge of the lines' equations. fitted: m_u of `mixed.flow`
_WEIGHTS = {True: (0.375, 0.375, -0.875, 0.125), False: (0.0, 1.5, -2.0, 0.5)}
_LOCAL = threading.local()  # plans and scratch may not be shared between threads


class _Transforms:
    """Operators that depend on the number of nodes only; kept between solutions. Holds scratch."""

    def __init__(self, ny: int, nx: int, mirror: bool, library: str) -> None:
        self.near = influence(ny, nx)[:2, :8]
        self.deform = MirroredHalfSpace(ny, nx, library).deform if mirror else HalfSpace(ny, nx, 1.0, library).deform
        self._grid = (ny, nx, mirror)

    @cached_property
    def matrix(self) -> Array:
        """Dense deformation, for the coarsest grid level."""
        return coarsest.dense_deformation(*self._grid)


def _transforms(ny: int, nx: int, mirror: bool, library: str) -> _Transforms:
    key = (ny, nx, mirror, library)
    store: dict[tuple[int, int, bool, str], _Transforms] = _LOCAL.__dict__.setdefault("transforms", {})
    if key not in store:
        if len(store) >= _KEPT:
            store.pop(next(iter(store)))
        store[key] = _Transforms(*key)
    return store[key]


class Level:
    """One grid level; fields are [rows, nx], see `relaxation`.

    `f`, `base`, `offset` and `target` state the problem: right side of the balance, gap of the undeformed bodies, edge
    pressures beyond those that follow the inner ones, load.
    """

    def __init__(self, problem: Problem, x: Array, y: Array, mirror: bool, library: str) -> None:
        self.x, self.y, self.mirror = x, y, mirror
        self.rows, self.nx = (y.size + 1) // 2 if mirror else y.size, x.size
        self.dx = float(x[-1] - x[0]) / (x.size - 1)
        self.compliance, self.scale = problem.compliance, problem.compliance * 2.0 / np.pi**2 * self.dx
        self._problem = problem
        self._transforms = _transforms(y.size, x.size, mirror, library)
        near = self._transforms.near * self.scale
        self._lines = {fitted: relaxation.line_kernels(near, self.dx, w) for fitted, w in _WEIGHTS.items()}
        shape = (self.rows, self.nx)
        self.p, self.h, self.mass, self.soft, self.f = (np.zeros(shape) for _ in range(5))
        scales = relaxation.CLOSED, problem.step, 1.0 / (problem.compliance * self.dx**2), problem.fitted
        self.flow = Flow(shape, *scales)
        self.undeformed, self.base, self.edge, self.weight = (np.zeros(shape) for _ in range(4))
        self.mobility, self.thinned = np.zeros(shape), np.zeros(shape)
        self.offset, self.before, self.work = (np.zeros(shape) for _ in range(3))
        self.target, self.rigid, self.rigid_before = 0.0, 0.0, 0.0

    def set_bodies(self, undeformed: Array, edge: Array, weight: Array) -> None:
        """Take over undeformed gap, edge and weight [ny, nx]."""
        self.undeformed[:], self.edge[:], self.weight[:] = (f[: self.rows] for f in (undeformed, edge, weight))
        if self.mirror:
            self.weight[:-1] *= 2.0  # each row but the last stands for two

    def set_oil(self, mobility: Array, thinned: Array) -> None:
        """Take over mobility and thinned fluidity [ny, nx]."""
        self.mobility[:], self.thinned[:] = mobility[: self.rows], thinned[: self.rows]

    def state_problem(self, load: float) -> None:
        """State the problem without corrections from a finer level. `load`: integral of the pressure."""
        self.flow.fitted = self._problem.fitted
        self.f[:], self.offset[:], self.base[:] = 0.0, 0.0, self.undeformed
        self.target = load

    def whole(self, field: Array) -> Array:
        """Return a copy of a field on all nodes [ny, nx]."""
        return np.concatenate([field, field[-2::-1]]) if self.mirror else field.copy()

    def film(self) -> None:
        """Bring the film up to date with the pressure."""
        self._film(self._transforms.deform(self.p))

    def _film(self, deformation: Array) -> None:
        relaxation.gap_pass(self.base, deformation, self.scale, self.rigid, self.h)
        self._through(self.p, self.h)

    def _through(self, p: Array, h: Array) -> None:
        """Compute what flows through the faces under a pressure and a gap."""
        relaxation.oil_pass(p, h, *self._problem.tables, self.mass, self.soft, *self.flow.nodes)
        self.flow.measure()
        self.flow.drive(p, self.mass, self.mobility, self.thinned)
        if self._problem.fitted and not self.flow.fitted:
            oil = (self.flow.fluid, self.flow.potential, self.thinned)
            per_stiff = 1.0 / (self.compliance * self.dx**2)
            blended.blend(p, *oil, per_stiff, self._problem.step, *self.flow.faces)

    def relax(self, single: float, spread: float) -> None:
        """Relax once; the film must be up to date before, and is not afterwards."""
        wedge, wedge_soft = self._lines[self.flow.fitted]
        relaxation.relax(
            self.p, *self.flow.through, self.flow.rho, self.soft, self.f, self.edge, self.offset,
            wedge, wedge_soft, self.dx, self.compliance, self.mirror, single, spread, self.work,
        )  # fmt: skip

    def set_edges(self) -> None:
        """Set the edge pressures from the inner ones."""
        relaxation.set_edges(self.p, self.edge, self.offset, self.mirror)

    def load(self) -> float:
        """Return the integral of the pressure."""
        return float(transfer.weighted_sum(self.weight, self.p)) * self.dx**2

    def defect(self) -> float:
        """Put the defect of the balance into `work`; return the imbalance as `reynolds.imbalance`."""
        wrong, film = relaxation.defect(self.p, self.mass, *self.flow.through, self.f, self.dx, self.mirror, self.work)
        return abs(float(wrong / film))

    def restrict(self, fine: "Level") -> None:
        """State the problem that corrects the finer level, whose film is up to date; start from its fields."""
        fine.defect()
        self.flow.fitted = False  # a correction needs no more, and is smoother: see `blended`
        transfer.inject(fine.p, self.p)
        transfer.inject(fine.h, self.h)
        self.before[:] = self.p
        self.rigid = self.rigid_before = fine.rigid
        transfer.edge_offset(self.p, self.edge, self.mirror, self.offset)
        deformation = self._transforms.deform(self.p)
        transfer.undeformed_gap(self.h, deformation, self.scale, self.rigid, self.base)
        self._film(deformation)
        relaxation.balance(self.p, *self.flow.through, self.dx, self.mirror, self.f)
        transfer.add_weighted(fine.work, fine.mirror, self.f)
        self.target = self.load() + fine.target - fine.load()

    def correct(self, coarse: "Level") -> None:
        """Add the changes of the coarser level."""
        transfer.add_interpolated(coarse.p, coarse.before, self.p, self._problem.fitted)
        self.set_edges()
        self.rigid += coarse.rigid - coarse.rigid_before

    def newton(self) -> None:
        """Improve pressure and rigid gap together by a Newton step; the film must be up to date."""
        lift = coarsest.condensed(self._transforms.matrix, self.edge, self.mirror) * self.scale
        unknowns = lift.shape[1] + 1
        jacobian, change = np.empty((unknowns, unknowns)), np.empty(unknowns)
        missing = (self.target - self.load()) / self.dx**2
        inflow = np.zeros_like(self.p)
        relaxation.balance(self.p, *self.flow.through, self.dx, self.mirror, inflow)
        with np.errstate(all="ignore"):  # a film that diverges shows by its pressure
            by_p, by_h = self._by_colours(inflow, np.array([1.0, 0.0])), self._by_colours(inflow, np.array([0.0, 1.0]))
            excess = inflow - self.f
        derivatives = (by_p, by_h, excess, self.edge, self.weight, missing, lift, self.mirror)
        coarsest.assemble(self.p, *derivatives, jacobian, change)
        if coarsest.solve_dense(jacobian, change) and np.isfinite(change).all():  # else finer levels do without
            part = min(1.0, _LARGEST_STEP / max(float(np.abs(change[:-1]).max()), 1e-300))
            coarsest.advance(self.p, change, part, self.mirror)
            self.rigid += part * float(change[-1])
            self.set_edges()

    def _by_colours(self, inflow: Array, of: Array) -> Array:
        """Return the derivatives of the net inflow by pressure (`of` = 1, 0) or gap (0, 1) of the nodes around.

        [colours, rows, nx]: all nodes of a colour change at once, of which a balance looks at one at most.
        """
        out = np.empty((coarsest.ACROSS * coarsest.ALONG, *self.p.shape))
        size = _TRIAL * (of[0] + of[1] * float(np.abs(self.h).mean()))
        for colour in range(len(out)):
            part = np.zeros_like(self.p)
            part[colour // coarsest.ALONG :: coarsest.ACROSS, colour % coarsest.ALONG :: coarsest.ALONG] = size
            self._through(self.p + of[0] * part, self.h + of[1] * part)
            relaxation.balance(self.p + of[0] * part, *self.flow.through, self.dx, self.mirror, out[colour])
            out[colour] -= inflow
            out[colour] *= 1.0 / size
        self._through(self.p, self.h)
        return out

    def film_thickness(self) -> tuple[float, float]:
        """Return the gap at x = 0 on the row next to y = 0, and the smallest gap."""
        row = min(int(np.abs(self.y).argmin()), self.rows - 1)
        return float(np.interp(0.0, self.x, self.h[row])), float(self.h.min())
