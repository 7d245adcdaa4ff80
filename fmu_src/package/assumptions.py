"""What the assumptions of a scene are worth, in the descriptions of the outputs of its FMU."""

from collections.abc import Iterable
from dataclasses import replace

from contact_core.assumed import OUTPUTS, assumed
from contact_core.errors import ContactError
from contact_core.quantities import ABSOLUTE, STATED
from contact_core.scene import Scene

from ..variables import Variable

_LEAST = 1e-3  # half width that is told


def with_assumptions(scene: Scene, table: Iterable[Variable]) -> tuple[Variable, ...]:
    """Return the variables with the half widths by what the scene assumes, at its own operating point, in words."""
    try:
        worth = assumed(scene, scene.operation.point)
    except ContactError:  # the regression level has no answer there
        return tuple(table)
    halves = {output: worth[output].together for output in OUTPUTS if worth[output].together >= _LEAST}
    return tuple(replace(v, text=f"{v.text}{_words(v, halves)}") for v in table)


def _words(variable: Variable, halves: dict[str, float]) -> str:
    output = variable.name.removesuffix("_1").removesuffix("_2")
    if variable.causality != "output" or output not in halves:
        return ""
    half = halves[output]
    said = f"{half:.2g}" if STATED.get(variable.name) in ABSOLUTE else f"{100.0 * half:.2g} %"
    return f"; by what the scene assumes +- {said} at its own operating point"
