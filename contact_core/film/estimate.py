"""Error estimate of the outputs of a grid, from the grid of half its nodes."""

from .instant import FilmSolution, Grid, Instant, Settings
from .outputs import film_outputs
from .routes import coarser, prolonged, solve_film
from .scaled import Scaled

# error of an output over its difference between the two grids: 1/3 at second order, more where little is resolved;
# these cover nine in ten of random contacts of another seed than the one benchmarks/film/error_estimate.py reports
_UPWIND = {"contact_load_ratio": 2.0, "pressure_max": 2.5}, 1.5  # by name, and of the others
_FITTED = {"h_central": 0.5, "approach": 0.5, "contact_load_ratio": 2.0, "pressure_max": 2.0}, 1.0
_HALF_RESOLVED = 0.5  # nodes across the inlet, below which flow fitted to cells may miss the whole film
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
    factors, factor = _FITTED if settings.fitted else _UPWIND
    errors = {
        name: factors.get(name, factor) * abs(value - less[name]) + settings.tolerance * abs(value)
        for name, value in values.items()
    }
    if not found.resolved:  # both grids may agree on a wrong film
        scaled = Scaled(now, grid, settings)
        missed = min((_HALF_RESOLVED / found.inlet_nodes) ** 2, 1.0) if settings.fitted else 1.0
        for name in ("h_central", "h_c", "h_min", "approach"):  # bodies are closer by as much as their film is too thin
            errors[name] = max(errors[name], missed * scaled.smooth_film)
        if scaled.smooth_film > _PARTING * scaled.roughness:
            for name in ("contact_area_ratio", "contact_load_ratio"):
                errors[name] = max(errors[name], values[name])
    return found, values, errors
