"""Error estimate of the outputs of a grid, from coarser grids."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from ..kernels.arrays import Array
from .grid_steps import area_by_chance
from .instant import FilmSolution, Grid, Instant, Settings
from .outputs import film_outputs
from .routes import coarser, prolonged, solve_film
from .scaled import Scaled

# error of an output over its difference between the two grids: 1/3 at second order, more where little is resolved;
# these cover nine in ten of random contacts of another seed than the one benchmarks/film/error_estimate.py reports
_UPWIND = {"contact_load_ratio": 2.0, "pressure_max": 2.5}, 1.5  # by name, and of the others
_FITTED = {"h_central": 0.5, "approach": 0.5, "contact_load_ratio": 2.0, "pressure_max": 2.0}, 1.0
# of a sequence of grids: error over that at first order, for the larger of the differences to two coarser grids. Two
# differences rarely both miss an error; with one alone the error is larger. The order that three grids show does not
# sharpen this: where it is clean the factors could fall, but coincidences look clean, too
_SEQUENCE = {"h_c": 1.1, "pressure_max": 1.0, "contact_load_ratio": 0.5, "contact_area_ratio": 0.9, "approach": 0.6}
_SEQUENCE_OTHERS, _ONE_DIFFERENCE = 1.2, 2.5
_HALF_RESOLVED = 0.5  # nodes across the inlet, below which flow fitted to cells may miss the whole film
_BELOW_FLOOR = 0.5  # film of smooth bodies over the floor, below which it carries next to nothing
_PARTING = 0.3  # film of smooth bodies over rms roughness, from which on the solids may carry almost nothing


class Outputs(Protocol):
    """Outputs of a solution on one grid."""

    @property
    def spacing(self) -> float:
        """Distance between nodes [m]."""

    @property
    def values(self) -> Mapping[str, float]:
        """Outputs by name."""

    @property
    def area_by_chance(self) -> float:
        """Part of contact_area_ratio that is chance, as `grid_steps.area_by_chance`."""


@dataclass(frozen=True)
class OnGrid:
    """A film on one grid, and its outputs."""

    grid: Grid
    solution: FilmSolution
    values: dict[str, float]
    area_by_chance: float

    @staticmethod
    def of(now: Instant, grid: Grid, found: FilmSolution) -> "OnGrid":
        """Return the film of an instant with its outputs."""
        hertz = now.shape.hertz(now.load, now.reduced_modulus)
        values = film_outputs(grid, found.state, found.gap, found.touching, now.load, hertz)
        return OnGrid(grid, found, values, area_by_chance(found.touching > 0.0, grid.cell, hertz.area))

    @property
    def spacing(self) -> float:
        """Distance between nodes [m]."""
        return self.grid.spacing

    @property
    def nodes(self) -> tuple[int, int]:
        """Nodes along y and along x."""
        return self.grid.shape

    @property
    def converged(self) -> bool:
        """True if the film has converged."""
        return self.solution.converged

    @property
    def iterations(self) -> int:
        """Iterations on this grid."""
        return self.solution.iterations


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
    found = solve_film(now, grid, replace(settings, patient=True), prolonged(before.state, grid.shape))
    values = film_outputs(grid, found.state, found.gap, found.touching, *bodies)
    less = film_outputs(coarse, before.state, before.gap, before.touching, *bodies)
    factors, factor = _FITTED if settings.fitted else _UPWIND
    errors = {
        name: factors.get(name, factor) * abs(value - less[name]) + settings.tolerance * abs(value)
        for name, value in values.items()
    }
    if not (found.touching > 0.0).any():  # two grids may miss the bottom of a valley by as much
        errors["h_min"] = max(errors["h_min"], between_nodes(found.gap))
    _widen(errors, now, grid, found, values, settings)
    return found, values, errors


def between_nodes(gap: Array) -> float:
    """Return by how much nodes miss the smallest gap [m] about.

    Half of what a parabola rises on the way to its nearest nodes, from half way between them along both axes. The
    valleys of smooth contacts, in their side lobes, are narrow: benchmarks/film/flux_valleys.py.
    """
    at = np.unravel_index(gap.argmin(), gap.shape)
    bend = 0.0
    for axis, (k, nodes) in enumerate(zip(at, gap.shape, strict=True)):
        if nodes > 2:
            line = np.moveaxis(gap, axis, 0)[:, at[1 - axis]]
            middle = min(max(int(k), 1), nodes - 2)
            bend += abs(line[middle - 1] - 2.0 * line[middle] + line[middle + 1])
    return float(bend) / 16.0


def stated_errors(solved: Sequence[Outputs], tolerance: float) -> dict[str, float]:
    """Return the half width of the error of each output of the last of the grids, in its unit.

    From its differences to the two grids before, which are coarser; infinite for a single grid.
    """
    found, less = solved[-1], solved[-3:-1]
    alone = _ONE_DIFFERENCE if len(less) == 1 else 1.0
    errors = {}
    for name, value in found.values.items():
        apart = [abs(value - one.values[name]) / (one.spacing / found.spacing - 1.0) for one in less]
        factor = alone * _SEQUENCE.get(name, _SEQUENCE_OTHERS)
        errors[name] = factor * max(apart, default=np.inf) + tolerance * abs(value)
    errors["contact_area_ratio"] += found.area_by_chance
    return errors


def stated_errors_of_film(now: Instant, solved: Sequence[OnGrid], settings: Settings) -> dict[str, float]:
    """Return the same of films; `now` is the instant on the last grid."""
    errors = stated_errors(solved, settings.tolerance)
    last = solved[-1]
    _widen(errors, now, last.grid, last.solution, last.values, settings)
    return errors


def _widen(
    errors: dict[str, float],
    now: Instant,
    grid: Grid,
    found: FilmSolution,
    values: Mapping[str, float],
    settings: Settings,
) -> None:
    """Raise errors to what an unresolved inlet may hide: all grids may agree on a wrong film."""
    if found.resolved:
        return
    scaled = Scaled(now, grid, settings)
    if scaled.smooth_film < _BELOW_FLOOR * settings.floor:  # it lifts no solid
        return
    missed = min((_HALF_RESOLVED / found.inlet_nodes) ** 2, 1.0) if settings.fitted else 1.0
    for name in ("h_central", "h_c", "h_min", "approach"):  # bodies are closer by as much as their film is too thin
        errors[name] = max(errors[name], missed * scaled.smooth_film)
    if scaled.smooth_film > _PARTING * scaled.roughness:
        for name in ("contact_area_ratio", "contact_load_ratio"):
            errors[name] = max(errors[name], values[name])
