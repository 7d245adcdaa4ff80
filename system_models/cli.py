"""The command `tribofmu`: scenes and machines are listed and run, FMUs built and checked, systems of FMUs simulated.

Exit codes: 0 done; 1 some rows of the result are invalid, some rule failed, or some steps have missed a tolerance;
2 refused or failed, with a sentence on stderr; 130 interrupted.
"""

import argparse
import logging
import re
import sys
import tempfile
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from contact_core.errors import ContactError, StateError
from contact_core.scene import Scene, units
from contact_core.scene.toml import did_you_mean, shipped_scenes
from fmu_src.package import command as fmu_command

from . import cosim_command
from .console import add_settings, note, output_folder
from .machine import command as machine_command
from .machine import files as machine_files

if TYPE_CHECKING:
    import xarray as xr

    from .checkpoint import Checkpoint
    from .duty import Duty
    from .stribeck import Curves


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    arguments = _parser().parse_args(argv)
    try:
        return int(arguments.command(arguments))
    except ContactError as error:
        print(f"tribofmu: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt as interrupt:
        print(f"tribofmu: Interrupted. {interrupt}".rstrip(), file=sys.stderr)
        return 130


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="tribofmu", description="Mixed lubrication, tribofilm and wear of a contact as an FMU."
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    listing = commands.add_parser("list", help="name the shipped scenes and machines")
    listing.set_defaults(command=_list)
    run = commands.add_parser("run", help="run a scene's contact, or a machine, through its duty")
    run.set_defaults(command=_run)
    _add_scene(run)
    run.add_argument(
        "--resume",
        action="store_true",
        help="go on from the checkpoint that a killed, interrupted or failed run has left in DIR, to the same result, "
        "bit for bit; start from the beginning if there is none (without --resume always, and replace it)",
    )
    run.add_argument("--hours", metavar="H", help="duration of the test, instead of operation.duration")
    run.add_argument("--duty", metavar="FILE.csv", help="CSV of the duty, instead of operation.file")
    run.add_argument(
        "--unchecked",
        action="store_true",
        help="leave out what checks a machine's result: a simulation with double steps, and states solved again",
    )
    run.add_argument("--ssp", metavar="FILE.ssp", help="export a machine as SSP 1.0, do not run it")
    stribeck = commands.add_parser("stribeck", help="rub a scene's contact and sweep its Stribeck curves")
    stribeck.set_defaults(command=_stribeck)
    _add_scene(stribeck)
    stribeck.add_argument(
        "--times",
        metavar="MIN",
        nargs="+",
        default=["0,5,15,30,60,120"],
        help="rubbing times in minutes, after which speeds are swept (default: %(default)s)",
    )
    stribeck.add_argument(
        "--fastest", metavar="U", default="10", help="entrainment speed in m/s (default: %(default)s)"
    )
    stribeck.add_argument("--slowest", metavar="U", default="0.003", help="the other end (default: %(default)s)")
    stribeck.add_argument(
        "--points", metavar="N", type=int, default=12, help="speeds of a sweep (default: %(default)s)"
    )
    stribeck.add_argument("--srr", metavar="R", help="slide-to-roll ratio (u1 - u2) / u_e, instead of the scene's own")
    building = commands.add_parser("build", help="build the FMU of a scene, for another tool")
    fmu_command.add_arguments(building)
    building.set_defaults(command=fmu_command.run)
    check = commands.add_parser("check", help="give a verdict per rule on an FMU, anybody's")
    check.set_defaults(command=_check)
    check.add_argument("fmu", metavar="FILE.fmu", type=Path)
    check.add_argument("--deep", action="store_true", help="run it, too: replay, rollback, range of the inputs, ...")
    check.add_argument(
        "--limit",
        metavar="S",
        type=float,
        default=120.0,
        help="with --deep: seconds after which a call of the FMU is not waited for any more (default: %(default)g)",
    )
    check.add_argument(
        "--budget",
        metavar="S",
        type=float,
        default=20.0,
        help="with --deep: seconds after which a rule is left with a note on what it has found (default: %(default)g); "
        "the first run may take as long as it needs",
    )
    add_settings(
        check,
        "with --deep: start values of the run, e.g. fidelity=2; without, an FMU of several levels runs at its cheapest",
    )
    cosim = commands.add_parser("cosim", help="simulate a system of FMUs, anybody's")
    cosim_command.add_arguments(cosim)
    cosim.set_defaults(command=cosim_command.run)
    return parser


def _add_scene(command: argparse.ArgumentParser) -> None:
    """What says which contact it is and where the results go."""
    command.add_argument("scene", metavar="NAME", help="what is shipped (`tribofmu list`), or the path of a .toml file")
    command.add_argument("--out", metavar="DIR", help="folder of the results (default: results/NAME)")
    command.add_argument("--grid", metavar="N", help="nodes along x and y, instead of film.points")
    add_settings(command, "change values of it, e.g. tribofilm.model=none surface_2.rq='50 nm'")


def _list(arguments: argparse.Namespace) -> int:
    shipped = shipped_scenes() | machine_files.shipped()
    width = max(map(len, shipped))
    for name, description in shipped.items():
        print(f"{name:{width}}  {description}")
    return 0


def _run(arguments: argparse.Namespace) -> int:
    from .checkpoint import alone

    if machine_files.is_machine(arguments.scene):
        return machine_command.run(arguments)
    _check_name(arguments.scene)
    if arguments.ssp is not None:
        raise ContactError(f"'{arguments.scene}' is one contact, not a machine. Export it with `tribofmu build`.")
    scene, duty = _contact(arguments)
    folder = output_folder(arguments.out, Path(arguments.scene).stem)
    _warn(scene)
    with alone(folder):
        return _run_in(folder, scene, duty, arguments.resume)


def _check_name(name: str) -> None:
    """Raise ContactError if nothing that is shipped is called so, and it is no file."""
    shipped = [*shipped_scenes(), *machine_files.shipped()]
    if not name.endswith(".toml") and name not in shipped:
        raise ContactError(
            f"There is no scene or machine '{name}'.{did_you_mean(name, shipped)} Shipped are {', '.join(shipped)}; or "
            "give the path of a .toml file."
        )


def _contact(arguments: argparse.Namespace) -> "tuple[Scene, Duty]":
    """The scene, large enough for its duty, and the duty."""
    from .duty import Duty

    scene = Scene.from_toml(arguments.scene, _overrides(arguments))
    duty = Duty.of_scene(scene, _folder_of_duty(arguments))
    return duty.sized(scene), duty


def _warn(scene: Scene) -> None:
    for warning in scene.warnings():
        print(f"tribofmu: warning: {warning}", file=sys.stderr)


def _run_in(folder: Path, scene: Scene, duty: "Duty", resume: bool) -> int:
    checkpoint = _checkpoint(folder, scene, duty, resume)
    if resume and not checkpoint.saved and (code := _finished(folder, scene, duty)) is not None:
        return code
    try:
        code = _report(_simulate(scene, duty, checkpoint), scene, duty, folder)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(_how_to_go_on(checkpoint)) from None
    except StateError:
        raise
    except ContactError as error:
        raise ContactError(f"{error} {_how_to_go_on(checkpoint)}".rstrip()) from error
    checkpoint.remove()
    return code


def _checkpoint(folder: Path, scene: Scene, duty: "Duty", resume: bool) -> "Checkpoint":
    """Where the run goes on from, if it can and shall, said on stderr."""
    from .checkpoint import Checkpoint, identity

    run = identity(scene, duty)
    if not resume:
        checkpoint = Checkpoint(folder, run)
        if checkpoint.file.exists():
            note(f"'{checkpoint.file}' of an unfinished run will be replaced; to go on from it, use --resume.")
        return checkpoint
    checkpoint = Checkpoint.resume(folder, run)
    if checkpoint.saved:
        note(f"Going on from '{checkpoint.file}' at {checkpoint.saved.time / 60.0:.1f} min.")
    return checkpoint


def _finished(folder: Path, scene: Scene, duty: "Duty") -> int | None:
    """The exit code of this very run if its result is there already."""
    from . import report, results

    dataset = results.find(folder, scene, duty)
    if dataset is None:
        note(f"There is no checkpoint in '{folder}': the run starts from the beginning.")
        return None
    note(f"This run is finished, its result is in '{folder}'. Leave out --resume to compute it again.")
    return 1 if report.invalid_rows(dataset) else 0


def _how_to_go_on(checkpoint: "Checkpoint") -> str:
    if not checkpoint.count:
        return ""
    return f"What was computed is kept in '{checkpoint.file}': the same command with --resume goes on from there."


def _report(dataset: "xr.Dataset", scene: Scene, duty: "Duty", folder: Path) -> int:
    """Print and write the result; return the exit code."""
    from . import report, results

    dataset = results.with_scene(dataset, scene, duty)
    print(scene.description, report.table(dataset), *report.closing_lines(dataset), sep="\n")
    written = [*results.write(dataset, folder), report.write_overview(dataset, folder / "overview.png")]
    print(f"Written: {', '.join(map(str, written))}")
    return 1 if report.invalid_rows(dataset) else 0


def _overrides(arguments: argparse.Namespace) -> dict[str, str]:
    for option in ("hours", "grid", "duty", "out"):
        if getattr(arguments, option, None) == "":
            raise ContactError(f"--{option} is empty. Give a value, or leave --{option} out.")
    settings = dict(arguments.settings)
    if getattr(arguments, "hours", None):
        settings["operation.duration"] = f"{arguments.hours} h"
    if arguments.grid:
        settings["film.points"] = arguments.grid
    if getattr(arguments, "duty", None):
        settings["operation.file"] = arguments.duty
    return settings


def _folder_of_duty(arguments: argparse.Namespace) -> Path:
    """A path on the command line starts at the working folder, one in a scene's file at that file."""
    if getattr(arguments, "duty", None) or not arguments.scene.endswith(".toml"):
        return Path()
    return Path(arguments.scene).parent


def _simulate(scene: Scene, duty: "Duty", checkpoint: "Checkpoint") -> "xr.Dataset":
    """Build the FMU and drive it, with a progress bar in minutes of test time."""
    from tqdm import tqdm
    from tqdm.contrib.logging import logging_redirect_tqdm

    from fmu_src.package.build import build

    from .driven_contact import run

    logging.basicConfig(format="%(message)s")
    bar = tqdm(
        total=scene.operation.duration / 60.0,
        initial=checkpoint.saved.time / 60.0 if checkpoint.saved else 0.0,
        desc=scene.name,
        bar_format="{desc} {percentage:3.0f} %|{bar}| {n:.1f}/{total:.1f} min [{elapsed}<{remaining}]",
    )
    with tempfile.TemporaryDirectory(prefix="tribofmu-") as folder, bar, logging_redirect_tqdm():
        fmu = build(scene, Path(folder) / f"{scene.name}.fmu", "embedded")
        return run(
            fmu,
            duty,
            scene.operation.duration,
            scene.operation.interval,
            lambda time: bar.update(time / 60.0 - bar.n),
            checkpoint,
        )


def _stribeck(arguments: argparse.Namespace) -> int:
    from .checkpoint import alone
    from .stribeck import Curves, Plan

    scene, duty = _contact(arguments)
    plan = Plan.of(
        duty,
        _rubbing_times(arguments.times),
        _plain_or_with_unit("--fastest", arguments.fastest, "m/s"),
        _plain_or_with_unit("--slowest", arguments.slowest, "m/s"),
        arguments.points,
        None if arguments.srr is None else _plain_or_with_unit("--srr", arguments.srr, ""),
    )
    folder = output_folder(arguments.out, Path(arguments.scene).stem)
    _warn(scene)
    curves = Curves(plan)
    with alone(folder):
        try:
            _sweep(scene, duty, curves)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(_kept(scene, duty, curves, folder)) from None
        except ContactError as error:
            raise ContactError(f"{error} {_kept(scene, duty, curves, folder)}".rstrip()) from error
        return _report_curves(scene, duty, curves, folder)


def _rubbing_times(words: Sequence[str]) -> list[float]:
    """Minutes, apart from each other by commas or spaces, in seconds."""
    try:
        return [60.0 * float(word) for word in re.split(r"[,\s]+", " ".join(words)) if word]
    except ValueError:
        raise ContactError(f"--times = '{' '.join(words)}' must be numbers of minutes, such as 0,5,30.") from None


def _plain_or_with_unit(option: str, text: str, unit: str) -> float:
    with suppress(ValueError):
        text = f"{float(text)!r} {unit}"
    return units.parse(text, unit, option)


def _sweep(scene: Scene, duty: "Duty", curves: "Curves") -> None:
    """Measure the curves, with a progress bar in points."""
    from tqdm import tqdm
    from tqdm.contrib.logging import logging_redirect_tqdm

    from .stribeck import measure

    logging.basicConfig(format="%(message)s")
    bar = tqdm(
        total=len(curves.plan.times) * len(curves.plan.speeds),
        desc=scene.name,
        bar_format="{desc} {percentage:3.0f} %|{bar}| {n}/{total} points [{elapsed}<{remaining}]",
    )

    def show(stage: str, count: int) -> None:
        bar.set_description_str(f"{scene.name}, {stage}", refresh=False)
        bar.update(count - bar.n)
        bar.refresh()

    with bar, logging_redirect_tqdm():
        measure(scene, duty, curves, show)


def _kept(scene: Scene, duty: "Duty", curves: "Curves", folder: Path) -> str:
    """Write what there is of curves that are not finished, and say so."""
    if not curves.count:
        return ""
    from .results import write

    netcdf, _ = write(curves.dataset(scene, duty), folder, "stribeck")
    return f"The {curves.count} points measured so far are in '{netcdf}'."


def _report_curves(scene: Scene, duty: "Duty", curves: "Curves", folder: Path) -> int:
    """Print and write the curves; return the exit code."""
    from . import results, stribeck_report

    dataset = curves.dataset(scene, duty)
    print(scene.description, stribeck_report.table(dataset), sep="\n")
    print(*stribeck_report.shift_lines(dataset), *stribeck_report.closing_lines(dataset), sep="\n")
    written = results.write(dataset, folder, "stribeck")
    written.append(stribeck_report.write_figure(dataset, folder / "stribeck.png"))
    print(f"Written: {', '.join(map(str, written))}")
    return 1 if stribeck_report.invalid_points(dataset) else 0


def _check(arguments: argparse.Namespace) -> int:
    from .check import report
    from .check.package import opened

    if arguments.settings and not arguments.deep:
        raise ContactError("--set gives start values of a run of the FMU: add --deep.")
    found = []
    with opened(arguments.fmu) as package:
        for finding in report.findings(package, arguments.deep, arguments.limit, arguments.budget, arguments.settings):
            print(report.line(finding), flush=True)
            found.append(finding)
    print(f"{arguments.fmu}: {report.summary(found)}.")
    return report.exit_code(found)


if __name__ == "__main__":
    sys.exit(main())
