"""Reference results that an FMU carries, replayed."""

import csv
import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from lxml import etree

from .instance import Fmu
from .variables import magnitude
from .verdict import Answer, failed, not_applicable, passed, some

_TOLERANCE = 1e-3  # of reference results that state none
_RELATIVE_TOLERANCE = re.compile(r"^\s*RelTol\W+([\d.eE+-]+)", re.MULTILINE)
_TRUTH = {"true": 1.0, "false": 0.0}


def reference(fmu: Fmu, notebook: Path) -> Answer:
    """Check that the reference results that the FMU carries are reproduced."""
    fmu.start = {}  # they are of the FMU as it is
    files = sorted(fmu.folder.rglob("*ref.csv"))
    if not files:
        return not_applicable("There are no reference results (*ref.csv) in the FMU.")
    compared = 0
    for file in files:
        results = _table(file)
        held = file.with_name(file.name.removesuffix("ref.csv") + "in.csv")
        stimuli = _table(held) if held.exists() else _Table([], [], [])
        unknown = sorted({*results.names, *stimuli.names} - set(fmu.variables))
        if unknown:
            return failed(f"{file.name} or {held.name} names {some(unknown)}, which are no variables of the FMU.")
        allowed = _allowed(fmu, results, _tolerance(file))
        for time, row, wanted in zip(results.times, _replayed(fmu, results, stimuli), results.rows, strict=True):
            for name, value in wanted.items():
                if not abs(row[name] - value) <= allowed[name]:
                    return failed(
                        f"{name} is {row[name]!r} at {time:g} s; {file.name} has {value!r} +- {allowed[name]:.2g}."
                    )
                compared += 1
            fmu.progress = f"{compared} values have come out again"
    return passed(f"{compared} values of {some([file.name for file in files])} come out again within their tolerance.")


class _Table(NamedTuple):
    names: list[str]
    times: list[float]  # s
    rows: list[dict[str, float]]


def _table(file: Path) -> _Table:
    """Read a CSV with a header; its first column is the time."""
    with file.open(newline="", encoding="utf-8") as stream:
        head, *lines = [line for line in csv.reader(stream) if line]
    names = [name.strip() for name in head[1:]]
    rows = [{n: _number(cell) for n, cell in zip(names, line[1:], strict=True)} for line in lines]
    return _Table(names, [float(line[0]) for line in lines], rows)


def _number(cell: str) -> float:
    text = cell.strip().lower()
    return _TRUTH[text] if text in _TRUTH else float(text)


def _tolerance(file: Path) -> float:
    """Return the relative tolerance of reference results: of their experiment (fmi-ls-ref), or RelTol in their .opt."""
    for path in file.parent.glob("*.exp"):
        for experiment in etree.parse(path).iter("Experiment"):
            about = {element.get("source") for element in experiment.iter("References")}
            if file.name in about and "tolerance" in experiment.attrib:
                return float(experiment.get("tolerance"))
    options = file.with_suffix(".opt")
    stated = _RELATIVE_TOLERANCE.search(options.read_text("utf-8")) if options.exists() else None
    return float(stated[1]) if stated else _TOLERANCE


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
