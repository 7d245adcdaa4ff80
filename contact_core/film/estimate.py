"""How far the numbers of a grid are from those of a fine one, told from the grid of half its nodes."""

from ..reference import Hertz
from .instant import FilmSolution, Grid, Instant, Settings
from .outputs import film_outputs
from .routes import coarser, prolonged, solve_film

_SAFETY = 1.0


def solve_with_estimate(
    now: Instant, grid: Grid, settings: Settings, hertz: Hertz
) -> tuple[FilmSolution, dict[str, float], dict[str, float]]:
    """Steady film, its outputs, and the half width of the error of each, in its unit.

    The film of the coarser grid, which the estimate needs, is also where that of the finer one begins.
    """
    instant, coarse = coarser(now, grid)
    before = solve_film(instant, coarse, settings)
    found = solve_film(now, grid, settings, prolonged(before.state, grid.shape))
    values = film_outputs(grid, found.state, found.gap, now.load, hertz)
    less = film_outputs(coarse, before.state, before.gap, now.load, hertz)
    return found, values, {name: _SAFETY * abs(value - less[name]) for name, value in values.items()}
