"""Build an FMU: model description, documentation, resources and binaries in one zip.

pythonfmu's builder writes time and a random guid, runs the model to describe it, and packs a copy of itself.
"""

import io
import zipfile
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path

from contact_core.errors import SceneError
from contact_core.scene import Scene

from ..flavours import VERSIONS, Flavour, Version
from ..native import program
from ..runtime import resources
from ..variables import Variable, variables
from . import compiled, evidence, fmi2, fmi3, licences, terminals
from .describe import Model, described, variables_of
from .document.page import documentation

_LIBRARY = files("fmu_src.isolated") / "library"
_LIBRARIES = (".so", ".dll", ".dylib")
_TUPLES = {"linux64": "x86_64-linux", "win64": "x86_64-windows"}  # FMI 3's names of FMI 2's platforms


def build(
    scene: Scene,
    out: Path,
    flavour: Flavour = "isolated",
    *,
    fmi: Version = 2,
    python: str | None = None,
    reference: bool = False,
    here: bool = False,
) -> Path:
    """Write the FMU of a scene and return its path. Equal arguments and versions give equal bytes.

    Parameters
    ----------
    scene
        The contact.
    out
        Path of the FMU.
    flavour
        "isolated": any host can load the FMU; the model runs in a process of its own. "embedded": the model runs inside
        a host in Python. "native": the model is C, without Python.
    fmi
        Version of FMI: 2 for FMI 2.0, 3 for FMI 3.0.
    python
        Interpreter of an isolated FMU; default: the one that the FMU finds, see `licences.VARIABLES`.
    reference
        Add reference data, for which the contact is solved at five operating points.
    here
        Build a native FMU for this platform only.

    Raises
    ------
    SceneError
        The flavour is not built in this version of FMI, or not for this scene.
    OSError
        The file cannot be written, or the binaries, a compiler or a licence are missing.
    """
    check(flavour, fmi, scene)
    own = {
        **_picture(scene, fmi),
        "documentation/index.html": documentation(scene, flavour, reference, fmi),
        **(evidence.reference(scene) if reference else {}),
        **(compiled.files(scene, fmi, here) if flavour == "native" else _of_slave(scene)),
    }
    return pack(described(scene, flavour, fmi), variables_of(scene, flavour), own, out, flavour, python, fmi)


def check(flavour: Flavour, fmi: Version, scene: Scene | None = None) -> None:
    """Raise SceneError if the flavour is not built in this version of FMI or, where one is given, for this scene."""
    if scene is not None and flavour == "native":
        program.check(scene)
    if fmi in VERSIONS[flavour]:
        return
    own = " or ".join(str(version) for version in VERSIONS[flavour])
    fitting = " or ".join(f"'{known}'" for known, versions in VERSIONS.items() if fmi in versions)
    way_out = f"Build it with fmi = {own}" + (f", or with flavour = {fitting}." if fitting else ".")
    raise SceneError(f"There is no FMU of FMI {fmi}.0 with flavour = '{flavour}'. {way_out}")


def _picture(scene: Scene, fmi: Version) -> dict[str, bytes]:
    """Return name and content of the files that show the FMU in diagrams."""
    icon = Path(__file__).with_name("icon.png").read_bytes()
    if fmi == 2:
        return {"model.png": icon}
    return {
        f"{terminals.FOLDER}/icon.png": icon,
        f"{terminals.FOLDER}/terminalsAndIcons.xml": terminals.terminals(variables(scene)),
    }


def _of_slave(scene: Scene) -> dict[str, bytes]:
    """Return name and content of the files that the slave in Python reads."""
    return {f"resources/{name}": data for name, data in resources.files(scene).items()}


def pack(
    model: Model,
    table: Sequence[Variable],
    own: Mapping[str, bytes],
    out: Path,
    flavour: Flavour,
    python: str | None,
    fmi: Version = 2,
) -> Path:
    """Write an FMU from its `own` files, its description and the files of its flavour."""
    files = {
        **own,
        "modelDescription.xml": _description(model, table, own, flavour, fmi),
        "documentation/externalDependencies.txt": licences.external_dependencies(flavour),
        **{f"documentation/licenses/{name}": text for name, text in licences.licences(flavour, fmi).items()},
    }
    if flavour != "native":
        files |= binaries(flavour, model.name, fmi)
    if flavour == "isolated":
        files |= {f"resources/{name}": data for name, data in _of_process(model.guid, python).items()}
    return _write(files, out)


def _description(
    model: Model, table: Sequence[Variable], own: Mapping[str, bytes], flavour: Flavour, fmi: Version
) -> bytes:
    if fmi == 3:
        return fmi3.description(model, table, flavour)
    names = [name.removeprefix(compiled.SOURCES) for name in own if name.startswith(compiled.SOURCES)]
    return fmi2.description(model, table, flavour, compiled.to_compile(names))


def _of_process(guid: str, python: str | None) -> dict[str, bytes]:
    """Return name and content of the resources that start an isolated FMU; `python` is its interpreter."""
    found = {"start.py": (_LIBRARY / "start.py").read_bytes(), "guid.txt": guid.encode()}
    return found | ({"python.txt": python.encode()} if python else {})


def _write(parts: Mapping[str, bytes], out: Path) -> Path:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in sorted(parts):
            entry = zipfile.ZipInfo(name)  # dated 1980, so that builds are reproducible
            entry.create_system, entry.external_attr = 3, 0o644 << 16
            archive.writestr(entry, parts[name], zipfile.ZIP_DEFLATED)
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_bytes(buffer.getvalue())
    return out


def binaries(flavour: Flavour, model: str, fmi: Version = 2) -> dict[str, bytes]:
    """Return the library of a flavour in Python for every platform that has one, under the name of the model."""
    root = _LIBRARY if flavour == "isolated" else files("pythonfmu") / "resources"
    found = {
        f"binaries/{_folder(platform.name, fmi)}/{model}{Path(library.name).suffix}": library.read_bytes()
        for platform in (root / "binaries").iterdir()
        for library in platform.iterdir()
        if Path(library.name).suffix in _LIBRARIES
    }
    if not found:
        raise FileNotFoundError(f"There are no binaries in {root}. Install tribofmu and pythonfmu again.")
    return found


def _folder(platform: str, fmi: Version) -> str:
    return platform if fmi == 2 else _TUPLES[platform]
