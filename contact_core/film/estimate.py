"""Error estimate of the outputs of a grid, from the grid of half its nodes."""

from .instant import FilmSolution, Grid, Instant, Settings
from .outputs import film_outputs
from .routes import coarser, prolonged, solve_film
from .scaled import Scaled

# error of an output over its difference between the two grids: 1/3 at second order, more where little is resolved;
# these cover nine in ten of random contacts of another seed than the one benchmarks/film/error_estimate.py reports
_FACTORS = {"contact_load_ratio": 2.0, "pressure_max": 2.5}
_FACTOR = 1.5  # of the others
_PARTING = 0.3  # film of smooth bodies over rms roughness, from which on the solids may carry almost nothing


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
    errors = {
        name: _FACTORS.get(name, _FACTOR) * abs(value - less[name]) + settings.tolerance * abs(value)
        for name, value in values.items()
    }
    if not found.resolved:  # both grids may agree on a wrong film
        scaled = Scaled(now, grid, settings)
        for name in ("h_central", "h_c", "h_min", "approach"):  # bodies are closer by as much as their film is too thin
            errors[name] = max(errors[name], scaled.smooth_film)
        if scaled.smooth_film > _PARTING * scaled.roughness:
            for name in ("contact_area_ratio", "contact_load_ratio"):
                errors[name] = max(errors[name], values[name])
    return found, values, errors
