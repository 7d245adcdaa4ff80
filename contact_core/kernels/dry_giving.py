"""Frictionless dry contact of rough bodies whose surfaces give way node by node.

The pressure minimises the energy of `dry` and that of `SurfaceGive`. Both are convex: there is one solution.
"""

import numpy as np

from .arrays import Array
from .dry import dry_solution
from .half_space import HalfSpace
from .surface_give import SurfaceGive

_STEPS = 30  # of Newton's method, at most
_HALVINGS = 8
_ROUNDING = 1e-12  # of the energy


def solve_dry_giving(
    half_space: HalfSpace,
    gap: Array,
    cap: Array,
    load: float,
    start: Array,
    give: SurfaceGive,
    tolerance: float,
    iterations: int,
) -> tuple[Array, float, bool, int]:
    """Return pressure, rigid gap, convergence and iterations of `dry.dry_solution` on a surface that gives way.

    Newton's method: u is piecewise linear, so each step is a contact of nodes that are soft, and the last one is exact.
    Steps are shortened until the energy falls.
    """
    p, energy, spent, rigid, converged = start, np.inf, 0, 0.0, False
    for _ in range(_STEPS):
        soft = give.slope_at(p)
        undeformed = gap + give.at(p) - soft * p
        found = dry_solution(half_space, undeformed, cap, load, p, tolerance, iterations - spent, soft)
        spent += found.iterations
        step, rigid, part = found.pressure - p, found.rigid, 1.0
        for _ in range(_HALVINGS):
            trial = p + part * step
            new = _energy(half_space, gap, give, trial)
            if new <= energy + _ROUNDING * abs(energy):
                break
            part *= 0.5
        p, energy = trial, new
        converged = found.converged and part == 1.0 and float(np.abs(step).sum()) < tolerance * load
        if converged or spent >= iterations:
            break
    return p, rigid, converged, spent


def _energy(half_space: HalfSpace, gap: Array, give: SurfaceGive, p: Array) -> float:
    return float(((gap + 0.5 * half_space.deform(p)) * p).sum()) + give.energy(p)
