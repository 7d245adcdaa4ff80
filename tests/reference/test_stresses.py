"""Closed forms of stress below Hertz's contacts, held against integrals of point and line forces and against tables."""

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from benchmarks.stress.closed_forms import circle_stress, ellipse_axis_stress, line_stress


def boussinesq(x, y, z, poisson):
    """Stress of a unit force along z at the origin, by its components in polar coordinates."""
    r, out, soft = np.hypot(x, y), np.sqrt(x * x + y * y + z * z), 1.0 - 2.0 * poisson
    radial = soft / (out * (out + z)) - 3.0 * z * r**2 / out**5
    hoop = soft * (z / out**3 - 1.0 / (out * (out + z)))
    c, s, shear = x / r, y / r, -3.0 * r * z**2 / out**5
    xx, yy, xy = radial * c * c + hoop * s * s, radial * s * s + hoop * c * c, (radial - hoop) * s * c
    return np.stack([xx, yy, -3.0 * z**3 / out**5, shear * s, shear * c, xy]) / (2.0 * np.pi)


def under_ellipse(x, y, z, b, poisson):
    """Stress under the pressure (1 - x^2 - y^2 / b^2)^0.5: Gauss nodes for t = pressure, even angles."""
    t, weight = np.polynomial.legendre.leggauss(60)
    t, weight = 0.5 + 0.5 * t[:, None], 0.5 * weight[:, None]
    angle = 2.0 * np.pi * (np.arange(240)[None, :] + 0.37) / 240
    r = np.sqrt(1.0 - t * t)
    force = t * t * weight * b * 2.0 * np.pi / 240
    return (boussinesq(x - r * np.cos(angle), y - b * r * np.sin(angle), z, poisson) * force).sum(axis=(1, 2))


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("place", [(0.0, 0.0), (0.4, 0.0), (0.3, -0.6), (-1.0, 0.0), (0.0, 1.2), (2.0, -1.0)])
def test_the_circle_is_the_integral_of_point_forces(place, poisson):
    for z in (0.5, 1.0, 3.0):
        found = circle_stress(*(2.0 * np.array([*place, z])), 2.0, 5.0, poisson)
        assert found == approx(5.0 * under_ellipse(*place, z, 1.0, poisson), abs=5e-5)


def test_the_circle_has_the_surface_stress_of_textbooks():
    """-(1 + 2 v) p_max / 2 in the centre, (1 - 2 v) p_max / 3 at the edge, as 1 / r^2 outside: pure shear."""
    x = np.array([0.0, 1.0, 1.0 + 1e-12, 2.0])
    xx, yy, zz, *shear = circle_stress(x, 0.0 * x, 0.0 * x, 1.0, 1.0, 0.3)
    assert xx == approx(np.array([-0.8, 0.4 / 3.0, 0.4 / 3.0, 0.1 / 3.0]), abs=2e-6)
    assert yy == approx(np.array([-0.8, -0.4 / 3.0, -0.4 / 3.0, -0.1 / 3.0]), abs=2e-6)
    assert zz == approx(np.array([-1.0, 0.0, 0.0, 0.0]), abs=2e-6)
    assert not np.abs(shear).any()


def test_no_place_of_the_closed_forms_lacks_a_value():
    x = np.array([0.0, 1e-200, 1e-9, 0.5, 1.0 - 1e-16, 1.0, 1.0 + 1e-15, 30.0])
    for z in (0.0, 1e-200, 1e-12, 1e-3, 50.0):
        for stress in (circle_stress(x, 0.0, z, 1.0, 1.0, 0.3), line_stress(x, z, 1.0, 1.0, 0.3, 0.4)):
            assert np.isfinite(stress).all()
            assert np.abs(stress).max() < 2.1


def under_line(x, z, friction):
    """xx, zz, xz by Flamant's line forces: pressure and friction times it, at s = sin(t)."""

    def part(t, name):
        dx, p = x - np.sin(t), np.cos(t) ** 2
        force = -2.0 / np.pi * p * (z - friction * -dx) / (dx * dx + z * z) ** 2
        return force * {"xx": dx * dx, "zz": z * z, "xz": dx * z}[name]

    return [quad(part, -np.pi / 2, np.pi / 2, args=(name,), limit=400, epsabs=1e-11)[0] for name in ("xx", "zz", "xz")]


@pytest.mark.parametrize("friction", [0.0, 0.1, 0.4, -0.4])
@pytest.mark.parametrize("x", [0.0, 0.3, 1.0, -1.0, 1.5, -2.0])
def test_the_line_is_the_integral_of_line_forces(x, friction):
    for z in (0.05, 0.5, 2.0):
        found = line_stress(3.0 * x, 3.0 * z, 3.0, 7.0, 0.27, friction)
        assert found[[0, 2, 4]] == approx(7.0 * np.array(under_line(x, z, friction)), abs=1e-7)
        assert found[1] == approx(0.27 * (found[0] + found[2]), rel=1e-13)
        assert not found[[3, 5]].any()


def test_a_sliding_line_pulls_the_surface_behind_it():
    """-p - 2 mu x / a on the contact; 2 mu p_max at the end that the friction points away from, tension."""
    x = np.array([-1.0, -0.5, 0.0, 0.5, 1.0])
    xx, _, zz, _, xz, _ = line_stress(x, 0.0, 1.0, 1.0, 0.3, 0.4)
    p = np.sqrt(1.0 - x * x)
    assert xx == approx(-p - 0.8 * x, abs=1e-13)
    assert zz == approx(-p, abs=1e-13)
    assert xz == approx(-0.4 * p, abs=1e-13)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("b", [0.2, 0.7, 1.0, 3.0])
def test_the_axis_of_an_ellipse_is_the_integral_of_point_forces(b, poisson):
    for z in (0.6, 2.0):
        found = ellipse_axis_stress(2.0 * z, 2.0, 2.0 * b, 5.0, poisson)
        assert found == approx(5.0 * under_ellipse(1e-9, 0.0, z, b, poisson)[:3], abs=2e-4)


def test_the_axis_of_an_ellipse_joins_those_of_circle_and_line():
    z = np.linspace(0.0, 4.0, 30)
    circle = circle_stress(0.0 * z, 0.0 * z, z, 1.0, 1.0, 0.3)[:3]
    assert ellipse_axis_stress(z, 1.0, 1.0, 1.0, 0.3) == approx(circle, abs=1e-13)
    assert ellipse_axis_stress(z, 1.0, 1e4, 1.0, 0.3) == approx(line_stress(0.0 * z, z, 1.0, 1.0, 0.3)[:3], abs=5e-5)


def largest(a, b):
    """Depth and size of the largest shear on the axis."""

    def shear(z):
        stress = ellipse_axis_stress(z, a, b, 1.0, 0.3)
        return 0.5 * float(stress.max() - stress.min())

    found = minimize_scalar(lambda z: -shear(z), bounds=(0.05, 1.5), method="bounded", options={"xatol": 1e-9})
    return found.x, shear(found.x)


@pytest.mark.parametrize(
    ("ratio", "depth", "shear"),
    [
        (1e-6, 0.785, 0.3),
        (0.2, 0.745, 0.322),
        (0.4, 0.665, 0.325),
        (0.6, 0.59, 0.323),
        (0.8, 0.53, 0.317),
        (1.0, 0.48, 0.31),
    ],
)
def test_largest_shear_of_ellipses_is_that_of_the_table(ratio, depth, shear):
    """Johnson, Contact Mechanics, table 4.1 (from memory): depth over the short half width, shear over the pressure."""
    found_depth, found_shear = largest(1.0, 1.0 / ratio)
    assert found_depth == approx(depth, rel=0.011)  # of a flat maximum
    assert found_shear == approx(shear, abs=1e-3)
    assert largest(1.0 / ratio, 1.0) == approx(largest(1.0, 1.0 / ratio), abs=1e-6)
