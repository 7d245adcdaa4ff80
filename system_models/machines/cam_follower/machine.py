"""Cam and flat-faced follower: drive, camshaft, a contact at every station over the cam's turn, and the heat.

    [drive]            parts.speed_source.SpeedSource of the camshaft
    [shaft]            parts.shaft.Shaft, driven through its coupling
    [cam]              part.CamFollower; the table [cam.lobe] is the cam
    [head]             parts.thermal.ThermalNetwork with the nodes cam, follower and oil (heat_flows = 1)
    [contact]          a scene with a line contact and heat.bulk = "inputs"; radius and tracks are the station's

Signals of the duty: speed (of the cam), temperature (that a thermostat holds the oil at) and ambient.
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
from .part import RECEIVED, SENT, CamFollower, contact_name
from .profile import Station

SIGNALS = {
    "speed": Quantity("speed", "w", "rad/s", "speed of the cam", "input", display="rpm", minimum=0.0, maximum=1e4),
    "temperature": TABLE["temperature"],
    "ambient": replace(TABLE["temperature"], name="ambient", text="temperature of the surroundings"),
}
_SETS = {
    "speed": "drive.speed_setpoint",
    "temperature": "head.setpoint_oil",
    "ambient": "head.temperature_ambient",
}
_SHAFT: tuple[tuple[Any, ...], ...] = (
    ("drive.speed", "shaft.speed_drive"),
    ("shaft.torque_coupling", "drive.torque"),
    ("shaft.speed", "cam.speed"),
    ("cam.friction_torque", "shaft.torque_resisting"),
    ("cam.heat_flow_1", "head.heat_cam"),
    ("cam.heat_flow_2", "head.heat_follower"),
    ("cam.power_rolling", "head.heat_oil"),
)


def design(table: Mapping[str, Any], duty: Timeline) -> Design:
    """Return the parts, the contacts of all stations and the connections of a cam and its follower."""
    cam: CamFollower = record(CamFollower, table, "cam")
    cam.check()
    drive: SpeedSource = record(SpeedSource, table, "drive")
    parts: dict[str, Part] = {
        "drive": drive,
        "shaft": record(Shaft, table, "shaft"),
        "cam": cam,
        "head": record(ThermalNetwork, table, "head"),
    }
    schedule: Schedule = dict(duty.schedule(_SETS))
    schedule["drive.speed_setpoint"] = drive.with_arrivals(duty.course("speed"))
    names = {k: contact_name(k, cam.stations) for k in range(1, cam.stations + 2)}
    return Design(
        parts,
        {names[k]: _contact(table, cam, station) for k, station in enumerate(cam.contacts, 1)},
        (*_SHAFT, *(link for k, name in names.items() for link in _links(k, name))),
        schedule,
    )


def foreseen(parts: Mapping[str, Part], signals: Mapping[str, float]) -> dict[str, dict[str, float]]:
    """Return load, speeds and radius of the contacts under signals of the duty."""
    cam = parts["cam"]
    assert isinstance(cam, CamFollower)
    found = cam.outputs((), start_values(cam) | {"speed": signals["speed"]})
    names = {k: contact_name(k, cam.stations) for k in range(1, cam.stations + 2)}
    return {name: {key: found[indexed(key, k)] for key in SENT} for k, name in names.items()}


def turning(parts: Mapping[str, Part], signals: Mapping[str, float]) -> dict[str, float]:
    """Return the speed of the cam under signals of the duty."""
    return {"cam.speed": signals["speed"]}


def _contact(table: Mapping[str, Any], cam: CamFollower, station: Station) -> Contact:
    scene = scene_of(table)
    tracks = cam.track_lengths(station, scene.film.domain)
    return Contact(scene, {f"geometry.track_length_{i}": length for i, length in enumerate(tracks, 1)})


def _links(k: int, name: str) -> list[tuple[Any, ...]]:
    """Return the connections of the contact at a station."""
    return [
        *((f"cam.{indexed(key, k)}", f"{name}.{key}") for key in SENT),
        *((f"{name}.{key}", f"cam.{indexed(key, k)}") for key in RECEIVED),
        ("head.temperature_oil", f"{name}.temperature"),
        ("head.temperature_cam", f"{name}.body_temperature_1"),
        ("head.temperature_follower", f"{name}.body_temperature_2"),
    ]


CAM_FOLLOWER = Kind(
    name="cam_follower",
    tables=("drive", "shaft", "cam", "head"),
    signals=SIGNALS,
    needed=("speed",),
    design=design,
    foreseen=foreseen,
    turning=turning,
    main=("cam.friction_torque", "cam.power_loss"),
    legend=report.LEGEND,
    lines=report.lines,
    pictures=pictures.sheets,
)
