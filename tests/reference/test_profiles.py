"""Roller profiles against the half space they are made for and against plain geometry."""

import numpy as np
from closed_forms import lundberg_depth
from comparison import approx
from scipy.integrate import quad

from contact_core.reference import hertz_line, logarithmic_drop, rounded_drop

E, LENGTH, LOAD, RADIUS = 230e9, 12e-3, 6000.0, 5e-3
Y = np.linspace(-0.5 * LENGTH, 0.5 * LENGTH, 101)


def test_lundbergs_drop_is_what_an_even_load_settles_less_towards_the_ends():
    """Settlement of half spaces under Hertz's pressure on the whole length, by quadrature over its columns."""
    a = hertz_line(LOAD, RADIUS, LENGTH, E).a

    def settlement(y: float) -> float:
        def of_column(s: float) -> float:
            ends = np.arcsinh((0.5 * LENGTH - y) / s) + np.arcsinh((0.5 * LENGTH + y) / s)
            return 2.0 * np.sqrt(1.0 - (s / a) ** 2) * ends

        return 2.0 / (np.pi * E) * 2.0 * LOAD / LENGTH / (np.pi * a) * quad(of_column, 0.0, a, epsrel=1e-10)[0]

    depth = lundberg_depth(LOAD, LENGTH, E)
    for y in (0.2, 0.5, 0.8):
        y *= 0.5 * LENGTH
        drop = settlement(0.0) - settlement(y)
        assert logarithmic_drop(y, LENGTH, depth) == approx(drop, rel=1e-2)
    assert logarithmic_drop(0.4 * LENGTH, LENGTH, depth) > 0.5e-6


def test_the_standards_profile():
    """ISO 16281: 0.00035 D ln{1 / [1 - (2 y / L)^2]}."""
    inner = Y[1:-1]
    standard = 0.00035 * 10e-3 * np.log(1.0 / (1.0 - (2.0 * inner / LENGTH) ** 2))
    assert logarithmic_drop(inner, LENGTH, 0.00035 * 10e-3) == approx(standard, rel=1e-12)
    assert np.all(np.isinf(logarithmic_drop([-0.5 * LENGTH, 0.5 * LENGTH, LENGTH], LENGTH, 3.5e-6)))


def test_a_finite_end_drop_is_reached_at_the_ends_and_the_middle_is_straight():
    drop = logarithmic_drop(Y, LENGTH, 3e-6, crowned=0.4, end_drop=20e-6)
    assert drop[[0, -1]] == approx(20e-6, rel=1e-12)
    straight = np.abs(Y) <= 0.3 * LENGTH
    assert np.all(drop[straight] == 0.0)
    assert np.all(np.diff(drop[Y > 0.3 * LENGTH]) > 0.0)
    assert drop == approx(drop[::-1], rel=1e-9, abs=1e-18)
    far = logarithmic_drop(Y[1:-1], LENGTH, 3e-6, end_drop=1e-3)
    assert far == approx(logarithmic_drop(Y[1:-1], LENGTH, 3e-6), rel=1e-12)


def test_rounded_ends_are_circles_tangent_to_the_cylinder():
    straight, radius = 8e-3, 30e-3
    drop = rounded_drop(Y, LENGTH, straight, radius)
    outside = np.abs(Y) > 0.5 * straight
    assert np.all(drop[~outside] == 0.0)
    on_circle = (np.abs(Y[outside]) - 0.5 * straight) ** 2 + (radius - drop[outside]) ** 2
    assert on_circle == approx(radius**2, rel=1e-12)
    crown = rounded_drop(Y, LENGTH, 0.0, 1.0)
    assert crown == approx(Y * Y / 2.0, rel=1e-4, abs=1e-18)
    assert np.isinf(rounded_drop(0.51 * LENGTH, LENGTH, straight, radius))
    assert np.isinf(rounded_drop(5e-3, LENGTH, straight, 0.5e-3))
