"""A host of FMI 3.0 with the interface of the one of FMI 2.0 in fmu_host."""

import contextlib
from collections.abc import Iterator
from ctypes import byref, c_bool, c_double, c_void_p
from pathlib import Path

import fmpy
from fmpy.fmi3 import FMU3Slave, fmi3FMUState


class Host3:
    """An instance of the FMU of FMI 3.0 unpacked in `folder`."""

    def __init__(self, folder: Path, logging: bool = True, token: str | None = None, **options: object):
        description = fmpy.read_model_description(str(folder))
        self.log: list[tuple[int, str, str]] = []  # status, category and text of everything
        self.variables = {v.name: v for v in description.modelVariables}
        self.fmu = FMU3Slave(
            guid=token or description.guid,
            unzipDirectory=str(folder),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="fmu",
        )
        self.fmu.instantiate(loggingOn=logging, logMessage=self._logged, **options)
        self.time = 0.0
        self.flags = (c_bool(True), c_bool(True), c_bool(True))  # event needed, end asked for, returned early
        self.last = c_double()  # last successful time

    def _logged(self, environment: c_void_p, status: int, category: bytes, message: bytes) -> None:
        self.log.append((status, category.decode(), message.decode()))

    def initialise(self, start: float = 0.0, stop: float | None = None, **values: object) -> "Host3":
        self.set(**values)
        self.time = start
        self.fmu.enterInitializationMode(startTime=start, stopTime=stop)
        self.fmu.exitInitializationMode()
        return self

    def set(self, **values: object) -> None:
        """Set variables by name, `__` for the dot."""
        for name, value in values.items():
            variable = self.variables[name.replace("__", ".")]
            getattr(self.fmu, f"set{variable.type}")([variable.valueReference], [value])

    def get(self, name: str) -> float | int | bool | str:
        variable = self.variables[name]
        return getattr(self.fmu, f"get{variable.type}")([variable.valueReference])[0]

    def step(self, dt: float, **inputs: object) -> dict[str, float]:
        self.set(**inputs)
        self.fmu.fmi3DoStep(self.fmu.component, self.time, dt, True, *map(byref, self.flags), byref(self.last))
        self.time += dt
        return self.outputs()

    def outputs(self) -> dict[str, float]:
        return {name: self.get(name) for name, v in self.variables.items() if v.causality == "output"}

    def state(self) -> bytes:
        handle = self.fmu.getFMUState()
        data = self.fmu.serializeFMUState(handle)
        self.fmu.freeFMUState(handle)
        return data

    def restore(self, data: bytes) -> None:
        handle = fmi3FMUState()
        self.fmu.deserializeFMUState(data, handle)
        self.fmu.setFMUState(handle)
        self.fmu.freeFMUState(handle)
        self.time = self.get("time")


@contextlib.contextmanager
def hosted3(folder: Path, **options: object) -> Iterator[Host3]:
    """Instantiate, and free the instance in any case."""
    host = Host3(folder, **options)
    try:
        yield host
    finally:
        host.fmu.freeInstance()
