import numpy as np
import pytest
from closed_forms import brewe_hamrock, palmgren_approach
from comparison import approx
from scipy.integrate import quad
from scipy.optimize import brentq

from contact_core.reference import Hertz, hertz_line, hertz_point

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
    assert 2.0 / 3.0 * hertz.area * hertz.pressure_max == approx(50.0, rel=1e-12)
    for x, y in [(0.0, 0.0), (0.5, 0.0), (0.0, 0.7), (0.6, 0.6), (-0.3, 0.9)]:
        x, y = x * hertz.a, y * hertz.b
        gap = settlement(hertz, x, y) + x * x / (2.0 * radius_x) + y * y / (2.0 * radius_y)
        assert gap == approx(hertz.approach, rel=1e-9, abs=0.0)


@pytest.mark.parametrize("ratio", [0.1, 1.0, 8.0])
def test_the_gap_around_the_contact_is_what_the_pressure_leaves_open(ratio):
    """By a quadrature over the ellipse, r sqrt(1 - r^2) in r^2 and the trapezoidal rule in the angle."""
    radius_x, radius_y = 10e-3, 10e-3 * ratio
    hertz = hertz_point(50.0, radius_x, radius_y, E)
    s, weights = np.polynomial.legendre.leggauss(64)
    r, angle = np.sqrt(1.0 - (0.5 + 0.5 * s) ** 2), 2.0 * np.pi * np.arange(256) / 256
    of_ring = 0.5 * weights * (0.5 + 0.5 * s) ** 2 * 2.0 * np.pi / 256 * hertz.a * hertz.b * hertz.pressure_max
    x, y = np.array([0.4, 1.3, 3.0]) * hertz.a, np.array([0.0, 1.4]) * hertz.b
    gap = hertz.gap(x, y, E)
    assert gap[0, 0] == 0.0
    for j, i in ((0, 1), (0, 2), (1, 0), (1, 2)):
        away = np.hypot(x[i] - hertz.a * np.outer(r, np.cos(angle)), y[j] - hertz.b * np.outer(r, np.sin(angle)))
        settled = 2.0 / (np.pi * E) * float((of_ring[:, None] / away).sum())
        open_by = x[i] ** 2 / (2.0 * radius_x) + y[j] ** 2 / (2.0 * radius_y) - hertz.approach + settled
        assert gap[j, i] == approx(open_by, rel=1e-4, abs=0.0)


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
    assert (hertz.b / size, hertz.a / size) == approx((long, short), abs=6e-5)
    assert hertz.approach / size**2 == approx(approach, abs=6e-5)


def test_the_circle_is_the_limit_of_the_ellipse_to_the_last_digits():
    circle = hertz_point(50.0, 10e-3, 10e-3, E)
    for excess in (1e-14, 1e-10, 1e-6, 1e-3):
        ellipse = hertz_point(50.0, 10e-3, 10e-3 * (1.0 + excess), E)
        # first order of a slightly longer radius_y, from the elliptic integrals' series
        assert ellipse.a / circle.a - 1.0 == approx(-excess / 6.0, abs=excess**2 + 1e-14)
        assert ellipse.b / circle.b - 1.0 == approx(excess / 2.0, abs=excess**2 + 1e-14)


def test_the_long_axis_lies_along_the_larger_radius():
    along = hertz_point(50.0, 10e-3, 30e-3, E)
    across = hertz_point(50.0, 30e-3, 10e-3, E)
    assert along.b > along.a
    assert (along.a, along.b, along.pressure_max) == (across.b, across.a, across.pressure_max)


@pytest.mark.parametrize("radius_y", [10e-3, 25e-3])
def test_pressure_grows_with_the_cube_root_of_load(radius_y):
    one, eight = hertz_point(10.0, 10e-3, radius_y, E), hertz_point(80.0, 10e-3, radius_y, E)
    assert eight.pressure_max / one.pressure_max == approx(2.0, rel=1e-12)
    assert eight.a / one.a == approx(2.0, rel=1e-12)
    assert eight.approach / one.approach == approx(4.0, rel=1e-12)


def bearing_ellipse(load: float, radius_x: float, radius_y: float) -> tuple[float, float, float, float]:
    """Long and short half width, largest pressure and approach by the textbook's elliptic integrals, by quadrature.

    F(k) = [(k^2 + 1) E - 2 K] / [(k^2 - 1) E] is the difference of curvatures over their sum, k long over short.
    """
    curvatures = sorted((1.0 / radius_x, 1.0 / radius_y))
    total, difference = sum(curvatures), (curvatures[1] - curvatures[0]) / sum(curvatures)

    def integrals(k: float) -> tuple[float, float]:
        def root(angle: float) -> float:
            return np.sqrt(np.cos(angle) ** 2 + (np.sin(angle) / k) ** 2)

        first, _ = quad(lambda angle: 1.0 / root(angle), 0.0, np.pi / 2, epsrel=1e-12, limit=400)
        second, _ = quad(root, 0.0, np.pi / 2, epsrel=1e-12, limit=400)
        return first, second

    def missing(log_k: float) -> float:
        k2, (first, second) = np.exp(2.0 * log_k), integrals(np.exp(log_k))
        return ((k2 + 1.0) * second - 2.0 * first) / ((k2 - 1.0) * second) - difference

    k = np.exp(brentq(missing, 1e-4, 8.0, xtol=1e-13))
    first, second = integrals(k)
    size = (3.0 * load / (total * E)) ** (1.0 / 3.0)
    long, short = (2.0 * k * k * second / np.pi) ** (1 / 3) * size, (2.0 * second / (np.pi * k)) ** (1 / 3) * size
    approach = 2.0 * first / np.pi * (np.pi / (2.0 * k * k * second)) ** (1 / 3) * size**2 * total / 2.0
    return long, short, 1.5 * load / (np.pi * long * short), approach


@pytest.mark.parametrize("ratio", [0.01, 0.03, 0.1, 0.5, 0.9, 1.1, 2.0, 8.0, 10.0, 40.0, 100.0])
def test_ellipses_are_those_of_the_elliptic_integrals_to_a_millionth(ratio):
    hertz = hertz_point(70.0, 8e-3, 8e-3 * ratio, E)
    long, short, pressure, approach = bearing_ellipse(70.0, 8e-3, 8e-3 * ratio)
    assert sorted((hertz.a, hertz.b)) == approx([short, long], rel=1e-6, abs=0.0)
    assert (hertz.a < hertz.b) == (ratio > 1.0)
    assert hertz.pressure_max == approx(pressure, rel=1e-6)
    assert hertz.approach == approx(approach, rel=1e-6)
    assert hertz.pressure_mean * hertz.area == approx(70.0, rel=1e-12)


@pytest.mark.parametrize(
    ("sign", "total", "difference", "stiffness", "long", "short", "pressure"),
    [
        (1.0, 0.20178, 0.93996, 1.0184e6, 2.548, 0.2744, 3091.0),
        (-1.0, 0.13780, 0.91209, 1.0766e6, 2.471, 0.3387, 2582.0),
    ],
)
def test_the_most_loaded_ball_of_a_209_bearing(sign, total, difference, stiffness, long, short, pressure):
    """Rows of rolling bearing analysis in N and mm: ball 12.7 mm, pitch 65 mm, grooves of 0.52 balls, 4526.6 N."""
    ball, shrink = 12.7e-3, 12.7 / 65.0
    along = 2.0 / ball * (1.0 + sign * shrink / (1.0 - sign * shrink))
    across = (2.0 - 1.0 / 0.52) / ball
    assert (along + across) * 1e-3 == approx(total, rel=5e-5)
    assert (along - across) / (along + across) == approx(difference, rel=1e-5)
    hertz = hertz_point(4526.6, 1.0 / along, 1.0 / across, 206.84e9 / (1.0 - 0.3**2))
    assert 4526.6 / (hertz.approach * 1e3) ** 1.5 == approx(stiffness, rel=1e-4)
    assert (hertz.b * 1e3, hertz.a * 1e3) == approx((long, short), rel=2e-4)
    assert hertz.pressure_max * 1e-6 == approx(pressure, rel=2e-4)


def test_a_218_bearing_under_thrust():
    """Ball 22.225 mm, pitch 125.26 mm, grooves of 0.5232 balls, contact angle 41.5 degrees, 1679 N: 1525, 1348 MPa."""
    ball, shrink = 22.225e-3, 22.225 * np.cos(np.radians(41.5)) / 125.26
    across, modulus, softness = (2.0 - 1.0 / 0.5232) / ball, 206.84e9 / (1.0 - 0.3**2), 0.0
    for sign, pressure in ((1.0, 1525.0), (-1.0, 1348.0)):
        along = 2.0 / ball * (1.0 + sign * shrink / (1.0 - sign * shrink))
        hertz = hertz_point(1679.0, 1.0 / along, 1.0 / across, modulus)
        assert hertz.pressure_max * 1e-6 == approx(pressure, rel=2e-3)
        softness += hertz.approach * 1e3 / 1679.0 ** (2 / 3)
    assert softness**-1.5 == approx(4.659e5, rel=3e-4)


def test_brewe_and_hamrock_are_as_near_as_said():
    for ratio in np.logspace(0.0, 2.0, 41):
        for swapped in (False, True):
            radii = (8e-3 * ratio, 8e-3) if swapped else (8e-3, 8e-3 * ratio)
            exact, near = hertz_point(70.0, *radii, E), brewe_hamrock(70.0, *radii, E)
            assert (near.a, near.b) == approx((exact.a, exact.b), rel=0.045)
            assert near.pressure_max == approx(exact.pressure_max, rel=0.025)
            assert near.approach == approx(exact.approach, rel=0.055)
            if 1.3 < ratio < 50.0:
                assert (near.a, near.b, near.pressure_max) == approx((exact.a, exact.b, exact.pressure_max), rel=0.02)


def strip_settlement(pressure: float, a: float, length: float, x: float, y: float) -> float:
    """Displacement of both half spaces at (x, y) under pressure (1 - x^2 / a^2)^0.5 on |y| < length / 2."""

    def of_column(s: float) -> float:  # a column of the strip at x = s; its integral along y in closed form
        away = max(abs(x - s), 1e-300)
        ends = np.arcsinh((0.5 * length - y) / away) + np.arcsinh((0.5 * length + y) / away)
        return np.sqrt(max(1.0 - (s / a) ** 2, 0.0)) * ends

    value, _ = quad(of_column, -a, a, points=[x] if abs(x) < a else None, epsrel=1e-11, limit=800)
    return 2.0 * pressure / (np.pi * E) * value


def test_a_strip_of_pressure_flattens_cylinders_onto_each_other():
    radius, length = 10e-3, 12e-3
    hertz = hertz_line(3000.0, radius, length, E)
    assert hertz.a == approx(np.sqrt(8.0 * 3000.0 * radius / (length * np.pi * E)), rel=1e-14)
    assert hertz.b == 0.5 * length
    assert hertz.pressure_mean * hertz.area == approx(3000.0, rel=1e-12)
    assert hertz.pressure_mean == approx(np.pi / 4.0 * hertz.pressure_max)
    for x in (0.0, 0.3, 0.8, -1.0):
        x *= hertz.a
        gap = strip_settlement(hertz.pressure_max, hertz.a, length, x, 0.0) + x * x / (2.0 * radius)
        assert gap == approx(hertz.approach, rel=2.0 * (hertz.a / length) ** 2, abs=0.0)


def test_a_line_is_the_limit_of_a_long_ellipse():
    """The largest pressure of a long ellipse is that of the line under the load per length of its middle."""
    ellipse = hertz_point(100.0, 5e-3, 5e3, E)
    per_length = 1.5 * 100.0 / (2.0 * ellipse.b)
    line = hertz_line(per_length, 5e-3, 1.0, E)
    assert (line.a, line.pressure_max) == approx((ellipse.a, ellipse.pressure_max), rel=1e-4)
    x, middle = np.array([0.5, 1.2, 4.0]) * line.a, np.zeros(1)
    assert line.gap(x, middle, E) == approx(ellipse.gap(x, middle, E), rel=2e-3)


@pytest.mark.parametrize("line", [False, True])
def test_a_contact_under_another_load_is_known_from_one(line):
    def of_load(load):
        return hertz_line(load, 10e-3, 8e-3, E) if line else hertz_point(load, 10e-3, 25e-3, E)

    one, more = of_load(10.0), of_load(230.0)
    root, wide = one.growth(23.0)
    assert (more.a, more.pressure_max) == approx((root * one.a, root * one.pressure_max), rel=1e-12)
    assert (more.b, more.area) == approx((wide * one.b, root * wide * one.area), rel=1e-12)
    assert more.approach == approx(one.approach_at(23.0), rel=1e-12)
    assert one.approach_at(0.0) == 0.0
    rows = (np.arange(20_000) + 0.5) / 20_000 * one.b
    assert one.chords(rows).mean() == approx(one.chord_share, rel=1e-5)
    assert 4.0 * one.a * one.b * one.chord_share == approx(one.area, rel=1e-12)


@pytest.mark.parametrize("radius_y", [10e-3, 40e-3, 2e-3])
def test_the_lever_of_friction_is_the_mean_distance_under_the_pressure(radius_y):
    hertz = hertz_point(50.0, 10e-3, radius_y, E)
    angle, part = np.meshgrid((np.arange(400) + 0.5) * np.pi / 800, (np.arange(4000) + 0.5) / 4000)
    weight = part * np.sqrt(1.0 - part**2)
    away = part * np.hypot(hertz.a * np.cos(angle), hertz.b * np.sin(angle))
    assert hertz.lever_share * hertz.b == approx((weight * away).sum() / weight.sum(), rel=1e-5)
    strip = hertz_line(50.0, 1e-3, 8e-3, E)
    x, y = np.meshgrid((np.arange(200) + 0.5) / 200 * strip.a, (np.arange(200) + 0.5) / 200 * strip.b)
    weight = np.sqrt(1.0 - (x / strip.a) ** 2)
    assert strip.lever_share * strip.b == approx((weight * np.hypot(x, y)).sum() / weight.sum(), rel=1e-3)


def test_palmgrens_rollers_approach_as_half_spaces_do_to_15_percent():
    """Measured on crowned rollers: the two are alike, not the same."""
    for load in (1000.0, 5000.0, 20000.0):
        measured = palmgren_approach(load, 12e-3, E)
        assert measured == approx(3.84e-5 * load**0.9 / 12.0**0.8 * 1e-3, rel=0.02)  # as printed, N and mm
        assert measured == approx(hertz_line(load, 5e-3, 12e-3, E).approach, rel=0.15)


@pytest.mark.parametrize("ratio", [0.3, 1.0, 4.0, 30.0])
def test_slow_sliding_of_a_spinning_contact_is_a_matter_of_its_middle(ratio):
    """Friction in proportion to pressure, in the direction of (u - w y, w x): its sum along x for a small u."""
    hertz = hertz_point(50.0, 0.01, 0.01 * ratio, 2.3e11)
    t = np.sin(0.5 * np.pi * (np.arange(400) + 0.5) / 400)[:, None] ** 2  # finer at the middle and at the edge
    angle = 2.0 * np.pi * (np.arange(4000) + 0.5)[None, :] / 4000
    width = np.gradient(t[:, 0])[:, None]
    x, y, part = hertz.a * t * np.cos(angle), hertz.b * t * np.sin(angle), np.sqrt(1.0 - t**2) * t * width
    slow = 1e-3 * min(hertz.a, hertz.b)  # sliding speed over spin
    along = (slow - y) / np.hypot(slow - y, x)
    found = float((part * along).sum() / (part * np.ones_like(along)).sum())
    assert found == approx(slow / (hertz.turn_share * hertz.b), rel=0.02)
