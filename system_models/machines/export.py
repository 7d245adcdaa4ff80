"""A machine for tools that import SSP: its duty as a component, because SSP knows no schedule.

Not every importer gives the FMUs the parameters of the system: each starts with its own.
"""

from dataclasses import replace

from contact_core.errors import ContactError
from contact_core.quantities import numbers

from ..parts.part import Start
from ..parts.timetable import Entry, Signal, Timetable
from .assembly import Assembly, Schedule, Value

_DUTY = "duty"


def with_timetable(assembly: Assembly) -> Assembly:
    """Return the machine with a component `duty` in place of its schedule; constant signals become parameters."""
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
    for name, part in assembly.parts.items():  # so that the file has them
        constant |= {f"{name}.{key}": value for key, value, _ in numbers(part) if isinstance(value, float)}
    started = {name: replace(part, starts=_starts(name, assembly.schedule)) for name, part in assembly.parts.items()}
    return replace(
        assembly,
        parts={**started, **({_DUTY: Timetable(tuple(signals))} if signals else {})},
        contacts={name: replace(contact, scene=contact.own_scene) for name, contact in assembly.contacts.items()},
        connections=(*assembly.connections, *links),
        parameters={**assembly.parameters, **constant},
        schedule={},
    )


def _starts(part: str, schedule: Schedule) -> tuple[Start, ...]:
    """Return the inputs of a part that the duty sets, as it does at first."""
    first = ((name.partition("."), steps[0][1]) for name, steps in schedule.items())
    return tuple(Start(variable, float(value)) for (owner, _, variable), value in first if owner == part)
