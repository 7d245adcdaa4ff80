"""Build a scene's FMU: model description, documentation, resources and binaries, in one zip.

pythonfmu's own builder is not used: it stamps time and a random guid into every FMU, runs the model to
describe it, and packs a copy of itself that would hide the installed one.
"""

import argparse
import io
import sys
import zipfile
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from shutil import which

from contact_core.errors import SceneError
from contact_core.scene import Scene

from . import evidence, icon, packages, resources
from .describe import model_description
from .document import documentation
from .resources import FLAVOURS, Flavour

_LIBRARIES = (".so", ".dll", ".dylib")


def build(
    scene: Scene, out: Path, flavour: Flavour = "isolated", *, python: str | None = None, reference: bool = False
) -> Path:
    """Write the FMU of `scene` to `out` and return it. The same arguments and versions give the same bytes.

    `flavour` "isolated": any host can load it, and the model runs in a process of its own, in the interpreter
    `python` (default: what the host finds). "embedded": the model runs inside a host that is itself Python.
    `reference`: with reference data, for which the contact is solved at five operating points.
    Raises OSError if the file cannot be written, or the binaries or a licence are missing.
    """
    return pack(
        {
            "modelDescription.xml": model_description(scene, flavour),
            "model.png": icon.png(),
            "documentation/index.html": documentation(scene, flavour, reference),
            "documentation/externalDependencies.txt": packages.external_dependencies(flavour),
            **{f"documentation/licenses/{name}": text for name, text in packages.licences(flavour).items()},
            **(evidence.reference(scene) if reference else {}),
            **{f"resources/{name}": data for name, data in resources.files(scene, flavour, python).items()},
            **binaries(flavour, resources.MODEL),
        },
        out,
    )


def pack(parts: Mapping[str, bytes], out: Path) -> Path:
    """Write an FMU of these files."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in sorted(parts):
            entry = zipfile.ZipInfo(name)  # dated 1980: builds are reproducible
            entry.create_system, entry.external_attr = 3, 0o644 << 16
            archive.writestr(entry, parts[name], zipfile.ZIP_DEFLATED)
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_bytes(buffer.getvalue())
    return out


def binaries(flavour: Flavour, model: str) -> dict[str, bytes]:
    """The flavour's library for every platform that has one, under the model's name."""
    root = files("fmu_src") / "native" if flavour == "isolated" else files("pythonfmu") / "resources"
    found = {
        f"binaries/{platform.name}/{model}{Path(library.name).suffix}": library.read_bytes()
        for platform in (root / "binaries").iterdir()
        for library in platform.iterdir()
        if Path(library.name).suffix in _LIBRARIES
    }
    if not found:
        raise FileNotFoundError(f"There are no binaries in {root}. Install tribofmu and pythonfmu again.")
    return found


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return 0, or 2 with a sentence on stderr."""
    parser = argparse.ArgumentParser(prog="build_fmu.py", description="Build the FMU of a scene.")
    add_arguments(parser)
    try:
        return run(parser.parse_args(argv))
    except SceneError as error:
        print(error, file=sys.stderr)
        return 2


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What `run` wants to know."""
    parser.add_argument("scene", metavar="SCENE", help="name of a shipped scene, or path of a .toml file")
    parser.add_argument("--out", type=Path, metavar="FILE.fmu", help="default: here, the scene's name")
    parser.add_argument(
        "--flavour",
        choices=FLAVOURS,
        default="isolated",
        help="isolated: for any host, the model in a process of its own; embedded: for hosts that are Python "
        "(default: %(default)s)",
    )
    parser.add_argument(
        "--python",
        metavar="PATH",
        nargs="?",
        const=sys.executable,
        help="the Python that runs an isolated FMU where TRIBOFMU_PYTHON is not set (without PATH: the one that builds "
        "it; without --python: python3 on the host's PATH)",
    )
    parser.add_argument(
        "--set",
        dest="overrides",
        metavar="key=value",
        nargs="+",
        action="extend",
        default=[],
        help="change a value of the scene, e.g. film.points=65 or tribofilm.model=none",
    )


def run(arguments: argparse.Namespace) -> int:
    """Build what the command line asks for and print its path; return 0, or 2 if it cannot be written.

    Raises SceneError if it asks for what cannot be.
    """
    if arguments.python and arguments.flavour == "embedded":
        raise SceneError("--python is for isolated FMUs: an embedded one is run by its host's Python. Leave it out.")
    scene = Scene.from_toml(arguments.scene, _overrides(arguments.overrides))
    for warning in scene.warnings():
        print(f"Note: {warning}", file=sys.stderr)
    out = arguments.out or Path(f"{scene.name}.fmu")
    try:
        print(build(scene, out, arguments.flavour, python=_recorded(arguments.python), reference=True))
    except OSError as error:
        print(f"The FMU cannot be written: {error}.", file=sys.stderr)
        return 2
    return 0


def _recorded(python: str | None) -> str | None:
    """The interpreter's whole path, if it is on this machine; a virtual environment's stays what it is."""
    found = python and which(python)
    if python and not found:
        print(f"Note: '{python}' cannot be run here. The FMU will look for it as it stands.", file=sys.stderr)
        return python
    return str(Path(found).absolute()) if found else None


def _overrides(pairs: Sequence[str]) -> dict[str, str]:
    for pair in pairs:
        if "=" not in pair:
            raise SceneError(f"--set {pair} has no '='. Write for example --set film.points=65.")
    return {key.strip(): value.strip() for key, _, value in (pair.partition("=") for pair in pairs)}
