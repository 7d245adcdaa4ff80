"""Folder of the compiled kernels: numba's own choice if it can be written, else a private temporary one.

numba keeps compiled code beside the sources or in the user's cache.

Service accounts and containers often can write neither, and numba then refuses to compile what is to be kept.
"""

import contextlib
import os
import stat
import sys
import tempfile
import warnings
from pathlib import Path

from ..errors import ContactError


def ensure() -> str:
    """Choose a private folder for compiled kernels if numba can write none of its own.

    Return the sentence of the warning, or an empty text if there was no need. Raises ContactError if there is no
    such folder either. Loads no compiler: the regression level needs none.
    """
    if os.environ.get("NUMBA_CACHE_DIR") or any(map(_can_be_written, _places())):
        return ""
    try:
        folder = _private_folder()
    except OSError as error:
        raise ContactError(
            f"Compiled kernels can be kept nowhere ({error}). Set NUMBA_CACHE_DIR to a folder that can be written."
        ) from None
    os.environ["NUMBA_CACHE_DIR"] = str(folder)  # of child processes, too
    if "numba" in sys.modules:
        setattr(sys.modules["numba"].config, "CACHE_DIR", str(folder))  # noqa: B010  # numba declares it nowhere
    notice = (
        f"Neither the folder of contact_core nor the user's cache can be written: compiled kernels are kept in "
        f"'{folder}'. Set NUMBA_CACHE_DIR to a folder that lasts, and the first start will not be slow again."
    )
    warnings.warn(notice, RuntimeWarning, stacklevel=2)
    return notice


def _places() -> list[Path]:
    """Return the folders in which numba keeps the compiled functions of this folder, by preference."""
    beside, of_user = Path(__file__).with_name("__pycache__"), user_cache()
    if of_user is None:
        return [beside]
    return [beside, of_user if sys.platform == "win32" else of_user / "numba"]


def user_cache() -> Path | None:
    """Return the folder of this user's caches; None for a user without a home folder."""
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", tempfile.gettempdir()))
    caches = "~/Library/Caches" if sys.platform == "darwin" else os.environ.get("XDG_CACHE_HOME", "~/.cache")
    with contextlib.suppress(RuntimeError):
        return Path(caches).expanduser()
    return None


def _can_be_written(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False


def _private_folder() -> Path:
    """Return a temporary folder of this user alone: its contents are executed."""
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
