"""Where numba keeps the compiled kernels: beside the sources or in the user's cache, as it does by itself; else apart.

Service accounts and containers often can write neither, and numba then refuses to compile what is to be kept.
"""

import os
import stat
import tempfile
import warnings
from pathlib import Path

import numba

from ..errors import ContactError


def _probe() -> None:
    """A function of this folder, never called."""


def ensure() -> str:
    """Choose a private folder for compiled kernels if numba finds none that can be written.

    Return the sentence that says so, and warn with it; empty if there was no need. Raises ContactError if there is no
    such folder either.
    """
    if _has_place():
        return ""
    try:
        folder = _private_folder()
    except OSError as error:
        raise ContactError(
            f"Compiled kernels can be kept nowhere ({error}). Set NUMBA_CACHE_DIR to a folder that can be written."
        ) from None
    os.environ["NUMBA_CACHE_DIR"] = str(folder)  # of child processes, too
    setattr(numba.config, "CACHE_DIR", str(folder))  # noqa: B010  # numba declares it nowhere
    notice = (
        f"Neither the folder of contact_core nor the user's cache can be written: compiled kernels are kept in "
        f"'{folder}'. Set NUMBA_CACHE_DIR to a folder that lasts, and the first start will not be slow again."
    )
    warnings.warn(notice, RuntimeWarning, stacklevel=2)
    return notice


def _has_place() -> bool:
    try:
        numba.njit(cache=True)(_probe)
    except RuntimeError:  # numba's, for "no locator available"
        return False
    return True


def _private_folder() -> Path:
    """A folder of this user alone among the temporary ones: what lies in it is executed."""
    if not hasattr(os, "getuid"):  # Windows: temporary folders are the user's own
        folder = Path(tempfile.gettempdir(), "tribofmu-kernels")
        folder.mkdir(exist_ok=True)
        return folder
    folder = Path(tempfile.gettempdir(), f"tribofmu-kernels-{os.getuid()}")
    try:
        folder.mkdir(mode=0o700)
    except FileExistsError:
        found = folder.lstat()
        private = stat.S_ISDIR(found.st_mode) and found.st_uid == os.getuid() and not found.st_mode & 0o077
        if not private or not os.access(folder, os.W_OK):
            return Path(tempfile.mkdtemp(prefix="tribofmu-kernels-"))
    return folder


NOTICE = ensure()
