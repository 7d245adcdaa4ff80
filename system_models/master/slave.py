"""A running FMU, and what is the same in FMI 2.0 and 3.0."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from ctypes import byref, c_double
from time import perf_counter
from typing import Any

import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import (
    FMU2Slave,
    fmi2Discard,
    fmi2Integer,
    fmi2LastSuccessfulTime,
    fmi2Terminated,
    fmi2ValueReference,
)
from fmpy.model_description import ModelVariable
from numpy.typing import NDArray

from .. import messages
from . import hold
from .errors import CouplingError
from .model import Model, kind

_FACTORIALS = np.array([[1.0], [1.0], [2.0]])


class Reals:
    """Real variables of an FMU: their values lie in memory that numpy and the FMU share."""

    def __init__(self, variables: Sequence[ModelVariable]) -> None:
        self.count = len(variables)
        self.names = [variable.name for variable in variables]
        self.references = (fmi2ValueReference * self.count)(*(v.valueReference for v in variables))
        self.values = np.zeros(self.count)
        self.buffer = (c_double * self.count).from_buffer(self.values.data)


class Slave(ABC):
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
        self.told_order = 0  # up to which derivatives of the inputs have been set
        self.event, self.events = False, 0  # handled in the last step or after it, and how many: from FMI 3 on
        self.next_event: float | None = None  # its time [s], where the FMU announces it
        self.interpolates = False  # whether it takes derivatives of its inputs, or asks for them within a step
        self._instantiate(folder)

    def step(self, time: float, size: float, polynomial: NDArray[np.float64]) -> float:
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

    def _hold(self, polynomial: NDArray[np.float64], size: float) -> None:
        if len(polynomial) > 1 and not self.interpolates:
            self.inputs.values[:] = hold.mean(polynomial, size)
        else:
            self.inputs.values[:] = polynomial[0]
        self.set_inputs()

    def failure(self, what: str, error: Exception) -> CouplingError:
        """What to raise where the FMU has failed to do something."""
        return CouplingError(f"The FMU '{self.name}' failed {what}: {str(error).rstrip('.')}. Its messages say why.")

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
        """The value of a variable of any type."""

    @abstractmethod
    def set(self, variable: ModelVariable, value: Any) -> None:
        """Set a variable of any type."""

    @abstractmethod
    def enter_initialization(self, time: float, stop: float, tolerance: float | None) -> None:
        """From the start values to the initialisation."""

    @abstractmethod
    def exit_initialization(self) -> None:
        """From the initialisation to the first step."""

    @abstractmethod
    def save(self) -> Any:
        """The FMU's state, to be given to `restore` any number of times and to `release` once."""

    @abstractmethod
    def restore(self, state: Any) -> None:
        """Go back to a state."""

    @abstractmethod
    def release(self, state: Any) -> None:
        """Free a state."""

    @abstractmethod
    def serialised(self) -> bytes:
        """The FMU's state as bytes."""

    @abstractmethod
    def deserialise(self, data: bytes) -> None:
        """Go to a state that `serialised` gave, also in another process."""

    @abstractmethod
    def free(self) -> None:
        """End the instance, whatever state it is in."""


class Fmi2Slave(Slave):
    """An instance of an FMU of FMI 2.0."""

    def _instantiate(self, folder: str) -> None:
        try:
            self._fmu = FMU2Slave(
                guid=self.model.description.guid,
                modelIdentifier=self.model.capabilities.modelIdentifier,
                unzipDirectory=folder,
                instanceName=self.name,
            )
            self._fmu.instantiate(callbacks=messages.callbacks(), loggingOn=True)
        except Exception as error:
            raise self.failure("to start", error) from error
        self._component = self._fmu.component
        self.interpolates = bool(self.model.capabilities.canInterpolateInputs)
        self._no_return = not self.model.restores  # whether it is promised that no state before a step comes back
        self._order = 0  # of the buffers for derivatives of the inputs

    def _hold(self, polynomial: NDArray[np.float64], size: float) -> None:
        super()._hold(polynomial, size)
        order = len(polynomial) - 1
        if self.interpolates:
            self.told_order = max(order, self.told_order)
            if self.told_order:
                self._set_derivatives(self.told_order, polynomial)

    def _set_derivatives(self, order: int, polynomial: NDArray[np.float64]) -> None:
        """Set the derivatives up to the order up to which they were ever set: what is not set may stay."""
        count = self.inputs.count * order
        if order > self._order:
            references = (fmi2ValueReference * count)(*(list(self.inputs.references) * order))
            orders = (fmi2Integer * count)(*np.repeat(np.arange(1, order + 1), self.inputs.count).tolist())
            self._slopes = np.zeros((order, self.inputs.count))
            buffer = (c_double * count).from_buffer(self._slopes.data)
            self._order, self._derivatives = order, (references, orders, buffer)
        degree = len(polynomial) - 1
        self._slopes[degree:] = 0.0
        np.multiply(polynomial[1:], _FACTORIALS[1 : degree + 1], out=self._slopes[:degree])
        references, orders, buffer = self._derivatives
        self._fmu.fmi2SetRealInputDerivatives(self._component, references, count, orders, buffer)

    def set_inputs(self) -> None:
        """Give the FMU the values of `inputs`."""
        self._fmu.fmi2SetReal(self._component, self.inputs.references, self.inputs.count, self.inputs.buffer)

    def _get_outputs(self) -> None:
        self._fmu.fmi2GetReal(self._component, self.outputs.references, self.outputs.count, self.outputs.buffer)

    def _do_step(self, time: float, size: float) -> float:
        try:
            self._fmu.fmi2DoStep(self._component, time, size, self._no_return)
        except FMICallException as error:
            if error.status != fmi2Discard:
                raise
            return self._discarded(time)
        return time + size

    def _discarded(self, time: float) -> float:
        """The time that a refused step has reached."""
        self.terminated = self._status(self._fmu.getBooleanStatus, fmi2Terminated, False)
        return max(time, self._status(self._fmu.getRealStatus, fmi2LastSuccessfulTime, time))

    @staticmethod
    def _status(get: Any, which: int, otherwise: Any) -> Any:
        try:
            return get(which)
        except FMICallException:  # many cannot say
            return otherwise

    def get(self, variable: ModelVariable) -> Any:
        """The value of a variable of any type."""
        getter = getattr(self._fmu, _FMI2_NAMES[kind(variable)].format("get"))
        value = getter([variable.valueReference])[0]
        return bool(value) if kind(variable) == "boolean" else value.decode() if isinstance(value, bytes) else value

    def set(self, variable: ModelVariable, value: Any) -> None:
        """Set a variable of any type."""
        getattr(self._fmu, _FMI2_NAMES[kind(variable)].format("set"))([variable.valueReference], [value])

    def enter_initialization(self, time: float, stop: float, tolerance: float | None) -> None:
        """From the start values to the initialisation."""
        self._fmu.setupExperiment(tolerance=tolerance, startTime=time, stopTime=stop)
        self._fmu.enterInitializationMode()

    def exit_initialization(self) -> None:
        """From the initialisation to the first step."""
        self._fmu.exitInitializationMode()

    def save(self) -> Any:
        """The FMU's state, to be given to `restore` any number of times and to `release` once."""
        return self._fmu.getFMUstate()

    def restore(self, state: Any) -> None:
        """Go back to a state."""
        self._fmu.fmi2SetFMUstate(self._component, state)
        self.terminated = False

    def release(self, state: Any) -> None:
        """Free a state."""
        self._fmu.fmi2FreeFMUstate(self._component, byref(state))

    def serialised(self) -> bytes:
        """The FMU's state as bytes."""
        state = self.save()
        try:
            return bytes(self._fmu.serializeFMUstate(state))
        finally:
            self.release(state)

    def deserialise(self, data: bytes) -> None:
        """Go to a state that `serialised` gave, also in another process."""
        state = self._fmu.deSerializeFMUstate(data)
        self.restore(state)
        self.release(state)

    def free(self) -> None:
        """End the instance, whatever state it is in."""
        self._fmu.freeInstance()


_FMI2_NAMES = {"real": "{}Real", "float": "{}Real", "integer": "{}Integer"}
_FMI2_NAMES |= {"boolean": "{}Boolean", "string": "{}String"}
