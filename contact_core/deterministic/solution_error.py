"""Errors of the contact's solution: by the grid, and by iterations that stop early."""

from collections.abc import Mapping

from ..film.grid_error import grid_error
from ..film.lengths import inlet_length
from ..scene import Case
from ..state import Error, Outputs

_STOPPED = 0.01  # of an output: what four times as many iterations still change over roughness
_UNCONVERGED = 0.3  # of an output that a solution has which did not converge


def with_errors_of_the_solution(case: Case, out: Outputs, found: Mapping[str, Error]) -> dict[str, Error]:
    """Return errors of outputs, by name and in their units, with those by the grid and by iterations."""
    rough, inlet = _nodes(case)
    share = min(out.contact_load_ratio, 1.0)
    stopped = _STOPPED + _UNCONVERGED * out.unconverged
    errors = {}
    for name, error in found.items():
        value = abs(getattr(out, name))
        by_grid = grid_error(name, rough, inlet, share)
        errors[name] = error._replace(grid=by_grid * value, iteration=stopped * value)
    return errors


def _nodes(case: Case) -> tuple[float, float]:
    """Return the nodes per correlation length of the rougher body, and across the inlet; 0 without any."""
    spacing, rougher = case.scene.film.spacing, case.sides[case.scene.rougher].surface
    rough = 0.0 if rougher.smooth else rougher.length / spacing
    if not case.entrained or case.smooth_film <= 0.0:
        return rough, 0.0
    return rough, inlet_length(case.hertz.a, case.shape, case.smooth_film) / spacing
