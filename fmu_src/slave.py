"""The slave in the FMU: pythonfmu's callbacks in, `contact_core.advance` out, nothing raised to the host.

An exception that reaches pythonfmu's binary can end the host's process, and its only other answer, Discard,
ends a simulation without a word. So every callback returns OK; what could not be used is logged, `valid`
turns false, and state and outputs stand until the next step that can be computed.
"""

import math
import sys
import traceback
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from pythonfmu import Fmi2Slave
from pythonfmu.enums import Fmi2Status

from contact_core import (
    ContactError,
    ContactState,
    ConvergenceError,
    OperatingPoint,
    Scene,
    StateError,
    advance,
    initial_state,
)
from contact_core.scene import with_values

from . import loader, resources
from .snapshot import Phase, Snapshot
from .variables import INITIAL_STATE, ZERO, Causality, Kind, Value, variables


class ContactSlave(Fmi2Slave):
    """One contact: its scene with the parameters, its state, and all variables by value reference."""

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
        self._values: list[Value] = [v.start for v in self._variables]
        self._scene: Scene | None = None
        self._state: ContactState | None = None
        self._phase = Phase.NEW
        self._fault = "its initialisation has not ended."
        self._interrupted = False

    # initialisation and steps

    def enter_initialization_mode(self) -> None:
        """From here on the outputs follow inputs and parameters until initialisation ends."""
        self._phase = Phase.UNSETTLED

    def exit_initialization_mode(self) -> None:
        """Set up the contact and evaluate it, without moving time."""
        if self._phase is not Phase.SETTLED:
            self._guard(self._initialise)
        self._phase = Phase.STEPPING

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advance under held inputs. False, which ends the simulation, only after the user's interrupt."""
        if not self._interrupted:
            self._guard(self._advance, step_size)
        return not self._interrupted

    def _initialise(self) -> None:
        """Make scene, state and outputs from the parameters and inputs as they are now."""
        self._phase = Phase.SETTLED
        self._scene = self._state = None
        self._fault = "an unexpected error was logged at initialisation."
        try:
            scene = self._rebuilt(self._values)
            state = self._first_state(scene)
        except ContactError as error:
            self._fault = str(error)
            raise
        self._scene, self._state = scene, state
        self._advance(0.0)

    def _rebuilt(self, values: Sequence[Value]) -> Scene:
        """The scene with the parameters in `values`."""
        parameters = self._named("parameter", values)
        return with_values(self._design, {name: x for name, x in parameters.items() if name != INITIAL_STATE})

    def _first_state(self, scene: Scene) -> ContactState:
        path = self._named("parameter", self._values)[INITIAL_STATE]
        if not path:
            return initial_state(scene)
        try:
            data = Path(path).read_bytes()
        except OSError as error:
            raise StateError(
                f"{INITIAL_STATE} = '{path}' cannot be read: {error.strerror}. "
                "Give the path of a stored state, or leave it empty."
            ) from None
        return ContactState.from_bytes(data, scene)

    def _advance(self, step_size: float) -> None:
        if self._scene is None or self._state is None:
            raise ContactError(f"The contact is not set up: {self._fault}")
        point = OperatingPoint(**self._named("input", self._values))
        state, outputs = advance(self._scene, point, self._state, step_size)
        results: dict[str, float] = {name: x for name, x in asdict(outputs).items() if name in self._references}
        broken = [name for name, value in results.items() if not math.isfinite(value)]
        if broken:
            raise ConvergenceError(
                f"No finite {', '.join(broken)} came out at {point}. Change the inputs, or go back to an earlier state."
            )
        self._state = state
        for name, value in results.items():
            reference = self._references[name]
            self._values[reference] = type(self._variables[reference].start)(value)
        self._values[self._references["valid"]] = True

    def _named(self, causality: Causality, values: Sequence[Value]) -> dict[str, Any]:
        pairs = zip(self._variables, values, strict=True)
        return {variable.name: value for variable, value in pairs if variable.causality == causality}

    # the guard

    def _guard(self, action: Callable[..., None], *arguments: Any) -> None:
        """Run `action`; whatever it raises becomes one log entry and valid = false."""
        try:
            action(*arguments)
        except ContactError as error:
            self._refuse(str(error), Fmi2Status.warning)
        except KeyboardInterrupt:
            self._interrupted = True
            self._refuse("Interrupted by the user.", Fmi2Status.warning)
        except Exception:
            self._refuse(f"Unexpected error in the contact. {traceback.format_exc()}", Fmi2Status.error)

    def _refuse(self, reason: str, status: Fmi2Status) -> None:
        self._values[self._references["valid"]] = False
        # the host reads the message as a printf format, the binary as strict UTF-8
        self.log(reason.replace("%", "%%").encode("utf-8", "backslashreplace").decode(), status)

    # variables by value reference

    def _get(self, references: list[int], kind: Kind) -> list[Any]:
        if self._phase is Phase.UNSETTLED and any(self._causality(vr) == "output" for vr in references):
            self._guard(self._initialise)
        found = []
        for vr in references:
            known = self._causality(vr) is not None and self._variables[vr].kind == kind
            if not known:
                self._refuse(f"There is no {kind} variable with value reference {vr}.", Fmi2Status.warning)
            found.append(self._values[vr] if known else ZERO[kind])
        return found

    def _set(self, references: list[int], values: Sequence[Value], kind: Kind) -> None:
        for vr, value in zip(references, values, strict=True):
            self._guard(self._store, vr, value, kind)

    def _store(self, reference: int, value: Value, kind: Kind) -> None:
        causality = self._causality(reference)
        if causality is None or self._variables[reference].kind != kind:
            raise ContactError(f"There is no {kind} variable with value reference {reference}.")
        name = self._variables[reference].name
        if causality == "output":
            raise ContactError(f"{name} is an output and cannot be set.")
        if causality == "parameter" and self._phase is Phase.STEPPING:
            raise ContactError(f"{name} is a parameter: set it before initialisation ends, or reset the FMU first.")
        self._values[reference] = value
        if self._phase is Phase.SETTLED:
            self._phase = Phase.UNSETTLED

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
        return Snapshot(self._module, self._phase, self._fault, tuple(self._values), self._scene, self._state)

    def _set_fmu_state(self, handle: Snapshot | bytes) -> None:
        self._guard(self._restore, handle)

    def _restore(self, handle: Snapshot | bytes) -> None:
        snapshot = Snapshot.from_bytes(handle, self._rebuilt) if isinstance(handle, bytes) else handle
        if snapshot.module != self._module:
            raise StateError("The FMU state belongs to another FMU. Use one that an FMU of the same scene has given.")
        self._values = list(snapshot.values)
        self._scene, self._state = snapshot.scene, snapshot.state
        self._phase, self._fault = snapshot.phase, snapshot.fault

    @staticmethod
    def _fmu_state_to_bytes(handle: Snapshot | bytes) -> bytes:
        return handle if isinstance(handle, bytes) else handle.data

    @staticmethod
    def _fmu_state_from_bytes(data: bytes) -> bytes:
        return data
