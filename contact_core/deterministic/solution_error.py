"""Errors of the contact's solution: by the grid, by the inlet that it cuts off, and by iterations that stop early."""

import math
from collections.abc import Callable, Mapping

from ..film.grid_error import (
    area_error,
    film_error,
    friction_error,
    inlet_error,
    load_ratio_error,
    other_error,
    solids_error,
    tribofilm_error,
    wear_error,
)
from ..film.inlet_loss import NEGLIGIBLE, PEAK
from ..film.lengths import inlet_length
from ..scene import Case
from ..state import Error, Outputs
from .instant import instant_time
from .rolling import beyond_grid

# of an output over roughness: what stricter iterations and shorter steps still change, and what a solution has at most
# that did not converge (`python -m benchmarks.film.time_step`)
_STOPPED, _UNCONVERGED = 0.025, 0.3
# error of W_c by the time step over a hard floor; rms of asperities below the grid over that of the surfaces, by which
# it falls to 1 / e: they soften how contacts begin and end
_HARD, _SOFTENED = 0.2, 0.05
# relative error of W_c by a time step in which the bodies slide past each other by a correlation length; it falls with
# the square of that way
_SLIDING = 0.15
_ON_SOLIDS, _AT_EDGE = 0.5, 0.25  # of rolling resistance: part where solids carry all; of its share beyond the grid
_RELATIVE: dict[str, Callable[[float, float, float], float]] = {
    "h_c": film_error,
    "lambda_ratio": film_error,
    "contact_area_ratio": area_error,
    "friction_solid": solids_error,
    "wear_depth": wear_error,
}
# where the domain cuts the inlet off: outputs that no missing film changes, and those that change by a part of another
# one where all film is missing
_WITHOUT_FILM = {"lambda_conventional", "roughness_1", "roughness_2"}
_PARTS = {
    "approach": (1.0, "h_c"),
    "contact_temperature_max": (1.0, "flash_temperature_rise"),
    "pressure_max": (PEAK, "pressure_max"),
}


def with_errors_of_the_solution(case: Case, out: Outputs, found: Mapping[str, Error]) -> dict[str, Error]:
    """Return errors of outputs, by name and in their units, with those by the grid, the inlet and by iterations.

    What a domain that ends within the inlet takes from the film is left out where it is negligible beside the others.
    """
    rough, film = _by_grid(case)
    share = _step_error(case, out.contact_load_ratio)
    lost, stopped = case.missing_film, _STOPPED + _UNCONVERGED * out.unconverged
    errors = {}
    for name, error in found.items():
        grid, inlet = _half_width(case, out, name, rough, film), _by_inlet(case, out, name, lost)
        early = math.hypot(stopped * abs(getattr(out, name)), _by_step(out, name, share))
        others = error._replace(grid=grid, iteration=early)
        errors[name] = others._replace(inlet=inlet) if inlet > NEGLIGIBLE * others.together else others
    return errors


def _half_width(case: Case, out: Outputs, name: str, rough: float, film: float) -> float:
    """Return the half width of an output by nodes per correlation length and a relative error of the film."""
    value, share = abs(getattr(out, name)), min(out.contact_load_ratio, 1.0)
    if name == "friction_force":
        return friction_error(share, out.friction_solid, out.friction_force - out.friction_solid, rough, film)
    if name == "contact_load_ratio":
        return load_ratio_error(share, rough, film)
    if name == "rolling_resistance":
        return min(math.hypot(film, _ON_SOLIDS * share), 1.0) * value
    if name.startswith("tribofilm_"):
        smoother = name != f"tribofilm_{case.scene.rougher + 1}"
        return tribofilm_error(share, rough, film, smoother=smoother) * value
    relative = _RELATIVE.get(name.removesuffix("_1").removesuffix("_2"), other_error)
    return relative(share, rough, film) * value


def _step_error(case: Case, load_ratio: float) -> float:
    """Return the half width (95 %) of the error of contact_load_ratio by the steps in which contacts begin and end."""
    rms = math.hypot(case.scene.surface_1.rms, case.scene.surface_2.rms)
    if rms == 0.0 or not case.entrained or case.scene.control.driver == "dry":
        return 0.0
    soft = case.microroughness.rms if case.microroughness is not None else 0.0
    slid = abs(case.op.sliding_speed) * instant_time(case) / case.sides[case.scene.rougher].surface.length
    hard, sliding = _HARD * math.exp(-soft / (_SOFTENED * rms)), _SLIDING * min(slid, 1.0) ** 2 * load_ratio
    return min(math.hypot(hard, sliding), load_ratio, 1.0)


def _by_step(out: Outputs, name: str, share: float) -> float:
    """Return the half width of an output by an error of contact_load_ratio, `share`."""
    load_ratio, value = out.contact_load_ratio, abs(getattr(out, name))
    if name == "contact_load_ratio":
        return share
    if name == "friction_force":
        fluid, solid = abs(out.friction_force - out.friction_solid), abs(out.friction_solid)
        return share * abs(solid / max(load_ratio, share, 1e-300) - fluid / max(1.0 - load_ratio, share, 1e-300))
    if name.removesuffix("_1").removesuffix("_2") in ("friction_solid", "contact_area_ratio", "wear_depth"):
        return share / max(load_ratio, share, 1e-300) * value
    return 0.0


def _by_inlet(case: Case, out: Outputs, name: str, lost: float) -> float:
    """Return the half width of an output by film that is missing, over the film that is found."""
    if name in _WITHOUT_FILM:
        return 0.0
    if name == "rolling_resistance":  # its share beyond the grid is added; the edge takes some of what is before it
        return _AT_EDGE * abs(beyond_grid(case, case.grid(case.scene.rows)))
    if name in _PARTS:
        part, of = _PARTS[name]
        return part * lost * abs(getattr(out, of))
    return _half_width(case, out, name, 0.0, lost)


def _by_grid(case: Case) -> tuple[float, float]:
    """Return nodes per correlation length of the rougher body, 0 of smooth ones, and the error of the smooth film."""
    spacing, rougher = case.scene.film.spacing, case.sides[case.scene.rougher].surface
    rough = 0.0 if rougher.smooth else rougher.length / spacing
    if not case.entrained or case.smooth_film <= 0.0:
        return rough, 0.0
    return rough, inlet_error(inlet_length(case.hertz.a, case.shape, case.smooth_film) / spacing)
