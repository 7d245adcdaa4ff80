"""Rules on variables and structure of the model description."""

import math
from collections import Counter
from collections.abc import Callable
from functools import wraps

from fmpy.model_description import ModelDescription, ModelVariable

from .package import DESCRIPTION, Package
from .variables import attribute, is_real
from .verdict import Answer, failed, not_applicable, noted, passed, some

Rule = Callable[[Package], Answer]

_STARTED = ("exact", "approx")


def described(rule: Callable[[ModelDescription], Answer]) -> Rule:
    """Return the rule for a package: not applicable where fmpy cannot interpret the description."""

    @wraps(rule)
    def answer(package: Package) -> Answer:
        if package.description is None:
            return not_applicable(f"{DESCRIPTION} cannot be interpreted.")
        return rule(package.description)

    return answer


@described
def nominals(description: ModelDescription) -> Answer:
    """Check that nominals are finite and above zero; FMI leaves open whether a Real has one."""
    nominals_of = {v.name: attribute(v, "nominal") for v in reals_of(description)}
    odd = [f"{name} = {text}" for name, text in nominals_of.items() if text is not None and not is_positive(text)]
    if odd:
        return failed(f"The nominal {some(odd)} must be finite and above zero.")
    if bare := [name for name, text in nominals_of.items() if text is None]:
        return noted(f"Without a nominal: {some(bare)}; hosts then take 1, and tolerances miss small quantities.")
    return passed(f"{len(nominals_of)} Reals with their magnitudes.")


def is_positive(text: str) -> bool:
    """Return True for a finite number above zero."""
    return 0.0 < float(text) < math.inf


def reals_of(description: ModelDescription) -> list[ModelVariable]:
    """Return all Reals but time, which is in seconds by FMI."""
    return [v for v in description.modelVariables if is_real(v) and v.causality != "independent"]


@described
def starts(description: ModelDescription) -> Answer:
    """Start values where FMI wants them, within min and max."""
    variables = [v for v in description.modelVariables if v.type != "Clock"]
    missing = [v.name for v in variables if v.start is None and (v.causality == "input" or v.initial in _STARTED)]
    if missing:
        return failed(f"Without a start value: {some(missing)}; inputs and what is initially exact or approx need one.")
    numbers = [v for v in variables if is_real(v) or "Int" in v.type]
    for v in numbers:
        low, high = _range(v)
        values = [float(word) for word in (v.start or "").split()]
        if low > high:
            return failed(f"{v.name} has min = {low:g} above max = {high:g}.")
        if not all(low <= value <= high for value in values):
            return failed(f"{v.name} starts at {v.start}, which is not within its range {low:g} to {high:g}.")
    return passed(f"{sum(v.start is not None for v in variables)} start values, all within their ranges.")


def _range(variable: ModelVariable) -> tuple[float, float]:
    low, high = attribute(variable, "min"), attribute(variable, "max")
    return -math.inf if low is None else float(low), math.inf if high is None else float(high)


@described
def aliases(description: ModelDescription) -> Answer:
    """Check that variables of one value reference have one unit, and that at most one of them can be set."""
    groups: dict[tuple[str, int], list[ModelVariable]] = {}
    for v in description.modelVariables:
        if v.alias is None:
            reached = "Integer" if v.type == "Enumeration" else v.type  # FMI 2.0 counts within a type
            groups.setdefault((reached, v.valueReference), []).append(v)
    shared = [group for group in groups.values() if len(group) > 1]
    for group in shared:
        if len({attribute(v, "unit") for v in group}) > 1:
            different = [f"{v.name} in {attribute(v, 'unit') or 'no unit'}" for v in group]
            return failed(f"With one valueReference, {group[0].valueReference}, but not one unit: {some(different)}.")
        settable = [v.name for v in group if v.causality in ("input", "parameter")]
        if len(settable) > 1:
            return failed(f"With one valueReference, {group[0].valueReference}, but each to be set: {some(settable)}.")
    return passed(f"{len(groups)} values, {len(shared)} of them with several names.")


@described
def outputs(description: ModelDescription) -> Answer:
    """Check that ModelStructure/Outputs lists every output once, and nothing else."""
    listed = Counter(u.variable.name for u in description.outputs)
    expected = {v.name for v in description.modelVariables if v.causality == "output" and v.alias is None}
    missing = sorted(expected - set(listed))
    if missing:
        return failed(f"Not in ModelStructure/Outputs: {some(missing)}.")
    foreign = sorted(set(listed) - expected)
    if foreign:
        return failed(f"In ModelStructure/Outputs, but no output: {some(foreign)}.")
    twice = [name for name, count in listed.items() if count > 1]
    if twice:
        return failed(f"In ModelStructure/Outputs more than once: {some(twice)}.")
    return passed(f"{len(expected)} outputs, each listed once.")


@described
def dependencies(description: ModelDescription) -> Answer:
    """Check that every output declares its dependencies, which FMI leaves open."""
    silent = [u.variable.name for u in description.outputs if u.dependencies is None]
    if silent:
        return noted(f"Without dependencies: {some(silent)}; a host must suppose that every input counts.")
    inputs = sum(any(v.causality == "input" for v in u.dependencies) for u in description.outputs)
    return passed(f"{inputs} of {len(description.outputs)} outputs depend directly on inputs.")


@described
def initial_unknowns(description: ModelDescription) -> Answer:
    """Check that every calculated output is in InitialUnknowns."""
    listed = {u.variable.name for u in description.initialUnknowns}
    calculated = [
        v.name
        for v in description.modelVariables
        if v.causality == "output" and v.initial in ("calculated", "approx") and v.alias is None and not v.clocks
    ]
    missing = [name for name in calculated if name not in listed]
    if missing:
        return failed(f"Calculated, but not in ModelStructure/InitialUnknowns: {some(missing)}.")
    return passed(f"{len(calculated)} calculated outputs, all in InitialUnknowns.")


@described
def experiment(description: ModelDescription) -> Answer:
    """Check that there is a default experiment that goes forward in time."""
    default = description.defaultExperiment
    if default is None:
        return noted("There is no DefaultExperiment: a host must know the step that suits.")
    start = float(default.startTime or 0.0)
    if default.stopTime is not None and not float(default.stopTime) > start:
        return failed(f"stopTime = {default.stopTime} must be above startTime = {start:g}.")
    for name in ("stepSize", "tolerance"):
        value = getattr(default, name)
        if value is not None and not is_positive(value):
            return failed(f"{name} = {value} must be finite and above zero.")
    return passed(f"From {start:g} s to {default.stopTime or '?'} s in steps of {default.stepSize or '?'} s.")


@described
def capabilities(description: ModelDescription) -> Answer:
    """Check the capabilities that a master needs to iterate or go back."""
    able = description.coSimulation
    if able is None:
        return not_applicable("There is no interface for co-simulation.")
    lacks = [
        text
        for has, text in (
            (able.canGetAndSetFMUstate, "it cannot be set back (canGetAndSetFMUstate)"),
            (able.canSerializeFMUstate, "its state cannot be stored (canSerializeFMUstate)"),
            (able.canHandleVariableCommunicationStepSize, "its step must be constant"),
            (not able.needsExecutionTool, "needsExecutionTool is true, so some hosts refuse it"),
            (not able.canBeInstantiatedOnlyOncePerProcess, "only one instance fits in a process"),
        )
        if not has
    ]
    if lacks:
        return noted(f"Declared: {'; '.join(lacks)}.")
    return passed("State can be kept and stored, steps can vary, many instances fit, no other tool is needed.")
