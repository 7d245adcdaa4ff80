"""What lies beyond the grid of a light contact: Kapitza's pressure of an ellipsoid, by quadrature of its own."""

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import dblquad

from contact_core.kernels.far_field import far_field

FILM = 0.3


def pressure(x, y, curvature, wedge, closing):
    """Of the rigid, half-flooded ellipsoid, up to a factor."""
    return max(closing - wedge * x, 0.0) / (FILM + 0.5 * (x * x + curvature * y * y)) ** 2


@pytest.mark.parametrize("curvature", [0.1, 1.0, 10.0])
@pytest.mark.parametrize(("wedge", "closing"), [(1.0, 0.0), (1.0, 0.8), (0.0, 1.0)])
def test_pressure_like_one_over_the_gap_squared_balances_wedge_and_squeeze(curvature, wedge, closing):
    """div(h^3 grad p) = -(3 + 2 k) wedge dh/dx ... as finite differences have it, p of `far_field`'s decay."""

    def flow(x, y, dx, dy):
        gap = FILM + 0.5 * (x * x + curvature * y * y)
        h = 1e-4
        there, here = (pressure(x + s * h * dx, y + s * h * dy, curvature, wedge, closing) for s in (0.5, -0.5))
        return gap**3 * (there - here) / h

    x, y, h = -0.7, 0.4, 1e-3
    net = flow(x + h, y, 1, 0) - flow(x - h, y, 1, 0) + flow(x, y + h, 0, 1) - flow(x, y - h, 0, 1)
    asked = (3.0 + 2.0 * curvature) * wedge * x - (2.0 + 2.0 * curvature) * closing
    assert net / (2.0 * h) == approx(asked, rel=1e-4)


@pytest.mark.parametrize("curvature", [0.1, 1.0, 10.0])
@pytest.mark.parametrize(("wedge", "closing"), [(1.0, 0.0), (0.0, 1.0)])
def test_weights_hold_the_load_beyond_the_grid(curvature, wedge, closing):
    """The grid's sum with weights is the integral over the plane, within the error of the grid's midpoint rule."""
    x, y = np.linspace(-3.0, 2.0, 201), np.linspace(-2.5, 2.5, 201)
    ratio, weight = far_field(x, y, FILM, curvature, wedge, closing)
    p = np.array([[pressure(a, b, curvature, wedge, closing) for a in x] for b in y])
    assert ratio[100, 0] == approx(p[100, 0] / p[100, 1], rel=1e-12)
    assert ratio[0, 60] == approx(p[0, 60] / p[1, 60], rel=1e-12)
    found = float((weight * p).sum()) * (x[1] - x[0]) ** 2
    # in polar coordinates, r = t / (1 - t)
    exact = dblquad(
        lambda t, angle: (
            pressure(t / (1.0 - t) * np.cos(angle), t / (1.0 - t) * np.sin(angle), curvature, wedge, closing)
            * t
            / (1.0 - t) ** 3
        ),
        0.5 * np.pi if closing == 0.0 else 0.0,
        1.5 * np.pi if closing == 0.0 else 2.0 * np.pi,
        0.0,
        1.0,
    )[0]
    beyond = float(((weight - 1.0) * p).sum()) * (x[1] - x[0]) ** 2
    assert beyond > 0.05 * exact
    assert found == approx(exact, rel=5e-3)


@pytest.mark.parametrize("film", [-0.5, -1e-3, 0.0, 1e-3])
@pytest.mark.parametrize(("wedge", "closing"), [(1.0, 0.0), (0.0, 1.0)])
def test_bodies_flattened_or_lifted_carry_beyond_the_grid_what_their_own_gap_says(film, wedge, closing):
    x = np.linspace(-3.0, 3.0, 121)
    ratio, weight = far_field(x, x, film, 1.0, wedge, closing)
    xx, yy = np.meshgrid(x, x)
    radius_2, spacing = xx**2 + yy**2, x[1] - x[0]
    gap = np.where(ratio > 0.0, film + 0.5 * radius_2, np.inf)
    p = np.maximum(closing - wedge * xx, 0.0) / gap**2
    found = float(((weight - 1.0) * p).sum()) * spacing**2
    side = 3.0 + 0.5 * spacing  # the cells reach there; outside the square, in the sector of one side and then of all
    turn = (lambda angle: np.cos(angle)) if wedge else (lambda angle: 1.0)

    def beyond(t, angle):
        begin = side / max(abs(np.cos(angle)), abs(np.sin(angle)))
        r = begin / t
        return abs(turn(angle)) * r ** (1.0 + wedge) / (film + 0.5 * r * r) ** 2 * begin / t**2

    whole = 1.5 if wedge else 2.0
    exact = dblquad(beyond, (0.5 if wedge else 0.0) * np.pi, whole * np.pi, 1e-9, 1.0)[0]
    assert found == approx(exact, rel=5e-3)
