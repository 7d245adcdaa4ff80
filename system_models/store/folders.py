"""Folders of results."""

import os
from pathlib import Path

from contact_core.errors import ContactError


def made(folder: Path) -> Path:
    """Return a folder of results, made before a run so that no result is lost. Raises ContactError if it cannot be."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ContactError(f"The folder '{folder}' cannot be made: {error.strerror}. Use another --out.") from None
    if not os.access(folder, os.W_OK):
        raise ContactError(f"The folder '{folder}' cannot be written to. Use another --out.")
    return folder
