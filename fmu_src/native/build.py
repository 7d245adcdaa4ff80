"""Build the libraries of a native FMU from its sources in C.

zig (pip install tribofmu[native]) builds for every platform, with old C libraries; gcc or cc for this Linux only.
"""

import struct
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from platform import machine
from shutil import which
from typing import Literal

from ..flavours import Version
from ..isolated.library.build import headers
from . import keeping

Fmi = Version
Compiler = Literal["zig", "gcc", "cc"]

FOLDER = Path(__file__).parent
_SHARED = (
    "derivatives.c",
    "instance.c",
    "log.c",
    "states.c",
    "values.c",
    "instance.h",
    "log.h",
    "model.h",
    "elementary.h",
    "elementary_arrays.h",
)
RUNTIME: dict[Fmi, tuple[str, ...]] = {2: ("fmi2.c", *_SHARED), 3: ("fmi3.c", "fmi3_absent.c", *_SHARED)}

WARNINGS = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror")
# no fused multiply-adds: equal bits on every platform
FLAGS = (
    "-O2",
    "-g0",
    "-s",
    "-shared",
    "-fPIC",
    "-fvisibility=hidden",
    "-ffp-contract=off",
    "-fno-math-errno",
)
_OF_GCC_ALONE = ("-fno-tree-slp-vectorize",)  # its numbers in pairs make the series of elementary.h slower


@dataclass(frozen=True)
class Target:
    """A platform that zig builds for."""

    triple: str  # zig's name
    suffix: str
    linker: tuple[str, ...] = ()


_NAMED = ("-Wl,-install_name,@rpath/library.dylib",)  # else the library contains the folder it was built in

TARGETS = {  # by FMI 3's names
    "x86_64-linux": Target("x86_64-linux-gnu.2.17", ".so", ("-lm",)),  # any glibc since 2012
    "aarch64-linux": Target("aarch64-linux-gnu.2.17", ".so", ("-lm",)),
    "x86_64-windows": Target("x86_64-windows-gnu", ".dll"),
    "x86_64-darwin": Target("x86_64-macos", ".dylib", _NAMED),
    "aarch64-darwin": Target("aarch64-macos", ".dylib", _NAMED),
}
# FMI 2's names; a library for macOS serves both of its processors
_FMI2 = {
    "linux64": ("x86_64-linux",),
    "win64": ("x86_64-windows",),
    "darwin64": ("x86_64-darwin", "aarch64-darwin"),
}
PLATFORMS: dict[Fmi, Mapping[str, tuple[str, ...]]] = {2: _FMI2, 3: {name: (name,) for name in TARGETS}}
_SYSTEMS = {"win32": "windows", "darwin": "darwin"}  # of sys.platform; others are Linux
_PROCESSORS = {"amd64": "x86_64", "arm64": "aarch64"}  # as they call themselves there
_OF_GCC: dict[Fmi, str] = {2: "linux64", 3: "x86_64-linux"}


def own(fmi: Fmi) -> str:
    """Return the name of this platform. Raises ValueError if no library is built for it."""
    processor = machine().lower()
    target = f"{_PROCESSORS.get(processor, processor)}-{_SYSTEMS.get(sys.platform, 'linux')}"
    for name, targets in PLATFORMS[fmi].items():
        if target in targets:
            return name
    raise ValueError(f"No native FMU of FMI {fmi}.0 is built for {target}, but for {', '.join(PLATFORMS[fmi])}.")


def runtime(fmi: Fmi) -> dict[str, bytes]:
    """Return name and content of the sources that all native FMUs of a version of FMI share."""
    return {name: (FOLDER / name).read_bytes() for name in RUNTIME[fmi]}


def default_compiler() -> Compiler:
    """Return the compiler that builds for most platforms. Raises FileNotFoundError if there is none."""
    for compiler in ("zig", "gcc", "cc"):
        if available(compiler):
            return compiler
    raise FileNotFoundError("There is no compiler for C. Install zig (pip install tribofmu[native]) or gcc.")


def available(compiler: Compiler) -> bool:
    """Return True if the compiler is installed."""
    return (find_spec("ziglang") if compiler == "zig" else which(compiler)) is not None


def platforms(fmi: Fmi, compiler: Compiler) -> tuple[str, ...]:
    """Return the names of the platforms that a compiler builds for, as folders of `binaries`."""
    return tuple(PLATFORMS[fmi]) if compiler == "zig" else (_OF_GCC[fmi],)


def binaries(
    sources: Mapping[str, bytes],
    fmi: Fmi,
    model: str,
    compiler: Compiler | None = None,
    chosen: Iterable[str] | None = None,
) -> dict[str, bytes]:
    """Return the libraries of an FMU by their names in it, such as binaries/linux64/MixedContact.so.

    Parameters
    ----------
    sources
        Name and content of every file: those of `runtime` and those generated for the scene.
    fmi
        Version of FMI, which decides the names of the platforms.
    model
        Name of the library.
    compiler
        Default: zig, else gcc, else cc.
    chosen
        Names of platforms; default: all that the compiler supports.

    Raises
    ------
    FileNotFoundError
        There is no compiler.
    ValueError
        The compiler does not support a platform.
    CalledProcessError
        The sources cannot be compiled.
    """
    compiler = compiler or default_compiler()
    known = platforms(fmi, compiler)
    wanted = known if chosen is None else tuple(chosen)
    if missing := sorted(set(wanted) - set(known)):
        raise ValueError(f"{compiler} does not build for {', '.join(missing)}, but for {', '.join(known)}.")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, content in sources.items():
            (folder / file).write_bytes(content)
        return dict(_library(folder, PLATFORMS[fmi][platform], platform, model, compiler) for platform in wanted)


def _library(
    folder: Path, targets: tuple[str, ...], platform: str, model: str, compiler: Compiler
) -> tuple[str, bytes]:
    parts = [compiled(folder, target, compiler) for target in targets]
    content = parts[0] if len(parts) == 1 else universal(parts)
    return f"binaries/{platform}/{model}{TARGETS[targets[0]].suffix}", content


def command(folder: Path, target: str, compiler: Compiler, library: Path) -> list[str]:
    """Return the call that builds the library of all C files in a folder."""
    files = sorted(path.name for path in folder.glob("*.c"))
    include = ("-isystem", str(headers()))
    return [
        *_caller(target, compiler),
        *WARNINGS,
        *FLAGS,
        *include,
        "-o",
        str(library),
        *files,
        *TARGETS[target].linker,
    ]


def compiled(folder: Path, target: str, compiler: Compiler) -> bytes:
    """Return the library of all C files in a folder for one target; files met before are not compiled again."""
    sources = {path.name: path.read_bytes() for path in folder.iterdir() if path.suffix in (".c", ".h")}
    headers_of_all = tuple(sorted((name, data) for name, data in sources.items() if name.endswith(".h")))
    options = [flag for flag in FLAGS if flag not in _OF_LINKER]
    one = (*_caller(target, compiler), *WARNINGS, *options)
    with tempfile.TemporaryDirectory() as scratch:
        for name, data in sources.items():
            if name.endswith(".c"):
                made = _object(name, data, headers_of_all, one, compiler)
                Path(scratch, f"{name.removesuffix('.c')}.o").write_bytes(made)
        library = Path(scratch, f"library{TARGETS[target].suffix}")  # zig also writes an import library
        files = sorted(path.name for path in Path(scratch).glob("*.o"))
        call = [*_caller(target, compiler), *FLAGS, "-o", str(library), *files, *TARGETS[target].linker]
        subprocess.run(call, cwd=scratch, check=True)
        return library.read_bytes()


@lru_cache(maxsize=512)
def _object(
    name: str, source: bytes, included: tuple[tuple[str, bytes], ...], call: tuple[str, ...], compiler: Compiler
) -> bytes:
    """Return one C file compiled, by an earlier run or now; `call`: the compiler's call without the file."""
    key = ("object", name, source, included, call, _version(compiler))
    return keeping.kept(key, lambda: _compiled_now(name, source, included, call))


@lru_cache(maxsize=3)
def _version(compiler: Compiler) -> str:
    call = [*_caller("x86_64-linux", compiler), "--version"]
    return subprocess.run(call, capture_output=True, text=True, check=True).stdout


def _compiled_now(name: str, source: bytes, included: tuple[tuple[str, bytes], ...], call: tuple[str, ...]) -> bytes:
    with tempfile.TemporaryDirectory() as scratch:
        for file, data in (*included, (name, source)):
            Path(scratch, file).write_bytes(data)
        subprocess.run([*call, "-isystem", str(headers()), "-c", name, "-o", "one.o"], cwd=scratch, check=True)
        return Path(scratch, "one.o").read_bytes()


_OF_LINKER = ("-s", "-shared")


def _caller(target: str, compiler: Compiler) -> list[str]:
    if compiler == "zig":
        return [sys.executable, "-m", "ziglang", "cc", "-target", TARGETS[target].triple]
    return [compiler, *_OF_GCC_ALONE]


_FAT, _PAGE = 0xCAFEBABE, 14  # magic number, logarithm of the alignment


def universal(parts: Iterable[bytes]) -> bytes:
    """Join libraries of macOS for several processors into one (Apple, mach-o/fat.h): header, then aligned parts."""
    parts = list(parts)
    page = 1 << _PAGE
    header, body = struct.pack(">II", _FAT, len(parts)), b""
    for part in parts:
        processor, kind = struct.unpack_from("<II", part, 4)
        header += struct.pack(">IIIII", processor, kind, page + len(body), len(part), _PAGE)
        body += part + bytes(-len(part) % page)
    return header + bytes(page - len(header)) + body
