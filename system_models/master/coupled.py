"""The running FMUs of a system: they exchange values at communication points and advance between them."""

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.model_description import ModelVariable
from numpy.typing import NDArray

from . import hold
from .control import wrms
from .errors import CouplingError
from .hold import History
from .initial import initialise
from .iteration import METHODS, Method
from .linear import Correction
from .sequence import Block, blocks, feedthrough_order
from .slave import Slave
from .start import started
from .system import Connection, Port, System

_SAME_TIME = 1e-12  # relative to the step: a step that ends this close to its end has got there


@dataclass(frozen=True)
class Scheme:
    """How a communication step is made."""

    algorithm: str = "jacobi"
    order: int = 0
    iterate: str | None = None
    iteration_tolerance: float = 1e-6
    most_iterations: int = 50


class Outcome(NamedTuple):
    """How a step went."""

    iterations: int  # passes through the FMUs of the loop that needed most
    residual: float  # of the iteration, 1 = just converged; 0 without one


class StoppedEarly(Exception):
    """An FMU has not gone to the end of a step."""

    def __init__(self, name: str, time: float) -> None:
        super().__init__(name, time)
        self.name, self.time = name, time


@dataclass
class Point:
    """A communication point to which the whole system can go back."""

    time: float
    outputs: NDArray[np.float64]
    history: Any
    passed: list[Any]
    memories: list[Any]
    states: dict[str, Any]  # of the FMUs; empty if one of them cannot go back


class Coupled:
    """The FMUs of a system between two communication points.

    time in s; outputs [number of Real outputs] of all FMUs, those in `names`. Every method that calls an FMU raises
    CouplingError if it fails.
    """

    def __init__(self, system: System, recorded: Sequence[Port], scheme: Scheme, exits: ExitStack) -> None:
        self.system, self.scheme = system, scheme
        self.restores = all(model.restores for model in system.models.values())
        reals = [c for c in system.connections if c.source.kind == c.target.kind == "real"]
        read = [c.source for c in reals] + [*recorded, *system.events, *system.derivatives.values()]
        read += [bond_end.source for bond in system.bonds for bond_end in (bond.one, bond.other)]
        read += [system.port(of) for of, _ in system.derivatives]
        self.slaves: dict[str, Slave] = started(
            system,
            {name: [c.target.variable for c in reals if c.target.model.name == name] for name in system.models},
            {name: _real_variables(read, name) for name in system.models},
            self.restores,
            exits,
        )
        self._output_of, self.names = self._index("outputs")
        self._input_of, input_names = self._index("inputs")
        self.outputs = np.zeros(len(self.names))
        position = {name: n for n, name in enumerate(self.names)}
        by_target = {c.target.name: c for c in reals}
        wired = [by_target[name] for name in input_names]
        self._source = np.array([position[c.source.name] for c in wired], dtype=np.intp)
        self._factor = np.array([c.factor for c in wired])
        self._offset = np.array([c.offset for c in wired])
        self.coupled = np.unique(self._source)  # outputs that set an input
        self._passed_on = [c for c in system.connections if c not in reals]
        self._passed: list[Any] = [None] * len(self._passed_on)
        self.history = History(scheme.order)
        place = {name: n for n, name in enumerate(input_names)}
        self._bonds = [
            (b.watt, position[b.one.source.name], place[b.one.target.name],
             position[b.other.source.name], place[b.other.target.name])
            for b in system.bonds
        ]
        self._correction = Correction(system, position, input_names, self._source, self._factor)
        gauss_seidel = scheme.algorithm == "gauss_seidel"
        self.blocks = blocks(system, self.slaves, input_names, gauss_seidel, loops=bool(scheme.iterate))
        self._feedthrough = feedthrough_order(system, self.slaves)
        self._methods: list[Method] = [METHODS[scheme.iterate]() for _ in self.blocks] if scheme.iterate else []
        self.magnitudes = np.array([_nominal(system.port(name)) for name in self.names])  # that outputs reach, at least
        self.iteration_tolerance = scheme.iteration_tolerance
        self.time = 0.0
        self._held: NDArray[np.float64] | None = None  # inputs at the end of the last step, as they were extrapolated

    def _index(self, which: str) -> tuple[dict[str, slice], list[str]]:
        places, names = {}, []
        for slave in self.slaves.values():
            reals = getattr(slave, which)
            places[slave.name] = slice(len(names), len(names) + reals.count)
            names += [f"{slave.name}.{name}" for name in reals.names]
        return places, names

    def initialise(self, stop: float, tolerance: float | None) -> None:
        """Bring all FMUs to consistent initial values at the time 0."""
        for name, value in self.system.parameters.items():
            self.set(name, value)
        for slave in self.slaves.values():
            with self._named(slave, "to be initialised"):
                slave.enter_initialization(self.time, stop, tolerance)
        self.set_scheduled(self.time)
        initialise(self.slaves, self.system.connections)
        for slave in self.slaves.values():
            with self._named(slave, "to be initialised"):
                slave.exit_initialization()
        self.meet()

    def set(self, name: str, value: Any) -> None:
        """Set one variable from outside."""
        port = self.system.port(name)
        with self._named(self.slaves[port.model.name], f"to take '{name}' = {value!r}"):
            self.slaves[port.model.name].set(port.variable, value)

    def get(self, port: Port) -> Any:
        """The value of a variable of any type."""
        return self.slaves[port.model.name].get(port.variable)

    def set_scheduled(self, time: float) -> bool:
        """Set the inputs whose schedule has a value at just this time, and say whether there are any."""
        due = [(name, value) for name, steps in self.system.schedule.items() for at, value in steps if at == time]
        for name, value in due:
            self.set(name, value)
        return bool(due)

    def meet(self) -> None:
        """Begin anew at this time: read all outputs, and forget what was before."""
        for slave in self.slaves.values():
            slave.read()
            self.outputs[self._output_of[slave.name]] = slave.outputs.values
        self.history.clear()
        for method in self._methods:
            method.clear()
        self._held = None
        self._exchange(explicit=True)

    def remember(self, past: Sequence[tuple[float, NDArray[np.float64]]]) -> None:
        """Take outputs before now, (time, values) from the oldest on, as the history of the extrapolation."""
        self.history.clear()
        for time, outputs in past:
            self.history.push(time, self._inputs(outputs))
        self.history.push(self.time, self._inputs())

    def _inputs(self, outputs: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """The coupled inputs that go with outputs, those of now if none are given."""
        return (self.outputs if outputs is None else outputs)[self._source] * self._factor + self._offset

    def advance(self, end: float, start: Point | None = None) -> Outcome:
        """One communication step to the time `end`; an iterated one goes back to `start`, which is now.

        Raises StoppedEarly if an FMU does not get to its end: then the system must go back.
        """
        size = end - self.time
        outcome = self._explicit(size) if start is None else self._iterated(size, start)
        self.time = end
        self._exchange(explicit=start is None)
        return outcome

    def _explicit(self, size: float) -> Outcome:
        polynomial = self.history.extrapolate()
        for block in self.blocks:
            self._pass(block, size, polynomial)
        self._held = hold.value(polynomial, size)
        return Outcome(1, 0.0)

    def _iterated(self, size: float, start: Point) -> Outcome:
        ends = hold.value(self.history.extrapolate(), size)
        worst = Outcome(1, 0.0)
        for block, method in zip(self.blocks, self._methods, strict=True):
            outcome = self._solve(block, method, size, start, ends)
            worst = Outcome(max(worst.iterations, outcome.iterations), max(worst.residual, outcome.residual))
        self._held = ends
        return worst

    def _solve(
        self, block: Block, method: Method, size: float, start: Point, ends: NDArray[np.float64]
    ) -> Outcome:
        """Pass through a block until the inputs at the end of the step are what comes out of it.

        ends: a guess of these inputs, of the whole system.
        """
        ends[block.outside] = self._inputs()[block.outside]
        unknown = block.unknown
        if not len(unknown):  # no loop
            self._pass(block, size, self.history.interpolate(size, ends))
            return Outcome(1, 0.0)
        guess, floor = ends[unknown], np.abs(self._factor * self.magnitudes[self._source])[unknown]
        method.start(self.iteration_tolerance * _positive(np.maximum(floor, abs(guess))))
        iteration, residual = 0, math.inf
        while residual > 1.0 and iteration < self.scheme.most_iterations:
            if iteration:
                guess = method.next(guess, result)
                for name in block.names:
                    self._restore_slave(name, start)
            iteration += 1
            ends[unknown] = guess
            self._pass(block, size, self.history.interpolate(size, ends))
            result = self._inputs()[unknown]
            scale = self.iteration_tolerance * _positive(np.maximum(floor, np.maximum(abs(result), abs(guess))))
            residual = wrms(result - guess, scale)
        method.accept(guess, result)
        ends[block.within] = self._inputs()[block.within]
        ends[unknown] = guess
        return Outcome(iteration, residual)

    def _pass(self, block: Block, size: float, polynomial: NDArray[np.float64]) -> None:
        """Step the FMUs of a block; those late in a Gauss-Seidel sequence see what the early ones have reached."""
        end = self.time + size
        for name, fresh in block.sequence:
            slave, inputs = self.slaves[name], polynomial[:, self._input_of[name]]
            if len(fresh):
                latest = self.history.interpolate(size, self._inputs())[:, self._input_of[name]]
                inputs = _with_columns(inputs, latest, fresh)
            try:
                reached = slave.step(self.time, size, inputs)
                if end - reached > _SAME_TIME * size:
                    raise StoppedEarly(name, reached)
                slave.read()
            except FMICallException as error:
                raise self._failure(slave, f"in the step from {self.time:g} s to {end:g} s", error) from error
            self.outputs[self._output_of[name]] = slave.outputs.values

    def _exchange(self, explicit: bool) -> None:
        """Pass on what the FMUs have reached; outputs that depend directly on inputs follow these at once."""
        for n, connection in enumerate(self._passed_on):
            value = self.get(connection.source)
            if value != self._passed[n]:
                self.set(connection.target.name, _converted(connection, value))
                self._passed[n] = value
        if explicit:
            self._refresh()
        if not np.isfinite(self.outputs).all():
            place = int(np.flatnonzero(~np.isfinite(self.outputs))[0])
            raise CouplingError(
                f"'{self.names[place]}' is {self.outputs[place]} at {self.time:g} s. "
                "Take smaller steps, or look into its FMU."
            )
        self.history.push(self.time, self._inputs())

    def _refresh(self) -> None:
        if self._correction and self._held is not None:
            self._correction.apply(self.outputs, self._held, self._offset)
        for name in self._feedthrough:
            slave = self.slaves[name]
            inputs = self._inputs()[self._input_of[name]]
            with self._named(slave, f"at {self.time:g} s"):
                slave.refresh(inputs)
            self.outputs[self._output_of[name]] = slave.outputs.values

    def save(self) -> Point:
        """The point of now. The FMUs can go back to it only if all of them can; `release` frees it."""
        states = {name: slave.save() for name, slave in self.slaves.items()} if self.restores else {}
        memories = [method.copy() for method in self._methods]
        return Point(self.time, self.outputs.copy(), self.history.copy(), list(self._passed), memories, states)

    def restore(self, point: Point) -> None:
        """Go back to a point."""
        for name in self.slaves:
            self._restore_slave(name, point)
        self.time = point.time
        self.outputs[:] = point.outputs
        self.history.restore(point.history)
        self._passed[:] = point.passed
        for method, memory in zip(self._methods, point.memories, strict=True):
            method.restore(memory)

    def _restore_slave(self, name: str, point: Point) -> None:
        slave = self.slaves[name]
        with self._named(slave, f"to go back to {point.time:g} s"):
            slave.restore(point.states[name])
        slave.terminated = False

    def release(self, point: Point) -> None:
        """Free what a point holds of the FMUs."""
        for name, state in point.states.items():
            self.slaves[name].release(state)
        point.states.clear()

    def stored(self) -> tuple[dict[str, bytes], dict[str, Any]]:
        """The states of the FMUs as bytes, and all else that is needed to go on from now in another process."""
        states = {}
        for name, slave in self.slaves.items():
            with self._named(slave, "to give its state"):
                states[name] = slave.serialised()
        return states, {
            "time": self.time,
            "outputs": self.outputs.copy(),
            "history": self.history.copy(),
            "passed": list(self._passed),
            "memories": [method.copy() for method in self._methods],
            "magnitudes": self.magnitudes.copy(),
            "held": self._held,
            "counts": {name: [slave.steps, slave.seconds, slave.events] for name, slave in self.slaves.items()},
        }

    def go_on(self, states: Mapping[str, bytes], memory: Mapping[str, Any]) -> None:
        """Go to what `stored` has given."""
        for name, slave in self.slaves.items():
            with self._named(slave, "to take the state of a checkpoint"):
                slave.deserialise(states[name])
            slave.steps, slave.seconds, slave.events = memory["counts"][name]
        self.time = memory["time"]
        self.outputs[:] = memory["outputs"]
        self.history.restore(memory["history"])
        self._passed[:] = memory["passed"]
        for method, kept in zip(self._methods, memory["memories"], strict=True):
            method.restore(kept)
        self.magnitudes[:] = memory["magnitudes"]
        self._held = memory["held"]

    def accept(self) -> None:
        """The last step stands."""
        np.maximum(self.magnitudes, np.abs(self.outputs), out=self.magnitudes)

    def event(self) -> bool:
        """Whether an FMU has met an event of its own in the last step."""
        return any(slave.event for slave in self.slaves.values())

    def scales(self) -> NDArray[np.float64]:
        """Magnitudes of the outputs that set inputs."""
        return _positive(np.maximum(self.magnitudes, np.abs(self.outputs))[self.coupled])

    def nodes(self, size: float) -> list[float]:
        """The times [s], from now, at which the inputs of a step of a size are those of the outputs."""
        ages = [-age for age in self.history.ages()]
        return ([size, *ages] if self.scheme.iterate else ages)[: self.scheme.order + 1]

    def power_residuals(self) -> list[float]:
        """For each bond, the power [W] that the one FMU gives less the power that the other takes.

        Each reckons with its own output and with what it was told of the other's: the difference is what the coupling
        adds to the system (Sadjina et al. 2017, doi:10.1007/s00366-016-0492-8).
        """
        if self._held is None:
            return [0.0] * len(self._bonds)
        told = (self._held - self._offset) / self._factor
        return [
            watt * (self.outputs[y1] * told[u2] - self.outputs[y2] * told[u1]) for watt, y1, u1, y2, u2 in self._bonds
        ]

    @contextmanager
    def _named(self, slave: Slave, what: str) -> Iterator[None]:
        try:
            yield
        except FMICallException as error:
            raise self._failure(slave, what, error) from error

    @staticmethod
    def _failure(slave: Slave, what: str, error: FMICallException) -> CouplingError:
        return CouplingError(f"The FMU '{slave.name}' failed {what}: {error} Its messages say why.")


def _real_variables(ports: Sequence[Port], name: str) -> list[ModelVariable]:
    """The variables of the FMU `name` among the ports that are read as Real, each once."""
    return [*{port.variable.name: port.variable for port in ports if port.model.name == name and port.kind == "real"}.values()]


def _nominal(port: Port) -> float:
    return abs(float(port.variable.nominal)) if port.variable.nominal else 0.0


def _positive(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Magnitudes; of what has none yet, the 1 that FMI gives to what names no nominal."""
    return np.where(values > 0.0, values, 1.0)


def _with_columns(
    old: NDArray[np.float64], new: NDArray[np.float64], columns: NDArray[np.intp]
) -> NDArray[np.float64]:
    """Polynomials with some columns from others, which may be of another degree."""
    mixed = np.zeros((max(len(old), len(new)), old.shape[1]))
    mixed[: len(old)] = old
    mixed[:, columns] = 0.0
    mixed[: len(new), columns] = new[:, columns]
    return mixed


def _converted(connection: Connection, value: Any) -> Any:
    return connection.factor * value + connection.offset if isinstance(value, float) else value
