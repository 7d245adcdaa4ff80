"""A machine as a co-simulation: its contacts, parts, connections, parameters and schedule; builds the FMUs."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from contact_core.errors import SceneError
from contact_core.quantities import LEVELS, TABLE
from contact_core.scene import OperatingPoint, Scene, with_values
from contact_core.scene.intervals import Interval, replaced, spread
from fmu_src.flavours import Flavour
from fmu_src.native.program import own_radii
from fmu_src.package.build import build as build_contact
from fmu_src.variables import FIDELITY

from ..master import System
from ..parts.build import build as build_part
from ..parts.part import Part

Value = float | int | bool | str
Schedule = dict[str, Sequence[tuple[float, Value]]]  # by "part.variable": times [s] and values

# outputs of contacts that a machine's result leaves out; all others of the table of quantities are recorded
_NOT_RECORDED = {
    "friction_fluid", "spin_torque", "heat_flow_1", "heat_flow_2", "pressure_max", "approach",
    "dfriction_dspeed_1", "dfriction_dspeed_2", "dfriction_dload", "dfriction_dtemperature",
    "h_central", "h_min", "lambda_conventional", "temperature_1", "temperature_2",
    "contact_area_ratio", "contact_area_ratio_disc", "contact_load_ratio_disc",
    "tribofilm_roughness_1", "tribofilm_roughness_2", "tribofilm_covered_1", "tribofilm_covered_2",
    "tribofilm_upper_1", "tribofilm_upper_2", "coverage_1", "coverage_2",
    "roughness_ra_1", "roughness_ra_2", "roughness_raw_1", "roughness_raw_2",
    "iterations", "suggested_step", "unconverged", "blocks_dry", "blocks_mixed", "blocks_fallback",
}  # fmt: skip
RECORDED = tuple(q.name for q in TABLE.values() if q.role != "input" and q.name not in _NOT_RECORDED)


@dataclass(frozen=True)
class Contact:
    """One contact of a machine: a scene, and the values that its FMU is given beside the connected inputs."""

    scene: Scene
    parameters: Mapping[str, Value] = field(default_factory=dict)
    count: str = ""  # output with the number of contacts that it stands for, if that changes
    moved: tuple[str, ...] = ()  # radii that change during the duty

    @property
    def own_scene(self) -> Scene:
        """The scene with the values that its FMU is given."""
        given: dict[str, Any] = dict(self.parameters)
        scene = self.scene.at_level(LEVELS[int(given.pop(FIDELITY)) - 1]) if FIDELITY in given else self.scene
        inputs: dict[str, Any] = {f.name: given.pop(f.name) for f in fields(OperatingPoint) if f.name in given}
        return replace(with_values(scene, given), operation=replace(scene.operation, **inputs))


@dataclass(frozen=True)
class Assembly:
    """Everything that decides a simulation of a machine.

    Parts and contacts are given by name, connections as `master.System` takes them, parameters and schedule of parts by
    "part.variable". Settings are the arguments of `master.simulate`.
    """

    name: str
    description: str
    parts: Mapping[str, Part]
    contacts: Mapping[str, Contact]
    connections: tuple[tuple[Any, ...], ...]
    parameters: Mapping[str, Value]
    schedule: Schedule
    settings: Mapping[str, Any]
    reported: Mapping[str, Any] = field(default_factory=dict)  # what only the report reads, by table of the file
    intervals: tuple[Interval, ...] = ()  # of what is assumed, by "part.key" and "contact.key"

    def ends(self, interval: Interval) -> list[tuple[dict[str, float], dict[str, float]]]:
        """Return least and largest values in SI by key, of each number of an interval. Raises SceneError for none."""
        records = {"contact": next(iter(self.contacts.values())).scene, **self.parts}
        if len(interval.keys) > 1:  # they go together
            return [interval.ends(records)]
        return [replace(interval, key=key).ends(records) for key in spread(records, interval.key)]

    def with_values(self, values: Mapping[str, float]) -> "Assembly":
        """Return the machine with other values [SI] by dotted keys of parts, or of all contacts' scenes."""
        changed = self
        for key, value in values.items():
            changed = changed._with_value(key, value)
        return changed

    def _with_value(self, key: str, value: float) -> "Assembly":
        part, _, rest = key.partition(".")
        if part != "contact":
            return replace(self, parts={**self.parts, part: replaced(self.parts[part], rest, value)})
        own = {name: replaced(contact.scene, rest, value) for name, contact in self.contacts.items()}
        return replace(self, contacts={name: replace(self.contacts[name], scene=scene) for name, scene in own.items()})

    def outputs(self) -> list[str]:
        """Return the recorded variables: all outputs of parts, those of contacts in `RECORDED`, changing inputs."""
        found = [f"{name}.{q.name}" for name, part in self.parts.items() for q in part.responses]
        found += [f"{name}.valid" for name in self.parts]
        for name, contact in self.contacts.items():
            lacks = contact.scene.geometry.lacks
            found += [f"{name}.{key}" for key in RECORDED if key not in lacks]
        return [*found, *(f"{name}.{key}" for name in self.contacts for key in self.inputs_of(name))]

    def nominals(self) -> dict[str, float]:
        """Return the nominal values of the recorded outputs."""
        found = {f"{name}.{q.name}": q.nominal for name, part in self.parts.items() for q in part.responses}
        return found | {f"{name}.{key}": TABLE[key].nominal for name in self.contacts for key in RECORDED}

    def system(
        self, folder: Path, flavour: Flavour = "embedded", contacts: Flavour | None = None, *, here: bool = False
    ) -> System:
        """Build the FMUs into a folder and couple them; contacts of one scene share a file.

        `contacts`: their flavour, if not that of the components. `here`: native FMUs for this platform only. Raises
        ContactError for parts that do not fit together, and for a contact that the flavour cannot have.
        """
        contacts = contacts or flavour
        if contacts == "native":
            self._check_radii()
        proposed = {"duration": self.settings["stop_time"], "step_size": self.settings["step_size"]}
        files = {
            name: build_part(part, folder / f"{name}.fmu", flavour, here=here, **proposed)
            for name, part in self.parts.items()
        }
        scenes: dict[str, Path] = {}
        for name, contact in self.contacts.items():
            scene = contact.own_scene if contacts == "native" else contact.scene  # native FMUs take no parameters
            key = json.dumps(scene.to_dict(), sort_keys=True)
            if key not in scenes:
                short = hashlib.sha256(key.encode()).hexdigest()[:8]
                scenes[key] = build_contact(scene, folder / f"contact_{short}.fmu", contacts, here=here)
            files[name] = scenes[key]
        own = {f"{name}.{key}": value for name, c in self.contacts.items() for key, value in c.parameters.items()}
        return System(files, self.connections, {**self.parameters, **own}, self.schedule)

    def _check_radii(self) -> None:
        """Raise SceneError if a radius changes that is built into the native FMU of its contact."""
        for name, contact in self.contacts.items():
            for radius in own_radii(contact.own_scene):
                if radius in contact.moved:
                    raise SceneError(
                        f"{name}.{radius} changes during this duty, and a native FMU of a point contact has one value "
                        "of it. Take --flavour embedded, for an exported file isolated; in Python, the components can "
                        "be native with contacts = 'isolated'."
                    )

    def inputs_of(self, contact: str) -> list[str]:
        """Return the inputs of a contact that are connected, then those that the schedule sets."""
        targets = [*(target for _, target, *_ in self.connections), *self.schedule]
        return [variable for owner, _, variable in (t.partition(".") for t in targets) if owner == contact]
