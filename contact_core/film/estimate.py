"""How far the numbers of a grid are from those of a fine one, told from the grid of half its nodes."""

from .instant import FilmSolution, Grid, Instant, Settings
from .outputs import film_outputs
from .routes import coarser, prolonged, solve_film
from .scaled import Scaled

# error of an output over its difference between the two grids: 1/3 at second order, more where little is resolved;
# these cover nine in ten of random contacts of another seed than the one benchmarks/film/error_estimate.py reports
_FACTORS = {"contact_load_ratio": 2.0, "pressure_max": 2.5}
_FACTOR = 1.5  # of the others
_RESOLVED = 3.0  # nodes across the inlet, from which on a grid knows the film
_PARTING = 0.3  # film of smooth bodies over rms roughness, from which on the solids may carry next to nothing


def solve_with_estimate(
    now: Instant, grid: Grid, settings: Settings
) -> tuple[FilmSolution, dict[str, float], dict[str, float]]:
    """Steady film, its outputs, and the half width of the error of each, in its unit.

    What the stopping rule leaves open counts, too: a share of the tolerance in each value. The film of the coarser
    grid, which the estimate needs, is also where that of the finer one may begin.
    """
    instant, coarse = coarser(now, grid)
    bodies = now.load, now.shape.hertz(now.load, now.reduced_modulus)
    before = solve_film(instant, coarse, settings)
    found = solve_film(now, grid, settings, prolonged(before.state, grid.shape))
    values = film_outputs(grid, found.state, found.gap, *bodies)
    less = film_outputs(coarse, before.state, before.gap, *bodies)
    errors = {
        name: _FACTORS.get(name, _FACTOR) * abs(value - less[name]) + settings.tolerance * abs(value)
        for name, value in values.items()
    }
    if found.route == "mixed" and found.inlet_nodes < _RESOLVED:  # both grids may agree on a film that is none
        scaled = Scaled(now, grid, settings)
        for name in ("h_central", "h_c", "h_min", "approach"):  # bodies are as much closer as their film is too thin
            errors[name] = max(errors[name], scaled.smooth_film)
        if scaled.smooth_film > _PARTING * scaled.roughness:
            for name in ("contact_area_ratio", "contact_load_ratio"):
                errors[name] = max(errors[name], values[name])
    return found, values, errors
