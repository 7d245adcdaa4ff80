"""One instance of a co-simulation FMU, every call written down before it is made: after a crash the last one shows."""

import logging
import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from ctypes import c_void_p
from functools import partial
from io import FileIO
from pathlib import Path
from typing import Any, NamedTuple

import fmpy
from fmpy.fmi1 import FMICallException
from fmpy.model_description import DefaultExperiment, ModelDescription

from ..fmu import messages
from ..fmu.kinds import kind
from .library import STATUS, FMU2Checked, FMU3Checked, Instead, Library
from .variables import Start, clipped, is_readable, is_real, magnitude

Value = float | int | bytes
Row = dict[str, str]  # outputs as text that differs where bits differ

_LONGEST = 300  # characters of a message, from its end, where a traceback names the error
_FEW = 100.0  # steps in an experiment that names no step
_MANY = 1000.0  # steps that an FMU makes in one of these, if it says which it makes


class Complaints(logging.Handler):
    """Keeps the messages of FMUs with a status worse than a warning."""

    def __init__(self) -> None:
        super().__init__()
        self.texts: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        """Keep the text of a message."""
        status, text = vars(record)["status"], vars(record)["text"]
        if status > 1 and text:
            self.texts.append(" ".join(text.split()))


def call_in(trace: bytes) -> str:
    """Return the call that was made last, in a trace."""
    return trace.decode("utf-8", "replace").partition("\n")[0].partition(" ")[2]


def progress_in(trace: bytes) -> str:
    return trace.decode("utf-8", "replace").partition("\n")[2]


class RefusedError(Exception):
    """The FMU refuses to be instantiated."""


class Objection(NamedTuple):
    """Answer of an FMU to a wrong call: its status refuses it, or something else says so, or nothing does."""

    refused: bool
    said: str


class Fmu:
    """An FMU unpacked in `folder`; its last call stands in the file `trace`, and how far its rule has come.

    Instances start with the values in `start` in place of the FMU's own.
    """

    def __init__(self, folder: Path, trace: FileIO, start: Start):
        self.folder = folder
        self.start = start
        self.description = fmpy.read_model_description(str(folder), validate=False)
        self.capabilities = self.description.coSimulation
        variables = self.description.modelVariables
        self.variables = {v.name: v for v in variables}
        for name, value in start.items():
            self.variables[name].start = str(value)
        self.library = FMU3Checked if self.description.fmiVersion.startswith("3") else FMU2Checked
        outputs = [v for v in variables if v.causality == "output"]
        self.outputs = [v for v in outputs if is_readable(v)]
        ends = [v for v in variables if v.causality in ("input", "output")]
        self.left_out = [v.name for v in ends if not is_readable(v)]  # arrays, clocks and binary data of FMI 3
        self.inputs = [v for v in variables if v.causality == "input" and is_real(v) and is_readable(v)]
        self.start_time, self.step = _experiment(self.description)
        self._complaints = _complaints()
        self.fault = ""  # the call that an instance has refused, and how
        self.where = ""  # circumstances of the next calls, if unusual
        self.progress = ""  # finding so far, if the rule must end here
        self._trace = trace
        self._calls = 0

    def note(self, call: str) -> None:
        """Write down a call that is about to be made."""
        self._calls += 1
        after = f" after {self.fault}" if self.fault else ""
        self._trace.seek(0)
        self._trace.write(f"{self._calls} {call}{self.where}{after}\n{self.progress}".encode())
        self._trace.truncate()

    def last_call(self) -> str:
        """Return the call written down last, also by a forked child."""
        return call_in(Path(self._trace.name).read_bytes())

    def refused(self, call: str, status: int) -> None:
        """Remember that an instance has answered a call with an error."""
        said = self.complaint()
        self.fault = f"{call}{self.where} was answered with {STATUS[status]}{f' ({said})' if said else ''}"

    def complaint(self) -> str:
        """Return the end of the last error that the FMU has reported."""
        texts = self._complaints.texts
        return texts[-1][-_LONGEST:] if texts else ""

    @contextmanager
    def instance(self) -> Iterator["Instance"]:
        """Make a new instance, and free it in the end."""
        instance = Instance(self)
        try:
            yield instance
        finally:
            instance.free()

    @contextmanager
    def started(self) -> Iterator["Instance"]:
        """Make a new instance, initialised with its start values."""
        with self.instance() as instance:
            instance.initialise()
            yield instance

    def stimulus(self, number: int) -> dict[str, float]:
        """Return continuous inputs at their start values, moved by a hundredth per number, within their ranges."""
        moving = [v for v in self.inputs if v.variability == "continuous"]
        return {v.name: clipped(v, float(v.start or 0.0) + 0.01 * number * magnitude(v)) for v in moving}


def _experiment(description: ModelDescription) -> tuple[float, float]:
    """Start time and step in s of the default experiment."""
    experiment = description.defaultExperiment or DefaultExperiment()
    start = float(experiment.startTime or 0.0)
    length = float(experiment.stopTime or start + 1.0) - start
    inner = float(description.coSimulation.fixedInternalStepSize or math.inf)
    return start, float(experiment.stepSize or min(length / _FEW, _MANY * inner))


def _complaints() -> Complaints:
    """Return the handler that takes the messages of FMUs from now on, in place of others: they are evidence only."""
    messages.log.handlers[:] = [found := Complaints()]
    messages.log.propagate = False
    return found


class Instance:
    """An instance of an FMU, with variables by name."""

    def __init__(self, fmu: Fmu, instead: Instead | None = None):
        """Instantiate, with some other arguments than the right ones where `instead` names them."""
        self._owner = fmu
        self.fatal = False
        self.time = fmu.start_time
        self._experiment: tuple[Any, ...] = (None, fmu.start_time, None)  # tolerance, start and stop time
        function, unusual = fmu.library.instantiation(instead or {})
        fmu.note(function + "".join(f" with {name} = {value}" for name, value in unusual.items()))
        self._fmu: Library = fmu.library(fmu.description, str(fmu.folder))
        self._create = partial(self._fmu.new, fmu.capabilities.modelIdentifier, instead or {})
        self._fmu.component = self._create()
        if self._fmu.component is None:
            self._fmu.freeLibrary()
            raise RefusedError(f"It cannot be instantiated{fmu.where}.")

    def _call(self, method: str, *arguments: Any, about: str = "") -> Any:
        method = self._fmu.spelt(method)
        call = f"{self._fmu.prefix}{method[0].upper()}{method[1:]}{about}"
        self._owner.note(call)
        try:
            return getattr(self._fmu, method)(*arguments)
        except FMICallException as error:
            self._owner.refused(call, error.status)
            self.fatal = STATUS[error.status] == "fatal"
            raise

    def objection(self, call: Callable[[], None]) -> Objection:
        """Return the FMU's answer to a wrong call: its status, or a Boolean output that turns false."""
        truths = self._truths()
        self._fmu.warned = False
        try:
            call()
        except FMICallException as error:
            self._owner.fault = ""  # it is right
            return Objection(True, STATUS[error.status])
        if self._fmu.warned:
            return Objection(False, "warning")
        gone = sorted(truths - self._truths())
        return Objection(False, f"{gone[0]} = false" if gone else "")

    def _truths(self) -> set[str]:
        """Return Boolean outputs that are true."""
        names = [v.name for v in self._owner.outputs if kind(v) == "boolean"]
        return {name for name, value in self.read(names).items() if value}

    def set_up(self, stop: float | None = None) -> None:
        """Give the start time and, if there is one, the stop time: to FMI 3.0 when initialisation begins."""
        self.time = self._owner.start_time
        self._experiment = None, self.time, stop
        if self._fmu.sets_up:
            self._call("setupExperiment", *self._experiment)

    def enter(self) -> None:
        """Begin initialisation."""
        self._call("enterInitializationMode", *(() if self._fmu.sets_up else self._experiment))

    def leave(self) -> None:
        """End initialisation."""
        self._call("exitInitializationMode")

    def initialise(self, values: dict[str, float] | None = None, stop: float | None = None) -> None:
        """Set up and initialise with the start values and `values`."""
        self.set_up(stop)
        self.put(self._owner.start)
        self.enter()
        self.put(values or {})
        self.leave()

    def put(self, values: Start) -> None:
        """Set variables by name."""
        for name, value in values.items():
            variable = self._owner.variables[name]
            if isinstance(value, str):
                self.put_text(name, value.encode())
                continue
            typed = value if is_real(variable) else int(value)
            setter = f"set{self._fmu.type_of(variable)}"
            self._call(setter, [variable.valueReference], [typed], about=f" of {name} = {value:g}")

    def put_text(self, name: str, text: bytes) -> None:
        about = f" of {name} = {text[:8]!r}{'...' if len(text) > 8 else ''}, {len(text)} bytes"
        self._call("setString", [self._owner.variables[name].valueReference], [text], about=about)

    def read(self, names: list[str]) -> dict[str, Value]:
        found = {}
        for name in names:
            variable = self._owner.variables[name]
            getter = f"get{self._fmu.type_of(variable)}"
            found[name] = self._call(getter, [variable.valueReference], about=f" of {name}")[0]
        return found

    def partial(self, output: str, name: str) -> float:
        """Return the derivative of an output by an input that it depends on directly."""
        references = [[self._owner.variables[n].valueReference] for n in (output, name)]
        return self._call("getDirectionalDerivative", *references, [1.0], about=f" of {output} by {name}")[0]

    def step(self, size: float | None = None, inputs: dict[str, float] | None = None) -> None:
        """Set the inputs and step, by the default experiment's step if no size is given."""
        self.put(inputs or {})
        size = self._owner.step if size is None else size
        about = "".join(f", {name} = {value:g}" for name, value in (inputs or {}).items())
        self._call("doStep", self.time, size, about=f" at {self.time:g} s{about}")
        self.time += size

    def outputs(self) -> dict[str, Value]:
        return self.read([v.name for v in self._owner.outputs])

    def row(self) -> Row:
        """Return all outputs as comparable text."""
        return {name: x.hex() if isinstance(x, float) else repr(x) for name, x in self.outputs().items()}

    def broken(self) -> set[str]:
        """Return the outputs that are not finite."""
        return {name for name, x in self.outputs().items() if isinstance(x, float) and not math.isfinite(x)}

    def reset(self) -> None:
        """Go back to the state after instantiation."""
        self._call("reset")

    def save(self) -> tuple[c_void_p, float]:
        """Return the FMU's state and its time."""
        return self._call("getFMUState"), self.time

    def restore(self, saved: tuple[c_void_p, float]) -> None:
        """Go back to a saved state, which stays."""
        self._call("setFMUState", saved[0])
        self.time = saved[1]

    def forget(self, saved: tuple[c_void_p, float]) -> None:
        """Free a saved state."""
        self._call("freeFMUState", saved[0])

    def stored(self) -> bytes:
        saved = self.save()
        data = self._call("serializeFMUState", saved[0])
        self.forget(saved)
        return data

    def resume(self, data: bytes, time: float) -> None:
        """Go on from stored bytes."""
        saved = self._call("deserializeFMUState", data), time
        self.restore(saved)
        self.forget(saved)

    def terminate(self) -> None:
        """End the simulation."""
        self._call("terminate")

    def reload(self) -> None:
        """Unload and load the library again, and continue with the loaded one."""
        self._owner.note("dlclose and dlopen")
        self._fmu.reload()

    def be_quiet(self) -> None:
        """Switch logging off: a call that FMI allows at any time."""
        self._call("setDebugLogging", False, [])

    # for threads that run beside: not written down

    def be_quiet_unwritten(self) -> None:
        """Switch logging off."""
        self._fmu.be_quiet()

    def come_and_go(self) -> None:
        """Make another instance and free it."""
        component = self._create()
        if component:
            self._fmu.discard(component)

    def free(self) -> None:
        """Free the instance; after a fatal status FMI allows no further call."""
        if not self.fatal:
            self._call("freeInstance")
