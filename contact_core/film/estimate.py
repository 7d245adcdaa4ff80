"""Error estimate of the outputs of a grid, from coarser grids."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .instant import FilmSolution, Grid, Instant, Settings
from .outputs import film_outputs
from .routes import coarser, prolonged, solve_film
from .scaled import Scaled

# error of an output over its difference between the two grids: 1/3 at second order, more where little is resolved;
# these cover nine in ten of random contacts of another seed than the one benchmarks/film/error_estimate.py reports
_UPWIND = {"contact_load_ratio": 2.0, "pressure_max": 2.5}, 1.5  # by name, and of the others
_FITTED = {"h_central": 0.5, "approach": 0.5, "contact_load_ratio": 2.0, "pressure_max": 2.0}, 1.0
# the same over the error at second order, for the larger of the differences to two coarser grids
_FACTORS: dict[str, float] = {}
_FACTOR = 2.0
_HALF_RESOLVED = 0.5  # nodes across the inlet, below which flow fitted to cells may miss the whole film
_PARTING = 0.3  # film of smooth bodies over rms roughness, from which on the solids may carry almost nothing


@dataclass(frozen=True)
class OnGrid:
    """A film on one grid, and its outputs."""

    grid: Grid
    solution: FilmSolution
    values: dict[str, float]

    @staticmethod
    def of(now: Instant, grid: Grid, found: FilmSolution) -> "OnGrid":
        """Return the film of an instant with its outputs."""
        hertz = now.shape.hertz(now.load, now.reduced_modulus)
        return OnGrid(grid, found, film_outputs(grid, found.state, found.gap, found.touching, now.load, hertz))


def solve_with_estimate(
    now: Instant, grid: Grid, settings: Settings
) -> tuple[FilmSolution, dict[str, float], dict[str, float]]:
    """Solve for the steady film; return it, its outputs, and the half width of the error of each in its unit.

    The stopping rule adds a share of the tolerance to each error. The film of the coarser grid, which the estimate
    needs, is also the start of the finer one.
    """
    instant, coarse = coarser(now, grid)
    bodies = now.load, now.shape.hertz(now.load, now.reduced_modulus)
    before = solve_film(instant, coarse, settings)
    found = solve_film(now, grid, settings, prolonged(before.state, grid.shape))
    values = film_outputs(grid, found.state, found.gap, found.touching, *bodies)
    less = film_outputs(coarse, before.state, before.gap, before.touching, *bodies)
    factors, factor = _FITTED if settings.fitted else _UPWIND
    errors = {
        name: factors.get(name, factor) * abs(value - less[name]) + settings.tolerance * abs(value)
        for name, value in values.items()
    }
    _widen(errors, now, OnGrid(grid, found, values), settings)
    return found, values, errors


def stated_errors(now: Instant, solved: Sequence[OnGrid], settings: Settings) -> dict[str, float]:
    """Return the half width of the error of each output of the last of the grids, in its unit.

    From its differences to the two grids before, which are coarser: the larger of both errors at second order, times a
    factor. Infinite for a single grid. `now` is the instant on the last one.
    """
    found, coarser_ones = solved[-1], solved[-3:-1]
    errors = {}
    for name, value in found.values.items():
        apart = [
            abs(value - less.values[name]) / ((less.grid.spacing / found.grid.spacing) ** 2 - 1.0)
            for less in coarser_ones
        ]
        factor = _FACTORS.get(name, _FACTOR)
        errors[name] = factor * max(apart, default=np.inf) + settings.tolerance * abs(value)
    _widen(errors, now, found, settings)
    return errors


def _widen(errors: dict[str, float], now: Instant, found: OnGrid, settings: Settings) -> None:
    """Raise errors to what an unresolved inlet may hide: all grids may agree on a wrong film."""
    if found.solution.resolved:
        return
    scaled = Scaled(now, found.grid, settings)
    missed = min((_HALF_RESOLVED / found.solution.inlet_nodes) ** 2, 1.0) if settings.fitted else 1.0
    for name in ("h_central", "h_c", "h_min", "approach"):  # bodies are closer by as much as their film is too thin
        errors[name] = max(errors[name], missed * scaled.smooth_film)
    if scaled.smooth_film > _PARTING * scaled.roughness:
        for name in ("contact_area_ratio", "contact_load_ratio"):
            errors[name] = max(errors[name], found.values[name])
