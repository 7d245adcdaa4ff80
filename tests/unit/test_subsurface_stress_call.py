"""contact_core.calls.subsurface_stress: input, units, results."""

import math

import numpy as np
import pytest
from comparison import approx

from contact_core import OperatingPointError, graded_depths, subsurface_stress

P = np.ones((3, 4))
CALL = {"pressure": P, "shear_x": None, "shear_y": None, "spacing": 1e-6, "depths": [0.0, 1e-6]}


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"pressure": [1.0]}, r"pressure has the shape \(1,\); .* at least one node along each side"),
        ({"pressure": np.zeros((0, 3))}, r"pressure has the shape \(0, 3\)"),
        ({"pressure": "high"}, r"pressure must be an array \[ny, nx\] of numbers in Pa"),
        ({"pressure": np.full((2, 2), math.nan)}, r"pressure holds 4 of 4 values that are not finite.*Fill them in"),
        ({"shear_x": np.ones((4, 3))}, r"shear_x is \(4, 3\) and pressure \(3, 4\); both must lie on the same nodes"),
        ({"shear_y": P * math.inf}, r"shear_y holds 12 of 12"),
        ({"spacing": 0.0}, r"spacing = 0 m \(distance between nodes along x and y\) must be above 0 and at most 1 m"),
        ({"spacing": "1 um"}, r"spacing = '1 um' .* must be a number in SI units"),
        ({"depths": []}, r"depths has the shape \(0,\); it must be an array \[nz\] of at least one depth"),
        ({"depths": [[1.0]]}, r"depths has the shape \(1, 1\)"),
        ({"depths": [0.0, -1e-6]}, r"depths = -1e-06 m lies outside the body: depths must be at least 0 m"),
        ({"depths": [math.nan]}, r"depths holds 1 of 1 values that are not finite"),
        ({"depths": [2.0]}, r"depths = 2 m is below 1e\+06 spacings of 1e-06 m"),
        ({"pressure": 1e14 * P}, r"pressure reaches 1e\+14 Pa; it must stay within 1e\+13 Pa\. Check its unit"),
        ({"residual": [1e300] * 6}, r"residual reaches 1e\+300 Pa"),
        ({"poisson_ratio": 0.6}, r"poisson_ratio = 0\.6 .* at least 0 and at most 0\.5"),
        ({"poisson_ratio": True}, r"poisson_ratio = True .* must be a number"),
        ({"residual": [1.0, 2.0]}, r"residual has the shape \(2,\); for 2 depths it must be \(6,\) or \(6, 2\)"),
        ({"residual": np.zeros((6, 3))}, r"residual has the shape \(6, 3\)"),
        ({"residual": [math.nan] * 6}, r"residual holds 6 of 6 values that are not finite"),
        ({"periodic": 1}, r"periodic = 1 .* must be True or False"),
        ({"fft": "mkl"}, r"fft = 'mkl' is not one of pyfftw, scipy"),
    ],
)
def test_bad_input_is_refused_with_what_would_be_right(change, sentence):
    with pytest.raises(OperatingPointError, match=sentence):
        subsurface_stress(**(CALL | change))


def test_residual_stress_is_added_at_every_node_and_depth():
    bare = subsurface_stress(**CALL)
    even = np.array([-3.0, 2.0, 0.0, 0.1, 0.2, 0.3])
    by_depth = np.stack([even, 2.0 * even], axis=1)
    assert subsurface_stress(**CALL, residual=even).stress == approx(bare.stress + even[:, None, None, None], abs=1e-15)
    found = subsurface_stress(**CALL, residual=by_depth)
    assert found.stress == approx(bare.stress + by_depth[:, :, None, None], abs=1e-15)
    alone = subsurface_stress(**(CALL | {"pressure": 0.0 * P, "residual": by_depth}))
    assert alone.stress[:, 1, 2, 3] == approx(2.0 * even)


def test_measures_belong_to_the_stress_of_the_result():
    shear = np.linspace(0.0, 0.5, 12).reshape(3, 4)
    found = subsurface_stress(**(CALL | {"shear_x": shear, "shear_y": -shear, "residual": [0.5, 0, 0, 0, 0, 0]}))
    assert found.stress.shape == (6, 2, 3, 4)
    assert found.principal.shape == (3, 2, 3, 4)
    assert found.principal.sum(axis=0) == approx(found.stress[:3].sum(axis=0), abs=1e-14)
    assert found.largest_shear == approx(0.5 * np.ptp(found.principal, axis=0), abs=1e-15)
    first, second, third = found.principal
    assert found.von_mises**2 == approx(
        0.5 * ((first - second) ** 2 + (second - third) ** 2 + (third - first) ** 2), rel=1e-8
    )


def test_units_cancel_input_is_left_alone_and_bits_repeat():
    pressure = np.random.Generator(np.random.Philox(3)).random((5, 6))
    before = pressure.copy()
    small = subsurface_stress(**(CALL | {"pressure": pressure, "shear_x": 0.1 * pressure}))
    large = subsurface_stress(1e9 * pressure, 1e8 * pressure, None, 1e-3, [0.0, 1e-3])
    assert large.stress == approx(1e9 * small.stress, abs=1e-4)
    assert np.array_equal(pressure, before)
    again = subsurface_stress(**(CALL | {"pressure": pressure, "shear_x": 0.1 * pressure}))
    assert again.stress.tobytes() == small.stress.tobytes()


def test_one_depth_may_be_a_number():
    assert subsurface_stress(**(CALL | {"depths": 2e-6})).stress.shape == (6, 1, 3, 4)


def test_graded_depths_begin_at_half_a_spacing_and_end_below_the_contact():
    depths = graded_depths(1e-6, 32e-6)
    steps = np.diff(depths, prepend=0.0)
    assert depths.shape == (12,)
    assert (depths[0], depths[-1]) == approx((0.5e-6, 48e-6))
    assert steps[1:] / steps[:-1] == approx(np.full(11, steps[1] / steps[0]), rel=1e-9)
    assert steps[1] > steps[0]
    assert graded_depths(1.0, 1.0, 6) == approx(np.linspace(0.25, 1.5, 6))
    assert graded_depths(0.1, 1.0, 1) == approx([1.5])


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ((0.0, 1.0), r"spacing = 0 m"),
        ((0.1, math.inf), r"half_width = inf m .* finite"),
        ((0.1, 1.0, 0), r"layers = 0 \(depths\) must be at least 1 and at most 1000"),
        ((0.1, 1.0, 2.5), r"layers = 2\.5 \(depths\) must be a whole number"),
    ],
)
def test_depths_that_cannot_be_graded_are_refused(given, sentence):
    with pytest.raises(OperatingPointError, match=sentence):
        graded_depths(*given)
