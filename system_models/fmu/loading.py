"""Unpacks FMUs and loads their libraries."""

import tempfile
import threading
from collections.abc import Callable
from contextlib import ExitStack, chdir
from pathlib import Path
from typing import Any

from .archive import opened
from .errors import CouplingError

_LOADING = threading.Lock()  # fmpy changes the working directory while it loads a library


def unpack(path: Path, exits: ExitStack) -> str:
    """Unpack an FMU into a temporary folder, which is removed when `exits` closes, and return the folder."""
    folder = exits.enter_context(tempfile.TemporaryDirectory(prefix="tribofmu-"))
    if "%" in Path(folder).as_uri().replace("%20", ""):  # some FMUs crash there
        raise CouplingError(
            f"FMUs cannot be loaded from '{folder}'. Set TMPDIR to a folder named in plain letters and digits."
        )
    with opened(path) as archive:
        archive.unpack(folder)
    return folder


def load(library: Callable[..., Any], *arguments: Any, **named: Any) -> Any:
    """Return library(*arguments, **named), one at a time."""
    with _LOADING, chdir("."):  # fmpy stays in the library's folder if it cannot be loaded
        return library(*arguments, **named)
