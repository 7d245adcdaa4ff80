"""The command line that builds an FMU: build_fmu.py, and `tribofmu build`. Light to import."""

import argparse
import os
import sys
import zipfile
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from shutil import which
from xml.etree import ElementTree

from contact_core.errors import SceneError
from contact_core.quantities import UNSOLVED
from contact_core.scene import Scene, told

from ..flavours import FLAVOURS, VERSIONS, Flavour

_NO_PYTHON: dict[Flavour, str] = {
    "embedded": "an embedded FMU runs in its host's Python",
    "native": "a native FMU needs none",
}


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return 0, or 2 after an error message on stderr."""
    parser = argparse.ArgumentParser(prog="build_fmu.py", description="Build the FMU of a scene.")
    add_arguments(parser)
    try:
        return run(parser.parse_args(argv))
    except SceneError as error:
        print(error, file=sys.stderr)
        return 2


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that `run` reads."""
    parser.add_argument("scene", metavar="SCENE", help="name of a shipped scene, or path of a .toml file")
    parser.add_argument("--out", type=Path, metavar="FILE.fmu", help="default: name of the scene, in this folder")
    parser.add_argument(
        "--flavour",
        choices=FLAVOURS,
        default="isolated",
        help="isolated: for any host, the model in a process of its own; embedded: for hosts in Python; native: for "
        "any host, C generated for the scene, without Python (default: %(default)s)",
    )
    parser.add_argument(
        "--fmi",
        type=int,
        choices=sorted({version for versions in VERSIONS.values() for version in versions}),
        default=2,
        help="version of FMI: 2 for FMI 2.0, 3 for FMI 3.0, which the embedded flavour lacks (default: %(default)s)",
    )
    parser.add_argument(
        "--python",
        metavar="PATH",
        nargs="?",
        const=sys.executable,
        help="interpreter of an isolated FMU where TRIBOFMU_PYTHON is not set (without PATH: the one that builds it, "
        "which is the default in a virtual environment; elsewhere python3 on the host's PATH)",
    )
    parser.add_argument(
        "--portable", action="store_true", help="record no interpreter, for equal files on all machines: see --python"
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
    parser.add_argument(
        "--force",
        action="store_true",
        help="build numbers that look like mistakes, and replace a file of another scene",
    )


def run(arguments: argparse.Namespace) -> int:
    """Build the FMU and print its path; return 0, or 2 if it cannot be written.

    Raises SceneError if the arguments cannot be used.
    """
    if arguments.python and arguments.flavour != "isolated":
        raise SceneError(f"--python is for isolated FMUs: {_NO_PYTHON[arguments.flavour]}. Leave it out.")
    if arguments.python and arguments.portable:
        raise SceneError("--portable records no interpreter, and --python names one. Leave one of them out.")
    settings = _overrides(arguments.overrides)
    scene, assumed = Scene.read(arguments.scene, settings)
    if arguments.flavour == "native" and "film.model" not in settings:
        scene = _without_solver(scene)
    doubts = scene.doubts()
    if doubts and not arguments.force:
        raise SceneError(f"{' '.join(doubts)} If this is meant, add --force.")
    from .build import build, check

    check(arguments.flavour, arguments.fmi, scene)
    for warning in (*filter(None, [told(assumed)]), *doubts, *scene.warnings()):
        print(f"Note: {warning}", file=sys.stderr)
    out = arguments.out or Path(f"{scene.name}.fmu")
    _ask_before(out, scene, arguments.force)
    if arguments.flavour == "native":
        print("Note: C is written and compiled, for each platform in turn; this may take minutes.", file=sys.stderr)
    if scene.film.fidelity not in UNSOLVED:
        solved = "the contact is solved for the reference data; the first time kernels compile, which takes minutes"
        print(f"Note: {solved}.", file=sys.stderr)
    try:
        recorded = _recorded(_interpreter(arguments))
        print(build(scene, out, arguments.flavour, fmi=arguments.fmi, python=recorded, reference=True))
        _tell_missing(arguments)
    except OSError as error:
        print(f"The FMU cannot be written: {error}.", file=sys.stderr)
        return 2
    return 0


def _ask_before(out: Path, scene: Scene, force: bool) -> None:
    """Say that a file is replaced. Raises SceneError if it cannot be, or is no FMU of this scene, unless `force`d."""
    folder = out.absolute().parent
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
    if not os.access(folder, os.W_OK):
        raise SceneError(f"The folder '{out.parent}' cannot be written to. Use another --out.")
    if not out.is_file():
        return
    before = _description(out)
    own = before == scene.description or before.startswith(f"{scene.name}:")  # as descriptions by default do
    if not own and not force:
        what = f"the FMU '{before}'" if before else "no FMU"
        raise SceneError(f"'{out}' is there already: {what}. Use another --out, or --force to replace it.")
    print(f"Note: '{out}' is replaced.", file=sys.stderr)


def _description(path: Path) -> str:
    """Return the description of an FMU; an empty text if the file is none."""
    try:
        with zipfile.ZipFile(path) as fmu, fmu.open("modelDescription.xml") as text:
            _, root = next(iter(ElementTree.iterparse(text, events=("start",))))
            return str(root.get("description", ""))
    except Exception:  # zipfile and zlib raise a dozen kinds for a file that is damaged or no FMU
        return ""


def _tell_missing(arguments: argparse.Namespace) -> None:
    """Print the platforms for which a native FMU has no library, if any."""
    if arguments.flavour != "native":
        return
    from ..native.files import missing

    if names := missing(arguments.fmi):
        print(
            f"Note: The FMU has no library for {', '.join(names)}. Build it with zig (pip install tribofmu[native]), "
            "or compile its sources there (fmpy compile).",
            file=sys.stderr,
        )


def _without_solver(scene: Scene) -> Scene:
    """Return the scene at the level of a native FMU; say so, with its error, where that is another one."""
    from ..native.level import other_level, unsolved

    taken = unsolved(scene)
    if taken is not scene:
        print(f"Note: {other_level(scene, taken)}", file=sys.stderr)
    return taken


def _interpreter(arguments: argparse.Namespace) -> str | None:
    """Return the interpreter to record: the one asked for, else, for an isolated FMU, that of a virtual environment."""
    own = arguments.flavour == "isolated" and not arguments.portable and sys.prefix != sys.base_prefix
    return arguments.python or (sys.executable if own else None)


def _recorded(python: str | None) -> str | None:
    """Return the absolute path of the interpreter, if it is on this machine; links of virtual environments are kept."""
    found = python and which(python)
    if python and not found:
        print(f"Note: '{python}' cannot be run here. The FMU will look for it under this name.", file=sys.stderr)
        return python
    return str(Path(found).absolute()) if found else None


def _overrides(pairs: Sequence[str]) -> dict[str, str]:
    for pair in pairs:
        if "=" not in pair:
            raise SceneError(f"--set {pair} has no '='. Write for example --set film.points=65.")
    return {key.strip(): value.strip() for key, _, value in (pair.partition("=") for pair in pairs)}
