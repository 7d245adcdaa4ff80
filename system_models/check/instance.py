"""One instance of a co-simulation FMU, every call written down before it is made: after a crash the last one shows."""

import copy
import math
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import c_void_p
from io import FileIO
from pathlib import Path
from typing import Any

import fmpy
from fmpy.fmi1 import FMICallException
from fmpy.simulation import instantiate_fmu

from .variables import base_type, clipped, magnitude

Value = float | int | bytes
Row = dict[str, str]  # outputs as text that differs where bits differ

_STATUS = ("OK", "warning", "discard", "error", "fatal", "pending")
_LONGEST = 300  # characters of a message, its end: there a traceback says what it was
_FEW = 100.0  # steps in an experiment that names no step


class Fmu:
    """An FMU unpacked in `folder`; its last call stands in the file `trace`."""

    def __init__(self, folder: Path, trace: FileIO):
        self.folder = folder
        self.description = fmpy.read_model_description(str(folder), validate=False)
        self.capabilities = self.description.coSimulation
        variables = self.description.modelVariables
        self.variables = {v.name: v for v in variables}
        self.outputs = [v for v in variables if v.causality == "output"]
        self.inputs = [v for v in variables if v.causality == "input" and v.type == "Real"]
        self.start_time, self.step = _experiment(self.description.defaultExperiment)
        self.messages: list[str] = []  # of errors
        self.fault = ""  # the call that an instance has refused, and how
        self._trace = trace
        self._calls = 0

    def note(self, call: str) -> None:
        """Write down a call that is about to be made."""
        self._calls += 1
        after = f" after {self.fault}" if self.fault else ""
        self._trace.seek(0)
        self._trace.write(f"{self._calls} {call}{after}".encode())
        self._trace.truncate()

    def refused(self, call: str, status: int) -> None:
        """Remember that an instance has answered a call with an error."""
        self.fault = f"{call} was answered with {_STATUS[status]}" + (
            f" ({self.messages[-1][-_LONGEST:]})" if self.messages else ""
        )

    @contextmanager
    def instance(self) -> Iterator["Instance"]:
        """A new instance, freed in the end."""
        instance = Instance(self)
        try:
            yield instance
        finally:
            instance.free()

    @contextmanager
    def started(self) -> Iterator["Instance"]:
        """A new instance, initialised with its start values."""
        with self.instance() as instance:
            instance.initialise()
            yield instance

    def stimulus(self, number: int) -> dict[str, float]:
        """Continuous inputs at their start values, moved by a hundredth per number, within their ranges."""
        moving = [v for v in self.inputs if v.variability == "continuous"]
        return {v.name: clipped(v, float(v.start or 0.0) + 0.01 * number * magnitude(v)) for v in moving}


def _experiment(experiment: Any) -> tuple[float, float]:
    """Start time and step in s of the default experiment."""
    if experiment is None:
        return 0.0, 1.0 / _FEW
    start = float(experiment.startTime or 0.0)
    length = float(experiment.stopTime or start + 1.0) - start
    return start, float(experiment.stepSize or length / _FEW)


class Instance:
    """An instance of an FMU, with variables by name."""

    def __init__(self, fmu: Fmu, guid: str | None = None):
        """Instantiate, with a `guid` that is not the FMU's if one is given."""
        self._owner = fmu
        description = copy.copy(fmu.description)
        description.guid = description.guid if guid is None else guid
        fmu.note("fmi2Instantiate" + ("" if guid is None else f" with guid = {guid}"))
        self._fmu = instantiate_fmu(
            str(fmu.folder), description, fmi_type="CoSimulation", debug_logging=True, logger=self._logged
        )
        self._fatal = False
        self.time = fmu.start_time

    def _logged(self, component: int, name: bytes, status: int, category: bytes, message: bytes | None) -> None:
        if status > 1 and message:
            self._owner.messages.append(" ".join(message.decode("utf-8", "replace").split()))

    def _call(self, method: str, *arguments: Any, about: str = "") -> Any:
        call = f"fmi2{method[0].upper()}{method[1:]}{about}"
        self._owner.note(call)
        try:
            return getattr(self._fmu, method)(*arguments)
        except FMICallException as error:
            self._owner.refused(call, error.status)
            self._fatal = _STATUS[error.status] == "fatal"
            raise

    def initialise(self, **values: float) -> None:
        """Set up and initialise with the start values and `values`."""
        self.time = self._owner.start_time
        self._call("setupExperiment", None, self.time)
        self._call("enterInitializationMode")
        self.put(values)
        self._call("exitInitializationMode")

    def put(self, values: dict[str, float]) -> None:
        """Set variables by name."""
        for name, value in values.items():
            variable = self._owner.variables[name]
            kind = base_type(variable)
            typed = value if kind == "Real" else int(value)
            self._call(f"set{kind}", [variable.valueReference], [typed], about=f" of {name} = {value:g}")

    def read(self, names: list[str]) -> dict[str, Value]:
        """Values of variables by name."""
        found = {}
        for name in names:
            variable = self._owner.variables[name]
            found[name] = self._call(f"get{base_type(variable)}", [variable.valueReference], about=f" of {name}")[0]
        return found

    def step(self, size: float | None = None, inputs: dict[str, float] | None = None) -> None:
        """Set the inputs and step, by the default experiment's step if no size is given."""
        self.put(inputs or {})
        size = self._owner.step if size is None else size
        about = "".join(f", {name} = {value:g}" for name, value in (inputs or {}).items())
        self._call("doStep", self.time, size, about=f" at {self.time:g} s{about}")
        self.time += size

    def outputs(self) -> dict[str, Value]:
        """All outputs."""
        return self.read([v.name for v in self._owner.outputs])

    def row(self) -> Row:
        """All outputs as comparable text."""
        return {name: x.hex() if isinstance(x, float) else repr(x) for name, x in self.outputs().items()}

    def broken(self) -> set[str]:
        """The outputs that are not finite."""
        return {name for name, x in self.outputs().items() if isinstance(x, float) and not math.isfinite(x)}

    def reset(self) -> None:
        """Back to what it was after instantiation."""
        self._call("reset")

    def save(self) -> tuple[c_void_p, float]:
        """The FMU's state and its time."""
        return self._call("getFMUstate"), self.time

    def restore(self, saved: tuple[c_void_p, float]) -> None:
        """Back to a saved state, which stays."""
        self._call("setFMUstate", saved[0])
        self.time = saved[1]

    def forget(self, saved: tuple[c_void_p, float]) -> None:
        """Free a saved state."""
        self._call("freeFMUstate", saved[0])

    def stored(self) -> bytes:
        """The state as bytes."""
        saved = self.save()
        data = self._call("serializeFMUstate", saved[0])
        self.forget(saved)
        return data

    def resume(self, data: bytes, time: float) -> None:
        """Go on from stored bytes."""
        saved = self._call("deSerializeFMUstate", data), time
        self.restore(saved)
        self.forget(saved)

    def terminate(self) -> None:
        """End the simulation."""
        self._call("terminate")

    def free(self) -> None:
        """Free the instance; after a fatal status FMI allows no further call."""
        if not self._fatal:
            self._call("freeInstance")
