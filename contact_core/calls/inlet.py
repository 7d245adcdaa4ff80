"""What a domain that ends within the inlet takes from the film of a call: in its errors, and as a warning."""

from collections.abc import Mapping
from math import hypot

from ..film.grid_error import area_error, film_error, load_ratio_error
from ..film.inlet_loss import NEGLIGIBLE, PEAK, inlets_before, inlets_for, is_light, lost_film
from ..film.instant import FilmSolution, Grid, Instant
from ..film.lengths import inlet_length
from ..reference import SmoothContact, SmoothLine
from ..shapes import Shape

_FILMS = ("h_central", "h_c", "h_min")
_TOLD, _LEFT = 0.05, 0.01  # missing parts of the film: more than the first is warned of, the way out leaves the second
_OF_ACCURACY = 0.09  # missing film over an accuracy that is asked for: within it, whatever the error by the grid


def extent_before(accuracy: float, a: float, shape: Shape, smooth: SmoothContact | SmoothLine) -> float:
    """Return the extent [m] before the centre that an accuracy needs, of a contact of half width a [m]."""
    inlets = inlets_for(_OF_ACCURACY * accuracy, shape, light=is_light(shape, smooth, None))
    return a + inlets * inlet_length(a, shape, smooth.film)


def with_inlet(
    now: Instant, grid: Grid, found: FilmSolution, values: Mapping[str, float], errors: Mapping[str, float]
) -> tuple[dict[str, float], tuple[str, ...]]:
    """Return half widths of outputs in their units with the film that is missing, and a warning if that is much."""
    shape, a = now.shape, now.shape.hertz(now.load, now.reduced_modulus).a
    smooth = shape.smooth(now.load, now.entrainment_speed, now.viscosity, now.temperature, now.reduced_modulus)
    before = float(-grid.x[0] if now.entrainment_speed > 0.0 else grid.x[-1])
    if found.route != "mixed":
        return dict(errors), ()
    lost, share = lost_film(before, a, shape, smooth, now.supply, now.meniscus), values["contact_load_ratio"]
    parts = {name: film_error(share, 0.0, lost) * values[name] for name in _FILMS}
    parts |= {
        "contact_load_ratio": load_ratio_error(share, 0.0, lost),
        "contact_area_ratio": area_error(share, 0.0, lost) * values["contact_area_ratio"],
        "pressure_max": PEAK * lost * values["pressure_max"],
    }
    both = {
        name: hypot(error, parts[name]) if parts.get(name, 0.0) > NEGLIGIBLE * error else error
        for name, error in errors.items()
    }
    if parts["h_central"] <= _TOLD * values["h_central"]:
        return both, ()
    inlets = inlets_before(before, a, shape, smooth.film)
    enough = a + inlets_for(_LEFT, shape) * inlet_length(a, shape, smooth.film)
    return both, (
        f"The domain ends {inlets:.1f} lengths of the inlet before Hertz's contact: up to "
        f"{parts['h_central'] / values['h_central']:.0%} of h_central are missing, which error_estimate holds. "
        f"Begin the domain {enough:.2g} m before the centre.",
    )
