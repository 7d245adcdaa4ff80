"""Forces of squeezed films against Reynolds' equation by differences, and its motions against their integration."""

import numpy as np
import pytest
from closed_forms import squeeze_line, squeeze_point, squeezed_line, squeezed_point
from comparison import approx
from scipy.integrate import quad, solve_ivp

ETA, GAP = 0.05, 1e-7


def force_of(outflow: float, radius: float, weight) -> float:
    """Of the pressure that drives outflow(r) = outflow r from under a parabola; `weight` of u = r / (2 R h_0)^0.5."""
    scale = np.sqrt(2.0 * radius * GAP)

    def pressure(u: float) -> float:  # p' = -12 eta outflow r / h^3
        steep, _ = quad(lambda v: v / (1.0 + v * v) ** 3, u, np.inf, epsrel=1e-10, limit=400)
        return 12.0 * ETA * outflow * scale**2 / GAP**3 * steep

    return quad(lambda u: weight(u, scale) * pressure(u), 0.0, np.inf, epsrel=1e-8, limit=400)[0]


def test_a_ball_is_opposed_by_the_pressure_of_reynolds_equation():
    """What a ring lets out, 2 pi r times the flow, is what is displaced inside, pi r^2 V."""
    radius, speed = 0.01, 1e-5
    force = force_of(0.5 * speed, radius, lambda u, scale: 2.0 * np.pi * scale**2 * u)
    assert squeeze_point(speed, GAP, radius, radius, ETA) == approx(force, rel=1e-6)
    assert squeeze_point(speed, GAP, radius, radius, ETA) == approx(6.0 * np.pi * ETA * speed * radius**2 / GAP)


def test_a_cylinder_is_opposed_by_the_pressure_of_reynolds_equation():
    radius, speed = 0.01, 1e-5
    force = force_of(speed, radius, lambda u, scale: 2.0 * scale)
    assert squeeze_line(speed, GAP, radius, ETA) == approx(force, rel=1e-6)


@pytest.mark.parametrize("radius_y", [0.003, pytest.param(0.05, marks=pytest.mark.long)])
def test_an_ellipsoid_meets_reynolds_equation_in_two_dimensions(radius_y):
    """The pressure behind the formula, F h_0 / (2 pi sqrt(R_x R_y) h^2), has the divergence of the displaced oil."""
    radius_x, speed = 0.01, 1e-5
    strength = squeeze_point(speed, GAP, radius_x, radius_y, ETA) * GAP / (2.0 * np.pi * np.sqrt(radius_x * radius_y))
    x, y = (np.linspace(-2e-4, 2e-4, 2001) for _ in range(2))
    x, y = x[:, None], y[None, 900:1101]

    def gap(x, y):
        return GAP + x * x / (2.0 * radius_x) + y * y / (2.0 * radius_y)

    step = x[1, 0] - x[0, 0]
    p, outflow = strength / gap(x, y) ** 2, 0.0
    for axis in (0, 1):
        apart = (0.5 * step, 0.0) if axis == 0 else (0.0, 0.5 * step)
        between = gap(x + apart[0], y + apart[1])
        between = between[:-1] if axis == 0 else between[:, :-1]
        flow = -(between**3) / (12.0 * ETA) * np.diff(p, axis=axis) / step
        outflow = outflow + np.diff(flow, axis=axis)[(slice(None), slice(1, -1)) if axis == 0 else slice(1, -1)] / step
    assert outflow == approx(speed, rel=1e-3)
    total = p[:, 100] @ np.full(x.shape[0], step)  # along x at y = 0, the tails being thin
    assert total == approx(strength * np.pi / 2.0 * np.sqrt(2.0 * radius_x * GAP) / GAP**2, rel=1e-2)


def test_under_a_constant_load_the_gap_falls_as_integrated():
    radius, load = 0.01, 0.02

    def approach(_, gap):
        return [-load / squeeze_point(1.0, gap[0], radius, 2.0 * radius, ETA)]

    end = solve_ivp(approach, (0.0, 3e-2), [1e-6], rtol=1e-10, atol=0.0).y[0, -1]
    assert squeezed_point(3e-2, 1e-6, load, radius, 2.0 * radius, ETA) == approx(end, rel=1e-7)
    ball = 6.0 * np.pi * ETA * radius**2
    assert squeezed_point(3e-2, 1e-6, load, radius, radius, ETA) == approx(1e-6 * np.exp(-load * 3e-2 / ball))

    def fall(_, gap):
        return [-100.0 / squeeze_line(1.0, gap[0], radius, ETA)]

    end = solve_ivp(fall, (0.0, 2e-3), [1e-6], rtol=1e-10, atol=0.0).y[0, -1]
    assert squeezed_line(2e-3, 1e-6, 100.0, radius, ETA) == approx(end, rel=1e-7)
    assert end < 0.9e-6
