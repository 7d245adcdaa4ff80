"""The command `tribofmu map`: makes the map of a scene, for film.correction = "map"."""

import argparse
import re
from pathlib import Path
from typing import TYPE_CHECKING

from contact_core.errors import ContactError
from contact_core.scene import Scene, units

from .console import add_settings, note, output_folder
from .overwriting import add_force
from .progress import counted
from .scenes import ask_back, refuse_machine, tell_assumed, warn

if TYPE_CHECKING:
    from ..run.map_build import Built, Order

_TIME = re.compile(r"\s*([0-9.]+)\s*(s|min|h)\s*$")
_SECONDS = {"s": 1.0, "min": 60.0, "h": 3600.0}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", metavar="NAME", help="a shipped scene (`tribofmu list`), or the path of a .toml file")
    parser.add_argument("--out", metavar="DIR", help="folder of map, histories and report (default: results/NAME)")
    parser.add_argument(
        "--accuracy",
        metavar="A",
        default="5 %",
        help="median half width (95 %%) of friction and h_c at which no more is solved (default: 5 %%)",
    )
    parser.add_argument(
        "--time", metavar="T", default="30min", help="time after which no more is solved (default: %(default)s)"
    )
    executor_arguments(parser, "histories")
    for option, text in (
        ("--load", "loads, such as 10:80, in N"),
        ("--entrainment", "entrainment speeds, such as 0.01:1, in m/s"),
        ("--slide-roll", "sliding over entrainment speed, of both directions, such as '1 %%:50 %%'"),
        ("--temperature", "oil temperatures, such as '60 degC:100 degC'"),
        ("--radius-x", "radii along entrainment of rollers and lines, such as '5 mm:12 mm', alone that of the scene"),
    ):
        parser.add_argument(option, metavar="LOW:HIGH", help=f"{text} (default: about the scene's operation)")
    add_force(parser)
    add_settings(parser, "change values of the scene, e.g. tribofilm.model=none surface_2.rq='50 nm'")


def executor_arguments(parser: argparse.ArgumentParser, what: str) -> None:
    """Add the arguments that say where `what` are solved."""
    parser.add_argument(
        "--processes", metavar="N", type=int, default=1, help=f"processes for the {what} (default: %(default)s)"
    )
    parser.add_argument(
        "--executor", metavar="dask://HOST:PORT", help="scheduler of a cluster in their place (extra 'dask')"
    )


def run(arguments: argparse.Namespace) -> int:
    """Make, print and write the map; return the exit code."""
    from ..run import map_build, map_report
    from ..run.map_ranges import OPTIONS, Ranges
    from ..store.checkpoint import alone

    refuse_machine(arguments.scene)
    scene, assumed = Scene.read(arguments.scene, dict(arguments.settings))
    tell_assumed(assumed)
    given = {name: text for name in OPTIONS if (text := getattr(arguments, name)) is not None}
    order = map_build.Order(
        scene,
        Ranges.of(scene, given),
        _accuracy(arguments.accuracy),
        _seconds(arguments.time),
        processes_of(arguments.processes),
        arguments.executor,
    )
    ask_back(
        scene.doubts([("operation", scene.operation.point), ("The map's range", order.ranges.extreme())]),
        arguments.force,
    )
    folder = output_folder(arguments.out, scene.name)
    warn(scene.warnings())
    with alone(folder):
        built = _built(order, folder / "histories.jsonl")
        print(*map_report.lines(built), sep="\n")
        written = map_report.write(built, folder)
    print(f"Written: {', '.join(map(str, written))}")
    print(f"A scene uses the map by film.correction = 'map' and film.file = '{written[0].resolve()}'.")
    if not built.reached:
        note("The time was over first. The same command goes on from what is solved.")
    return 0 if built.reached else 1


def _accuracy(text: str) -> float:
    accuracy = units.parse(text, "", "--accuracy")
    if not 0.0 < accuracy <= 1.0:
        raise ContactError(f"--accuracy = {text} must be above 0 and at most 100 %, such as 5 %.")
    return accuracy


def _seconds(text: str) -> float:
    match = _TIME.match(text)
    if not match:
        raise ContactError(f"--time = '{text}' is not a time such as 90s, 30min or 2h.")
    try:
        return float(match[1]) * _SECONDS[match[2]]
    except ValueError:
        raise ContactError(f"--time = '{text}' is not a time such as 90s, 30min or 2h.") from None


def processes_of(count: int) -> int:
    """Return --processes. Raises ContactError for less than 1, or far too many."""
    if not 1 <= count <= 1024:
        raise ContactError(f"--processes = {count} must be at least 1 and at most 1024.")
    return count


def _built(order: "Order", file: Path) -> "Built":
    """Make the map, with a counter of the histories."""
    from ..run.map_build import build

    name = order.scene.name
    try:
        with counted(name, "histories") as shown:

            def show(count: int, halves: tuple[float, ...] | None) -> None:
                known = zip(("friction", "h_c", "W_c"), halves or (), strict=False)
                shown(count, ", ".join([name, *(f"{output} {100.0 * half:.1f} %" for output, half in known)]))

            return build(order, file, show)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"What is solved is kept in '{file}': the same command goes on from there.") from None
