"""The functions of an FMU of FMI 2.0."""

from ctypes import byref
from pathlib import Path
from typing import Any

from fmpy.fmi2 import FMU2Slave, fmi2CoSimulation
from fmpy.model_description import ModelDescription

from . import messages


class FMU2Library(FMU2Slave):  # fmpy takes the version of FMI from the name
    """The library of an unpacked FMU, whose messages go to `messages`."""

    def __init__(self, description: ModelDescription, folder: str) -> None:
        super().__init__(
            guid=description.guid,
            modelIdentifier=description.coSimulation.modelIdentifier,
            unzipDirectory=folder,
        )
        self.callbacks = messages.callbacks()

    def create(self, name: str, **instead: Any) -> int | None:
        """Return a new component, None if it is refused; `instead` replaces arguments of fmi2Instantiate by name."""
        arguments = {
            "instanceName": name,
            "fmuType": fmi2CoSimulation,
            "fmuGUID": self.guid,
            "fmuResourceLocation": Path(self.unzipDirectory, "resources").absolute().as_uri(),
        } | instead
        encoded = [value.encode() if isinstance(value, str) else value for value in arguments.values()]
        return self.fmi2Instantiate(*encoded, byref(self.callbacks), False, True)
