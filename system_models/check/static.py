"""Rules that need the file only: archive, model description, binaries, what lies beside them."""

import math
import re
import zipfile
import zlib
from collections import Counter
from collections.abc import Callable
from functools import wraps
from pathlib import Path, PurePosixPath

import fmpy
from fmpy.model_description import BaseUnit, DisplayUnit, ModelDescription, ModelVariable
from fmpy.validation import validate_fmu
from lxml import etree

from contact_core.errors import SceneError
from contact_core.scene import units
from fmu_src.isolated.native import image

from .package import DESCRIPTION, Package
from .variables import attribute, base_type, is_real
from .verdict import Answer, failed, not_applicable, noted, passed, some

Rule = Callable[[Package], Answer]

_SCHEMATA = {
    "1": "fmi1/fmiModelDescription.xsd",
    "2": "fmi2/fmi2ModelDescription.xsd",
    "3": "fmi3/fmi3ModelDescription.xsd",
}

# FMI 2.0.4, section 2.1 and 4.2: what a library exports
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

# FMI 3's names of what the folders of FMI 2 may hold: they name no processor
_FOLDERS = {
    "linux64": {"x86_64-linux", "aarch64-linux"},
    "win64": {"x86_64-windows", "aarch64-windows"},
    "win32": {"x86-windows"},
}

_ROUNDED = 1e-5  # relative difference of a conversion for display that was written with few digits

# supplied by every ordinary Linux or Windows
_LINUX = re.compile(r"(lib(c|m|dl|pthread|rt|gcc_s|stdc\+\+)|ld-linux.*)\.so\.\d+$")
_WINDOWS = re.compile(
    r"(api-ms-win-.*|kernel32|user32|advapi32|shell32|ole32|oleaut32|ntdll|ws2_32|bcrypt(primitives)?|shlwapi|gdi32|"
    r"version|secur32|userenv|psapi|dbghelp|winmm|iphlpapi|rpcrt4|synchronization|msvcrt|ucrtbase|msvcp\d+\w*|"
    r"vcruntime\d+\w*)\.dll$",
    re.IGNORECASE,
)
_PYTHON_LIBRARY = re.compile(r"(lib)?python\d.*", re.IGNORECASE)


def _described(rule: Callable[[ModelDescription], Answer]) -> Rule:
    """A rule about the description, where fmpy could interpret it."""

    @wraps(rule)
    def answer(package: Package) -> Answer:
        if package.description is None:
            return not_applicable(f"{DESCRIPTION} cannot be interpreted.")
        return rule(package.description)

    return answer


# the archive and its description


def archive(package: Package) -> Answer:
    """Every file whole, no path that leaves the folder, no file twice."""
    try:
        damaged = package.archive.testzip()
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, OSError) as error:
        return failed(f"The archive cannot be read to its end: {error}.")
    if damaged:
        return failed(f"'{damaged}' is damaged: its checksum is wrong.")
    astray = [info.orig_filename for info in package.archive.infolist() if _leaves(info.orig_filename)]
    if astray:
        return failed(f"'{some(astray)}' must be relative, without '..', and with '/' between folders.")
    twice = [name for name, count in Counter(package.names).items() if count > 1]
    if twice:
        return failed(f"In the archive more than once: {some(twice)}.")
    return passed(f"{len(package.names)} files, all whole, all within the folder.")


def _leaves(name: str) -> bool:
    return "\\" in name or name.startswith("/") or ":" in name.split("/")[0] or ".." in PurePosixPath(name).parts


def schema(package: Package) -> Answer:
    """Valid against the XSD of its FMI version."""
    file = _SCHEMATA.get(package.version[:1])
    if file is None:
        return failed(f"fmiVersion = '{package.version}' is none of 1.0, 2.0, 3.0.")
    xsd = etree.XMLSchema(file=str(Path(fmpy.__file__).parent / "schema" / file))
    if xsd.validate(package.root):
        return passed(f"{DESCRIPTION} is valid FMI {package.version}.")
    first = xsd.error_log[0]
    return failed(f"Line {first.line} of {DESCRIPTION}: {first.message}")


def validation(package: Package) -> Answer:
    """Nothing that the validation of fmpy finds."""
    problems = validate_fmu(str(package.path))
    if problems:
        return failed(f"{len(problems)} problem(s), the first: {' '.join(problems[0].split())}")
    return passed("fmpy.validation.validate_fmu finds no problem.")


# variables


@_described
def unit_of_reals(description: ModelDescription) -> Answer:
    """Every Real has a unit, and the unit a base unit."""
    reals = _reals(description)
    bare = [v.name for v in reals if attribute(v, "unit") is None]
    if bare:
        return failed(f"Without a unit: {some(bare)}; a number without dimension has the unit '1'.")
    defined = {unit.name: unit for unit in description.unitDefinitions}
    unknown = [f"'{attribute(v, 'unit')}' of {v.name}" for v in reals if attribute(v, "unit") not in defined]
    if unknown:
        return failed(f"Not in UnitDefinitions: the unit {some(unknown)}.")
    empty = sorted({u for v in reals if defined[u := str(attribute(v, "unit"))].baseUnit is None})
    if empty:
        return failed(f"Without a BaseUnit: the unit {some(empty)}, which so cannot be converted or compared.")
    return passed(f"{len(reals)} Reals with {len({attribute(v, 'unit') for v in reals})} units.")


@_described
def unit_audit(description: ModelDescription) -> Answer:
    """A unit with the name of an SI unit is that unit, and one for display is converted to what it is called."""
    known = count = 0
    without_rad = []
    for unit in description.unitDefinitions:
        count += 1 + len(unit.displayUnits)
        base, expected = unit.baseUnit, _si(unit.name)
        if base is None or base.mol:  # our mol is a number
            continue
        if expected is not None:
            known += 1
            right = math.isclose(base.factor, expected.factor, rel_tol=1e-9) and base.offset == expected.offset
            if not right or _dimension(base) != _dimension(expected):
                declared = f"The unit '{unit.name}' is declared as {_base(base)}"
                return failed(f"{declared}; by its name it is {_base(expected)}.")
            if expected.rad and not base.rad:
                without_rad.append(f"'{unit.name}'")
        for shown in unit.displayUnits:
            meant = _si(shown.name)
            if meant is None or meant.rad != (expected or base).rad:  # 1/min may count turns
                continue
            known += 1
            if wrong := _misconverted(base, shown, meant):
                return failed(f"The display unit '{shown.name}' of '{unit.name}' {wrong}.")
    if without_rad:
        return noted(
            f"The BaseUnit of {some(without_rad)} lacks rad. Hosts that compare exponents, such as OMSimulator, refuse "
            "to connect it with a unit that has it."
        )
    return passed(f"{known} of {count} unit names are known here, and mean what they say.")


def _misconverted(base: BaseUnit, shown: DisplayUnit, meant: BaseUnit) -> str:
    """What is wrong with display = factor * value + offset, where the display's unit is `meant`."""
    if _dimension(base) != _dimension(meant):
        return f"is by its name {_base(meant)}, and cannot show {_base(base)}"
    factor, offset = base.factor / meant.factor, (base.offset - meant.offset) / meant.factor
    if math.isclose(shown.factor, factor, rel_tol=_ROUNDED) and math.isclose(shown.offset, offset, rel_tol=_ROUNDED):
        return ""
    return (
        f"has factor={shown.factor:g} offset={shown.offset:g}; by its name it has factor={factor:g} offset={offset:g}"
    )


def _si(name: str | None) -> BaseUnit | None:
    """What a unit is by its name, if that is known here."""
    if name in ("degC", "°C"):
        return BaseUnit(K=1, offset=273.15)
    try:
        factor, (m, kg, s, kelvin, rad) = units.unit(name or "?")
    except (SceneError, OverflowError):
        return None
    return BaseUnit(m=m, kg=kg, s=s, K=kelvin, rad=rad, factor=factor) if 0.0 < factor < math.inf else None


def _dimension(base: BaseUnit) -> tuple[int, ...]:
    """Exponents of the base units but rad, which is a number."""
    return base.kg, base.m, base.s, base.A, base.K, base.cd


def _base(base: BaseUnit) -> str:
    exponents = ((axis, getattr(base, axis)) for axis in ("kg", "m", "s", "A", "K", "mol", "cd", "rad"))
    text = " ".join(f"{axis}={n}" for axis, n in exponents if n) or "a plain number"
    factor = f" factor={base.factor:g}" if base.factor != 1.0 else ""
    return text + factor + (f" offset={base.offset:g}" if base.offset else "")


@_described
def nominals(description: ModelDescription) -> Answer:
    """Every Real has a nominal, finite and above zero."""
    reals = _reals(description)
    bare = [v.name for v in reals if attribute(v, "nominal") is None]
    if bare:
        return failed(f"Without a nominal: {some(bare)}; hosts then take 1, and tolerances miss small quantities.")
    odd = [f"{v.name} = {text}" for v in reals if not _is_positive(text := str(attribute(v, "nominal")))]
    if odd:
        return failed(f"The nominal {some(odd)} must be finite and above zero.")
    return passed(f"{len(reals)} Reals with their magnitudes.")


def _is_positive(text: str) -> bool:
    return 0.0 < float(text) < math.inf


def _reals(description: ModelDescription) -> list[ModelVariable]:
    """All Reals but time, which is in seconds by FMI."""
    return [v for v in description.modelVariables if is_real(v) and v.causality != "independent"]


@_described
def starts(description: ModelDescription) -> Answer:
    """Start values where FMI wants them, within min and max."""
    variables = [v for v in description.modelVariables if v.type != "Clock"]
    missing = [v.name for v in variables if v.start is None and (v.causality == "input" or v.initial in _STARTED)]
    if missing:
        return failed(f"Without a start value: {some(missing)}; inputs and what is initially exact or approx need one.")
    numbers = [v for v in variables if is_real(v) or "Int" in v.type]
    for v in numbers:
        low, high = _range(v)
        values = [float(word) for word in (v.start or "").split()]
        if low > high:
            return failed(f"{v.name} has min = {low:g} above max = {high:g}.")
        if not all(low <= value <= high for value in values):
            return failed(f"{v.name} starts at {v.start}, which is not within its range {low:g} to {high:g}.")
    return passed(f"{sum(v.start is not None for v in variables)} start values, all within their ranges.")


_STARTED = ("exact", "approx")


def _range(variable: ModelVariable) -> tuple[float, float]:
    low, high = attribute(variable, "min"), attribute(variable, "max")
    return -math.inf if low is None else float(low), math.inf if high is None else float(high)


@_described
def aliases(description: ModelDescription) -> Answer:
    """Variables of one value reference have one unit, and at most one of them can be set."""
    groups: dict[tuple[str, int], list[ModelVariable]] = {}
    for v in description.modelVariables:
        if v.alias is None:
            groups.setdefault((base_type(v), v.valueReference), []).append(v)
    shared = [group for group in groups.values() if len(group) > 1]
    for group in shared:
        if len({attribute(v, "unit") for v in group}) > 1:
            different = [f"{v.name} in {attribute(v, 'unit') or 'no unit'}" for v in group]
            return failed(f"With one valueReference, {group[0].valueReference}, but not one unit: {some(different)}.")
        settable = [v.name for v in group if v.causality in ("input", "parameter")]
        if len(settable) > 1:
            return failed(f"With one valueReference, {group[0].valueReference}, but each to be set: {some(settable)}.")
    return passed(f"{len(groups)} values, {len(shared)} of them with several names.")


# structure


@_described
def outputs(description: ModelDescription) -> Answer:
    """ModelStructure/Outputs lists every output once, and nothing else."""
    listed = Counter(u.variable.name for u in description.outputs)
    expected = {v.name for v in description.modelVariables if v.causality == "output" and v.alias is None}
    missing = sorted(expected - set(listed))
    if missing:
        return failed(f"Not in ModelStructure/Outputs: {some(missing)}.")
    foreign = sorted(set(listed) - expected)
    if foreign:
        return failed(f"In ModelStructure/Outputs, but no output: {some(foreign)}.")
    twice = [name for name, count in listed.items() if count > 1]
    if twice:
        return failed(f"In ModelStructure/Outputs more than once: {some(twice)}.")
    return passed(f"{len(expected)} outputs, each listed once.")


@_described
def dependencies(description: ModelDescription) -> Answer:
    """Every output says what it depends on."""
    silent = [u.variable.name for u in description.outputs if u.dependencies is None]
    if silent:
        return failed(f"Without dependencies: {some(silent)}; a host must suppose that every input counts.")
    inputs = sum(any(v.causality == "input" for v in u.dependencies) for u in description.outputs)
    return passed(f"{inputs} of {len(description.outputs)} outputs depend directly on inputs.")


@_described
def initial_unknowns(description: ModelDescription) -> Answer:
    """Every calculated output is in InitialUnknowns."""
    listed = {u.variable.name for u in description.initialUnknowns}
    calculated = [
        v.name
        for v in description.modelVariables
        if v.causality == "output" and v.initial in ("calculated", "approx") and v.alias is None and not v.clocks
    ]
    missing = [name for name in calculated if name not in listed]
    if missing:
        return failed(f"Calculated, but not in ModelStructure/InitialUnknowns: {some(missing)}.")
    return passed(f"{len(calculated)} calculated outputs, all in InitialUnknowns.")


@_described
def experiment(description: ModelDescription) -> Answer:
    """A default experiment that goes forward in time."""
    default = description.defaultExperiment
    if default is None:
        return noted("There is no DefaultExperiment: a host must know the step that suits.")
    start = float(default.startTime or 0.0)
    if default.stopTime is not None and not float(default.stopTime) > start:
        return failed(f"stopTime = {default.stopTime} must be above startTime = {start:g}.")
    for name in ("stepSize", "tolerance"):
        value = getattr(default, name)
        if value is not None and not _is_positive(value):
            return failed(f"{name} = {value} must be finite and above zero.")
    return passed(f"From {start:g} s to {default.stopTime or '?'} s in steps of {default.stepSize or '?'} s.")


@_described
def capabilities(description: ModelDescription) -> Answer:
    """What the FMU can do for a master that iterates or goes back."""
    slave = description.coSimulation
    if slave is None:
        return not_applicable("There is no interface for co-simulation.")
    lacks = [
        text
        for has, text in (
            (slave.canGetAndSetFMUstate, "it cannot be set back (canGetAndSetFMUstate)"),
            (slave.canSerializeFMUstate, "its state cannot be stored (canSerializeFMUstate)"),
            (slave.canHandleVariableCommunicationStepSize, "its step must be constant"),
            (not slave.needsExecutionTool, "needsExecutionTool is true, so some hosts refuse it"),
            (not slave.canBeInstantiatedOnlyOncePerProcess, "only one instance fits in a process"),
        )
        if not has
    ]
    if lacks:
        return noted(f"Declared: {'; '.join(lacks)}.")
    return passed("State can be kept and stored, steps can vary, many instances fit, no other tool is needed.")


# binaries


def platforms(package: Package) -> Answer:
    """A whole binary of the right name and kind for every platform that has a folder."""
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
    """What is wrong with the first binary that is damaged, or that is for a platform other than its folder's."""
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
        except (image.ImageError, zipfile.BadZipFile, zlib.error):
            continue  # of a kind that is not read here, or a matter of the archive
    return ""


def functions(package: Package) -> Answer:
    """The binaries export what FMI 2.0 co-simulation calls."""
    description = package.description
    if description is None or description.coSimulation is None or package.version != "2.0":
        return not_applicable("The list is that of FMI 2.0 co-simulation.")
    slave = description.coSimulation
    wanted = [*_CO_SIMULATION, *_STATE * slave.canGetAndSetFMUstate, *_BYTES * slave.canSerializeFMUstate]
    libraries, unread = _libraries(package)
    for platform, library in libraries.items():
        missing = [f"fmi2{name}" for name in wanted if f"fmi2{name}" not in library.exports]
        if missing:
            return failed(f"The binary for {platform} does not export {some(missing)}.")
    if not libraries:
        return not_applicable(f"No binary could be read. {unread}".rstrip())
    return passed(f"{len(wanted)} functions in the binaries for {', '.join(libraries)}. {unread}".rstrip())


def host_needs(package: Package) -> Answer:
    """What a plain host must supply before it can load the binaries."""
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
    """What of Python it needs, which libraries that neither the system nor the FMU has, and which symbols of none."""
    foreign = [name for name in library.libraries if not (_LINUX.match(name) or _WINDOWS.match(name) or name in beside)]
    python = [name for name in library.unbound if name.lstrip("_").startswith("Py")]
    python += [name for name in foreign if _PYTHON_LIBRARY.match(name)]
    foreign = [name for name in foreign if name not in python]
    # the system's libraries put versions on all their symbols, others need not
    unversioned = any(not _LINUX.match(name) for name in library.libraries)
    return python, foreign, [] if unversioned else [name for name in library.unbound if name not in python]


def _libraries(package: Package) -> tuple[dict[str, image.Image], str]:
    """The binaries by platform, and a sentence about those that were not read."""
    libraries, unread = {}, []
    for platform, name in sorted(package.binaries.items()):
        try:
            libraries[platform] = image.read(package.archive.read(name))
        except (image.ImageError, zipfile.BadZipFile, zlib.error) as error:
            unread.append(f"{platform} was not examined: {error}.")
    return libraries, " ".join(unread)


# what lies beside


def documentation(package: Package) -> Answer:
    """A page for people."""
    page = "documentation/index.html"
    if page in package.names:
        return passed(f"{page}, {package.archive.getinfo(page).file_size / 1024:.0f} kB.")
    return noted(f"There is no {page}.")


def icon(package: Package) -> Answer:
    """A picture for the host's canvas."""
    places = ("model.png", "terminalsAndIcons/icon.png", "terminalsAndIcons/icon.svg")
    found = [name for name in places if name in package.names]
    return passed(f"{found[0]}.") if found else noted("There is no icon (model.png).")


def licence(package: Package) -> Answer:
    """Who may use it."""
    files = [name for name in package.names if re.match(r"documentation/licenses/.+", name)]
    declared = package.root.get("license") or package.root.get("copyright")
    if files or declared:
        return passed(f"{' and '.join(filter(None, [some(files), declared]))}.")
    return noted("There is neither documentation/licenses/ nor an attribute license: nobody knows who may use it.")


def reference_data(package: Package) -> Answer:
    """Results with which an importer can check itself."""
    found = [name for name in package.names if name.endswith("ref.csv")]
    if found:
        return passed(f"{some(found)}; --deep replays it.")
    return noted("There are no reference results (*ref.csv): an importer cannot check itself.")


RULES: dict[str, Rule] = {
    "archive": archive,
    "schema": schema,
    "fmpy": validation,
    "units": unit_of_reals,
    "unit audit": unit_audit,
    "nominals": nominals,
    "starts": starts,
    "aliases": aliases,
    "outputs": outputs,
    "dependencies": dependencies,
    "initial unknowns": initial_unknowns,
    "experiment": experiment,
    "capabilities": capabilities,
    "platforms": platforms,
    "functions": functions,
    "host needs": host_needs,
    "documentation": documentation,
    "icon": icon,
    "licence": licence,
    "reference data": reference_data,
}
