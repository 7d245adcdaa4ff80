"""How much more easily oil flows through a film than its Newtonian viscosity says: thinned by shear, or warmer.

A generalised Newtonian oil is sheared by sliding and by its pressure gradient together. Across a film of thickness h
the stress is tau_m + z grad p, |z| < h/2, and the rate of shear E(|tau|) tau / eta. The sliding speed, integral of
the rate, and the pressure flow, integral of -z times the rate, determine tau_m and grad p; the ease is that flow over
what the same gradient would drive at constant viscosity, -(h^3 / 12 eta) grad p. It is taken at the pressure flow of
the film at hand rather than at its gradient: continuity holds the flow, whatever the oil, so repeated solutions settle,
and stresses stay finite where pressures jump. In a converged film both are the same.

One factor serves both directions: that of a gradient along the sliding speed, with the size of grad p. It is exact in
pure rolling, and along x. Across a fast sliding film it is too large: by the ratio of tangent to secant of the flow
curve, at most 1/n for a power n.

The limiting stress is left out: where it acts the oil does not flow under pressure but slips.

Sources: Johnson & Greenwood, Wear 61 (1980) 353, doi:10.1016/0043-1648(80)90298-4 (the flow of an Eyring oil in closed
form); Yang & Wen, J. Tribol. 112 (1990) 631, doi:10.1115/1.2920308 (generalised Reynolds equation).
"""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from typing import Any, Protocol

import numpy as np

from ..kernels.thinning import stress_of_flow
from .instant import Array, FilmSolution, FilmState, Instant

_STIFFEST = 1e30  # Pa: no stress of a Newtonian oil above matters
_LEAST = (1e-4, 1e-3)  # pressed stress: share of the sheared one, and Pa. Below, the oil yields as at a vanishing one
_LOG_STRESS = np.linspace(np.log(1e-2), np.log(1e11), 8193)  # Pa
_SOLUTIONS = 12  # of a steady film, at most


class Rheology(Protocol):
    """A law of `laws.rheology`."""

    @property
    def thins(self) -> bool:
        """Whether the viscosity falls with the stress."""

    def __call__(self, newtonian: Array, pressure: Array) -> Array:
        """Shear stress [Pa] of that of a Newtonian oil, under a pressure [Pa]."""

    def ease(self, stress: Array) -> Array:
        """How many times easier than a Newtonian one the oil shears at a stress [Pa]."""


def flow_ease(
    rheology: Rheology,
    sliding: float | Array,
    gap: Array,
    pressure: Array,
    spacing: float,
    viscosity: Array,
    reference: Array,
    before: Array | None = None,
) -> Array:
    """`Instant.ease` of a film that was solved under the ease `before` (None: everywhere 1). Arrays [ny, nx].

    sliding [m/s]; gap [m]; fluid pressure [Pa]; spacing of the nodes [m]; Newtonian viscosity [Pa s] at the pressures
    and temperatures of the film, and `reference` [Pa s], that at the pressures and the temperature of the instant.
    """
    warmer = reference / viscosity
    if not rheology.thins:
        return warmer
    along_y, along_x = np.gradient(pressure, spacing)
    pressed = 0.5 * gap * np.hypot(along_x, along_y) / warmer
    if before is not None:
        pressed *= before
    sheared = np.minimum(viscosity * np.abs(sliding) / gap, _STIFFEST)
    pressed = np.clip(pressed, np.maximum(_LEAST[0] * sheared, _LEAST[1]), _STIFFEST)
    unlimited = np.full_like(gap, np.inf)
    upper, lower = rheology(sheared + pressed, unlimited), rheology(sheared - pressed, unlimited)
    mean, half = 0.5 * (upper + lower), 0.5 * (upper - lower)
    table = (_LOG_STRESS[0], _LOG_STRESS[1] - _LOG_STRESS[0], _log_ease(rheology))
    stress_of_flow(*(field.ravel() for field in (sheared, pressed, mean, half)), *table)
    return warmer * pressed / half


@lru_cache(maxsize=8)
def _log_ease(rheology: Any) -> Array:
    return np.log(rheology.ease(np.exp(_LOG_STRESS)))


def solve_thinning(
    now: Instant,
    solve: Callable[[Instant, FilmState | None], FilmSolution],
    ease_of: Callable[[FilmSolution, Array | None], Array],
    tolerance: float,
) -> FilmSolution:
    """Steady film whose ease fits it: solved anew under the ease of the film before until it stands still.

    `solve` an instant from a film state or from nothing; `ease_of` a film and the ease that it was solved under;
    `tolerance`: relative change of the film, weighted by pressure. What is returned holds the ease it was solved with,
    and the iterations of all solutions. Without a film it is the first solution.
    """
    found = solve(now, None)
    spent, change = found.iterations, np.inf
    for _ in range(_SOLUTIONS - 1):
        if found.route != "mixed":
            return replace(found, iterations=spent)
        now = replace(now, ease=ease_of(found, now.ease))
        before, found = found, solve(now, found.state)
        spent, change = spent + found.iterations, _change(before, found)
        if change < tolerance:
            return replace(found, iterations=spent)
    why = f"the film changes with its ease by {change:.2g} in solution {_SOLUTIONS}, not below {tolerance:g}"
    return replace(found, iterations=spent, converged=False, shortfall="; ".join(filter(None, (found.shortfall, why))))


def _change(before: FilmSolution, found: FilmSolution) -> float:
    """Relative change of the film from one solution to the next, weighted by pressure."""
    weight = found.state.pressure
    return float((weight * np.abs(found.gap - before.gap)).sum() / (weight * found.gap).sum())
