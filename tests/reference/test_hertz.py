import numpy as np
import pytest
from scipy.integrate import quad

from contact_core.reference import Hertz, hertz_point

E = 230.47e9


def settlement(hertz: Hertz, x: float, y: float) -> float:
    """Displacement of both half spaces at (x, y) under the Hertz pressure, integrated chord by chord."""

    def chord(angle: float) -> float:
        cos, sin = np.cos(angle), np.sin(angle)
        a = (cos / hertz.a) ** 2 + (sin / hertz.b) ** 2
        b = x * cos / hertz.a**2 + y * sin / hertz.b**2
        c = (x / hertz.a) ** 2 + (y / hertz.b) ** 2
        return 0.5 * np.pi * (1.0 - c + b * b / a) / np.sqrt(a)

    value, _ = quad(chord, 0.0, np.pi, epsrel=1e-12, limit=400)
    return 2.0 * hertz.pressure_max / (np.pi * E) * value


@pytest.mark.parametrize("ratio", [0.1, 0.5, 1.0, 1.001, 3.0, 30.0])
def test_the_pressure_flattens_the_bodies_onto_each_other(ratio):
    radius_x, radius_y = 10e-3, 10e-3 * ratio
    hertz = hertz_point(50.0, radius_x, radius_y, E)
    assert 2.0 / 3.0 * hertz.area * hertz.pressure_max == pytest.approx(50.0, rel=1e-12)
    for x, y in [(0.0, 0.0), (0.5, 0.0), (0.0, 0.7), (0.6, 0.6), (-0.3, 0.9)]:
        x, y = x * hertz.a, y * hertz.b
        gap = settlement(hertz, x, y) + x * x / (2.0 * radius_x) + y * y / (2.0 * radius_y)
        assert gap == pytest.approx(hertz.approach, rel=1e-9, abs=0.0)


@pytest.mark.parametrize(
    ("difference", "long", "short", "approach"),
    [
        (0.7332, 2.0114, 0.5881, 0.8394),
        (0.90999, 3.2327, 0.4499, 0.6636),
        (0.93657, 3.7378, 0.4166, 0.6112),
        (0.95738, 4.3944, 0.3830, 0.5551),
    ],
)
def test_tabulated_ellipses_of_ball_bearings(difference, long, short, approach):
    """The dimensionless a*, b*, delta* of rolling bearing analysis against the curvature difference."""
    curvatures = 1.0 + difference, 1.0 - difference  # sum 2
    hertz = hertz_point(1.0, 1.0 / curvatures[0], 1.0 / curvatures[1], 1.0)
    size = (3.0 / 2.0) ** (1.0 / 3.0)
    assert (hertz.b / size, hertz.a / size) == pytest.approx((long, short), abs=6e-5)
    assert hertz.approach / size**2 == pytest.approx(approach, abs=6e-5)


def test_the_circle_is_the_limit_of_the_ellipse_to_the_last_digits():
    circle = hertz_point(50.0, 10e-3, 10e-3, E)
    for excess in (1e-14, 1e-10, 1e-6, 1e-3):
        ellipse = hertz_point(50.0, 10e-3, 10e-3 * (1.0 + excess), E)
        # first order of a slightly longer radius_y, from the elliptic integrals' series
        assert ellipse.a / circle.a - 1.0 == pytest.approx(-excess / 6.0, abs=excess**2 + 1e-14)
        assert ellipse.b / circle.b - 1.0 == pytest.approx(excess / 2.0, abs=excess**2 + 1e-14)


def test_the_long_axis_lies_along_the_larger_radius():
    along = hertz_point(50.0, 10e-3, 30e-3, E)
    across = hertz_point(50.0, 30e-3, 10e-3, E)
    assert along.b > along.a
    assert (along.a, along.b, along.pressure_max) == (across.b, across.a, across.pressure_max)


@pytest.mark.parametrize("radius_y", [10e-3, 25e-3])
def test_pressure_grows_with_the_cube_root_of_load(radius_y):
    one, eight = hertz_point(10.0, 10e-3, radius_y, E), hertz_point(80.0, 10e-3, radius_y, E)
    assert eight.pressure_max / one.pressure_max == pytest.approx(2.0, rel=1e-12)
    assert eight.a / one.a == pytest.approx(2.0, rel=1e-12)
    assert eight.approach / one.approach == pytest.approx(4.0, rel=1e-12)
