"""The command `tribofmu cosim`: simulates a system of FMUs from a TOML file, or exports it."""

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contact_core.errors import ContactError

from .console import add_settings, note, output_folder
from .overwriting import add_force, refuse_existing

if TYPE_CHECKING:
    import xarray as xr

    from ..master import System
    from ..runs import Finished


def add_arguments(parser: argparse.ArgumentParser) -> None:
    text = "FMUs, their connections and options of the simulation"
    parser.add_argument("system", metavar="SYSTEM.toml", type=Path, help=text)
    parser.add_argument("--out", metavar="DIR", help="folder of the results (default: results/SYSTEM)")
    add_force(parser)
    add_settings(
        parser, "change parameters and settings of the file, e.g. parameters.block.m=2 simulate.step_size='1 ms'"
    )
    instead = parser.add_mutually_exclusive_group()
    instead.add_argument(
        "--resume",
        action="store_true",
        help="continue from the checkpoint that a killed, interrupted or failed simulation has left in DIR, to the "
        "same result, bit for bit; start from the beginning if there is none. Without --resume a simulation starts "
        "from the beginning and replaces the checkpoint.",
    )
    instead.add_argument("--ssp", metavar="FILE.ssp", help="export the system as SSP 1.0, do not simulate it")


def run(arguments: argparse.Namespace) -> int:
    """Carry out the command; return 0, or 1 if steps are less accurate than asked, or rows are invalid.

    Raises ContactError with a sentence if it cannot be done.
    """
    from ..master.reading import read
    from ..runs.job import carry_out
    from .listener import CONSOLE

    system, settings = read(arguments.system, arguments.settings)
    if arguments.ssp:
        refuse_existing([Path(arguments.ssp)], arguments.force)
        return _export(system, arguments.ssp, settings)
    for key in ("stop_time", "step_size"):
        if key not in settings:
            raise ContactError(
                f"'{arguments.system}' does not say simulate.{key}. Add it, or --set simulate.{key}=VALUE."
            )
    if "outputs" not in settings and (left_out := system.left_out()):
        names = ", ".join(left_out)
        note(f"Not recorded: {names}, which are no numbers, or too many. simulate.outputs can name texts.")
    folder = output_folder(arguments.out, arguments.system.stem)
    given = {"resume": arguments.resume, "force": arguments.force, "listener": CONSOLE}
    return carry_out(system, settings, arguments.system.stem, folder, _report, **given).exit_code


def _export(system: "System", path: str, settings: Mapping[str, Any]) -> int:
    from ..master import export_ssp

    left_out = [name for name in ("events", "bonds", "derivatives") if getattr(system, name)]
    if left_out:
        note(f"SSP has no place for {', '.join(left_out)}: importers do not learn of them.")
    print(f"Written: {export_ssp(system, path, settings.get('stop_time'), settings.get('step_size'))}")
    return 0


def _report(dataset: "xr.Dataset", folder: Path) -> "Finished":
    """Print and write the result."""
    from ..charts import files
    from ..run import cosim_report
    from ..runs.job import EXIT_CODE, Finished
    from ..store import results

    print(cosim_report.table(dataset), "", cosim_report.costs(dataset), "", sep="\n")
    print(*cosim_report.closing_lines(dataset), *cosim_report.validity(dataset), sep="\n")
    wrong = bool(cosim_report.unreliable_steps(dataset) or dataset.attrs["invalid"])
    dataset = dataset.assign_attrs({EXIT_CODE: int(wrong)})
    written = [*results.write(dataset, folder), *files.write({"overview": cosim_report.overview(dataset)}, folder)]
    print(f"Written: {', '.join(map(str, written))}")
    return Finished(dataset, folder, not wrong, tuple(map(Path, written)))
