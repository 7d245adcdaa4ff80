"""What a neighbour of body 2 is connected to in FMI 3.0."""

from xml.etree import ElementTree as ET

import pytest

from contact_core import Scene
from fmu_src.package.terminals import terminals
from fmu_src.variables import variables


@pytest.mark.parametrize("body", [1, 2])
def test_the_terminal_of_a_body_has_its_own_variables(body: int) -> None:
    data = terminals(variables(Scene.from_toml("mtm_zddp")))
    (found,) = (each for each in ET.fromstring(data).iter("Terminal") if each.get("name") == f"body_{body}")
    members = {str(each.get("memberName")): str(each.get("variableName")) for each in found}
    own = {name: variable for name, variable in members.items() if name != "friction_force"}  # that is on body 1
    assert len(own) == 7
    assert all(variable.endswith(f"_{body}") for variable in own.values())
    assert own["speed"] == f"speed_{body}"
