"""Folders of results."""

import os
from pathlib import Path

from contact_core.errors import ContactError

_WAY_OUT = "Use another --out (in Python: folder)."


def made(folder: Path) -> Path:
    """Return a folder of results, made before a run so that no result is lost. Raises ContactError if it cannot be."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ContactError(f"The folder '{folder}' cannot be made: {error.strerror}. {_WAY_OUT}") from None
    if not os.access(folder, os.W_OK):
        raise ContactError(f"The folder '{folder}' cannot be written to. {_WAY_OUT}")
    return folder
