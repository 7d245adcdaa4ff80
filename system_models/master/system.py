"""A system: FMUs, the connections between them, parameters and schedules."""

import math
import unicodedata
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from fmpy.model_description import ModelVariable

from contact_core.errors import did_you_mean

from ..fmu.errors import CouplingError
from ..fmu.kinds import discrete, holds, kind
from ..fmu.model import MOST_ELEMENTS, Model
from . import unit_checks

Value = float | int | bool | str

_OWN = ("master", "bond")  # before a dot, in names of columns
_RECORDED = ("real", "integer", "boolean")  # kinds of outputs


@dataclass(frozen=True)
class Port:
    """A variable of an FMU in a system."""

    model: Model
    variable: ModelVariable

    @property
    def name(self) -> str:
        return f"{self.model.name}.{self.variable.name}"

    @property
    def kind(self) -> str:
        """real, integer, boolean or string; array, one too large to be exchanged by its elements."""
        return "array" if self.variable.dimensions else kind(self.variable)

    @property
    def continuous(self) -> bool:
        """True for a Real that may change between communication points."""
        return self.kind == "real" and not discrete(self.variable)

    @property
    def nominal(self) -> float | None:
        """Its order of magnitude, where the FMU says it."""
        return abs(float(self.variable.nominal)) if self.variable.nominal else None


@dataclass(frozen=True)
class Connection:
    """An output that sets an input: target = factor * source + offset, units converted."""

    source: Port
    target: Port
    factor: float
    offset: float

    @property
    def sampled(self) -> bool:
        """True if its value holds between communication points, because an end is discrete."""
        return discrete(self.source.variable) or discrete(self.target.variable)

    @property
    def single(self) -> bool:
        """True if an end is of single precision."""
        return "Float32" in (self.source.variable.type, self.target.variable.type)

    @property
    def coupled(self) -> bool:
        """True for a Real input that is set in every step; the others are set when their values change."""
        model, variable = self.target.model, self.target.variable
        by_events = model.fmi3 and model.capabilities.hasEventMode and discrete(variable)
        return self.source.kind == self.target.kind == "real" and not by_events

    def result(self, value: Any) -> Any:
        """Return the value of the target for a value of the source."""
        found = self.factor * value + self.offset if self.source.kind == "real" else value
        if self.source.kind == "integer":
            _check_holds(self.target, found)
        return found


@dataclass(frozen=True)
class Bond:
    """A power that leaves one FMU and enters another: two connections, one each way."""

    effort: Connection
    flow: Connection
    watt: float  # per product of the two sources, in their own units

    @property
    def name(self) -> str:
        """The two outputs whose product it is."""
        return f"{self.effort.source.name}*{self.flow.source.name}"


class System:
    """A graph of FMUs, checked.

    fmus: path of the .fmu file by name; the name has no dot. connections: (output, input) or (output, input, factor)
    by their names "fmu.variable"; units are converted, and refused where they do not fit. parameters: start values of
    parameters and inputs; that of a connected input is where the search for consistent initial values begins.
    schedule: (time [s], value) pairs of an input that nothing is connected to, which holds each value until the next;
    the times are communication points. events: outputs whose change of sign (Real) or of value (all others) must not be
    stepped over. bonds: pairs of connected outputs, effort and flow: a force on the other FMU, and that FMU's speed.
    derivatives: the output that is the derivative of an output by an input, {("a.force", "a.speed"): "a.dforce"}.

    Raises CouplingError for variables that do not exist or cannot be coupled.
    """

    def __init__(
        self,
        fmus: Mapping[str, str | Path],
        connections: Iterable[Sequence[Any]] = (),
        parameters: Mapping[str, Value] | None = None,
        schedule: Mapping[str, Sequence[tuple[float, Value]]] | None = None,
        events: Iterable[str] = (),
        bonds: Iterable[tuple[str, str]] = (),
        derivatives: Mapping[tuple[str, str], str] | None = None,
    ) -> None:
        self.models = {name: Model(_fmu_name(name), fmus[name]) for name in sorted(fmus)}
        if not self.models:
            raise CouplingError("The system has no FMU. Name at least one.")
        found = [self._connection(*_pair(entry)) for entry in connections]
        self.connections = sorted(found, key=lambda connection: connection.target.name)
        self._check_targets()
        self.parameters = {name: self._start(name, value) for name, value in sorted((parameters or {}).items())}
        self.schedule = {name: self._schedule(name, steps) for name, steps in sorted((schedule or {}).items())}
        self.events = [self._output(name, "an event") for name in sorted({*events})]
        self.bonds = [self._bond(*pair) for pair in sorted({(effort, flow) for effort, flow in bonds})]
        self.derivatives = {
            (self._output(of, "a derivative").name, self._input(by, "a derivative").name): self._output(
                name, "a derivative"
            )
            for (of, by), name in sorted((derivatives or {}).items())
        }
        self._check_derivatives()

    def port(self, name: str) -> Port:
        """Return the variable "fmu.variable". Raises CouplingError if there is none."""
        owner, dot, variable = str(name).partition(".")
        if not dot or owner not in self.models:
            raise CouplingError(
                f"'{name}' names no variable of this system: its FMUs are {', '.join(self.models)}, "
                f"and a variable is called FMU.VARIABLE.{did_you_mean(owner, list(self.models))}"
            )
        model = self.models[owner]
        if elements := model.arrays.get(variable):
            raise CouplingError(
                f"'{name}' is an array, which is exchanged by its elements. Name them: '{owner}.{elements[0]}' to "
                f"'{owner}.{elements[-1]}'."
            )
        if variable not in model.variables:
            raise CouplingError(
                f"The FMU '{owner}' has no variable '{variable}'.{did_you_mean(variable, list(model.variables))} "
                f"`fmpy info {model.path}` lists them."
            )
        return Port(model, model.variables[variable])

    def outputs(self, names: Iterable[str] | None) -> list[Port]:
        """Return the variables to record: those named and verdicts of FMUs, or every output that is no text.

        An array by its elements.
        """
        if isinstance(names, str):
            raise CouplingError(f"outputs = {names!r} is one name. Give a list of names.")
        if names is not None:
            every = dict.fromkeys([*names, *self.verdicts.values()])
            return [element for name in every for element in self._recorded(name)]
        return [port for port in self._every_output() if port.kind in _RECORDED]

    @property
    def verdicts(self) -> dict[str, str]:
        """The output `valid` of each FMU that has one: whether it could use its inputs."""
        return {name: f"{name}.{m.verdict.name}" for name, m in self.models.items() if m.verdict is not None}

    def left_out(self) -> list[str]:
        """Return the outputs that are recorded only where they are named, if at all: texts, binary data and arrays."""
        return [port.name for port in self._every_output() if port.kind not in _RECORDED]

    def _every_output(self) -> Iterator[Port]:
        outputs = ((m, v) for m in self.models.values() for v in m.variables.values() if v.causality == "output")
        return (Port(model, variable) for model, variable in outputs)

    def _recorded(self, name: str) -> list[Port]:
        owner, _, variable = str(name).partition(".")
        elements = self.models[owner].arrays.get(variable) if owner in self.models else None
        ports = [self.port(name)] if elements is None else [self.port(f"{owner}.{each}") for each in elements]
        for port in ports:
            self._check_kind(port)
        return ports

    def _input(self, name: str, what: str) -> Port:
        return self._of_causality(name, "input", what)

    def _output(self, name: str, what: str) -> Port:
        return self._of_causality(name, "output", what)

    def _of_causality(self, name: str, causality: str, what: str) -> Port:
        port = self.port(name)
        if port.variable.causality != causality:
            raise CouplingError(
                f"'{name}' is of causality '{port.variable.causality}', but {what} needs an {causality} there. "
                f"The {causality}s of '{port.model.name}' are "
                f"{', '.join(v.name for v in port.model.variables.values() if v.causality == causality) or 'none'}."
            )
        self._check_kind(port)
        return port

    def _check_kind(self, port: Port) -> None:
        if port.kind == "array":
            raise CouplingError(
                f"'{port.name}' is an array of {math.prod(port.variable.shape)} elements; up to {MOST_ELEMENTS} can be "
                "exchanged. Leave it out."
            )
        if port.kind not in ("real", "integer", "boolean", "string"):
            raise CouplingError(
                f"'{port.name}' is of type {port.variable.type}, which cannot be exchanged. Leave it out."
            )

    def _connection(self, source_name: str, target_name: str, factor: float) -> Connection:
        source = self._output(source_name, "the start of a connection")
        target = self._input(target_name, "the end of a connection")
        if source.kind != target.kind:
            raise CouplingError(
                f"'{source.name}' is of type {source.variable.type} and cannot set '{target.name}' of type "
                f"{target.variable.type}. Connect variables of one type."
            )
        if source.kind != "real":
            if factor != 1.0:
                raise CouplingError(
                    f"The connection from '{source.name}' to '{target.name}' has the factor {factor:g}, but type "
                    f"{source.variable.type} has none. Leave it out."
                )
            return Connection(source, target, 1.0, 0.0)
        if not (math.isfinite(factor) and factor):
            raise CouplingError(
                f"The connection from '{source.name}' to '{target.name}' has the factor {factor:g}. "
                "Give a finite number other than 0."
            )
        try:
            scale, offset = unit_checks.conversion(
                source.variable, source.model.description, target.variable, target.model.description
            )
        except CouplingError as error:
            raise CouplingError(f"'{source.name}' cannot be connected to '{target.name}': {error}") from None
        missing = unit_checks.turns(
            source.variable, source.model.description, target.variable, target.model.description
        )
        if missing and factor == 1.0:
            raise CouplingError(
                f"'{source.name}' in {source.variable.unit} cannot be connected to '{target.name}' in "
                f"{target.variable.unit}: one counts turns, the other is an angle. Give it the factor {missing!r}."
            )
        return Connection(source, target, factor * scale, factor * offset)

    def _check_targets(self) -> None:
        seen: dict[str, Connection] = {}
        for connection in self.connections:
            before = seen.setdefault(connection.target.name, connection)
            if before is not connection:
                raise CouplingError(
                    f"'{connection.target.name}' is set by '{before.source.name}' and by '{connection.source.name}'. "
                    "Connect one output to an input, and add up in an FMU."
                )

    def _free_input(self, name: str, what: str) -> Port:
        port = self._input(name, what)
        for connection in self.connections:
            if connection.target.name == name:
                raise CouplingError(
                    f"'{name}' is set by '{connection.source.name}' and cannot be set by {what}. Leave one of them out."
                )
        return port

    def _start(self, name: str, value: Value) -> Value:
        port = self.port(name)
        if port.variable.causality == "structuralParameter":
            raise CouplingError(
                f"'{name}' is a structural parameter, the size of arrays, and keeps its value here. Leave it out, or "
                "export the FMU with another."
            )
        if port.variable.causality != "input" and (
            port.variable.variability == "constant" or port.variable.initial not in ("exact", "approx")
        ):
            raise CouplingError(
                f"'{name}' of causality '{port.variable.causality}' cannot be set: its FMU calculates it. "
                "Name a parameter, an input or a start value."
            )
        self._check_kind(port)
        return checked(port, value)

    def _schedule(self, name: str, steps: Sequence[tuple[float, Value]]) -> list[tuple[float, Value]]:
        port = self._free_input(name, "a schedule")
        try:
            pairs = [(float(time), checked(port, value)) for time, value in steps]
        except (TypeError, ValueError):
            raise CouplingError(f"The schedule of '{name}' is {steps!r}. Give pairs of time in s and value.") from None
        times = [time for time, _ in pairs]
        if (
            not times
            or not all(map(math.isfinite, times))
            or any(later <= earlier for earlier, later in pairwise(times))
        ):
            raise CouplingError(
                f"The times of the schedule of '{name}' are {times}. Give at least one, and let them rise."
            )
        return pairs

    def _bond(self, first: str, second: str) -> Bond:
        pairs = [
            (one, other)
            for one in self.connections
            for other in self.connections
            if (one.source.name, other.source.name) == (first, second)
            and one.target.model is other.source.model
            and other.target.model is one.source.model
        ]
        if not pairs:
            raise CouplingError(
                f"The bond of '{first}' and '{second}' needs two connections: from the FMU of each to that of the "
                "other. Connect them, or leave the bond out."
            )
        effort, flow = pairs[0]
        a, b = effort.source, flow.source
        if not (a.continuous and b.continuous):
            raise CouplingError(f"The bond of '{first}' and '{second}' is no power: both must be continuous Real.")
        if a.variable.unit is None or b.variable.unit is None:
            return Bond(effort, flow, 1.0)
        watt = unit_checks.power(a.variable, a.model.description, b.variable, b.model.description)
        if watt is None:
            raise CouplingError(
                f"The product of '{a.name}' in {a.variable.unit} and '{b.name}' in {b.variable.unit} is no power. "
                "A bond pairs a force with a speed, a torque with an angular speed, and so on."
            )
        return Bond(effort, flow, watt)

    def _check_derivatives(self) -> None:
        for (of, by), port in self.derivatives.items():
            three = [self.port(of), self.port(by), port]
            if len({one.model.name for one in three}) > 1 or not all(one.continuous for one in three):
                raise CouplingError(
                    f"'{port.name}' cannot be the derivative of '{of}' by '{by}': the three must be continuous Real "
                    "variables of one FMU."
                )


def checked(port: Port, value: Any) -> Value:
    """Return a value as the variable's type has it. Raises CouplingError if it is of another."""
    types: dict[str, tuple[type, ...]] = {"boolean": (bool,), "string": (str,), "integer": (int,)}
    fits = isinstance(value, types.get(port.kind, (int, float))) and (port.kind == "boolean") == isinstance(value, bool)
    if not fits or (port.kind == "real" and not math.isfinite(value)):
        unit = f", in {port.variable.unit or '1'}" if port.kind == "real" else ""
        raise CouplingError(f"'{port.name}' = {value!r} is not a value of type {port.variable.type}. Give one{unit}.")
    _check_holds(port, value)
    return float(value) if port.kind == "real" else value


def _check_holds(port: Port, value: Any) -> None:
    if not holds(port.variable, value):
        raise CouplingError(
            f"'{port.name}' = {value!r} is beyond what {port.variable.type}, its type, can hold. Give a smaller one."
        )


def _fmu_name(name: str) -> str:
    if not isinstance(name, str) or not name or "." in name:
        raise CouplingError(
            f"An FMU cannot be called '{name}': a dot separates it from its variables. Use another name."
        )
    if name in _OWN:
        raise CouplingError(
            f"An FMU cannot be called '{name}': the results have columns '{name}.*' of their own. Use another name."
        )
    if any(unicodedata.category(letter) in ("Cc", "Cs") for letter in name):
        raise CouplingError(f"An FMU cannot be called {name!r}: it has control characters. Use another name.")
    return name


def _pair(entry: Sequence[Any]) -> tuple[str, str, float]:
    ends: list[Any] = list(entry) if isinstance(entry, (list, tuple)) else [entry]
    if len(ends) not in (2, 3) or not all(isinstance(end, str) for end in ends[:2]):
        raise CouplingError(f'The connection {entry!r} is not ("fmu.output", "fmu.input") with a factor at most.')
    try:
        return ends[0], ends[1], float(ends[2]) if len(ends) == 3 else 1.0
    except (TypeError, ValueError):
        raise CouplingError(f"The factor {ends[2]!r} of the connection {entry!r} is not a number.") from None
