"""A machine as a co-simulation: its contacts and components, what flows between them, and what is asked of it.

Who gives what to whom is the matter of `ball_on_disc`, `ball_bearing` and `gear_pair`; this builds the FMUs.
"""

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from contact_core.quantities import TABLE
from contact_core.scene import Scene
from fmu_src.flavours import Flavour
from fmu_src.package.build import build as build_contact

from ..master import System
from ..parts.build import build as build_part
from ..parts.part import Part

Value = float | int | bool | str
Schedule = dict[str, Sequence[tuple[float, Value]]]  # by "part.variable": times [s] and values

TOLD = (  # outputs of a contact that a result keeps
    "friction_force",
    "friction_coefficient",
    "rolling_resistance",
    "power_loss",
    "wear_rate_1",
    "wear_rate_2",
    "wear_volume_1",
    "wear_volume_2",
    "wear_depth_1",
    "wear_depth_2",
    "h_c",
    "lambda_ratio",
    "tribofilm_1",
    "tribofilm_2",
    "roughness_1",
    "roughness_2",
    "contact_load_ratio",
    "flash_temperature_rise",
    "load_cycles_1",
    "load_cycles_2",
    "valid",
    "fidelity_used",
    "range_flags",
    "error_friction",
    "error_film",
    "error_wear",
)


@dataclass(frozen=True)
class Contact:
    """One contact of a machine: a scene, and what its FMU is told beside the inputs that are connected."""

    scene: Scene
    parameters: Mapping[str, Value] = field(default_factory=dict)
    count: str = ""  # output that says for how many contacts it stands, if that changes


@dataclass(frozen=True)
class Assembly:
    """Everything that decides a simulation of a machine.

    parts and contacts by name; connections as `master.System` takes them; parameters and schedule of parts by
    "part.variable"; settings are the arguments of `master.simulate`.
    """

    name: str
    description: str
    parts: Mapping[str, Part]
    contacts: Mapping[str, Contact]
    connections: tuple[tuple[Any, ...], ...]
    parameters: Mapping[str, Value]
    schedule: Schedule
    settings: Mapping[str, Any]

    def outputs(self) -> list[str]:
        """What a result keeps: all that the parts tell, and of the contacts `TOLD`."""
        told = [f"{name}.{q.name}" for name, part in self.parts.items() for q in part.responses]
        valid = [f"{name}.valid" for name in self.parts]
        lacks = {name: contact.scene.geometry.lacks for name, contact in self.contacts.items()}
        found = [*told, *valid, *(f"{name}.{key}" for name in self.contacts for key in TOLD if key not in lacks[name])]
        return [*found, *(f"{name}.{key}" for name in self.contacts for key in self.inputs_of(name))]

    def nominals(self) -> dict[str, float]:
        """What is typical of the outputs that a result keeps."""
        found = {f"{name}.{q.name}": q.nominal for name, part in self.parts.items() for q in part.responses}
        return found | {f"{name}.{key}": TABLE[key].nominal for name in self.contacts for key in TOLD}

    def system(self, folder: Path, flavour: Flavour = "embedded") -> System:
        """Build the FMUs into a folder and couple them; contacts of one scene share a file.

        Raises ContactError for what does not go together.
        """
        proposed = {"duration": self.settings["stop_time"], "step_size": self.settings["step_size"]}
        files = {
            name: build_part(part, folder / f"{name}.fmu", flavour, **proposed) for name, part in self.parts.items()
        }
        scenes: dict[str, Path] = {}
        for name, contact in self.contacts.items():
            key = json.dumps(contact.scene.to_dict(), sort_keys=True)
            if key not in scenes:
                short = hashlib.sha256(key.encode()).hexdigest()[:8]
                scenes[key] = build_contact(contact.scene, folder / f"contact_{short}.fmu", flavour)
            files[name] = scenes[key]
        told = {f"{name}.{key}": value for name, c in self.contacts.items() for key, value in c.parameters.items()}
        return System(files, self.connections, {**self.parameters, **told}, self.schedule)

    def inputs_of(self, contact: str) -> list[str]:
        """The connected inputs of a contact."""
        targets = (target.partition(".") for _, target, *_ in self.connections)
        return [variable for owner, _, variable in targets if owner == contact]
