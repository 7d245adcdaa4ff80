"""The process behind the isolated flavour on Linux: it imports the model once and forks a worker for every instance.

Orders come over a socket from native/channel_linux.c; the messages of each worker lie in a file in memory.
"""

import ctypes
import faulthandler
import gc
import os
import resource
import select
import signal
import socket
import traceback
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from .shared_memory import SharedMemory
from .worker import Worker, slave_class

_TRACE = 6000  # most bytes of a worker's trace in the reason given to the host
_MODULES = "\nExtension modules:"  # end of faulthandler's report, of no use here
_PR_SET_PDEATHSIG = 1

_libc = ctypes.CDLL(None, use_errno=True)


@dataclass
class Child:
    """A worker process, seen from its supervisor."""

    number: int
    channel: SharedMemory
    trace: int  # file in memory for faulthandler's report


class Supervisor:
    """Carries out the host's orders and reports to it when a worker has ended."""

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
        """Carry out orders until the host has gone; then kill the workers."""
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
        """Fork a worker for the channel in `files` and return the answer to the order."""
        supervisor = os.getpid()
        try:
            files.append(os.memfd_create("trace"))
            file, trace = files  # only one if no descriptor was left for the host's file
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
    """Serve the host at the other end of the socket `control`; `ready` reports to it that the model is loaded."""
    most = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))  # a worker takes three
    slave = slave_class(resources)
    if hasattr(slave, "warm_up"):
        slave.warm_up(resources)
    gc.freeze()  # memory shared with the workers stays shared
    gc.enable()
    supervisor = Supervisor(socket.socket(fileno=control), resources)
    ready()
    supervisor.serve()
