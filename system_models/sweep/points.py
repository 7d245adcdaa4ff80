"""The runs of a sweep: one file for each point, so that a killed sweep continues; all of them as one Dataset."""

import json
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np
import xarray as xr

from contact_core.errors import ContactError
from contact_core.scene import Scene
from fmu_src.package.build import build

from ..run.contact import run
from ..run.duty import Duty, refuse_hidden
from ..run.origin import attributes
from ..run.workers import done_by, workers
from ..store.results import to_dataset, with_half_widths
from .plan import Factor, Plan, Point

_HEAD, _TIME = "head", "time"  # names in the file of a kept run that are no outputs


@dataclass(frozen=True)
class Task:
    """What is run at every point."""

    scene: str  # name, or path of a file
    settings: tuple[tuple[str, str], ...]  # of all points
    folder_of_duty: Path
    folder: Path  # of the files of the points
    force: bool = False  # run points that look like mistakes, too


@dataclass(frozen=True)
class Outcome:
    """A point that is done: the file of its run, or why there is none."""

    number: int
    refused: str = ""


def file_of(task: Task, number: int) -> Path:
    """Return the file of a point's run."""
    return task.folder / f"{number:06d}.npz"


def solve(task: Task, number: int, point: Point) -> Outcome:
    """Run the scene at a point and keep its result; a result that is there already is kept."""
    try:
        scene, duty = scene_at(task, point)
        doubts = [] if task.force else scene.doubts(duty.named(scene))
        if doubts:
            return Outcome(number, f"{' '.join(doubts)} If this is meant, add --force.")
        origin, file = attributes(scene, duty), file_of(task, number)
        before = kept(file)
        if before is not None and before.attrs == origin:
            return Outcome(number)
        fmu = build(scene, task.folder / f"{number:06d}.fmu", "embedded")
        try:
            found = run(fmu, duty, scene.operation.duration, scene.operation.interval)
        finally:
            fmu.unlink(missing_ok=True)
        keep(found, origin, file)
    except ContactError as error:
        return Outcome(number, str(error))
    return Outcome(number)


def scene_at(task: Task, point: Point) -> tuple[Scene, Duty]:
    """Return scene and duty of a point. Raises ContactError if the point has none."""
    changes = dict(task.settings) | point.settings
    scene = Scene.from_toml(task.scene, changes)
    refuse_hidden(scene, task.folder_of_duty, changes)
    duty = Duty.of_scene(scene, task.folder_of_duty)
    return duty.sized(scene), duty


def keep(found: xr.Dataset, origin: dict[str, Any], file: Path) -> None:
    """Write a run as a whole: a kill leaves no file or all of it. Arrays by name: netCDF takes as long as the run."""
    said = {str(name): [column.attrs["units"], column.attrs["long_name"]] for name, column in found.data_vars.items()}
    head = json.dumps({"origin": origin, "said": said})
    unfinished = file.with_suffix(".new")
    columns: dict[str, Any] = {str(name): column.values for name, column in found.data_vars.items()}
    columns |= {_HEAD: np.array(head), _TIME: found["time"].values}
    with unfinished.open("wb") as out:
        np.savez(out, **columns)
    unfinished.replace(file)


def kept(file: Path) -> xr.Dataset | None:
    """Return the run in a file, its origin as attributes; None if there is none that is whole."""
    try:
        with file.open("rb") as opened, np.load(opened) as arrays:
            columns = {name: arrays[name] for name in arrays.files}
    except (OSError, ValueError, BadZipFile):
        return None
    head = json.loads(str(columns.pop(_HEAD)))
    units, texts = ({name: said[k] for name, said in head["said"].items()} for k in (0, 1))
    return to_dataset(columns.pop(_TIME), columns, units, texts).assign_attrs(head["origin"])


def solved(
    task: Task, plan: Plan, processes: int, executor: str | None, progress: Callable[[int], None]
) -> dict[int, Outcome]:
    """Run all points, those that are kept from before apart; return them by number.

    `progress` is called with the number of points that are done. Raises ContactError if every one is refused.
    """
    found: dict[int, Outcome] = {}
    with workers(processes, executor) as given:
        tasks = ((task, number, point) for number, point in enumerate(plan.points()))
        with closing(done_by(given, solve, tasks)) as outcomes:
            for outcome in outcomes:
                found[outcome.number] = outcome
                progress(len(found))
    if all(outcome.refused for outcome in found.values()):
        raise ContactError(f"Every point is refused. The first: {found[0].refused}")
    return found


def gathered(task: Task, plan: Plan, outcomes: dict[int, Outcome]) -> xr.Dataset:
    """Return all runs as one Dataset: an axis for each key with choices, one of the samples, and time.

    Runs whose times differ are kept at their end alone. Where a point was refused, numbers are nan, `valid` is False
    and `refused` says why.
    """
    found = {number: kept(file_of(task, number)) for number, one in outcomes.items() if not one.refused}
    runs = {number: run for number, run in found.items() if run is not None}
    first = next(iter(runs.values()))
    alike = all(np.array_equal(run["time"].values, first["time"].values) for run in runs.values())
    runs = runs if alike else {number: run.isel(time=-1, drop=True) for number, run in runs.items()}
    first = next(iter(runs.values()))
    dims = (*(factor.key for factor in plan.grid), *(("sample",) if plan.sampled else ()))
    reasons = np.array([outcomes[number].refused for number in range(len(outcomes))], dtype=object)
    variables: dict[str, Any] = {
        str(name): (
            (*dims, *variable.dims),
            _stacked(str(name), runs, len(outcomes)).reshape(*plan.shape, *variable.shape),
            variable.attrs,
        )
        for name, variable in first.data_vars.items()
    }
    text = {"units": "1", "long_name": "why there is no run at this point"}
    variables["refused"] = (dims, reasons.astype(str).reshape(plan.shape), text)
    coordinates: dict[str, Any] = {factor.key: (factor.key, *_along(factor)) for factor in plan.grid}
    for factor, shares in zip(plan.sampled, plan.shares.T, strict=True):
        values = [float(factor.text(factor.at(float(share))).split(" ")[0]) for share in shares]
        coordinates[factor.key] = ("sample", values, {"units": factor.unit or "1"})
    if plan.sampled:
        coordinates["sample"] = ("sample", np.arange(len(plan.shares)), {"units": "1"})
    if alike:
        coordinates["time"] = first["time"]
    return with_half_widths(
        xr.Dataset(variables, coordinates, {"title": first.attrs["title"], **origin_of(task, plan)})
    )


def origin_of(task: Task, plan: Plan) -> dict[str, str]:
    """Return the identity of a sweep, as attributes of its Dataset."""
    given = " ".join(f"{key}={value}" for key, value in task.settings)
    return {"scene": task.scene, "method": plan.method, "vary": plan.text, "settings": given}


def rows(plan: Plan, dataset: xr.Dataset) -> xr.Dataset:
    """Return a sweep at the end of its runs, with all keys that are varied as variables."""
    return ends(dataset).reset_coords([factor.key for factor in plan.sampled])


def ends(dataset: xr.Dataset) -> xr.Dataset:
    """Return a sweep at the end of its runs."""
    return dataset.isel(time=-1) if "time" in dataset.dims else dataset


def _stacked(name: str, runs: dict[int, xr.Dataset], count: int) -> np.ndarray:
    """Return an output of all points, one after the other; what is missing is nan, or False."""
    some = next(iter(runs.values()))[name].values
    if some.dtype == bool:
        missing: np.ndarray = np.zeros_like(some)
    else:
        missing = np.full(some.shape, np.nan)
    return np.stack([runs[number][name].values if number in runs else missing for number in range(count)])


def _along(factor: Factor) -> tuple[Sequence[Any], dict[str, str]]:
    """Return the coordinate of a key with choices: numbers in their unit if all are numbers in one, else texts."""
    parts = [choice.partition(" ") for choice in factor.choices]
    try:
        numbers = [float(number) for number, _, _ in parts]
    except ValueError:
        return list(factor.choices), {"units": "1"}
    units = {unit for _, _, unit in parts}
    return (numbers, {"units": units.pop() or "1"}) if len(units) == 1 else (list(factor.choices), {"units": "1"})
