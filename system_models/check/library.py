"""The library of an FMU of FMI 2.0 or 3.0 behind one interface, with calls that only the check makes.

Methods are named as fmpy names those of FMI 3.0; `spelt` gives the name for the FMU's own version.
"""

import os
from collections.abc import Sequence
from ctypes import c_int, cdll
from pathlib import Path
from typing import Any, ClassVar, TypedDict

from fmpy import freeLibrary
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import fmi2ModelExchange, fmi2String, fmi2ValueReference
from fmpy.fmi3 import (
    FMU3Slave,
    fmi3Discard,
    fmi3IntermediateUpdateCallback,
    fmi3LogMessageCallback,
    fmi3String,
    fmi3ValueReference,
)
from fmpy.model_description import ModelDescription, ModelVariable

from ..fmu import messages
from ..fmu.library import FMU2Library

STATUS = ("OK", "warning", "discard", "error", "fatal", "pending")  # by number


class Instead(TypedDict, total=False):
    """Other arguments of the instantiation than the right ones."""

    token: str
    resources: None
    model_exchange: bool


class _Checked:
    """What the libraries of both versions have in common."""

    warned = False  # a call was answered with a warning since this was set to False
    component: Any
    dll: Any
    _functions: dict[str, Any]

    def _call(self, name: str, *arguments: Any) -> Any:
        answer = super()._call(name, *arguments)  # type: ignore[misc]
        self.warned |= self._functions[name].restype is c_int and STATUS[answer] == "warning"
        return answer

    def reload(self) -> None:
        """Unload the library, as far as it lets itself be unloaded, and load it again."""
        path = self.dll._name
        freeLibrary(self.dll._handle)
        self.dll = cdll.LoadLibrary(path)
        self._loadFunctions()  # type: ignore[attr-defined]


class FMU2Checked(_Checked, FMU2Library):  # fmpy takes the version of FMI from the name
    """The library of an FMU of FMI 2.0."""

    prefix = "fmi2"
    sets_up = True  # the experiment, by a call of its own
    _spelling: ClassVar = {
        "getFMUState": "getFMUstate",
        "setFMUState": "setFMUstate",
        "freeFMUState": "freeFMUstate",
        "serializeFMUState": "serializeFMUstate",
        "deserializeFMUState": "deSerializeFMUstate",
    }

    @classmethod
    def spelt(cls, method: str) -> str:
        return cls._spelling.get(method, method)

    @staticmethod
    def instantiation(instead: Instead) -> tuple[str, dict[str, Any]]:
        """Return the function that instantiates, and its unusual arguments by FMI's names."""
        names = {"token": "fmuGUID", "resources": "fmuResourceLocation"}
        unusual = {names[key]: value for key, value in instead.items() if key in names}
        if instead.get("model_exchange"):
            unusual["fmuType"] = fmi2ModelExchange
        return "fmi2Instantiate", unusual

    def new(self, name: str, instead: Instead) -> int | None:
        """Return a new component, None if it is refused."""
        _, unusual = self.instantiation(instead)
        return self.create(name, **unusual)

    @staticmethod
    def type_of(variable: ModelVariable) -> str:
        """Return the type by whose functions a variable is reached."""
        return "Integer" if variable.type == "Enumeration" else str(variable.type)

    def setString(self, references: Sequence[int], values: Sequence[bytes]) -> None:
        """Set Strings to any bytes; fmpy's own takes text only."""
        count = len(references)
        self.fmi2SetString(
            self.component, (fmi2ValueReference * count)(*references), count, (fmi2String * count)(*values)
        )

    def be_quiet(self) -> None:
        """Switch logging off, by the shortest way."""
        self.fmi2SetDebugLogging(self.component, False, 0, None)

    def discard(self, component: int) -> None:
        self.fmi2FreeInstance(component)


class FMU3Checked(_Checked, FMU3Slave):  # fmpy takes the version of FMI from the name
    """The library of an FMU of FMI 3.0. It handles its events itself, within its steps."""

    prefix = "fmi3"
    sets_up = False

    def __init__(self, description: ModelDescription, folder: str) -> None:
        super().__init__(
            guid=description.guid,
            modelIdentifier=description.coSimulation.modelIdentifier,
            unzipDirectory=folder,
        )

    @staticmethod
    def spelt(method: str) -> str:
        return method

    @staticmethod
    def instantiation(instead: Instead) -> tuple[str, dict[str, Any]]:
        """Return the function that instantiates, and its unusual arguments by FMI's names."""
        names = {"token": "instantiationToken", "resources": "resourcePath"}
        kind = "ModelExchange" if instead.get("model_exchange") else "CoSimulation"
        return f"fmi3Instantiate{kind}", {names[key]: value for key, value in instead.items() if key in names}

    def new(self, name: str, instead: Instead) -> int | None:
        """Return a new component, None if it is refused."""
        function, unusual = self.instantiation(instead)
        arguments = {
            "instanceName": name,
            "instantiationToken": self.guid,
            "resourcePath": str(Path(self.unzipDirectory, "resources").absolute()) + os.sep,
        } | unusual
        first = [text and text.encode() for text in arguments.values()]
        between = [] if function.endswith("ModelExchange") else [False, False, None, 0]  # neither events nor updates
        after = [] if function.endswith("ModelExchange") else [_NO_UPDATE]
        return getattr(self, function)(*first, False, True, *between, None, _LOGGER, *after)

    @staticmethod
    def type_of(variable: ModelVariable) -> str:
        """Return the type by whose functions a variable is reached."""
        return "Int64" if variable.type == "Enumeration" else str(variable.type)

    def doStep(self, time: float, size: float) -> None:
        """Make a step. One that asks for the end of the simulation is raised as FMI 2.0 reports it: as discarded."""
        _, ended, _, _ = super().doStep(time, size)
        if ended:
            raise FMICallException("fmi3DoStep", fmi3Discard)

    def setString(self, references: Sequence[int], values: Sequence[bytes]) -> None:
        """Set Strings to any bytes; fmpy's own takes text only."""
        count = len(references)
        self.fmi3SetString(
            self.component, (fmi3ValueReference * count)(*references), count, (fmi3String * count)(*values), count
        )

    def getString(self, references: Sequence[int]) -> list[bytes]:
        """Return Strings as bytes; fmpy's own fails where they are no UTF-8."""
        count = len(references)
        values = (fmi3String * count)()
        self.fmi3GetString(self.component, (fmi3ValueReference * count)(*references), count, values, count)
        return [value or b"" for value in values]

    def be_quiet(self) -> None:
        """Switch logging off, by the shortest way."""
        self.fmi3SetDebugLogging(self.component, False, 0, None)

    def discard(self, component: int) -> None:
        self.fmi3FreeInstance(component)


Library = FMU2Checked | FMU3Checked


def _on_message(environment: Any, status: int, category: bytes | None, message: bytes | None) -> None:
    messages.pass_on("the FMU", status, message)


_LOGGER = fmi3LogMessageCallback(_on_message)  # never freed: instances are made and freed by threads
_NO_UPDATE = fmi3IntermediateUpdateCallback()
