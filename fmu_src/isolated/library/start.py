"""Serve the instances of an FMU; run by the FMU's library in the Python in which tribofmu is installed.

With --pipe one instance over its standard streams; otherwise by a worker forked for each, on orders from a socket.
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
    # one thread: there are many workers, and a process with threads cannot be forked safely
    os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", MKL_NUM_THREADS="1", NUMBA_NUM_THREADS="1")
    if _PIPE:
        _serve_one(resources)
    elif sys.platform != "win32":
        gc.disable()  # imported modules stay: collecting them takes a tenth of a second
        from fmu_src.isolated.supervisor import supervise

        os.closerange(_SOCKET + 1, os.sysconf("SC_OPEN_MAX"))
        supervise(_SOCKET, resources, lambda: _say(b"R"))


def _serve_one(resources: Path) -> None:
    import faulthandler

    from fmu_src.isolated.channels import Pipe
    from fmu_src.isolated.worker import Worker, slave_class

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
    """Report to the library that the model is loaded (R), or why not (E)."""
    with contextlib.suppress(OSError):  # the host may have gone
        os.write(_outgoing, len(data).to_bytes(8, "little") + data if _PIPE else data)


if not _PIPE and os.fork():
    os._exit(0)  # a host may wait for all of its children: this process must not be one
signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is for the host
_incoming = _outgoing = _SOCKET
if _PIPE:  # keep what the model reads and prints apart from messages
    _incoming, _outgoing = os.dup(0), os.dup(1)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(2, 1)
try:
    _serve(Path(__file__).parent)
except ModuleNotFoundError as error:
    version = sys.version.split()[0]
    _say(f"E{error}: Python {version} does not have tribofmu, with all its packages, as this FMU needs it.".encode())
    sys.exit(1)
except BaseException as error:
    refused = any(known.__name__ == "ContactError" for known in type(error).__mro__)  # its message is enough
    text = str(error) if refused else traceback.format_exc()
    _say(b"E" + text.encode("utf-8", "backslashreplace")[-7000:])
    sys.exit(1)
