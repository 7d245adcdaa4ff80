"""The channel of a worker on Linux: a file in memory, mapped by host and worker.

library/channel_linux.c is the other side; change the two together.
"""

import ctypes
import fcntl
import mmap
import os
import struct
from collections.abc import Sequence
from contextlib import suppress
from typing import Any

from .message import Buffer

_SIZES = struct.Struct("<QQ")  # of the file, of the message
_SIZE = struct.Struct("<Q")
_AT_SIZES, _AT_REASON_SIZE, _AT_REASON, _AT_MESSAGE = 8, 24, 64, 8192  # offsets [bytes]; the turn is at 0
_REASON = _AT_MESSAGE - _AT_REASON  # longest reason for a lost worker [bytes]
_WORKER, _HOST, _LOST = 1, 2, 3  # the turn: who acts next
_FUTEX, _WAIT, _WAKE = 202, 0, 1  # system call and operations of x86-64

_syscall = ctypes.CDLL(None, use_errno=True).syscall


def _futex(turn: ctypes.c_uint32, operation: int, value: int) -> tuple[Any, ...]:
    """Return the arguments of a futex call on the turn as C types: converting them takes longer than the call."""
    address, nothing = ctypes.c_void_p(ctypes.addressof(turn)), ctypes.c_void_p()
    number, rest = ctypes.c_long(_FUTEX), ctypes.c_int(0)
    return number, address, ctypes.c_int(operation), ctypes.c_uint32(value), nothing, nothing, rest


class SharedMemory:
    """A channel in a file in memory."""

    def __init__(self, file: int) -> None:
        self._file = file
        self._map()

    def _map(self) -> None:
        self._memory = mmap.mmap(self._file, os.fstat(self._file).st_size)
        self._turn = ctypes.c_uint32.from_buffer(self._memory)
        self._wake = _futex(self._turn, _WAKE, 1)
        self._waits = [_futex(self._turn, _WAIT, whose) for whose in range(_LOST + 1)]

    def receive(self) -> bytes:
        """Wait for the host's next message and return it."""
        while (whose := self._turn.value) != _WORKER:
            _syscall(*self._waits[whose])
        capacity, size = _SIZES.unpack_from(self._memory, _AT_SIZES)
        if capacity > len(self._memory):
            self._map()
        return self._memory[_AT_MESSAGE : _AT_MESSAGE + size]

    def send(self, chunks: Sequence[Buffer]) -> None:
        """Answer the last message."""
        data = b"".join(chunks)
        end = _AT_MESSAGE + len(data)
        if end > len(self._memory):
            os.ftruncate(self._file, 2 * end)
            self._map()
        self._memory[_AT_MESSAGE:end] = data
        _SIZES.pack_into(self._memory, _AT_SIZES, len(self._memory), len(data))
        self._give(_HOST)

    def hold(self) -> None:
        """Lock the file while this process lives: the lock shows the host when the process has ended."""
        with suppress(OSError):  # where locks do not work, the supervisor's report is enough
            self._held = os.open(f"/proc/self/fd/{self._file}", os.O_RDWR | os.O_CLOEXEC)
            fcntl.flock(self._held, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def lose(self, reason: str) -> None:
        """Report to the host that the worker has ended."""
        data = reason.encode()[:_REASON]
        self._memory[_AT_REASON : _AT_REASON + len(data)] = data
        _SIZE.pack_into(self._memory, _AT_REASON_SIZE, len(data))
        self._give(_LOST)

    def _give(self, turn: int) -> None:
        self._turn.value = turn
        _syscall(*self._wake)

    def close(self) -> None:
        os.close(self._file)
