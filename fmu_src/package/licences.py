"""Requirements of an FMU and their licences, from the metadata of the installed packages."""

from importlib.metadata import PackageNotFoundError, distribution

from contact_core import __version__

from ..flavours import Flavour, Version
from ..runtime.resources import VERSIONS

PACKAGE = "tribofmu"
_HEADERS: dict[Version, str] = {  # of those that a library is compiled with; all of a version have the same licence
    2: "fmi2TypesPlatform.h",
    3: "fmi3PlatformTypes.h",
}


def licences(flavour: Flavour, fmi: Version = 2) -> dict[str, bytes]:
    """Return name and text of the licences of the FMU and of third-party parts of its library.

    Raises FileNotFoundError if a package is not installed with its licence.
    """
    if flavour == "embedded":
        return {"license.txt": _file(PACKAGE, "LICENSE"), "pythonfmu.txt": _file("pythonfmu", "LICENSE")}
    comment = _file("fmpy", _HEADERS[fmi]).partition(b"/*")[2].partition(b"*/")[0]
    return {"license.txt": _file(PACKAGE, "LICENSE"), "fmi.txt": comment.strip() + b"\n"}


def _file(package: str, name: str) -> bytes:
    """Return the content of the file `name` of an installed package."""
    try:
        files = distribution(package).files or []
    except PackageNotFoundError:
        files = []
    found = [file for file in files if file.name == name]
    if not found:
        raise FileNotFoundError(f"{package} is not installed with its {name}. Install it with pip.")
    return found[0].read_binary()


def owner() -> dict[str, str]:
    """Return the attributes of a model description that say whose the code in the FMU is, and who may use it."""
    metadata = distribution(PACKAGE).metadata
    lines = _file(PACKAGE, "LICENSE").decode().splitlines()
    return {
        "author": metadata["Author"],
        "copyright": next(line for line in lines if line.startswith("Copyright")),
        "license": metadata["License-Expression"],
    }


def python() -> str:
    """Return the supported versions of Python."""
    return distribution(PACKAGE).metadata["Requires-Python"]


def dependencies() -> list[str]:
    """Return the requirements that pip installs with the package."""
    return [name for name in distribution(PACKAGE).requires or [] if "extra ==" not in name]


def exact() -> dict[str, str]:
    """Return the packages that the FMU needs in exactly one version."""
    return {PACKAGE: __version__, "pythonfmu": VERSIONS["pythonfmu"]}


VARIABLES: dict[Flavour, dict[str, str]] = {
    "isolated": {
        "TRIBOFMU_PYTHON": "path of the Python that has the packages; default: the one recorded at build time, "
        "if any, then python3 on PATH",
        "TRIBOFMU_TIMEOUT": "time limit of a call in seconds; a longer call ends with an error; default: no limit",
        "TRIBOFMU_START_TIMEOUT": "time limit of a start in seconds; default: 120, or TRIBOFMU_TIMEOUT if that is more",
        "NUMBA_CACHE_DIR": "folder for compiled kernels; default: the packages' own, the user's cache or a private one",
    },
    "embedded": {
        "LD_PRELOAD": "Linux, host without Python: path of libpython3.x.so",
        "PYTHONPATH": "host without Python: folder of the packages",
    },
    "native": {},
}


def external_dependencies(flavour: Flavour) -> bytes:
    """Return documentation/externalDependencies.txt."""
    if flavour == "native":
        return b"This FMU needs nothing that is not part of it but the C library of its platform.\n"
    lines = [
        "Requirements of this FMU that are not part of it.",
        "",
        f"Python {python()}"
        + (", in the process of the host" if flavour == "embedded" else ", in a process of its own"),
        "Packages in exactly these versions:",
        *(f"    {name} {version}" for name, version in exact().items()),
        "and the packages that pip installs with them:",
        *(f"    {name}" for name in dependencies()),
        "Environment variables:",
        *(f"    {name}: {text}" for name, text in VARIABLES[flavour].items()),
        "",
    ]
    return "\n".join(lines).encode()
