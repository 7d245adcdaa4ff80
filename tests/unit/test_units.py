import pytest
from comparison import approx

from contact_core.errors import SceneError
from contact_core.scene import units


@pytest.mark.parametrize(
    ("text", "si_unit", "value"),
    [
        ("1.26 GPa", "Pa", 1.26e9),
        ("8 um", "m", 8e-6),
        ("8 \u00b5m", "m", 8e-6),  # the sign for micro
        ("8 \u03bcm", "m", 8e-6),  # the Greek letter, which looks the same
        ("127nm", "m", 127e-9),
        ("4 mPa s", "Pa s", 4e-3),
        ("4 mPa.s", "Pa s", 4e-3),
        ("40 cP", "Pa s", 0.04),
        ("14.94 GPa^-1", "Pa^-1", 14.94e-9),
        ("6.799e-4 s^-1", "s^-1", 6.799e-4),
        ("30 min^-1", "s^-1", 0.5),
        ("3000 rpm", "rad/s", 314.1592653589793),
        ("46 W/(m K)", "W/(m K)", 46.0),
        ("0.5 kJ/K", "J/K", 500.0),
        ("20 mW/K", "W/K", 0.02),
        ("12.5 mm2/s", "m2/s", 1.25e-5),
        ("46 cSt", "m2/s", 46e-6),
        ("3 um^3/s", "m3/s", 3e-18),
        ("7800 kg/m3", "kg/m3", 7800.0),
        ("0.87 kg/l", "kg/m3", 870.0),
        ("0.87 g/ml", "kg/m3", 870.0),
        ("1 J", "N m", 1.0),
        ("0.8 eV", "J", 0.8 * 1.602176634e-19),
        ("65 kJ/mol", "J", 65e3 / 6.02214076e23),  # per molecule
        ("0.13 nm3", "m3", 0.13e-27),
        ("2e-8 1/(Pa m)", "1/(Pa m)", 2e-8),
        ("90 degC", "K", 363.15),
        ("20 °C", "K", 293.15),
        ("-1e-3 kN", "N", -1.0),
        ("2 h", "s", 7200.0),
        ("5 %", "", 0.05),
        ("3e-3", "", 3e-3),
        (1e-5, "", 1e-5),
        (129, "", 129.0),
    ],
)
def test_text_with_a_unit_becomes_si(text, si_unit, value):
    assert units.parse(text, si_unit, "field") == approx(value, rel=1e-15, abs=0.0)


@pytest.mark.parametrize(("text", "value"), [("8 um", 8e-6), ("127 nm", 127e-9), ("0.5 mm", 0.5e-3)])
def test_small_prefixes_lose_no_digit(text, value):
    assert units.parse(text, "m", "field") == value


@pytest.mark.parametrize(
    ("given", "si_unit", "expected"),
    [
        ("10 Pa", "m", ["'10 Pa'", "wrong unit", "m."]),
        ("10 N/m", "N", ["wrong unit", "N."]),
        ("5 m", "", ["wrong unit", "plain number"]),
        ("10", "m", ["no unit", "'20 nm' or '10 mm'"]),
        (10.0, "m", ["no unit", "'20 nm' or '10 mm'"]),
        ("10 rpm", "m/s", ["wrong unit", "m/s"]),
        ("10 parsec", "m", ["'parsec'", "not a unit", "SI"]),
        ("1,5 m", "m", ["a comma", "decimals have a point: write '1.5 m'."]),
        (",1 kN", "N", ["a comma", "write '0.1 kN'."]),
        ("1,000 N", "N", ["write '1.000 N'. If it separates thousands, write '1000 N'."]),
        ("20 nm; 30 nm", "m", ["';'", "one number"]),
        ("60 C", "K", ["'C' is not a unit", "Did you mean 'degC'?"]),
        ("2 hours", "s", ["'hours' is not a unit", "Did you mean 'h'?"]),
        ("46 cst/s", "m2/s", ["'cst' in 'cst/s'", "Did you mean 'cSt'?"]),
        ("90 degF", "K", ["'degF'", "not a unit"]),
        ("90 degC", "Pa", ["temperature", "Pa"]),
        ("fast", "m/s", ["does not start with a number", "'1.0 m/s'"]),
        ("", "m", ["does not start with a number"]),
        ("nan m", "m", ["not finite"]),
        ("-inf m", "m", ["not finite"]),
        ("1e999 m", "m", ["not finite"]),
        (float("nan"), "", ["not finite", "0.5"]),
        pytest.param(10**400, "", ["not finite"], id="huge"),
        (True, "m", ["True", "not a number"]),
        (None, "m", ["None", "not a number"]),
        ([1.0], "m", ["not a number"]),
    ],
)
def test_what_is_not_the_quantity_is_refused_with_its_name_and_a_way_out(given, si_unit, expected):
    with pytest.raises(SceneError) as refusal:
        units.parse(given, si_unit, "geometry.radius_x")
    sentence = str(refusal.value)
    assert sentence.startswith("geometry.radius_x = ")
    for part in expected:
        assert part in sentence


def test_a_unit_has_its_factor_and_exponents_of_metre_kilogram_second_kelvin_radian():
    assert units.unit("W/(m K)") == (1.0, (1, 1, -3, -1, 0))
    assert units.unit("mN") == (1e-3, (1, 1, -2, 0, 0))
    assert units.unit("") == (1.0, (0, 0, 0, 0, 0))
    assert units.unit("N m s/rad") == (1.0, (2, 1, -1, 0, -1))
    assert units.unit("rpm")[1] == units.unit("rad/s")[1] == (0, 0, -1, 0, 1)


@pytest.mark.parametrize(("text", "si_unit"), [("3 1/s", "rad/s"), ("3 rad/s", "1/s"), ("3", "rad"), (3, "rad")])
def test_an_angle_may_be_given_as_the_number_that_it_is(text, si_unit):
    assert units.parse(text, si_unit, "field") == 3.0
