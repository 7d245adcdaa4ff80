"""What pythonfmu's binary leaves behind in the process, and how it is tidied up."""

import atexit
import contextlib
import ctypes
import functools
import os
import sys
from pathlib import Path


def tidy(folder: str, model: str) -> None:
    """Undo the side effects of one instantiation of the FMU of `model` whose resources lie in `folder`."""
    with contextlib.suppress(ValueError):  # the binary puts it there at each instantiation and leaves it
        sys.path.remove(folder)
    _release_at_exit(folder, model)


@functools.cache
def _release_at_exit(folder: str, model: str) -> None:
    """Let the binary of pythonfmu 0.7 give up its interpreter before the process ends.

    On Linux it does so twice otherwise, in a static destructor and again when it is unloaded, if the C++ runtime
    has pinned it until then: a use after free that now and then aborts a Python host at its exit. By then the host may
    have deleted the folder: only the very name by which it was loaded finds the library, and ecos's URIs have a slash
    more.
    """
    if sys.platform == "linux":
        library = Path("/" + folder.lstrip("/")).parent / "binaries" / "linux64" / f"{model}.so"
        atexit.register(_release, library)


def _release(library: Path) -> None:
    with contextlib.suppress(OSError):  # not loaded any more: nothing to give up
        ctypes.CDLL(str(library), mode=os.RTLD_NOLOAD | os.RTLD_LAZY).finalizePythonInterpreter()
