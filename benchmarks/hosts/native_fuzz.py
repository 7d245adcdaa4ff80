"""A C program that drives the sources of a native FMU by random calls: compiled with them, see native_fuzz.c."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping
from pathlib import Path

from fmu_src.isolated.library.build import headers

SOURCE = Path(__file__).with_suffix(".c")
_FLAGS = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-ffp-contract=off", "-fno-math-errno")
SANITIZED = ("-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
COUNTED = ("-DCOUNT_ALLOCATIONS",)  # not with a sanitizer, which has its own allocation


def compiled(folder: Path, sources: Mapping[str, bytes], *flags: str, compiler: tuple[str, ...] = ("gcc",)) -> Path:
    """The program, with the sources of both versions of FMI."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in (sources | {SOURCE.name: SOURCE.read_bytes()}).items():
        (folder / name).write_bytes(content)
    files = sorted(path.name for path in folder.glob("*.c"))
    program = folder / "native_fuzz"
    call = [*compiler, *_FLAGS, *flags, "-isystem", str(headers()), *files, "-lm", "-o", str(program)]
    subprocess.run(call, cwd=folder, check=True)
    return program


def digest(program: Path, sequences: int, seed: int = 1) -> str:
    """Digest of all answers to so many sequences of calls. Raises RuntimeError with what went wrong."""
    return _answer(program, "random", sequences, seed)


def kilobytes(program: Path, instances: int) -> float:
    """Resident memory of each of so many instances after its first step [kB]."""
    return float(_answer(program, "crowd", instances))


def _answer(program: Path, *words: object) -> str:
    found = subprocess.run([program, *map(str, words)], capture_output=True, text=True)
    if found.returncode:
        raise RuntimeError(f"{found.stdout}{found.stderr}".strip() or f"exit status {found.returncode}")
    return found.stdout.strip()
