"""A spur gear pair: drive, both shafts, the mesh with a contact at every flank station, a brake, and the heat.

    [drive]            parts.speed_source.SpeedSource of the pinion
    [brake]            parts.brake.Brake of the wheel
    [shafts]           shafts.GearShafts; `pair` is that of the mesh, `stiffness` by default the mean of its teeth,
                       `start_speed` that of the duty
    [mesh]             mesh.GearMesh; pair = "fzg_c", "fzg_a" or the numbers of another one
    [gearbox]          parts.thermal.ThermalNetwork with the nodes pinion, wheel and oil (heat_flows = 1)
    [rating]           rating.Rating, for the standards in the report; optional
    [contact]          a scene with a line contact and heat.bulk = "inputs"; radius, width and tracks are the station's

Signals of the duty: speed and torque (of the pinion; the brake's torque follows), temperature (that a thermostat holds
the oil at) and ambient.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from contact_core.errors import SceneError, did_you_mean
from contact_core.quantities import TABLE, Quantity
from contact_core.scene.toml import unbuild

from ...parts.brake import Brake
from ...parts.part import Part, indexed, start_values
from ...parts.speed_source import SpeedSource
from ...parts.thermal import ThermalNetwork
from ..assembly import Schedule
from ..kind import Design, Kind
from ..tables import record, scene_of
from ..timeline import Timeline
from . import pictures, report
from .flanks import contact_at
from .geometry import FZG_A, FZG_C
from .mesh import RECEIVED, SENT, GearMesh, flank
from .rating import Rating
from .shafts import GearShafts
from .sharing import mean_stiffness

PAIRS = {"fzg_a": FZG_A, "fzg_c": FZG_C}
SIGNALS = {
    "speed": Quantity("speed", "w_1", "rad/s", "speed of the pinion", "input", display="rpm", minimum=0.0, maximum=1e4),
    "torque": Quantity("torque", "T_1", "N m", "torque of the pinion", "input", minimum=0.0, maximum=1e6),
    "temperature": TABLE["temperature"],
    "ambient": replace(TABLE["temperature"], name="ambient", text="temperature of the surroundings"),
}


def design(table: Mapping[str, Any], duty: Timeline) -> Design:
    """Return the parts, the contacts of all stations and the connections of a gear pair."""
    table = {**table, "mesh": _with_pair(table.get("mesh", {}))}
    mesh: GearMesh = record(GearMesh, table, "mesh")
    shafts = {"stiffness": f"{mean_stiffness(mesh.pair) * mesh.pair.face_width!r} N/m", **table.get("shafts", {})}
    start = {"start_speed": f"{duty.course('speed')[0][1]!r} rad/s"}  # if the file has none: that of the duty
    table["shafts"] = {"pair": table["mesh"]["pair"], **start, **shafts}
    scene = scene_of(table)
    drive: SpeedSource = record(SpeedSource, table, "drive")
    parts: dict[str, Part] = {
        "drive": drive,
        "brake": record(Brake, table, "brake"),
        "shafts": _started(record(GearShafts, table, "shafts"), duty),
        "mesh": mesh,
        "gearbox": record(ThermalNetwork, table, "gearbox"),
    }
    schedule: Schedule = dict(duty.schedule(_SETS))
    schedule["drive.speed_setpoint"] = drive.with_arrivals(duty.course("speed"))
    schedule["brake.torque_setpoint"] = [(time, mesh.pair.ratio * value) for time, value in duty.course("torque")]
    return Design(
        parts,
        {flank(k): contact_at(scene, mesh.pair, station) for k, station in enumerate(mesh.contacts, 1)},
        (*_SHAFTS, *(link for k in range(1, mesh.stations + 1) for link in _links(k))),
        schedule,
        {"rating": record(Rating, table, "rating")} if "rating" in table else {},
    )


def _started(shafts: GearShafts, duty: Timeline) -> GearShafts:
    """Return the shafts. Raises SceneError if the coupling to a drive at another speed would break the teeth."""
    drive = duty.course("speed")[0][1]
    force = abs(shafts.coupling * (drive - shafts.start_speed)) / shafts.pair.base_radius_1
    most = TABLE["load"].maximum
    if force > most:
        raise SceneError(
            f"shafts.start_speed = {shafts.start_speed:g} rad/s, but the duty begins at {drive:g} rad/s: through the "
            f"coupling, {shafts.coupling:g} N m s/rad, the teeth would get {force:.2g} N, and {most:g} N at most are "
            "possible. Leave start_speed out, which is that of the duty then, or let the duty begin there."
        )
    return shafts


def foreseen(parts: Mapping[str, Part], signals: Mapping[str, float]) -> dict[str, dict[str, float]]:
    """Return load and speeds of the contacts under signals of the duty."""
    mesh = parts["mesh"]
    assert isinstance(mesh, GearMesh)
    given = {target.partition(".")[2]: value for target, value in turning(parts, signals).items()}
    found = mesh.outputs((), start_values(mesh) | given)
    return {flank(k): {key: found[indexed(key, k)] for key in SENT} for k in range(1, mesh.stations + 1)}


def turning(parts: Mapping[str, Part], signals: Mapping[str, float]) -> dict[str, float]:
    """Return torque and speeds of the mesh under signals of the duty."""
    mesh = parts["mesh"]
    assert isinstance(mesh, GearMesh)
    speed = signals["speed"]
    return {"mesh.torque": signals["torque"], "mesh.speed_1": speed, "mesh.speed_2": speed / mesh.pair.ratio}


_SETS = {
    "speed": "drive.speed_setpoint",
    "torque": "brake.torque_setpoint",
    "temperature": "gearbox.setpoint_oil",
    "ambient": "gearbox.temperature_ambient",
}
_SHAFTS: tuple[tuple[Any, ...], ...] = (
    ("drive.speed", "shafts.speed_drive"),
    ("shafts.torque_coupling", "drive.torque"),
    ("shafts.speed_2", "brake.speed"),
    ("brake.torque", "shafts.brake_torque"),
    ("shafts.speed_1", "mesh.speed_1"),
    ("shafts.speed_2", "mesh.speed_2"),
    ("shafts.mesh_torque", "mesh.torque"),
    ("mesh.friction_torque_1", "shafts.friction_torque_1"),
    ("mesh.friction_torque_2", "shafts.friction_torque_2"),
    ("mesh.heat_flow_1", "gearbox.heat_pinion"),
    ("mesh.heat_flow_2", "gearbox.heat_wheel"),
    ("mesh.power_rolling", "gearbox.heat_oil"),
    ("gearbox.temperature_pinion", "mesh.body_temperature_1"),
    ("gearbox.temperature_wheel", "mesh.body_temperature_2"),
)


def _links(k: int) -> list[tuple[Any, ...]]:
    """Return connections of the contact at a station."""
    name = flank(k)
    sent = [(f"mesh.{indexed(key, k)}", f"{name}.{key}") for key in SENT]
    received = [(f"{name}.{key}", f"mesh.{indexed(key, k)}") for key in RECEIVED]
    return [
        *sent,
        *received,
        ("gearbox.temperature_oil", f"{name}.temperature"),
        ("gearbox.temperature_pinion", f"{name}.body_temperature_1"),
        ("gearbox.temperature_wheel", f"{name}.body_temperature_2"),
    ]


def _with_pair(table: Mapping[str, Any]) -> dict[str, Any]:
    """Return the table of the mesh with the numbers of a pair that it names."""
    pair = table.get("pair")
    if not isinstance(pair, str):
        return dict(table)
    if pair not in PAIRS:
        raise SceneError(
            f"mesh.pair = '{pair}' is not known.{did_you_mean(pair, list(PAIRS))} Known are {', '.join(PAIRS)}."
        )
    return {**table, "pair": unbuild(PAIRS[pair])}


GEAR_PAIR = Kind(
    name="gear_pair",
    tables=("drive", "brake", "shafts", "mesh", "gearbox", "rating"),
    signals=SIGNALS,
    needed=("speed", "torque"),
    design=design,
    foreseen=foreseen,
    turning=turning,
    main=("mesh.friction_coefficient", "mesh.power_loss"),
    legend=report.LEGEND,
    lines=report.lines,
    pictures=pictures.sheets,
)
