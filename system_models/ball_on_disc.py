"""Ball on disc, the test rig: two spindles, a load arm and an oil bath around one contact.

    [ball], [disc]     parts.spindle.Spindle; body 1 is the ball
    [arm]              parts.load_arm.LoadArm
    [bath]             parts.thermal.ThermalNetwork with a node "oil" on a thermostat; the rest as the rig is built
    [contact]          a scene with a point contact; its track lengths follow from [rig]

Signals of the duty: speed_ball, speed_disc (of the surfaces), load, temperature (of the bath's thermostat), ambient.
"""

import math
from typing import Any

from contact_core.errors import SceneError

from . import machines, timeline
from .assembly import Assembly, Contact
from .parts.load_arm import LoadArm
from .parts.spindle import Spindle
from .parts.thermal import ThermalNetwork

SIGNALS = {
    "speed_ball": "ball.surface_speed_setpoint",
    "speed_disc": "disc.surface_speed_setpoint",
    "load": "arm.load_setpoint",
    "temperature": "bath.setpoint_oil",
    "ambient": "bath.temperature_ambient",
}


def assemble(machine: machines.Machine) -> Assembly:
    """The co-simulation of a rig. Raises SceneError for what is missing, unknown or out of range."""
    machines.check_keys(
        machine, "description", "ball", "disc", "arm", "bath", "contact", "deterministic", "duty", "simulate"
    )
    table = machine.table
    parts = {
        "ball": machines.record(Spindle, table, "ball"),
        "disc": machines.record(Spindle, table, "disc"),
        "arm": machines.record(LoadArm, table, "arm"),
        "bath": machines.record(ThermalNetwork, table, "bath"),
    }
    scene = machines.scene_of(table)
    tracks: dict[str, Any] = {
        f"geometry.track_length_{i}": 2.0 * math.pi * parts[name].radius for i, name in ((1, "ball"), (2, "disc"))
    }
    contacts = machines.at_levels({"contact": Contact(scene, tracks)}, table)
    if not any(node.name == "oil" and node.heat_flows == 2 for node in parts["bath"].nodes):
        raise SceneError("The [[bath.nodes]] have no 'oil' with heat_flows = 2, one from each body. Add it.")
    duty = timeline.read(table.get("duty", {}), SIGNALS, parts, machine.folder)
    return Assembly(
        machine.name,
        str(table["description"]),
        parts,
        contacts,
        (
            ("ball.surface_speed", "contact.speed_1"),
            ("disc.surface_speed", "contact.speed_2"),
            ("arm.load", "contact.load"),
            ("bath.temperature_oil", "contact.temperature"),
            ("contact.friction_force", "ball.friction_force"),
            ("contact.friction_force", "disc.friction_force", -1.0),
            ("contact.rolling_resistance", "ball.rolling_resistance"),
            ("contact.rolling_resistance", "disc.rolling_resistance"),
            ("contact.heat_flow_1", "bath.heat_oil[1]"),
            ("contact.heat_flow_2", "bath.heat_oil[2]"),
        ),
        {},
        duty.schedule,
        machines.simulation(table, duty.end),
    )
