"""contact_core.calls.dry_contact: input, units, results."""

import dataclasses
import math

import numpy as np
import pytest
from comparison import approx

from contact_core.calls.dry_contact import dry_contact
from contact_core.errors import OperatingPointError
from contact_core.reference import hertz_point

CALL = {"heights": np.zeros((33, 33)), "spacing": 1e-5, "radius": 10e-3, "load": 20.0, "reduced_modulus": 230e9}


def bumpy(ny, nx, rq=5e-8):
    return rq * np.random.Generator(np.random.Philox(ny * nx)).normal(size=(ny, nx))


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"heights": [1.0, 2.0]}, r"heights has the shape \(2,\); .* at least 2 nodes along each side"),
        ({"heights": np.zeros((1, 9))}, r"heights has the shape \(1, 9\)"),
        ({"heights": "rough"}, r"heights must be an array \[ny, nx\] of numbers in metres"),
        ({"heights": np.full((3, 4), math.nan)}, r"heights holds 12 of 12 values that are not finite\. Fill them in"),
        ({"spacing": 0.0}, r"spacing = 0 m \(distance between nodes along x and y\) must be above 0 and at most 1 m"),
        ({"spacing": None}, r"spacing = None .* must be a number in SI units"),
        ({"radius": -1.0}, r"radius = -1 m .* above 0 and at most 1000 m"),
        ({"radius": -math.inf}, r"radius = -inf m .* finite"),
        ({"radius": math.nan}, r"radius = nan m .* finite"),
        ({"load": 0.0}, r"load = 0 N \(normal load\) must be above 0"),
        ({"load": "20 N"}, r"load = '20 N' \(normal load\) must be a number"),
        ({"reduced_modulus": 230.0}, r"reduced_modulus = 230 Pa .* must be above 1000 and at most 1e\+13 Pa"),
        ({"hardness": 0.0}, r"hardness = 0 Pa .* above 0"),
        ({"tolerance": 0.0}, r"tolerance = 0 .* at least 1e-13 and at most 0\.1"),
        ({"fft": "mkl"}, r"fft = 'mkl' is not one of pyfftw, scipy"),
        (
            {"hardness": 1e6},
            r"load = 20 N is more than bodies of 0\.00033 m by 0\.00033 m can carry at hardness = 1e\+06 Pa, "
            r"at most 0\.108 N\. Lower the load, raise the hardness or give a larger array",
        ),
    ],
)
def test_bad_input_is_refused_with_what_would_be_right(change, sentence):
    with pytest.raises(OperatingPointError, match=sentence):
        dry_contact(**(CALL | change))


def test_every_fault_is_named_at_once():
    with pytest.raises(OperatingPointError, match=r"spacing = -1 m .*load = -2 N .*tolerance = 3 "):
        dry_contact(**(CALL | {"spacing": -1.0, "load": -2.0, "tolerance": 3.0}))


def test_the_same_input_gives_the_same_bits_and_is_left_alone():
    heights = bumpy(70, 81)
    before = heights.copy()
    first, second = (dry_contact(**(CALL | {"heights": heights, "hardness": 3e9})) for _ in range(2))
    assert np.array_equal(heights, before)
    for field in dataclasses.fields(first):
        assert np.array_equal(getattr(first, field.name), getattr(second, field.name)), field.name


def test_both_transform_libraries_find_the_same_contact():
    fftw, scipy = (dry_contact(**(CALL | {"heights": bumpy(40, 71)}), fft=name) for name in ("pyfftw", "scipy"))
    assert fftw.pressure == approx(scipy.pressure, abs=1e-7 * scipy.pressure_max)


def test_units_cancel():
    """The same contact a thousand times larger: pressures stay, lengths grow."""
    small = dry_contact(**(CALL | {"heights": bumpy(33, 40)}))
    large = dry_contact(**(CALL | {"heights": 1e3 * bumpy(33, 40), "spacing": 1e-2, "radius": 10.0, "load": 20.0e6}))
    assert large.pressure == approx(small.pressure, rel=1e-6, abs=1e-7 * small.pressure_max)
    assert large.gap == approx(1e3 * small.gap, rel=1e-6, abs=1e-12)
    assert large.approach == approx(1e3 * small.approach, rel=1e-7)
    assert large.contact_area == approx(1e6 * small.contact_area, rel=1e-12)


def test_results_agree_with_each_other():
    found = dry_contact(**(CALL | {"heights": bumpy(65, 64), "hardness": 2e9}))
    touch, area = found.pressure > 0.0, hertz_point(20.0, 10e-3, 10e-3, 230e9).area
    assert found.converged
    assert found.pressure_max == found.pressure.max()
    assert found.contact_area == approx(touch.sum() * 1e-10, rel=1e-12)
    assert found.contact_area_ratio == approx(found.contact_area / area, rel=1e-12)
    assert found.load_error == approx(found.pressure.sum() * 1e-10 / 20.0 - 1.0, abs=1e-14)
    assert abs(found.load_error) < 1e-12
    assert not found.gap[touch].any()
    assert found.gap[~touch].min() >= 0.0
    assert found.overlap.max() > 0.0
    assert not found.overlap[found.pressure < 2e9 * (1.0 - 1e-12)].any()
    assert 0.0 < found.complementarity < 1e-6
    assert not found.reaches_edge


def test_flat_bodies_end_with_the_array():
    """A smooth square punch: pressure grows toward the edge; the area is that of the array."""
    found = dry_contact(**(CALL | {"heights": np.zeros((40, 40)), "radius": math.inf}))
    assert found.converged
    assert found.reaches_edge
    assert found.contact_area_ratio == 1.0
    assert found.pressure[0, 0] > found.pressure[0, 20] > found.pressure[20, 20]
    assert found.pressure.sum() * 1e-10 == approx(20.0, rel=1e-12)
    # rigid square punch of side s: load = 1.152 E' / 2 s approach (Sneddon's circle of equal area: 1.128); cells of
    # constant pressure are softer
    assert found.approach == approx(20.0 / (0.5 * 1.152 * 230e9 * 40e-5), rel=0.02)


@pytest.mark.parametrize("shape", [(2, 2), (2, 9), (3, 200)])
def test_tiny_and_narrow_arrays_work(shape):
    found = dry_contact(**(CALL | {"heights": bumpy(*shape), "load": 1e-3}))
    assert found.converged
    assert found.pressure.sum() * 1e-10 == approx(1e-3, rel=1e-12)


def test_a_contact_of_one_node_carries_the_load():
    heights = np.zeros((50, 50))
    heights[20, 30] = 1e-5
    found = dry_contact(**(CALL | {"heights": heights, "load": 1e-4}))
    assert found.converged
    assert (found.pressure > 0.0).sum() == 1
    assert found.pressure[20, 30] == approx(1e-4 / 1e-10, rel=1e-12)


@pytest.mark.parametrize("pressure", [5e6, 0.1e9, 1e9, 4e9])
@pytest.mark.parametrize("rq", [1e-8, 1.5e-6])
def test_light_and_heavy_loads_on_smooth_and_coarse_bodies_converge(pressure, rq):
    load = (pressure * math.pi) ** 3 * 10e-3**2 / (6.0 / 1.0 * 230e9**2) * 4.0
    hertz = hertz_point(load, 10e-3, 10e-3, 230e9)
    found = dry_contact(bumpy(81, 80, rq), 4.0 * hertz.a / 80, 10e-3, load, 230e9, 6e9)
    assert found.converged
    assert abs(found.load_error) < 1e-12
    assert found.pressure_max <= 6e9 * (1.0 + 1e-12)


@pytest.mark.parametrize(("shape", "reaches"), [((21, 9), True), ((9, 21), True), ((21, 21), False)])
def test_a_contact_that_reaches_any_edge_of_the_array_says_so(shape, reaches):
    """Half widths of 6 nodes."""
    load = (6 * 1e-6) ** 3 * 230e9 / (1.5 * 0.01)
    assert dry_contact(np.zeros(shape), 1e-6, 0.01, load, 230e9, tolerance=1e-4).reaches_edge is reaches
