"""Frozen records of numbers and arrays as little-endian bytes and back, bit for bit.

Numbers take 8 bytes each, in the order of their fields; of an array kind, shape and checksum stand with them, and its
memory is kept apart, uncopied. An array of one value everywhere has that value for memory.
"""

import math
import struct
import zlib
from dataclasses import fields
from functools import cache, lru_cache
from operator import itemgetter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..kernels.arrays import Array, Mask

_ARRAY = struct.Struct("<3s?IIQ")  # dtype, of one value, rows, columns (0: no rows), its bits or the checksum
_LETTERS: dict[Any, str] = {float: "d", float | None: "d", int: "q"}


class Kind:
    """Layout in which records of a class are stored."""

    def __init__(self, record: type) -> None:
        letters = {f.name: _LETTERS[f.type] for f in fields(record) if f.type in _LETTERS}
        self.record = record
        self.numbers = tuple(letters)
        self.maybe = tuple(f.name for f in fields(record) if f.type == float | None)
        self.arrays = tuple(f.name for f in fields(record) if f.type in (_REALS, _BOOLEANS))
        self.layout = struct.Struct("<" + "".join(letters.values()))
        self.fetch = itemgetter(*letters) if len(letters) > 1 else lambda of: tuple(of[name] for name in letters)


_REALS, _BOOLEANS = Array, Mask
_kind = cache(Kind)


def numbers(record: Any) -> bytes:
    """Return the numbers of a record as bytes; None, where a number is optional, becomes NaN."""
    kind = _kind(record.__class__)
    values = kind.fetch(vars(record))
    if kind.maybe:
        values = tuple([math.nan if value is None else value for value in values])
    return kind.layout.pack(*values)


class Stored(NamedTuple):
    """A record as it is stored."""

    head: bytes  # its numbers, and what its arrays are
    memory: list[memoryview]  # of its arrays


def stored(record: Any) -> Stored:
    """Made once and kept with the record, whose arrays never change."""
    kept: Stored | None = vars(record).get("_stored")
    if kept is None:
        head, memory = [numbers(record)], []
        for name in _kind(record.__class__).arrays:
            array = _little_endian(getattr(record, name))
            value = _one_value(array)
            rows, columns = array.shape if array.ndim == 2 else (0, array.size)
            mark = zlib.crc32(array.data) if value is None else value
            head.append(_ARRAY.pack(array.dtype.str.encode(), value is not None, rows, columns, mark))
            if value is None:
                memory.append(array.data)
        kept = Stored(b"".join(head), memory)
        vars(record)["_stored"] = kept
    return kept


def _little_endian(array: NDArray[Any]) -> NDArray[Any]:
    return np.ascontiguousarray(array).astype(array.dtype.newbyteorder("<"), copy=False)


def _one_value(array: NDArray[Any]) -> int | None:
    """Return the bits of an array's value, if it has no other."""
    bits = array.reshape(-1).view(_bits(array.dtype))
    if bits.size and bits[0] == bits[-1] and (bits == bits[0]).all():
        return int(bits[0])
    return None


def _bits(dtype: np.dtype[Any]) -> str:
    return f"<u{dtype.itemsize}"


@lru_cache(maxsize=16)
def _filled(dtype: str, shape: tuple[int, ...], value: int) -> NDArray[Any]:
    """Return an array of the value with these bits: one object for all records that have it."""
    kind = np.dtype(dtype)
    array = np.full(shape, value, _bits(kind)).view(kind)
    array.setflags(write=False)
    return array


class Reader:
    """Reads what was stored, in the same order. Raises ValueError or struct.error where the bytes do not fit."""

    def __init__(self, data: bytes, start: int, end: int) -> None:
        """Read `data`: the numbers from `start` to `end`, and then the memory of the arrays."""
        self._data = data
        self._at, self._stop, self._end = start, end, end

    def values(self, layout: struct.Struct) -> tuple[Any, ...]:
        """Return the next values, of a layout."""
        found = layout.unpack_from(self._data, self._at)
        self._at += layout.size
        return found

    def text(self, size: int) -> str:
        """Return the next text."""
        self._at += size
        return self._data[self._at - size : self._at].decode()

    def numbers(self, record: type) -> dict[str, Any]:
        """Return the next numbers, by the names of their fields."""
        kind = _kind(record)
        found = dict(zip(kind.numbers, self.values(kind.layout), strict=True))
        for name in kind.maybe:
            if math.isnan(found[name]):
                found[name] = None
        return found

    def record(self, record: Any) -> Any:
        """Return the next record of a class with nothing but numbers and arrays."""
        values = self.numbers(record)
        return record(**values, **{name: self._array() for name in _kind(record).arrays})

    def _array(self) -> NDArray[Any]:
        name, same, rows, columns, mark = self.values(_ARRAY)
        dtype, shape = np.dtype(name.decode()), (rows, columns) if rows else (columns,)
        if same:
            return _filled(dtype.str, shape, mark)
        array = np.frombuffer(self._data, dtype, math.prod(shape), self._end)
        self._end += array.nbytes
        if zlib.crc32(array.data) != mark:
            raise ValueError("an array was changed")
        return array.reshape(shape).copy()  # a copy, because the bytes need not be aligned

    def close(self) -> None:
        """Raise ValueError if bytes are left over."""
        if self._at != self._stop or self._end != len(self._data):
            raise ValueError("it has another length")
