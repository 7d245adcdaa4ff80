"""Rules on the answers of an FMU: outputs are finite, repeatable, and restored with a state."""

import json
import math
import os
import sys
from functools import partial
from pathlib import Path
from typing import NamedTuple

from .instance import Fmu, Instance, Row
from .rows import STEPS, again, difference, reals_of, rows_alone, rows_of
from .variables import elsewhere, extremes, is_real, magnitude
from .verdict import Answer, failed, not_applicable, noted, passed, some

_SPLIT = 1e-3  # of the magnitude: a difference by the size of the step that is worth a note


class FirstRun(NamedTuple):
    """Notes of `run` in the notebook, for rules that need no run of their own."""

    rows: list[Row]
    has_child: bool | None  # the host has a process that it did not start; None where that is unknown

    def write(self, notebook: Path) -> None:
        """Leave it."""
        (notebook / "first_run.json").write_text(json.dumps(self))

    @classmethod
    def read(cls, notebook: Path) -> "FirstRun":
        return cls(*json.loads((notebook / "first_run.json").read_text()))


def run(fmu: Fmu, notebook: Path) -> Answer:
    """Instantiate, initialise, step, terminate, free."""
    with fmu.started() as instance:
        rows = rows_of(fmu, instance)
        FirstRun(rows, _has_child()).write(notebook)
        instance.terminate()
    done = f"Instantiated, initialised, {STEPS} steps of {fmu.step:g} s, terminated, freed."
    if fmu.left_out:
        return noted(f"{done} Arrays, clocks and binary data are neither set nor read here: {some(fmu.left_out)}.")
    return passed(done)


def _has_child() -> bool | None:
    if sys.platform != "linux":
        return None
    try:
        os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT)
    except ChildProcessError:
        return False
    return True


def finite(fmu: Fmu, notebook: Path) -> Answer:
    """Check that no output of the run was NaN or infinite."""
    reals = [v.name for v in fmu.outputs if is_real(v)]
    for number, row in enumerate(FirstRun.read(notebook).rows):
        if broken := sorted(name for name in reals if not math.isfinite(float.fromhex(row[name]))):
            return failed(f"{some(broken)} not finite after {number} step(s), with inputs about their start values.")
    return passed(f"{len(reals)} outputs after initialisation and {STEPS} steps.")


def replay(fmu: Fmu, notebook: Path) -> Answer:
    """Check that the same calls in another process give the same bits."""
    if wrong := difference(rows_alone(fmu), FirstRun.read(notebook).rows):
        return failed(f"The same calls in another process: {wrong}.")
    return passed("The same calls in another process give the same bits.")


def rollback(fmu: Fmu, notebook: Path) -> Answer:
    """Check that a state set twice gives the same steps twice."""
    if not fmu.capabilities.canGetAndSetFMUstate:
        return not_applicable("canGetAndSetFMUstate is false.")
    with fmu.started() as instance:
        instance.step(inputs=fmu.stimulus(1))
        saved = instance.save()
        expected = _onward(fmu, instance)
        for time, count in (("first", len(expected)), ("second", 2)):
            instance.restore(saved)
            if wrong := difference(_onward(fmu, instance, count), expected[:count]):
                return failed(f"After the state was set the {time} time, {wrong}: the state is not whole.")
            fmu.progress = "set once, the state has given the same bits"
        instance.forget(saved)
    return passed("A state set twice gives the same bits twice.")


def _onward(fmu: Fmu, instance: Instance, count: int = 3) -> list[Row]:
    """Return outputs as they stand, after a step with the inputs as they stand, and after one with others."""
    rows = [instance.row()]
    for inputs in ({}, fmu.stimulus(4))[: count - 1]:
        instance.step(inputs=inputs)
        rows.append(instance.row())
    return rows


def save(fmu: Fmu, notebook: Path) -> Answer | None:
    """Prepare `resume`: store the state of a run."""
    if not fmu.capabilities.canSerializeFMUstate:
        return not_applicable("canSerializeFMUstate is false.")
    with fmu.started() as instance:
        instance.step(inputs=fmu.stimulus(1))
        (notebook / "state").write_bytes(instance.stored())
        (notebook / "onward.json").write_text(json.dumps([instance.time, _onward(fmu, instance)]))
    return None


def resume(fmu: Fmu, notebook: Path) -> Answer:
    """Check that the bytes of a state, restored in another process, give the same steps."""
    data = (notebook / "state").read_bytes()
    time, expected = json.loads((notebook / "onward.json").read_text())
    with fmu.started() as instance:
        instance.resume(data, time)
        wrong = difference(_onward(fmu, instance), expected)
    if wrong:
        return failed(f"Restored in another process, {wrong}: the bytes do not hold the whole state.")
    return passed(f"{len(data)} bytes restored in another process give the same bits.")


def splitting(fmu: Fmu, notebook: Path) -> Answer:
    """Check that a step in two halves ends where the whole step ends."""
    if not fmu.capabilities.canHandleVariableCommunicationStepSize:
        return not_applicable("canHandleVariableCommunicationStepSize is false.")
    with again(fmu) as get:
        instance = get()
        instance.step()
        whole, already = instance.outputs(), instance.broken()
        instance = get()
        instance.step(0.5 * fmu.step)
        instance.step(0.5 * fmu.step)
        halves, broken = instance.outputs(), sorted(instance.broken() - already)
    if broken:
        return failed(f"{some(broken)} not finite after two steps of {0.5 * fmu.step:g} s.")
    largest, name = 0.0, ""
    for variable in fmu.outputs:
        if is_real(variable) and variable.name not in already:
            size = max(magnitude(variable), abs(float(whole[variable.name])))
            largest, name = max((largest, name), (_distance(whole, halves, variable.name) / size, variable.name))
    if largest > _SPLIT:
        return noted(f"Two half steps move {name} by {largest:.2g} of its magnitude: choose the step with care.")
    return passed(f"Two half steps move no output by more than {largest:.2g} of its magnitude.")


def _distance(first: dict, second: dict, name: str) -> float:
    return abs(float(first[name]) - float(second[name]))


def sweep(fmu: Fmu, notebook: Path) -> Answer:
    """Check that the FMU can use every input at both ends of its range and at zero."""
    settings = [(v.name, x) for v in fmu.inputs if v.variability == "continuous" for x in extremes(v)]
    if not settings:
        return not_applicable("There is no continuous input with a range.")
    unused: list[str] = []
    with again(fmu) as get:
        instance = get()
        before = reals_of(fmu, instance)
        usual = instance.objection(instance.step).said
        already, moves = instance.broken(), reals_of(fmu, instance) != before
        for number, (name, value) in enumerate(settings):
            fmu.progress = f"{number} of {len(settings)} settings have been stepped with, and are right"
            instance, setting = get(), f"{name} = {value:g}"
            objection = instance.objection(partial(instance.step, inputs={name: value}))
            if objection.refused:
                said = f"{objection.said} ({fmu.complaint()})" if fmu.complaint() else objection.said
                return failed(f"A step with {setting}, which is in its range, is answered with {said}.")
            if broken := sorted(instance.broken() - already):
                return failed(f"{some(broken)} not finite after a step with {setting}, which is in its range.")
            stands = moves and reals_of(fmu, instance) == before
            if objection.said not in ("", usual) and (stands or objection.said == "warning"):
                unused.append(f"{setting} ({objection.said}{', and the outputs stand still' if stands else ''})")
    if unused:
        return noted(f"In the range of inputs, but not used without a reservation: {some(unused)}.")
    return passed(f"{len(settings)} steps with inputs at the ends of their ranges and at zero.")


def _broken_after(instance: Instance, inputs: dict[str, float]) -> set[str]:
    instance.step(inputs=inputs)
    return instance.broken()


def unusable(fmu: Fmu, notebook: Path) -> Answer:
    """Check that an input that is NaN or infinite does no harm, and is reported where the outputs stay as they were."""
    if not fmu.inputs:
        return not_applicable("There is no Real input.")
    settings = [(v.name, x) for v in fmu.inputs for x in (math.nan, math.inf)]
    spoilt: list[str] = []
    still: dict[str, list[str]] = {}  # settings by the sign that they are not used
    refused = 0
    with again(fmu) as get:
        instance = get()
        before = reals_of(fmu, instance)
        already = _broken_after(instance, {})
        moves = reals_of(fmu, instance) != before
        for number, (name, value) in enumerate(settings):
            fmu.progress = f"{number} of {len(settings)} settings have been stepped with"
            instance, setting = get(), f"{name} = {value:g}"
            objection = instance.objection(partial(instance.step, inputs={name: value}))
            if objection.refused:
                refused += 1
            elif broken := sorted(instance.broken() - already):
                spoilt.append(f"{setting} (into {some(broken, 1)})")
            elif moves and reals_of(fmu, instance) == before:
                still.setdefault(objection.said, []).append(setting)
    worth = []
    if spoilt:
        worth.append(f"Passed on to the outputs: {some(spoilt)}")
    if silent := still.pop("", []):
        worth.append(f"The outputs stand still, and nothing says so, after {some(silent)}")
    if worth:
        return noted(f"{'. '.join(worth)}: a host must check what it sets.")
    others = "".join(f" {len(s)} leave the outputs as they stand, with {said}." for said, s in still.items())
    return passed(f"{len(settings)} settings to NaN and inf: {refused} refused by status, no output spoilt.{others}")


def feedthrough(fmu: Fmu, notebook: Path) -> Answer:
    """Check that an output that changes with an input before the next step declares this dependency."""
    settings = [(v.name, x) for v in fmu.inputs if v.variability == "continuous" for x in elsewhere(v)]
    declared = {
        u.variable.name: {v.name for v in u.dependencies}
        for u in fmu.description.outputs
        if u.dependencies is not None  # else on every input
    }
    if not settings or not declared:
        return not_applicable("There is no continuous input, or no output that declares its dependencies.")
    with again(fmu, steps=1) as get:
        for number, (name, value) in enumerate(settings):
            fmu.progress = f"{number} of {len(settings)} settings have been tried, and are right"
            instance = get()
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
    """Check that the run after a reset is the first run."""
    with fmu.started() as instance:
        expected = rows_of(fmu, instance)
        instance.reset()
        instance.initialise()
        wrong = difference(rows_of(fmu, instance), expected)
    if wrong:
        return failed(f"In the run after a reset, {wrong}.")
    return passed("The run after a reset gives the same bits.")


def interleaved(fmu: Fmu, notebook: Path) -> Answer:
    """Check that two instances in one process, stepped in turn, do not affect each other."""
    if fmu.capabilities.canBeInstantiatedOnlyOncePerProcess:
        return not_applicable("canBeInstantiatedOnlyOncePerProcess is true.")
    if wrong := disturbed(fmu, reload=False):
        return failed(f"With another instance at work, {wrong}.")
    return passed("Two instances stepped in turn give the bits of each alone.")


def disturbed(fmu: Fmu, reload: bool) -> str:
    """Return what differs if two instances are stepped in turn; `reload`: load the library again before the second."""
    alone = [rows_alone(fmu, first) for first in (0, STEPS)]
    together: list[list[Row]] = [[], []]
    with fmu.started() as first:
        together[0].append(first.row())
        if reload:
            first.reload()
            fmu.where = " after the library was loaded again"
        with fmu.started() as second:
            together[1].append(second.row())
            for number in range(STEPS):
                for i, instance in enumerate((first, second)):
                    instance.step(inputs=fmu.stimulus(number + i * STEPS))
                    together[i].append(instance.row())
    return next(filter(None, map(difference, together, alone)), "")
