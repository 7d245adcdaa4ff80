"""A rule on the directional derivatives that an FMU gives."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from fmpy.fmi1 import FMICallException
from lxml import etree

from .instance import Fmu, Instance
from .rows import again
from .variables import is_free, is_real, magnitude
from .verdict import Answer, failed, not_applicable, noted, passed, some

_SHIFTS = (1e-4, 1e-5)  # of an input's magnitude
_SMOOTH = 1e-2  # relative difference of slopes over both shifts; a larger one shows a kink
_NEGLIGIBLE = 1e-6  # of the ratio of magnitudes: slopes below are lost in rounding
_FLAGS = ("providesDirectionalDerivative", "providesDirectionalDerivatives")  # FMI 2.0, FMI 3.0

Get = Callable[[], Instance]


def derivatives(fmu: Fmu, notebook: Path) -> Answer:
    """Check directional derivatives of outputs to the inputs that they depend on directly, against differences.

    Where no output does so between steps, they are compared while the FMU is initialised.
    """
    interface = etree.parse(fmu.folder / "modelDescription.xml").find("CoSimulation")
    if all(interface.get(flag) not in ("true", "1") for flag in _FLAGS):
        return not_applicable("providesDirectionalDerivative is false.")
    if pairs := _pairs(fmu, fmu.description.outputs):
        with again(fmu, steps=1) as get:
            return _compared(fmu, get, pairs)
    if pairs := _pairs(fmu, fmu.description.initialUnknowns):
        fmu.where = ", while it is initialised"
        with _initialising(fmu) as get:
            return _compared(fmu, get, pairs)
    return not_applicable("There is no Real output that depends directly on a continuous input.")


def _pairs(fmu: Fmu, unknowns: Iterable[Any]) -> list[tuple[str, str]]:
    """Return continuous outputs, each with a continuous input that can be moved and that it depends on directly."""
    inputs = [v.name for v in fmu.inputs if v.variability == "continuous" and is_free(v)]
    outputs = {v.name for v in fmu.outputs if is_real(v) and v.variability == "continuous"}
    return [
        (unknown.variable.name, name)
        for unknown in unknowns
        if unknown.variable.name in outputs
        for name in inputs
        if unknown.dependencies is None or name in {v.name for v in unknown.dependencies}
    ]


@contextmanager
def _initialising(fmu: Fmu) -> Iterator[Get]:
    """Yield a function that returns an instance in initialisation mode, its inputs at their start values."""
    with fmu.instance() as instance:
        instance.set_up()
        instance.put(fmu.start)
        instance.enter()

        def get() -> Instance:
            instance.put({v.name: float(v.start or 0.0) for v in fmu.inputs if v.variability == "continuous"})
            return instance

        yield get


def _compared(fmu: Fmu, get: Get, pairs: list[tuple[str, str]]) -> Answer:
    unsteady: list[str] = []
    refused: list[str] = []
    for number, (output, name) in enumerate(pairs):
        fmu.progress = f"{number} of {len(pairs)} derivatives have been compared, and are right"
        try:
            given = get().partial(output, name)
        except FMICallException:
            fmu.fault = ""  # it may refuse some
            refused.append(f"{output} by {name}")
            continue
        coarse, fine = (_slope(fmu, get, output, name, shift) for shift in _SHIFTS)
        small = _NEGLIGIBLE * magnitude(fmu.variables[output]) / magnitude(fmu.variables[name])
        if abs(coarse - fine) > _SMOOTH * max(abs(coarse), abs(fine)) + small:
            unsteady.append(f"{output} by {name}")
        elif not abs(given - fine) <= _SMOOTH * max(abs(given), abs(fine)) + small:
            told = f"The derivative of {output} by {name} is given as {given:g}; differences give {fine:g}"
            return failed(f"{told}{fmu.where}.")
    kinks = f" Not smooth enough to compare: {some(unsteady)}." if unsteady else ""
    compared = f"{len(pairs) - len(unsteady) - len(refused)} derivatives agree with differences{fmu.where}.{kinks}"
    return noted(f"{compared} Refused: {some(refused)}.") if refused else passed(compared)


def _slope(fmu: Fmu, get: Get, output: str, name: str, shift: float) -> float:
    """Return the central difference of an output over an input that is moved both ways."""
    variable = fmu.variables[name]
    start, size = float(variable.start or 0.0), shift * magnitude(variable)
    values = []
    for moved in (start - size, start + size):
        instance = get()
        instance.put({name: moved})
        values.append(float(instance.read([output])[output]))
    return (values[1] - values[0]) / (2.0 * size)
