"""Symbols of the equations: those that all laws share, and what each symbol of an equation stands for.

A law has its own in `Equations.symbols`. What stands alone left of a sign is defined by the equation itself.
"""

import re
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import fields
from functools import lru_cache
from importlib.resources import files
from typing import Any, NamedTuple

from .equations import Equations


class Symbol(NamedTuple):
    """A symbol of an equation."""

    symbol: str
    unit: str  # empty: a number without a unit
    text: str
    field: str = ""  # of the law, whose value it is


UNEXPLAINED = "not explained by the law"

_SYMBOL = re.compile(r"[^\W\d_]+[\u0300-\u036f′]*(?:_(?:\{[^{}]*\}|[\w∞]))?")
_UNITS = re.compile(r"\bin mm\^2/s|\bMPa\b|\bPa\b|oil's|solids'")
_WORD = re.compile(r"[a-z]{2,}′?(?:_t|_\{10\})?")  # functions, differentials and words
_NUMBERS = frozenset({"π", "Σ", "Σ_{k}"})
_DEFINED = re.compile(rf"({_SYMBOL.pattern})(?:\([^()]*\))? [=∝] ")
BESIDE = ",   "  # between the equations of one line


@lru_cache(maxsize=1)
def common() -> dict[str, tuple[str, str]]:
    """Return unit and text of the symbols that all laws share."""
    text = (files("contact_core") / "data" / "symbols.toml").read_text("utf-8")
    return {symbol: (unit, text) for symbol, (unit, text) in tomllib.loads(text).items()}


def in_lines(lines: Sequence[str]) -> Iterator[str]:
    """Yield the symbols of some lines of equations, each once, in their order."""
    found = dict.fromkeys(token for line in lines for token in _SYMBOL.findall(_UNITS.sub("", line)))
    yield from (token for token in found if not _WORD.fullmatch(token) and token not in _NUMBERS)


def defined(lines: Sequence[str]) -> set[str]:
    """Return the symbols that stand alone on the left of an equation."""
    phrases = (phrase for line in lines for phrase in line.split(BESIDE))
    return {match[1] for phrase in phrases if (match := _DEFINED.match(phrase.strip()))}


def explained(equations: Equations, law: Any) -> list[Symbol]:
    """Return what the symbols of a law's equations stand for; `law` is its class or record.

    Left out are those that only the equations define. What nothing explains has the text UNEXPLAINED.
    """
    known = {f.name: f.metadata for f in fields(law)} if hasattr(law, "__dataclass_fields__") else {}
    found = []
    for symbol in in_lines(equations.lines):
        said = equations.symbols.get(symbol)
        if said in known:
            found.append(Symbol(symbol, known[said]["unit"], known[said]["text"], said))
        elif said is not None:
            text, _, unit = said.rpartition(" [")
            found.append(Symbol(symbol, "" if unit == "1]" else unit.rstrip("]"), text))
        elif symbol in common():
            found.append(Symbol(symbol, *common()[symbol]))
        elif symbol not in defined(equations.lines):
            found.append(Symbol(symbol, "", UNEXPLAINED))
    return found
