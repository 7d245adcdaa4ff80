"""A rule on the directional derivatives that an FMU gives."""

from collections.abc import Callable
from pathlib import Path

from fmpy.fmi1 import FMICallException
from lxml import etree

from .instance import Fmu, Instance
from .rows import again
from .variables import is_real, magnitude
from .verdict import Answer, failed, not_applicable, noted, passed, some

_SHIFTS = (1e-4, 1e-5)  # of an input's magnitude
_SMOOTH = 1e-2  # relative difference of slopes over both shifts; a larger one shows a kink
_NEGLIGIBLE = 1e-6  # of the ratio of magnitudes: slopes below are lost in rounding
_FLAGS = ("providesDirectionalDerivative", "providesDirectionalDerivatives")  # FMI 2.0, FMI 3.0


def derivatives(fmu: Fmu, notebook: Path) -> Answer:
    """Check directional derivatives of outputs to the inputs that they depend on directly, against differences."""
    interface = etree.parse(fmu.folder / "modelDescription.xml").find("CoSimulation")
    if all(interface.get(flag) not in ("true", "1") for flag in _FLAGS):
        return not_applicable("providesDirectionalDerivative is false.")
    pairs = _pairs(fmu)
    if not pairs:
        return not_applicable("There is no Real output that depends directly on a continuous input.")
    unsteady: list[str] = []
    refused: list[str] = []
    with again(fmu, steps=1) as get:
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
                return failed(f"The derivative of {output} by {name} is given as {given:g}; differences give {fine:g}.")
    kinks = f" Not smooth enough to compare: {some(unsteady)}." if unsteady else ""
    compared = f"{len(pairs) - len(unsteady) - len(refused)} derivatives agree with differences.{kinks}"
    return noted(f"{compared} Refused: {some(refused)}.") if refused else passed(compared)


def _pairs(fmu: Fmu) -> list[tuple[str, str]]:
    """Return outputs, each with a continuous input that it depends on directly."""
    inputs = [v.name for v in fmu.inputs if v.variability == "continuous"]
    outputs = {v.name for v in fmu.outputs if is_real(v) and v.variability == "continuous"}
    return [
        (unknown.variable.name, name)
        for unknown in fmu.description.outputs
        if unknown.variable.name in outputs
        for name in inputs
        if unknown.dependencies is None or name in {v.name for v in unknown.dependencies}
    ]


def _slope(fmu: Fmu, get: Callable[[], Instance], output: str, name: str, shift: float) -> float:
    """Return the central difference of an output over an input that is moved both ways."""
    variable = fmu.variables[name]
    start, size = float(variable.start or 0.0), shift * magnitude(variable)
    values = []
    for moved in (start - size, start + size):
        instance = get()
        instance.put({name: moved})
        values.append(float(instance.read([output])[output]))
    return (values[1] - values[0]) / (2.0 * size)
