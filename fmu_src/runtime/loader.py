"""Clean-up after pythonfmu's binary, which leaves traces in the process (embedded FMUs)."""

import atexit
import contextlib
import ctypes
import functools
import os
import sys
from pathlib import Path


def tidy(folder: str, model: str) -> None:
    """Undo the side effects of one instantiation of the FMU of `model` whose resources lie in `folder`."""
    with contextlib.suppress(ValueError):  # added by the binary at each instantiation, never removed
        sys.path.remove(folder)
    _release_at_exit(folder, model)


@functools.cache
def _release_at_exit(folder: str, model: str) -> None:
    """Make the binary of pythonfmu 0.7 release its interpreter before the process ends.

    On Linux it would otherwise do so twice, in a static destructor and again when it is unloaded, if the C++ runtime
    has pinned it until then: a use after free that sometimes aborts a Python host at its exit. The host may have
    deleted the folder by then: only the name by which the library was loaded finds it, and the URIs of ecos have an
    extra slash.
    """
    if sys.platform == "linux":
        library = Path("/" + folder.lstrip("/")).parent / "binaries" / "linux64" / f"{model}.so"
        atexit.register(_release, library)


def _release(library: Path) -> None:
    with contextlib.suppress(OSError):  # no longer loaded: nothing to release
        ctypes.CDLL(str(library), mode=os.RTLD_NOLOAD | os.RTLD_LAZY).finalizePythonInterpreter()
