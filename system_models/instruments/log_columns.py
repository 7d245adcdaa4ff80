"""Columns of the text logs of test rigs: which is which quantity, in which unit, by log_columns.toml."""

import itertools
import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

from contact_core.errors import ContactError, did_you_mean
from contact_core.quantities import TABLE, measured_range
from contact_core.scene import units

_TABLES = tomllib.loads((files(__package__) / "log_columns.toml").read_text("utf-8"))
OF_RIGS: dict[str, dict[str, Any]] = _TABLES["of_rigs"]
_NAMES: dict[str, str] = {name: quantity for quantity, names in _TABLES["names"].items() for name in names}
_NOT_TAKEN: dict[str, str] = _TABLES["not_taken"]

_HEADER = re.compile(r"\s*(.*?)\s*(?:[\[(]([^\[\]()]*)[\])])?\s*$")
_NAMED = re.compile(r"\s*(\w*)\s*(?:\[([^\]]*)\])?\s*$")
_UNITS = {"-": "1", "°c": "degC", "degc": "degC", "deg c": "degC", "c": "degC", "secs": "s", "sec": "s", "mins": "min"}
_NUMBERS = {"friction_coefficient", "ball_speed", "disc_speed"}  # quantities that need no unit


@dataclass(frozen=True)
class Column:
    """A column that is taken: its header, its quantity, and the unit of its numbers."""

    header: str
    quantity: str
    unit: str

    @property
    def limits(self) -> tuple[float, float]:
        """Least and largest value in SI that can have been measured."""
        rig = OF_RIGS.get(self.quantity)
        return (rig["least"], rig["largest"]) if rig else measured_range(TABLE[self.quantity])

    @property
    def si(self) -> str:
        """Unit in SI of the quantity."""
        return _unit(self.quantity)

    def value(self, number: float) -> float:
        return units.parse(f"{number!r} {self.unit}", "" if self.si == "1" else self.si, f"'{self.header}'")


def _unit(quantity: str) -> str:
    return str(OF_RIGS[quantity]["unit"]) if quantity in OF_RIGS else TABLE[quantity].unit


def named(texts: Sequence[str]) -> dict[str, tuple[str, str | None]]:
    """Return quantity and unit by header of texts "HEADER=quantity [unit]"; an empty quantity leaves a column out.

    Raises ContactError for a text that is not so, or names no quantity.
    """
    found: dict[str, tuple[str, str | None]] = {}
    for text in texts:
        header, equals, told = text.rpartition("=")
        match = _NAMED.match(told)
        if not equals or not header.strip() or not match:
            raise ContactError(
                f"--column '{text}' is not HEADER=QUANTITY, such as 'Speed (m/s)=rolling_speed', or "
                "'Speed=rolling_speed [m/s]' where the header has no unit."
            )
        known = [*OF_RIGS, *(q.name for q in TABLE.values() if q.kind == "Real")]
        if match[1] and match[1] not in known:
            raise ContactError(
                f"--column '{text}': there is no quantity '{match[1]}'.{did_you_mean(match[1], known)} A rig has "
                f"{', '.join(OF_RIGS)}, load, temperature, and outputs of the contact such as h_c."
            )
        found[" ".join(header.split()).lower()] = (match[1], match[2])
    return found


def taken(
    headers: Sequence[str], names: Mapping[str, tuple[str, str | None]], filled: Sequence[bool]
) -> tuple[list[Column | None], list[str]]:
    """Return the column that each header is, None of one that is not taken, and a sentence on each of these.

    `names` are those of `named`; `filled` says which columns have numbers: exports repeat columns and leave some empty.
    Raises ContactError for a unit that is not said or cannot be that of the quantity.
    """
    rank = {name: i for i, name in enumerate(_NAMES)}
    best: dict[str, tuple[int, int]] = {}  # of each quantity: rank and place
    told: list[tuple[str, str | None]] = []
    for i, header in enumerate(headers):
        name, unit = _parts(header)
        own = names.get(" ".join(header.split()).lower(), names.get(name))
        told.append((_NAMES.get(name, ""), unit) if own is None else (own[0], own[1] if own[1] is not None else unit))
        quantity = told[-1][0]
        if quantity and filled[i]:
            best[quantity] = min(best.get(quantity, (len(rank), i)), (-1 if own else rank[name], i))
    columns: list[Column | None] = []
    left: list[str] = []
    for i, (header, (quantity, unit)) in enumerate(zip(headers, told, strict=True)):
        chosen = quantity in best and best[quantity][1] == i
        columns.append(_column(header, quantity, unit) if chosen else None)
        if not chosen and header.strip():
            left.append(f"'{header.strip()}': {_why(header, quantity, names, headers, best)}")
    return columns, left


def with_units(headers: Sequence[str], units_below: Sequence[str]) -> list[str]:
    """Return headers with units from elsewhere, where they say none of their own."""
    pairs = itertools.zip_longest(headers, units_below[: len(headers)], fillvalue="")
    return [f"{header.strip()} ({unit})" if unit and _parts(header)[1] is None else header for header, unit in pairs]


def are_units(cells: Sequence[str]) -> bool:
    """Return whether the cells of a line are units, such as s, [N] or -, or empty."""
    given = [cell for cell in cells if cell]
    return bool(given) and all(map(_is_unit, given))


def _is_unit(text: str) -> bool:
    try:
        return _ascii(text) == "degC" or bool(units.unit(_ascii(text)))
    except ContactError:
        return False


def _ascii(unit: str) -> str:
    """Return a unit of an export as it is called here."""
    return _UNITS.get(unit.strip().lower(), unit.strip().replace("\u03bc", "u"))


def known(cells: Sequence[str], names: Mapping[str, tuple[str, str | None]]) -> bool:
    """Return whether cells are a header: none a number, and one at least the name of a column."""
    found = [_parts(cell)[0] for cell in cells]
    whole = [" ".join(cell.split()).lower() for cell in cells]
    return any(name in _NAMES or name in names or all_ in names for name, all_ in zip(found, whole, strict=True))


def _parts(header: str) -> tuple[str, str | None]:
    """Return the name of a header in small letters, and its unit if it says one."""
    match = _HEADER.match(header)
    assert match  # any text does
    return " ".join(match[1].split()).lower(), match[2]


def _column(header: str, quantity: str, unit: str | None) -> Column:
    if unit is None and quantity in _NUMBERS:
        unit = "1"
    if unit is None or not unit.strip():
        example = "%" if quantity == "srr" else _unit(quantity)
        raise ContactError(
            f"Column '{header.strip()}' does not say its unit. Give it by --column '{header.strip()}={quantity} "
            f"[{example}]', or leave the column out by --column '{header.strip()}='."
        )
    column = Column(header.strip(), quantity, _ascii(unit))
    try:
        column.value(1.0)
    except ContactError as error:
        raise ContactError(f"Column '{header.strip()}' cannot be {quantity}: {error}") from None
    return column


def _why(
    header: str,
    quantity: str,
    names: Mapping[str, tuple[str, str | None]],
    headers: Sequence[str],
    best: Mapping[str, tuple[int, int]],
) -> str:
    """Return why a column is not taken."""
    name = _parts(header)[0]
    if quantity and quantity not in best:
        return "it is empty"
    if quantity:
        return f"'{headers[best[quantity][1]].strip()}' is taken for {quantity}"
    if name in names or " ".join(header.split()).lower() in names:
        return "left out by --column"
    reason = next((why for known, why in _NOT_TAKEN.items() if re.match(rf"{known}( \d)?$", name)), "")
    return reason or f"not known; name it by --column '{header.strip()}=QUANTITY'"
