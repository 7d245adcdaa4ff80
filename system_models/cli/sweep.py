"""The command `tribofmu sweep`: runs a scene with many values of some of its keys."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from contact_core.errors import ContactError

from .console import add_settings, note, output_folder
from .map import executor_arguments, processes_of
from .overwriting import add_force
from .progress import counted
from .scenes import refuse_machine

if TYPE_CHECKING:
    import xarray as xr

    from ..sweep.plan import Plan
    from ..sweep.points import Outcome, Task


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", metavar="NAME", help="a shipped scene (`tribofmu list`), or the path of a .toml file")
    parser.add_argument(
        "--vary",
        metavar="KEY=VALUES",
        nargs="+",
        action="extend",
        default=[],
        help="a key of the scene and its values: LOW:HIGH:N for N even steps, with :log behind for even steps of the "
        "logarithm; A,B,... for a choice; LOW:HIGH for a range that samples fill. All grids and choices are crossed",
    )
    parser.add_argument("--samples", metavar="N", type=int, help="samples in all ranges LOW:HIGH together")
    parser.add_argument(
        "--method",
        choices=("lhs", "sobol", "indices"),
        default="lhs",
        help="Latin hypercube; Sobol's sequence; or Sobol indices of the outputs, which take N (keys + 2) runs "
        "(default: %(default)s)",
    )
    parser.add_argument("--seed", metavar="S", type=int, default=1, help="of the samples (default: %(default)s)")
    parser.add_argument("--out", metavar="DIR", help="folder of the results (default: results/NAME_sweep)")
    executor_arguments(parser, "runs")
    add_force(parser)
    add_settings(parser, "change values of the scene at every point, e.g. film.model=regression")


def run(arguments: argparse.Namespace) -> int:
    """Run, print and write the sweep; return the exit code."""
    refuse_machine(arguments.scene)
    note(f"Loading '{arguments.scene}'.")
    from ..runs.replacing import ask_before
    from ..store.checkpoint import alone
    from ..sweep.plan import plan_of
    from ..sweep.points import Task, origin_of
    from .listener import CONSOLE

    plan = plan_of(arguments.vary, arguments.samples, arguments.method, arguments.seed)
    if plan.method == "indices" and plan.grid:
        keys = ", ".join(factor.key for factor in plan.grid)
        raise ContactError(f"--method indices varies ranges alone: give {keys} as LOW:HIGH, or by --set.")
    if both := {factor.key for factor in plan.factors} & dict(arguments.settings).keys():
        raise ContactError(f"{', '.join(sorted(both))}: --vary and --set give it. Keep one of the two.")
    folder = output_folder(arguments.out, f"{Path(arguments.scene).stem}_sweep")
    duty = Path(arguments.scene).parent if arguments.scene.endswith(".toml") else Path()
    task = Task(
        arguments.scene, tuple(arguments.settings), duty, output_folder(str(folder / "points"), ""), arguments.force
    )
    with alone(folder):
        ask_before(folder, origin_of(task, plan), arguments.force, CONSOLE, "sweep")
        outcomes = solved_with_bar(task, plan, processes_of(arguments.processes), arguments.executor)
        return _report(task, plan, outcomes, folder)


def solved_with_bar(task: "Task", plan: "Plan", processes: int, executor: str | None) -> "dict[int, Outcome]":
    """Run the points, with a counter of them."""
    from math import prod

    from ..sweep.points import solved

    try:
        with counted(Path(task.scene).stem, "runs", prod(plan.shape)) as show:
            return solved(task, plan, processes, executor, show)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"Runs are kept in '{task.folder}': the same command goes on from there.") from None


def _report(task: "Task", plan: "Plan", outcomes: "dict[int, Outcome]", folder: Path) -> int:
    """Print and write the sweep; return the exit code."""
    from ..charts import files
    from ..store.results import write
    from ..sweep import report
    from ..sweep.points import ends, gathered, rows, scene_at
    from ..sweep.sensitivity import indices

    dataset = gathered(task, plan, outcomes)
    found = indices(plan, ends(dataset), report.OUTPUTS) if plan.method == "indices" else []
    said = report.lines(plan, dataset, found, lambda point: scene_at(task, point)[0])
    print(dataset.attrs["title"], report.table(plan, dataset), *said, sep="\n")
    netcdf = write(dataset, folder, "sweep", table=rows(plan, dataset))
    netcdf += _means(plan, dataset, folder)
    netcdf.append(files.save(report.sheet(plan, dataset), folder / "sweep.png", dpi=120))
    print(f"Written: {', '.join(map(str, netcdf))}")
    refused = any(outcome.refused for outcome in outcomes.values())
    return 1 if refused or not bool(dataset["valid"].values.all()) else 0


def _means(plan: "Plan", dataset: "xr.Dataset", folder: Path) -> list[Path]:
    """Write means and bands over patches of a surface, if the plan has some."""
    from ..store.results import write_csv
    from ..sweep import ensemble, report
    from ..sweep.points import ends

    if not ensemble.patches_of(plan):
        return []
    return [write_csv(ensemble.averaged(plan, ends(dataset), report.OUTPUTS), folder / "patches.csv")]
