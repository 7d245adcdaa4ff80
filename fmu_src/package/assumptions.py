"""What the assumptions of a scene are worth, in the descriptions of the outputs of its FMU."""

from collections.abc import Iterable
from dataclasses import replace

from contact_core.assumed import LEAST, assumed, text
from contact_core.errors import ContactError
from contact_core.scene import Scene

from ..variables import Variable


def with_assumptions(scene: Scene, table: Iterable[Variable]) -> tuple[Variable, ...]:
    """Return the variables with the half widths by what the scene assumes, at its own operating point, in words."""
    try:
        worth = assumed(scene, scene.operation.point)
    except ContactError:  # the regression level has no answer there
        return tuple(table)
    halves = {name: text(name, each.together) for name, each in worth.items() if each.together >= LEAST[name]}
    return tuple(replace(v, text=f"{v.text}{_words(v, halves)}") for v in table)


def _words(variable: Variable, halves: dict[str, str]) -> str:
    output = variable.name.removesuffix("_1").removesuffix("_2")
    if variable.causality != "output" or output not in halves:
        return ""
    return f"; by what the scene assumes +- {halves[output]} at its own operating point"
