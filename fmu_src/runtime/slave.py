"""The slave of a contact: pythonfmu's callbacks in, `contact_core.advance` out; guarded, no physics."""

import contextlib
import math
from collections.abc import Sequence
from itertools import pairwise
from operator import itemgetter
from pathlib import Path
from typing import Any

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
from contact_core.kernels import NOTICE
from contact_core.quantities import LEVELS, OF_CALLER
from contact_core.scene import with_values
from contact_core.state import changed

from ..variables import FIDELITY, INITIAL_STATE, SEED, SPECIAL, Value, Variable, variables
from . import resources
from .guarded import GuardedSlave
from .snapshot import Layout, Scenes, Snapshot, check_owner

OF_SOLVER = RangeFlag.NOT_CONVERGED | RangeFlag.FALLBACK
_NOWHERE = OperatingPoint(load=0.0, speed_1=0.0, speed_2=0.0, temperature=0.0)
_OTHER_LEVEL = int(RangeFlag.OTHER_LEVEL)


class _LevelOutputs:
    """The outputs that the core fills at a level, read and stored all at once."""

    def __init__(self, table: Sequence[Variable], level: str) -> None:
        filled = {
            vr: v.name
            for vr, v in enumerate(table)
            if v.causality == "output" and v.name not in OF_CALLER and level in v.levels
        }
        self.names, self.references = tuple(filled.values()), tuple(filled)
        self._fetch = itemgetter(*self.names)
        # as few copies as there are gaps between the references
        first = [k for k, vr in enumerate(self.references) if vr - 1 not in filled]
        self._runs = [
            (slice(self.references[k], self.references[end - 1] + 1), slice(k, end))
            for k, end in pairwise([*first, len(filled)])
        ]

    def values(self, outputs: Outputs) -> tuple[Any, ...]:
        """Return the values of `names`, in their order."""
        found: tuple[Any, ...] = self._fetch(vars(outputs))
        return found

    def store(self, found: tuple[Any, ...], values: list[Value]) -> None:
        """Store the values found in the values of all variables."""
        for places, part in self._runs:
            values[places] = found[part]

    def check(self, values: tuple[Any, ...], point: OperatingPoint) -> None:
        """Raise ConvergenceError if a value is not finite."""
        broken = [name for name, value in zip(self.names, values, strict=True) if not math.isfinite(value)]
        if broken:
            raise ConvergenceError(
                f"No finite {', '.join(broken)} came out at {point}. Change the inputs, or go back to an earlier state."
            )


class ContactSlave(GuardedSlave):
    """One contact: its scene with the parameters, and its state."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._layout = Layout(self.values)
        self._level_outputs = [_LevelOutputs(self._variables, level) for level in LEVELS]
        self._most_outputs = max(len(outputs.names) for outputs in self._level_outputs)
        self._scenes: Scenes | None = None
        self._state: ContactState | None = None
        self._fault = "its initialisation has not ended."
        if NOTICE:
            self._message(NOTICE, Fmi2Status.ok, "logStatusWarning")

    def _read(self) -> Sequence[Variable]:
        self._design = resources.read(self.resources, self._module)
        return variables(self._design)

    @classmethod
    def warm_up(cls, folder: Path) -> None:
        """Load what the first steps of the contact in these resources need, before processes are forked.

        Raises SceneError if they were built with another version, or edited.
        """
        scene = resources.read(str(folder), cls.__module__)
        warm_up(scene)
        with contextlib.suppress(ContactError):  # the first instance will log it
            # the track means of the fresh surfaces, to be shared by the processes
            advance(scene.at_level(LEVELS[0]), scene.operation.point, initial_state(scene), 0.0)

    def _initialise(self) -> None:
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
        of_this_level = self._level_outputs[self._fidelity() - 1].references
        for reference in {r for outputs in self._level_outputs for r in outputs.references} - {*of_this_level}:
            # another level may have been evaluated earlier in initialisation mode
            self.values[reference] = self._variables[reference].start

    def _rebuilt(self, values: Sequence[Value]) -> Scenes:
        """Return the scene with the parameters in `values`, at each level."""
        parameters = self._parameters(values)
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
        point = changed(_NOWHERE, **inputs)
        state, outputs = advance(self._scenes[fidelity - 1], point, self._state, step_size)
        outputs_of_level = self._level_outputs[fidelity - 1]
        results = outputs_of_level.values(outputs)
        if not math.isfinite(sum(results)):
            outputs_of_level.check(results, point)
        flags = outputs.range_flags | (_OTHER_LEVEL if len(outputs_of_level.names) < self._most_outputs else 0)
        appeared = flags & ~int(self._value("range_flags"))
        self._state = state
        values, references = self.values, self._references
        outputs_of_level.store(results, values)
        values[references["range_flags"]] = flags
        values[references["fidelity_used"]] = fidelity
        values[references["valid"]] = True
        if appeared:
            self._log_flags(RangeFlag(appeared))

    def _fidelity(self) -> int:
        fidelity = int(self._value(FIDELITY))
        if not 1 <= fidelity <= len(LEVELS):
            known = " or ".join(f"{i} ({level})" for i, level in enumerate(LEVELS, 1))
            raise ContactError(f"{FIDELITY} = {fidelity} must be {known}.")
        return fidelity

    def _log_flags(self, appeared: RangeFlag) -> None:
        for flag in appeared:
            category = "logSolver" if flag in OF_SOLVER else "logValidity"
            self._message(f"range_flags: {flag.text}.", Fmi2Status.ok, category)

    def _get_fmu_state(self) -> Snapshot:
        values = tuple(self.values)
        return Snapshot(self._module, self._layout, self.phase, self._fault, values, self._scenes, self._state)

    def _restore(self, handle: Snapshot | bytes) -> None:
        try:
            if isinstance(handle, bytes):
                handle = Snapshot.from_bytes(handle, self._module, self._layout, self._rebuilt)
            check_owner(handle.module, self._module)
        except ContactError as error:
            self._refuse(str(error), Fmi2Status.error, "logValidity")
            return
        self._go_to(handle.values, handle.phase)
        self._scenes, self._state, self._fault = handle.scenes, handle.state, handle.fault

    @staticmethod
    def parts(handle: Snapshot) -> list[bytes | memoryview]:
        """Return the buffers of a state, see GuardedSlave."""
        return handle.parts
