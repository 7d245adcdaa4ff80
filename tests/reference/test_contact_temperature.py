"""Largest temperature of smooth sliding contacts against Jaeger's integral and Blok's formula."""

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import quad
from scipy.optimize import minimize_scalar
from scipy.special import k0e

from contact_core.laws.heat import TemperatureField
from contact_core.laws.temperatures import Rubbing
from contact_core.reference import Hertz, jaeger_circle

CONDUCTIVITY, DIFFUSIVITY, A, FLUX = 46.0, 1.25e-5, 1e-4, 1e8  # FLUX: mean over the contact [W/m2]
LAW = TemperatureField(CONDUCTIVITY, CONDUCTIVITY, DIFFUSIVITY, DIFFUSIVITY)
UNIT = FLUX * A / CONDUCTIVITY
PECLETS = (0.05, 1.0, 8.0, 60.0)


def speed(peclet: float) -> float:
    return 2.0 * DIFFUSIVITY * peclet / A


def hertz_circle(peclet: float) -> float:
    """Largest rise under a flux like Hertz's pressure on a circle, in units of mean flux A / K: by polar quadrature."""

    def rise(x: float) -> float:
        def along(angle: float) -> float:
            c, s = np.cos(angle), np.sin(angle)
            reach = x * c + np.sqrt(max(1.0 - (x * s) ** 2, 0.0))

            def part(r: float) -> float:
                beside = max(1.0 - (x - r * c) ** 2 - (r * s) ** 2, 0.0)
                return float(1.5 * np.sqrt(beside) * np.exp(-peclet * r * (1.0 - c)))

            return float(quad(part, 0.0, reach, limit=100, epsrel=1e-7)[0])

        narrow = min(4.0 / np.sqrt(1.0 + peclet), 3.0)
        return float(quad(along, 0.0, np.pi, points=[narrow], limit=100, epsrel=1e-6)[0]) / np.pi

    return -float(minimize_scalar(lambda x: -rise(x), bounds=(0.0, 1.0), method="bounded", options={"xatol": 1e-3}).fun)


def hertz_band(peclet: float) -> float:
    """The same under an endless band: by line sources."""

    def rise(x: float) -> float:
        def part(angle: float) -> float:  # source at sin(angle)
            away = peclet * (x - np.sin(angle))
            return float(4.0 / np.pi * np.cos(angle) ** 2 * k0e(abs(away)) * np.exp(away - abs(away)))

        here = np.arcsin(x)
        return float(quad(part, -0.5 * np.pi, 0.5 * np.pi, points=[here], limit=400, epsrel=1e-7)[0]) / np.pi

    return -float(minimize_scalar(lambda x: -rise(x), bounds=(-0.5, 0.99), method="bounded").fun)


def hottest(flux: np.ndarray, spacing: float, nodes: int, speeds: tuple[float, float], face: float | None = None):
    """Rise of the hottest nodes of two bodies that slide without oil between them."""
    gap, inside = np.full(flux.shape, 1e-12), flux > 0.0
    found = LAW.temperatures(Rubbing(flux, gap, inside, inside, spacing, speeds, (350.0, 350.0), 0.14, face))
    assert found.solved
    return found.hottest(nodes) - 350.0


def circle(n: int, even: bool) -> tuple[np.ndarray, float, int]:
    spacing = 2.4 * A / (n - 1)
    x = (np.arange(n) - n // 2) * spacing / A
    inside = np.maximum(1.0 - x[None, :] ** 2 - x[:, None] ** 2, 0.0)
    shape = np.where(inside > 0.0, 1.0, 0.0) if even else np.sqrt(inside)
    flux = FLUX * np.pi * A**2 / spacing**2 * shape / shape.sum()
    return flux, spacing, max(round(0.01 * np.pi * A**2 / spacing**2), 1)


@pytest.mark.parametrize("peclet", PECLETS)
def test_the_hottest_percent_of_a_hertzian_circle_is_jaegers_largest_rise(peclet):
    exact = 0.5 * UNIT * hertz_circle(peclet)  # either body takes half
    errors = []
    for n in (33, 65, 129):
        flux, spacing, nodes = circle(n, even=False)
        errors.append(hottest(flux, spacing, nodes, (speed(peclet), speed(peclet))) / exact - 1.0)
    print(f"Peclet number {peclet:g}: " + ", ".join(f"{error:+.2%}" for error in errors))
    assert abs(errors[-1]) < 0.012
    assert abs(errors[0]) < 0.03


@pytest.mark.parametrize("peclet", PECLETS)
def test_the_hottest_percent_of_an_even_circle_is_jaegers_largest_rise(peclet):
    flux, spacing, nodes = circle(129, even=True)
    found = hottest(flux, spacing, nodes, (speed(peclet), speed(peclet)))
    assert found == approx(0.5 * UNIT * jaeger_circle(peclet)[0], rel=0.03)  # its ridge at the trailing edge is narrow


def test_the_hottest_percent_of_a_fast_sliding_line_is_bloks_flash_temperature():
    u_1, u_2 = 10.0, 4.0
    n, rows = 129, 9
    spacing = 2.4 * A / (n - 1)
    x = (np.arange(n) - n // 2) * spacing / A
    shape = np.sqrt(np.maximum(1.0 - x**2, 0.0))
    flux = np.tile(FLUX * 2.0 * A / spacing * shape / shape.sum(), (rows, 1))
    nodes = max(round(0.01 * 2.0 * A / spacing * rows), 1)
    found = hottest(flux, spacing, nodes, (u_1, u_2), face=2000 * spacing)
    effusivity = CONDUCTIVITY / np.sqrt(DIFFUSIVITY)
    friction = FLUX * 2.0 * A / (u_1 - u_2)  # per length
    blok = 1.11 * friction * (np.sqrt(u_1) - np.sqrt(u_2)) / (effusivity * np.sqrt(2.0 * A))
    print(f"line: {found:.2f} K, Blok {blok:.2f} K")
    assert found == approx(blok, rel=0.03)


@pytest.mark.parametrize("peclet", (1e-3, 0.1, 1.0, 3.0, 10.0, 100.0, pytest.param(1e4, marks=pytest.mark.long)))
def test_conductances_of_the_hottest_spot_are_those_of_jaegers_integral(peclet):
    still = np.array([0.0]) if peclet < 1e-2 else np.array([speed(peclet)])
    on_circle = float(LAW.conductances(np.array([A]), (still, still), hottest=True)[0][0])
    assert FLUX / on_circle == approx(UNIT * hertz_circle(peclet), rel=0.012)
    if peclet > 0.5:
        on_strip = float(LAW.strip_conductances(np.array([A]), 1e3 * A, (still, still), hottest=True)[0][0])
        ratio = FLUX / on_strip / (UNIT * hertz_band(peclet))
        print(f"strip at Peclet number {peclet:g}: {ratio - 1.0:+.1%}")
        assert ratio == approx(1.0, rel=0.05 if peclet < 2.0 else 0.006)


def test_a_strip_at_rest_is_hottest_in_its_middle_as_by_lines_of_heat():
    long, u = 50.0, np.array([0.0])
    found = FLUX / float(LAW.strip_conductances(np.array([A]), long * A, (u, u), hottest=True)[0][0])

    def line(angle: float) -> float:  # of half length `long` at the distance |sin(angle)|
        return float(4.0 / np.pi * np.cos(angle) ** 2 * np.arcsinh(long / abs(np.sin(angle))))

    exact = 2.0 * quad(line, 0.0, 0.5 * np.pi, limit=200)[0] / np.pi
    assert found == approx(UNIT * exact, rel=0.01)  # a body at rest counts as creeping


def test_an_ellipse_across_the_motion_is_cooler_than_the_circle_of_its_area_by_its_shorter_way():
    fast = np.array([speed(1e5)])
    area = np.array([np.pi * A * A])
    bodies = [Hertz(a, A * A / a, 1.0, 1.0) for a in (A, 0.25 * A)]
    round_, narrow = (body.conductances(LAW, area, (fast, fast), hottest=True)[0][0] for body in bodies)
    assert round_ / narrow == approx(np.sqrt(0.25), rel=1e-4)
