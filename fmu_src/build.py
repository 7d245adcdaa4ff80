"""Build a scene's FMU: model description, documentation, resources and pythonfmu's binaries, in one zip.

pythonfmu's own builder is not used: it stamps time and a random guid into every FMU, runs the model to
describe it, and packs a copy of itself that would hide the installed one.
"""

import argparse
import io
import sys
import zipfile
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path

from contact_core.errors import SceneError
from contact_core.scene import Scene

from . import resources
from .describe import model_description
from .document import documentation

_LIBRARIES = (".so", ".dll", ".dylib")


def build(scene: Scene, out: Path) -> Path:
    """Write the FMU of `scene` to `out` and return it. The same scene and versions give the same bytes.

    Raises OSError if the file cannot be written or pythonfmu's binaries are missing.
    """
    parts = {
        "modelDescription.xml": model_description(scene),
        "documentation/index.html": documentation(scene),
        **{f"resources/{name}": data for name, data in resources.files(scene).items()},
        **_binaries(),
    }
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in sorted(parts):
            entry = zipfile.ZipInfo(name)  # dated 1980: builds are reproducible
            entry.create_system, entry.external_attr = 3, 0o644 << 16
            archive.writestr(entry, parts[name], zipfile.ZIP_DEFLATED)
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_bytes(buffer.getvalue())
    return out


def _binaries() -> dict[str, bytes]:
    """The library of pythonfmu for every platform it has, under the model's name."""
    root = files("pythonfmu") / "resources" / "binaries"
    found = {
        f"binaries/{platform.name}/{resources.MODEL}{Path(library.name).suffix}": library.read_bytes()
        for platform in root.iterdir()
        for library in platform.iterdir()
        if Path(library.name).suffix in _LIBRARIES
    }
    if not found:
        raise FileNotFoundError(f"pythonfmu has no binaries in {root}. Install pythonfmu again.")
    return found


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return 0, or 2 with a sentence on stderr."""
    parser = argparse.ArgumentParser(prog="build_fmu.py", description="Build the FMU of a scene.")
    parser.add_argument("scene", metavar="SCENE", help="name of a shipped scene, or path of a .toml file")
    parser.add_argument("--out", type=Path, metavar="FILE.fmu", help="default: here, the scene's name")
    parser.add_argument(
        "--set",
        dest="overrides",
        metavar="key=value",
        nargs="+",
        action="extend",
        default=[],
        help="change a value of the scene, e.g. film.points=65 or tribofilm.model=none",
    )
    arguments = parser.parse_args(argv)
    try:
        scene = Scene.from_toml(arguments.scene, _overrides(arguments.overrides))
        for warning in scene.warnings():
            print(f"Note: {warning}", file=sys.stderr)
        print(build(scene, arguments.out or Path(f"{scene.name}.fmu")))
    except SceneError as error:
        print(error, file=sys.stderr)
        return 2
    except OSError as error:
        print(f"The FMU cannot be written: {error}.", file=sys.stderr)
        return 2
    return 0


def _overrides(pairs: Sequence[str]) -> dict[str, str]:
    for pair in pairs:
        if "=" not in pair:
            raise SceneError(f"--set {pair} has no '='. Write for example --set film.points=65.")
    return {key.strip(): value.strip() for key, _, value in (pair.partition("=") for pair in pairs)}
