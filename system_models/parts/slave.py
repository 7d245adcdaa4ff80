"""The slave of a component's FMU: callbacks in, the three functions of a `Part` out; guarded, no physics."""

import contextlib
import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from pythonfmu.enums import Fmi2Status

from contact_core.errors import ContactError, StateError
from contact_core.quantities import with_numbers
from fmu_src.phases import Phase
from fmu_src.runtime.guarded import GuardedSlave
from fmu_src.variables import Value, Variable

from . import resources
from .part import Part, State, start_values
from .variables import variables

_MAGIC = "tribofmu part 1"
_ANY_STEP = 1e-3  # s


@dataclass(frozen=True, eq=False)
class Snapshot:
    """All that the next answer depends on. It is never changed, so it needs no copy."""

    module: str  # fingerprint of the FMU it belongs to
    phase: Phase
    stale: bool  # outputs older than the inputs they depend on
    values: tuple[Value, ...]  # by value reference
    part: Part | None  # with the parameters of `values`
    state: State | None

    @cached_property
    def data(self) -> bytes:
        """The snapshot as JSON, which gives every number back bit for bit."""
        held = [_MAGIC, self.module, self.phase, self.stale, self.values, self.state]
        return json.dumps(held).encode()


class PartSlave(GuardedSlave):
    """One component and its state."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._responses = [(v.name, vr) for vr, v in enumerate(self._variables) if v.causality == "output"][:-1]
        self._part: Part | None = None
        self._state: State | None = None
        self._stale = False

    def _read(self) -> Sequence[Variable]:
        self._design = resources.read(self.resources, self._module)
        return variables(self._design)

    @classmethod
    def warm_up(cls, folder: Path) -> None:
        """Load what the first steps of the component in these resources need, before processes are forked.

        Raises SceneError if it cannot be used.
        """
        part = resources.read(str(folder), cls.__module__)
        inputs = start_values(part)
        with contextlib.suppress(ContactError):  # which the first instance will say
            part.outputs(part.advance(part.initial(inputs), inputs, _ANY_STEP), inputs)

    def _initialise(self) -> None:
        self._part = self._state = None
        part = self._rebuilt(self.values)
        state = _finite(part.initial(self._checked_inputs()))
        self._part, self._state = part, state
        self._evaluate(state)

    def _rebuilt(self, values: Sequence[Value]) -> Part:
        part: Part = with_numbers(self._design, self._parameters(values))
        resources.check(part)
        return part

    def _advance(self, step_size: float) -> None:
        if self._part is None or self._state is None:
            raise ContactError("The component is not set up: its initialisation has failed. Correct what was logged.")
        self._stale = False  # if the step fails, the outputs stand
        after = self._state
        if step_size > 0.0:
            after = _finite(self._part.advance(after, self._checked_inputs(), step_size))
        self._evaluate(after)
        self._state = after

    def _evaluate(self, state: State) -> None:
        """Set the outputs of a state, for the inputs as they are."""
        assert self._part is not None
        self._stale = False  # also if they cannot be had: they stand
        found = self._part.outputs(state, self._checked_inputs())
        results = [float(found[name]) for name, _ in self._responses]
        if not all(map(math.isfinite, results)):
            broken = [name for name, value in found.items() if not math.isfinite(value)]
            raise ContactError(f"No finite {', '.join(broken)} came out. Change the inputs, or go back in time.")
        for (_, reference), value in zip(self._responses, results, strict=True):
            self.values[reference] = value
        self.values[self._references["valid"]] = True

    def _checked_inputs(self) -> dict[str, float]:
        inputs: dict[str, Any] = {name: self.values[reference] for name, reference in self._inputs}
        for name, value in inputs.items():
            if not math.isfinite(value):
                raise ContactError(f"{name} = {value} must be a finite number.")
        return inputs

    def _store(self, pairs: Sequence[tuple[int, Value]]) -> None:
        super()._store(pairs)
        if self.phase is Phase.STEPPING and any(self.layout[reference][1] == "direct" for reference, _ in pairs):
            self._stale = True

    def refresh(self) -> None:
        """Evaluate anew if an input has been set on which outputs depend at once."""
        if self._stale and self.phase is Phase.STEPPING and self._state is not None:
            self._guard(self._evaluate, self._state)
        super().refresh()

    def _get_fmu_state(self) -> Snapshot:
        return Snapshot(self._module, self.phase, self._stale, tuple(self.values), self._part, self._state)

    def _restore(self, handle: Snapshot | bytes) -> None:
        try:
            found = self._parsed(handle) if isinstance(handle, bytes) else handle
            if found.module != self._module:
                raise StateError("The FMU state belongs to another FMU. Use one that this component has given.")
        except ContactError as error:
            self._refuse(str(error), Fmi2Status.error, "logValidity")
            return
        self._go_to(found.values, found.phase)
        self._stale, self._part, self._state = found.stale, found.part, found.state

    def _parsed(self, data: bytes) -> Snapshot:
        try:
            magic, module, phase, stale, values, state = json.loads(data)
            found = Snapshot(module, Phase(phase), bool(stale), tuple(values), None, state and tuple(state))
        except (ValueError, TypeError):
            magic = ""
        if magic != _MAGIC or [*map(type, found.values)] != [type(v.start) for v in self._variables]:
            raise StateError("The stored state is none of this component, or damaged. Use one that it has serialised.")
        part = None if state is None else self._rebuilt(found.values)
        return Snapshot(found.module, found.phase, found.stale, found.values, part, found.state)


def _finite(state: State) -> State:
    """Return a state. Raises ContactError if a number in it is not finite: it would spoil all that come after it."""
    if not all(map(math.isfinite, state)):
        raise ContactError("The state would not be finite, and stays as it was. Change the inputs.")
    return state
