"""Drives one unpacked FMU through a fixed script: golden_host.py FOLDER OUT.json."""

import json
import sys
from ctypes import byref
from pathlib import Path

import fmpy
import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, defaultCallbacks, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.logging import addLoggerProxy
from golden_record import Record

LOADS = (1.0, 0.8, 1.1, 1.0, 0.6)  # of the start value
SPEEDS = (1.0, 1.05, 0.9)
STEPS = (0.001, 0.5, 2.0, 10.0)  # s
COUNT = 12  # of steps before the state is stored
AFTER = 5


class Host:
    """An instance, what it was asked and has said."""

    def __init__(self, folder: Path, record: Record) -> None:
        description = fmpy.read_model_description(str(folder))
        self.record, self.time = record, 0.0
        self.variables = {v.name: v for v in description.modelVariables}
        self.able = description.coSimulation.providesDirectionalDerivative
        self.fmu = FMU2Slave(
            guid=description.guid,
            unzipDirectory=str(folder),
            modelIdentifier=description.coSimulation.modelIdentifier,
        )
        self.functions = fmi2CallbackFunctions()  # kept, for fmpy calls its logger at any time
        self.functions.logger = fmi2CallbackLoggerTYPE(lambda *told: None)
        self.functions.allocateMemory = defaultCallbacks.allocateMemory
        self.functions.freeMemory = defaultCallbacks.freeMemory
        addLoggerProxy(byref(self.functions))
        self.fmu.instantiate(callbacks=self.functions, loggingOn=False)

    def initialise(self) -> None:
        self.time = 0.0
        self.fmu.setupExperiment()
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def start(self, name: str) -> float:
        return float(self.variables[name].start)

    def get(self, name: str) -> float | int | str:
        variable = self.variables[name]
        return getattr(self.fmu, f"get{variable.type}")([variable.valueReference])[0]

    def set(self, name: str, value: float) -> None:
        variable = self.variables[name]
        getattr(self.fmu, f"set{variable.type}")([variable.valueReference], [value])

    def step(self, i: int, told: str) -> None:
        """The step of this number in the script: inputs that change, a step, every output."""
        self.set("load", LOADS[i % len(LOADS)] * self.start("load"))
        self.set("speed_1", SPEEDS[i % len(SPEEDS)] * self.start("speed_1"))
        self.set("temperature", self.start("temperature") + 0.25 * (i % 4))
        self.fmu.doStep(self.time, STEPS[i % len(STEPS)])
        self.time += STEPS[i % len(STEPS)]
        self.tell(told)

    def tell(self, told: str) -> None:
        """Keep every output and input, and derivatives if it has them."""
        for name, variable in self.variables.items():
            if variable.causality in ("output", "input", "independent"):
                value = self.get(name)
                self.record.put(f"{told}, {name}", float(value) if variable.type == "Real" else str(value))
        if self.able:
            unknown, known = ([self.variables[name].valueReference] for name in ("friction_force", "load"))
            self.record.put(f"{told}, derivative", np.asarray(self.fmu.getDirectionalDerivative(unknown, known, [1.0])))


def script(host: Host) -> None:
    """All that is asked of the FMU."""
    for name, variable in host.variables.items():
        if variable.causality == "parameter":
            host.record.put(f"parameter {name}", str(host.get(name)))
    host.initialise()
    host.tell("initialised")
    for i in range(COUNT):
        host.step(i, f"step {i}")
    state, time = host.fmu.getFMUstate(), host.time
    stored = host.fmu.serializeFMUstate(state)
    host.record.put("stored state again", stored == host.fmu.serializeFMUstate(state))
    replays = []
    for told in ("after", "restored", "from bytes"):
        if told == "restored":
            host.fmu.setFMUstate(state)
        elif told == "from bytes":
            read = host.fmu.deSerializeFMUstate(stored)
            host.fmu.setFMUstate(read)
            host.fmu.freeFMUstate(read)
        host.time = time
        for i in range(COUNT, COUNT + AFTER):
            host.step(i, f"{told}, step {i}")
        replays.append([repr(host.get("friction_force")), repr(host.get("wear_volume_1"))])
    host.record.put("replays", replays)
    host.fmu.freeFMUstate(state)
    host.set("fidelity", 1)
    host.step(0, "at the regression level")
    host.set("fidelity", 2)
    host.step(1, "at the deterministic level")
    try:
        host.set("load", -1.0)
        host.fmu.doStep(host.time, 1.0)
    except FMICallException as error:
        host.record.put("refused, status", int(error.status))
    host.time += 1.0
    host.tell("refused")
    host.fmu.terminate()
    host.fmu.reset()
    host.set("seed", 3)
    host.set("boundary_friction.bare", 0.2)
    host.initialise()
    for i in range(3):
        host.step(i, f"after reset, step {i}")


def main() -> None:
    """Drive it and write what it has said."""
    record = Record()
    host = Host(Path(sys.argv[1]), record)
    try:
        script(host)
    finally:
        host.fmu.freeInstance()
    Path(sys.argv[2]).write_text(json.dumps(record.values))


if __name__ == "__main__":
    main()
