"""Runs of an FMU in a process of its own: python -m system_models.check.stages FOLDER STAGE NOTEBOOK.

A stage writes its answer to NOTEBOOK/answer.json; a stage without one has left files there for the next, which runs in
a new process. Every comparison is of bits.
"""

import csv
import ctypes
import gc
import json
import math
import re
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from fmpy.fmi1 import FMICallException
from lxml import etree

from .instance import Fmu, Instance, Row
from .variables import elsewhere, extremes, magnitude
from .verdict import Answer, failed, not_applicable, noted, passed, some

Stage = Callable[[Fmu, Path], Answer | None]

_STEPS = 3
_SETTLED, _CYCLES = 5, 20  # instances: until caches are full, and then
_LEAK = 10.0  # kB per instance that are worth a note
_SPLIT = 1e-3  # of the magnitude: a difference by the size of the step that is worth a note
_TOLERANCE = 1e-3  # of reference results that state none
_RELATIVE_TOLERANCE = re.compile(r"^\s*RelTol\W+([\d.eE+-]+)", re.MULTILINE)
_OTHER_GUID = "00000000-0000-0000-0000-000000000000"
_TRUTH = {"true": 1.0, "false": 0.0}


def _rows(fmu: Fmu, instance: Instance, first: int = 0) -> list[Row]:
    """Outputs after initialisation and after each of a few steps; inputs move on from number `first`."""
    rows = [instance.row()]
    for number in range(first, first + _STEPS):
        instance.step(inputs=fmu.stimulus(number))
        rows.append(instance.row())
    return rows


def _new_rows(fmu: Fmu, first: int = 0) -> list[Row]:
    with fmu.started() as instance:
        return _rows(fmu, instance, first)


def _difference(rows: list[Row], expected: list[Row]) -> str:
    """The first output that differs, with both values, or nothing."""
    for number, (row, wanted) in enumerate(zip(rows, expected, strict=True)):
        for name in wanted:
            if row[name] != wanted[name]:
                return f"{name} is {_shown(row[name])} instead of {_shown(wanted[name])} after {number} step(s)"
    return ""


def _shown(text: str) -> str:
    try:
        return repr(float.fromhex(text))
    except ValueError:
        return text


def run(fmu: Fmu, notebook: Path) -> Answer:
    """Instantiate, initialise, step, terminate, free."""
    with fmu.started() as instance:
        _rows(fmu, instance)
        instance.terminate()
    return passed(f"Instantiated, initialised, {_STEPS} steps of {fmu.step:g} s, terminated, freed.")


def guid(fmu: Fmu, notebook: Path) -> Answer:
    """The binary takes no description that is not its own."""
    try:
        instance = Instance(fmu, _OTHER_GUID)
    except Exception:  # fmpy's own, for a null pointer
        return passed("It refuses to be instantiated with another guid.")
    instance.free()
    return noted("It is instantiated with another guid, too: nothing shows that description and binary do not match.")


def finite(fmu: Fmu, notebook: Path) -> Answer:
    """No output is NaN or infinite."""
    with fmu.started() as instance:
        for number in range(_STEPS + 1):
            if broken := sorted(instance.broken()):
                return failed(f"{some(broken)} not finite after {number} step(s) at start values.")
            if number < _STEPS:
                instance.step()
    return passed(f"{len(fmu.outputs)} outputs after initialisation and {_STEPS} steps.")


def record(fmu: Fmu, notebook: Path) -> None:
    """First half of `replay`."""
    (notebook / "rows.json").write_text(json.dumps(_new_rows(fmu)))


def replay(fmu: Fmu, notebook: Path) -> Answer:
    """The same calls in another process give the same bits."""
    difference = _difference(_new_rows(fmu), json.loads((notebook / "rows.json").read_text()))
    if difference:
        return failed(f"The same calls in another process: {difference}.")
    return passed("The same calls in another process give the same bits.")


def rollback(fmu: Fmu, notebook: Path) -> Answer:
    """A state set twice gives the same steps twice."""
    if not fmu.capabilities.canGetAndSetFMUstate:
        return not_applicable("canGetAndSetFMUstate is false.")
    with fmu.started() as instance:
        instance.step(inputs=fmu.stimulus(1))
        saved = instance.save()
        expected = _onward(fmu, instance)
        for time in ("first", "second"):
            instance.restore(saved)
            difference = _difference(_onward(fmu, instance), expected)
            if difference:
                return failed(f"After the state was set the {time} time, {difference}: the state is not whole.")
        instance.forget(saved)
    return passed("A state set twice gives the same bits twice.")


def _onward(fmu: Fmu, instance: Instance) -> list[Row]:
    """Outputs as they stand, after a step with the inputs as they stand, and after one with others."""
    rows = [instance.row()]
    for inputs in ({}, fmu.stimulus(4)):
        instance.step(inputs=inputs)
        rows.append(instance.row())
    return rows


def save(fmu: Fmu, notebook: Path) -> Answer | None:
    """First half of `resume`."""
    if not fmu.capabilities.canSerializeFMUstate:
        return not_applicable("canSerializeFMUstate is false.")
    with fmu.started() as instance:
        instance.step(inputs=fmu.stimulus(1))
        (notebook / "state").write_bytes(instance.stored())
        (notebook / "rows.json").write_text(json.dumps([instance.time, _onward(fmu, instance)]))
    return None


def resume(fmu: Fmu, notebook: Path) -> Answer:
    """Bytes of a state, restored in another process, give the same steps."""
    data = (notebook / "state").read_bytes()
    time, expected = json.loads((notebook / "rows.json").read_text())
    with fmu.started() as instance:
        instance.resume(data, time)
        difference = _difference(_onward(fmu, instance), expected)
    if difference:
        return failed(f"Restored in another process, {difference}: the bytes do not hold the whole state.")
    return passed(f"{len(data)} bytes restored in another process give the same bits.")


def splitting(fmu: Fmu, notebook: Path) -> Answer:
    """A step in two halves ends where the whole one ends."""
    if not fmu.capabilities.canHandleVariableCommunicationStepSize:
        return not_applicable("canHandleVariableCommunicationStepSize is false.")
    with fmu.started() as instance:
        instance.step()
        whole, already = instance.outputs(), instance.broken()
    with fmu.started() as instance:
        instance.step(0.5 * fmu.step)
        instance.step(0.5 * fmu.step)
        halves, broken = instance.outputs(), sorted(instance.broken() - already)
    if broken:
        return failed(f"{some(broken)} not finite after two steps of {0.5 * fmu.step:g} s.")
    largest, name = 0.0, ""
    for variable in fmu.outputs:
        if variable.type == "Real" and variable.name not in already:
            size = max(magnitude(variable), abs(float(whole[variable.name])))
            largest, name = max((largest, name), (_distance(whole, halves, variable.name) / size, variable.name))
    if largest > _SPLIT:
        return noted(f"Two half steps move {name} by {largest:.2g} of its magnitude: choose the step with care.")
    return passed(f"Two half steps move no output by more than {largest:.2g} of its magnitude.")


def _distance(first: dict, second: dict, name: str) -> float:
    return abs(float(first[name]) - float(second[name]))


@contextmanager
def _again(fmu: Fmu, steps: int = 0) -> Iterator[Callable[[], Instance]]:
    """A way to get an instance at its start values, as often as wanted: set back, or reset where it cannot be.

    It has made so many steps.
    """
    with fmu.started() as instance:
        for _ in range(steps):
            instance.step()
        saved = instance.save() if fmu.capabilities.canGetAndSetFMUstate else None

        def again() -> Instance:
            if saved is not None:
                instance.restore(saved)
            else:
                instance.reset()
                instance.initialise()
                for _ in range(steps):
                    instance.step()
            return instance

        yield again
        if saved is not None:
            instance.forget(saved)


def sweep(fmu: Fmu, notebook: Path) -> Answer:
    """Every input at both ends of its range and at zero."""
    settings = [(v.name, x) for v in fmu.inputs if v.variability == "continuous" for x in extremes(v)]
    if not settings:
        return not_applicable("There is no continuous input with a range.")
    with _again(fmu) as again:
        already = _broken_after(again(), {})
        for name, value in settings:
            broken = sorted(_broken_after(again(), {name: value}) - already)
            if broken:
                return failed(f"{some(broken)} not finite after a step with {name} = {value:g}, which is in its range.")
    return passed(f"{len(settings)} steps with inputs at the ends of their ranges and at zero.")


def _broken_after(instance: Instance, inputs: dict[str, float]) -> set[str]:
    instance.step(inputs=inputs)
    return instance.broken()


def unusable(fmu: Fmu, notebook: Path) -> Answer:
    """An input that is NaN or infinite does no harm."""
    if not fmu.inputs:
        return not_applicable("There is no Real input.")
    passing: list[str] = []
    refused = 0
    for variable in fmu.inputs:
        for value in (math.nan, math.inf):
            with fmu.started() as instance:
                already = instance.broken()
                try:
                    broken = sorted(_broken_after(instance, {variable.name: value}) - already)
                except FMICallException:
                    refused += 1
                    fmu.fault = ""  # it is right
                    continue
            if broken:
                passing.append(f"{variable.name} = {value:g} (into {some(broken, 1)})")
    if passing:
        return noted(f"Passed on to the outputs: {some(passing)}; a host must check what it sets.")
    return passed(f"NaN and inf in {len(fmu.inputs)} inputs: {refused} refused by status, no output spoilt.")


def feedthrough(fmu: Fmu, notebook: Path) -> Answer:
    """An output that moves with an input before the next step declares that it depends on it."""
    settings = [(v.name, x) for v in fmu.inputs if v.variability == "continuous" for x in elsewhere(v)]
    declared = {
        u.variable.name: {v.name for v in u.dependencies}
        for u in fmu.description.outputs
        if u.dependencies is not None  # else on every input
    }
    if not settings or not declared:
        return not_applicable("There is no continuous input, or no output that declares its dependencies.")
    with _again(fmu, steps=1) as again:
        for name, value in settings:
            instance = again()
            before = instance.row()
            instance.put({name: value})
            moved = [output for output, text in instance.row().items() if text != before[output]]
            silent = [output for output in moved if name not in declared.get(output, {name})]
            if silent:
                return failed(
                    f"{name} = {value:g} moves {some(silent)} without a step; its dependencies do not list it."
                )
    return passed(
        f"{len(settings)} settings of inputs between steps: no output moves at once that does not declare it."
    )


def reset(fmu: Fmu, notebook: Path) -> Answer:
    """The run after a reset is the first run."""
    with fmu.started() as instance:
        expected = _rows(fmu, instance)
        instance.reset()
        instance.initialise()
        difference = _difference(_rows(fmu, instance), expected)
    if difference:
        return failed(f"In the run after a reset, {difference}.")
    return passed("The run after a reset gives the same bits.")


def cycles(fmu: Fmu, notebook: Path) -> Answer:
    """Instances come and go, and leave little behind."""
    before = _memory_after(fmu, _SETTLED)
    growth = (_memory_after(fmu, _CYCLES) - before) / _CYCLES
    evidence = f"{_SETTLED + _CYCLES} instances made and freed"
    if math.isnan(growth):
        return passed(f"{evidence}; memory is measured on Linux only.")
    evidence += f"; memory grows by {max(growth, 0.0):.0f} kB per instance."
    return noted(evidence) if growth > _LEAK else passed(evidence)


def _memory_after(fmu: Fmu, count: int) -> float:
    """Memory of this process in kB after so many instances; NaN where it cannot be told."""
    for _ in range(count):
        with fmu.instance():
            pass
        gc.collect(1)  # what fmpy leaves
    try:
        text = Path("/proc/self/status").read_text()
    except OSError:
        return math.nan
    match = re.search(r"VmRSS:\s*(\d+) kB", text)
    return float(match[1]) if match else math.nan


def interleaved(fmu: Fmu, notebook: Path) -> Answer:
    """Two instances in one process, step by step in turn, do not touch each other."""
    if fmu.capabilities.canBeInstantiatedOnlyOncePerProcess:
        return not_applicable("canBeInstantiatedOnlyOncePerProcess is true.")
    alone = [_new_rows(fmu, first) for first in (0, _STEPS)]
    with fmu.started() as first, fmu.started() as second:
        pair = (first, second)
        together = [[instance.row()] for instance in pair]
        for number in range(_STEPS):
            for i, instance in enumerate(pair):
                instance.step(inputs=fmu.stimulus(number + i * _STEPS))
                together[i].append(instance.row())
    for rows, expected in zip(together, alone, strict=True):
        if difference := _difference(rows, expected):
            return failed(f"With another instance at work, {difference}.")
    return passed("Two instances stepped in turn give the bits of each alone.")


def reference(fmu: Fmu, notebook: Path) -> Answer:
    """The reference results that the FMU carries come out again."""
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
    """Relative tolerance of reference results: of their experiment (fmi-ls-ref), or RelTol in their .opt file."""
    for path in file.parent.glob("*.exp"):
        for experiment in etree.parse(path).iter("Experiment"):
            about = {element.get("source") for element in experiment.iter("References")}
            if file.name in about and "tolerance" in experiment.attrib:
                return float(experiment.get("tolerance"))
    options = file.with_suffix(".opt")
    stated = _RELATIVE_TOLERANCE.search(options.read_text("utf-8")) if options.exists() else None
    return float(stated[1]) if stated else _TOLERANCE


def _allowed(fmu: Fmu, results: _Table, rtol: float) -> dict[str, float]:
    """Differences that a tolerance allows: it is one of a column's largest magnitude, or of the nominal if all is 0."""
    largest = {name: max(abs(row[name]) for row in results.rows) for name in results.names}
    return {name: rtol * (size or magnitude(fmu.variables[name])) for name, size in largest.items()}


def _replayed(fmu: Fmu, results: _Table, stimuli: _Table) -> Iterator[dict[str, float]]:
    """The variables at the times of `results`; inputs hold from their row to the next, parameters start as they do."""
    fmu.start_time = results.times[0]

    def inputs(time: float) -> dict[str, float]:
        past = [row for change, row in zip(stimuli.times, stimuli.rows, strict=True) if change <= time]
        return past[-1] if past else {}

    def outputs() -> dict[str, float]:
        return {name: float(value) for name, value in instance.read(results.names).items()}

    with fmu.instance() as instance:
        instance.initialise(**inputs(results.times[0]))
        yield outputs()
        for begin, end in pairwise(results.times):
            instance.step(end - begin, inputs(begin))
            yield outputs()


STAGES: dict[str, Stage] = {
    stage.__name__: stage
    for stage in (
        run, guid, finite, record, replay, rollback, save, resume, splitting, sweep, unusable, feedthrough, reset,
        cycles, interleaved, reference,
    )
}  # fmt: skip


def answer(folder: Path, stage: str, notebook: Path) -> Answer | None:
    """Answer one stage; what it raises is an answer, too."""
    with (notebook / "call").open("wb", buffering=0) as trace:
        fmu = Fmu(folder, trace)
        try:
            return STAGES[stage](fmu, notebook)
        except FMICallException:
            return failed(f"{fmu.fault}.")
        except Exception as error:  # fmpy's own, when an FMU cannot be loaded or instantiated, and unreadable data
            sentences = [" ".join(str(error).split()), *fmu.messages[-1:]]
            return failed(" ".join(sentence.rstrip(".") + "." for sentence in sentences))


_PR_SET_PDEATHSIG = 1


def main(folder: str, stage: str, notebook: str) -> None:
    """Write the answer of one stage, if it gives one. It ends with the checker, also when that is killed."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    found = answer(Path(folder), stage, Path(notebook))
    if found is not None:
        (Path(notebook) / "answer.json").write_text(json.dumps(found))


if __name__ == "__main__":
    main(*sys.argv[1:])
