"""The laws that a scene uses, with their equations and those of the options that are chosen."""

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any, NamedTuple

from ..laws.equations import Equations


class Chosen(NamedTuple):
    """An option of a law that has equations or a note of its own."""

    option: str
    choice: str
    equations: Equations


class InUse(NamedTuple):
    """A law in a scene."""

    path: str  # dotted
    law: Any
    chosen: tuple[Chosen, ...]

    @property
    def equations(self) -> Equations:
        """Equations of the law itself."""
        found: Equations = self.law.equations
        return found

    @property
    def notes(self) -> str:
        """Note of the law, and of options that have a note alone."""
        return " ".join(
            filter(None, [self.equations.note, *(c.equations.note for c in self.chosen if not c.equations.lines)])
        )


def in_use(record: Any, path: str = "") -> Iterator[InUse]:
    """Yield every law of a record and of those in it."""
    for f in fields(record):
        part: Any = getattr(record, f.name)
        if hasattr(part, "equations"):
            yield InUse(f"{path}{f.name}", part, tuple(_chosen(part)))
        if is_dataclass(part):
            yield from in_use(part, f"{path}{f.name}.")


def _chosen(law: Any) -> Iterator[Chosen]:
    for option, known in law.equations.options.items():
        choice = getattr(law, option)
        if choice in known:
            yield Chosen(option, choice, known[choice])
