"""The record of how a solution converged, shared by the results of kernels, films, instants and calls."""

from dataclasses import dataclass, fields
from typing import Any


@dataclass(frozen=True, kw_only=True)
class SolverConvergence:
    """Convergence as an algorithm reports it."""

    converged: bool
    shortfall: str  # why it is not converged, empty if it is
    iterations: int
    pressure_change: float  # by the last iteration, relative
    load_error: float  # relative
    complementarity: float  # mean distance of solid contacts from the floor, weighted by pressure, in floors
    imbalance: float  # mass that the film gains or loses without a cause, relative

    @property
    def convergence(self) -> dict[str, Any]:
        """Fields of this record by name, for a result that takes them over."""
        return {field.name: getattr(self, field.name) for field in fields(SolverConvergence)}


@dataclass(frozen=True, kw_only=True)
class Convergence(SolverConvergence):
    """Route, algorithm and convergence of the film of one contact at one instant."""

    route: str  # "mixed", "dry" (asked for, or no entrainment), "fallback" (dry, no film was found) or "open" (no load)
    algorithm: str  # row of `film.routes.REGIMES` and its algorithm that found the film: "smooth: multigrid from none"
    load_beyond: float  # share of the load that a film wider than the grid carries beyond its edge
    inlet_nodes: float  # grid nodes across the inlet zone of the film
    resolved: bool  # True if those are enough for a film that does not depend on the grid

    @property
    def convergence(self) -> dict[str, Any]:
        """Fields of this record by name, for a result that takes them over."""
        return {field.name: getattr(self, field.name) for field in fields(Convergence)}
