"""Run by the FMU's library: serves its instances, in the Python in which tribofmu is installed.

With --pipe it serves one instance over its standard streams; else it leaves the host's children and forks a worker for
each instance, as the library's socket tells it to.
"""

import contextlib
import gc
import os
import signal
import sys
import traceback
from pathlib import Path

_SOCKET = 3
_PIPE = "--pipe" in sys.argv


def _serve(resources: Path) -> None:
    # one thread: the workers are many, and a process with threads cannot be forked
    os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", MKL_NUM_THREADS="1", NUMBA_NUM_THREADS="1")
    if _PIPE:
        _serve_one(resources)
    elif sys.platform != "win32":
        gc.disable()  # what is imported stays: to look through it costs a tenth of a second
        from fmu_src.supervisor import supervise

        os.closerange(_SOCKET + 1, os.sysconf("SC_OPEN_MAX"))
        supervise(_SOCKET, resources, lambda: _say(b"R"))


def _serve_one(resources: Path) -> None:
    import faulthandler

    from fmu_src.worker import Pipe, Worker, slave_class

    slave = slave_class(resources)
    if hasattr(slave, "warm_up"):
        slave.warm_up(resources)
    _say(b"R")
    faulthandler.enable()
    try:
        Worker(Pipe(_incoming, _outgoing), resources).serve()
    except BaseException:  # the library reads stderr when its worker has ended
        traceback.print_exc()
        os._exit(1)


def _say(data: bytes) -> None:
    """Tell the library that all is ready (R), or why there is no worker (E)."""
    with contextlib.suppress(OSError):  # a host that is gone need not know
        os.write(_outgoing, len(data).to_bytes(8, "little") + data if _PIPE else data)


if not _PIPE and os.fork():
    os._exit(0)  # the host, which may wait for all of its children, has none of ours
signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is the host's
_incoming = _outgoing = _SOCKET
if _PIPE:  # what the model reads and prints is no message
    _incoming, _outgoing = os.dup(0), os.dup(1)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(2, 1)
try:
    _serve(Path(__file__).parent)
except ModuleNotFoundError as error:
    _say(f"E{error}: the Python {sys.version.split()[0]} that was found has not all packages of tribofmu.".encode())
    sys.exit(1)
except BaseException as error:
    refused = any(known.__name__ == "ContactError" for known in type(error).__mro__)  # a sentence says it all
    text = str(error) if refused else traceback.format_exc()
    _say(b"E" + text.encode("utf-8", "backslashreplace")[-7000:])
    sys.exit(1)
