"""The checkpoint of a run, in the folder of its results: all that is needed to continue after a kill.

`checkpoint.tribofmu` is the point reached, replaced as a whole: magic, checksum of the rest, length of a JSON header,
header, state. `checkpoint.rows` has the rows up to there, and only grows: the header says how many of its bytes count,
and their checksum. `checkpoint.kept` is the same for records of the caller, such as fields.
"""

import json
import logging
import math
import os
import struct
import sys
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contact_core.errors import StateError

log = logging.getLogger(__name__)

_MAGIC = b"tribofmu run 2\n"
_LENGTH = struct.Struct("<Q")  # before each record of the caller
_PAUSE = 2.0  # at least, between two checkpoints [s]
_REST = 20.0  # at least this many times the time that a checkpoint takes lies between two
_NAMED = 3  # differences listed in full


@contextmanager
def alone(folder: Path) -> Iterator[None]:
    """Hold a folder for one run, where the system has locks; a kill lets go of it.

    Raises StateError if another run is at work in it.
    """
    if sys.platform == "win32":
        yield
        return
    import fcntl

    handle = os.open(folder, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise StateError(
                f"Another run is at work in '{folder}'. Wait for it, or use another --out (in Python: folder)."
            ) from None
        except OSError:  # a file system without locks
            pass
        yield
    finally:
        os.close(handle)


@dataclass(frozen=True)
class Saved:
    """A point from which a run can continue."""

    time: float  # [s]
    state: bytes  # of the FMU, serialised
    rows: NDArray[np.void]  # a record for every row so far


class _Grown:
    """A file that only grows: what of it counts is known to the checkpoint, remains behind are overwritten."""

    def __init__(self, path: Path, what: str) -> None:
        self.path, self._what = path, f"its {what} '{path}'"
        self.size = self.checksum = 0  # of what counts

    def written(self, data: bytes) -> tuple[int, int]:
        """Write behind what counts; return the new size and checksum, which count once they are in the header."""
        with self.path.open("r+b" if self.size else "wb") as file:
            file.seek(self.size)
            file.write(data)
            _flush(file)
        return self.size + len(data), zlib.crc32(data, self.checksum)

    def counted(self, size: int, checksum: int) -> None:
        """Let this much count."""
        self.size, self.checksum = size, checksum

    def read(self, size: int, checksum: int) -> bytes:
        """Return what counts. Raises ValueError with the reason if it is not there."""
        try:
            with self.path.open("rb") as file:
                data = file.read(size)
        except OSError as error:
            raise ValueError(f"{self._what} cannot be read: {error.strerror}") from None
        if len(data) != size or zlib.crc32(data) != checksum:
            raise ValueError(f"{self._what} were cut or changed")
        self.counted(size, checksum)
        return data


class Checkpoint:
    """Stores the point that a run has reached; `saved` is the point from which it continues.

    `run` is all that decides the result; `about` are texts on it that do not, for those who look at a checkpoint.
    `kept` are records of the caller, of any bytes, which it only adds to: the next `save` stores those that are new.
    """

    def __init__(self, folder: Path, run: Mapping[str, Any], about: Mapping[str, str] | None = None) -> None:
        self.file = folder / "checkpoint.tribofmu"
        self._rows = _Grown(folder / "checkpoint.rows", "rows")
        self._records = _Grown(folder / "checkpoint.kept", "records")
        self._new = folder / "checkpoint.new"
        self._run = run
        self.about = dict(about or {})
        self._next = -math.inf
        self._writable = True
        self.count = 0  # rows stored so far
        self.kept: list[bytes] = []
        self._stored = 0  # of these
        self.saved: Saved | None = None

    @staticmethod
    def resume(folder: Path, run: Mapping[str, Any], about: Mapping[str, str] | None = None) -> "Checkpoint":
        """Return the checkpoint of `folder`, with `saved` if there is one.

        Raises StateError if it is damaged or belongs to another run than `run`.
        """
        checkpoint = Checkpoint(folder, run, about)
        checkpoint._load()
        return checkpoint

    @staticmethod
    def read(folder: Path) -> "tuple[Checkpoint, dict[str, Any]] | None":
        """Return the checkpoint of `folder` and what its run is, as `run` was given; None if there is none.

        Raises StateError if it is damaged.
        """
        checkpoint = Checkpoint(folder, {})
        data = checkpoint._data()
        if data is None:
            return None
        header, state = checkpoint._parsed(data)
        checkpoint._take(header, state)
        checkpoint.about = header.get("about", {})
        return checkpoint, header["run"]

    def due(self) -> bool:
        """Return True if the last checkpoint is old enough for another."""
        return monotonic() >= self._next

    def save(self, time: float, state: bytes, rows: NDArray[np.void]) -> None:
        """Store the point reached at `time` [s]; `rows` are those since the last checkpoint that was stored.

        A kill at any moment leaves this checkpoint or the one before. A disk that refuses is warned about: the run is
        worth more than its checkpoint.
        """
        start = monotonic()
        try:
            self._write(time, state, rows)
            self._writable = True
        except OSError as error:
            if self._writable:
                log.warning(
                    "The checkpoint '%s' cannot be written: %s. The run continues and tries again.",
                    self.file,
                    error.strerror,
                )
            self._writable = False
        self._next = monotonic() + max(_PAUSE, _REST * (monotonic() - start))

    def remove(self) -> None:
        # the rows last: without them the file would be damaged
        for path in (self.file, self._new, self._records.path, self._rows.path):
            path.unlink(missing_ok=True)

    def _write(self, time: float, state: bytes, rows: NDArray[np.void]) -> None:
        if not self._rows.size:
            self.remove()  # another run's
        size, checksum = self._rows.written(rows.tobytes())
        header: dict[str, Any] = {
            "run": self._run,
            "about": self.about,
            "time": time,
            "columns": [[name, rows.dtype[name].str] for name in rows.dtype.names or ()],
            "size": size,
            "checksum": checksum,
        }
        kept = len(self.kept)
        if kept:
            new = self.kept[self._stored :]
            header["kept"] = self._records.written(b"".join(_LENGTH.pack(len(each)) + each for each in new))
        text = json.dumps(header).encode()
        rest = b"".join([struct.pack("<I", len(text)), text, state])
        with self._new.open("wb") as file:
            file.write(_MAGIC + struct.pack("<I", zlib.crc32(rest)) + rest)
            _flush(file)
        self._new.replace(self.file)
        self._rows.counted(size, checksum)
        if kept:
            self._records.counted(*header["kept"])
        self.count, self._stored = self.count + len(rows), kept

    def _data(self) -> bytes | None:
        try:
            return self.file.read_bytes()
        except FileNotFoundError:
            return None
        except OSError as error:
            raise StateError(f"The checkpoint '{self.file}' cannot be read: {error.strerror}. {_WAY_OUT}") from None

    def _load(self) -> None:
        data = self._data()
        if data is None:
            return
        header, state = self._parsed(data)
        different = list(_differences(header["run"], self._run))
        if different:
            more = f" and {len(different) - _NAMED} more" if len(different) > _NAMED else ""
            raise StateError(
                f"The checkpoint '{self.file}' belongs to another run: {'; '.join(different[:_NAMED])}{more}. "
                "Give the settings it was made with or another --out, or start from the beginning without --resume, "
                "which replaces it (in Python: folder, without resume=True)."
            )
        self._take(header, state)

    def _take(self, header: Mapping[str, Any], state: bytes) -> None:
        """Have the rows and records that a header counts, and the state, as `saved`."""
        try:
            data = self._rows.read(header["size"], header["checksum"])
            kept = self._records.read(*header["kept"]) if "kept" in header else b""
        except ValueError as reason:
            raise self._damaged(str(reason)) from None
        rows = np.frombuffer(data, np.dtype([(name, kind) for name, kind in header["columns"]]))
        self.kept = list(_records(kept))
        self.count, self._stored = len(rows), len(self.kept)
        self.saved = Saved(header["time"], state, rows)

    def _parsed(self, data: bytes) -> tuple[dict[str, Any], bytes]:
        """Return header and state."""
        start = len(_MAGIC) + 8
        if len(data) < start or not data.startswith(_MAGIC):
            raise self._damaged("it is not one of this version of tribofmu")
        checksum, length = struct.unpack("<II", data[len(_MAGIC) : start])
        if zlib.crc32(data[start - 4 :]) != checksum:
            raise self._damaged("it was cut or changed")
        return json.loads(data[start : start + length]), data[start + length :]

    def _damaged(self, reason: str) -> StateError:
        return StateError(f"The checkpoint '{self.file}' cannot be used: {reason}. {_WAY_OUT}")


_WAY_OUT = "Start from the beginning without --resume, which replaces it (in Python: without resume=True)."


def _records(data: bytes) -> Iterator[bytes]:
    """Yield the records of the caller."""
    at = 0
    while at < len(data):
        (length,) = _LENGTH.unpack_from(data, at)
        at += _LENGTH.size + length
        yield data[at - length : at]


def _flush(file: Any) -> None:
    """Flush to the disk: a checkpoint must not name rows that a power cut can lose."""
    file.flush()
    os.fsync(file.fileno())


def _differences(there: dict[str, Any], here: Mapping[str, Any]) -> Iterator[str]:
    before, now = dict(_leaves(there)), dict(_leaves(here))
    for name in [*before, *(name for name in now if name not in before)]:
        old, new = before.get(name, "nothing"), now.get(name, "nothing")
        if old != new:
            yield f"{name} = {old!r} there, {new!r} here"


def _leaves(table: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _leaves(value, f"{path}{key}.")
        else:
            yield f"{path}{key}", value
