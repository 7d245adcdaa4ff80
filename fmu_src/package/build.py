"""Build an FMU: model description, documentation, resources and binaries in one zip.

pythonfmu's own builder is not used: it writes time and a random guid into every FMU, runs the model to describe it, and
packs a copy of itself that would hide the installed one.
"""

import io
import zipfile
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path

from contact_core.scene import Scene

from ..flavours import Flavour
from ..runtime import resources
from ..variables import Variable, variables
from . import evidence, icon, licences
from .describe import Model, described, xml
from .document.page import documentation

_NATIVE = files("fmu_src.isolated") / "native"
_LIBRARIES = (".so", ".dll", ".dylib")


def build(
    scene: Scene, out: Path, flavour: Flavour = "isolated", *, python: str | None = None, reference: bool = False
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
        a host in Python.
    python
        Interpreter of an isolated FMU; default: the one that the FMU finds, see `licences.VARIABLES`.
    reference
        Add reference data, for which the contact is solved at five operating points.

    Raises
    ------
    OSError
        The file cannot be written, or the binaries or a licence are missing.
    """
    own = {
        "model.png": icon.png(),
        "documentation/index.html": documentation(scene, flavour, reference),
        **(evidence.reference(scene) if reference else {}),
        **{f"resources/{name}": data for name, data in resources.files(scene).items()},
    }
    return pack(described(scene, flavour), variables(scene), own, out, flavour, python)


def pack(
    model: Model, table: Sequence[Variable], own: Mapping[str, bytes], out: Path, flavour: Flavour, python: str | None
) -> Path:
    """Write an FMU from its `own` files, its description and the files of its flavour."""
    files = {
        **own,
        "modelDescription.xml": xml(model, table, flavour),
        "documentation/externalDependencies.txt": licences.external_dependencies(flavour),
        **{f"documentation/licenses/{name}": text for name, text in licences.licences(flavour).items()},
        **binaries(flavour, model.name),
    }
    if flavour == "isolated":
        files |= {f"resources/{name}": data for name, data in _of_process(model.guid, python).items()}
    return _write(files, out)


def _of_process(guid: str, python: str | None) -> dict[str, bytes]:
    """Return name and content of the resources that start an isolated FMU; `python` is its interpreter."""
    found = {"start.py": (_NATIVE / "start.py").read_bytes(), "guid.txt": guid.encode()}
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


def binaries(flavour: Flavour, model: str) -> dict[str, bytes]:
    """Return the library of the flavour for every platform that has one, under the name of the model."""
    root = _NATIVE if flavour == "isolated" else files("pythonfmu") / "resources"
    found = {
        f"binaries/{platform.name}/{model}{Path(library.name).suffix}": library.read_bytes()
        for platform in (root / "binaries").iterdir()
        for library in platform.iterdir()
        if Path(library.name).suffix in _LIBRARIES
    }
    if not found:
        raise FileNotFoundError(f"There are no binaries in {root}. Install tribofmu and pythonfmu again.")
    return found
