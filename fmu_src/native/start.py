"""Run by the FMU's library: serves its instances, in the Python in which tribofmu is installed."""

import os
import sys
import traceback
from pathlib import Path

_CONTROL = 3  # the library's socket; on Windows messages go through the standard streams


def _serve(resources: Path) -> None:
    # one thread: the workers are many, and a process with threads cannot be forked
    os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", MKL_NUM_THREADS="1", NUMBA_NUM_THREADS="1")
    if sys.platform == "win32":
        from fmu_src.worker import Pipe, Worker

        _say(b"R")
        incoming, outgoing = os.dup(0), os.dup(1)
        os.dup2(2, 1)  # what the model prints goes to where errors go
        Worker(Pipe(incoming, outgoing), resources).serve()
    else:
        from fmu_src.supervisor import supervise

        os.closerange(_CONTROL + 1, os.sysconf("SC_OPEN_MAX"))
        supervise(_CONTROL, resources, lambda: _say(b"R"))


def _say(data: bytes) -> None:
    """Tell the library that all is ready (R), or why there is no worker (E)."""
    if sys.platform == "win32":
        os.write(1, len(data).to_bytes(8, "little") + data)
    else:
        os.write(_CONTROL, data)


try:
    _serve(Path(__file__).parent)
except ModuleNotFoundError as error:
    _say(f"E{error}: the Python {sys.version.split()[0]} that was found has not all packages of tribofmu.".encode())
    sys.exit(1)
except BaseException:
    _say(b"E" + traceback.format_exc().encode("utf-8", "backslashreplace")[:7000])
    sys.exit(1)
