"""Processes as Linux's /proc knows them."""

import contextlib
import time
from collections.abc import Callable
from pathlib import Path


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
    """Those that are no children of others among them."""
    below = {child for pid in pids for child in children(pid)}
    return [pid for pid in pids if pid not in below]


def alive(pid: int) -> bool:
    """Whether it runs: a zombie does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def soon(condition: Callable[[], bool], seconds: float = 20.0) -> bool:
    """Whether `condition` comes true."""
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.01)
    return condition()


def resident(pid: int) -> int:
    """Memory [kB] in use by `pid` now."""
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("VmRSS"))


def descriptors(pid: int) -> int:
    """Number of files that `pid` holds open."""
    return sum(1 for _ in Path(f"/proc/{pid}/fd").iterdir())
