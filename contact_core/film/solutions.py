"""What was found, in SI: a film or the contact without one, and the load that it carries."""

from dataclasses import dataclass, replace

import numpy as np

from ..kernels.arrays import Array
from ..kernels.mixed.problem import Solution
from .instant import FilmSolution, FilmState
from .lengths import inlet_length, resolves_inlet
from .outputs import disc
from .scaled import Scaled
from .starts import shared

LOAD_ACCEPTED = 1e-3  # relative error of the load, up to which a film is accepted
_BEYOND_KNOWN = 0.05  # relative error of the formula for the load beyond the grid


@dataclass(frozen=True)
class LoadBalance:
    """Load that a solution carries, compared with the load it should carry."""

    error: float  # relative
    beyond: float  # share of the load beyond the grid
    apart: float | None  # film [m] of rigid bodies with the gap beyond the grid's edge; None: no load there

    @property
    def holds(self) -> bool:
        """True if the solution carries its load within the known accuracy."""
        return abs(self.error) <= LOAD_ACCEPTED + _BEYOND_KNOWN * abs(self.beyond)


def load_balance(scaled: Scaled, found: FilmSolution) -> LoadBalance:
    """Return the load of a solution, summed anew.

    The pressure beyond the grid follows from the gap of the solution itself.
    """
    pressure, per_load = found.state.pressure, scaled.grid.cell / scaled.now.load
    beyond = (scaled.beyond[1] - 1.0) * pressure
    if not beyond.any():
        return LoadBalance(float(pressure.sum()) * per_load - 1.0, 0.0, None)
    shape = scaled.now.shape.gap(scaled.x, scaled.y, scaled.size) * scaled.h_unit
    least = min(float(shape[[0, -1]].min()), float(shape[:, [0, -1]].min()))
    opened = float((beyond * (found.gap + scaled.now.heights - shape)).sum() / beyond.sum())
    apart = max(opened, -0.5 * least)
    both = scaled.far_field(apart)[1] * pressure
    return LoadBalance(
        error=float(both.sum()) * per_load - 1.0,
        beyond=float((both - pressure).sum()) * per_load,
        apart=apart,
    )


def dry(scaled: Scaled, route: str, share: float = 1.0) -> FilmSolution:
    """Return the contact without a film: its gap is the floor where solids touch.

    Solids carry `share` of the load, oil under a pressure like Hertz's the rest.
    """
    tolerance = 0.1 * scaled.settings.tolerance  # conjugate gradients are cheap, and no later step corrects them
    iterate, converged, iterations = shared(scaled, share, tolerance)
    gap = iterate.rigid + scaled.undeformed + scaled.half_space.deform(iterate.pressure)
    if scaled.give is not None:
        gap += scaled.give.at(iterate.pressure)
    load_error = float(iterate.pressure.sum()) / scaled.load - 1.0
    mass = np.maximum(gap, scaled.floor)
    if scaled.now.supply is not None:
        mass = np.minimum(mass, scaled.now.supply / scaled.h_unit)
    why = "" if converged else f"dry contact not converged to {tolerance:g} after {iterations} iterations"
    found = Solution(
        iterate,
        gap,
        mass,
        converged=converged,
        shortfall=why,
        iterations=iterations,
        pressure_change=tolerance,
        load_error=load_error,
        complementarity=0.0,
        imbalance=0.0,
    )
    return solution(scaled, found, route, "conjugate gradients")


def solution(scaled: Scaled, found: Solution, route: str, algorithm: str) -> FilmSolution:
    """Return a solution in SI."""
    it, gap = found.iterate, np.maximum(found.gap, scaled.floor) * scaled.h_unit
    state = FilmState(
        it.pressure * scaled.p_unit,
        it.fluid * scaled.p_unit,
        it.solid,
        found.mass * scaled.h_unit,
        it.rigid * scaled.h_unit,
        np.ones((1, 1)) if scaled.now.ease is None else scaled.now.ease,
        np.zeros((1, 1)) if scaled.now.thinned is None else scaled.now.thinned,
        gap=gap,
    )
    if scaled.start and scaled.step and scaled.step.order == 2:
        state = replace(state, mass_before=scaled.start.mass, dt=scaled.step.dt)
    capped = it.solid & (it.pressure >= scaled.cap)
    overlap = np.where(capped, np.maximum(scaled.floor - found.gap, 0.0), 0.0) * scaled.h_unit
    if scaled.give is not None:
        overlap += scaled.give.yielded(it.pressure) * scaled.h_unit
    inlet_nodes = _inlet_nodes(scaled, gap)
    return FilmSolution(
        state=state,
        gap=gap,
        overlap=overlap,
        touching=scaled.now.touching(state.pressure - state.fluid),
        route=route,
        algorithm=algorithm,
        load_beyond=1.0 + found.load_error - float(it.pressure.sum()) / scaled.load,
        inlet_nodes=inlet_nodes,
        resolved=route != "mixed" or resolves_inlet(inlet_nodes, fitted=scaled.settings.fitted),
        **found.convergence,
    )


def _inlet_nodes(scaled: Scaled, gap: Array) -> float:
    """Return the nodes across the zone before the contact in which the film builds up."""
    film = float(gap[disc(scaled.grid, scaled.hertz)].mean())
    if scaled.now.entrainment_speed > 0.0:  # roughness holds the gap open, but the inlet is that of the oil's film
        film = min(film, scaled.smooth_film)
    return inlet_length(scaled.a, scaled.now.shape, film) / scaled.grid.spacing
