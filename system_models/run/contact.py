"""One contact in a test rig: a system of one FMU, which the master drives through a duty.

Nothing flows back: inputs are held over each communication step, and the outputs at its end are recorded.
"""

from collections.abc import Callable, Mapping
from dataclasses import MISSING
from dataclasses import fields as fields_of
from pathlib import Path

import numpy as np
import xarray as xr
from fmpy.model_description import ModelVariable

from contact_core.errors import ContactError
from contact_core.scene import OperatingPoint
from fmu_src.runtime.snapshot import contact_state

from ..fmu.instance import Instance
from ..fmu.model import Model
from ..master import System, simulate
from ..master.simulate import Observer
from ..store.checkpoint import Checkpoint
from ..store.results import to_dataset
from .duty import Duty
from .fields import Fields

_NAME = "contact"  # of the FMU in its system
_INPUTS = {f.name: f.default for f in fields_of(OperatingPoint)}  # inputs that a duty may set, and their defaults
_MOST_STEPS = 1_000_000
_SAME = 1e-9  # of an interval: times closer than that are one, as for the master


def run(
    fmu_path: str | Path,
    duty: Duty,
    duration: float,
    interval: float,
    progress: Callable[[float], None] | None = None,
    checkpoint: Checkpoint | None = None,
    fields: Fields | None = None,
    at_end: Callable[[bytes], None] | None = None,
) -> xr.Dataset:
    """Drive a `MixedContact` FMU through a duty.

    duration and interval in seconds. There is a row every `interval`, at every change of the duty and at
    the end; the first row is the contact after initialisation. `progress` is called with the time reached.
    A step that the FMU calls invalid is recorded like any other and warned about at the end. The FMU's
    messages go to `logging`. With a `checkpoint` the run continues from its saved point, bit for bit, and saves the
    points that it reaches; the last point stays until the caller removes it. `fields` keeps maps at some of the rows,
    `at_end` gets the state of the contact after the last one.

    Returns a Dataset along `time` with the inputs and all outputs of the FMU, named and with units as in its
    modelDescription.xml. Raises ContactError if the FMU fails or is not one of a contact, and KeyboardInterrupt also
    when the interrupt reaches the FMU.
    """
    points = communication_points(duty, duration, interval)
    inputs, outputs = _variables(Model(_NAME, fmu_path))
    _check(duty, inputs)
    system = System({_NAME: fmu_path}, schedule={_port(v): _course(duty, v, duration) for v in inputs})
    recorded = [*inputs, *outputs]
    if fields and checkpoint:
        fields.kept = checkpoint.kept
    found = simulate(
        system,
        stop_time=points[-1],
        step_size=interval,
        points=points[1:],
        outputs=[_port(v) for v in recorded],
        checkpoint=checkpoint,
        progress=progress,
        observe=_observer(points[-1], fields, at_end),
    )
    return to_dataset(
        found["time"].values,
        {v.name: found[_port(v)].values for v in recorded},
        {v.name: v.unit or "1" for v in recorded},
        {v.name: f"{v.description}, held over the step that ends here" for v in inputs}
        | {v.name: v.description or v.name for v in outputs},
    )


def _observer(end: float, fields: Fields | None, at_end: Callable[[bytes], None] | None) -> Observer | None:
    """Return the observer of the contact's FMU: it keeps the fields at the rows, and at time `end` [s] the state."""
    if at_end is None:
        return fields.observe if fields else None

    def observe(time: float, instances: Mapping[str, Instance]) -> None:
        if fields:
            fields.observe(time, instances)
        if time >= end:
            at_end(contact_state(instances[_NAME].serialised()))

    return observe


def communication_points(duty: Duty, duration: float, interval: float) -> list[float]:
    """Return times [s] from 0 to `duration`: every `interval`, every change of the duty, and the end.

    Changes that rounding parts are one.

    Raises ContactError if either is not above zero, or the interval cuts the duration into too many steps.
    """
    if not (0.0 < duration < np.inf and interval >= duration / _MOST_STEPS):
        raise ContactError(
            f"A duration of {duration:g} s cannot be cut into intervals of {interval:g} s: "
            f"both must be above 0, and there may be {_MOST_STEPS:,} steps at most."
        )
    regular = interval * np.arange(np.ceil(duration / interval))
    changes = np.array([*(time for time in duty.times if time < duration), duration])
    # a multiple of the interval may miss a change by a rounding error only: then the change stands for both
    apart = np.abs(regular[:, None] - changes).min(axis=1) > 1e-9 * duration
    times = np.union1d(regular[apart], changes)
    times = times[np.diff(times, prepend=-np.inf) > _SAME * min(interval, duration)]
    return [*map(float, times[:-1]), float(duration)]


def _port(variable: ModelVariable) -> str:
    return f"{_NAME}.{variable.name}"


def _variables(model: Model) -> tuple[list[ModelVariable], list[ModelVariable]]:
    """Return the inputs that a duty can set, and the outputs. Raises ContactError for an FMU of something else."""
    inputs = {v.name: v for v in model.variables.values() if v.causality == "input"}
    outputs = [v for v in model.variables.values() if v.causality == "output"]
    needed = {name for name, default in _INPUTS.items() if default is MISSING}
    missing = {*needed, "valid"} - {*inputs, *(v.name for v in outputs)}
    if missing:
        raise ContactError(
            f"The FMU '{model.description.modelName}' has no {', '.join(sorted(missing))}. "
            "Use one that `tribofmu build` has made."
        )
    return [inputs[name] for name in _INPUTS if name in inputs], outputs


def _check(duty: Duty, inputs: list[ModelVariable]) -> None:
    """Raise ContactError if the duty sets an input that the FMU does not have."""
    for name in sorted({*_INPUTS} - {v.name for v in inputs}):
        if any(getattr(point, name) != _INPUTS[name] for point in duty.points):
            raise ContactError(
                f"The duty sets {name}, which means nothing to the contact of this FMU: it has no such input. "
                "Leave it out."
            )


def _course(duty: Duty, variable: ModelVariable, duration: float) -> list[tuple[float, float]]:
    """Return times [s] and values of an input."""
    rows = zip(duty.times, duty.points, strict=True)
    return [(time, _held(point, variable)) for time, point in rows if time < duration]


def _held(point: OperatingPoint, variable: ModelVariable) -> float:
    """Return the value of an input; by default the oil's temperature or the scene's radius."""
    value = getattr(point, variable.name)
    open_value = point.temperature if variable.unit == "K" else variable.start
    return float(open_value if value is None else value)
