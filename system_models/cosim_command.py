"""The command `tribofmu cosim`: simulates a system of FMUs from a TOML file, or exports it. Light to import."""

import argparse
import json
import logging
from collections.abc import Callable, Mapping
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Any

from contact_core.errors import ContactError, StateError

from .console import add_settings, note, output_folder

if TYPE_CHECKING:
    import xarray as xr

    from .master import System

EXIT_CODE = "exit_code"  # of the run, as an attribute of its result


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What `run` wants to know."""
    parser.add_argument("system", metavar="SYSTEM.toml", type=Path, help="FMUs, their connections and how to simulate")
    parser.add_argument("--out", metavar="DIR", help="folder of the results (default: results/SYSTEM)")
    add_settings(
        parser, "change parameters and settings of the file, e.g. parameters.block.m=2 simulate.step_size='1 ms'"
    )
    instead = parser.add_mutually_exclusive_group()
    instead.add_argument(
        "--resume",
        action="store_true",
        help="go on from the checkpoint that a killed, interrupted or failed simulation has left in DIR, to the same "
        "result, bit for bit; start from the beginning if there is none (without --resume always, and replace it)",
    )
    instead.add_argument("--ssp", metavar="FILE.ssp", help="export the system as SSP 1.0, do not simulate it")


def run(arguments: argparse.Namespace) -> int:
    """Do what the command line asks for; return 0, or 1 if some steps have missed a tolerance.

    Raises ContactError with a sentence if it cannot be done.
    """
    from .master.reading import read

    system, settings = read(arguments.system, arguments.settings)
    if arguments.ssp:
        return _export(system, arguments.ssp, settings)
    for key in ("stop_time", "step_size"):
        if key not in settings:
            raise ContactError(
                f"'{arguments.system}' does not say simulate.{key}. Add it, or --set simulate.{key}=VALUE."
            )
    folder = output_folder(arguments.out, arguments.system.stem)
    return carry_out(system, settings, arguments.system.stem, folder, arguments.resume, _report)


def carry_out(
    system: "System",
    settings: Mapping[str, Any],
    name: str,
    folder: Path,
    resume: bool,
    report: Callable[["xr.Dataset", Path], int],
    **attributes: str,
) -> int:
    """Simulate with a checkpoint in the folder and hand the result to `report`, whose exit code is returned.

    With `resume` go on from the checkpoint; if there is none, but the result of this very simulation, leave that. The
    settings are the arguments of `master.simulate`. `report` writes the result with its exit code as the attribute
    EXIT_CODE; `attributes` are others of it that tell it from results of another kind.
    """
    origin = _origin(system, settings, name) | attributes
    checkpoint = _checkpoint(folder, system, settings, resume)
    go_on = resume and checkpoint is not None and checkpoint.exists()
    if resume and not go_on and (code := _finished(folder, origin)) is not None:
        return code
    begin = monotonic()
    dataset = _simulated(system, settings, name, checkpoint, go_on)
    if not go_on:
        dataset.attrs["wall_seconds"] = monotonic() - begin
    code = report(dataset.assign_attrs(origin), folder)
    _remove_checkpoint(folder)
    return code


def _export(system: "System", path: str, settings: Mapping[str, Any]) -> int:
    from .master import export_ssp

    left_out = [name for name in ("events", "bonds", "derivatives") if getattr(system, name)]
    if left_out:
        note(f"SSP has no place for {', '.join(left_out)}: importers do not learn of them.")
    print(f"Written: {export_ssp(system, path, settings.get('stop_time'), settings.get('step_size'))}")
    return 0


def _origin(system: "System", settings: Mapping[str, Any], name: str) -> dict[str, str]:
    """What decides the result, for its attributes."""
    from .master.saving import identity

    return {"title": name, "simulation_json": json.dumps(identity(system, settings))}


def _checkpoint(folder: Path, system: "System", settings: Mapping[str, Any], resume: bool) -> Path | None:
    """The file where the simulation stores the point it has reached, if its FMUs can be stored."""
    from .checkpoint import Checkpoint
    from .master import CouplingError
    from .master.saving import check

    file = Checkpoint(folder, {}).file
    try:
        check(system, system.outputs(settings.get("outputs")))
    except CouplingError as error:
        if resume:
            raise
        note(f"There will be no checkpoint. {error}")
        return None
    if file.exists() and not resume:
        note(f"'{file}' of an unfinished run will be replaced; to go on from it, use --resume.")
    if file.exists() and resume:
        note(f"Going on from '{file}'.")
    return file


def _finished(folder: Path, origin: Mapping[str, str]) -> int | None:
    """The exit code of this very simulation if its result is there already."""
    from . import results

    dataset = results.find_by(origin, folder)
    if dataset is None:
        note(f"There is no checkpoint in '{folder}': the simulation starts from the beginning.")
        return None
    note(f"This simulation is finished, its result is in '{folder}'. Leave out --resume to compute it again.")
    return int(dataset.attrs.get(EXIT_CODE, 0))


def _simulated(
    system: "System", settings: Mapping[str, Any], name: str, checkpoint: Path | None, resume: bool
) -> "xr.Dataset":
    """Simulate, with a progress bar in seconds; what ends it early says how to go on."""
    from tqdm import tqdm
    from tqdm.contrib.logging import logging_redirect_tqdm

    from .master import simulate

    logging.basicConfig(format="%(message)s")
    bar = tqdm(
        total=settings["stop_time"],
        desc=name,
        bar_format="{desc} {percentage:3.0f} %|{bar}| {n:.4g}/{total:.4g} s [{elapsed}<{remaining}]",
    )
    folder, before = checkpoint and checkpoint.parent, _stamp(checkpoint)

    def how_to_go_on() -> str:
        if _stamp(checkpoint) == before and not resume:
            return ""
        return f"What was computed is kept in '{checkpoint}': the same command with --resume goes on from there."

    try:
        with bar, logging_redirect_tqdm():
            return simulate(
                system,
                **settings,
                checkpoint=folder,
                resume=resume,
                progress=lambda time: bar.update(time - bar.n),
            )
    except KeyboardInterrupt:
        raise KeyboardInterrupt(how_to_go_on()) from None
    except StateError:
        raise
    except ContactError as error:
        raise ContactError(f"{error} {how_to_go_on()}".rstrip()) from error


def _stamp(file: Path | None) -> int | None:
    """When a file was written, if it is there."""
    return file.stat().st_mtime_ns if file is not None and file.exists() else None


def _report(dataset: "xr.Dataset", folder: Path) -> int:
    """Print and write the result; return the exit code."""
    from . import cosim_report, results

    print(cosim_report.table(dataset), "", cosim_report.costs(dataset), "", sep="\n")
    print(*cosim_report.closing_lines(dataset), sep="\n")
    code = 1 if cosim_report.missed_steps(dataset) else 0
    dataset = dataset.assign_attrs({EXIT_CODE: code})
    written = [*results.write(dataset, folder), cosim_report.write_overview(dataset, folder / "overview.png")]
    print(f"Written: {', '.join(map(str, written))}")
    return code


def _remove_checkpoint(folder: Path) -> None:
    from .checkpoint import Checkpoint

    Checkpoint(folder, {}).remove()
