"""Factors and offsets from the unit of one variable to that of another, by hand."""

import math

import pytest
from comparison import approx
from fmpy.model_description import BaseUnit, ModelDescription, ModelVariable, Unit

from system_models.fmu.errors import CouplingError
from system_models.master.unit_checks import conversion, power, turns


def of(unit: str | None, relative: bool = False) -> ModelVariable:
    variable = ModelVariable("x", 1)
    variable.unit, variable.relativeQuantity = unit, relative
    return variable


MODEL = ModelDescription()
MODEL.unitDefinitions = [
    Unit("degC", BaseUnit(K=1, offset=273.15)),
    Unit("degF", BaseUnit(K=1, factor=1.0 / 1.8, offset=255.372222)),
    Unit("odd", None),
    Unit("Hz", BaseUnit(s=-1)),
    Unit("1/min", BaseUnit(s=-1, factor=0.016666667)),
    Unit("kHz", BaseUnit(s=-1, factor=1e3)),
    Unit("of a tool", BaseUnit(s=-1, rad=1)),
    Unit("rpm of a tool", BaseUnit(s=-1, factor=math.pi / 30.0)),
]


def converted(source: ModelVariable, target: ModelVariable, value: float) -> float:
    factor, offset = conversion(source, MODEL, target, MODEL)
    return factor * value + offset


def test_temperatures_are_converted_with_their_zero_and_differences_without() -> None:
    assert converted(of("degC"), of("K"), 20.0) == approx(293.15)
    assert converted(of("K"), of("degC"), 293.15) == approx(20.0)
    assert converted(of("degC"), of("degF"), 100.0) == approx(212.0)
    assert converted(of("degC", True), of("K", True), 20.0) == approx(20.0)
    assert converted(of("degC", True), of("degF", True), 100.0) == approx(180.0)
    assert converted(of("mm", True), of("m"), 5.0) == approx(5e-3)


@pytest.mark.parametrize(("one", "other"), [("degC", "K"), ("K", "degF"), ("degC", "degC"), ("degC", "degF")])
@pytest.mark.parametrize("relative", [True, False])
def test_a_difference_of_temperatures_sets_no_temperature(one: str, other: str, relative: bool) -> None:
    with pytest.raises(CouplingError, match="is a difference"):
        conversion(of(one, relative), MODEL, of(other, not relative), MODEL)


def test_units_are_known_by_name_where_an_fmu_does_not_define_them() -> None:
    assert converted(of("mm"), of("m"), 5.0) == approx(5e-3)
    assert converted(of("rad/s"), of("1/s"), 5.0) == approx(5.0)
    assert converted(of(None), of("m"), 5.0) == 5.0


@pytest.mark.parametrize("relative", [True, False])
def test_a_difference_in_kelvin_is_passed_on_with_a_warning(relative: bool, caplog: pytest.LogCaptureFixture) -> None:
    assert converted(of("K", relative), of("mK", not relative), 5.0) == approx(5e3)
    assert "in mK is" in caplog.text
    caplog.clear()
    assert converted(of("K", True), of("K", True), 5.0) == converted(of("m", True), of("m"), 5.0) == 5.0
    assert not caplog.text


def test_degrees_are_known_by_name() -> None:
    bare = ModelDescription()
    assert conversion(of("degC"), bare, of("K"), bare) == (1.0, 273.15)
    assert conversion(of("degC"), bare, of("degC"), MODEL) == (1.0, 0.0)
    factor, offset = conversion(of("°C"), bare, of("degF"), bare)
    assert factor * 100.0 + offset == approx(212.0)
    with pytest.raises(CouplingError, match="is a difference"):
        conversion(of("degC"), bare, of("degC", True), bare)


@pytest.mark.parametrize(
    ("one", "other", "mixed"),
    [
        ("Hz", "rad/s", True),
        ("1/min", "of a tool", True),
        ("1/min", "rpm", True),  # the latter known as 2 pi / 60 rad/s
        ("kHz", "rad/s", True),
        ("1/s", "rad/s", False),
        ("Hz", "1/min", False),
        ("rpm", "of a tool", False),
        ("rpm of a tool", "rad/s", False),  # without rad, but with its 2 pi
        ("mm", "rad/s", False),
        ("odd", "rad/s", False),
    ],
)
def test_turns_and_angles_are_told_apart(one: str, other: str, mixed: bool) -> None:
    assert turns(of(one), MODEL, of(other), MODEL) == (approx(2.0 * math.pi) if mixed else None)
    assert turns(of(other), MODEL, of(one), MODEL) == (approx(0.5 / math.pi) if mixed else None)
    assert turns(of(None), MODEL, of(other), MODEL) is None


@pytest.mark.parametrize(("source", "target", "said"), [("m", "N", "another quantity"), ("odd", "m", "does not say")])
def test_what_cannot_be_converted_is_refused(source: str, target: str, said: str) -> None:
    with pytest.raises(CouplingError, match=said):
        conversion(of(source), MODEL, of(target), MODEL)


def test_a_product_is_a_power_or_none() -> None:
    assert power(of("kN"), MODEL, of("mm/s"), MODEL) == approx(1.0)
    assert power(of("N m"), MODEL, of("rad/s"), MODEL) == approx(1.0)
    assert power(of("N"), MODEL, of("N"), MODEL) is None
