"""The variables of a component's FMU: inputs, parameters, outputs, `valid`, time, in order of value references."""

from contact_core.quantities import TABLE, numbers
from fmu_src.variables import CLOCK, Variable, of_number, of_quantity

from .part import Part, start_values


def variables(part: Part) -> tuple[Variable, ...]:
    """Return the variables; index + 1 is the index of the model description."""
    starts = start_values(part)
    return (
        *(of_quantity(q, "input", starts[q.name]) for q in part.inputs),
        *(of_number(name, value, field) for name, value, field in numbers(part) if isinstance(value, float)),
        *(of_quantity(q, "output", 0.0, q.direct, part.at_start) for q in part.responses),
        of_quantity(TABLE["valid"], "output", False, (), part.at_start),
        CLOCK,
    )
