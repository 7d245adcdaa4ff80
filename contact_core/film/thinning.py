"""Flow of oil through a film in which shear thins it or heat warms it.

A generalised Newtonian oil is sheared by sliding and by its pressure gradient together. Across a film of thickness h
the stress is tau_m + z grad p, |z| < h/2, and the rate of shear E(|tau|) tau / eta. The sliding speed, integral of
the rate, and the pressure flow, integral of -z times the rate, determine tau_m and grad p. The oil flows as if its
fluidity were 1/eta times that flow over what the same gradient drives at constant viscosity, -(h^3 / 12 eta) grad p.

Two choices let repeated solutions converge. The flow is that of the present film, not its gradient: continuity fixes
the flow, whatever the oil, and stresses stay finite where pressures jump. And the fluidity that shear adds is kept, not
its ratio to 1/eta: under high shear, an oil flows nearly independently of its pressure (Eyring's: tau_E h / sliding
speed for its viscosity), so that the sum stays right where pressures change by the next solution.

One fluidity serves both directions: that of a gradient along the sliding speed, with the size of grad p. It is exact in
pure rolling, and along x. Across a fast sliding film it is too large: by the ratio of tangent to secant of the flow
curve, which is 1/n for a power n and x coth x for an Eyring oil at x times its stress.

The limiting stress is left out: where it acts the oil does not flow under pressure but slips.

Sources: Yang & Wen, J. Tribol. 112 (1990) 631, doi:10.1115/1.2920308 (generalised Reynolds equation); Conry, Wang &
Cusano, J. Tribol. 109 (1987) 648 (an Eyring oil, in closed form).
"""

from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np

from ..kernels.arrays import Array
from ..laws.base import Rheology
from .instant import FilmSolution, FilmState, Instant

_STIFFEST = 1e30  # Pa: no stress of a Newtonian oil above matters
_LEAST = (1e-4, 1e-3)  # pressed stress: share of the sheared one, and Pa. Below, the oil yields as at a vanishing one
_LOG_STRESS = np.linspace(np.log(1e-2), np.log(1e11), 8193)  # Pa
_SOLUTIONS = 20  # of a steady film, at most
_SLOW = 0.9  # of the change before, above which under-relaxation halves the steps


def thinned_fluidity(
    rheology: Rheology,
    sliding: float | Array,
    gap: Array,
    pressure: Array,
    spacing: float,
    viscosity: Array,
    flowing: Array | None = None,
) -> Array:
    """Return the fluidity that shear adds to the oil at every node [1/(Pa s)]: `Instant.thinned`.

    Arrays [ny, nx]. Zero where no pressure drives a flow.

    sliding [m/s]; gap [m]; fluid pressure [Pa]; spacing of the nodes [m]; Newtonian viscosity [Pa s] at the pressures
    and temperatures of the film; `flowing`: fluidity that the film was solved with, None for 1 / viscosity.
    """
    if not rheology.thins:
        return np.zeros_like(gap)
    from ..kernels.thinning import stress_of_flow  # the kernels: loaded where an oil is thinned

    thinned, steepness = np.zeros_like(gap), _steepness(pressure, spacing)
    driven = steepness > 0.0
    newtonian = viscosity[driven]
    sheared = np.minimum(newtonian * np.abs(np.broadcast_to(sliding, gap.shape)[driven]) / gap[driven], _STIFFEST)
    pressed = 0.5 * gap[driven] * steepness[driven]
    if flowing is not None:
        pressed *= newtonian * flowing[driven]
    pressed = np.clip(pressed, np.maximum(_LEAST[0] * sheared, _LEAST[1]), _STIFFEST)
    unlimited = np.full_like(pressed, np.inf)
    upper, lower = rheology(sheared + pressed, unlimited), rheology(sheared - pressed, unlimited)
    mean, half = 0.5 * (upper + lower), 0.5 * (upper - lower)
    table = (_LOG_STRESS[0], _LOG_STRESS[1] - _LOG_STRESS[0], _log_ease(rheology))
    stress_of_flow(sheared, pressed, mean, half, *table)
    thinned[driven] = np.maximum(pressed / half - 1.0, 0.0) / newtonian
    return thinned


def eased(
    now: Instant,
    found: FilmSolution,
    rheology: Rheology,
    sliding: float | Array,
    spacing: float,
    viscosity: Array | None = None,
) -> Instant:
    """Return the instant with the ease and the thinning of a film `found` for it, or for one before.

    sliding [m/s]; spacing of the nodes [m]; `viscosity`: of the Newtonian oil at the pressures of the film and its
    temperatures [Pa s], None: at that of the instant. An oil that neither thins nor is warmer leaves the instant as it
    is, and so does a contact without a film.
    """
    if found.route != "mixed" or (viscosity is None and not rheology.thins):
        return now
    state = found.state
    reference = now.viscosity(state.fluid, now.temperature)
    ease = None if viscosity is None else reference / viscosity
    thinned = None
    if rheology.thins:
        viscosity, flowing = reference if viscosity is None else viscosity, state.ease / reference + state.thinned
        thinned = thinned_fluidity(rheology, sliding, found.gap, state.fluid, spacing, viscosity, flowing)
    return replace(now, ease=ease, thinned=thinned)


def remembering(found: FilmSolution, then: Instant) -> FilmSolution:
    """Return a film whose state holds the oil of the next instant, `then`."""
    ease = np.ones((1, 1)) if then.ease is None else then.ease
    thinned = np.zeros((1, 1)) if then.thinned is None else then.thinned
    return replace(found, state=replace(found.state, ease=ease, thinned=thinned))


def recalled(now: Instant, state: FilmState) -> Instant:
    """Return the instant with the oil that a film state holds."""
    ease, thinned = (field if field.size > 1 else None for field in (state.ease, state.thinned))
    return replace(now, ease=ease, thinned=thinned)


def _steepness(pressure: Array, spacing: float) -> Array:
    """Return the size of the pressure gradient of every node [Pa/m].

    It is the root mean square of the slopes to the neighbours: a central difference would miss the flow between the
    node of a peak and its neighbours.
    """
    square = np.zeros_like(pressure)
    for axis in range(2):
        if pressure.shape[axis] == 1:  # the one row of a line
            continue
        slope_2 = np.moveaxis((np.diff(pressure, axis=axis) / spacing) ** 2, axis, 0)
        sums = np.moveaxis(square, axis, 0)  # a view
        sums[:-1] += slope_2
        sums[1:] += slope_2
        sums[[0, -1]] += slope_2[[0, -1]]  # a node of the edge has one neighbour
    return np.sqrt(0.5 * square)


@lru_cache(maxsize=8)
def _log_ease(rheology: Any) -> Array:
    return np.log(rheology.ease(np.exp(_LOG_STRESS)))


class Agreement:
    """How a steady film and its oil come to agree: solved again and again, each time with the oil of the film before.

    `tolerance`: relative change of the film, weighted by pressure.
    """

    def __init__(self, tolerance: float) -> None:
        self._tolerance, self._part, self._change = tolerance, 1.0, np.inf
        self._last: FilmSolution | None = None
        self._spent = self._solutions = 0
        self._holds = False

    def asks_for_more(self, found: FilmSolution) -> bool:
        """Take a solution; return True if another one is needed, and permitted."""
        before, self._last = self._last, found
        self._spent += found.iterations
        self._solutions += 1
        if before is not None:
            last, self._change = self._change, _change(before, found)
            self._holds = self._change < self._tolerance * self._part
            if self._change > _SLOW * last:
                self._part *= 0.5
        return not self._holds and self._solutions < _SOLUTIONS

    def towards(self, now: Instant, then: Instant) -> Instant:
        """Return the instant to solve next: now, with some or all of the change to its oil `then`."""
        return _between(now, then, self._part)

    def film(self, found: FilmSolution) -> FilmSolution:
        """Return the last solution, with the oil it was solved with and the iterations of all."""
        found = replace(found, iterations=self._spent)
        if self._holds or self._solutions < _SOLUTIONS:
            return found
        change = f"the film changes with its oil by {self._change:.2g} in solution {_SOLUTIONS}"
        why = f"{change}, not below {self._tolerance:g}"
        return replace(found, converged=False, shortfall="; ".join(filter(None, (found.shortfall, why))))


def _between(now: Instant, then: Instant, part: float) -> Instant:
    """Return an instant a `part` of the change to the oil of another one."""
    ease, thinned = then.ease, then.thinned
    if now.ease is not None and ease is not None:
        ease = now.ease + part * (ease - now.ease)
    if now.thinned is not None and thinned is not None:
        thinned = now.thinned + part * (thinned - now.thinned)
    return replace(then, ease=ease, thinned=thinned)


def _change(before: FilmSolution, found: FilmSolution) -> float:
    """Return the relative change of the film from one solution to the next, weighted by pressure."""
    weight = found.state.pressure
    return float((weight * np.abs(found.gap - before.gap)).sum() / (weight * found.gap).sum())
