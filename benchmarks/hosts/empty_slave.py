"""An FMU of an empty model: cost of a step without the model's own time.

`pack` puts this very file into the FMU, as the script of its slave.
"""

import json
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pythonfmu import Fmi2Slave

from fmu_src.phases import Phase

INPUT, OUTPUT, PARAMETER = range(3)  # value references
LAYOUT = (("Real", "input"), ("Real", "output"), ("Real", "parameter"))
_VARIABLES = """
  <ScalarVariable name="u" valueReference="0" causality="input"><Real start="0.0"/></ScalarVariable>
  <ScalarVariable name="y" valueReference="1" causality="output"><Real/></ScalarVariable>
  <ScalarVariable name="p" valueReference="2" causality="parameter" variability="fixed">
    <Real start="1.0"/>
  </ScalarVariable>
"""
_GUID = "3b7c1a52-9d0f-4e7c-8a35-5d0e1c6f2b90"
_DESCRIPTION = f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="Empty" guid="{_GUID}">
<CoSimulation modelIdentifier="MixedContact" canGetAndSetFMUstate="true" canSerializeFMUstate="true"/>
<ModelVariables>{_VARIABLES}</ModelVariables>
<ModelStructure>
  <Outputs><Unknown index="2"/></Outputs>
  <InitialUnknowns><Unknown index="2"/></InitialUnknowns>
</ModelStructure>
</fmiModelDescription>
"""


def pack(out: Path, parts: Mapping[str, bytes]) -> Path:
    """Write the FMU: description, script, and the `parts` of a flavour by name, its binaries above all."""
    with zipfile.ZipFile(out, "w") as archive:
        archive.writestr("modelDescription.xml", _DESCRIPTION)
        archive.writestr("resources/slavemodule.txt", "empty_slave_of_fmu")
        archive.writestr("resources/guid.txt", _GUID)
        archive.writestr("resources/empty_slave_of_fmu.py", Path(__file__).read_bytes())
        for name, data in parts.items():
            archive.writestr(name, data)
    return out


class Empty(Fmi2Slave):
    """y = p u at the end of a step."""

    layout = LAYOUT

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.values = [0.0, 0.0, 1.0]
        self.phase = Phase.NEW

    def enter_initialization_mode(self) -> None:
        self.phase = Phase.SETTLED

    def exit_initialization_mode(self) -> None:
        self.phase = Phase.STEPPING

    def refresh(self) -> None:
        """y is constant until the next step."""

    def do_step(self, current_time: float, step_size: float) -> bool:
        self.values[OUTPUT] = self.values[PARAMETER] * self.values[INPUT]
        return True

    def get_real(self, vrs: list[int]) -> list[float]:
        return [self.values[vr] for vr in vrs]

    def set_real(self, vrs: list[int], values: list[float]) -> None:
        for vr, value in zip(vrs, values, strict=True):
            self.values[vr] = value

    def _get_fmu_state(self) -> tuple[float, ...]:
        return tuple(self.values)

    def _set_fmu_state(self, state: tuple[float, ...]) -> None:
        self.values[:] = state

    @classmethod
    def parts(cls, state: tuple[float, ...]) -> list[bytes]:
        return [cls._fmu_state_to_bytes(state)]

    @staticmethod
    def _fmu_state_to_bytes(state: tuple[float, ...]) -> bytes:
        return json.dumps(state).encode()

    @staticmethod
    def _fmu_state_from_bytes(data: bytes) -> tuple[float, ...]:
        return tuple(json.loads(data))
