"""A host for one FMU: fmpy's low-level interface with variables by name, and a log."""

from __future__ import annotations

import contextlib
import os
import zipfile
from collections.abc import Callable, Iterator
from ctypes import byref
from pathlib import Path

import fmpy
from fmpy.fmi2 import FMU2Slave, defaultCallbacks, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE, fmi2OK
from fmpy.logging import addLoggerProxy

import contact_core

SMALL = {
    "film.points": "17",
    "surface_1.correlation_length": "32 um",
    "surface_2.correlation_length": "32 um",
}
LINE = {
    "film.points": "33",
    "film.width": "0.2 mm",
    "surface_1.correlation_length": "50 um",
    "surface_2.correlation_length": "50 um",
    "film.tolerance": "1e-2",
    "control.mixed_instants": "2",
}
ROLLER = LINE | {
    "geometry.model": "roller",
    "geometry.face_width": "1.2 mm",
    "geometry.profile.model": "logarithmic",
    "geometry.profile.depth": "1 um",
    "film.width": "0 m",
    "operation.load": "300 N",
}
ELLIPSE = SMALL | {"geometry.radius_y": "30 mm", "film.width": "1 mm"}
SHAPES = {"line": ("fzg_flank", LINE), "roller": ("fzg_flank", ROLLER), "ellipse": ("mtm_zddp", ELLIPSE)}


def unpacked(fmu: Path, folder: Path) -> Path:
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(folder)
    return folder


def environment() -> dict[str, str]:
    """Environment of a process that finds the packages where this one found them."""
    root = str(Path(contact_core.__file__).parents[1])
    return os.environ | {"PYTHONPATH": os.pathsep.join([root, os.environ.get("PYTHONPATH", "")])}


_KEPT = []  # fmpy hands the messages of all FMUs to the logger that was added last: none of them may go


def _callbacks(logger: Callable[..., None]) -> fmi2CallbackFunctions:
    functions = fmi2CallbackFunctions()
    functions.logger = fmi2CallbackLoggerTYPE(logger)
    functions.allocateMemory = defaultCallbacks.allocateMemory
    functions.freeMemory = defaultCallbacks.freeMemory
    _KEPT.append(functions)
    addLoggerProxy(byref(functions))
    return functions


class Host:
    """An instance of the FMU unpacked in `folder`."""

    def __init__(self, folder: Path, logging: bool = True):
        description = fmpy.read_model_description(str(folder))
        self.log: list[tuple[int, str]] = []  # status and text of what went wrong
        self.entries: list[tuple[int, str, str]] = []  # status, category and text of everything
        self.variables = {v.name: v for v in description.modelVariables}
        self.fmu = FMU2Slave(
            guid=description.guid,
            unzipDirectory=str(folder),
            modelIdentifier=description.coSimulation.modelIdentifier,
        )
        self.fmu.instantiate(callbacks=_callbacks(self._logged), loggingOn=logging)
        self.time = 0.0
        for call in ("setFMUstate", "reset"):  # time goes with states, as in every host
            setattr(self.fmu, call, self._with_time(getattr(self.fmu, call)))

    def _with_time(self, call: Callable[..., None]) -> Callable[..., None]:
        def made(*arguments: object) -> None:
            call(*arguments)
            if "time" in self.variables:
                self.time = self.get("time")

        return made

    def _logged(self, component, instance, status, category, message) -> None:
        self.entries.append((status, (category or b"").decode(), message.decode()))
        if status != fmi2OK:
            self.log.append((status, message.decode()))

    def initialise(self, **values) -> Host:
        self.fmu.setupExperiment()
        self.fmu.enterInitializationMode()
        self.set(**values)
        self.fmu.exitInitializationMode()
        return self

    def set(self, **values) -> None:
        """Set variables by name, `__` for the dot."""
        for name, value in values.items():
            variable = self.variables[name.replace("__", ".")]
            getattr(self.fmu, f"set{variable.type}")([variable.valueReference], [value])

    def get(self, name: str) -> float | int | bool | str:
        variable = self.variables[name]
        value = getattr(self.fmu, f"get{variable.type}")([variable.valueReference])[0]
        return bool(value) if variable.type == "Boolean" else value

    def step(self, dt: float, **inputs) -> dict[str, float]:
        self.set(**inputs)
        self.fmu.doStep(self.time, dt)
        self.time += dt
        return self.outputs()

    def outputs(self) -> dict[str, float]:
        return {name: self.get(name) for name, v in self.variables.items() if v.causality == "output"}

    def state(self) -> bytes:
        handle = self.fmu.getFMUstate()
        data = self.fmu.serializeFMUstate(handle)
        self.fmu.freeFMUstate(handle)
        return data

    def restore(self, data: bytes) -> None:
        handle = self.fmu.deSerializeFMUstate(data)
        self.fmu.setFMUstate(handle)
        self.fmu.freeFMUstate(handle)


@contextlib.contextmanager
def hosted(folder: Path, **options) -> Iterator[Host]:
    """Instantiate, and free the instance in any case."""
    host = Host(folder, **options)
    try:
        yield host
    finally:
        host.fmu.freeInstance()
