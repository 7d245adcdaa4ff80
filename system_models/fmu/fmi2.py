"""A running FMU of FMI 2.0."""

from ctypes import byref, c_double
from typing import Any

import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import (
    fmi2Discard,
    fmi2Integer,
    fmi2LastSuccessfulTime,
    fmi2Terminated,
    fmi2ValueReference,
)
from fmpy.model_description import ModelVariable

from contact_core.kernels.arrays import Array

from .instance import Instance
from .kinds import discrete, kind
from .library import FMU2Library
from .loading import load

_FACTORIALS = np.array([[1.0], [1.0], [2.0]])


class Fmi2Instance(Instance):
    """An instance of an FMU of FMI 2.0."""

    def _instantiate(self, folder: str) -> None:
        try:
            self._fmu = load(FMU2Library, self.model.description, folder)
            self._fmu.component = self._fmu.create(self.name)
        except Exception as error:
            raise self.failure("to start", error) from error
        if self._fmu.component is None:
            raise self.failure("to start", Exception("Failed to instantiate model"))
        self._component = self._fmu.component
        self._smooth = [n for n, name in enumerate(self.inputs.names) if not discrete(self.model.variables[name])]
        self.interpolates = bool(self.model.capabilities.canInterpolateInputs and self._smooth)
        self._no_return = not self.model.restores  # whether it is promised that no state before a step comes back
        self._order = 0  # of the buffers for derivatives of the inputs

    def _hold(self, polynomial: Array, size: float) -> None:
        super()._hold(polynomial, size)
        order = len(polynomial) - 1
        if self.interpolates:
            self.derivative_order = max(order, self.derivative_order)
            if self.derivative_order:
                self._set_derivatives(self.derivative_order, polynomial)

    def _set_derivatives(self, order: int, polynomial: Array) -> None:
        """Set those of continuous inputs, up to the highest order that was ever set: an FMU may keep old ones."""
        count = len(self._smooth) * order
        if order > self._order:
            references = (fmi2ValueReference * count)(*([self.inputs.references[n] for n in self._smooth] * order))
            orders = (fmi2Integer * count)(*np.repeat(np.arange(1, order + 1), len(self._smooth)).tolist())
            self._slopes = np.zeros((order, len(self._smooth)))
            buffer = (c_double * count).from_buffer(self._slopes.data)
            self._order, self._derivatives = order, (references, orders, buffer)
        degree = len(polynomial) - 1
        self._slopes[degree:] = 0.0
        np.multiply(polynomial[1:, self._smooth], _FACTORIALS[1 : degree + 1], out=self._slopes[:degree])
        references, orders, buffer = self._derivatives
        self._fmu.fmi2SetRealInputDerivatives(self._component, references, count, orders, buffer)

    def set_inputs(self) -> None:
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
        """Return the time that a refused step has reached."""
        self.terminated = self._status(self._fmu.getBooleanStatus, fmi2Terminated, False)
        return max(time, self._status(self._fmu.getRealStatus, fmi2LastSuccessfulTime, time))

    @staticmethod
    def _status(get: Any, which: int, otherwise: Any) -> Any:
        try:
            return get(which)
        except FMICallException:  # many cannot say
            return otherwise

    def get(self, variable: ModelVariable) -> Any:
        getter = getattr(self._fmu, _FMI2_NAMES[kind(variable)].format("get"))
        value = getter([variable.valueReference])[0]
        return bool(value) if kind(variable) == "boolean" else value.decode() if isinstance(value, bytes) else value

    def set(self, variable: ModelVariable, value: Any) -> None:
        getattr(self._fmu, _FMI2_NAMES[kind(variable)].format("set"))([variable.valueReference], [value])

    def enter_initialization(self, time: float, stop: float, tolerance: float | None) -> None:
        self._fmu.setupExperiment(tolerance=tolerance, startTime=time, stopTime=stop)
        self._fmu.enterInitializationMode()

    def exit_initialization(self) -> None:
        self._fmu.exitInitializationMode()

    def save(self) -> Any:
        return self._fmu.getFMUstate()

    def restore(self, state: Any) -> None:
        self._fmu.fmi2SetFMUstate(self._component, state)
        self.terminated = False

    def release(self, state: Any) -> None:
        self._fmu.fmi2FreeFMUstate(self._component, byref(state))

    def serialised(self) -> bytes:
        state = self.save()
        try:
            return bytes(self._fmu.serializeFMUstate(state))
        finally:
            self.release(state)

    def deserialise(self, data: bytes) -> None:
        state = self._fmu.deSerializeFMUstate(data)
        self.restore(state)
        self.release(state)

    def free(self) -> None:
        self._fmu.freeInstance()


_FMI2_NAMES = {"real": "{}Real", "integer": "{}Integer", "boolean": "{}Boolean", "string": "{}String"}
