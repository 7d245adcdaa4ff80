"""The running FMUs of a system, coupled: they exchange values at communication points and advance between them."""

import math
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from fmpy.fmi1 import FMICallException
from numpy.typing import NDArray

from contact_core.kernels.arrays import Array

from ..fmu.errors import CouplingError, NotFiniteError
from ..fmu.instance import Instance
from ..numerics import hold
from ..numerics.control import wrms
from ..numerics.hold import History, Past
from ..numerics.iteration import METHODS, Method
from .initial import initialise, with_feedthrough
from .linear import Correction
from .magnitudes import Magnitudes, positive
from .passed_on import PassedOn
from .running import Running
from .sequence import Block, blocks, feedthrough_order
from .settings import Settings
from .system import Port, System

_SAME_TIME = 1e-12  # relative to the step: a step that ends this close to its end has got there
_MOST_ITERATIONS = 50


class Outcome(NamedTuple):
    """Iterations and residual of a step."""

    iterations: int  # passes through the FMUs of the loop that needed most
    residual: float  # of the iteration, up to 1 it has converged; 0 without one


class StoppedEarly(Exception):  # noqa: N818 - no error
    """An FMU has not gone to the end of a step."""

    def __init__(self, name: str, time: float) -> None:
        super().__init__(name, time)
        self.name, self.time = name, time


@dataclass
class Point:
    """A communication point to which the whole system can go back."""

    time: float
    outputs: Array
    history: Past
    passed: list[Any]
    memories: list[Any]
    states: dict[str, Any]  # of the FMUs; empty if one of them cannot go back


class Coupled(Running):
    """The FMUs of a system between two communication points: how their inputs go on, and how a step is made."""

    def __init__(self, system: System, recorded: Sequence[Port], settings: Settings, exits: ExitStack) -> None:
        super().__init__(system, recorded, settings, exits)
        self.magnitudes = Magnitudes([system.port(name).nominal or 0.0 for name in self.wiring.outputs])
        self.history = History(settings.order, self.wiring.sampled)
        self.iteration_tolerance = settings.converged
        self._blocks = blocks(system, self.instances, self.wiring.inputs, settings)
        self._methods: list[Method] = [METHODS[settings.iterate]() for _ in self._blocks] if settings.iterate else []
        self._feedthrough = feedthrough_order(system, self.instances)
        self._correction = Correction(system, self.wiring)
        self._passed = PassedOn([c for c in system.connections if c.target.name not in self.wiring.input_place])
        self._held: Array | None = None  # inputs at the end of the last step, as the FMUs received them

    def initialise(self) -> None:
        """Bring all FMUs to consistent initial values at the time 0."""
        for name, value in self.system.parameters.items():
            self.set(name, value)
        for instance in self.instances.values():
            with self.named(instance, "to be initialised"):
                instance.enter_initialization(self.time, self.settings.stop_time, self.settings.tolerance)
        self.set_scheduled(lambda time: time <= self.settings.margin(self.time))
        initialise(self.instances, self.system.connections)
        for instance in self.instances.values():
            with self.named(instance, "to be initialised"):
                instance.exit_initialization()
        self._feedthrough = with_feedthrough(self.instances, self._feedthrough)
        self.restart()

    def restart(self) -> None:
        """Begin anew at this time: read all outputs, and forget the past."""
        for instance in self.instances.values():
            self.read(instance)
        self.history.clear()
        for method in self._methods:
            method.clear()
        self._held = None
        self._exchange(explicit=True)

    def remember(self, past: Sequence[tuple[float, Array]]) -> None:
        """Take outputs before now, (time, values) from the oldest on, as the history of the extrapolation."""
        self.history.clear()
        for time, outputs in [*past, (self.time, self.outputs)]:
            self.history.push(time, self.wiring.inputs_from(outputs))

    def advance(self, end: float, start: Point) -> Outcome:
        """Make one communication step to the time `end` from `start`, which is now.

        Raises StoppedEarly if an FMU does not get to its end: then the system must go back.
        """
        size = end - self.time
        outcome = self._iterated(size, start) if self.settings.iterate else self._explicit(size, start)
        self.time = end
        self._exchange(explicit=self.settings.iterate is None)
        return outcome

    @property
    def repeats(self) -> bool:
        """True if the next step goes back to its start: to iterate, or for want of the past that its order needs."""
        short = self.restores and len(self.history) <= self.settings.order
        return self.settings.iterate is not None or short

    def _explicit(self, size: float, start: Point) -> Outcome:
        """Pass once with extrapolated inputs; without enough past, once more for each order, interpolating."""
        polynomial = self.history.extrapolate()
        repeats = self.settings.order if self.repeats else 0
        for again in range(repeats + 1):
            if again:
                polynomial = self.history.interpolate(size, self.wiring.inputs_from(self.outputs))
                for name in self.instances:
                    self.go_back(name, start.states, start.time)
            ends = hold.value(polynomial, size)
            for block in self._blocks:
                self._pass(block, size, polynomial, ends)
        self._held = ends
        return Outcome(1 + repeats, 0.0)

    def _iterated(self, size: float, start: Point) -> Outcome:
        ends = hold.value(self.history.extrapolate(), size)
        worst = Outcome(1, 0.0)
        for block, method in zip(self._blocks, self._methods, strict=True):
            outcome = self._solve(block, method, size, start, ends)
            worst = Outcome(max(worst.iterations, outcome.iterations), max(worst.residual, outcome.residual))
        self._held = ends
        return worst

    def _solve(self, block: Block, method: Method, size: float, start: Point, ends: Array) -> Outcome:
        """Pass through a block until the inputs at the end of the step are those that its outputs give.

        ends: a guess of these inputs, of the whole system.
        """
        ends[block.outside] = self.wiring.inputs_from(self.outputs, block.outside)
        unknown = block.unknown
        if not len(unknown):  # no loop
            self._pass(block, size, self.history.interpolate(size, ends), ends)
            return Outcome(1, 0.0)
        guess, floor = ends[unknown], np.abs(self.wiring.factor * self.magnitudes.known[self.wiring.source])[unknown]
        method.start(self.iteration_tolerance * positive(np.maximum(floor, abs(guess))))
        iteration, residual, result = 0, math.inf, guess
        with np.errstate(over="ignore", invalid="ignore"):  # where it diverges
            while residual > 1.0 and iteration < _MOST_ITERATIONS:
                if iteration:
                    guess = method.next(guess, result)
                    if not np.isfinite(guess).all():
                        break
                    for name in block.names:
                        self.go_back(name, start.states, start.time)
                iteration += 1
                ends[unknown] = guess
                self._pass(block, size, self.history.interpolate(size, ends), ends)
                result = self.wiring.inputs_from(self.outputs, unknown)
                scale = self.iteration_tolerance * positive(np.maximum(floor, np.maximum(abs(result), abs(guess))))
                residual = wrms(result - guess, scale)
                residual = math.inf if math.isnan(residual) else residual
        if math.isfinite(residual):
            method.accept(guess, result)
        return Outcome(iteration, residual)

    def _pass(self, block: Block, size: float, polynomial: Array, ends: Array) -> None:
        """Step the FMUs of a block; those late in a Gauss-Seidel sequence see the results of the early ones.

        ends: the inputs at the end of the step, of the whole system; those that turn out others are changed.
        """
        end = self.time + size
        for name, fresh in block.sequence:
            instance, inputs = self.instances[name], polynomial[:, self.wiring.input_of[name]]
            self._require_size(instance, size)
            if len(fresh):
                own = self.wiring.input_of[name]
                now = self.wiring.inputs_from(self.outputs, own)
                ends[own][fresh] = now[fresh]
                latest = self.history.interpolate(size, now, own)
                inputs = latest if len(fresh) == instance.inputs.count else _with_columns(inputs, latest, fresh)
            try:
                reached = instance.step(self.time, size, inputs)
                if end - reached > _SAME_TIME * size:
                    raise StoppedEarly(name, reached)
                instance.read()
            except FMICallException as error:
                raise instance.failure(f"in the step from {self.time:g} s to {end:g} s", error) from error
            self.outputs[self.wiring.output_of[name]] = instance.outputs.values
            if name in self._correction.owners:
                self._to_end(instance, hold.value(inputs, size))

    def _require_size(self, instance: Instance, size: float) -> None:
        step = self.settings.step_size
        variable = instance.model.capabilities.canHandleVariableCommunicationStepSize
        if not variable and abs(size - step) > self.settings.margin(self.time):
            raise CouplingError(
                f"The FMU '{instance.name}' takes steps of one size only (canHandleVariableCommunicationStepSize is "
                f"false), {step:g} s here, but the step from {self.time:g} s must be one of {size:g} s: points, or an "
                "event that another FMU announces, are no multiples of it. Take another step_size."
            )

    def _to_end(self, instance: Instance, inputs: Array) -> None:
        """Correct the outputs of an FMU from the inputs that it received to those at the end of the step."""
        change = np.zeros(len(self.wiring.inputs))
        if not instance.interpolates:
            change[self.wiring.input_of[instance.name]] = inputs - instance.inputs.values
            self._correction.move(self.outputs, change)

    def _exchange(self, explicit: bool) -> None:
        """Exchange the values of the FMUs; outputs that depend directly on inputs follow these at once."""
        self._passed.settle(self)
        if explicit:
            self._refresh()
        if not np.isfinite(self.outputs).all():
            place = int(np.flatnonzero(~np.isfinite(self.outputs))[0])
            raise NotFiniteError(
                f"'{self.wiring.outputs[place]}' is {self.outputs[place]} at {self.time:g} s. "
                "Take smaller steps, iterate, or look into its FMU."
            )
        self.history.push(self.time, self.wiring.inputs_from(self.outputs))

    def _refresh(self) -> None:
        if self._correction.owners and self._held is not None:
            self._correction.settle(self.outputs, self._held)
        for name in self._feedthrough:
            instance = self.instances[name]
            instance.inputs.values[:] = self.wiring.inputs_from(self.outputs, self.wiring.input_of[name])
            with self.named(instance, f"at {self.time:g} s"):
                instance.set_inputs()
            self.read(instance)

    def save(self) -> Point:
        """Return the present point. The FMUs can go back to it only if all of them can; `release` frees it."""
        states = self.saved() if self.restores else {}
        memories = [method.copy() for method in self._methods]
        return Point(self.time, self.outputs.copy(), self.history.copy(), list(self._passed.values), memories, states)

    def restore(self, point: Point) -> None:
        """Go back to a point."""
        for name in self.instances:
            self.go_back(name, point.states, point.time)
        self.time = point.time
        self.outputs[:] = point.outputs
        self.history.restore(point.history)
        self._passed.values[:] = point.passed
        for method, memory in zip(self._methods, point.memories, strict=True):
            method.restore(memory)

    def release(self, point: Point) -> None:
        """Free the states of FMUs that a point holds."""
        self.freed(point.states)

    def stored(self) -> tuple[dict[str, bytes], dict[str, Any]]:
        """Return the states of the FMUs as bytes, and all else that another process needs to continue."""
        return self.serialised(), {
            "time": self.time,
            "outputs": self.outputs.copy(),
            "history": self.history.copy(),
            "passed": list(self._passed.values),
            "memories": [method.copy() for method in self._methods],
            "magnitudes": self.magnitudes.known.copy(),
            "expected": self.magnitudes.expected.copy(),
            "held": self._held,
            "counts": self.counts(),
        }

    def continue_from(self, states: Mapping[str, bytes], memory: Mapping[str, Any]) -> None:
        """Go to a point that `stored` has returned."""
        self.deserialise(states, memory["counts"])
        self.time = memory["time"]
        self.outputs[:] = memory["outputs"]
        self.history.restore(memory["history"])
        self._passed.values[:] = memory["passed"]
        for method, kept in zip(self._methods, memory["memories"], strict=True):
            method.restore(kept)
        self.magnitudes.known[:] = memory["magnitudes"]
        self.magnitudes.expected[:] = memory["expected"]
        self._held = memory["held"]

    def ends(self) -> Array:
        """Return the inputs at the end of the last step, as the FMUs have received them, over their magnitudes."""
        assert self._held is not None  # there has been one
        return self._held / positive(np.abs(self.wiring.factor * self.magnitudes.known[self.wiring.source]))

    def nodes(self, size: float) -> list[float]:
        """Return the times [s], from now, at which the inputs of a step of a size are those of the outputs."""
        ages = [-age for age in self.history.ages()]
        return ([size, *ages] if self.repeats else ages)[: self.settings.order + 1]

    def power_residuals(self) -> list[float]:
        """Return the power that the coupling has added to each bond at the end of the last step [W]."""
        return self.wiring.power_residuals(self.outputs, self._held)


def _with_columns(old: Array, new: Array, columns: NDArray[np.intp]) -> Array:
    """Return polynomials with some columns from others, which may be of higher degree."""
    mixed = np.zeros_like(new)
    mixed[: len(old)] = old
    mixed[:, columns] = new[:, columns]
    return mixed
