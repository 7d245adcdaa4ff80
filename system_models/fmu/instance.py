"""A running FMU: the common part of FMI 2.0 and 3.0."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from ctypes import c_double
from pathlib import Path
from time import perf_counter
from typing import Any

import fmpy
import numpy as np
from fmpy.fmi2 import fmi2ValueReference
from fmpy.model_description import ModelVariable

from contact_core.arrays import Array

from ..numerics import hold
from . import messages
from .errors import CouplingError
from .model import Model


class Reals:
    """Real variables of an FMU: their values lie in memory that numpy and the FMU share."""

    def __init__(self, variables: Sequence[ModelVariable]) -> None:
        self.count = len(variables)
        self.names = [variable.name for variable in variables]
        self.references = (fmi2ValueReference * self.count)(*(v.valueReference for v in variables))
        self.values = np.zeros(self.count)
        self.buffer = (c_double * self.count).from_buffer(self.values.data)


class Instance(ABC):
    """An instance of an FMU between its communication points.

    inputs are the Real variables that connections set, outputs those that they or the recorder read; `refreshed` are
    among the outputs those that depend directly on the inputs.
    """

    def __init__(self, model: Model, folder: str, inputs: list[ModelVariable], outputs: list[ModelVariable]) -> None:
        self.model, self.name = model, model.name
        self.inputs, self.outputs = Reals(inputs), Reals(outputs)
        names = {variable.name for variable in inputs}
        dependencies = model.dependencies
        self.feedthrough = any(dependencies.get(v.name, names) & names for v in outputs)
        self.seconds, self.steps = 0.0, 0  # spent in doStep, and how many
        self.terminated = False  # it has asked for the end of the simulation
        self.derivative_order = 0  # up to which derivatives of the inputs have been set
        self.event, self.events = False, 0  # handled in the last step or after it, and how many: from FMI 3 on
        self.next_event: float | None = None  # its time [s], where the FMU announces it
        self.interpolates = False  # whether it takes derivatives of its inputs, or asks for them within a step
        messages.said.pop(self.name, None)
        self._refuse_platform(folder)
        self._instantiate(folder)

    def step(self, time: float, size: float, polynomial: Array) -> float:
        """Advance from `time` by `size`, both in s, and return the time reached: earlier if the FMU stops before.

        polynomial [order + 1, inputs]: coefficients of the inputs in powers of the time since `time`. An FMU that takes
        no derivatives holds their mean over the step, good for the second order.
        """
        if self.inputs.count:
            self._hold(polynomial, size)
        start = perf_counter()
        reached = self._do_step(time, size)
        self.seconds += perf_counter() - start
        self.steps += 1
        if self.feedthrough and len(polynomial) > 1 and not self.interpolates:  # outputs of the end, not of the mean
            self.inputs.values[:] = hold.value(polynomial, size)
            self.set_inputs()
        return reached

    def read(self) -> None:
        """Get the outputs."""
        if self.outputs.count:
            self._get_outputs()

    def _hold(self, polynomial: Array, size: float) -> None:
        if len(polynomial) > 1 and not self.interpolates:
            self.inputs.values[:] = hold.mean(polynomial, size)
        else:
            self.inputs.values[:] = polynomial[0]
        self.set_inputs()

    def failure(self, what: str, error: Exception) -> CouplingError:
        """Return the error to raise where the FMU has failed to do something."""
        why = messages.cause(self.name)
        return CouplingError(f"The FMU '{self.name}' failed {what}: {str(error).rstrip('.')}. {why}")

    def _refuse_platform(self, folder: str) -> None:
        """Raise CouplingError if the FMU has no library for this platform."""
        own = fmpy.platform_tuple if self.model.fmi3 else fmpy.platform
        there = sorted(each.name for each in Path(folder, "binaries").glob("*") if any(each.glob("*")))
        if own not in there:
            others = f"only for {', '.join(there)}" if there else "nor for any other"
            raise CouplingError(
                f"The FMU '{self.name}' has no library for this platform, {own}, {others}. Export it for {own}, or "
                "run it where its library does."
            )

    @abstractmethod
    def _instantiate(self, folder: str) -> None: ...

    @abstractmethod
    def set_inputs(self) -> None:
        """Give the FMU the values of `inputs`."""

    @abstractmethod
    def _get_outputs(self) -> None: ...

    @abstractmethod
    def _do_step(self, time: float, size: float) -> float: ...

    @abstractmethod
    def get(self, variable: ModelVariable) -> Any:
        """Return the value of a variable of any type."""

    @abstractmethod
    def set(self, variable: ModelVariable, value: Any) -> None:
        """Set a variable of any type."""

    @abstractmethod
    def enter_initialization(self, time: float, stop: float, tolerance: float | None) -> None:
        """Go from the start values to the initialisation."""

    @abstractmethod
    def exit_initialization(self) -> None:
        """Go from the initialisation to the first step."""

    @abstractmethod
    def save(self) -> Any:
        """Return the FMU's state, to be given to `restore` any number of times and to `release` once."""

    @abstractmethod
    def restore(self, state: Any) -> None:
        """Go back to a state."""

    @abstractmethod
    def release(self, state: Any) -> None:
        """Free a state."""

    @abstractmethod
    def serialised(self) -> bytes:
        """Return the FMU's state as bytes."""

    @abstractmethod
    def deserialise(self, data: bytes) -> None:
        """Go to a state that `serialised` gave, also in another process."""

    @abstractmethod
    def free(self) -> None:
        """End the instance, whatever state it is in."""
