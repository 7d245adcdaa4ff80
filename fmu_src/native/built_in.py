"""The variables of a native FMU: those of the other flavours, with one value where others would be refused."""

from collections.abc import Collection, Iterable
from dataclasses import replace

from contact_core.scene import Scene

from ..variables import Variable, variables
from .program import own_radii


def native_variables(scene: Scene) -> tuple[Variable, ...]:
    """Return the variables of the native FMU of a scene as hosts see them.

    Parameters, and the radii of a point contact, can only have the values at which they start.
    """
    return built_in(variables(scene), own_radii(scene))


def built_in(table: Iterable[Variable], inputs: Collection[str] = ()) -> tuple[Variable, ...]:
    """Return a table of variables in which the parameters, and the inputs named, are limited to their start values."""
    return tuple(_held(v) if v.causality == "parameter" or v.name in inputs else v for v in table)


def _held(v: Variable) -> Variable:
    text = f"{v.text} (built in: no other value can be set)"
    if v.kind == "String":
        return replace(v, text=text)
    return replace(v, text=text, minimum=float(v.start), maximum=float(v.start))
