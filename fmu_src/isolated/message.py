"""Layout of the messages between the FMU's library and a worker: little-endian, items at multiples of 8 bytes.

library/message.h describes their contents; change the two together.
"""

import struct
from enum import IntEnum

from ..variables import Value

REQUEST = struct.Struct("<IIQQQQ3d")
ANSWER = struct.Struct("<IIQQ")
ENTRY = struct.Struct("<IIII")
RECORD = struct.Struct("<HHId")
PART = struct.Struct("<Qq")
COUNT = struct.Struct("<Q")

KINDS = ("Real", "Integer", "Boolean", "String")
CAUSALITIES = ("input", "parameter", "tunable", "output", "direct")
TYPES: tuple[type, ...] = (float, int, bool, str)

Buffer = bytes | memoryview


class Operation(IntEnum):
    """Request of the host."""

    OPEN = 1
    SETUP = 2
    ENTER = 3
    EXIT = 4
    STEP = 5
    LOOK = 6  # of a get, where outputs are older than what was set: sends that, brings all values
    TERMINATE = 7
    RESET = 8
    SAVE = 9
    RESTORE = 10
    QUIT = 11


WITH_TABLE = (Operation.OPEN, Operation.LOOK, Operation.RESET, Operation.RESTORE)  # answered with all values


def log_entry(entry: tuple[int, str, str]) -> bytes:
    """Encode status, category and text of one log message."""
    status, category, message = entry
    first, second = (text.encode("utf-8", "backslashreplace") + b"\0" for text in (category, message))
    texts = first + second
    return ENTRY.pack(status, len(first), len(second), 0) + texts + padding(len(texts))


def record(reference: int, description: tuple[str, str], value: Value) -> bytes:
    """Encode value reference, kind, causality and value of one variable."""
    kind, causality = KINDS.index(description[0]), CAUSALITIES.index(description[1])
    if isinstance(value, str):
        text = value.encode("utf-8", "backslashreplace")
        return RECORD.pack(kind, causality, reference, len(text)) + text + padding(len(text))
    return RECORD.pack(kind, causality, reference, value)


def padding(size: int) -> bytes:
    """Return the zeros that fill an item of `size` bytes up to a multiple of 8."""
    return bytes(-size % 8)


def size_of(part: Buffer) -> int:
    """Return the length of a buffer [bytes]."""
    return part.nbytes if isinstance(part, memoryview) else len(part)


def identity(part: Buffer) -> tuple[int, int]:
    """Return a key that two references to the same immutable buffer share."""
    return (id(part.obj), part.nbytes) if isinstance(part, memoryview) else (id(part), len(part))
