"""What the FMU needs from outside and under which licences, from the metadata of the installed packages."""

from importlib.metadata import PackageNotFoundError, distribution

from contact_core import __version__

from .flavours import Flavour
from .resources import VERSIONS

PACKAGE = "tribofmu"
_HEADER = "fmi2TypesPlatform.h"  # one of those that our library is compiled with; all have the same licence


def licences(flavour: Flavour) -> dict[str, bytes]:
    """Name and text of the licence of the FMU and of what others made of the library in it.

    Raises FileNotFoundError if a package is not installed with its licence.
    """
    if flavour == "embedded":
        return {"license.txt": _file(PACKAGE, "LICENSE"), "pythonfmu.txt": _file("pythonfmu", "LICENSE")}
    comment = _file("fmpy", _HEADER).partition(b"/*")[2].partition(b"*/")[0]
    return {"license.txt": _file(PACKAGE, "LICENSE"), "fmi.txt": comment.strip() + b"\n"}


def _file(package: str, name: str) -> bytes:
    """The content of the file `name` that pip has installed for a package."""
    try:
        files = distribution(package).files or []
    except PackageNotFoundError:
        files = []
    found = [file for file in files if file.name == name]
    if not found:
        raise FileNotFoundError(f"{package} is not installed with its {name}. Install it with pip.")
    return found[0].read_binary()


def python() -> str:
    """Versions of Python that will do."""
    return distribution(PACKAGE).metadata["Requires-Python"]


def dependencies() -> list[str]:
    """What pip installs beside the package, as it asks for it."""
    return [name for name in distribution(PACKAGE).requires or [] if "extra ==" not in name]


def exact() -> dict[str, str]:
    """Packages of which the FMU takes no other version."""
    return {PACKAGE: __version__, "pythonfmu": VERSIONS["pythonfmu"]}


VARIABLES: dict[Flavour, dict[str, str]] = {
    "isolated": {
        "TRIBOFMU_PYTHON": "path of the Python that has the packages; without it the one recorded when the FMU was "
        "built, if any, then python3 on PATH",
        "TRIBOFMU_TIMEOUT": "longest time of a call in seconds, after which it ends with an error; without it, none",
        "TRIBOFMU_START_TIMEOUT": "longest time of a start in seconds; without it, 120 or TRIBOFMU_TIMEOUT, if more",
        "NUMBA_CACHE_DIR": "folder for compiled kernels; without it the packages', the user's cache or a private one",
    },
    "embedded": {
        "LD_PRELOAD": "Linux, host without Python: path of libpython3.x.so",
        "PYTHONPATH": "host without Python: where the packages lie",
    },
}


def external_dependencies(flavour: Flavour) -> bytes:
    """documentation/externalDependencies.txt."""
    lines = [
        "What this FMU needs that does not lie in it.",
        "",
        f"Python {python()}"
        + (", in the process of the host" if flavour == "embedded" else ", in a process of its own"),
        "Packages in exactly these versions:",
        *(f"    {name} {version}" for name, version in exact().items()),
        "and what pip installs with them:",
        *(f"    {name}" for name in dependencies()),
        "Environment variables:",
        *(f"    {name}: {text}" for name, text in VARIABLES[flavour].items()),
        "",
    ]
    return "\n".join(lines).encode()
