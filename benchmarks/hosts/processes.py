"""Processes, their memory and files, from Linux's /proc."""

import contextlib
import time
from collections.abc import Callable
from pathlib import Path


def children(pid: int) -> list[int]:
    """Return the processes whose parent is `pid`."""
    found = Path(f"/proc/{pid}/task").glob("*/children")
    return sorted(int(child) for listed in found for child in listed.read_text().split())


def marked(environment: bytes, command: bytes) -> list[int]:
    """Return the processes with an entry in their environment and a word in their command."""
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
    """Return the running processes of the list that are not children of others in it."""
    below = {child for pid in pids for child in children(pid)}
    return [pid for pid in pids if pid not in below and alive(pid)]


def alive(pid: int) -> bool:
    """Return whether a process runs; a zombie does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def soon(condition: Callable[[], bool], seconds: float = 120.0) -> bool:
    """Return whether `condition` becomes true; the limit is generous, for busy machines."""
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.01)
    return condition()


def resident(pid: int) -> int:
    """Return the memory that `pid` uses now [kB]."""
    return _memory(pid, "VmRSS")


def mapped(pid: int) -> int:
    """Return the address space of `pid` [kB]; the system decides how much of it is in memory."""
    return _memory(pid, "VmSize")


def _memory(pid: int, entry: str) -> int:
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith(entry))


def descriptors(pid: int) -> int:
    """Return the number of files that `pid` has open."""
    return sum(1 for _ in Path(f"/proc/{pid}/fd").iterdir())
