"""Rules on the binaries of an FMU."""

import re
from pathlib import PurePosixPath

from fmpy.fmi3 import FMU3Slave

from fmu_src.isolated.library import image

from ..fmu.errors import FmuError
from .package import Package
from .verdict import Answer, failed, not_applicable, noted, passed, some

# FMI 2.0.4, section 2.1 and 4.2: functions that a library exports
# fmt: off
_CO_SIMULATION = [
    "GetTypesPlatform", "GetVersion", "SetDebugLogging", "Instantiate", "FreeInstance", "SetupExperiment",
    "EnterInitializationMode", "ExitInitializationMode", "Terminate", "Reset", "GetReal", "GetInteger",
    "GetBoolean", "GetString", "SetReal", "SetInteger", "SetBoolean", "SetString", "DoStep", "CancelStep",
    "GetStatus", "GetRealStatus", "GetIntegerStatus", "GetBooleanStatus", "GetStringStatus",
]
# fmt: on
_STATE = ["GetFMUstate", "SetFMUstate", "FreeFMUstate"]
_BYTES = ["SerializedFMUstateSize", "SerializeFMUstate", "DeSerializeFMUstate"]

# FMI 3.0.1 wants all functions of fmi3Functions.h, also those of interfaces that the FMU does not have
_FMI3 = sorted(name for name in dir(FMU3Slave) if name.startswith("fmi3"))

# FMI 3's names of the platforms in the folders of FMI 2, which name no processor
_FOLDERS = {
    "linux64": {"x86_64-linux", "aarch64-linux"},
    "win64": {"x86_64-windows", "aarch64-windows"},
    "win32": {"x86-windows"},
}

# supplied by every ordinary Linux or Windows
_LINUX = re.compile(r"(lib(c|m|dl|pthread|rt|gcc_s|stdc\+\+)|ld-linux.*)\.so\.\d+$")
_WINDOWS = re.compile(
    r"(api-ms-win-.*|kernel32|user32|advapi32|shell32|ole32|oleaut32|ntdll|ws2_32|bcrypt(primitives)?|shlwapi|gdi32|"
    r"version|secur32|userenv|psapi|dbghelp|winmm|iphlpapi|rpcrt4|synchronization|msvcrt|ucrtbase|msvcp\d+\w*|"
    r"vcruntime\d+\w*)\.dll$",
    re.IGNORECASE,
)
_PYTHON_LIBRARY = re.compile(r"(lib)?python\d.*", re.IGNORECASE)


def platforms(package: Package) -> Answer:
    """Check that every platform that has a folder has a whole binary of the right name and kind."""
    folders = {name.split("/")[1] for name in package.names if re.match(r"binaries/[^/]+/.*\.(so|dll|dylib)$", name)}
    found = package.binaries
    unnamed = sorted(folders - set(found))
    if unnamed:
        wanted = " or ".join(sorted(package.identifiers))
        return failed(f"binaries/{unnamed[0]} holds no library called {wanted}, which is its modelIdentifier.")
    if not found and not package.sources:
        return failed("There is neither a binary nor source code: no host can run it.")
    if wrong := _unfit(package):
        return failed(wrong)
    text = f"Binaries for {', '.join(sorted(found)) or 'no platform'}" + (", and sources." if package.sources else ".")
    return passed(text) if package.platform in found else noted(f"{text} None for this machine, {package.platform}.")


def _unfit(package: Package) -> str:
    """Return a sentence on the first binary that is damaged or not for the platform of its folder."""
    for folder, name in sorted(package.binaries.items()):
        allowed = _FOLDERS.get(folder, {folder})
        try:
            data = package.archive.read(name)
            found = image.platform(data)
            if allowed <= image.PLATFORMS and found not in allowed:
                return f"{name} is a library for {found or 'no platform known here'}, not for {folder}."
            image.read(data)
        except image.DamagedError as error:
            return f"{name} cannot be loaded: {error}, perhaps cut short."
        except (image.ImageError, FmuError):
            continue  # of a kind that is not read here, or a matter of the archive
    return ""


def functions(package: Package) -> Answer:
    """Check that the binaries export the functions of their version of FMI."""
    description = package.description
    if description is None or description.coSimulation is None or not package.runs:
        return not_applicable("The lists are those of co-simulation of FMI 2.0 and 3.0.")
    able = description.coSimulation
    wanted = [*_CO_SIMULATION, *_STATE * able.canGetAndSetFMUstate, *_BYTES * able.canSerializeFMUstate]
    wanted = [f"fmi2{name}" for name in wanted] if package.version == "2.0" else _FMI3
    libraries, unread = _libraries(package)
    for platform, library in libraries.items():
        missing = [name for name in wanted if name not in library.exports]
        if missing:
            return failed(f"The binary for {platform} does not export {some(missing)}.")
    if not libraries:
        return not_applicable(f"No binary could be read. {unread}".rstrip())
    return passed(f"{len(wanted)} functions in the binaries for {', '.join(libraries)}. {unread}".rstrip())


def host_needs(package: Package) -> Answer:
    """Check what a plain host must supply before it can load the binaries."""
    libraries, unread = _libraries(package)
    if not libraries:
        return not_applicable(f"No binary could be read. {unread}".rstrip())
    wrong: list[str] = []
    worth: list[str] = []
    undeclared = "" if package.needs_tool else ", which needsExecutionTool must declare"
    for platform, library in libraries.items():
        beside = {PurePosixPath(name).name for name in package.names if name.startswith(f"binaries/{platform}/")}
        python, foreign, lost = _beyond_the_system(library, beside)
        if lost:
            wrong.append(f"{platform}: no library that it names supplies {some(lost)}")
        if python:
            said = f"{platform}: only a host with Python can load it ({some(python, 2)}){undeclared}"
            (wrong if undeclared else worth).append(said)
        if foreign:
            worth.append(f"{platform}: the host must have {some(foreign)}")
    least = [f"{platform}: glibc {library.glibc} or later" for platform, library in libraries.items() if library.glibc]
    evidence = "; ".join([*wrong, *worth, *least]) or f"{', '.join(libraries)}: nothing beyond the operating system"
    answer = failed if wrong else noted if worth else passed
    return answer(f"{evidence}. {unread}".rstrip())


def _beyond_the_system(library: image.Image, beside: set[str]) -> tuple[list[str], list[str], list[str]]:
    """Return needs of Python, libraries that neither system nor FMU has, and symbols that no library supplies."""
    foreign = [name for name in library.libraries if not (_LINUX.match(name) or _WINDOWS.match(name) or name in beside)]
    python = [name for name in library.unbound if name.lstrip("_").startswith("Py")]
    python += [name for name in foreign if _PYTHON_LIBRARY.match(name)]
    foreign = [name for name in foreign if name not in python]
    # the system's libraries put versions on all their symbols, others need not
    unversioned = any(not _LINUX.match(name) for name in library.libraries)
    return python, foreign, [] if unversioned else [name for name in library.unbound if name not in python]


def _libraries(package: Package) -> tuple[dict[str, image.Image], str]:
    """Return the binaries by platform, and a sentence about those that were not read."""
    libraries, unread = {}, []
    for platform, name in sorted(package.binaries.items()):
        try:
            libraries[platform] = image.read(package.archive.read(name))
        except (image.ImageError, FmuError) as error:
            unread.append(f"{platform} was not examined: {error}.")
    return libraries, " ".join(unread)
