"""Known arrays as tables in C."""

import re
from collections.abc import Sequence

import numpy as np

from . import code
from .values import Num, array_kind, literal


def named(array: np.ndarray) -> Num:
    """Return the name of a table with the numbers of an array, row after row."""
    whole = array.dtype.kind in "iub"
    key = (whole, array.size, np.ascontiguousarray(array, np.int64 if whole else np.float64).tobytes())
    number = _TABLES.setdefault(key, len(_TABLES))
    return Num(f"{_TABLE}{number}", array_kind("i" if whole else "d", array.size))


_TABLES: dict[tuple[bool, int, bytes], int] = {}  # of all programs, in order
_TABLE = "known_table_"
_NAME = "constants"


def with_tables(texts: Sequence[str]) -> list[str]:
    """Return C functions after the tables that they read."""
    numbers = list(dict.fromkeys(re.findall(rf"\b{_TABLE}(\d+)\b", "\n".join(texts))))
    if not numbers:
        return list(texts)
    keys = list(_TABLES)
    names = {number: f"{_NAME}_{place}" for place, number in enumerate(numbers, 1)}
    tables = [_written(names[number], *keys[int(number)]) for number in numbers]
    return [*tables, *(re.sub(rf"\b{_TABLE}(\d+)\b", lambda found: names[found[1]], text) for text in texts)]


def _written(name: str, whole: bool, size: int, content: bytes) -> str:
    values = np.frombuffer(content, np.int64 if whole else np.float64)
    kind = "i" if whole else "d"
    listed = values.tolist() if values.any() or np.signbit(values.astype(float)).any() else [values[0].item()]
    items = ", ".join(literal(value, kind).text for value in listed)
    return "\n".join(code.wrapped(f"static const {code.c_type(kind)} {name}[{size}] = {{ {items} }};", 0))
