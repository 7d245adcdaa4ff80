"""Steady films of rough contacts, marched in time over standing surfaces.

A steady film has to find its way through the contacts: where oil presses against one, that is released node by node
from upstream, and what flows on meets the next. An iteration without time moves this front by a node or less, while it
changes the pressure so little that each looks converged. Time steps of a few nodes, each far from solved, move it
as fast and keep the mass, so that what is still to come shows in the pressure's change over some steps.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .dry import solve_dry
from .half_space import HalfSpace
from .mixed import _DEPTH, _STIFF_STEP, Iterate, Problem, Solution, _Iteration, shortfall

Array = NDArray[np.float64]

_NODES = 4.0  # by which the oil moves in a time step
_PER_STEP = 6  # iterations
_STEPS = 3  # time steps over which the film must stand still
_SOLID_SHARE = 0.85  # of the load in `shared_start`: the best of 0.03 to 0.95 from light contact to nearly dry
_DRY_TOLERANCE = 1e-2
_DRY_ITERATIONS = 200


def shared_start(half_space: HalfSpace, problem: Problem, smooth: Array) -> Iterate:
    """Solids that carry most of the load in dry contact, above oil that carries the rest like smooth bodies.

    Filled valleys drain faster than dry ones fill: from a dry contact, the oil has to break every seal. The contact
    then settles to a share of its own, which is far lower. smooth [ny, nx]: pressure of smooth bodies, of any size.
    """
    fluid = smooth * ((1.0 - _SOLID_SHARE) * problem.load / smooth.sum())
    fluid = np.minimum(fluid, 0.5 * problem.cap)
    left = problem.load - float(fluid.sum())
    gap = problem.undeformed + half_space.deform(fluid)
    solid, rigid, _, _ = solve_dry(half_space, gap, problem.cap - fluid, left, smooth, _DRY_TOLERANCE, _DRY_ITERATIONS)
    return Iterate(solid + fluid, fluid, solid > 0.0, rigid + problem.floor)


def solve_steady(
    half_space: HalfSpace, problem: Problem, start: Iterate, tolerance: float, iterations: int
) -> Solution:
    """March from `start` until the pressure changes by less than `tolerance` in `_STEPS` time steps.

    `problem` is a steady one, its `per_dt` zero. The solution's `change` and `imbalance` are those over these steps.
    Non-finite values never leave, as in `mixed.solve_mixed`.
    """
    per_dt = 1.0 / (_NODES * problem.spacing)
    it = _Iteration(half_space, replace(problem, per_dt=per_dt), start, _DEPTH, _STIFF_STEP)
    mass = it.filled()
    before, found, n = (it.p.copy(), mass), None, 0
    while n < iterations:
        if n % _PER_STEP == 0:
            it.step_on(mass)
        n += 1
        it.correct()
        if not np.isfinite(it.change):
            break
        if n % _PER_STEP == 0:
            now = it.kept(it.assess(n, tolerance))
            mass = now.mass
            steps = (n // _PER_STEP - 1) % _STEPS + 1
            found = _judged(now, before, problem.load, per_dt / steps, tolerance)
            if steps == _STEPS:
                if found.converged:
                    break
                before = (now.iterate.pressure, mass)
            elif found.converged:
                found = replace(found, converged=False, shortfall="too few time steps")
        it.mix()
    if found is None:
        zeros, why = np.zeros_like(problem.cap), "no finite solution"
        return Solution(start, zeros, problem.mass_old, False, n, np.inf, np.inf, np.inf, np.inf, why)
    return replace(found, iterations=n)


def _judged(now: Solution, before: tuple[Array, Array], load: float, per_time: float, tolerance: float) -> Solution:
    """A film with what has changed since an earlier pressure and mass, and whether it stands still."""
    p = now.iterate.pressure
    oil = np.where(now.iterate.solid, 0.0, p)
    change = float(np.abs(p - before[0]).sum()) / load
    gained = float((np.abs(now.mass - before[1]) * oil).sum()) * per_time
    imbalance = gained / max(float((now.mass * oil).sum()), 1e-300) * float(oil.sum()) / load
    why = shortfall(tolerance, change, now.load_error, now.intrusion, imbalance, False)
    return replace(now, change=change, imbalance=imbalance, converged=not why, shortfall=why)
