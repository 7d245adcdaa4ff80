"""Moving heat sources against quadratures of Jaeger's integral that share nothing with the kernel."""

import numpy as np
import pytest
from closed_forms import jaeger_band
from comparison import approx
from scipy.integrate import dblquad, quad
from scipy.special import k0

from contact_core.kernels.half_space import influence
from contact_core.kernels.moving_source import MovingSurface, moving_influence, periodic_moving_influence
from contact_core.laws.heat import TemperatureField
from contact_core.reference import jaeger_circle, tian_kennedy_circle

CONDUCTIVITY, DIFFUSIVITY = 46.0, 1.25e-5


def kernel(y: float, x: float, peclet: float) -> float:
    """exp[-P (r - x)] / r; downstream r - x is y^2 / (r + x), which keeps its digits."""
    r = float(np.hypot(x, y))
    return float(np.exp(-peclet * (y * y / (r + x) if x > 0.0 else r - x)) / r)


def cell(j: int, i: int, peclet: float) -> float:
    """The kernel over the unit cell at the distance (j, i), not its own."""
    low, weight = (0.0, 2.0) if j == 0 else (j - 0.5, 1.0)  # symmetric across
    args = {"args": (peclet,), "epsabs": 1e-13, "epsrel": 1e-9}
    return weight * dblquad(kernel, i - 0.5, i + 0.5, low, j + 0.5, **args)[0]


def own_cell(peclet: float) -> float:
    """The kernel over the cell around the point, in polar coordinates: exact along the radius."""

    def part(angle: float) -> float:
        reach = 0.5 / max(abs(np.cos(angle)), abs(np.sin(angle)))
        rate = 2.0 * peclet * np.sin(0.5 * angle) ** 2
        return float(-np.expm1(-rate * reach) / rate if rate * reach > 1e-14 else reach)

    corners = [np.pi / 4, np.pi / 2, 3 * np.pi / 4, min(4.0 / np.sqrt(1.0 + peclet), 3.0)]
    return 2.0 * quad(part, 0.0, np.pi, points=corners, limit=400, epsabs=0.0, epsrel=1e-12)[0]


PECLETS = (1e-6, 0.03, 1.0, 30.0, 1e3)


@pytest.mark.parametrize("peclet", PECLETS)
def test_coefficients_are_integrals_of_jaegers_source_over_cells(peclet):
    n = 41
    found = moving_influence(n, n, peclet)
    largest = found[0, n - 1]
    assert largest == approx(own_cell(peclet), rel=1e-11)
    errors = [
        abs(found[j, n - 1 + i] - cell(j, i, peclet)) / largest
        for j, i in ((0, 1), (0, -1), (1, 0), (1, 1), (2, -2), (0, 5), (1, 40), (40, 3), (0, -40))
    ]
    print(f"cell Peclet number {peclet:g}: largest error {max(errors):.1e} of the coefficient of the cell itself")
    assert max(errors) < 1e-9


def test_a_source_at_rest_has_loves_coefficients():
    half = influence(7, 9)
    found = moving_influence(7, 9, 0.0)
    assert np.array_equal(found[:, 8:], half)
    assert np.array_equal(found[:, 8::-1], half)
    assert moving_influence(7, 9, 1e-12) == approx(found, rel=1e-9)


@pytest.mark.parametrize("peclet", PECLETS)
def test_a_reversed_motion_has_mirrored_coefficients_and_its_wake_downstream(peclet):
    found = moving_influence(6, 8, peclet)
    assert np.array_equal(moving_influence(6, 8, -peclet), found[:, ::-1])
    assert np.all(found[:, 8:] >= found[:, 6::-1])
    assert np.all(found[0, 8:] > found[0, 6::-1])


@pytest.mark.parametrize("speed", [0.0, 0.7, -0.7])
def test_a_rise_is_the_sum_over_all_cells(speed):
    ny, nx, spacing = 7, 10, 3e-6
    flux = np.random.default_rng(3).random((ny, nx)) * 1e9
    table = moving_influence(ny, nx, speed * spacing / (2.0 * DIFFUSIVITY))
    expected = np.zeros((ny, nx))
    for j in range(ny):
        for i in range(nx):
            for m in range(ny):
                expected[j, i] += table[abs(j - m), nx - 1 + i : i - 1 if i else None : -1] @ flux[m]
    expected *= spacing / (2.0 * np.pi * CONDUCTIVITY)
    found = MovingSurface((ny, nx), spacing, CONDUCTIVITY, DIFFUSIVITY, speed).rise(flux)
    assert found == approx(expected, rel=1e-12)


def circle(cells: int) -> np.ndarray:
    """Share of each cell in a circle of a radius of so many cells; cells that the circle cuts by 32 x 32 points."""
    n, fine = 2 * cells + 3, 32
    at = (np.arange(n * fine) + 0.5) / fine - 0.5 * n
    inside = (at[:, None] ** 2 + at[None, :] ** 2 < cells**2).reshape(n, fine, n, fine)
    return inside.mean(axis=(1, 3))


def resolved(peclet: float, cells: int) -> tuple[float, float]:
    """Largest and mean rise under a circle of so many cells' radius, in q r / K."""
    share = circle(cells)
    spacing = 1e-5 / cells
    speed = peclet * 2.0 * DIFFUSIVITY / 1e-5
    rise = MovingSurface(share.shape, spacing, CONDUCTIVITY, DIFFUSIVITY, speed).rise(share)
    unit = 1e-5 / CONDUCTIVITY
    return float(rise.max() / unit), float((rise * share).sum() / share.sum() / unit)


def test_jaegers_circle_at_rest_has_its_closed_form():
    assert jaeger_circle(0.0) == approx((1.0, 8.0 / (3.0 * np.pi)), rel=1e-8)


def test_jaegers_circle_at_high_speed_is_conduction_straight_into_the_body():
    """2 q sqrt(k t / (pi K^2)) of the time under the source: largest at the end of the longest chord."""
    largest, mean = jaeger_circle(1e6)
    assert largest == approx(2.0 / np.sqrt(np.pi * 1e6), rel=1e-3)
    assert mean == approx(1.2204 / np.sqrt(np.pi * 1e6), rel=1e-4)


def test_a_static_circle_reaches_both_limits():
    largest, mean = resolved(0.0, 40)
    print(f"static circle, 40 cells: largest {largest:.5f} q r/K (1), mean {mean:.5f} q r/K (0.84883)")
    assert largest == approx(1.0, rel=1e-3)
    assert mean == approx(8.0 / (3.0 * np.pi), rel=1e-3)


@pytest.mark.parametrize("peclet", [0.1, 1.0, 10.0, 100.0])
def test_a_moving_circle_follows_jaegers_integral(peclet):
    found, exact, formula = resolved(peclet, 40), jaeger_circle(peclet), tian_kennedy_circle(peclet)
    for name, one, right, other in zip(("largest", "mean"), found, exact, formula, strict=True):
        print(
            f"Peclet number {peclet:g}, {name}: {one:.5f} q r/K, "
            f"off Jaeger's integral {100 * (one / right - 1):+.3f} %; "
            f"Tian and Kennedy's formula {100 * (other / right - 1):+.2f} %"
        )
    assert found == approx(exact, rel=3e-3)
    # the formulas themselves are up to 2.2 % (largest) and 3.7 % (mean) off between their two exact limits
    assert found == approx(formula, rel=0.01 if peclet >= 10.0 else 0.045)


def test_a_long_strip_across_the_motion_is_jaegers_band():
    half, across, peclet = 6, 90, 2.0  # half width and half length in cells
    flux = np.zeros((2 * across + 1, 61))
    flux[:, 30 - half : 31 + half] = 1.0
    width = half + 0.5
    speed = peclet * 2.0 * DIFFUSIVITY / (width * 1e-6)
    rise = MovingSurface(flux.shape, 1e-6, CONDUCTIVITY, DIFFUSIVITY, speed).rise(flux)[across]
    x = (np.arange(61) - 30) / width
    exact = np.array([jaeger_band(float(at), peclet) for at in x]) * width * 1e-6 / CONDUCTIVITY
    assert np.abs(rise - exact).max() < 2e-3 * exact.max()
    assert rise.argmax() > 30


def test_jaegers_band_is_the_integral_of_its_line_source():
    for peclet, x in ((0.1, 3.0), (1.0, 0.3), (5.0, -1.05), (5.0, 1.0)):
        line = lambda w: np.exp(w) * k0(abs(w)) if w else 0.0  # noqa: E731
        ends = peclet * (x - 1.0), peclet * (x + 1.0)
        middle = [0.0] if ends[0] < 0.0 < ends[1] else None
        exact = quad(line, *ends, points=middle, limit=200)[0] / (np.pi * peclet)
        assert jaeger_band(x, peclet) == approx(exact, rel=1e-8)


def test_heat_at_rest_spreads_alike_in_all_directions():
    source = np.zeros((9, 9))
    source[4, 4] = 1e9
    rise = MovingSurface((9, 9), 1e-6, CONDUCTIVITY, DIFFUSIVITY, 0.0).rise(source)
    assert rise == approx(rise.T, rel=1e-12)
    assert rise == approx(rise[::-1, ::-1], rel=1e-12)


def strip_rise(a: float, b: float, speed: float) -> float:
    """Mean rise by the law, per flux, of body 1 under a strip."""
    law = TemperatureField(CONDUCTIVITY, 1.0, DIFFUSIVITY, 1.0)
    return 1.0 / float(law.strip_conductances(np.array(a), b, (np.array(speed), np.array(0.0)))[0])


@pytest.mark.parametrize("ratio", [20.0, 100.0])
def test_a_long_strip_at_rest_is_as_warm_in_the_mean_as_its_point_sources_make_it(ratio):
    def column(distance: float) -> float:  # mean along y of the integral of 1 / r over y
        return 2.0 * (np.arcsinh(2.0 * ratio / distance) - (np.hypot(2.0 * ratio, distance) - distance) / 2.0 / ratio)

    mean = quad(lambda distance: (2.0 - distance) * column(distance), 0.0, 2.0)[0] / (2.0 * np.pi)
    assert strip_rise(1e-4, 1e-4 * ratio, 0.0) == approx(mean * 1e-4 / CONDUCTIVITY, rel=0.02)


@pytest.mark.parametrize("peclet", [30.0, 300.0])
def test_a_fast_strip_is_as_warm_in_the_mean_as_jaegers_band(peclet):
    mean = quad(lambda x: jaeger_band(x, peclet), -1.0, 1.0, limit=400)[0] / 2.0
    speed = 2.0 * peclet * DIFFUSIVITY / 1e-4
    assert strip_rise(1e-4, 5e-3, speed) == approx(mean * 1e-4 / CONDUCTIVITY, rel=0.01)


@pytest.mark.parametrize("peclet", [0.01, 0.1, 0.5, 1.0, 3.0, 10.0])
def test_between_rest_and_speed_the_mean_of_a_strip_is_met_to_a_ninth(peclet):
    nx, ny = 16, 160  # cells of a strip ten times as long as wide; mean over pairs of cells
    cells = moving_influence(ny, nx, peclet / (0.5 * nx))
    along, across = nx - np.abs(np.arange(1 - nx, nx)), ny - np.arange(ny)
    pairs = along[None, :] * (np.where(np.arange(ny) == 0, 1, 2) * across)[:, None]
    mean = (cells * pairs).sum() / (nx * ny) * (2.0 / nx) / (2.0 * np.pi)
    found = strip_rise(1e-4, 1e-3, 2.0 * peclet * DIFFUSIVITY / 1e-4) * CONDUCTIVITY / 1e-4
    assert found == approx(mean, rel=0.11)
    assert found < mean


# lines that repeat themselves across the motion


@pytest.mark.parametrize("peclet", [0.1, 1.0, 30.0])
def test_a_repeated_cell_is_the_sum_of_its_images(peclet):
    ny, nx, images = 6, 7, 400
    alone = moving_influence(images * ny, nx, peclet)
    expected = sum(alone[np.abs(np.arange(ny) + k * ny)] for k in range(1 - images, images - 1))
    found = periodic_moving_influence(ny, nx, peclet, 1e9)
    assert found == approx(expected, rel=1e-9, abs=1e-12)


def test_a_face_with_ends_cools_the_middle_as_the_missing_images_would():
    ny, nx, images = 6, 7, 20  # on either side, of cells at rest
    alone = moving_influence((images + 1) * ny, nx, 0.0)
    expected = sum(alone[np.abs(np.arange(ny) + k * ny)] for k in range(-images, images + 1)).mean(axis=0)
    found = periodic_moving_influence(ny, nx, 0.0, (2 * images + 1) * ny).mean(axis=0)
    assert found == approx(expected, rel=1e-4)


@pytest.mark.parametrize("peclet", [0.3, 5.0, -5.0, 100.0])
def test_one_row_under_even_flux_is_jaegers_band(peclet):
    n, half = 401, 0.1e-3
    spacing = 2.0 * half / n
    surface = MovingSurface((1, n), spacing, CONDUCTIVITY, DIFFUSIVITY, 2.0 * DIFFUSIVITY * peclet / half, face=1e3)
    flux = 1e8
    found = surface.rise(np.full((1, n), flux))[0] * CONDUCTIVITY / (flux * half)
    x = (np.arange(n) - 0.5 * (n - 1)) * spacing / half
    expected = np.array([jaeger_band(float(np.sign(peclet) * xi), abs(peclet)) for xi in x])
    assert found == approx(expected, rel=1e-6)


def test_one_row_at_rest_is_as_warm_as_the_middle_of_a_long_strip():
    """2 a q / (pi K) [ln(b / a) + 3/2], b half the face: the mean of Jaeger's point sources across the middle."""
    n, half, face = 201, 0.1e-3, 20e-3
    surface = MovingSurface((1, n), 2.0 * half / n, CONDUCTIVITY, DIFFUSIVITY, 0.0, face)
    expected = 2.0 * half / (np.pi * CONDUCTIVITY) * (np.log(0.5 * face / half) + 1.5)
    assert surface.rise(np.ones((1, n))).mean() == approx(expected, rel=1e-4)


@pytest.mark.parametrize("speed", [0.0, 2.0])
def test_rows_that_repeat_may_be_counted_from_any_and_twice(speed):
    flux = np.random.default_rng(5).random((6, 9))
    one = MovingSurface((6, 9), 3e-6, CONDUCTIVITY, DIFFUSIVITY, speed, 1e-3)
    twice = MovingSurface((12, 9), 3e-6, CONDUCTIVITY, DIFFUSIVITY, speed, 1e-3)
    rise = one.rise(flux)
    assert one.rise(np.roll(flux, 2, axis=0)) == approx(np.roll(rise, 2, axis=0), rel=1e-12)
    assert twice.rise(np.tile(flux, (2, 1))) == approx(np.tile(rise, (2, 1)), rel=1e-9)
