"""The named oils against what their sources print."""

import csv
import tomllib
from dataclasses import replace
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
from comparison import approx

from contact_core import Scene, SceneError
from contact_core.laws.rheology import Carreau
from contact_core.scene import Lubricant
from contact_core.scene.bases import base_of
from contact_core.scene.toml import build, read_table

TEXT = (files("contact_core") / "data" / "lubricants.toml").read_text("utf-8")
NAMES = list(tomllib.loads(TEXT))
CELSIUS = 273.15
WARM = np.array([40.0, 80.0, 100.0]) + CELSIUS

# kinematic viscosity at 40 and 100 degC [mm2/s] and density at 15.6 degC: Arana et al. 2019, Table 2
ISO_VG_100 = {"m100": (96.0, 10.6, 882.0), "pao100": (94.1, 14.0, 840.0), "n100": (97.9, 8.61, 900.0)}
# ASTM D341 A, B; family
CONSTANTS = {
    "minr": (9.0658, 3.4730, "mineral"), "paor": (7.3514, 2.7865, "pao"), "pagd": (5.7597, 2.1512, "pag"),
}  # fmt: skip
LIMITS = {"m100": 0.061, "pao100": 0.041, "n100": 0.0625, "fva3": 0.061, "minr": 0.061, "paor": 0.041, "pagd": 0.052}


def lubricant(name: str) -> Lubricant:
    return build(Lubricant, {"set": name}, "lubricant")


def kinematic(name: str, temperature):
    a, b, *_ = CONSTANTS[name]
    return 10.0 ** (10.0 ** (a - b * np.log10(temperature))) - 0.7  # mm2/s


def pressure_coefficient(name: str, temperature):
    low, high = lubricant(name).viscosity(np.array([[0.0], [1e4]]), np.asarray(temperature))
    return np.log(high / low) / 1e4


def test_every_named_oil_is_tested_here():
    assert {"azam_oil", *LIMITS} == set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_every_named_oil_has_a_source_and_says_what_is_assumed(name):
    table = tomllib.loads(TEXT)[name]
    assert len(table["source"]) > 40
    assert "ssumed" in table["source"]


@pytest.mark.parametrize("name", [*NAMES, "FVA3", "Pao100"])
def test_a_scene_takes_a_named_oil_in_any_case(name):
    table = read_table("azam_case_a")
    table["lubricant"] = {"set": name, "conductivity": "0.13 W/(m K)"}
    oil = Scene.from_dict(table).lubricant
    assert oil.conductivity == 0.13
    assert oil.viscosity == lubricant(name.lower()).viscosity


@pytest.mark.parametrize("name", ["FVA3", "m100"])
def test_another_oil_drops_what_a_scene_says_beside_its_own(name):
    assert "viscosity" in read_table("mtm_zddp")["lubricant"]  # the temperature of the old oil's viscosity
    assert Scene.from_toml("mtm_zddp", {"lubricant.set": name}).lubricant == lubricant(name)
    kept = Scene.from_toml("mtm_zddp", {"lubricant.set": "Azam_Oil"})
    assert kept.lubricant == Scene.from_toml("mtm_zddp").lubricant


def test_a_law_of_ones_own_takes_the_place_of_the_named_oils():
    carreau = {"rheology.model": "carreau", "rheology.critical_stress": "6 MPa", "rheology.exponent": "0.4"}
    sheet = {f"viscosity.{key}": value for key, value in example()["viscosity"].items()}
    oil = Scene.from_toml("azam_case_a", {f"lubricant.{k}": v for k, v in (carreau | sheet).items()}).lubricant
    assert oil.rheology == Carreau(6e6, 0.4, limiting_coefficient=0.047)  # what both laws have is the named oil's
    assert oil.viscosity == build(Lubricant, example(), "lubricant").viscosity
    assert oil.density == lubricant("azam_oil").density
    softer = Scene.from_toml("azam_case_a", {"lubricant.rheology.eyring_stress": "3 MPa"}).lubricant
    assert softer.rheology == replace(lubricant("azam_oil").rheology, eyring_stress=3e6)


@pytest.mark.parametrize(("name", "cold", "hot"), [("m100", -8, 4), ("pao100", 7, -4), ("n100", -20, 8)])
def test_fitted_constants_are_as_far_from_the_data_sheet_as_their_source_says(name, cold, hot):
    nu_40, nu_100, density = ISO_VG_100[name]
    temperature = np.array([40.0, 100.0]) + CELSIUS
    expected = np.array([nu_40, nu_100]) * 1e-6 * density * (1.0 - 7e-4 * (temperature - 15.6 - CELSIUS))
    found = 100.0 * (lubricant(name).viscosity(np.zeros(2), temperature) / expected - 1.0)
    print(f"{name}: {found[0]:+.1f} % at 40 degC, {found[1]:+.1f} % at 100 degC")
    assert found == approx([cold, hot], abs=0.5)
    said = tomllib.loads(TEXT)[name]["source"]
    for percent in (cold, hot):
        assert f"{abs(percent)} % {'above' if percent > 0 else 'below'}" in said


def test_modulus_oils_have_the_viscosities_computed_from_the_printed_constants():
    assert lubricant("m100").viscosity(np.zeros(2), WARM[[0, 2]]) == approx([76.9e-3, 9.14e-3], rel=1e-3)
    assert lubricant("pao100").viscosity(np.zeros(1), WARM[:1]) == approx([83.5e-3], rel=1e-3)
    assert lubricant("n100").viscosity(np.zeros(1), WARM[:1]) == approx([69.7e-3], rel=1e-3)


def test_fva3_has_its_measured_viscosity_to_a_gigapascal():
    with (Path(__file__).parents[1] / "data" / "fva3_viscosity.csv").open() as file:
        rows = [[float(value) for value in row] for row in list(csv.reader(file))[1:]]
    for celsius, at_rest, *under in rows:  # of Wingertszahn et al. 2023, evaluated from their printed parameters
        viscosity = lubricant("fva3").viscosity(np.array([0.0, 1e8, 4e8, 1e9]), celsius + CELSIUS)
        assert viscosity == approx([1e-3 * at_rest, *under], rel=2e-3), celsius


@pytest.mark.parametrize("name", CONSTANTS)
def test_oils_of_a_chart_have_its_kinematic_viscosities_and_what_their_family_gives(name):
    oil = lubricant(name).viscosity
    found = np.array([oil.viscosity_40, oil.viscosity_100]) * 1e6
    assert found == approx(kinematic(name, WARM[[0, 2]]), rel=5e-5)
    between = oil(np.zeros(1), WARM[1:2]) / (oil.density * (1.0 - oil.expansion * 65.0)) * 1e6
    assert between == approx(kinematic(name, WARM[1:2]), rel=2e-4)
    family = base_of(CONSTANTS[name][-1]).oil(replace(oil, pressure_coefficient=0.0))
    shown = [oil.pressure_coefficient, oil.bend_40, oil.bend_100]
    assert shown == approx([family.pressure_coefficient, family.bend_40, family.bend_100], rel=5e-3)


@pytest.mark.parametrize("name", LIMITS)
def test_pressure_coefficients_and_shear_stresses_are_those_of_oils(name):
    coefficient = pressure_coefficient(name, WARM)
    assert np.all((coefficient > 9e-9) & (coefficient < 28e-9))  # polyglycols lowest, naphthenic oils highest
    rheology = lubricant(name).rheology
    assert rheology.limiting_coefficient == LIMITS[name]
    thick, thin = lubricant(name).viscosity(np.array([1e9, 0.0]), WARM[1])
    warm = LIMITS[name] * rheology.limiting_left(WARM[1])
    assert rheology.eyring_stress == approx(2.0 * warm / (1e-9 * np.log(thick / thin)), rel=0.015)


def example() -> dict:
    """The oil written down in the head of the file."""
    lines = [line[6:] for line in TEXT.splitlines() if line.startswith("#     ")]
    start = next(i for i, line in enumerate(lines) if line.startswith("viscosity.model"))
    return tomllib.loads("\n".join(["[lubricant]", *lines[start:]]))["lubricant"]


def test_the_example_of_an_oil_of_ones_own_is_one_table_that_a_scene_takes():
    table = read_table("azam_case_a") | {"lubricant": example()}
    scene = Scene.from_dict(table)
    oil = scene.lubricant.viscosity
    assert (oil.viscosity_40, oil.viscosity_100) == approx((46e-6, 6.8e-6), rel=1e-12)
    assert oil(np.zeros(1), 313.15)[0] == approx(46e-6 * 870.0 * (1.0 - 7e-4 * 25.0), rel=1e-9)
    assert Scene.from_dict(scene.to_dict()) == scene


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("viscosity_100", "60 mm2/s", ["viscosity_100 = 6e-05 m2/s", "viscosity_40 = 4.6e-05 m2/s", "Exchange"]),
        ("bend_40", "0.2", ["bend_100 = 0.0", "at least bend_40 = 0.2", "Give both"]),
        ("viscosity_40", "46 mm2", ["viscosity_40 = '46 mm2'", "wrong unit", "m2/s"]),
        ("viscosity_40", "46", ["no unit", "m2/s"]),
        ("density", "0.87 kg/m3", ["lubricant.viscosity.density = 0.87 kg/m3", "at least 600"]),
        ("pressure_coefficient", "20 Pa^-1", ["pressure_coefficient = 20 Pa^-1", "at most 1e-07"]),
    ],
)
def test_an_oil_that_cannot_be_is_refused_with_what_would_be_right(key, value, said):
    oil = example()
    oil["viscosity"][key] = value
    with pytest.raises(SceneError) as refused:
        Scene.from_dict(read_table("azam_case_a") | {"lubricant": oil})
    for part in said:
        assert part in str(refused.value)


def test_a_pole_of_the_modulus_equation_in_temperature_is_out_of_range():
    table = read_table("azam_case_a")
    table["lubricant"] = {"set": "m100", "viscosity": {"vogel_offset": "-240 K"}}
    with pytest.raises(SceneError, match=r"vogel_offset = -240 K .* at least -225"):
        Scene.from_dict(table)
