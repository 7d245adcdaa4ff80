"""The law of asperities below the grid: limits, inverses, two bodies, and the contacts that its constants are from."""

from pathlib import Path

import numpy as np
import pytest
from comparison import approx
from periodic_contact import Band, PeriodicPlane, press

from contact_core.laws import asperity_layer
from contact_core.laws.asperity_layer import AsperityLayer

MODULUS, HARDNESS = 2.3e11, 4e9
LAYER = AsperityLayer(20e-9, 4e-6)
MEASURED = np.genfromtxt(Path(__file__).parents[1] / "data" / "asperity_layer.csv", delimiter=",", skip_header=4)


def test_the_gap_under_the_pressure_at_a_height_is_the_height():
    height = np.linspace(0.0, 150e-9, 30).reshape(5, 6)
    pressure = LAYER.pressure(height, MODULUS, HARDNESS)
    assert pressure.shape == height.shape
    assert LAYER.gap(pressure, MODULUS, HARDNESS) == approx(height, rel=1e-12, abs=1e-20)


def test_the_pressure_falls_to_one_over_e_per_height_scale_from_its_value_at_the_floor():
    top, over = LAYER.pressure_scale(MODULUS, HARDNESS), LAYER.height_scale(MODULUS, HARDNESS)
    assert LAYER.pressure(np.array([-1e-9, 0.0, over]), MODULUS, HARDNESS) == approx(
        top * np.array([1.0, 1.0, np.exp(-1.0)])
    )
    assert LAYER.gap(np.array([2.0 * top, top]), MODULUS, HARDNESS) == approx(np.zeros(2), abs=1e-30)
    assert LAYER.gap(0.0, MODULUS, HARDNESS) == np.inf


def test_hard_bodies_are_elastic_and_soft_ones_bear_their_hardness():
    unit = 2.0 * np.pi / 4e-6 * 20e-9 * MODULUS / 2.0
    assert LAYER.pressure_scale(MODULUS, 1e6 * unit) == approx(unit)
    assert LAYER.pressure_scale(MODULUS, 1e-6 * unit) == approx(1.1e-6 * unit)
    assert LAYER.height_scale(MODULUS, 1e6 * unit) == approx(0.44 * 20e-9)
    assert LAYER.height_scale(MODULUS, 1e-6 * unit) == approx(0.52 * 20e-9, rel=1e-5)


def test_each_node_may_have_a_hardness_of_its_own():
    hardness, pressure = np.array([1e9, 2e9, 6e9]), np.array([1e7, 1e8, 5e8])
    for method in (LAYER.gap, LAYER.area, LAYER.pressure):
        first = pressure if method != LAYER.pressure else 1e-16 * pressure
        alone = [method(first[i : i + 1], MODULUS, float(hardness[i]))[0] for i in range(3)]
        assert method(first, MODULUS, hardness) == approx(np.array(alone), rel=1e-14)


def test_the_area_rises_with_pressure_from_none_to_all_and_bears_it_at_most_at_the_hardness():
    pressure = np.concatenate([[0.0], np.geomspace(1e3, HARDNESS, 200)])
    for layer in (LAYER, AsperityLayer(1e-9, 16e-6), AsperityLayer(60e-9, 1e-6)):
        area = layer.area(pressure, MODULUS, HARDNESS)
        assert area[0] == 0.0
        assert np.all(np.diff(area) >= 0.0)
        assert np.all(area >= pressure / HARDNESS * (1.0 - 1e-12))
        assert area[-1] == approx(1.0)


def test_light_elastic_contact_touches_in_proportion_to_pressure_over_slope():
    pressure = np.array([1e4, 1e5, 1e6])
    slope = 2.3 * 2.0 * np.pi * 20e-9 / 4e-6
    assert LAYER.area(pressure, MODULUS, 1e15) == approx(2.2 * pressure / (MODULUS / 2.0 * slope), rel=1e-6)


def test_without_roughness_the_layer_is_a_hard_floor():
    floor = AsperityLayer(0.0, 4e-6)
    assert floor.pressure(np.array([0.0, 1e-9]), MODULUS, HARDNESS).tolist() == [0.0, 0.0]
    assert floor.gap(np.array([0.0, 1e6]), MODULUS, HARDNESS).tolist() == [np.inf, 0.0]
    assert floor.area(np.array([0.0, 1e6]), MODULUS, HARDNESS).tolist() == [0.0, 1.0]
    assert (floor.pressure_scale(MODULUS, HARDNESS), floor.height_scale(MODULUS, HARDNESS)) == (0.0, 0.0)


def test_less_and_less_roughness_comes_to_the_hard_floor():
    layer = AsperityLayer(1e-15, 4e-6)
    assert layer.gap(1e5, MODULUS, HARDNESS) < 1e-15
    assert layer.area(1e6, MODULUS, HARDNESS) > 0.99


def test_of_two_bodies_the_squares_of_heights_and_of_slopes_add():
    other = AsperityLayer(15e-9, 10e-6)
    both = LAYER.beside(other)
    assert both.rms == approx(25e-9)
    assert both.slope == approx(np.hypot(LAYER.slope, other.slope))
    assert other.beside(LAYER) == both
    assert LAYER.beside(AsperityLayer(0.0, 1e-6)).longest == approx(4e-6)
    assert AsperityLayer(0.0, 1e-6).beside(AsperityLayer(0.0, 3e-6)) == AsperityLayer(0.0, 3e-6)


def test_heights_in_a_wrong_unit_are_told():
    assert LAYER.error == ""
    assert "at most 0.3" in AsperityLayer(20e-6, 4e-6).error


def test_the_constants_lie_among_those_of_the_contacts():
    """Between the spectra's, each with two standard errors; h0 follows p0, so that the gap is checked, too."""
    unit = AsperityLayer(1.0, 2.0 * np.pi)
    found = MEASURED
    for hardness in np.unique(found[:, 0]):
        p0, dp, h0, dh = found[found[:, 0] == hardness, 1:].T
        assert len(p0) == 2
        for law, value, error in (
            (unit.pressure_scale(2.0, hardness), p0, dp),
            (unit.height_scale(2.0, hardness), h0, dh),
        ):
            assert (value - 2.0 * error).min() <= law <= (value + 2.0 * error).max()
    elastic = found[np.isinf(found[:, 0]), 1].mean()
    assert elastic == approx(asperity_layer.ELASTIC_PRESSURE, rel=0.1)


@pytest.mark.parametrize(("hardness", "tolerance"), [(np.inf, 0.15), (0.5, 0.1)])
def test_gap_and_area_are_those_of_a_rough_contact(hardness, tolerance):
    """Tolerance in rms heights: a pressure is then right within 1.4 or 1.2; of the area the slope is known to 25 %."""
    band, unit = Band(4, 0.8), AsperityLayer(1.0, 2.0 * np.pi)
    for found in press(PeriodicPlane(128, band.longest), band.heights(128, 1), (0.01, 0.05, 0.2), hardness):
        assert unit.gap(found.pressure, 2.0, hardness) == approx(found.gap, abs=tolerance)
        assert unit.area(found.pressure, 2.0, hardness) == approx(found.area, rel=0.3)
