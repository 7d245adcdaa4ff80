"""The command `tribofmu stribeck`: rubs a scene's contact and measures its Stribeck curves."""

import argparse
import re
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from contact_core.errors import ContactError
from contact_core.quantities import UNSOLVED
from contact_core.scene import Scene, units

from .console import output_folder
from .map import processes_of
from .progress import counted
from .scenes import add_scene, ask_back, contact, warn

if TYPE_CHECKING:
    from ..run.duty import Duty
    from ..run.stribeck import Curves, Plan


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_scene(parser, "scene")
    parser.add_argument(
        "--times",
        metavar="MIN",
        nargs="+",
        default=["0,5,15,30,60,120"],
        help="rubbing times in minutes, after each of which speeds are swept (default: 0,5,15,30,60,120)",
    )
    parser.add_argument("--fastest", metavar="U", default="10", help="fastest entrainment speed in m/s (default: 10)")
    parser.add_argument(
        "--slowest", metavar="U", default="0.003", help="slowest entrainment speed in m/s (default: 0.003)"
    )
    parser.add_argument("--points", metavar="N", type=int, default=12, help="speeds of a sweep (default: %(default)s)")
    parser.add_argument(
        "--srr",
        metavar="R",
        help="slide-to-roll ratio (u1 - u2) / u_e, such as 0.1 or '10 %%' (default: that of the scene)",
    )
    parser.add_argument(
        "--processes",
        metavar="N",
        type=int,
        help="processes that solve the points of the sweeps while this one rubs; 1: this one alone (default: one for "
        "each core; 1 for levels that solve no contact)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Measure, print and write the curves; return the exit code."""
    from ..run.origin import attributes
    from ..run.stribeck import Curves, Plan
    from ..runs.replacing import ask_before
    from ..store.checkpoint import alone
    from .listener import CONSOLE

    scene, duty = contact(arguments)
    processes = _processes(arguments.processes, scene)
    plan = Plan.of(
        duty,
        _rubbing_times(arguments.times),
        _plain_or_with_unit("--fastest", arguments.fastest, "m/s"),
        _plain_or_with_unit("--slowest", arguments.slowest, "m/s"),
        arguments.points,
        _slide_roll_ratio(arguments.srr),
    )
    swept = ((f"The sweep at {speed:.3g} m/s", plan.point(speed)) for speed in plan.speeds)
    ask_back(scene.doubts(swept), arguments.force)
    folder = output_folder(arguments.out, Path(arguments.scene).stem)
    warn(scene.warnings())
    _introduce(scene, plan)
    curves = Curves(plan)
    with alone(folder):
        ask_before(folder, attributes(scene, duty), arguments.force, CONSOLE, "stribeck")
        try:
            _sweep(scene, duty, curves, processes)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(_kept(scene, duty, curves, folder)) from None
        except ContactError as error:
            raise ContactError(f"{error} {_kept(scene, duty, curves, folder)}".rstrip()) from error
        return _report_curves(scene, duty, curves, folder)


def _introduce(scene: Scene, plan: "Plan") -> None:
    """Print what the contact is like over the speeds of a sweep, before it is solved."""
    from ..run import trust
    from ..run.duty import Duty

    swept = Duty(tuple(map(float, range(len(plan.speeds)))), tuple(map(plan.point, plan.speeds)))
    print(*trust.wrapped(scene.description), *trust.before(scene, swept), "", sep="\n", flush=True)


def _rubbing_times(words: Sequence[str]) -> list[float]:
    """Return minutes, apart from each other by commas or spaces, in seconds."""
    try:
        return [60.0 * float(word) for word in re.split(r"[,\s]+", " ".join(words)) if word]
    except ValueError:
        raise ContactError(f"--times = '{' '.join(words)}' must be numbers of minutes, such as 0,5,30.") from None


def _slide_roll_ratio(text: str | None) -> float | None:
    """Return the ratio of --srr; a plain number above 2, at which a body rests, looks like per cent."""
    if text is None:
        return None
    ratio = _plain_or_with_unit("--srr", text, "")
    if abs(ratio) > 2.0 and "%" not in text:
        raise ContactError(
            f"--srr = {text} is {100.0 * ratio:g} %, and from 200 % on the surfaces move against each other. Write "
            f"--srr '{text} %' for per cent, or '{100.0 * ratio:g} %' if that is meant."
        )
    return ratio


def _plain_or_with_unit(option: str, text: str, unit: str) -> float:
    with suppress(ValueError):
        text = f"{float(text)!r} {unit}"
    return units.parse(text, unit, option)


def _processes(asked: int | None, scene: Scene) -> int:
    """Return --processes; to start some takes longer than points that solve no contact."""
    from ..run.workers import cores

    return processes_of(asked) if asked is not None else 1 if scene.film.fidelity in UNSOLVED else cores()


def _sweep(scene: Scene, duty: "Duty", curves: "Curves", processes: int) -> None:
    """Measure the curves, with a progress bar in points."""
    from ..run.stribeck import measure

    with counted(scene.name, "points", len(curves.plan.times) * len(curves.plan.speeds)) as show:
        measure(scene, duty, curves, lambda stage, count: show(count, f"{scene.name}, {stage}"), processes)


def _kept(scene: Scene, duty: "Duty", curves: "Curves", folder: Path) -> str:
    """Write the points of unfinished curves, and return a sentence on it."""
    if not curves.count:
        return ""
    from ..store.results import write

    netcdf, _ = write(curves.dataset(scene, duty), folder, "stribeck")
    return f"The {curves.count} points measured so far are in '{netcdf}'."


def _report_curves(scene: Scene, duty: "Duty", curves: "Curves", folder: Path) -> int:
    """Print and write the curves; return the exit code."""
    from ..charts import files
    from ..run import stribeck_report
    from ..store import results

    dataset = curves.dataset(scene, duty)
    print(stribeck_report.table(dataset))
    print(*stribeck_report.shift_lines(dataset), *stribeck_report.closing_lines(dataset), sep="\n")
    written = results.write(dataset, folder, "stribeck")
    written.append(files.save(stribeck_report.sheet(dataset), folder / "stribeck.png"))
    print(f"Written: {', '.join(map(str, written))}")
    return 1 if stribeck_report.invalid_points(dataset) else 0
