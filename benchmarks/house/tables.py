"""Tables of sections of docs/measured, and the figures in their cells."""

import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from benchmarks import claims, sections

Row = dict[str, str]


class Table(NamedTuple):
    """A table of a section: the heading it stands under, and its rows by column."""

    heading: str
    columns: tuple[str, ...]
    rows: list[Row]


def tables(text: str) -> list[Table]:
    """All tables of a section."""
    found: list[Table] = []
    heading, before = "", ""
    for line in text.splitlines():
        if line.startswith("#"):
            heading = line.lstrip("# ")
        elif re.match(r"\|(---\|)+$", line):
            found.append(Table(heading, unlike(cell.strip() for cell in before.strip()[1:-1].split("|")), []))
        elif line.startswith("|") and before.startswith("|"):
            # prose may hold |x|: such rows have cells to spare, which no figure here is taken from
            cells = [cell.strip() for cell in line.strip()[1:-1].split("|")]
            found[-1].rows.append(dict(zip(found[-1].columns, cells, strict=False)))
        before = line
    return found


def unlike(names: Iterable[str]) -> tuple[str, ...]:
    """Names of columns, the second of the same name with a number."""
    found: list[str] = []
    for name in names:
        found.append(f"{name} ({found.count(name) + 1})" if name in found else name)
    return tuple(found)


class Pages:
    """The sections of docs/measured, each read once."""

    def __init__(self, folder: Path = sections.KEPT) -> None:
        self.folder, self.read = folder, {}  # type: Path, dict[str, list[Table]]

    def text(self, name: str) -> str:
        """Return a section in Markdown."""
        return sections.read(name, self.folder).text

    def rows(self, name: str, column: str, heading: str = "", **given: str) -> list[Row]:
        """Rows of the tables with a column under a heading that begins so, whose cells have these values."""
        if name not in self.read:
            self.read[name] = tables(self.text(name))
        found = [
            row
            for table in self.read[name]
            if column in table.columns and table.heading.startswith(heading)
            for row in table.rows
            if all(row.get(key) == value for key, value in given.items())
        ]
        if not found:
            raise LookupError(f"the section {name} has no row with {column!r}, {given} under {heading!r}")
        return found

    def row(self, name: str, column: str, heading: str = "", **given: str) -> Row:
        """Return the only such row."""
        (found,) = self.rows(name, column, heading, **given)
        return found


def number(cell: str) -> float:
    """Return the first number of a cell."""
    found = re.search(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?", cell)
    if found is None:
        raise ValueError(f"no number in {cell!r}")
    return float(found[0])


def numbers(cell: str) -> list[float]:
    """All numbers of a cell."""
    return [float(found) for found in re.findall(r"\d+(?:\.\d+)?(?:e[-+]?\d+)?", cell)]


def per_cent(share: float) -> str:
    """A share in per cent."""
    return f"{100.0 * share:.0f} %"


def link(name: str) -> str:
    """A link to a section, which says if that is of older code."""
    older = sections.OLDER if claims.note(sections.read(name)) else ""
    return f"[{name}](measured/{sections.place(name)}){older}"


def range_of(cells: Iterable[str], say: Callable[[float], str]) -> tuple[str, str]:
    """The least and the largest number."""
    numbers = [number(cell) for cell in cells]
    return say(min(numbers)), say(max(numbers))


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """A table in Markdown."""
    return [_line(heads), "|" + "---|" * len(heads), *map(_line, rows)]


def _line(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"
