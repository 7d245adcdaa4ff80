"""Solution of one instant to an accuracy: grids from coarse to fine, until the stated errors are within it.

The next grid is chosen by the error that is left: errors are taken to fall with the square of the spacing, but no step
is finer than a half.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Generic, Protocol, TypeVar

import numpy as np
import scipy  # its parts are loaded at their first use
from numpy.typing import NDArray

from ..errors import ConvergenceError
from ..kernels.arrays import Array
from .estimate import OnGrid, Outputs, stated_errors_of_film
from .grid_steps import GridStep
from .instant import FilmState, Grid, Instant, Settings
from .routes import solve_film

_RELATIVE, _ABSOLUTE = ("h_central", "h_c", "pressure_max"), ("contact_load_ratio", "contact_area_ratio")
_TOLERANCE, _LARGEST_TOLERANCE = 0.1, 3e-3  # of the stopping rule, over the accuracy; and at most
_ABOUT = 1.0 + 1e-6  # for spacings that are equal but for rounding
_FINER = 2.0  # largest ratio of the spacings of two grids in a row
_ALLOWANCE = 1.1  # spacing over that at which the error is expected to be within the accuracy
_FAILURES = {True: 2, False: 3}  # grids in a row without a converged solution, by whether one had any, that are tried


class Solved(Outputs, Protocol):
    """A solution on one grid."""

    @property
    def nodes(self) -> tuple[int, int]:
        """Nodes along y and along x."""

    @property
    def converged(self) -> bool:
        """True if it has converged."""

    @property
    def iterations(self) -> int:
        """Iterations on this grid."""


Found = TypeVar("Found", bound=Solved)


@dataclass(frozen=True)
class Refined(Generic[Found]):
    """The solution on the finest grid that converged, its stated errors, and how it was found."""

    best: Found
    errors: dict[str, float]  # half width of each output, in its unit
    steps: tuple[GridStep, ...]
    warnings: tuple[str, ...]


@dataclass(frozen=True)
class Request:
    """An accuracy, and the outputs whose relative and whose absolute errors it bounds.

    No grid with a spacing above `coarsest` [m] is an answer: it does not show the surface, and may agree with others.
    """

    accuracy: float
    relative: tuple[str, ...] = _RELATIVE
    absolute: tuple[str, ...] = _ABSOLUTE
    coarsest: float = np.inf

    def errors(self, errors: dict[str, float], found: Outputs) -> dict[str, float]:
        """Return the errors of these outputs as the accuracy counts them."""
        relative = {name: errors[name] / abs(found.values[name]) for name in self.relative}
        return relative | {name: errors[name] for name in self.absolute}


def refined(
    spacings: Sequence[float],
    solve: Callable[[int, Found | None], Found],
    stated: Callable[[Sequence[Found]], dict[str, float]],
    request: Request,
) -> Refined[Found]:
    """Solve on some of the grids, from coarse to fine, until the stated errors are within the request.

    `solve` gives the solution on a grid by its number and that on the grid before; `stated` the errors of the last of
    some grids. A solution that has not converged is the answer if no grid has one that has.

    Raises
    ------
    ConvergenceError
        If no solution is found on any grid.

    """
    solved, others, steps, failed, at = list[Found](), list[Found](), list[GridStep](), 0, 0
    while True:
        try:
            found = solve(at, solved[-1] if solved else None)
        except ConvergenceError:
            failed += 1
            if failed == _FAILURES[bool(solved)] or at == len(spacings) - 1:
                if not (solved or others):
                    raise
                break
            at = _next(spacings, at, np.inf)
            continue
        (solved if found.converged else others).append(found)
        failed = 0 if found.converged else failed + 1
        output, error = "", np.inf
        if found.converged:
            errors = request.errors(stated(solved), found)
            output = max(errors, key=lambda name: errors[name])
            error = errors[output]
        steps.append(GridStep(found.nodes, found.iterations, found.converged, output, error))
        shown = found.spacing <= _ABOUT * request.coarsest
        if (shown and error <= request.accuracy) or at == len(spacings) - 1 or failed == _FAILURES[bool(solved)]:
            break
        at = _next(spacings, at, error / request.accuracy if shown else np.inf)
    best = solved or others
    # grids without a converged solution say nothing of the error, however well they agree
    errors = stated(solved) if solved else dict.fromkeys(best[-1].values, np.inf)
    finest = at == len(spacings) - 1
    return Refined(best[-1], errors, tuple(steps), _warnings(request, best[-1], errors, failed, finest))


def refined_film(
    on: Callable[[Grid], Instant], grids: Sequence[Grid], settings: Settings, request: Request
) -> Refined[OnGrid]:
    """Solve for a steady film to an accuracy; `on` gives the instant on a grid. As `refined`."""
    settings = replace(settings, tolerance=min(_TOLERANCE * request.accuracy, _LARGEST_TOLERANCE))

    def solve(at: int, before: OnGrid | None) -> OnGrid:
        start = None if before is None else moved(before.solution.state, before.grid, grids[at])
        now = on(grids[at])
        return OnGrid.of(now, grids[at], solve_film(now, grids[at], settings, start))

    def stated(solved: Sequence[OnGrid]) -> dict[str, float]:
        return stated_errors_of_film(on(solved[-1].grid), solved, settings)

    return refined([grid.spacing for grid in grids], solve, stated, request)


def moved(state: FilmState, old: Grid, new: Grid) -> FilmState:
    """Return a film state on another grid over the same contact, by linear interpolation."""
    rows, columns = _weights(old.y, new.y), _weights(old.x, new.x)

    def on(field: NDArray[Any]) -> Array:
        return np.ascontiguousarray(rows @ field.astype(np.float64) @ columns.T)

    pressure, fluid, mass = (on(field) for field in (state.pressure, state.fluid, state.mass))
    return FilmState(pressure, fluid, on(state.solid) > 0.5, mass, state.rigid_gap)


def _weights(nodes: Array, at: Array) -> "scipy.sparse.csr_array":
    """Return the matrix of linear interpolation from nodes to places; constant beyond the nodes."""
    place = np.zeros(at.size)
    if nodes.size > 1:
        place = np.clip((at - nodes[0]) / (nodes[-1] - nodes[0]) * (nodes.size - 1), 0.0, nodes.size - 1.0)
    low = np.minimum(place.astype(np.int64), max(nodes.size - 2, 0))
    high, part, row = np.minimum(low + 1, nodes.size - 1), place - low, np.arange(at.size)
    entries = np.concatenate([1.0 - part, part]), (np.tile(row, 2), np.concatenate([low, high]))
    return scipy.sparse.csr_array(entries, shape=(at.size, nodes.size))


def _next(spacings: Sequence[float], at: int, excess: float) -> int:
    """Return the grid after grid `at`, whose error is `excess` times the accuracy; infinite if unknown."""
    least = max(_ALLOWANCE * excess**-0.5, 1.0 / _FINER - 1e-3) * spacings[at]
    while at + 2 < len(spacings) and spacings[at + 2] >= least:
        at += 1
    return at + 1


def _warnings(request: Request, best: Solved, errors: dict[str, float], failed: int, finest: bool) -> tuple[str, ...]:
    """Return a sentence if the request is not met."""
    stated = request.errors(errors, best)
    missed = [f"{error:.2g} of {name}" for name, error in stated.items() if not error <= request.accuracy]
    if not missed:
        return ()
    ny, nx = best.nodes
    if not failed:
        why = "this is the finest grid that is tried"
    elif finest:
        why = "no finer grid gave a converged solution"
    else:
        why = f"{failed} grids in a row gave no converged solution, and finer ones were not tried"
    said = f"the stated error on {ny} by {nx} nodes is {', '.join(missed)}"
    if not np.isfinite(list(stated.values())).any():
        said = f"no error can be stated on {ny} by {nx} nodes"
    return (f"accuracy = {request.accuracy:g} is not reached: {said}; {why}.",)
