"""A ball bearing on its shaft: motor, shaft, the bearing with a contact for every class of its contacts, and the heat.

    [drive]            parts.speed_source.SpeedSource
    [shaft]            parts.shaft.Shaft, driven through its coupling
    [bearing]          part.BallBearing
    [housing]          parts.thermal.ThermalNetwork with the nodes balls, inner, outer and oil (heat_flows = 1)
    [contact]          a scene with a point contact and heat.bulk = "inputs"; radii and tracks are the class's
    [rating]           rating.Rating, for the report of rating lives; may be left out

Signals of the duty: speed (of the shaft), load (radial), axial_load, moment (about the axis across both) and ambient.
The tracks of the contacts are those at the duty's largest loads.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from contact_core.quantities import TABLE, Quantity

from ...parts.part import Part, indexed, start_values
from ...parts.shaft import Shaft
from ...parts.speed_source import SpeedSource
from ...parts.thermal import ThermalNetwork
from ..assembly import Contact, Schedule
from ..kind import Design, Kind
from ..tables import record, scene_of
from ..timeline import Timeline
from . import pictures, report
from .equilibrium import RingLoads
from .geometry import RACES
from .part import RECEIVED, SENT, BallBearing, LoadClass, contact_name
from .rating import Rating

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
_BY_SIGNAL = {"speed": "bearing.speed"} | {
    name: _SETS[name] for name in ("load", "axial_load", "moment")
}  # inputs of the bearing
_SHAFT: tuple[tuple[Any, ...], ...] = (
    ("drive.speed", "shaft.speed_drive"),
    ("shaft.torque_coupling", "drive.torque"),
    ("shaft.speed", "bearing.speed"),
    ("bearing.friction_torque", "shaft.torque_resisting"),
    *((f"bearing.heat_flow_{node}", f"housing.heat_{node}") for node in ("balls", "inner", "outer", "oil")),
)


def design(table: Mapping[str, Any], duty: Timeline) -> Design:
    """Return the parts, the contacts of all load classes and the connections of a bearing."""
    bearing: BallBearing = record(BallBearing, table, "bearing")
    drive: SpeedSource = record(SpeedSource, table, "drive")
    parts: dict[str, Part] = {
        "drive": drive,
        "shaft": record(Shaft, table, "shaft"),
        "bearing": bearing,
        "housing": record(ThermalNetwork, table, "housing"),
    }
    schedule: Schedule = dict(duty.schedule(_SETS))
    schedule["drive.speed_setpoint"] = drive.with_arrivals(duty.course("speed"))
    classes = bearing.designs(*_largest(duty))
    moved = ("radius_x",) if _leans(bearing, duty) else ()
    return Design(
        parts,
        {each.name: _contact(table, each, moved) for each in classes},
        (*_SHAFT, *(link for each in classes for link in _links(each))),
        schedule,
        {"rating": record(Rating, {"rating": {}, **table}, "rating")},
    )


def _largest(duty: Timeline) -> tuple[RingLoads, float]:
    """Return the row of the duty with the largest force, and the largest speed [rad/s]."""
    rows = [values for _, values in duty.filled()]
    heavy = max(rows, key=lambda row: abs(row.get("load", 0.0)) + abs(row.get("axial_load", 0.0)))
    loads = RingLoads(heavy.get("axial_load", 0.0), heavy.get("load", 0.0), 0.0, 0.0, heavy.get("moment", 0.0))
    return loads, max(abs(row["speed"]) for row in rows)


def _leans(bearing: BallBearing, duty: Timeline) -> bool:
    """Return True if contact angles change, and with them radii: only a purely radial load leaves all at 0."""
    rows = [values for _, values in duty.filled()]
    return bearing.dimensions.contact_angle > 0.0 or any(row.get("axial_load") or row.get("moment") for row in rows)


def foreseen(parts: Mapping[str, Part], signals: Mapping[str, float]) -> dict[str, dict[str, float]]:
    """Return load, speeds, spin and radius of the contacts of all load classes under signals of the duty."""
    bearing = parts["bearing"]
    assert isinstance(bearing, BallBearing)
    given = {target.partition(".")[2]: value for target, value in turning(parts, signals).items()}
    inputs = start_values(bearing) | given
    found = bearing.outputs(bearing.initial(inputs), inputs)
    return {
        contact_name(race, k): {key: found[indexed(f"{key}_{race}", k)] for key in SENT}
        for race in RACES
        for k in range(1, bearing.levels + 1)
    }


def turning(parts: Mapping[str, Part], signals: Mapping[str, float]) -> dict[str, float]:
    """Return loads and speed of the bearing under signals of the duty."""
    return {target: signals.get(name, 0.0) for name, target in _BY_SIGNAL.items()}


def _contact(table: Mapping[str, Any], design: LoadClass, moved: tuple[str, ...]) -> Contact:
    """Return the contact of a load class: values of its FMU beside the connected inputs."""
    tracks = {f"geometry.track_length_{i}": getattr(design, f"track_length_{i}") for i in (1, 2)}
    values = {"radius_x": design.radius_x, "radius_y": design.radius_y, **tracks}
    return Contact(scene_of(table), values, "bearing." + indexed(f"count_{design.race}", design.level), moved)


def _links(design: LoadClass) -> list[tuple[Any, ...]]:
    """Return connections of the contact of a class."""
    name = design.name

    def port(key: str) -> str:
        return "bearing." + indexed(f"{key}_{design.race}", design.level)

    return [
        *((port(key), f"{name}.{key}") for key in SENT),
        *((f"{name}.{key}", port(key)) for key in RECEIVED),
        ("housing.temperature_oil", f"{name}.temperature"),
        ("housing.temperature_balls", f"{name}.body_temperature_1"),
        (f"housing.temperature_{design.race}", f"{name}.body_temperature_2"),
    ]


BALL_BEARING = Kind(
    name="ball_bearing",
    tables=("drive", "shaft", "bearing", "housing", "rating"),
    signals=SIGNALS,
    needed=("speed",),
    design=design,
    foreseen=foreseen,
    turning=turning,
    main=("bearing.friction_torque", "bearing.power_loss"),
    legend=report.LEGEND,
    lines=report.lines,
    pictures=pictures.sheets,
)
