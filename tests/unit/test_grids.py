"""Between a grid and that of half its nodes."""

import numpy as np
import pytest
from comparison import approx

from contact_core.kernels.grids import prolong, restrict


@pytest.mark.parametrize(("n", "coarse"), [(17, 9), (16, 8)])
def test_coordinates_of_the_coarser_grid_span_the_same_contact(n, coarse):
    x = np.linspace(-1.0, 1.0, n)
    found = restrict(x)
    assert found.size == coarse
    assert np.diff(found) == approx(2.0 * (x[1] - x[0]), rel=1e-12)
    assert found.mean() == approx(0.0, abs=1e-15)


@pytest.mark.parametrize("shape", [(17, 17), (16, 16), (17, 24)])
def test_prolongation_is_exact_for_linear_fields(shape):
    y, x = (np.linspace(-1.0, 1.0, n) for n in shape)
    plane = 1.0 + 0.1 * x[None, :] + 0.05 * y[:, None]
    coarse = 1.0 + 0.1 * restrict(x)[None, :] + 0.05 * restrict(y)[:, None]
    inside = np.s_[1:-1, 1:-1]
    assert prolong(coarse, shape)[inside] == approx(plane[inside], rel=1e-14)


def test_what_is_restricted_from_a_prolonged_field_is_the_field():
    field = np.random.default_rng(1).random((9, 9))
    assert restrict(prolong(field, (17, 17))) == approx(field, rel=1e-15)
