"""Signals against time as a component, for importers of SSP, which know no schedule."""

from dataclasses import dataclass
from typing import ClassVar

from contact_core.quantities import parameter

from .part import Input, Output, Part, State, Values


@dataclass(frozen=True)
class Entry:
    """A value that a signal takes at a time and holds until its next entry."""

    time: float = parameter("s", "time from which on the value holds", least=0.0)
    value: float = parameter("", "value in the signal's SI unit")


@dataclass(frozen=True)
class Signal:
    """A signal and its course, by time; before the first entry it has its value."""

    name: str
    unit: str
    entries: tuple[Entry, ...]


@dataclass(frozen=True)
class Timetable(Part):
    """Signals that hold values from given times on."""

    name: ClassVar[str] = "Timetable"
    text: ClassVar[str] = "signals that hold values from given times on"

    signals: tuple[Signal, ...]

    @property
    def inputs(self) -> tuple[Input, ...]:
        return ()

    @property
    def responses(self) -> tuple[Output, ...]:
        return tuple(Output(signal.name, "", signal.unit, f"signal {signal.name}") for signal in self.signals)

    def initial(self, inputs: Values) -> State:
        return (0.0,)

    def advance(self, state: State, inputs: Values, step: float) -> State:
        """Return the time after the step."""
        return (state[0] + step,)

    def outputs(self, state: State, inputs: Values) -> dict[str, float]:
        now = state[0] * (1.0 + 1e-9)
        found = {}
        for signal in self.signals:
            value = signal.entries[0].value
            for entry in signal.entries[1:]:
                if entry.time <= now:
                    value = entry.value
            found[signal.name] = value
        return found
