"""Ball on disc, the test rig: two spindles, a load arm and an oil bath around one contact.

    [ball], [disc]     parts.spindle.Spindle; body 1 is the ball
    [arm]              parts.load_arm.LoadArm
    [bath]             parts.thermal.ThermalNetwork with a node "oil" on a thermostat; the rest as the rig is built
    [contact]          a scene with a point contact; its track lengths follow from [rig]

Signals of the duty: entrainment_speed, slide_roll_ratio = (u1 - u2) / u_e, load; temperature (that the bath is held at)
and ambient.
"""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from contact_core.errors import SceneError
from contact_core.quantities import TABLE, Quantity

from ...parts.load_arm import LoadArm
from ...parts.part import Part
from ...parts.spindle import OppositeSpindle, Spindle
from ...parts.thermal import ThermalNetwork
from ..assembly import Contact, Schedule
from ..kind import Design, Kind
from ..tables import record, scene_of
from ..timeline import Timeline
from . import report

SIGNALS = {
    q.name: q
    for q in (
        Quantity("entrainment_speed", "u_e", "m/s", "mean speed of both surfaces", "input", 1.0, -100.0, 100.0),
        Quantity("slide_roll_ratio", "SRR", "", "(u_1 - u_2) / u_e", "input", minimum=-1e3, maximum=1e3),
        TABLE["load"],
        TABLE["temperature"],
        replace(TABLE["temperature"], name="ambient", text="temperature of the surroundings"),
    )
}
_SETS = {"load": "arm.load_setpoint", "temperature": "bath.setpoint_oil", "ambient": "bath.temperature_ambient"}


def design(table: Mapping[str, Any], duty: Timeline) -> Design:
    """Return the parts, the contact and the connections of a rig."""
    parts = {
        "ball": record(Spindle, table, "ball"),
        "disc": record(OppositeSpindle, table, "disc"),
        "arm": record(LoadArm, table, "arm"),
        "bath": record(ThermalNetwork, table, "bath"),
    }
    scene = scene_of(table)
    tracks: dict[str, Any] = {
        f"geometry.track_length_{i}": 2.0 * math.pi * parts[name].radius for i, name in ((1, "ball"), (2, "disc"))
    }
    if not any(node.name == "oil" and node.heat_flows == 2 for node in parts["bath"].nodes):
        raise SceneError("The [[bath.nodes]] have no 'oil' with heat_flows = 2, one from each body. Add it.")
    return Design(parts, {"contact": Contact(scene, tracks)}, _CONNECTIONS, _schedule(duty))


_CONNECTIONS: tuple[tuple[Any, ...], ...] = (
    ("ball.surface_speed", "contact.speed_1"),
    ("disc.surface_speed", "contact.speed_2"),
    ("arm.load", "contact.load"),
    ("bath.temperature_oil", "contact.temperature"),
    ("contact.friction_force", "ball.friction_force"),
    ("contact.friction_force", "disc.friction_force"),
    ("contact.rolling_resistance", "ball.rolling_resistance"),
    ("contact.rolling_resistance", "disc.rolling_resistance"),
    ("contact.heat_flow_1", "bath.heat_oil[1]"),
    ("contact.heat_flow_2", "bath.heat_oil[2]"),
)


def foreseen(parts: Mapping[str, Part], signals: Mapping[str, float]) -> dict[str, dict[str, float]]:
    """Return load and speeds of the contact under signals of the duty."""
    mean, ratio = signals["entrainment_speed"], signals["slide_roll_ratio"]
    speeds = {f"speed_{i}": mean * (1.0 + sign * ratio) for i, sign in ((1, 0.5), (2, -0.5))}
    return {"contact": {"load": signals["load"], **speeds}}


def _schedule(duty: Timeline) -> Schedule:
    """Return the schedule of the parts; both surface speeds follow from two signals."""
    given: Schedule = {target: duty.course(name) for name, target in _SETS.items() if name in duty.rows[0][1]}
    speeds = [(time, values["entrainment_speed"], values["slide_roll_ratio"]) for time, values in duty.filled()]
    for name, sign in (("ball", 0.5), ("disc", -0.5)):
        given[f"{name}.surface_speed_setpoint"] = [(time, mean * (1.0 + sign * ratio)) for time, mean, ratio in speeds]
    return given


BALL_ON_DISC = Kind(
    name="ball_on_disc",
    tables=("ball", "disc", "arm", "bath"),
    signals=SIGNALS,
    needed=("entrainment_speed", "slide_roll_ratio", "load"),
    design=design,
    foreseen=foreseen,
    main=("contact.friction_coefficient", "contact.power_loss"),
    legend=report.LEGEND,
    lines=report.lines,
    pictures=report.pictures,
)
