"""The running FMUs of a system: their values by name, their events, their states."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from typing import Any

import numpy as np
from fmpy.fmi1 import FMICallException

from ..fmu.instance import Instance
from ..fmu.start import started
from .settings import Settings
from .system import Port, System
from .wiring import Wiring, real_inputs, real_outputs


class Running:
    """The FMUs of a system, as they run.

    time in s; outputs: the Real outputs of all FMUs, in the order of the wiring; restores: whether all of them can go
    back to a state. Every method that calls an FMU raises CouplingError if it fails.
    """

    def __init__(self, system: System, recorded: Sequence[Port], settings: Settings, exits: ExitStack) -> None:
        self.system, self.settings = system, settings
        self.restores = all(model.restores for model in system.models.values())
        ports = real_inputs(system), real_outputs(system, list(recorded))
        inputs, outputs = ({name: [port.variable for port in each[name]] for name in system.models} for each in ports)
        self.instances = started(system.models, inputs, outputs, early_return=self.restores, exits=exits)
        self.wiring = Wiring(system, self.instances)
        self.outputs = np.zeros(len(self.wiring.outputs))
        self.time = 0.0

    def set(self, name: str, value: Any) -> None:
        """Set one variable from outside."""
        port = self.system.port(name)
        instance = self.instances[port.model.name]
        with self.named(instance, f"to take '{name}' = {value!r}"):
            instance.set(port.variable, value)

    def get(self, port: Port) -> Any:
        """Return the value of a variable of any type."""
        instance = self.instances[port.model.name]
        with self.named(instance, f"to give '{port.name}'"):
            return instance.get(port.variable)

    def set_scheduled(self, times: Callable[[float], bool]) -> bool:
        """Set inputs to their last scheduled value at such times; return True if there is one."""
        due = {name: value for name, steps in self.system.schedule.items() for at, value in steps if times(at)}
        for name, value in due.items():
            self.set(name, value)
        return bool(due)

    def next_event(self) -> float:
        """Return the time [s] of the first event that an FMU has announced, the latest of those at the same time."""
        announced = [instance.next_event for instance in self.instances.values() if instance.next_event is not None]
        ahead = [time for time in announced if time > self.time]
        first = min(ahead, default=math.inf)
        return max((time for time in ahead if time <= first + self.settings.margin(first)), default=math.inf)

    def read(self, instance: Instance) -> None:
        """Read the outputs of an FMU."""
        with self.named(instance, f"at {self.time:g} s"):
            instance.read()
        self.outputs[self.wiring.output_of[instance.name]] = instance.outputs.values

    def may_lag(self, place: int) -> bool:
        """Return True if an output may still belong to the held inputs, not to those at the end of the step."""
        port = self.system.port(self.wiring.outputs[place])
        direct = port.model.dependencies.get(port.variable.name, True)
        return not direct and not self.instances[port.model.name].interpolates

    def event(self) -> bool:
        """Return True if an FMU has had an event of its own in the last step."""
        return any(instance.event for instance in self.instances.values())

    def saved(self) -> dict[str, Any]:
        """Return the states of the FMUs, which `freed` frees."""
        return {name: instance.save() for name, instance in self.instances.items()}

    def freed(self, states: dict[str, Any]) -> None:
        """Free states of FMUs."""
        for name, state in states.items():
            self.instances[name].release(state)
        states.clear()

    def go_back(self, name: str, states: Mapping[str, Any], time: float) -> None:
        """Let an FMU go back to its state at a time [s]."""
        with self.named(self.instances[name], f"to go back to {time:g} s"):
            self.instances[name].restore(states[name])

    def serialised(self) -> dict[str, bytes]:
        """Return the states of the FMUs as bytes."""
        states = {}
        for name, instance in self.instances.items():
            with self.named(instance, "to give its state"):
                states[name] = instance.serialised()
        return states

    def counts(self) -> dict[str, list[float]]:
        """Return what has been counted of each FMU."""
        return {name: [s.steps, s.seconds, s.events, s.derivative_order] for name, s in self.instances.items()}

    def deserialise(self, states: Mapping[str, bytes], counts: Mapping[str, list[Any]]) -> None:
        """Let all FMUs go to states that another process has stored, and count on from there."""
        for name, instance in self.instances.items():
            with self.named(instance, "to take the state of a checkpoint"):
                instance.deserialise(states[name])
            instance.steps, instance.seconds, instance.events, instance.derivative_order = counts[name]

    @contextmanager
    def named(self, instance: Instance, what: str) -> Iterator[None]:
        """Raise CouplingError with the FMU's name, and what it has failed to do, where a call of it fails."""
        try:
            yield
        except FMICallException as error:
            raise instance.failure(what, error) from error
