"""Build the library of isolated FMUs: python -m fmu_src.isolated.library.build [--platform ...].

The committed ones are built by zig: equal sources and versions give equal bytes. gcc serves to try a change on Linux.
"""

import argparse
import hashlib
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from shutil import copyfile, which

from . import image

FOLDER = Path(__file__).parent
MADE_FROM = "made_from.txt"
COMPILERS = {"zig": ("linux64", "win64"), "gcc": ("linux64",)}


@dataclass(frozen=True)
class Platform:
    """Settings of a platform."""

    target: str  # zig's name
    flags: tuple[str, ...]
    sources: tuple[str, ...]
    library: str


PLATFORMS = {
    "linux64": Platform(
        "x86_64-linux-gnu.2.17",  # any glibc since 2012
        ("-D_GNU_SOURCE", "-pthread"),
        (
            "fmi2.c",
            "fmi3.c",
            "fmi3_unsupported.c",
            "instance.c",
            "state.c",
            "resources.c",
            "python_linux.c",
            "channel_linux.c",
        ),
        "tribofmu.so",
    ),
    "win64": Platform(
        "x86_64-windows-gnu",
        (),
        (
            "fmi2.c",
            "fmi3.c",
            "fmi3_unsupported.c",
            "instance.c",
            "state.c",
            "resources.c",
            "python_windows.c",
            "channel_windows.c",
        ),
        "tribofmu.dll",
    ),
}
FLAGS = (
    *("-std=gnu11", "-O2", "-g0", "-s", "-shared", "-fPIC", "-fvisibility=hidden"),
    *("-Wall", "-Wextra", "-Wshadow", "-Werror"),
)


def command(platform: str, compiler: str, library: Path) -> list[str]:
    """Return the call of `compiler`, in the folder of the sources, that builds the library of `platform`."""
    chosen = PLATFORMS[platform]
    call = [sys.executable, "-m", "ziglang", "cc", "-target", chosen.target] if compiler == "zig" else ["gcc"]
    return [*call, *FLAGS, *chosen.flags, "-isystem", str(headers()), "-o", str(library), *chosen.sources]


def fingerprint(platform: str) -> str:
    """Return the digest of everything that the library of `platform` is built from; it is stored beside the library."""
    chosen = PLATFORMS[platform]
    files = [*chosen.sources, *sorted(path.name for path in FOLDER.glob("*.h"))]
    parts = [repr((chosen, FLAGS)).encode(), *(FOLDER.joinpath(name).read_bytes() for name in files)]
    return hashlib.sha256(b"\0".join(parts)).hexdigest()


def headers() -> Path:
    """Return the folder of FMI's headers, in the wheel of fmpy."""
    spec = find_spec("fmpy")
    if spec is None or spec.origin is None:
        raise FileNotFoundError("fmpy, whose wheel has FMI's headers, is not installed. Install fmpy.")
    return Path(spec.origin).parent / "c-code"


def build(platform: str, compiler: str, out: Path) -> Path:
    """Build the library of `platform` into the folder `out` and return its path.

    Raises FileNotFoundError without the compiler, CalledProcessError if compilation fails.
    """
    with tempfile.TemporaryDirectory() as scratch:
        library = Path(scratch, PLATFORMS[platform].library)  # zig also writes an import library
        subprocess.run(command(platform, compiler, library), cwd=FOLDER, check=True)
        out.mkdir(parents=True, exist_ok=True)
        return Path(copyfile(library, out / library.name))


def available(compiler: str) -> bool:
    """Return True if `compiler` is installed."""
    return (find_spec("ziglang") if compiler == "zig" else which("gcc")) is not None


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line."""
    parser = argparse.ArgumentParser(
        prog="python -m fmu_src.isolated.library.build", description="Build the library of isolated FMUs."
    )
    parser.add_argument("--platform", choices=PLATFORMS, nargs="+", help="default: all that the compiler supports")
    parser.add_argument("--compiler", choices=COMPILERS, default="zig", help="default: %(default)s")
    parser.add_argument("--out", type=Path, default=FOLDER / "binaries", help="folder (default: in the package)")
    arguments = parser.parse_args(argv)
    known = COMPILERS[arguments.compiler]
    platforms = arguments.platform or known
    if not set(platforms) <= set(known):
        parser.error(f"{arguments.compiler} builds {' and '.join(known)} only")
    if not available(arguments.compiler):
        parser.error(f"{arguments.compiler} is not installed (zig: pip install ziglang)")
    for platform in platforms:
        library = build(platform, arguments.compiler, arguments.out / platform)
        library.with_name(MADE_FROM).write_text(fingerprint(platform) + "\n")
        found = image.read(library.read_bytes())
        print(f"{library}: {library.stat().st_size} bytes")
        print(f"  needs   {', '.join(found.libraries)}")
        print(f"  imports {', '.join(found.imports)}")
        print(f"  exports {', '.join(found.exports)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
