"""terminalsAndIcons/terminalsAndIcons.xml of FMI 3.0: variables that belong together, and the icon.

A terminal is what one neighbour of the contact is connected to: a body, the normal direction, the spin, the oil.
"""

from collections.abc import Sequence
from xml.etree import ElementTree as ET

from ..variables import Variable
from .describe import document
from .fmi3 import VERSION

FOLDER = "terminalsAndIcons"
_BODY = {  # member: variable, without the body's number
    "speed": "speed",
    "bulk_temperature": "body_temperature",
    "temperature": "temperature",
    "heat_flow": "heat_flow",
    "wear_depth": "wear_depth",
    "tribofilm": "tribofilm",
    "roughness": "roughness",
}
_TERMINALS: dict[str, tuple[str, dict[str, str]]] = {
    "body_1": (
        "body 1: motion, friction on it along +x, heat, surface",
        {"friction_force": "friction_force"} | {member: f"{name}_1" for member, name in _BODY.items()},
    ),
    "body_2": (
        "body 2: motion, heat, surface; the friction on it is the opposite of that on body 1",
        {member: f"{name}_2" for member, name in _BODY.items()},
    ),
    "normal": (
        "load and approach of the bodies",
        {"load": "load", "approach": "approach", "radius_x": "radius_x", "radius_y": "radius_y"},
    ),
    "spin": ("spin and friction torque about the axis from x to y", {"speed": "spin", "torque": "spin_torque"}),
    "oil": ("temperature of the oil, and the friction power", {"temperature": "temperature", "power": "power_loss"}),
}
_HALF = 100.0  # half the side of the icon, in units of the coordinate system
_SCALE = 0.1  # mm per unit


def terminals(table: Sequence[Variable]) -> bytes:
    """Return the file for the variables of an FMU; terminals without any of them are left out."""
    root = ET.Element("fmiTerminalsAndIcons", {"fmiVersion": VERSION})
    corners = {"x1": f"{-_HALF}", "y1": f"{-_HALF}", "x2": f"{_HALF}", "y2": f"{_HALF}"}
    picture = ET.SubElement(root, "GraphicalRepresentation")
    ET.SubElement(picture, "CoordinateSystem", corners | {"suggestedScalingFactorTo_mm": f"{_SCALE}"})
    ET.SubElement(picture, "Icon", corners)
    present = {v.name for v in table}
    listed = ET.SubElement(root, "Terminals")
    for name, (text, members) in _TERMINALS.items():
        found = {member: variable for member, variable in members.items() if variable in present}
        if found:
            # a bus: a neighbour connects those members that it has
            terminal = ET.SubElement(listed, "Terminal", {"name": name, "matchingRule": "bus", "description": text})
            for member, variable in found.items():
                ET.SubElement(
                    terminal,
                    "TerminalMemberVariable",
                    {"variableName": variable, "memberName": member, "variableKind": "signal"},
                )
    return document(root)
