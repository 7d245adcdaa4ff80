"""A host of its own process that gives NULL wherever FMI's functions take arrays; prints what each call answered."""

import ctypes
import json
import sys
from collections.abc import Iterator
from ctypes import byref, c_double, c_int, c_size_t, c_uint, c_void_p
from pathlib import Path

import fmpy
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave

KINDS = {2: ("Real", "Integer", "Boolean", "String"), 3: ("Float64", "Int32", "Boolean", "String")}
ROOM = 64  # bytes: more than any one value
Call = tuple[str, list[object]]


class Nulls:
    """The calls, on an instance after its initialisation."""

    def __init__(self, folder: Path, log: list[str]):
        self.log = log
        self.description = fmpy.read_model_description(str(folder))
        self.version = int(self.description.fmiVersion[0])
        self.fmu = (FMU2Slave if self.version == 2 else FMU3Slave)(
            guid=self.description.guid,
            unzipDirectory=str(folder),
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="nulls",
        )
        self.begin()
        self.raw = ctypes.CDLL(self.fmu.dll._name)
        self.room = (ctypes.c_char * ROOM)()

    def begin(self) -> None:
        if self.version == 2:
            table = fmpy.fmi2.fmi2CallbackFunctions()
            self.logger = ctypes.CFUNCTYPE(None, c_void_p, c_void_p, c_int, c_void_p, ctypes.c_char_p)(self.hear)
            table.logger = ctypes.cast(self.logger, type(table.logger))
            self.fmu.instantiate(callbacks=table, loggingOn=True)
            self.fmu.setupExperiment(startTime=0.0)
            self.fmu.enterInitializationMode()
        else:
            self.fmu.instantiate(logMessage=lambda *entry: self.log.append(entry[-1].decode()), loggingOn=True)
            self.fmu.enterInitializationMode(startTime=0.0)
        self.fmu.exitInitializationMode()

    def hear(self, *entry: object) -> None:
        self.log.append(entry[-1].decode())

    def of_variables(self) -> Iterator[Call]:
        """Getters and setters of every kind that the FMU has, without references and without values."""
        for kind in KINDS[self.version]:
            found = [v for v in self.description.modelVariables if v.type == kind]
            chosen = next((v for v in found if v.causality in ("input", "parameter")), found[0])
            reference, one = byref(c_uint(chosen.valueReference)), c_size_t(1)
            rest = [one] if self.version == 3 else []
            for call in (f"Get{kind}", f"Set{kind}"):
                yield call, [None, one, self.room, *rest]
                yield call, [reference, one, None, *rest]

    def of_states(self) -> Iterator[Call]:
        """Calls about states."""
        word, de = ("state", "DeSerialize") if self.version == 2 else ("State", "Deserialize")
        state = self.fmu.getFMUstate() if self.version == 2 else self.fmu.getFMUState()
        yield f"GetFMU{word}", [None]
        yield f"SetFMU{word}", [None]
        yield f"SerializedFMU{word}Size", [state, None]
        yield f"SerializeFMU{word}", [state, None, c_size_t(100_000_000)]
        yield f"{de}FMU{word}", [None, c_size_t(ROOM), byref(c_void_p())]
        yield f"{de}FMU{word}", [self.room, c_size_t(ROOM), None]

    def of_others(self) -> Iterator[Call]:
        """Steps, derivatives, the log."""
        step, one = [c_double(0.0), c_double(1.0), c_int(1)], c_size_t(1)
        yield "SetDebugLogging", [c_int(1), one, None]
        if self.version == 2:
            yield "GetBooleanStatus", [c_int(3), None]
            yield "GetDirectionalDerivative", [None, one, None, one, None, None]
            return
        yield "DoStep", [*step, None, None, None, None]
        yield "GetDirectionalDerivative", [None, one, None, one, None, one, None, one]
        yield "GetAdjointDerivative", [None, one, None, one, None, one, None, one]
        yield "GetNumberOfVariableDependencies", [c_uint(0), None]

    def answers(self) -> Iterator[tuple[str, int, str]]:
        """Name, status and message of every call, then those of the calls without an instance."""
        for call, arguments in (*self.of_variables(), *self.of_others(), *self.of_states()):
            self.log.clear()
            function = getattr(self.raw, f"fmi{self.version}{call}")
            yield call, function(c_void_p(self.fmu.component), *arguments), " ".join(self.log)
            yield f"{call} of no instance", function(None, *arguments), "-"


if __name__ == "__main__":
    print(json.dumps(list(Nulls(Path(sys.argv[1]), []).answers())))
