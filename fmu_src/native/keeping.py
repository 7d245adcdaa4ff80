"""What takes long to make for native FMUs is kept in the user's cache, so that only the first run waits for it."""

import hashlib
import json
import os
import sys
import tempfile
from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from time import time

import numpy as np

from contact_core.kernels.cache import user_cache

_NOWHERE = Path(os.devnull)  # can hold no folder
_CHECKSUM = 32  # bytes before what is kept
_UNUSED = 30 * 86400.0  # s after which something is removed that no run has asked for


def kept(key: object, make: Callable[[], bytes]) -> bytes:
    """Return what `make` returns, or has returned to an earlier run.

    The repr of `key` tells all that decides it. Where the cache cannot be written it is made each time.
    """
    file = folder() / hashlib.sha256(repr(key).encode()).hexdigest()
    with suppress(OSError):
        found = file.read_bytes()
        checksum, data = found[:_CHECKSUM], found[_CHECKSUM:]
        if checksum == hashlib.sha256(data).digest():  # else a power cut has torn it
            os.utime(file)
            return data
    data = make()
    with suppress(OSError):
        _keep(file, hashlib.sha256(data).digest() + data)
    return data


def kept_texts(key: object, make: Callable[[], dict[str, str]]) -> dict[str, str]:
    """Return texts by name, as `kept` does."""
    return dict(json.loads(kept(key, lambda: json.dumps(make()).encode())))


def _keep(file: Path, data: bytes) -> None:
    """Write a file as a whole, whatever other runs do meanwhile, and remove those that are unused."""
    file.parent.mkdir(parents=True, exist_ok=True)
    for other in file.parent.iterdir():
        if other.stat().st_mtime < time() - _UNUSED:
            other.unlink(missing_ok=True)
    with tempfile.NamedTemporaryFile(dir=file.parent, delete=False) as unfinished:
        unfinished.write(data)
    Path(unfinished.name).replace(file)


def folder() -> Path:
    return (user_cache() or _NOWHERE) / "tribofmu" / "native"


def code_of(*packages: str) -> str:
    """Return a fingerprint of all files of loaded packages or modules, and of what they compute with."""
    return _code_of(frozenset(packages))


@lru_cache(maxsize=16)
def _code_of(packages: frozenset[str]) -> str:
    found = hashlib.sha256(repr((sys.version, np.__version__)).encode())
    for name in sorted(packages):
        module = sys.modules[name]
        roots = getattr(module, "__path__", None) or [getattr(module, "__file__", None)]
        for root in roots:
            found.update(_content(Path(root)) if root else os.urandom(32))  # typed in: never the same
    return found.hexdigest()


def _content(root: Path) -> bytes:
    """Return a fingerprint of a file, or of all files in a folder and their names."""
    found = hashlib.sha256()
    for file in sorted(root.rglob("*")) if root.is_dir() else [root]:
        if file.is_file() and file.parent.name != "__pycache__":
            found.update(f"{file.relative_to(root.parent)}\0".encode() + file.read_bytes())
    return found.digest()
