"""A machine for tools that import SSP: its duty as a component, because SSP knows no schedule."""

from dataclasses import replace

from contact_core.errors import ContactError
from contact_core.quantities import numbers

from ..parts.timetable import Entry, Signal, Timetable
from .assembly import Assembly, Value

_DUTY = "duty"


def with_timetable(assembly: Assembly) -> Assembly:
    """The machine with a component `duty` in place of its schedule; what never changes becomes a parameter."""
    units = {f"{name}.{q.name}": q.unit for name, part in assembly.parts.items() for q in part.inputs}
    constant: dict[str, Value] = {}
    signals, links = [], []
    for name, steps in assembly.schedule.items():
        if len(steps) == 1:
            constant[name] = steps[0][1]
            continue
        if name not in units:
            raise ContactError(f"'{name}' is no input of a component, and changes: it cannot be exported.")
        signal = name.replace(".", "_")
        entries = tuple(Entry(float(time), float(value)) for time, value in steps)
        signals.append(Signal(signal, units[name], entries))
        links.append((f"{_DUTY}.{signal}", name))
    for name, part in assembly.parts.items():  # so that the file tells them
        constant |= {f"{name}.{key}": value for key, value, _ in numbers(part) if isinstance(value, float)}
    parts = {**assembly.parts, **({_DUTY: Timetable(tuple(signals))} if signals else {})}
    return replace(
        assembly,
        parts=parts,
        connections=(*assembly.connections, *links),
        parameters={**assembly.parameters, **constant},
        schedule={},
    )
