"""The slave in the FMU: pythonfmu's callbacks in, `contact_core.advance` out, nothing raised to the host.

An exception that reaches pythonfmu's binary can end the host's process, and its only other answer, Discard,
ends a simulation without a word. So every callback returns OK; what could not be used is logged, `valid`
turns false, and state and outputs stand until the next step that can be computed.

A message has one of `LOG_CATEGORIES`. pythonfmu's binary hands it on if the host has switched logging on and asked
for its category, or for none.
"""

import contextlib
import math
import sys
import traceback
from collections.abc import Callable, Sequence
from operator import attrgetter
from pathlib import Path
from typing import Any

from pythonfmu import Fmi2Slave
from pythonfmu.enums import Fmi2Status

from contact_core import (
    ContactError,
    ContactState,
    ConvergenceError,
    OperatingPoint,
    Outputs,
    RangeFlag,
    StateError,
    advance,
    initial_state,
    warm_up,
)
from contact_core.quantities import LEVELS, OF_CALLER
from contact_core.scene import with_values

from . import loader, resources
from .snapshot import Phase, Scenes, Snapshot, check_owner
from .variables import FIDELITY, INITIAL_STATE, SEED, SPECIAL, ZERO, Causality, Kind, Value, Variable, variables

LOG_CATEGORIES = {
    "logStatusWarning": "calls that FMI does not allow, and the user's interrupt",
    "logStatusError": "unexpected errors, with their traceback",
    "logValidity": "inputs, parameters, steps and states that cannot be used; range flags when they appear",
    "logSolver": "contacts without a solution, and solutions that missed their tolerance or were replaced",
}
_OF_SOLVER = RangeFlag.NOT_CONVERGED | RangeFlag.FALLBACK
_OTHER_LEVEL = int(RangeFlag.OTHER_LEVEL)


class CallError(ContactError):
    """A call that FMI does not allow."""


class _Told:
    """The outputs that the core fills at a level, and how to read them all at once."""

    def __init__(self, table: Sequence[Variable], level: str) -> None:
        told = [
            (v.name, vr, type(v.start))
            for vr, v in enumerate(table)
            if v.causality == "output" and v.name not in OF_CALLER and level in v.levels
        ]
        self.names, self.references, self._kinds = zip(*told, strict=True)
        self._fetch = attrgetter(*self.names)

    def values(self, outputs: Outputs) -> tuple[Any, ...]:
        """In the order of `names`."""
        found = self._fetch(outputs)
        if tuple(map(type, found)) == self._kinds:
            return found
        return tuple(kind(value) for kind, value in zip(self._kinds, found, strict=True))

    def check(self, values: tuple[Any, ...], point: OperatingPoint) -> None:
        """Raise ConvergenceError if a value is not finite."""
        broken = [name for name, value in zip(self.names, values, strict=True) if not math.isfinite(value)]
        if broken:
            raise ConvergenceError(
                f"No finite {', '.join(broken)} came out at {point}. Change the inputs, or go back to an earlier state."
            )


class ContactSlave(Fmi2Slave):
    """One contact: its scene with the parameters, its state, and all variables by value reference.

    `values` are theirs, always the same list, `layout` has kind and causality of each, `phase` is where in its life it
    is: all to be read only.
    """

    log_categories = LOG_CATEGORIES

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        loader.tidy(self.resources)
        self._module = type(self).__module__
        try:
            self._design = resources.read(self.resources, self._module)
        except ContactError as error:
            print(error, file=sys.stderr)  # the host is only told that the FMU cannot be instantiated
            raise
        self._variables = variables(self._design)
        self._references = {v.name: vr for vr, v in enumerate(self._variables)}
        self.values: list[Value] = [v.start for v in self._variables]
        self.layout = tuple((v.kind, "tunable" if v.variability == "tunable" else v.causality) for v in self._variables)
        self._inputs = [(v.name, vr) for vr, v in enumerate(self._variables) if v.causality == "input"]
        self._told = [_Told(self._variables, level) for level in LEVELS]
        self._scenes: Scenes | None = None
        self._state: ContactState | None = None
        self.phase = Phase.NEW
        self._fault = "its initialisation has not ended."
        self._interrupted = False

    @classmethod
    def warm_up(cls, folder: Path) -> None:
        """Load what the first steps of the contact in these resources need, before processes are forked.

        Raises SceneError if they are another version's, which may speak otherwise, or were edited.
        """
        scene = resources.read(str(folder), cls.__module__)
        warm_up(scene)
        with contextlib.suppress(ContactError):  # which the first instance will say
            # the means of the fresh surfaces, so that the processes share these
            advance(scene.at_level(LEVELS[0]), scene.operation.point, initial_state(scene), 0.0)

    # initialisation and steps

    def enter_initialization_mode(self) -> None:
        """From here on the outputs follow inputs and parameters until initialisation ends."""
        self.phase = Phase.UNSETTLED

    def exit_initialization_mode(self) -> None:
        """Set up the contact and evaluate it, without moving time."""
        if self.phase is not Phase.SETTLED:
            self._guard(self._initialise)
        self.phase = Phase.STEPPING

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advance under held inputs. False, which ends the simulation, only after the user's interrupt."""
        if not self._interrupted:
            self._guard(self._advance, step_size)
        return not self._interrupted

    def _initialise(self) -> None:
        """Make scene, state and outputs from the parameters and inputs as they are now."""
        self.phase = Phase.SETTLED
        self._scenes = self._state = None
        self._fault = "an unexpected error was logged at initialisation."
        try:
            scenes = self._rebuilt(self.values)
            state = self._first_state(scenes)
        except ContactError as error:
            self._fault = str(error)
            raise
        self._scenes, self._state = scenes, state
        self._advance(0.0)
        for reference in {*self._told[-1].references} - {*self._told[self._fidelity() - 1].references}:
            # it may have been evaluated earlier in the initialisation mode
            self.values[reference] = self._variables[reference].start

    def _rebuilt(self, values: Sequence[Value]) -> Scenes:
        """The scene with the parameters in `values`, at each level."""
        pairs = zip(self._variables, values, strict=True)
        parameters: dict[str, Any] = {v.name: value for v, value in pairs if v.causality == "parameter"}
        numbers = {name: value for name, value in parameters.items() if name not in SPECIAL}
        scene = with_values(self._design, numbers).realisation(parameters[SEED])
        return tuple(scene.at_level(level) for level in LEVELS)

    def _first_state(self, scenes: Scenes) -> ContactState:
        path = str(self._value(INITIAL_STATE))
        if not path:
            return initial_state(scenes[0])
        try:
            data = Path(path).read_bytes()
        except OSError as error:
            raise StateError(
                f"{INITIAL_STATE} = '{path}' cannot be read: {error.strerror}. "
                "Give the path of a stored state, or leave it empty."
            ) from None
        return ContactState.from_bytes(data, scenes[0])

    def _advance(self, step_size: float) -> None:
        if self._scenes is None or self._state is None:
            raise ContactError(f"The contact is not set up: {self._fault}")
        fidelity = self._fidelity()
        inputs: dict[str, Any] = {name: self.values[reference] for name, reference in self._inputs}
        point = OperatingPoint(**inputs)
        state, outputs = advance(self._scenes[fidelity - 1], point, self._state, step_size)
        told = self._told[fidelity - 1]
        results = told.values(outputs)
        if not math.isfinite(sum(results)):
            told.check(results, point)
        flags = outputs.range_flags | (_OTHER_LEVEL if len(told.names) < len(self._told[-1].names) else 0)
        appeared = flags & ~int(self._value("range_flags"))
        self._state = state
        values, references = self.values, self._references
        for reference, value in zip(told.references, results, strict=True):
            values[reference] = value
        values[references["range_flags"]] = flags
        values[references["fidelity_used"]] = fidelity
        values[references["valid"]] = True
        if appeared:
            self._tell_flags(RangeFlag(appeared))

    def _fidelity(self) -> int:
        fidelity = int(self._value(FIDELITY))
        if not 1 <= fidelity <= len(LEVELS):
            known = " or ".join(f"{i} ({level})" for i, level in enumerate(LEVELS, 1))
            raise ContactError(f"{FIDELITY} = {fidelity} must be {known}.")
        return fidelity

    def _value(self, name: str) -> Value:
        return self.values[self._references[name]]

    # the guard

    def _guard(self, action: Callable[..., None], *arguments: Any) -> None:
        """Run `action`; whatever it raises becomes one log entry and valid = false."""
        try:
            action(*arguments)
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
            reason = f"Unexpected error in the contact. {traceback.format_exc()}"
            self._refuse(reason, Fmi2Status.error, "logStatusError")

    def _refuse(self, reason: str, status: Fmi2Status, category: str) -> None:
        self.values[self._references["valid"]] = False
        self._tell(reason, status, category)

    def _tell(self, message: str, status: Fmi2Status, category: str) -> None:
        # the host reads the message as a printf format, the binary as strict UTF-8
        self.log(message.replace("%", "%%").encode("utf-8", "backslashreplace").decode(), status, category)

    def _tell_flags(self, appeared: RangeFlag) -> None:
        for flag in appeared:
            category = "logSolver" if flag in _OF_SOLVER else "logValidity"
            self._tell(f"range_flags: {flag.text}.", Fmi2Status.ok, category)

    # variables by value reference

    def _get(self, references: list[int], kind: Kind) -> list[Any]:
        if self.phase is Phase.UNSETTLED and any(self._causality(vr) == "output" for vr in references):
            self._guard(self._initialise)
        found = []
        for vr in references:
            known = self._causality(vr) is not None and self._variables[vr].kind == kind
            if not known:
                reason = f"There is no {kind} variable with value reference {vr}."
                self._refuse(reason, Fmi2Status.warning, "logStatusWarning")
            found.append(self.values[vr] if known else ZERO[kind])
        return found

    def _set(self, references: list[int], values: Sequence[Value], kind: Kind) -> None:
        for vr, value in zip(references, values, strict=True):
            self._guard(self._store, vr, value, kind)

    def _store(self, reference: int, value: Value, kind: Kind) -> None:
        causality = self._causality(reference)
        if causality is None or self._variables[reference].kind != kind:
            raise CallError(f"There is no {kind} variable with value reference {reference}.")
        name = self._variables[reference].name
        if causality == "output":
            raise CallError(f"{name} is an output and cannot be set.")
        if self.phase is Phase.STEPPING and self._variables[reference].variability == "fixed":
            raise CallError(f"{name} is a parameter: set it before initialisation ends, or reset the FMU first.")
        self.values[reference] = value
        if self.phase is Phase.SETTLED:
            self.phase = Phase.UNSETTLED

    def _causality(self, reference: int) -> Causality | None:
        return self._variables[reference].causality if 0 <= reference < len(self._variables) else None

    def get_real(self, vrs: list[int]) -> list[float]:
        """Values of Real variables."""
        return self._get(vrs, "Real")

    def get_integer(self, vrs: list[int]) -> list[int]:
        """Values of Integer variables."""
        return self._get(vrs, "Integer")

    def get_boolean(self, vrs: list[int]) -> list[bool]:
        """Values of Boolean variables."""
        return self._get(vrs, "Boolean")

    def get_string(self, vrs: list[int]) -> list[str]:
        """Values of String variables."""
        return self._get(vrs, "String")

    def set_real(self, vrs: list[int], values: list[float]) -> None:
        """Set Real inputs or parameters; what is wrong with a value is said when it is used."""
        self._set(vrs, values, "Real")

    def set_integer(self, vrs: list[int], values: list[int]) -> None:
        """Set Integer parameters."""
        self._set(vrs, values, "Integer")

    def set_boolean(self, vrs: list[int], values: list[bool]) -> None:
        """Refuse: no Boolean can be set."""
        self._set(vrs, values, "Boolean")

    def set_string(self, vrs: list[int], values: list[str | None]) -> None:
        """Set String parameters; a host's null is an empty text."""
        self._set(vrs, [value or "" for value in values], "String")

    # state: a handle is a Snapshot, or its bytes until they are set (the binary decodes without the instance)

    def _get_fmu_state(self) -> Snapshot:
        return Snapshot(self._module, self.phase, self._fault, tuple(self.values), self._scenes, self._state)

    def _set_fmu_state(self, handle: Snapshot | bytes) -> None:
        self._guard(self._restore, handle)

    def _restore(self, handle: Snapshot | bytes) -> None:
        """Go back to a state. One that cannot be used is an error: the host takes it for the contact's from now on."""
        try:
            if isinstance(handle, bytes):
                starts = tuple(v.start for v in self._variables)
                handle = Snapshot.from_bytes(handle, self._module, starts, self._rebuilt)
            check_owner(handle.module, self._module)
        except ContactError as error:
            self._refuse(str(error), Fmi2Status.error, "logValidity")
            return
        self.values[:] = handle.values
        self._scenes, self._state = handle.scenes, handle.state
        self.phase, self._fault = handle.phase, handle.fault
        self._interrupted = False

    @staticmethod
    def parts(handle: Snapshot) -> list[bytes | memoryview]:
        """Buffers whose join is `_fmu_state_to_bytes`: what has not changed since another state is the same object."""
        return handle.parts

    @staticmethod
    def _fmu_state_to_bytes(handle: Snapshot | bytes) -> bytes:
        return handle if isinstance(handle, bytes) else handle.data

    @staticmethod
    def _fmu_state_from_bytes(data: bytes) -> bytes:
        return data
