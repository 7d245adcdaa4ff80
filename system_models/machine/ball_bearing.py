"""A ball bearing on its shaft: motor, shaft, the bearing with a contact for every class of its contacts, and the heat.

    [drive]            parts.speed_source.SpeedSource
    [shaft]            parts.shaft.Shaft, driven through its coupling
    [bearing]          bearing.part.BallBearing
    [housing]          parts.thermal.ThermalNetwork with the nodes balls, inner, outer and oil (heat_flows = 1)
    [contact]          a scene with a point contact and heat.bulk = "inputs"; radii and tracks are the class's

Signals of the duty: speed (of the shaft), load (radial), axial_load, moment (about the axis across both) and ambient.
The tracks of the contacts are those at the duty's largest loads.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from contact_core.quantities import TABLE, Quantity

from ..bearing.equilibrium import RingLoads
from ..bearing.part import BallBearing, Design
from ..parts.part import Part, indexed
from ..parts.shaft import Shaft
from ..parts.speed_source import SpeedSource
from ..parts.thermal import ThermalNetwork
from . import reading, timeline
from .assembly import Assembly, Contact, Schedule

SENT = ("load", "speed_1", "speed_2", "spin", "radius_x")
RECEIVED = ("friction_force", "spin_torque", "rolling_resistance", "heat_flow_1", "heat_flow_2")
SIGNALS = {
    "speed": Quantity("speed", "w", "rad/s", "speed of the shaft", "input", display="rpm", minimum=-1e4, maximum=1e4),
    "load": Quantity("load", "F_r", "N", "radial load on the inner ring", "input", minimum=0.0, maximum=1e6),
    "axial_load": Quantity(
        "axial_load", "F_a", "N", "axial load on the inner ring", "input", minimum=-1e6, maximum=1e6
    ),
    "moment": Quantity("moment", "M_z", "N m", "moment on the inner ring", "input", minimum=-1e5, maximum=1e5),
    "ambient": replace(TABLE["temperature"], name="ambient", text="temperature of the surroundings"),
}
_SETS = {
    "speed": "drive.speed_setpoint",
    "load": "bearing.force_y",
    "axial_load": "bearing.force_x",
    "moment": "bearing.moment_z",
    "ambient": "housing.temperature_ambient",
}
_SHAFT: tuple[tuple[Any, ...], ...] = (
    ("drive.speed", "shaft.speed_drive"),
    ("shaft.torque_coupling", "drive.torque"),
    ("shaft.speed", "bearing.speed"),
    ("bearing.friction_torque", "shaft.torque_resisting"),
    *((f"bearing.heat_flow_{node}", f"housing.heat_{node}") for node in ("balls", "inner", "outer", "oil")),
)


def class_name(design: Design) -> str:
    """Name of the contact of a class: of the inner or outer race, from the lightest level on."""
    return f"{design.race}_{design.level}"


def assemble(machine: reading.Machine) -> Assembly:
    """The co-simulation of a bearing. Raises SceneError for what is missing, unknown or out of range."""
    reading.check_keys(
        machine,
        *("description", "drive", "shaft", "bearing", "housing", "contact", "deterministic", "duty", "simulate"),
    )
    table = machine.table
    bearing: BallBearing = reading.record(BallBearing, table, "bearing")
    drive: SpeedSource = reading.record(SpeedSource, table, "drive")
    parts: dict[str, Part] = {
        "drive": drive,
        "shaft": reading.record(Shaft, table, "shaft"),
        "bearing": bearing,
        "housing": reading.record(ThermalNetwork, table, "housing"),
    }
    duty = timeline.read(table.get("duty", {}), SIGNALS, machine.folder, ("speed",))
    schedule: Schedule = dict(duty.schedule(_SETS))
    schedule["drive.speed_setpoint"] = drive.with_arrivals(duty.course("speed"))
    designs = bearing.designs(*_largest(duty))
    return Assembly(
        machine.name,
        str(table["description"]),
        parts,
        reading.at_levels({class_name(design): _contact(table, design) for design in designs}, table),
        (*_SHAFT, *(link for design in designs for link in _links(design))),
        {},
        schedule,
        reading.simulation(table, duty.end),
    )


def _largest(duty: timeline.Timeline) -> tuple[RingLoads, float]:
    """The row of the duty with the largest force, and the largest speed [rad/s]."""
    rows = [values for _, values in duty.filled()]
    heavy = max(rows, key=lambda row: abs(row.get("load", 0.0)) + abs(row.get("axial_load", 0.0)))
    loads = RingLoads(heavy.get("axial_load", 0.0), heavy.get("load", 0.0), 0.0, 0.0, heavy.get("moment", 0.0))
    return loads, max(abs(row["speed"]) for row in rows)


def _contact(table: Mapping[str, Any], design: Design) -> Contact:
    """The contact of a class: what its FMU is told beside what changes."""
    tracks = {f"geometry.track_length_{i}": getattr(design, f"track_length_{i}") for i in (1, 2)}
    told = {"radius_x": design.radius_x, "radius_y": design.radius_y, **tracks}
    return Contact(reading.scene_of(table), told, "bearing." + indexed(f"count_{design.race}", design.level))


def _links(design: Design) -> list[tuple[Any, ...]]:
    """Connections of the contact of a class."""
    name = class_name(design)

    def port(key: str) -> str:
        return "bearing." + indexed(f"{key}_{design.race}", design.level)

    return [
        *((port(key), f"{name}.{key}") for key in SENT),
        *((f"{name}.{key}", port(key)) for key in RECEIVED),
        ("housing.temperature_oil", f"{name}.temperature"),
        ("housing.temperature_balls", f"{name}.body_temperature_1"),
        (f"housing.temperature_{design.race}", f"{name}.body_temperature_2"),
    ]
