"""A running FMU of FMI 3.0."""

import logging
import struct
from collections.abc import Callable
from ctypes import byref, c_bool, c_double
from math import isclose, nan
from typing import Any, NamedTuple

import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Slave, fmi3Discard
from fmpy.model_description import ModelVariable

from contact_core.kernels.arrays import Array

from ..numerics import hold
from . import messages
from .errors import CouplingError
from .instance import Instance
from .loading import load
from .model import Model
from .values import Shared, Values

log = logging.getLogger(__name__)

_MOST_UPDATES = 100  # of the discrete states at one time


class State(NamedTuple):
    """A saved state, and the event that its FMU had announced then."""

    memory: Any
    next_event: float | None


class Fmi3Instance(Instance):
    """An instance of an FMU of FMI 3.0.

    early_return: whether a step may end before its end, as at an event. It asks the master to repeat the step of all
    other FMUs up to that time.

    Where the FMU has an event mode, discrete inputs are set in it; it ends as soon as a value is asked for or a step is
    made. One that claims to have it and refuses it is begun again without.
    """

    def __init__(
        self,
        model: Model,
        folder: str,
        inputs: list[ModelVariable],
        outputs: list[ModelVariable],
        early_return: bool = False,
    ) -> None:
        self._early_return = early_return
        super().__init__(model, folder, inputs, outputs)

    def _instantiate(self, folder: str) -> None:
        capabilities = self.model.capabilities
        within = [self.model.variables[name].intermediateUpdate for name in self.inputs.names]
        self.interpolates = capabilities.providesIntermediateUpdate and bool(within) and all(within)
        self._given, self._got = (Shared(reals, self.model) for reals in (self.inputs, self.outputs))
        self._values = Values(self.model)
        self._has_event_mode = bool(capabilities.hasEventMode)
        self._started = self._stepping = self._in_event_mode = False
        self._folder = folder
        # values set and phases begun up to the first step, for an FMU that is begun again
        self._begun: list[tuple[Callable[..., None], tuple[Any, ...]]] = []
        self._load()
        try:
            self._create()
        except Exception as error:
            if not self._has_event_mode:
                raise self.failure("to start", error) from error
            self._leave_out_event_mode(error)
        self._no_return = not self.model.restores  # whether it is promised that no state before a step comes back
        self._event_needed, self._end_asked, self._early = c_bool(), c_bool(), c_bool()
        self._last_time = c_double()
        self._answers = (
            byref(self._event_needed),
            byref(self._end_asked),
            byref(self._early),
            byref(self._last_time),
        )
        self._polynomial, self._start = np.empty((0, self.inputs.count)), nan  # of the inputs in the running step
        self._refused_input: FMICallException | None = None

    def _load(self) -> None:
        try:
            self._fmu = load(
                FMU3Slave,
                guid=self.model.description.guid,
                modelIdentifier=self.model.capabilities.modelIdentifier,
                unzipDirectory=self._folder,
                instanceName=self.name,
            )
        except Exception as error:
            raise self.failure("to start", error) from error

    def _create(self) -> None:
        self._fmu.instantiate(
            loggingOn=True,
            eventModeUsed=self._has_event_mode,
            earlyReturnAllowed=self._early_return,
            logMessage=self._on_message,
            intermediateUpdate=self._on_intermediate_update if self.interpolates else None,
            requiredIntermediateVariables=list(dict.fromkeys(self.inputs.references)) if self.interpolates else None,
        )
        self._component = self._fmu.component
        self._values.begin(self._fmu)

    def _leave_out_event_mode(self, reason: Exception) -> None:
        """Begin again without event mode, up to where the FMU is. Raises CouplingError for `reason` if that fails."""
        self._has_event_mode = self._stepping = self._in_event_mode = False
        try:
            self._create()
            for function, arguments in self._begun:
                function(*arguments)
        except Exception:
            raise self.failure("to start", reason) from reason
        log.warning("The FMU '%s' claims to have event mode and refuses it: it goes on without.", self.name)

    def _on_message(self, environment: Any, status: int, category: bytes, message: bytes) -> None:
        messages.pass_on(self.name, status, message)

    def _on_intermediate_update(
        self,
        environment: Any,
        time: float,
        set_requested: bool,
        get_allowed: bool,
        step_finished: bool,
        can_return_early: bool,
        return_early: Any,
        return_time: Any,
    ) -> None:
        return_early[0] = False
        if set_requested and self._refused_input is None:
            self.inputs.values[:] = hold.value(self._polynomial, time - self._start)
            try:
                self._given.put(self._fmu)
            except FMICallException as error:  # nothing may be raised through the FMU
                self._refused_input = error

    def _hold(self, polynomial: Array, size: float) -> None:
        super()._hold(polynomial, size)
        self._polynomial = polynomial

    def set_inputs(self) -> None:
        """Give the FMU the values of `inputs`."""
        self._given.complete(self._fmu)
        self._given.put(self._fmu)

    def _get_outputs(self) -> None:
        self._end_event()
        self._got.get(self._fmu)

    def _do_step(self, time: float, size: float) -> float:
        self.event = False
        self._end_event()
        self._start, self._refused_input = time, None
        self._last_time.value, self._end_asked.value = time, False  # a step that is refused may leave them alone
        try:
            self._fmu.fmi3DoStep(self._component, time, size, self._no_return, *self._answers)
        except FMICallException as error:
            if error.status != fmi3Discard:
                raise
            self.terminated = self._end_asked.value
            return max(time, self._last_time.value)
        if self._refused_input is not None:
            raise self._refused_input
        self.terminated = self._end_asked.value
        reached = max(time, self._last_time.value) if self._early.value or self.terminated else time + size
        if self._stepping and not self.terminated and (self._event_needed.value or self._is_due(reached)):
            self._enter_event()
            self._end_event()
        return reached

    def _is_due(self, time: float) -> bool:
        """Return True if the event that the FMU has announced is at `time` or before."""
        event = self.next_event
        return event is not None and (time >= event or isclose(time, event, rel_tol=1e-12))

    def _enter_event(self) -> None:
        self._fmu.fmi3EnterEventMode(self._component)
        self._in_event_mode = self.event = True
        self.events += 1

    def _end_event(self) -> None:
        """Let the discrete states come to rest, and go back to steps."""
        if not self._in_event_mode:
            return
        for _ in range(_MOST_UPDATES):
            again, end, _, _, announced, next_time = self._fmu.updateDiscreteStates()
            if end or not again:
                break
        else:
            raise CouplingError(
                f"The FMU '{self.name}' still changes its discrete states after {_MOST_UPDATES} updates at one event. "
                "It must come to rest."
            )
        self._in_event_mode = False
        self.terminated |= end
        self.next_event = next_time if announced else None
        if not end:
            self._fmu.fmi3EnterStepMode(self._component)

    def get(self, variable: ModelVariable) -> Any:
        """Return the value of a variable of any type."""
        self._end_event()
        return self._values.get(variable)

    def set(self, variable: ModelVariable, value: Any) -> None:
        """Set a variable of any type: a discrete one, during the simulation, in event mode if the value is another."""
        if self._stepping and not self._in_event_mode and variable.variability != "continuous":
            if self._values.get(variable) == value:
                return
            self._enter_event()
        if not self._started:
            self._begun.append((self._values.put, (variable, value)))
        self._values.put(variable, value)

    def enter_initialization(self, time: float, stop: float, tolerance: float | None) -> None:
        """Go from the start values to the initialisation."""
        self._begun.append((self._enter_initialization, (time, stop, tolerance)))
        self._enter_initialization(time, stop, tolerance)

    def _enter_initialization(self, time: float, stop: float, tolerance: float | None) -> None:
        self._fmu.enterInitializationMode(tolerance=tolerance, startTime=time, stopTime=stop)
        self._values.given = True

    def exit_initialization(self) -> None:
        """Go from the initialisation to the first step."""
        self._fmu.exitInitializationMode()
        self._stepping = self._in_event_mode = self._has_event_mode
        try:
            self._end_event()
        except FMICallException as error:
            self._fmu.freeInstance()
            self._load()
            self._leave_out_event_mode(error)
            self._fmu.exitInitializationMode()
        self._started = True
        self._begun.clear()

    def save(self) -> Any:
        """Return the FMU's state, to be given to `restore` any number of times and to `release` once."""
        self._end_event()
        return State(self._fmu.getFMUState(), self.next_event)

    def restore(self, state: Any) -> None:
        """Go back to a state."""
        self._fmu.fmi3SetFMUState(self._component, state.memory)
        self._in_event_mode = self.terminated = False
        self.next_event = state.next_event

    def release(self, state: Any) -> None:
        """Free a state."""
        self._fmu.fmi3FreeFMUState(self._component, byref(state.memory))

    def serialised(self) -> bytes:
        """Return the FMU's state as bytes."""
        state = self.save()
        try:
            head = struct.pack("<d", nan if state.next_event is None else state.next_event)
            return head + self._fmu.serializeFMUState(state.memory)
        finally:
            self.release(state)

    def deserialise(self, data: bytes) -> None:
        """Go to a state that `serialised` gave, also in another process."""
        (next_event,) = struct.unpack_from("<d", data)
        memory = self._fmu.deserializeFMUState(data[8:])
        state = State(memory, None if next_event != next_event else next_event)
        self.restore(state)
        self.release(state)

    def free(self) -> None:
        """End the instance, whatever state it is in."""
        self._fmu.freeInstance()
