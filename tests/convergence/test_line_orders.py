"""Smooth line contacts by Newton's method on one row: order, the formula, every grid and load."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from comparison import approx
from line_contact import line

from contact_core.kernels.mixed.newton import solve_newton
from contact_core.kernels.mixed.problem import Iterate


def solve(load, oil, nx, coarse=None):
    """A smooth film, from that on a coarser grid if there is one: the case, and what was found."""
    wide = {"left": 5.0, "right": 3.0} if load < 30.0 else {"left": 2.5, "right": 1.5}
    case = line(load, oil, nx, **wide)
    start = case.start
    if coarse is not None:
        old, found = coarse
        p = np.tile(np.interp(case.x, old.x, found.iterate.pressure[1]), (3, 1))
        start = Iterate(p, p.copy(), np.zeros(p.shape, np.bool_), found.iterate.rigid)
    return case, solve_newton(case.half_space, case.problem, start, 1e-6, 30)


# (200, 1e-4) is left out: beside so long a deformation the film of so thin an oil is lost to Newton's method
@pytest.mark.parametrize(
    ("load", "oil"), [(m, oil) for m in (10.0, 50.0, 200.0) for oil in (1e-4, 5.0, 10.0, 15.0) if m * oil != 0.02]
)
def test_films_of_smooth_lines_converge_to_second_order_and_to_the_formula(load, oil):
    found, central = None, []
    for nx in (257, 513, 1025, 2049):
        found = solve(load, oil, nx, found)
        case, film = found
        assert film.converged, film.shortfall
        assert film.iterations <= 20
        assert film.pressure_change < 1e-6
        assert abs(film.load_error) < 1e-6
        assert film.imbalance < 5e-6
        assert np.abs(film.gap[1] - film.gap[0]).max() == 0.0
        central.append(film.gap[1, np.abs(case.x).argmin()] / case.film)
    orders = [np.log2((b - a) / (c - b)) for (a, b), c in zip(pairwise(central), central[2:], strict=False)]
    limit = central[-1] + (central[-1] - central[-2]) / 3.0
    print(f"M = {load:g}, L = {oil:g}: film / formula {limit:.4f}, orders {np.round(orders, 2).tolist()}")
    assert orders[-1] > 1.9
    assert limit == approx(1.0, abs=0.09)


@pytest.mark.parametrize("nx", [129, 257, 513, 1025])  # finer grids begin from coarser ones, as in the test before
@pytest.mark.parametrize(("load", "oil"), [(10.0, 1e-3), (10.0, 5.0), (50.0, 10.0), (100.0, 15.0)])
def test_a_smooth_line_is_solved_from_a_hertz_like_film(load, oil, nx):
    _, film = solve(load, oil, nx)
    assert film.converged, film.shortfall
    assert film.pressure_change < 1e-6
    assert abs(film.load_error) < 1e-6
    assert film.imbalance < 5e-6


@pytest.mark.parametrize("oil", [5.0, 15.0])
def test_a_heavy_load_is_solved_where_the_grid_resolves_its_inlet(oil):
    first = solve(1000.0, oil, 1025)
    case, film = solve(1000.0, oil, 2049, first)
    assert first[1].converged
    assert film.converged
    central = [f.gap[1, np.abs(c.x).argmin()] / c.film for c, f in (first, (case, film))]
    assert central[1] + (central[1] - central[0]) / 3.0 == approx(1.0, abs=0.09)


def test_heavy_loads_under_thick_oil_press_like_hertz():
    case, film = solve(1000.0, 10.0, 1025)
    p, hertz = film.iterate.pressure[1], np.sqrt(np.maximum(1.0 - case.x**2, 0.0))
    assert film.converged
    assert np.abs(p - hertz).sum() * case.problem.spacing < 0.02


def test_the_datum_of_the_deformation_moves_the_rigid_gap_alone():
    case = line(50.0, 8.0, 257)
    other = type(case.half_space)(1, 257, case.half_space.scale, "scipy", 3.0 * case.half_space.reference)
    down = case.half_space.scale * 2.0 * np.log(3.0) * case.problem.load
    one = solve_newton(case.half_space, case.problem, case.start, 1e-8, 30)
    start = replace(case.start, rigid=case.start.rigid - down)
    two = solve_newton(other, case.problem, start, 1e-8, 30)
    assert one.converged
    assert two.gap == approx(one.gap, abs=1e-8)
    assert two.iterate.rigid == approx(one.iterate.rigid - down, abs=1e-8)
