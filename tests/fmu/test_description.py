"""modelDescription.xml is complete, and agrees with the core."""

import math
import zipfile
from dataclasses import replace
from xml.etree import ElementTree as ET

import fmpy
import pytest
from comparison import approx
from fmpy.validation import validate_fmu
from fmu_host import SHAPES

from contact_core import Scene
from contact_core.assumed import assumed
from contact_core.assumed import text as words
from contact_core.quantities import INPUTS, OF_CALLER, OUTPUTS
from contact_core.scene import tunables
from contact_core.state import Outputs
from fmu_src.package.build import build
from fmu_src.runtime.resources import VERSIONS, guid, module_name
from fmu_src.variables import variables


@pytest.fixture(scope="module")
def description(fmu_file):
    return fmpy.read_model_description(str(fmu_file))


@pytest.fixture(scope="module")
def by_name(description):
    return {v.name: v for v in description.modelVariables}


@pytest.fixture(scope="module")
def xml(fmu_file):
    with zipfile.ZipFile(fmu_file) as archive:
        return ET.fromstring(archive.read("modelDescription.xml"))


def test_fmpy_finds_no_problem(fmu_file):
    assert validate_fmu(str(fmu_file)) == []


def test_every_quantity_is_a_variable_with_its_unit_and_nominal(by_name):
    for q in (*INPUTS, *OUTPUTS):
        variable = by_name[q.name]
        assert variable.causality == ("input" if q.role == "input" else "output")
        assert variable.type == q.kind
        assert variable.description.partition("; by what the scene assumes")[0] == q.text
        if q.kind == "Real":
            assert (variable.unit, float(variable.nominal)) == (q.unit, q.nominal)
            assert variable.displayUnit == (q.display or None)
        else:
            assert variable.variability == "discrete"


def test_every_real_has_a_unit_and_a_nominal_above_zero(by_name):
    reals = [v for v in by_name.values() if v.type == "Real" and v.name != "time"]
    assert {v.causality for v in reals} == {"input", "output", "parameter"}
    assert all(v.unit and 0.0 < float(v.nominal) < math.inf for v in reals)


def test_a_parameter_that_starts_at_zero_has_a_nominal_all_the_same():
    scene = Scene.from_toml("mtm_zddp", {"surface_1.rq": "0 m", "wear.film": "0"})
    nominals = {v.name: (v.start, v.nominal) for v in variables(scene)}
    assert nominals["surface_1.rq"] == (0.0, approx(1e-7))
    assert nominals["wear.film"] == (0.0, approx(1e-3))
    assert nominals["surface_2.rq"] == (1.3e-7, 1.3e-7)


def test_the_kinds_of_change_are_those_that_fmi_allows(by_name, xml):
    kinds = {(v.causality, v.type == "Real", v.variability, v.initial) for v in by_name.values()}
    assert kinds == {
        ("input", True, "continuous", "exact"),  # the reader's word: the description must not say it
        ("parameter", True, "fixed", "exact"),
        ("parameter", False, "fixed", "exact"),
        ("parameter", False, "tunable", "exact"),
        ("output", True, "continuous", "calculated"),
        ("output", False, "discrete", "calculated"),
        ("independent", True, "continuous", None),
    }
    assert [v.name for v in by_name.values() if v.variability == "tunable"] == ["fidelity"]
    assert all(v.get("initial") is None for v in xml.iter("ScalarVariable") if v.get("causality") == "input")


def test_time_is_the_last_variable_and_has_what_fmi_allows_it(xml):
    last = xml.find("ModelVariables")[-1]
    assert (last.get("name"), last.get("causality"), last.get("initial")) == ("time", "independent", None)
    assert last[0].attrib == {"declaredType": "Time", "unit": "s"}


def test_temperature_differences_are_marked_as_relative(xml):
    marked = {v.get("name") for v in xml.iter("ScalarVariable") if v[0].get("relativeQuantity") == "true"}
    assert marked == {q.name for q in (*INPUTS, *OUTPUTS) if q.relative}
    assert "flash_temperature_rise" in marked


def test_every_output_is_filled_by_the_core_or_its_caller(by_name):
    outputs = {name for name, v in by_name.items() if v.causality == "output"}
    assert outputs == {*Outputs.__dataclass_fields__, *OF_CALLER}


def test_every_tunable_of_the_scene_is_a_fixed_parameter_at_its_exact_value(by_name, scene):
    for name, (value, field) in tunables(scene).items():
        variable = by_name[name]
        assert (variable.causality, variable.variability, variable.initial) == ("parameter", "fixed", "exact")
        assert type(value)(variable.start) == value
        assert variable.description == field.metadata["text"]
        assert variable.min is not None
        assert variable.max is not None
    assert by_name["lubricant.viscosity.viscosity"].unit == "Pa s"
    assert by_name["surface_1.seed"].type == "Integer"
    assert by_name["initial_state"].type == "String"


def test_the_inputs_start_at_the_scenes_operation(by_name, scene):
    for q in INPUTS:
        if q.name not in ("radius_x", "radius_y"):
            value = getattr(scene.operation, q.name)
            assert float(by_name[q.name].start) == (scene.operation.temperature if value is None else value)


def test_radii_are_inputs_that_start_at_the_scenes_and_no_parameters(by_name, scene):
    for name in ("radius_x", "radius_y"):
        radius = by_name[name]
        assert (radius.causality, radius.unit, radius.displayUnit) == ("input", "m", "mm")
        assert float(radius.start) == getattr(scene.geometry, name)
        assert f"geometry.{name}" not in by_name


def test_units_are_exponents_of_the_base_units(xml):
    units = {u.get("name"): u.find("BaseUnit").attrib for u in xml.iter("Unit")}
    assert units["Pa"] == {"kg": "1", "m": "-1", "s": "-2"}
    assert units["N"] == {"kg": "1", "m": "1", "s": "-2"}
    assert units["W/(m K)"] == {"kg": "1", "m": "1", "s": "-3", "K": "-1"}
    assert units["m3/s"] == {"m": "3", "s": "-1"}
    assert units["1"] == {}


QUANTITIES = {
    "load": "Force",
    "spin": "AngularVelocity",
    "temperature": "ThermodynamicTemperature",
    "flash_temperature_rise": "TemperatureDifference",
    "pressure_max": "Pressure",
    "lubricant.rheology.eyring_stress": "Stress",
    "heat.diffusivity_1": "ThermalDiffusivity",
    "wear_rate_1": "VolumeFlowRate",
    "suggested_step": "Time",
    "time": "Time",
    "friction_coefficient": None,
    "fidelity": None,
}


def test_a_variable_says_what_it_measures(by_name):
    declared = {name: by_name[name].declaredType for name in QUANTITIES}
    assert {name: found and found.name for name, found in declared.items()} == QUANTITIES


def test_a_type_is_that_of_its_variables(xml):
    types = {t.get("name"): t.find("Real").attrib for t in xml.iter("SimpleType")}
    used = set()
    for variable in xml.iter("ScalarVariable"):
        if name := variable[0].get("declaredType"):
            used.add(name)
            for attribute in ("unit", "relativeQuantity"):
                assert types[name].get(attribute) == variable[0].get(attribute), (variable.get("name"), attribute)
            assert types[name].get("displayUnit") in (None, variable[0].get("displayUnit"))
    assert used == set(types)
    assert {t["quantity"] for n, t in types.items() if "Temperature" in n} == {"ThermodynamicTemperature"}


def test_no_difference_of_temperatures_is_shown_with_an_offset():
    law = {"model": "modulus", "vogel_viscosity": "6e-5 Pa s", "vogel_slope": "1000 K", "vogel_offset": "-110 K"}
    law |= {"modulus": "30 MPa", "modulus_slope": "50 kPa/K", "bend": "0.5", "bend_slope": "1e-3 K^-1"}
    scene = Scene.from_toml("mtm_zddp", {f"lubricant.viscosity.{key}": value for key, value in law.items()})
    shown = {v.name.rpartition(".")[2]: (v.relative, v.display) for v in variables(scene)}
    assert shown["vogel_slope"] == shown["vogel_offset"] == (True, "")
    assert shown["temperature"] == (False, "degC")


def test_parameters_are_shown_in_the_units_that_people_read(by_name):
    names = ("plasticity.hardness", "lubricant.rheology.eyring_stress", "surface_2.rq", "geometry.track_length_1")
    assert [by_name[name].displayUnit for name in names] == ["GPa", "MPa", "nm", "mm"]
    assert by_name["lubricant.viscosity.reference_temperature"].displayUnit == "degC"
    assert all(v.displayUnit for v in by_name.values() if v.unit in ("Pa", "m"))


def test_fidelity_is_of_a_type_that_every_host_sets(by_name):
    """libcosim and ecos silently set no Enumeration."""
    assert by_name["fidelity"].type == by_name["fidelity_used"].type == "Integer"


def test_display_units_convert_from_si(xml):
    units = {d.get("name"): d for d in xml.iter("DisplayUnit")}
    displays = {name: (float(d.get("factor", 1)), float(d.get("offset", 0))) for name, d in units.items()}
    assert displays["nm"] == (1e9, 0.0)
    assert displays["um3"] == (1e18, 0.0)
    assert displays["GPa"] == (1e-9, 0.0)
    assert displays["degC"] == (1.0, -273.15)


def test_outputs_depend_on_the_state_between_steps_and_on_every_known_at_the_start(description):
    outputs = [v for v in description.modelVariables if v.causality == "output"]
    assert [u.variable for u in description.outputs] == outputs
    assert all(u.dependencies == [] for u in description.outputs)
    assert [u.variable for u in description.initialUnknowns] == outputs
    assert all(u.dependencies is None for u in description.initialUnknowns)  # which says all


def test_radii_start_at_the_operations_else_at_the_geometrys(scene):
    told = replace(scene, operation=replace(scene.operation, radius_x=0.007))
    starts = {v.name: v.start for v in variables(told)}
    assert (starts["radius_x"], starts["radius_y"]) == (0.007, scene.geometry.radius_y)


def test_the_default_experiment_is_the_scenes_operation(description, scene):
    experiment = description.defaultExperiment
    assert float(experiment.stopTime) == scene.operation.duration
    assert float(experiment.stepSize) == scene.operation.interval
    assert float(experiment.tolerance) == scene.film.tolerance


def test_states_can_be_kept_and_instances_shared(description):
    assert description.coSimulation.canGetAndSetFMUstate
    assert description.coSimulation.canSerializeFMUstate
    assert not description.coSimulation.canBeInstantiatedOnlyOncePerProcess


def test_the_same_scene_gives_the_same_bytes(fmu_file, scene, tmp_path):
    assert build(scene, tmp_path / "again.fmu", "embedded").read_bytes() == fmu_file.read_bytes()


def test_another_scene_has_another_guid_and_script(fmu_file, other_scene, tmp_path):
    def identity(fmu):
        with zipfile.ZipFile(fmu) as archive:
            root = ET.fromstring(archive.read("modelDescription.xml"))
            return root.get("guid"), archive.read("resources/slavemodule.txt")

    mine, other = identity(fmu_file), identity(build(other_scene, tmp_path / "other.fmu", "embedded"))
    assert mine[0] != other[0]
    assert mine[1] != other[1]


@pytest.mark.parametrize("package", VERSIONS)
def test_the_same_scene_of_other_versions_has_another_guid_and_script(scene, monkeypatch, package):
    mine = guid(scene, "isolated"), module_name(scene)
    monkeypatch.setitem(VERSIONS, package, "99.0")
    other = guid(scene, "isolated"), module_name(scene)
    assert mine[0] != other[0]
    assert mine[1] != other[1]


def test_the_documentation_names_laws_variables_and_flags(fmu_file):
    with zipfile.ZipFile(fmu_file) as archive:
        page = archive.read("documentation/index.html").decode()
    for part in ("lubricant.viscosity: roelands", "friction_coefficient", "wear.bare", "range_flags is"):
        assert part in page


# what means nothing to a shape is absent, not zero


@pytest.mark.parametrize(
    ("shape", "absent"),
    [("line", {"radius_y", "spin", "spin_torque"}), ("roller", {"radius_y"}), ("ellipse", set())],
)
@pytest.mark.parametrize("level", ["deterministic", "regression"])
def test_an_fmu_has_the_quantities_of_its_shape(shape, absent, level):
    name, changes = SHAPES[shape]
    scene = Scene.from_toml(name, changes).at_level(level)
    listed = {v.name for v in variables(scene) if v.causality in ("input", "output")}
    assert listed == {q.name for q in (*INPUTS, *OUTPUTS) if q.role == "input" or level in q.levels} - absent
    assert "geometry.radius_x" not in {v.name for v in variables(scene)}


def test_the_fmu_of_a_line_is_described_whole(line_file, line_scene):
    assert validate_fmu(str(line_file)) == []
    description = fmpy.read_model_description(str(line_file))
    by_name = {v.name: v for v in description.modelVariables}
    assert [v.valueReference for v in description.modelVariables] == list(range(len(by_name)))
    assert float(by_name["geometry.face_width"].start) == line_scene.geometry.face_width
    assert float(by_name["load"].start) == line_scene.operation.load
    assert by_name["load"].unit == "N"


def test_outputs_say_what_the_assumptions_of_the_scene_are_worth(by_name, scene):
    worth = assumed(scene, scene.operation.point)
    for name, each in worth.items():
        for output in {name, f"{name}_1"} & set(by_name):
            said = f"by what the scene assumes +- {words(name, each.together)} at its own operating point"
            assert by_name[output].description.endswith(said)
    assert "assumes" not in by_name["lambda_ratio"].description
