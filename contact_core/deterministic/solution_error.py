"""Errors of the contact's solution: by the grid, and by iterations that stop early."""

from collections.abc import Callable, Mapping

from ..film.grid_error import (
    area_error,
    film_error,
    friction_error,
    load_ratio_error,
    other_error,
    solids_error,
    tribofilm_error,
    wear_error,
)
from ..film.lengths import inlet_length
from ..scene import Case
from ..state import Error, Outputs

# of an output over roughness: what four times as many iterations still change, and what a solution has at most that did
# not converge
_STOPPED, _UNCONVERGED = 0.01, 0.3
_RELATIVE: dict[str, Callable[[float, float, float], float]] = {
    "h_c": film_error,
    "lambda_ratio": film_error,
    "contact_area_ratio": area_error,
    "friction_solid": solids_error,
    "wear_depth": wear_error,
}


def with_errors_of_the_solution(case: Case, out: Outputs, found: Mapping[str, Error]) -> dict[str, Error]:
    """Return errors of outputs, by name and in their units, with those by the grid and by iterations."""
    nodes, share = _nodes(case), min(out.contact_load_ratio, 1.0)
    rougher = f"tribofilm_{case.scene.rougher + 1}"
    stopped = _STOPPED + _UNCONVERGED * out.unconverged
    errors = {}
    for name, error in found.items():
        value = abs(getattr(out, name))
        if name == "friction_force":
            grid = friction_error(share, out.friction_solid, out.friction_force - out.friction_solid, *nodes)
        elif name == "contact_load_ratio":
            grid = load_ratio_error(share, *nodes)
        elif name.startswith("tribofilm_"):
            grid = tribofilm_error(share, *nodes, smoother=name != rougher) * value
        else:
            relative = _RELATIVE.get(name.removesuffix("_1").removesuffix("_2"), other_error)
            grid = relative(share, *nodes) * value
        errors[name] = error._replace(grid=grid, iteration=stopped * value)
    return errors


def _nodes(case: Case) -> tuple[float, float]:
    """Return the nodes per correlation length of the rougher body, and across the inlet; 0 without any."""
    spacing, rougher = case.scene.film.spacing, case.sides[case.scene.rougher].surface
    rough = 0.0 if rougher.smooth else rougher.length / spacing
    if not case.entrained or case.smooth_film <= 0.0:
        return rough, 0.0
    return rough, inlet_length(case.hertz.a, case.shape, case.smooth_film) / spacing
