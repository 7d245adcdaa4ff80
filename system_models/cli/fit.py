"""The command `tribofmu fit`: fits constants of a scene to measured numbers."""

import argparse
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from contact_core.errors import ContactError
from contact_core.scene import Scene, units

from .console import note, output_folder
from .overwriting import refuse_existing
from .progress import counted
from .scenes import add_scene, contact, warn

if TYPE_CHECKING:
    from ..run.fit import Fit
    from ..run.fit_data import Measured
    from ..run.fit_model import Constant

LEVELS = ("regression", "deterministic")
_NAME = re.compile(r"[A-Za-z0-9_-]+$")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "data",
        metavar="DATA.csv",
        help="measured numbers against time: outputs of a contact such as 'tribofilm_1 [nm]', with standard deviations "
        "('tribofilm_1_sd [nm]') or without, and inputs such as 'temperature [degC]'",
    )
    add_scene(parser, "scene")
    parser.add_argument(
        "--vary",
        metavar="KEY[=LOW:HIGH]",
        nargs="+",
        action="extend",
        default=[],
        help="constants to fit, e.g. tribofilm.full_thickness='50 nm:300 nm'; without a range about the scene's value "
        "(default: all of the laws of what is measured)",
    )
    parser.add_argument("--level", choices=LEVELS, default=LEVELS[0], help="fidelity level (default: %(default)s)")
    parser.add_argument(
        "--hold-back",
        metavar="SHARE",
        default="0",
        help="share of the points that is not fitted but judged, such as 0.33 or '33 %%' (default: 0)",
    )
    parser.add_argument("--name", metavar="NAME", help="name of the set, and of its file (default: that of DATA.csv)")


def run(arguments: argparse.Namespace) -> int:
    """Fit, print and write the result; return the exit code."""
    from ..run import fit_data, fit_model
    from ..store.checkpoint import alone

    scene, duty = contact(arguments)
    if len(duty.points) > 1:
        raise ContactError(
            "The scene's duty changes with time, but a test of a fit holds its inputs. Leave out operation.steps and "
            "operation.file, and give inputs as columns of the data."
        )
    share, name = _share(arguments.hold_back), _name(arguments)
    measured = fit_data.read(Path(arguments.data), scene, arguments.level)
    constants = fit_model.constants_of(scene, arguments.vary, measured.quantities)
    folder = output_folder(arguments.out, name)
    warn(scene.warnings())
    with alone(folder):
        _ask_before(folder, name, {"data": measured.source, "scene": scene.name}, arguments.force)
        found = _fitted(name, scene, measured, constants, arguments.level, share)
        return _report(found, name, folder)


def _share(text: str) -> float:
    share = units.parse(text, "", "--hold-back")
    if not 0.0 <= share < 1.0:
        raise ContactError(f"--hold-back = {text} must be at least 0 and below 1, such as 0.33.")
    return share


def _name(arguments: argparse.Namespace) -> str:
    name = str(arguments.name or re.sub(r"[^A-Za-z0-9_-]+", "_", Path(arguments.data).stem))
    if not _NAME.match(name):
        raise ContactError(f"--name = '{name}' must be of letters, digits, '_' and '-'.")
    return name


def _ask_before(folder: Path, name: str, origin: Mapping[str, str], force: bool) -> None:
    """Say what fit in a folder is replaced. Raises ContactError if it is of other data or another scene."""
    path = folder / "fit.json"
    try:
        before = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError):
        refuse_existing([folder / f"{name}.toml"], force)
        return
    if not force and not origin.items() <= before.items():
        raise ContactError(
            f"'{path}' is the fit to '{before.get('data')}' in scene '{before.get('scene')}', and this is to "
            f"'{origin['data']}' in '{origin['scene']}'. Use another --out, or --force to replace it."
        )
    note(f"'{path}', an earlier fit, will be replaced. To keep it, stop and use another --out.")


def _fitted(
    name: str, scene: Scene, measured: "Measured", constants: "tuple[Constant, ...]", level: str, share: float
) -> "Fit":
    """Fit, with a counter of the sets of constants tried."""
    from itertools import count

    from ..run.fit import fit

    tried = count(1)
    try:
        with counted(name, "sets of constants") as show:
            held_back = measured.held_back(share)
            return fit(
                scene, measured, constants, held_back, level, lambda stage: show(next(tried), f"{name}, {stage}")
            )
    except KeyboardInterrupt:
        raise KeyboardInterrupt("Nothing was written; the same command fits from the beginning.") from None


def _report(found: "Fit", name: str, folder: Path) -> int:
    """Print and write a fit; return the exit code."""
    from ..run import fit_report

    print(f"{found.measured.source} in {found.scene.name}, level {found.level}", fit_report.table(found), sep="\n")
    print(*fit_report.lines(found), sep="\n")
    written = fit_report.write(found, name, folder)
    print(f"Written: {', '.join(map(str, written))}")
    print(f"A scene uses the set by set = '{folder / name}.toml:{name}'.")
    return 0 if found.agreed else 1
