"""Processes as Linux's /proc knows them."""

import contextlib
import ctypes
import time
from collections.abc import Callable
from pathlib import Path

import pytest


def children(pid: int) -> list[int]:
    """Processes whose parent is `pid`."""
    found = Path(f"/proc/{pid}/task").glob("*/children")
    return sorted(int(child) for listed in found for child in listed.read_text().split())


def marked(environment: bytes, command: bytes) -> list[int]:
    """Processes that have an entry in their environment and a word in their command."""
    found = []
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit():
            with contextlib.suppress(OSError):  # they come and go
                if (
                    environment in folder.joinpath("environ").read_bytes().split(b"\0")
                    and command in folder.joinpath("cmdline").read_bytes()
                ):
                    found.append(int(folder.name))
    return sorted(found)


def without_children(pids: list[int]) -> list[int]:
    """Those that are no children of others among them, and have not ended since."""
    below = {child for pid in pids for child in children(pid)}
    return [pid for pid in pids if pid not in below and alive(pid)]


def alive(pid: int) -> bool:
    """Whether it runs: a zombie does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def soon(condition: Callable[[], bool], seconds: float = 120.0) -> bool:
    """Whether `condition` comes true; the limit is for what never does, on a machine that is busy."""
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.01)
    return condition()


def mapped(pid: int) -> int:
    """Address space [kB] of `pid`: what of it is in memory is the system's affair."""
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("VmSize"))


class _Mallinfo(ctypes.Structure):
    _fields_ = [(f"before_{k}", ctypes.c_size_t) for k in range(4)]
    _fields_ += [("in_maps", ctypes.c_size_t), ("unused_1", ctypes.c_size_t), ("unused_2", ctypes.c_size_t)]
    _fields_ += [("in_heap", ctypes.c_size_t), ("free", ctypes.c_size_t), ("at_top", ctypes.c_size_t)]


def allocated() -> int:
    """Bytes that this process has got from malloc and not given back: a count, whatever of it is in memory."""
    mallinfo = getattr(ctypes.CDLL(None), "mallinfo2", None)
    if mallinfo is None:
        pytest.skip("this C library does not count what it has given")
    mallinfo.restype = _Mallinfo
    found = mallinfo()
    return found.in_heap + found.in_maps


def descriptors(pid: int) -> int:
    """Number of files that `pid` holds open."""
    return sum(1 for _ in Path(f"/proc/{pid}/fd").iterdir())
