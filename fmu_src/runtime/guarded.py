"""The base of all slaves: phases, steps, and a guard that lets no exception reach the host.

An exception that reaches pythonfmu's binary can end the host's process; its only other answer, Discard, ends a
simulation without a message. So every callback returns OK. The log says what could not be used, `valid` becomes false,
and state and outputs stay as they are until the next step that can be computed. An isolated FMU returns the worst
status of the log.

Every message has one of `LOG_CATEGORIES`. pythonfmu's binary forwards it if the host has switched logging on and asked
for its category, or for none.
"""

import math
import traceback
from abc import abstractmethod
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from pythonfmu.enums import Fmi2Status

from contact_core import ContactError, ConvergenceError

from ..phases import Phase
from ..variables import TIME, Value
from .references import ByReference

LOG_CATEGORIES = {
    "logStatusWarning": "calls that FMI does not allow, and the user's interrupt",
    "logStatusError": "unexpected errors, with their traceback",
    "logValidity": "inputs, parameters, steps and states that cannot be used; range flags when they appear",
    "logSolver": "contacts without a solution, and solutions that have not converged or were replaced",
}


# Two communication points are the same if they differ by no more than _PART of the step plus _ROUNDED of the time.
_PART, _ROUNDED = 1e-6, 1e-12
# A step may end beyond the stop time by _PAST in seconds, or as a share of a stop time above 1 s: fmusim's rounding
# needs this much, no known host needs more. It may not by more than _HALF of the step: that is no rounding.
_PAST = 1e-5
_HALF = 0.5

_WHEN = {
    Phase.NEW: "before initialisation",
    Phase.UNSETTLED: "in initialisation mode",
    Phase.SETTLED: "in initialisation mode",
    Phase.STEPPING: "after initialisation",
}


class CallError(ContactError):
    """A call that FMI does not allow."""


class StepError(CallError):
    """A step that does not begin where the last one ended, or that goes beyond the stop time."""


class GuardedSlave(ByReference):
    """A model with variables by value reference that keeps to the phases of FMI and raises nothing to its host."""

    log_categories = LOG_CATEGORIES

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._due: float | None = None  # begin of the next step [s]; None: anywhere
        self._stop: float | None = None  # [s], if the host has defined it
        self._interrupted = self._terminated = False

    @abstractmethod
    def _initialise(self) -> None:
        """Make model, state and outputs from the present parameters and inputs."""

    @abstractmethod
    def _advance(self, step_size: float) -> None:
        """Advance state and outputs by a step [s] under held inputs."""

    # initialisation and steps

    def setup_experiment(self, start_time: float, stop_time: float | None, tolerance: float | None) -> None:
        """Set the start time and the limit of time [s]; the tolerance is not used."""
        self._guard(self._set_up, start_time, stop_time)

    def _set_up(self, start: float, stop: float | None) -> None:
        self._must_be("fmi2SetupExperiment", Phase.NEW)
        if not math.isfinite(start):
            raise CallError(f"startTime = {start} s must be a finite number. Correct it in fmi2SetupExperiment.")
        self.values[self._references[TIME]] = self._due = float(start)
        self._stop = stop

    def enter_initialization_mode(self) -> None:
        """Enter initialisation mode: the outputs follow inputs and parameters until it ends."""
        self._guard(self._enter)

    def _enter(self) -> None:
        self._must_be("fmi2EnterInitializationMode", Phase.NEW)
        self.phase = Phase.UNSETTLED

    def exit_initialization_mode(self) -> None:
        """Set up the model and evaluate it, without moving time."""
        self._guard(self._exit)

    def _exit(self) -> None:
        self._must_be("fmi2ExitInitializationMode", Phase.UNSETTLED, Phase.SETTLED)
        if self.phase is not Phase.SETTLED or not self._value("valid"):
            self._settle()  # once more if it has failed before: this call, too, logs why
        self.phase = Phase.STEPPING

    def _must_be(self, call: str, *phases: Phase) -> None:
        """Raise CallError if the instance is in none of these phases."""
        if self._terminated or self.phase not in phases:
            when = "after fmi2Terminate" if self._terminated else _WHEN[self.phase]
            raise CallError(f"{call} is not allowed {when}. Nothing was done.")

    def _settle(self) -> None:
        self.phase = Phase.SETTLED
        self._guard(self._initialise)

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advance under held inputs. Return False, which ends the simulation, only after the user's interrupt.

        Called by pythonfmu's library (embedded) or isolated/worker.py.
        """
        if not self._interrupted:
            self._guard(self._step, current_time, step_size)
        return not self._interrupted

    def _step(self, time: float, size: float) -> None:
        """Advance from `time` by `size` [s]. Time advances also if the step cannot be computed."""
        self._must_be("fmi2DoStep", Phase.STEPPING)
        size = 0.0 if -_ROUNDED * abs(time) <= size < 0.0 else size  # a host's rounding at the end
        self._check_times(time, size)
        reached = time + size if size >= 0.0 and math.isfinite(time + size) else time
        self.values[self._references[TIME]] = reached
        self._due = None  # after an unexpected error some hosts continue, others try again
        try:
            self._advance(size)
        except ContactError:
            self._due = reached
            raise
        self._due = reached

    def _check_times(self, time: float, size: float) -> None:
        if not math.isfinite(time):
            raise StepError(f"currentCommunicationPoint = {time} s must be a finite number. Nothing was done.")
        length = abs(size) if math.isfinite(size) else 0.0
        if self._due is not None and not abs(time - self._due) <= _PART * length + _ROUNDED * abs(time):
            raise StepError(
                f"currentCommunicationPoint = {time!r} s must be {self._due!r} s, where the last step has ended. Begin "
                "there, or restore a saved state. Nothing was done."
            )
        if self._stop is not None and time + size > self._stop + min(_HALF * length, _PAST * max(1.0, abs(self._stop))):
            raise StepError(
                f"The step from {time!r} s to {time + size!r} s goes beyond stopTime = {self._stop!r} s. Give a later "
                "one, or none, in fmi2SetupExperiment. Nothing was done."
            )

    def terminate(self) -> None:
        """End the run: steps are refused from now on. Restoring a state permits them again."""
        self._terminated = True

    def refresh(self) -> None:
        """In initialisation mode compute the outputs anew if a parameter or input was set since the last time."""
        if self.phase is Phase.UNSETTLED:
            self._settle()

    # the guard

    @np.errstate(all="ignore")  # numpy would warn on the host's stderr; numbers that are not finite are refused
    def _guard(self, action: Callable[..., None], *arguments: Any) -> None:
        """Run `action`; an exception becomes one log entry and valid = false."""
        try:
            action(*arguments)
        except StepError as error:
            self._refuse(str(error), Fmi2Status.error, "logStatusError")
        except CallError as error:
            self._refuse(str(error), Fmi2Status.warning, "logStatusWarning")
        except ConvergenceError as error:
            self._refuse(str(error), Fmi2Status.warning, "logSolver")
        except ContactError as error:
            self._refuse(str(error), Fmi2Status.warning, "logValidity")
        except KeyboardInterrupt:
            self._interrupted = True
            self._refuse("Interrupted by the user.", Fmi2Status.warning, "logStatusWarning")
        except (Exception, SystemExit):
            reason = f"Unexpected error in the model. {traceback.format_exc()}"
            self._refuse(reason, Fmi2Status.error, "logStatusError")

    # FMU states. A handle, pythonfmu's object for a state, is one of two things: a frozen record with the bytes `data`,
    # made when the host gets a state; or plain bytes, made when the host deserialises a state. pythonfmu's binary calls
    # `_fmu_state_from_bytes` without an instance, so that bytes are read only when the state is set.

    def _set_fmu_state(self, handle: Any) -> None:
        self._guard(self._restore, handle)

    @abstractmethod
    def _restore(self, handle: Any) -> None:
        """Restore the state of a handle. An unusable one is an error: the host would take it for the model's state."""

    def _go_to(self, values: Sequence[Value], phase: Phase) -> None:
        """Restore values and phase of a state."""
        self.values[:] = values
        self.phase = phase
        self._due = float(self._value(TIME))
        self._interrupted = self._terminated = False

    @staticmethod
    def parts(handle: Any) -> Sequence[bytes | memoryview]:
        """Return buffers whose join is `_fmu_state_to_bytes`; unchanged ones are shared between states."""
        return [handle.data]

    @staticmethod
    def _fmu_state_to_bytes(handle: Any) -> bytes:
        return handle if isinstance(handle, bytes) else handle.data

    @staticmethod
    def _fmu_state_from_bytes(data: bytes) -> bytes:
        return data
