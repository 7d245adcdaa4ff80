"""Records of an explanation."""

from dataclasses import dataclass

from contact_core.laws.equations import Equations
from contact_core.laws.symbols import Symbol
from contact_core.scene.origins import Origin


@dataclass(frozen=True)
class Value:
    """A value of a scene."""

    key: str  # dotted
    symbol: str  # in the equations of its law; empty if it has none
    shown: str  # with its unit
    text: str  # what it is
    origin: Origin


@dataclass(frozen=True)
class Part:
    """A law, or a table of values without a law."""

    path: str  # dotted key of the law's table, or a title
    model: str  # name of the law; empty without one
    origin: Origin | None  # of the choice of the law
    equations: tuple[Equations, ...]  # of the law, and of options that have some
    note: str
    source: str
    values: tuple[Value, ...]
    symbols: tuple[Symbol, ...]  # all of the equations


@dataclass(frozen=True)
class Section:
    """Parts that belong together."""

    title: str
    parts: tuple[Part, ...]


@dataclass(frozen=True)
class Absent:
    """Something that a scene leaves out."""

    key: str
    value: str  # empty if it is not given
    cost: str  # a sentence


@dataclass(frozen=True)
class Explanation:
    """The explanation of a scene."""

    name: str
    description: str
    about: str  # what its file says of itself
    summary: str  # of its operating point
    sections: tuple[Section, ...]
    left_out: tuple[Absent, ...]
    trust: tuple[str, ...]  # sentences
    assumed: tuple[tuple[str, ...], ...]  # head and rows: what is assumed, its interval and its worth
    validity: tuple[tuple[str, str, str], ...]  # quantity, here, meaning
    commands: tuple[tuple[str, str], ...]  # command, what it shows
