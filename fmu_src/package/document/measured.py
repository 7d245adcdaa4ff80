"""Measured errors and costs shown in the documentation, by level: the figures of `measured.toml`."""

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any


@dataclass(frozen=True)
class Table:
    """Measured figures: title, the command and the page of docs/measured that they come from."""

    title: str
    command: str
    page: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@cache
def tables(kind: str) -> dict[str, tuple[Table, ...]]:
    """Return the tables of "errors" or of "costs" by level."""
    found = tomllib.loads(files(__package__).joinpath("measured.toml").read_text("utf-8"))[kind]
    return {level: tuple(map(_table, some)) for level, some in found.items()}


def _table(given: dict[str, Any]) -> Table:
    return Table(**given | {"head": tuple(given["head"]), "rows": tuple(map(tuple, given["rows"]))})
