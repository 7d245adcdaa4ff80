"""The description of a native FMU names no value that the FMU refuses."""

import shutil

import fmpy
import pytest
from built import Built

from contact_core import Scene
from fmu_src.flavours import Version
from fmu_src.native import build as native_build
from fmu_src.native.built_in import native_variables
from fmu_src.variables import variables
from system_models.parts.brake import Brake

pytestmark = [pytest.mark.fmu, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]

RADII = ["radius_x", "radius_y"]


@pytest.fixture(autouse=True)
def gcc(monkeypatch: pytest.MonkeyPatch) -> None:
    """Build with gcc: zig takes seconds to start."""
    monkeypatch.setattr(native_build, "default_compiler", lambda: "gcc")


def held(listed: list) -> list[str]:
    """Names of the variables that can have their start value only."""
    return [v.name for v in listed if v.start is not None and v.min == v.max == v.start]


@pytest.mark.parametrize("fmi", [2, 3])
def test_parameters_and_radii_of_a_point_have_their_start_values_only(quick: Scene, fmi: Version, built: Built) -> None:
    fmu = built.fmu(quick, "native", fmi=fmi, here=True)
    listed = fmpy.read_model_description(str(fmu)).modelVariables
    parameters = [v for v in listed if v.causality == "parameter"]
    assert held(listed) == RADII + [v.name for v in parameters if v.type != "String"]
    assert {v.variability for v in parameters} == {"fixed"}
    assert [v.name for v in listed] == [v.name for v in variables(quick)]


def test_the_radius_of_a_line_is_an_input_like_others(line_scene: Scene) -> None:
    table = {v.name: v for v in native_variables(line_scene.at_level("regression"))}
    assert table["radius_x"].minimum < table["radius_x"].maximum


def test_a_component_has_the_start_values_of_its_parameters_only(built: Built) -> None:
    file = built.fmu(Brake(), "native", here=True)
    listed = fmpy.read_model_description(str(file)).modelVariables
    assert held(listed) == [v.name for v in listed if v.causality == "parameter"] != []
