"""Reads the steps of a test rig's text log: tables of numbers between lines of text.

A table begins with a line in which a column is known and ends with other headers or the title of a step, such as
Step 1 "rub" started at 10:00:00; other lines are counted. Cells are apart by tabs, semicolons or commas.
"""

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from contact_core.errors import ContactError

from . import log_columns
from .log_columns import Column

_NUMBER = re.compile(r"[+-]?(\d+[.,]?\d*|[.,]\d+)([eE][+-]?\d+)?$")
_CLOCK = re.compile(r"(\d+):([0-5]?\d):([0-5]?\d(?:[.,]\d+)?)$")  # hours, minutes, seconds
_TITLE = re.compile(r"\s*step\b(?!\s*(time|type))", re.IGNORECASE)
_KIND = re.compile(r"\s*step type\W+(\w+)", re.IGNORECASE)
_LETTERS = re.compile(r"[^\W\d_]")
_MARKS = {"nan", "inf", "-inf", "over", "under", "ol", "n/a", "na", "#n/a", "none", "null"}  # in place of a number
_NOT_MEASURED = {-(10.0**n - 1.0) for n in range(1, 6)}  # -9, -99, ...: marks, among numbers of which none is negative
_MAPPER = "SLIM Mapper Analysis File"  # first line of another kind of file of the same rigs


@dataclass
class Step:
    """One table of a log: numbers in SI by quantity, nan where a cell is empty."""

    title: str
    columns: list[Column | None]
    rows: list[dict[str, float]] = field(default_factory=list)
    kind: str = ""  # as the log has it, such as FILM, Traction or BOD_TIMED

    def has(self, quantity: str) -> bool:
        return any(column is not None and column.quantity == quantity for column in self.columns)


@dataclass
class Log:
    """A text log: its steps, and what was not taken."""

    name: str
    steps: list[Step]
    left_out: list[str]  # sentences on columns, each once
    outside: list[str] = field(default_factory=list)  # sentences on cells and lines that were not measured

    def taken(self) -> list[str]:
        """Return words on each column that is taken, each once."""
        found = [column for step in self.steps for column in step.columns if column is not None]
        return list(dict.fromkeys(f"'{each.header}' as {each.quantity} [{each.unit}]" for each in found))


def read(path: Path, names: Mapping[str, tuple[str, str | None]]) -> Log:
    """Return the log in a file; `names` as `log_columns.named` gives them.

    Raises ContactError if it cannot be read, has no table, or does not say a unit.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise ContactError(f"The log '{path}' cannot be read: {error.strerror}.") from None
    lines = _text(content).splitlines()
    _refuse_mapper(path, lines)
    mark = next((mark for mark in "\t;" if any(_is_header(line, mark, names) for line in lines)), ",")
    _check_decimals(path, lines, mark)
    steps: list[Step] = []
    left: dict[str, None] = {}
    outside: dict[Column, list[str]] = {}
    marks: dict[Column, list[str]] = {}
    passed: list[str] = []
    for title, kind, headers, rows in _tables(lines, mark, names, passed):
        filled = [any(_NUMBER.match(row[i]) for row in rows if i < len(row)) for i in range(len(headers))]
        columns, sentences = log_columns.taken(headers, names, filled)
        left |= dict.fromkeys(sentences)
        rows = _without_marks(columns, rows, marks)
        steps.append(Step(title, columns, [_row(cells, columns, outside) for cells in rows], kind))
    if not steps:
        raise ContactError(f"'{path}' has {_why_nothing(lines, mark, names)}")
    told = [_told(column, cells) for column, cells in outside.items()] + [
        f"'{column.header}': {cells[0]} among numbers that are not negative counts as not measured: {len(cells)}."
        for column, cells in marks.items()
    ]
    if passed:
        told.append(f"Lines that are no rows of a table are passed over: {len(passed)}, such as '{passed[0].strip()}'.")
    return Log(path.name, steps, list(left), told)


def _why_nothing(lines: list[str], mark: str, names: Mapping[str, tuple[str, str | None]]) -> str:
    header = next((line for line in lines if _is_header(line, mark, names)), None)
    if header is not None:
        return (
            f"no row of numbers below '{header.strip()}': the first cell of a row is a number, or a time such as "
            "01:30:00. Write times of other kinds as seconds."
        )
    return (
        "no table with a known column, such as 'Rolling Speed (mm/s)' or 'Traction Coeff (-)'. "
        "Export it as text with headers, or name its columns by --column 'HEADER=QUANTITY [unit]'."
    )


def _told(column: Column, cells: list[str]) -> str:
    """Return a sentence on the cells of a column that cannot have been measured."""
    least, most = column.limits
    unit = "" if column.si == "1" else f" {column.si}"
    return (
        f"'{column.header}': cells that are not from {least:g} to {most:g}{unit}, as {column.quantity} is, count as "
        f"not measured: {len(cells)}, such as {cells[0]}."
    )


def _in_seconds(cell: str) -> str:
    """Return a time such as 01:30:00 as a number of seconds, with the sign of decimals that it has; else the cell."""
    found = _CLOCK.match(cell)
    if not found:
        return cell
    hours, minutes, seconds = found.groups()
    number = f"{3600 * int(hours) + 60 * int(minutes) + float(seconds.replace(',', '.')):.9g}"
    return number.replace(".", ",") if "," in seconds else number


def _tables(
    lines: list[str], mark: str, names: Mapping[str, tuple[str, str | None]], passed: list[str]
) -> Iterator[tuple[str, str, list[str], list[list[str]]]]:
    """Yield title and kind of the step, headers and rows of each table that has rows.

    Lines with numbers that are rows of none are added to `passed`, and others between two rows.
    """
    title, kind, headers, rows = "", "", [""], list[list[str]]()
    between: list[str] = []
    for line in [*lines, "Step"]:  # as if another one began
        own = [cell.strip().strip('"') for cell in line.split(mark)]
        cells = [*map(_in_seconds, own)]
        if headers != [""] and _is_row(cells) and not (between and len(cells) != len(rows[-1])):
            if not rows:
                headers = log_columns.with_units(headers, ["s" if _CLOCK.match(cell) else "" for cell in own])
            rows.append(cells)
            passed += filter(str.strip, between)
            between = []
            continue
        bare = [cell.strip("[]()") for cell in cells]
        if headers != [""] and not rows and log_columns.are_units(bare):
            headers = log_columns.with_units(headers, bare)
            continue
        begins = _KIND.match(line) or _is_header(line, mark, names) or _TITLE.match(line) or _are_words(cells)
        if rows and not begins:
            between.append(line)
            continue
        if not begins and _is_row(cells):
            passed.append(line)
        if rows:
            yield title, kind, headers, rows
        passed += (each for each in between if _is_row(each.split(mark)))
        headers, rows, between = [""], [], []
        if found := _KIND.match(line):  # before headers: FILM is a name of a column, too
            kind = found[1]
        elif _is_header(line, mark, names):
            headers = cells
        elif _TITLE.match(line):
            title, kind = " ".join(line.split()), ""


def _are_words(cells: list[str]) -> bool:
    """Return True for the headers of another table: several cells, different, without a number or a mark for none."""
    full = {cell.casefold() for cell in cells if cell}
    return (
        len(full) > 1
        and not any(_NUMBER.match(cell) or not _LETTERS.search(cell) for cell in full)
        and not full & _MARKS
    )


def _without_marks(
    columns: list[Column | None], rows: list[list[str]], marks: dict[Column, list[str]]
) -> list[list[str]]:
    """Return the rows with empty cells for -9, -99, ... in columns without another negative number."""
    rows = [list(row) for row in rows]
    for i, column in enumerate(columns):
        numbers = [(row, float(row[i].replace(",", "."))) for row in rows if i < len(row) and _NUMBER.match(row[i])]
        marked = [row for row, number in numbers if number in _NOT_MEASURED]
        if column is not None and 0 < len(marked) == sum(number < 0.0 for _, number in numbers) < len(numbers):
            marks[column] = [*marks.get(column, []), *(row[i] for row in marked)]
            for row in marked:
                row[i] = ""
    return rows


def _refuse_mapper(path: Path, lines: list[str]) -> None:
    """Raise ContactError for an analysis of a mapper's images, which has a thickness for each pixel."""
    if lines and lines[0].strip().startswith(_MAPPER):
        raise ContactError(
            f"'{path}' is an analysis of a mapper's images: the tribofilm on the ball at each pixel, without a time. "
            "Take the mean of each image, write it beside the time of its step as a table with columns "
            "'Step Time (s)' and 'Film (nm)', and name that by --column 'Film=tribofilm_1 [nm]'."
        )


def _text(content: bytes) -> str:
    try:
        return content.decode("utf-16" if content[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("cp1252", errors="replace")  # of Windows: its signs for degrees and micro


def _is_header(line: str, mark: str, names: Mapping[str, tuple[str, str | None]]) -> bool:
    cells = [cell.strip().strip('"') for cell in line.split(mark)]
    full = [cell for cell in cells if cell]
    return len(full) > 1 and not any(_NUMBER.match(cell) for cell in full) and log_columns.known(full, names)


def _is_row(cells: list[str]) -> bool:
    return bool(_NUMBER.match(cells[0])) and any(cells)


def _check_decimals(path: Path, lines: list[str], mark: str) -> None:
    """Raise ContactError if numbers have commas and points, so that 1,234 may be one thing or the other."""
    cells = [cell.strip() for line in lines for cell in line.split(mark)]
    numbers = [cell for cell in cells if _NUMBER.match(cell)]
    comma, point = (next((cell for cell in numbers if sign in cell), "") for sign in ",.")
    if comma and point:
        raise ContactError(
            f"'{path}' has numbers such as {comma} and {point}: a comma may be of decimals or of thousands. Export it "
            "with one sign of decimals and none of thousands."
        )


def _row(cells: list[str], columns: list[Column | None], outside: dict[Column, list[str]]) -> dict[str, float]:
    """Return the numbers of a row in SI; cells that cannot have been measured are added to `outside`."""
    found = {}
    for i, column in enumerate(columns):
        if column is not None:
            cell = cells[i] if i < len(cells) else ""
            number = float(cell.replace(",", ".")) if _NUMBER.match(cell) else math.nan
            value = column.value(number) if math.isfinite(number) else number
            least, most = column.limits
            if not (math.isnan(value) or least <= value <= most):
                outside.setdefault(column, []).append(cell)
                value = math.nan
            found[column.quantity] = value
    return found
