"""Stress below tractions on cells, held against closed forms: whole fields, and the order in the spacing."""

import numpy as np
import pytest
from comparison import approx

from benchmarks.stress.closed_forms import circle_stress, ellipse_axis_stress, line_stress
from contact_core import dry_contact, graded_depths, subsurface_stress
from contact_core.reference import hertz_point

# lengths in half widths of the contact, stress in its largest pressure


def nodes(across, reach=1.3):
    spacing = 2.0 / (across - 1)
    half = int(reach / spacing)
    return spacing * np.arange(-half, half + 1.0), spacing


def ellipse(x, y, b, spacing, parts=16):
    """Means of Hertz's pressure over cells."""
    part = ((np.arange(parts) + 0.5) / parts - 0.5) * spacing
    fields = [1.0 - (x[None, :] + s) ** 2 - ((y[:, None] + t) / b) ** 2 for s in part for t in part]
    return np.mean([np.sqrt(np.maximum(field, 0.0)) for field in fields], axis=0)


def strip(x, spacing):
    ends = np.clip([x - 0.5 * spacing, x + 0.5 * spacing], -1.0, 1.0)
    low, high = 0.5 * (ends * np.sqrt(1.0 - ends**2) + np.arcsin(ends))
    return np.tile((high - low) / spacing, (3, 1))


def circle_error(across, depths, given=None):
    """Largest error of each node and depth [nz, ny, nx], and the distance from the edge."""
    x, spacing = nodes(across)
    p = ellipse(x, x, 1.0, spacing) if given is None else given
    found = subsurface_stress(p, None, None, spacing, depths, poisson_ratio=0.3, fft="scipy").stress
    exact = circle_stress(x[None, :], x[:, None], np.asarray(depths)[:, None, None], 1.0, 1.0, 0.3)
    return np.abs(found - exact).max(axis=0), np.abs(np.hypot(x[None, :], x[:, None]) - 1.0)


def line_error(across, depths, friction):
    x, spacing = nodes(across)
    p = strip(x, spacing)
    found = subsurface_stress(p, friction * p, None, spacing, depths, periodic=True, fft="scipy").stress
    exact = line_stress(x, np.asarray(depths)[:, None, None], 1.0, 1.0, 0.3, friction)
    return np.abs(found - exact).max(axis=0), np.abs(np.abs(x) - 1.0)[None, :]


H = 2.0 / 64  # spacing of 65 nodes per contact
DEEPER = [H, 1.5 * H, 2.0 * H, 4.0 * H, 0.25, 0.48, 1.0, 1.5]


def test_below_one_spacing_a_circle_is_within_one_percent_everywhere():
    error, _ = circle_error(65, DEEPER)
    assert error.max() < 0.01


def test_so_is_the_pressure_that_the_dry_contact_finds():
    hertz = hertz_point(50.0, 1e-2, 1e-2, 2.3e11)
    x, spacing = nodes(65)
    contact = dry_contact(np.zeros((x.size, x.size)), spacing * hertz.a, 1e-2, 50.0, 2.3e11)
    error, _ = circle_error(65, DEEPER, contact.pressure / hertz.pressure_max)
    assert error.max() < 0.01


@pytest.mark.parametrize("friction", [0.0, 0.1, 0.2, 0.3, 0.4])
def test_below_one_spacing_a_sliding_line_is_within_one_percent_everywhere(friction):
    error, _ = line_error(65, DEEPER, friction)
    assert error.max() < 0.01


@pytest.mark.parametrize(
    ("case", "surface"),
    [(circle_error, 0.002), (lambda *at: line_error(*at, 0.0), 0.002), (lambda *at: line_error(*at, 0.4), 0.014)],
)
def test_above_it_the_edge_of_the_contact_alone_is_worse(case, surface):
    error, from_edge = case(65, [0.0, 0.25 * H, 0.5 * H])
    away = np.where(from_edge > 2.0 * H, error, 0.0).max(axis=(1, 2))
    assert away[0] < surface
    assert away[1:].max() < 0.008


@pytest.mark.parametrize("case", [circle_error, lambda *at: line_error(*at, 0.4)])
def test_at_a_depth_the_order_is_two(case):
    errors = [case(n, [0.48])[0].max() for n in (17, 33, 65)]
    assert (np.log2(np.divide(errors[:-1], errors[1:])) > 1.9).all()
    assert errors[-1] < 3e-4


def test_largest_shear_and_von_mises_stress_below_a_circle():
    """.310 p_max at .48 a and .62 p_max, Poisson's ratio 0.3."""
    x, spacing = nodes(65, 1.1)
    depths = np.linspace(0.3, 0.7, 41)
    found = subsurface_stress(ellipse(x, x, 1.0, spacing), None, None, spacing, depths, fft="scipy")
    for measure, size in ((found.largest_shear, 0.310), (found.von_mises, 0.620)):
        layer, row, column = np.unravel_index(measure.argmax(), measure.shape)
        assert measure.max() == approx(size, abs=5e-4)
        assert depths[layer] == approx(0.48, abs=0.011)
        assert (row, column) == (x.size // 2, x.size // 2)
    graded = subsurface_stress(
        ellipse(x, x, 1.0, spacing), None, None, spacing, graded_depths(spacing, 1.0), fft="scipy"
    )
    assert graded.largest_shear.max() == approx(0.310, rel=0.01)


@pytest.mark.parametrize("b", [1.25, 2.0, 4.0])
def test_the_axis_of_an_ellipse(b):
    x, spacing = nodes(65, 1.1)
    y = spacing * np.arange(-int(1.1 * b / spacing), int(1.1 * b / spacing) + 1.0)
    depths = np.array([H, 0.25, 0.5, 0.6, 0.7, 1.0, 1.5])
    found = subsurface_stress(ellipse(x, y, b, spacing, 8), None, None, spacing, depths, fft="scipy")
    exact = ellipse_axis_stress(depths, 1.0, b, 1.0, 0.3)
    assert found.stress[:3, :, y.size // 2, x.size // 2] == approx(exact, abs=5e-4)
    swapped = subsurface_stress(ellipse(x, y, b, spacing, 8).T, None, None, spacing, depths, fft="scipy")
    assert swapped.stress[:3, :, x.size // 2, y.size // 2] == approx(exact[[1, 0, 2]], abs=5e-4)


def test_a_wave_of_pressure_dies_away_with_its_length():
    """cos(k x) cos(q y) on a periodic strip, far from its ends: it alone is left at the depth of six cells."""
    rows, nx = 32, 601
    k, q = 2.0 * np.pi / 30.0, 2.0 * np.pi / rows
    x, y = np.arange(nx) - nx // 2, np.arange(rows)
    s, z, v = np.hypot(k, q), 6.0, 0.3
    waves = np.cos(q * y)[:, None] * np.cos(k * x)[None, :]
    steps = np.sinc(0.5 * k / np.pi) * np.sinc(0.5 * q / np.pi)  # share of the wave in steps as high as it
    found = subsurface_stress(waves / steps, None, None, 1.0, [z], periodic=True, fft="scipy").stress[:, 0]
    fall = np.exp(-s * z)
    xx = (k**2 * (1.0 - s * z) + 2.0 * v * q**2) / s**2 * fall
    yy = (q**2 * (1.0 - s * z) + 2.0 * v * k**2) / s**2 * fall
    middle = np.s_[:, nx // 2 - 10 : nx // 2 + 10]
    for component, size in ((0, -xx), (1, -yy), (2, -(1.0 + s * z) * fall)):
        assert found[component][middle] == approx((size * waves)[middle], abs=1e-6)
