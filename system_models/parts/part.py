"""A component of a system without a contact: parameters, variables, and three pure functions.

`fmu` wraps any of them as an FMU; none knows FMI, files or other components.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

from contact_core.quantities import TABLE, Quantity, Role, parameter

MACHINES = "tribofmu.machines"  # group of entry points: machines of other packages

Values = Mapping[str, float]  # by name, SI
State = tuple[float, ...]  # all that the next answer depends on, except parameters and inputs


@dataclass(frozen=True)
class Input(Quantity):
    """An input of a component; `start` is its value where nothing sets it."""

    role: Role = "input"
    start: float = 0.0


@dataclass(frozen=True)
class Output(Quantity):
    """An output of a component; `direct` names the inputs on which it depends without delay."""

    direct: tuple[str, ...] = ()


@dataclass(frozen=True)
class Start:
    """The value of an input, in its SI unit, where nothing sets it."""

    name: str
    value: float = parameter("", "value in the input's SI unit")


@dataclass(frozen=True)
class Part(ABC):
    """A component: a frozen dataclass of numbers declared by `quantities.parameter`, which become the FMU's parameters.

    Fields that are whole numbers, records or tuples of records decide which variables it has and are fixed when the
    FMU is built; `starts` has inputs that start elsewhere than they say. `check` raises SceneError, `initial`,
    `advance` and `outputs` ContactError with a sentence that names the variable, its value, what is allowed and the
    way out.
    """

    name: ClassVar[str]  # of the FMU's model, such as "Shaft"
    text: ClassVar[str]  # one line for its description

    starts: tuple[Start, ...] = field(default=(), kw_only=True)

    @property
    @abstractmethod
    def inputs(self) -> tuple[Input, ...]:
        """Inputs in order."""

    @property
    @abstractmethod
    def responses(self) -> tuple[Output, ...]:
        """Outputs in order."""

    @property
    def at_start(self) -> tuple[str, ...]:
        """Inputs that `initial` uses: the outputs at the start depend on them, as on those in `direct`."""
        return ()

    def check(self) -> None:  # noqa: B027 (few have anything to check)
        """Raise SceneError if parameters do not go together; the range of each is checked by the caller."""

    @abstractmethod
    def initial(self, inputs: Values) -> State:
        """Return the state at the start, for the inputs then."""

    @abstractmethod
    def advance(self, state: State, inputs: Values, step: float) -> State:
        """Return the state after `step` [s] > 0 under held inputs; `state` is left as it is."""

    @abstractmethod
    def outputs(self, state: State, inputs: Values) -> dict[str, float]:
        """Return the value of each of `responses`; those without `direct` do not look at `inputs`."""


def start_values(part: Part) -> dict[str, float]:
    """Return the value of each input where nothing sets it."""
    return {q.name: q.start for q in part.inputs} | {start.name: start.value for start in part.starts}


def indexed(name: str, number: int) -> str:
    """Return the name of one of several alike, counted from 1: `load[3]`."""
    return f"{name}[{number}]"


def of_contact(name: str, variable: str, where: str, nominal: float) -> dict[str, Any]:
    """Return what describes a component's variable for a quantity of a contact, and `where` this one is."""
    q = TABLE[name]
    return {
        "name": variable,
        "symbol": q.symbol,
        "unit": q.unit,
        "text": f"{q.text}; {where}",
        "nominal": nominal,
        "display": q.display,
        "relative": q.relative,
    }
