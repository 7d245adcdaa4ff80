"""One contact in a test rig: fmpy drives its FMU through a duty.

The rig prescribes load, speeds and temperature, so nothing flows back and no iteration is needed: the
inputs are held over each communication step, and the outputs at its end are recorded.
"""

import logging
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import MISSING, fields
from itertools import pairwise
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import xarray as xr
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2Discard
from fmpy.model_description import ModelDescription, ModelVariable
from numpy.typing import NDArray

from contact_core.errors import ContactError, StateError
from contact_core.scene import OperatingPoint

from . import messages
from .checkpoint import Checkpoint, Saved
from .duty import Duty
from .results import to_dataset

log = logging.getLogger(__name__)

_INPUTS = {f.name: f.default for f in fields(OperatingPoint)}  # what a duty may set, and what it is if it does not
_MOST_STEPS = 1_000_000
_BINARY = {"Real": "<f8", "Integer": "<i4", "Boolean": "?"}  # of a value in a checkpoint


def run(
    fmu_path: str | Path,
    duty: Duty,
    duration: float,
    interval: float,
    progress: Callable[[float], None] | None = None,
    checkpoint: Checkpoint | None = None,
) -> xr.Dataset:
    """Drive a `MixedContact` FMU through a duty.

    duration and interval in seconds. There is a row every `interval`, at every change of the duty and at
    the end; the first row is the contact after initialisation. `progress` is called with the time reached.
    A step that the FMU calls invalid is recorded like any other and warned about at the end. The FMU's
    messages go to `logging`. With a `checkpoint` the run goes on from what it has saved, bit for bit, and saves what it
    reaches; the last point stays until the caller has put the result away and removes it.

    Returns a Dataset along `time` with the inputs and all outputs of the FMU, named and with units as in its
    modelDescription.xml. Raises ContactError if the FMU fails or is not one of a contact, and KeyboardInterrupt also
    when the interrupt reaches the FMU.
    """
    points = communication_points(duty, duration, interval)
    with tempfile.TemporaryDirectory(prefix="tribofmu-") as folder:
        if "%" in Path(folder).as_uri().replace("%20", ""):
            raise ContactError(
                f"The FMU cannot be loaded from '{folder}'. Set TMPDIR to a folder named in plain letters and digits."
            )
        fmpy.extract(fmu_path, folder)
        recorder = _Recorder(fmpy.read_model_description(folder))
        recorder.check(duty)
        with _instance(recorder.description, folder) as slave:
            _drive(slave, recorder, duty, points, progress or (lambda time: None), checkpoint)
    return recorder.dataset(points)


def communication_points(duty: Duty, duration: float, interval: float) -> list[float]:
    """Times [s] from 0 to `duration`: every `interval`, every change of the duty, and the end.

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
    return [float(time) for time in np.union1d(regular[apart], changes)]


def _drive(
    slave: FMU2Slave,
    recorder: "_Recorder",
    duty: Duty,
    points: list[float],
    progress: Callable[[float], None],
    checkpoint: Checkpoint | None,
) -> None:
    time = points[0]
    try:
        if checkpoint and checkpoint.saved:
            time = checkpoint.saved.time
            _restore(slave, checkpoint.saved)
            recorder.restore(checkpoint.saved.rows)
        else:
            slave.setupExperiment(startTime=time, stopTime=points[-1])
            slave.enterInitializationMode()
            recorder.set_inputs(slave, duty, time)
            slave.exitInitializationMode()
            recorder.record(slave)
            # one that an interrupt cut short ends at the first step only, and must not be gone on from
            if checkpoint and recorder.rows["valid"][-1]:
                _save(slave, recorder, checkpoint, time)
        for time, end in pairwise(points[recorder.count - 1 :]):
            recorder.set_inputs(slave, duty, time)
            slave.doStep(time, end - time)
            recorder.record(slave)
            if checkpoint and (checkpoint.due() or end == points[-1]):
                _save(slave, recorder, checkpoint, end)
            progress(end)
        slave.terminate()
    except FMICallException as error:
        if (error.function, error.status) == ("fmi2DoStep", fmi2Discard):  # the contact does so only if interrupted
            raise KeyboardInterrupt from error
        raise ContactError(f"The FMU failed at t = {time:g} s: {error} Its messages say why.") from error


def _save(slave: FMU2Slave, recorder: "_Recorder", checkpoint: Checkpoint, time: float) -> None:
    checkpoint.save(time, _serialised(slave), recorder.table(checkpoint.count))


def _serialised(slave: FMU2Slave) -> bytes:
    handle = slave.getFMUstate()
    try:
        return bytes(slave.serializeFMUstate(handle))
    finally:
        slave.freeFMUstate(handle)


def _restore(slave: FMU2Slave, saved: Saved) -> None:
    handle = slave.deSerializeFMUstate(saved.state)
    slave.setFMUstate(handle)
    slave.freeFMUstate(handle)
    if _serialised(slave) != saved.state:
        raise StateError(
            f"The FMU does not take the state of the checkpoint at t = {saved.time:g} s; its messages say why. "
            "Use the FMU that the checkpoint was made with, or start from the beginning."
        )


class _Recorder:
    """Sets the inputs of a contact and keeps them, and every output that the FMU declares, row by row."""

    def __init__(self, description: ModelDescription) -> None:
        self.description = description
        inputs = {v.name: v for v in description.modelVariables if v.causality == "input"}
        outputs = [v for v in description.modelVariables if v.causality == "output"]
        needed = {name for name, default in _INPUTS.items() if default is MISSING}
        missing = {*needed, "valid"} - {*inputs, *(v.name for v in outputs)}
        if missing:
            raise ContactError(
                f"The FMU '{description.modelName}' has no {', '.join(sorted(missing))}. "
                "Use one that `tribofmu build` has made."
            )
        self.inputs: list[ModelVariable] = [inputs[name] for name in _INPUTS if name in inputs]
        self.outputs: dict[str, list[ModelVariable]] = {
            kind: [v for v in outputs if v.type == kind] for kind in ("Real", "Integer", "Boolean")
        }
        self.rows: dict[str, list[Any]] = {v.name: [] for v in (*self.inputs, *outputs)}
        self._record = np.dtype([(v.name, _BINARY[v.type]) for v in (*self.inputs, *outputs)])
        self.units = {v.name: v.unit or "1" for v in (*self.inputs, *outputs)}
        self.texts = {v.name: f"{v.description}, held over the step that ends here" for v in self.inputs}
        self.texts |= {v.name: v.description or v.name for v in outputs}

    def check(self, duty: Duty) -> None:
        """Raise ContactError if the duty sets an input that the FMU does not have."""
        absent = {*_INPUTS} - {v.name for v in self.inputs}
        for name in sorted(absent):
            if any(getattr(point, name) != _INPUTS[name] for point in duty.points):
                raise ContactError(
                    f"The duty sets {name}, which means nothing to the contact of this FMU: it has no such input. "
                    "Leave it out."
                )

    def set_inputs(self, slave: FMU2Slave, duty: Duty, time: float) -> None:
        """Set the operating point that holds from `time` on."""
        point = duty.at(time)
        self.held = [_held(point, v) for v in self.inputs]
        slave.setReal([v.valueReference for v in self.inputs], self.held)

    def record(self, slave: FMU2Slave) -> None:
        """Add a row."""
        for variable, value in zip(self.inputs, self.held, strict=True):
            self.rows[variable.name].append(value)
        getters = {"Real": slave.getReal, "Integer": slave.getInteger, "Boolean": slave.getBoolean}
        for kind, variables in self.outputs.items():
            values = getters[kind]([v.valueReference for v in variables])
            for variable, value in zip(variables, values, strict=True):
                self.rows[variable.name].append(bool(value) if kind == "Boolean" else value)

    @property
    def count(self) -> int:
        """Number of rows."""
        return len(self.rows["valid"])

    def table(self, first: int) -> NDArray[np.void]:
        """The rows from `first` on as records, exactly."""
        return np.array(list(zip(*(column[first:] for column in self.rows.values()), strict=True)), self._record)

    def restore(self, table: NDArray[np.void]) -> None:
        """Begin with rows that `table` gave."""
        self.rows = {name: table[name].tolist() for name in self.rows}

    def dataset(self, points: list[float]) -> xr.Dataset:
        """What was recorded, with a warning if the FMU called some of it invalid."""
        invalid = [time for time, valid in zip(points, self.rows["valid"], strict=True) if not valid]
        if invalid:
            log.warning(
                "%d of %d rows are invalid, the first at %g s: the outputs stand as they were before.",
                len(invalid),
                len(points),
                invalid[0],
            )
        return to_dataset(points, self.rows, self.units, self.texts)


def _held(point: OperatingPoint, variable: ModelVariable) -> float:
    """Value of an input at an operating point; what it leaves open is the oil's temperature or the scene's radius."""
    value = getattr(point, variable.name)
    open_value = point.temperature if variable.unit == "K" else variable.start
    return float(open_value if value is None else value)


@contextmanager
def _instance(description: ModelDescription, folder: str) -> Iterator[FMU2Slave]:
    """An instance of an extracted FMU, freed whatever happens: left alone, it may crash its host at exit."""
    slave = FMU2Slave(
        guid=description.guid,
        modelIdentifier=description.coSimulation.modelIdentifier,
        unzipDirectory=folder,
        instanceName="contact",
    )
    slave.instantiate(callbacks=messages.callbacks(), loggingOn=True)
    try:
        yield slave
    finally:
        slave.freeInstance()
