"""Signals against time from a CSV file, of a duty or of measurements, such as time [min],load [N],temperature [degC].

The header names each column with its unit. `time` is needed, starts at 0 and increases. Numbers become SI.
"""

import csv
import math
import re
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

from contact_core.errors import SceneError, did_you_mean
from contact_core.quantities import Quantity, value_out_of_range
from contact_core.scene import units
from contact_core.scene.other_names import meant
from contact_core.scene.toml import file_like

Row = tuple[float, dict[str, float]]  # time [s] and values by signal

_TIME = {"time": Quantity("time", "t", "s", "time")}
_COLUMN = re.compile(r"\s*([\w.]+(?:\[\d+\])?)\s*\[([^\]]+)\]\s*$")


def read(path: Path, signals: Mapping[str, Quantity]) -> list[Row]:
    """Return the rows of a table whose columns may be any of `signals`, by their names.

    Raises SceneError with one sentence that names file, line, column, value and remedy.
    """
    rows: list[Row] = []
    for where, (time, values) in rows_of(path, signals):
        if not rows and time != 0.0:
            raise SceneError(f"{where}: time = {time:g} s, but the first row must be at time 0.")
        if rows and time <= rows[-1][0]:
            raise SceneError(
                f"{where}: time = {time:g} s does not come after the {rows[-1][0]:g} s of the row "
                "above. Sort the rows by time and give each time once."
            )
        rows.append((time, values))
    return rows


def refuse_hidden(path: Path, signals: Mapping[str, Quantity], table: str, changes: Collection[str]) -> None:
    """Raise SceneError if one of the changed keys is a signal of a `table` for which the file has a column."""
    _, (_, values) = next(rows_of(path, signals))
    for name in values:
        if f"{table}.{name}" in changes:
            raise SceneError(
                f"{table}.{name} is set, but has no effect: the duty file '{path}' has a column {name}. Leave out one "
                "of them."
            )


def rows_of(
    path: Path, signals: Mapping[str, Quantity], kind: str = "duty", gaps: Collection[str] = ()
) -> Iterator[tuple[str, Row]]:
    """Yield each row with its place in words, for messages; times may be in any order.

    `kind` of file, for messages; cells of the columns `gaps` may be empty, and have no value then.
    """
    (line, header), *body = _lines(path, kind)
    columns = _columns(header, f"{path}, line {line}", _TIME | dict(signals))
    for line, cells in body:
        where = f"{path}, line {line}"
        yield where, _row(cells, columns, where, _TIME | dict(signals), gaps)


def _lines(path: Path, kind: str) -> list[tuple[int, list[str]]]:
    """Return the line numbers and cells of the lines that are not empty: the header and at least one more."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file)
            lines = [(reader.line_num, row) for row in reader if any(cell.strip() for cell in row)]
    except OSError as error:
        raise SceneError(f"The {kind} file '{path}' cannot be read: {error.strerror}.{file_like(path)}") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise SceneError(f"The {kind} file '{path}' is not a CSV file in UTF-8: {error}.") from None
    if len(lines) < 2:
        raise SceneError(f"The {kind} file '{path}' needs a header such as 'time [s],load [N]' and a row below it.")
    return lines


def _columns(header: list[str], where: str, signals: Mapping[str, Quantity]) -> list[tuple[str, str]]:
    """Return the name and unit of every column."""
    columns: list[tuple[str, str]] = []
    for text in header:
        match = _COLUMN.match(text)
        if not match and ";" in text:
            raise SceneError(
                f"{where}: '{text}' has semicolons. Put commas between columns, and a point before decimals."
            )
        if not match:
            raise SceneError(
                f"{where}: column '{text}' is not a name with a unit. "
                "Write for example 'time [s],load [N],temperature [degC]'."
            )
        name, unit = match[1], match[2].strip()
        if name not in signals:
            other = meant("operation", name)
            if other and {*other.keys} & signals.keys():
                raise SceneError(f"{where}: there is no column '{name}'. {other.sentence}")
            raise SceneError(
                f"{where}: there is no column '{name}'.{did_you_mean(name, list(signals))} "
                f"Known are {', '.join(signals)}."
            )
        if name in (known for known, _ in columns):
            raise SceneError(f"{where}: column '{name}' is there twice. Keep one.")
        _si(1.0, name, unit, where, signals)
        columns.append((name, unit))
    names = [name for name, _ in columns]
    if "time" not in names or len(names) < 2:
        raise SceneError(
            f"{where}: the columns are {', '.join(names)}; 'time' and at least one of "
            f"{', '.join(name for name in signals if name != 'time')} are needed."
        )
    return columns


def _row(
    cells: list[str],
    columns: list[tuple[str, str]],
    where: str,
    signals: Mapping[str, Quantity],
    gaps: Collection[str],
) -> Row:
    if len(cells) != len(columns):
        raise SceneError(
            f"{where}: {len(cells)} values for {len(columns)} columns. "
            "Put a comma between values and a point before decimals."
        )
    values: dict[str, float] = {}
    for cell, (name, unit) in zip(cells, columns, strict=True):
        if name in gaps and not cell.strip():
            continue
        here = f"{where}, column '{name} [{unit}]', value '{cell.strip()}'"
        try:
            number = float(cell)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            raise SceneError(f"{here}: not a finite number. Write for example 1.5.")
        values[name] = _si(number, name, unit, where, signals)
        for sentence in value_out_of_range(signals[name], values[name]):
            raise SceneError(f"{here}: {sentence}")
    return values.pop("time"), values


def _si(number: float, name: str, unit: str, where: str, signals: Mapping[str, Quantity]) -> float:
    try:
        return units.parse(f"{number!r} {unit}", signals[name].unit, name)
    except SceneError as error:
        raise SceneError(f"{where}: {error}") from None
