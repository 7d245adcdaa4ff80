"""Elementary functions: numbers and arrays alike, and numbers stay numbers."""

import numpy as np
import pytest

from contact_core.laws import elementary

ONE = {name: getattr(elementary, name) for name in ("exp", "expm1", "log", "log10", "sqrt", "tanh")}
TWO = {name: getattr(elementary, name) for name in ("minimum", "maximum")}
POINTS = np.array([1e-9, 0.3, 1.0, 7.5])


@pytest.mark.parametrize("name", ONE)
def test_a_float_gives_a_float_and_what_it_gives_in_an_array(name):
    numbers = [ONE[name](x) for x in POINTS.tolist()]
    assert all(type(number) is float for number in numbers)
    np.testing.assert_allclose(ONE[name](POINTS), numbers, rtol=1e-15)
    np.testing.assert_array_equal(ONE[name](POINTS), getattr(np, name)(POINTS))


@pytest.mark.parametrize("name", TWO)
def test_the_smaller_and_the_larger_of_floats_arrays_and_both(name):
    expected = getattr(np, name)(POINTS, 0.5)
    np.testing.assert_array_equal(TWO[name](POINTS, 0.5), expected)
    np.testing.assert_array_equal(TWO[name](0.5, POINTS), expected)
    assert [TWO[name](x, 0.5) for x in POINTS.tolist()] == expected.tolist()
    assert type(TWO[name](0.2, 0.5)) is float
