"""One steady film to an accuracy: grids from coarse to fine, until the stated errors are within it.

A grid starts from the film of the one before, and the next one is chosen by the error that is left: errors are taken to
fall with the square of the spacing, but no step is finer than a half.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ..errors import ConvergenceError
from .estimate import OnGrid, stated_errors
from .instant import FilmState, Grid, GridStep, Instant, Settings
from .routes import solve_film

Array = NDArray[np.float64]

ASKED = ("h_central", "h_c", "pressure_max", "contact_load_ratio", "contact_area_ratio")
_RATIOS = ASKED[3:]  # their errors are absolute, those of the others relative
_TOLERANCE, _LARGEST_TOLERANCE = 0.1, 3e-3  # of the stopping rule, over the accuracy; and at most
_FINER = 2.0  # largest ratio of the spacings of two grids in a row
_ALLOWANCE = 1.1  # spacing over that at which the error is expected to be within the accuracy
_FAILURES = 2  # grids in a row without a converged film, after which no finer one is tried


@dataclass(frozen=True)
class Refined:
    """The film of the finest grid that converged, its stated errors, and how it was found."""

    best: OnGrid
    errors: dict[str, float]  # half width of each output, in its unit
    steps: tuple[GridStep, ...]
    warnings: tuple[str, ...]


def refined(on: Callable[[Grid], Instant], grids: Sequence[Grid], settings: Settings, accuracy: float) -> Refined:
    """Solve for a steady film on some of the grids, from coarse to fine, until the accuracy is met.

    `on` gives the instant on a grid. A film that has not converged is the answer if no grid has one that has.

    Raises
    ------
    ConvergenceError
        If no film is found on any grid.

    """
    settings = replace(settings, tolerance=min(_TOLERANCE * accuracy, _LARGEST_TOLERANCE))
    solved, others, steps, failed, at = list[OnGrid](), list[OnGrid](), list[GridStep](), 0, 0
    while True:
        before = solved[-1] if solved else None
        try:
            found = _solved(on(grids[at]), grids[at], settings, before)
        except ConvergenceError:
            if not (solved or others) and (failed == _FAILURES - 1 or at == len(grids) - 1):
                raise
            found = None
        converged = found is not None and found.solution.converged
        if found is not None:
            (solved if converged else others).append(found)
        failed = 0 if converged else failed + 1
        output, error = (
            _worst(stated_errors(on(grids[at]), solved, settings), solved[-1]) if converged else ("", np.inf)
        )
        iterations = 0 if found is None else found.solution.iterations
        steps.append(GridStep(grids[at].shape, iterations, converged, output, error))
        if error <= accuracy or at == len(grids) - 1 or failed == _FAILURES:
            break
        at = _next(grids, at, error / accuracy)
    best = solved or others
    errors = stated_errors(on(best[-1].grid), best, settings)
    return Refined(best[-1], errors, tuple(steps), _warnings(accuracy, best[-1], errors, failed))


def moved(state: FilmState, old: Grid, new: Grid) -> FilmState:
    """Return a film state on another grid over the same contact, by linear interpolation."""
    rows, columns = _weights(old.y, new.y), _weights(old.x, new.x)

    def on(field: NDArray[Any]) -> Array:
        return np.ascontiguousarray(rows @ field.astype(np.float64) @ columns.T)

    pressure, fluid, mass = (on(field) for field in (state.pressure, state.fluid, state.mass))
    return FilmState(pressure, fluid, on(state.solid) > 0.5, mass, state.rigid_gap)


def _weights(nodes: Array, at: Array) -> csr_array:
    """Return the matrix of linear interpolation from nodes to places; constant beyond the nodes."""
    place = np.zeros(at.size)
    if nodes.size > 1:
        place = np.clip((at - nodes[0]) / (nodes[-1] - nodes[0]) * (nodes.size - 1), 0.0, nodes.size - 1.0)
    low = np.minimum(place.astype(np.int64), max(nodes.size - 2, 0))
    high, part, row = np.minimum(low + 1, nodes.size - 1), place - low, np.arange(at.size)
    entries = np.concatenate([1.0 - part, part]), (np.tile(row, 2), np.concatenate([low, high]))
    return csr_array(entries, shape=(at.size, nodes.size))


def _solved(now: Instant, grid: Grid, settings: Settings, before: OnGrid | None) -> OnGrid:
    start = None if before is None else moved(before.solution.state, before.grid, grid)
    return OnGrid.of(now, grid, solve_film(now, grid, settings, start))


def _worst(errors: dict[str, float], found: OnGrid) -> tuple[str, float]:
    """Return the output with the largest error for what is asked of it, and that error."""
    return max(((name, _asked(name, errors, found)) for name in ASKED), key=lambda pair: pair[1])


def _asked(name: str, errors: dict[str, float], found: OnGrid) -> float:
    """Return the error of an output as the accuracy counts it."""
    return errors[name] if name in _RATIOS else errors[name] / abs(found.values[name])


def _next(grids: Sequence[Grid], at: int, excess: float) -> int:
    """Return the grid after grid `at`, whose error is `excess` times the accuracy; infinite if unknown."""
    least = max(_ALLOWANCE * excess**-0.5, 1.0 / _FINER - 1e-3) * grids[at].spacing
    while at + 2 < len(grids) and grids[at + 2].spacing >= least:
        at += 1
    return at + 1


def _warnings(accuracy: float, best: OnGrid, errors: dict[str, float], failed: int) -> tuple[str, ...]:
    missed = [name for name in ASKED if not _asked(name, errors, best) <= accuracy]
    if not missed:
        return ()
    ny, nx = best.grid.shape
    said = ", ".join(f"{_asked(name, errors, best):.2g} of {name}" for name in missed)
    why = "no finer grid gave a converged film" if failed else "no finer grid is tried"
    return (f"accuracy = {accuracy:g} is not reached: the stated error on {ny} by {nx} nodes is {said}; {why}.",)
