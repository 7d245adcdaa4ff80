"""Steady film at the end of a march in time, by the iteration of `fixed_point`.

Where asperities share the load with oil, corrections of a steady film pass from contact to contact down the whole
flow, and overshoot. In a time step they reach no further than the oil flows in it, and the residual of the balance
becomes squeeze, which the next step takes over. Roughness stands still. Each round of steps is followed by a try at
the steady film, from the end of the march; the next round goes on from there, not from the try.
"""

from dataclasses import replace

from ..half_space import HalfSpace
from .fixed_point import solve_mixed
from .problem import Iterate, Problem, Solution
from .stopping_rule import excess

_PER_DT = (10.0, 10.0, 10.0, 5.0, 5.0, 2.0, 2.0, 2.0)  # 1 / time step of each round: long steps follow short ones
_STEPS, _STEP_ITERATIONS, _STEADY_ITERATIONS = 10, 40, 40


def solve_marched(
    half_space: HalfSpace, problem: Problem, start: Iterate, tolerance: float, iterations: int
) -> Solution:
    """March from `start` until a steady film satisfies the stopping rule or `iterations` are used up.

    Without convergence the result is the steady try that is nearest to it.
    """
    best = film = solve_mixed(half_space, problem, start, tolerance, min(_STEADY_ITERATIONS, iterations))
    spent = film.iterations
    for per_dt in _PER_DT:
        for _ in range(_STEPS):
            if best.converged or spent >= iterations:
                return replace(best, iterations=spent)
            step = replace(problem, per_dt=per_dt, mass_old=film.mass)
            limit = min(_STEP_ITERATIONS, iterations - spent)
            film = solve_mixed(half_space, step, film.iterate, tolerance, limit)
            spent += film.iterations
        found = solve_mixed(half_space, problem, film.iterate, tolerance, _STEADY_ITERATIONS)
        spent += found.iterations
        if excess(found, tolerance, problem) < excess(best, tolerance, problem):
            best = found
    return replace(best, iterations=spent)
