"""Reference results that an FMU carries, replayed."""

import csv
import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from fmpy.fmi1 import FMICallException

from ..fmu.archive import parsed
from ..fmu.kinds import kind
from .instance import Fmu
from .related import MANIFEST, located, related
from .variables import is_readable, magnitude
from .verdict import Answer, failed, not_applicable, noted, passed, some

_TOLERANCE = 1e-3  # of reference results that state none
_RELATIVE_TOLERANCE = re.compile(r"^\s*RelTol\W+([\d.eE+-]+)", re.MULTILINE)
_TRUTH = {"true": 1.0, "false": 0.0}


class _Recorded(NamedTuple):
    """Results of a run, its inputs, and the difference that is allowed, relative to the largest value."""

    results: Path
    stimuli: Path | None
    tolerance: float
    told: bool  # the FMU says how they came about: inputs that are not named were not changed


def reference(fmu: Fmu, notebook: Path) -> Answer:
    """Check that the reference results that the FMU carries are reproduced."""
    fmu.start = {}  # they are of the FMU as it is
    records = list(_records(fmu.folder))
    if not records:
        return not_applicable("There are no reference results: neither *ref.csv nor any that fmi-ls-ref names.")
    compared, different = 0, []
    for record in records:
        try:
            count, wrong = _compared(fmu, record)
        except FMICallException:
            count, wrong = 0, f"{fmu.fault}."
        if wrong and record.told:
            return failed(wrong)
        compared += count
        fmu.progress = f"{compared} values have come out again"
        different += [wrong] if wrong else []
    if different:
        return noted(f"{different[0]} Its manifest names no experiment, so that inputs and steps may have been others.")
    if not compared:
        return not_applicable("The reference results hold no single numbers, which alone are compared here.")
    files = some([record.results.name for record in records])
    return passed(f"{compared} values of {files} come out again within their tolerance.")


def _records(folder: Path) -> Iterator[_Recorded]:
    """Yield the results of experiments, those named *ref.csv, and those that the manifest names alone."""
    manifest = folder / MANIFEST
    roles = related(parsed(manifest.read_bytes())) if manifest.exists() else {}
    there = {folder / name: role for name, role in roles.items() if (folder / name).is_file()}
    known = set()
    for file in sorted({*folder.rglob("*.exp"), *(f for f, role in there.items() if role == "experiment")}):
        for record in _of_experiments(folder, file):
            known.add(record.results)
            yield record
    for file in sorted({*folder.rglob("*ref.csv")} - known):
        known.add(file)
        held = file.with_name(file.name.removesuffix("ref.csv") + "in.csv")
        yield _Recorded(file, held if held.exists() else None, _tolerance(file), told=True)
    for file, role in there.items():
        if role == "result" and file.suffix == ".csv" and file not in known:
            yield _Recorded(file, None, _TOLERANCE, told=False)


def _of_experiments(folder: Path, file: Path) -> Iterator[_Recorded]:
    """Yield the results of each experiment in a file."""
    for experiment in parsed(file.read_bytes()).iter("Experiment"):
        named = {
            tag: [folder / path for e in experiment.iter(tag) if (path := _beside(folder, file, e.get("source", "")))]
            for tag in ("References", "Stimuli")
        }
        tolerance = float(experiment.get("tolerance", _TOLERANCE))
        for results in named["References"]:
            yield _Recorded(results, next(iter(named["Stimuli"]), None), tolerance, told=True)


def _beside(folder: Path, document: Path, source: str) -> str:
    """Return the path in the FMU of a table that a document names; an empty text if there is none."""
    path = located(document.relative_to(folder).as_posix(), source)
    return path if path and (folder / path).is_file() else ""


def _tolerance(file: Path) -> float:
    """Return the relative tolerance of results that no experiment names: RelTol in their .opt."""
    options = file.with_suffix(".opt")
    stated = _RELATIVE_TOLERANCE.search(options.read_text("utf-8")) if options.exists() else None
    return float(stated[1]) if stated else _TOLERANCE


def _compared(fmu: Fmu, record: _Recorded) -> tuple[int, str]:
    """Return how many values have come out again, and the first difference, as a sentence."""
    results = _table(fmu, record.results)
    stimuli = _table(fmu, record.stimuli) if record.stimuli else _Table([], [], [], [])
    if unknown := sorted({*results.unknown, *stimuli.unknown}):
        files = " or ".join(file.name for file in (record.results, record.stimuli) if file)
        return 0, f"{files} names {some(unknown)}, which are no variables of the FMU."
    allowed = _allowed(fmu, results, record.tolerance)
    for time, row, wanted in zip(results.times, _replayed(fmu, results, stimuli), results.rows, strict=True):
        for name, value in wanted.items():
            if not abs(row[name] - value) <= allowed[name]:
                file = record.results.name
                return 0, f"{name} is {row[name]!r} at {time:g} s; {file} has {value!r} +- {allowed[name]:.2g}."
    return len(results.rows) * len(results.names), ""


class _Table(NamedTuple):
    names: list[str]  # of numbers and Booleans: others are not compared
    unknown: list[str]
    times: list[float]  # s
    rows: list[dict[str, float]]


def _table(fmu: Fmu, file: Path) -> _Table:
    """Read a CSV with a header; its first column is the time."""
    with file.open(newline="", encoding="utf-8") as stream:
        head, *lines = [line for line in csv.reader(stream) if line]
    columns = [name.strip() for name in head]
    known = {name: v for name in columns[1:] if (v := fmu.variables.get(name)) is not None}
    names = [name for name, v in known.items() if is_readable(v) and kind(v) != "string"]
    cells = [dict(zip(columns, line, strict=True)) for line in lines]
    rows = [{name: _number(row[name]) for name in names} for row in cells]
    return _Table(names, [n for n in columns[1:] if n not in known], [float(line[0]) for line in lines], rows)


def _number(cell: str) -> float:
    text = cell.strip().lower()
    return _TRUTH[text] if text in _TRUTH else float(text)


def _allowed(fmu: Fmu, results: _Table, rtol: float) -> dict[str, float]:
    """Return allowed differences: a tolerance times a column's largest magnitude, or times the nominal if all is 0."""
    largest = {name: max(abs(row[name]) for row in results.rows) for name in results.names}
    return {name: rtol * (size or magnitude(fmu.variables[name])) for name, size in largest.items()}


def _replayed(fmu: Fmu, results: _Table, stimuli: _Table) -> Iterator[dict[str, float]]:
    """Return the variables at the times of `results`; inputs hold from row to row, parameters start as they do."""
    fmu.start_time = results.times[0]

    def inputs(time: float) -> dict[str, float]:
        past = [row for change, row in zip(stimuli.times, stimuli.rows, strict=True) if change <= time]
        return past[-1] if past else {}

    def outputs() -> dict[str, float]:
        return {name: float(value) for name, value in instance.read(results.names).items()}

    with fmu.instance() as instance:
        instance.initialise(inputs(results.times[0]))
        yield outputs()
        for begin, end in pairwise(results.times):
            instance.step(end - begin, inputs(begin))
            yield outputs()
