"""The half space under Hertz's line pressure: a gap that is even inside and opens outside as it should."""

import numpy as np
import pytest

from contact_core.kernels.half_space import PeriodicHalfSpace


def cell_means(x, dx):
    """Of the pressure (1 - x^2)^(1/2) over cells about x, exactly."""

    def primitive(s):
        s = np.clip(s, -1.0, 1.0)
        return 0.5 * (s * np.sqrt(1.0 - s * s) + np.arcsin(s))

    return (primitive(x + 0.5 * dx) - primitive(x - 0.5 * dx)) / dx


def errors(nx, rows):
    """Largest unevenness of the gap well inside the contact, and of that outside beside the closed form."""
    x = np.linspace(-3.0, 3.0, nx)
    dx = x[1] - x[0]
    half_space = PeriodicHalfSpace(rows, nx, 0.25 * np.pi * 2.0 / np.pi**2 * dx, "scipy", 6.0 / dx)
    settled = half_space.deform(np.repeat(cell_means(x, dx)[None, :], rows, axis=0))
    assert np.ptp(settled, axis=0).max() < 1e-10
    gap = 0.5 * x**2 + settled[0]
    outside = np.maximum(np.abs(x), 1.0)  # gap beside Hertz's line contact, in a^2 / R
    opening = 0.5 * (outside * np.sqrt(outside**2 - 1.0) - np.arccosh(outside))
    even = gap - opening
    inside = np.abs(x) < 0.9
    # at the ends of a line of unit load per length, pi / 2 in these units, ln(1 / 6) is the datum
    datum = 0.25 * np.pi * 4.0 / np.pi**2 * 0.5 * np.pi * (np.log(2.0 * 6.0) + 0.5)
    return np.ptp(even[inside]), np.abs(even - datum)[np.abs(x) > 1.1].max()


@pytest.mark.parametrize("rows", [1, 6])
def test_the_gap_under_hertz_pressure_is_even_to_second_order(rows):
    found = np.array([errors(nx, rows) for nx in (121, 241, 481, 961)])
    orders = np.log2(found[0] / found[-1]) / 3.0
    print(f"rows {rows}: errors {found[-1]}, orders {orders.round(2).tolist()}")
    assert orders.min() > 1.9
    assert found[-1].max() < 2e-5
