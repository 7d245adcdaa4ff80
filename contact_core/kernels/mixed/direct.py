"""The iteration of `fixed_point` with fluid off the stiff zone, rigid gap and load solved at once.

Lines need thousands of iterations where the oil flows along narrow paths: in pockets closed off by contacts, and under
a light load, where a film is far wider than the contact and few nodes are stiff enough to carry a change of load.
Here the equation of `corrections.relax_lines` is solved by a sparse factorisation, bordered by the rigid gap and the
load. It takes a few tens of iterations from light to heavy loads and full film to dry; each costs some tens of those
of `fixed_point`.
"""

import numpy as np
import scipy
from numpy.typing import NDArray

from ..compiled import jit
from ..half_space import HalfSpace
from . import reynolds
from .asperities import carried_at, missing
from .cavities import Carried
from .edge import set_edge, wrap
from .fixed_point import Iteration, iterate_on
from .flow import Flow, node_pass
from .problem import Iterate, Problem, Solution

Array = NDArray[np.float64]


_DEPTH, _STIFF_STEP = 5, 0.5  # of Anderson's memory; part of their correction that stiff nodes take
_LARGEST_STEP = 0.3  # of the load, that pressures may change by in an iteration
_LARGEST_FALL = 0.5  # of the mean film, that the rigid gap may fall by
_JUMP = 10.0  # times the change before, above which the memory is discarded
_PROBE = 1e-6  # part of a film by which the rigid gap is moved for the derivative


@jit
def _number_free(p, f, solid, stiff, h, r, floor, stress, depth, wrapped, number, gain, lack):  # type: ignore[no-untyped-def]
    """Put the numbers of the free nodes into `number` (-1: not free); return their count.

    gain: rise of the fluid pressure with the gap, of nodes at which asperities share the load with the oil. lack: of
    the pressure, up to that of the asperities.
    """
    ny, nx = p.shape
    n = 0
    for j in range(ny):
        for i in range(nx):
            number[j, i], gain[j, i], lack[j, i] = -1, 0.0, 0.0
            inner = 0 < j < ny - 1 and 0 < i < nx - 1
            if inner and not stiff[j, i] and not solid[j, i] and not (p[j, i] <= 0.0 and r[j, i] <= 0.0):
                number[j, i] = n
                n += 1
            if depth > 0.0 and inner and not solid[j, i]:
                carried = carried_at(h[j, i], floor, stress, depth)
                lack[j, i] = missing(p[j, i], carried, False)
                if f[j, i] > 0.0 and h[j, i] > floor:
                    gain[j, i] = carried / depth
    if wrapped:
        wrap(number)
        wrap(gain)
        wrap(lack)
    return n


@jit
def _equations(  # type: ignore[no-untyped-def]
    p,
    solid,
    stiff,
    h,
    mass,
    ex,
    ey,
    r,
    edge,
    floor,
    per_dt,
    wedge,
    dx,
    near,
    patch_wide,
    given,
    unit,
    response,
    gain,
    extra,
    wrapped,
    number,
    starts,
    columns,
    values,
    rhs,
    filling=None,
    first=1,
):
    """Assemble the linearised equation of the free nodes, `number` from `_number_free`; return the count of entries.

    An image has the number of its node: of few rows, some columns stand in a row more than once, and add up.

    given, unit: step of the stiff nodes and its fall with the rigid gap; extra: what asperities add to the step of
    the fluid pressure besides. rhs [2, n]: what is asked for, and its change with the rigid gap.
    """
    ny, nx = p.shape
    per_dx2 = 1.0 / (dx * dx)
    k0, k1, k2, k3, k4 = near[0, 0], near[0, 1], near[0, 2], near[0, 3], near[0, 4]
    lifts = np.empty(6)  # d(deformation wedge)_i / dp_(i + m), m = -3 ... 2
    lifts[0] = wedge * ((1.5 * k3 - 2.0 * k2 + 0.5 * k1) / dx)
    lifts[1] = wedge * ((1.5 * k2 - 2.0 * k1 + 0.5 * k0) / dx)
    lifts[2] = wedge * ((1.5 * k1 - 2.0 * k0 + 0.5 * k1) / dx)
    lifts[3] = wedge * ((1.5 * k0 - 2.0 * k1 + 0.5 * k2) / dx) + per_dt * patch_wide
    lifts[4] = wedge * ((1.5 * k1 - 2.0 * k2 + 0.5 * k3) / dx)
    lifts[5] = wedge * ((1.5 * k2 - 2.0 * k3 + 0.5 * k4) / dx)
    filled = 0
    for j in range(1, ny - 1):
        for i in range(1, nx - 1):
            row = number[j, i]
            if row < 0:
                continue
            starts[row] = filled
            rho = mass[j, i] / h[j, i] if h[j, i] > floor else 0.0  # at the floor the flow does not depend on it
            asked, moved = r[j, i], response[j, i]
            diagonal, over_own = rho * lifts[3], 1.0 + gain[j, i] * k0
            faces, fluid_faces = np.zeros(6), np.zeros(6)  # of steps of free nodes, and of given ones
            for side in range(4):  # south, west, east, north
                dj, di = (-1, 0, 0, 1)[side], (0, -1, 1, 0)[side]
                face = per_dx2 * (ex[j, i + min(di, 0)] if dj == 0 else ey[j + min(dj, 0), i])
                diagonal += face * over_own
                own_share = 1.0
                if filling is not None and side == 1:
                    back = reynolds.returned(filling, first, per_dt, wedge, dx, j, i)
                    diagonal -= back * face * over_own
                    own_share -= back
                diagonal -= face * edge[j + dj, i + di]
                asked -= own_share * face * extra[j, i]
                if solid[j + dj, i + di] or edge[j + dj, i + di] > 0.0:  # the fluid pressure of a contact stays
                    face = 0.0
                asked += face * extra[j + dj, i + di]
                if dj == 0:
                    faces[3 + di], fluid_faces[3 + di] = face * (1.0 + gain[j, i + di] * k0), face
                    continue
                if side == 0 and number[j - 1, i] >= 0:
                    columns[filled], values[filled] = number[j - 1, i], -face * (1.0 + gain[j - 1, i] * k0)
                    filled += 1
                elif side == 0:
                    asked += face * given[j - 1, i]
                    moved -= face * unit[j - 1, i]
            for m in range(6):
                k = i + m - 3
                if m == 3:
                    columns[filled], values[filled] = row, diagonal
                    filled += 1
                elif 0 <= k < nx:
                    if number[j, k] >= 0:
                        columns[filled], values[filled] = number[j, k], rho * lifts[m] - faces[m]
                        filled += 1
                    else:
                        value = rho * lifts[m] - fluid_faces[m]
                        asked -= value * given[j, k]
                        moved += value * unit[j, k]
            north = 0.0 if solid[j + 1, i] or edge[j + 1, i] > 0.0 else per_dx2 * ey[j, i]
            if number[j + 1, i] >= 0:
                columns[filled], values[filled] = number[j + 1, i], -north * (1.0 + gain[j + 1, i] * k0)
                filled += 1
            else:
                asked += north * given[j + 1, i]
                moved -= north * unit[j + 1, i]
            rhs[0, row], rhs[1, row] = asked, moved
    return filled


@jit
def _carried(base, lever, shift, cap, edge, weight, wrapped, out):  # type: ignore[no-untyped-def]
    """Put base + shift * lever within its bounds into `out`; return its load and the rate of that."""
    ny, nx = base.shape
    for j in range(1, ny - 1):
        for i in range(1, nx - 1):
            out[j, i] = min(max(base[j, i] + shift * lever[j, i], 0.0), cap[j, i])
    set_edge(out, edge, wrapped)
    total, rate = 0.0, 0.0
    for j in range(ny):
        for i in range(nx):
            total += weight[j, i] * out[j, i]
            if 0.0 < out[j, i] < cap[j, i]:
                rate += weight[j, i] * lever[j, i]
    return total, rate


class Direct(Iteration):
    """The fixed-point iteration with the free nodes solved by factorisation."""

    splits = False

    def __init__(self, half_space: HalfSpace, problem: Problem, start: Iterate) -> None:
        super().__init__(half_space, problem, start, _DEPTH, _STIFF_STEP)
        shape, size = self.p.shape, self.p.size
        self.number, self.gain, self.lack = np.zeros(shape, np.int64), np.zeros(shape), np.zeros(shape)
        self.response, self.lever = np.zeros(shape), np.zeros(shape)
        self.moved = Flow.of(problem)
        self.moved_fluid, self.full_mass, self.moved_mass = np.zeros(shape), np.zeros(shape), np.zeros(shape)
        self.moved_oil = None if self.carried is None else Carried(problem)
        self.starts, self.columns = np.zeros(size + 1, np.int64), np.zeros(8 * size, np.int64)
        self.values, self.rhs = np.zeros(8 * size), np.zeros((2, size))

    def correct(self) -> None:
        """Compute the film of the present iterate; put its image into Anderson's memory."""
        self._film()
        self._press()
        q, p = self.problem, self.p
        bound = 0.2 + 0.5 * p
        base = np.where(self.stiff, np.clip(self.dp, -bound, bound), 0.0)
        self.lever[:] = np.where(self.stiff, -self.unit, 0.0)
        if q.wrapped:
            wrap(base)
            wrap(self.lever)
        self._solve_free(base)
        base += p
        yields = self.stiff & (p >= q.cap) & (self.dh >= 0.0)  # stay at the cap until their gap opens too far
        base[yields], self.lever[yields] = p[yields], 0.0
        image = self._pressure_of(self.memory.image)
        shift = self._meet_load(base, image)
        change = float(np.abs(image - p)[self.rows].sum()) / q.load
        part = min(1.0, _LARGEST_STEP / max(change, 1e-300))
        if part < 1.0:
            image[:] = p + part * (image - p)
        self.memory.image[-1] = self.x[-1] + self.weight * part * shift
        self.change = part * change
        if self.change > _JUMP * max(self.least, 1e-3):
            self.memory.clear()
        self.least = self.change

    def _solve_free(self, base: Array) -> None:
        """Put the steps of the free nodes into `base`, their change with the rigid gap into the lever."""
        q, p = self.problem, self.p
        scale = _PROBE * float(np.maximum(self.h, q.floor).min())
        state = (p, self.f, self.solid, self.stiff, self.h, self.r, *q.layer)
        n = _number_free(*state, q.wrapped, self.number, self.gain, self.lack)
        if n == 0:
            return
        self._respond(scale)
        filling = () if self.carried is None else (self.carried.filling, self.carried.first)
        film = (self.h, self.mass, *self.flow.faces, self.r, q.edge, q.floor, *q.terms)
        extra = np.where(self.stiff, self.stiff_step * self.gain * self.dh, 0.0) + self.lack
        given = (self.half_space.near, self.patch_wide, base, -self.lever, self.response, self.gain, extra)
        system = (self.number, self.starts, self.columns, self.values, self.rhs)
        filled = _equations(p, self.solid, self.stiff, *film, *given, q.wrapped, *system, *filling)
        self.starts[n] = filled
        rows = (self.values[:filled], self.columns[:filled], self.starts[: n + 1])
        # rows read as columns: the transpose. Its pattern is all but symmetric, which saves a third of the time
        matrix, how = scipy.sparse.csc_matrix(rows, shape=(n, n)), {"SymmetricMode": True}
        try:
            factors = scipy.sparse.linalg.splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.01, options=how)
        except RuntimeError:  # singular: no step
            base[:] = np.nan
            return
        free = self.number[1:-1] >= 0
        base[1:-1][free], self.lever[1:-1][free] = (factors.solve(side[:n], trans="T") for side in self.rhs)

    def _respond(self, trial: float) -> None:
        """Compute the change of every fluid node's net inflow with the rigid gap, by a trial change of that."""
        q, here, moved = self.problem, self.flow, self.moved
        rise = np.maximum(self.h + trial, q.floor) - np.maximum(self.h, q.floor)
        f, full = self.moved_fluid, self.full_mass
        given_up = np.where(self.number >= 0, self.gain, 0.0) * rise  # by asperities, to the oil
        change = (self.solid, given_up, rise, 1.0)
        node_pass(self.f, here.gap, *change, q.floor, *q.tables, f, full, *moved.nodes)
        moved.measure()
        moved.drive(f, full, q.mobility, q.thinned)
        mass, flux, old = full, moved.carried, here.carried
        filling, filling_before, first = None, None, 1
        if self.carried is not None and self.moved_oil is not None:
            np.copyto(self.moved_oil.full, full)
            mass = self.moved_mass
            self.moved_oil.carry(f, moved, mass)
            flux, old, first = self.moved_oil.flux, self.carried.flux, self.carried.first
            filling, filling_before = self.moved_oil.filling, self.carried.filling
        balance = (mass, q.mass_old, *moved.faces, flux, *q.terms)
        reynolds.residual(f, self.solid, *balance, self.response, filling, first)
        balance, before = (self.mass, q.mass_old, *here.faces, old, *q.terms), np.empty_like(self.response)
        reynolds.residual(self.f, self.solid, *balance, before, filling_before, first)
        self.response -= before
        self.response /= trial

    def _meet_load(self, base: Array, image: Array) -> float:
        """Return the change of the rigid gap for which base + change * lever carries the load; put it into `image`."""
        q = self.problem
        oil = ~self.stiff & (self.p > 0.0)
        pressure = self.p[oil]
        film = float((np.maximum(self.h[oil], q.floor) * pressure).sum() / pressure.sum()) if oil.any() else 1.0
        shift, most = 0.0, 0.3 + 0.3 * film
        for _ in range(30):
            total, rate = _carried(base, self.lever, shift, q.cap, q.edge, q.weight, q.wrapped, image)
            if abs(total - q.load) <= 1e-10 * q.load or rate >= 0.0:
                break
            shift = min(max(shift - (total - q.load) / rate, -max(_LARGEST_FALL * film, q.floor)), most)
        _carried(base, self.lever, shift, q.cap, q.edge, q.weight, q.wrapped, image)
        if self.carried is not None and not image.any():  # nothing is full: the bodies approach until something is
            shift = -_LARGEST_FALL * float(self.h.min())
        return shift


def solve_direct(
    half_space: HalfSpace, problem: Problem, start: Iterate, tolerance: float, iterations: int
) -> Solution:
    """Iterate as `fixed_point.solve_mixed`, with a factorisation per iteration."""
    return iterate_on(Direct(half_space, problem, start), tolerance, iterations)
