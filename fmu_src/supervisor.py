"""The process behind the isolated flavour on Linux: it imports the model once and forks a worker for every instance.

native/channel_linux.c is the other side: orders come over a socket and are answered there, each worker's messages lie
in a file in memory. The workers end with their supervisor, and the supervisor with its host.
"""

import ctypes
import faulthandler
import fcntl
import gc
import mmap
import os
import resource
import select
import signal
import socket
import struct
import traceback
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .worker import Buffer, Worker, slave_class

_SIZES = struct.Struct("<QQ")  # of the file, of the message
_SIZE = struct.Struct("<Q")
_AT_SIZES, _AT_REASON_SIZE, _AT_REASON, _AT_MESSAGE = 8, 24, 64, 8192  # the turn comes first
_WORKER, _HOST, _LOST = 1, 2, 3  # whose turn it is
_REASON, _TRACE = _AT_MESSAGE - _AT_REASON, 6000  # bytes: the last words on a worker, and its own in them

_MODULES = "\nExtension modules:"  # the end of what faulthandler says, and of no use here

_FUTEX, _WAIT, _WAKE = 202, 0, 1  # of x86-64
_PR_SET_PDEATHSIG = 1

_libc = ctypes.CDLL(None, use_errno=True)
_syscall = _libc.syscall


def _futex(turn: ctypes.c_uint32, operation: int, value: int) -> tuple[Any, ...]:
    """What a call of futex on the turn takes, as C has it: to convert it anew would take longer than the call."""
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
        """Wait for the host's next message."""
        while (whose := self._turn.value) != _WORKER:
            _syscall(*self._waits[whose])
        capacity, size = _SIZES.unpack_from(self._memory, _AT_SIZES)
        if capacity > len(self._memory):
            self._map()
        return self._memory[_AT_MESSAGE : _AT_MESSAGE + size]

    def send(self, chunks: Sequence[Buffer]) -> None:
        """Answer it."""
        data = b"".join(chunks)
        end = _AT_MESSAGE + len(data)
        if end > len(self._memory):
            os.ftruncate(self._file, 2 * end)
            self._map()
        self._memory[_AT_MESSAGE:end] = data
        _SIZES.pack_into(self._memory, _AT_SIZES, len(self._memory), len(data))
        self._give(_HOST)

    def hold(self) -> None:
        """Lock the file by a descriptor of its own, as long as this process lives: the host sees when it has ended."""
        with suppress(OSError):  # where that cannot be, the supervisor's word must do
            self._held = os.open(f"/proc/self/fd/{self._file}", os.O_RDWR | os.O_CLOEXEC)
            fcntl.flock(self._held, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def lose(self, reason: str) -> None:
        """Tell the host that there is no worker any more."""
        data = reason.encode()[:_REASON]
        self._memory[_AT_REASON : _AT_REASON + len(data)] = data
        _SIZE.pack_into(self._memory, _AT_REASON_SIZE, len(data))
        self._give(_LOST)

    def _give(self, turn: int) -> None:
        self._turn.value = turn
        _syscall(*self._wake)

    def close(self) -> None:
        """Let the file go."""
        os.close(self._file)


@dataclass
class Child:
    """A worker as its supervisor knows it."""

    number: int
    channel: SharedMemory
    trace: int  # file in memory with what faulthandler has to say


class Supervisor:
    """Takes the host's orders, and tells it when a worker has ended."""

    def __init__(self, control: socket.socket, resources: Path) -> None:
        self._control = control
        self._resources = resources
        self._children: dict[int, Child] = {}
        self._woken, self._waker = socket.socketpair()
        for end in (self._woken, self._waker):
            end.setblocking(False)
        signal.signal(signal.SIGCHLD, lambda *_: None)
        signal.set_wakeup_fd(self._waker.fileno(), warn_on_full_buffer=False)

    def serve(self) -> None:
        """Obey until the host is gone; then kill the workers."""
        while True:
            ready, _, _ = select.select([self._control, self._woken], [], [])
            if self._woken in ready:
                with suppress(BlockingIOError):
                    self._woken.recv(4096)
                self._reap()
            if self._control in ready and not self._obey():
                break
        for pid in self._children:
            os.kill(pid, signal.SIGKILL)
        for pid in self._children:
            os.waitpid(pid, 0)

    def _obey(self) -> bool:
        data, files, _, _ = socket.recv_fds(self._control, 16, 1)
        if not data:
            return False
        number = int.from_bytes(data[8:16], "little")
        if data[:1] == b"F":
            self._control.send(self._forked(number, files))
        for pid, child in self._children.items():
            if data[:1] == b"K" and child.number == number:
                os.kill(pid, signal.SIGKILL)
        return True

    def _forked(self, number: int, files: list[int]) -> bytes:
        """Fork a worker for the channel in `files`; the answer to the order."""
        supervisor = os.getpid()
        try:
            files.append(os.memfd_create("trace"))
            file, trace = files  # one only if there was no descriptor left for the host's file
            channel = SharedMemory(file)
            pid = os.fork()
        except (OSError, ValueError) as error:
            for descriptor in files:
                os.close(descriptor)
            return f"ENo process could be made for it ({error}). Free other instances, or raise limits.".encode()
        if pid:
            self._children[pid] = Child(number, channel, trace)
            return b"R"
        try:
            self._become_worker(supervisor, trace)
            channel.hold()
            Worker(channel, self._resources).serve()
        except BaseException:
            os.write(trace, traceback.format_exc().encode("utf-8", "backslashreplace"))
            os._exit(1)
        os._exit(0)

    def _become_worker(self, supervisor: int, trace: int) -> None:
        _libc.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != supervisor:
            os._exit(0)
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        self._control.close()
        for child in self._children.values():
            child.channel.close()
            os.close(child.trace)
        self._children.clear()
        faulthandler.enable(trace, all_threads=False)

    def _reap(self) -> None:
        with suppress(ChildProcessError):
            while (found := os.waitpid(-1, os.WNOHANG))[0]:
                pid, status = found
                child = self._children.pop(pid)
                trace = os.pread(child.trace, _TRACE, max(0, os.fstat(child.trace).st_size - _TRACE))
                text = trace.decode("utf-8", "replace").partition(_MODULES)[0]
                child.channel.lose(f"{_ending(status)}\n{text}".rstrip())
                child.channel.close()
                os.close(child.trace)


def _ending(status: int) -> str:
    code = os.waitstatus_to_exitcode(status)
    if code >= 0:
        return f"It ended with exit status {code}."
    return f"It was killed by signal {-code} ({signal.strsignal(-code)})."


def supervise(control: int, resources: Path, ready: Callable[[], None]) -> None:
    """Serve the host at the other end of the socket `control`, once `ready` has told it so."""
    most = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))  # a worker takes three
    slave = slave_class(resources)
    if hasattr(slave, "warm_up"):
        slave.warm_up(resources)
    gc.freeze()  # what is shared with the workers stays shared
    gc.enable()
    supervisor = Supervisor(socket.socket(fileno=control), resources)
    ready()
    supervisor.serve()
