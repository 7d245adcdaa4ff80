"""contact_core.calls.point_contact of unequal radii: limits, and grids."""

import numpy as np
import pytest
from comparison import approx

from contact_core import OperatingPointError, point_contact
from contact_core.film.fitted import Extent, fitted_grid
from contact_core.kernels.multigrid.cycle import _level_count
from contact_core.reference import hertz_point
from contact_core.shapes import Point

CALL = {
    "load": 20.0,
    "radius_x": 10e-3,
    "reduced_modulus": 230e9,
    "speed_1": 1.0,
    "speed_2": 1.0,
    "viscosity": 0.02,
    "pressure_viscosity": 15e-9,
}


@pytest.mark.parametrize("radius_y", [10e-3 / 31.0, 0.31])
def test_radii_too_far_apart_are_refused_with_the_limit(radius_y):
    with pytest.raises(
        OperatingPointError, match=r"radius_y = .* m is not within 1/30 and 30 times radius_x = 0\.01 m"
    ):
        point_contact(**CALL, radius_y=radius_y)


def test_a_film_too_thick_for_the_smaller_radius_is_refused():
    with pytest.raises(OperatingPointError, match=r"over 0\.01 of radius_y = 0\.001 m"):
        point_contact(**(CALL | {"load": 0.1, "speed_1": 20.0, "speed_2": 20.0}), radius_y=1e-3)


@pytest.mark.parametrize(("radius_x", "radius_y"), [(10e-3, 2e-3), (2e-3, 10e-3)])
@pytest.mark.parametrize(("nodes", "told"), [(33, True), (65, False)])
def test_few_nodes_across_the_shorter_side_of_an_ellipse_are_told(radius_x, radius_y, nodes, told):
    at_rest = CALL | {"radius_x": radius_x, "speed_1": 0.0, "speed_2": 0.0}
    side = 2.0 * hertz_point(20.0, 2e-3, 10e-3, 230e9).b  # half widths of 8 and 2.8 nodes, or twice as many
    found = point_contact(**at_rest, radius_y=radius_y, grid=(nodes, nodes), domain=(-side, side, -side, side))
    assert ("Fewer than 8 nodes lie across the Hertz contact." in found.warnings) is told


@pytest.mark.parametrize("ratio", [0.1, 10.0])
def test_under_a_thick_film_the_grid_of_an_ellipse_ends_where_it_is_as_open_as_that_of_a_ball(ratio):
    film, load = 3e-6, 1e-3  # much thicker than the load presses the bodies together
    ball, ellipse = (Extent.of(Point(10e-3, r * 10e-3), load, 230e9, film) for r in (1.0, ratio))
    assert ellipse.side**2 / ratio == approx(ball.side**2, rel=0.05)
    assert ellipse.left == approx(ball.left, rel=0.05)


@pytest.mark.parametrize("ratio", [1 / 30, 0.1, 0.37, 0.9, 1.3, 3.0, 10.0, 30.0])
@pytest.mark.parametrize("film", [0.0, 3e-8, 3e-6])
def test_grids_of_ellipses_hold_the_film_and_halve_for_multigrid(ratio, film):
    shape = Point(10e-3, ratio * 10e-3)
    extent = Extent.of(shape, 20.0, 230e9, film)
    for ny, nx in (extent.shape(), extent.shape(129), extent.shape(shorter=65)):
        halvings = _level_count(ny, nx, True) - 1
        assert halvings >= 2
        assert min(ny, nx) >> halvings <= 14
        grid = fitted_grid(shape, 20.0, 230e9, film, ny, nx)
        assert np.ptp(grid.y) == approx((ny - 1) * grid.spacing)
        assert np.ptp(grid.x) >= (1.0 - 1e-9) * (extent.left + extent.right)
        assert np.ptp(grid.y) >= (1.0 - 1e-9) * 2.0 * extent.side
        assert np.abs(grid.x).min() < 1e-12 < np.abs(grid.x).max()
        assert grid.y.sum() == approx(0.0, abs=1e-12)
    assert min(extent.shape()) == 129
    assert extent.shape(129)[1] == 129


@pytest.mark.parametrize("ratio", [0.25, 4.0])
def test_one_number_is_the_nodes_along_x(ratio):
    found = point_contact(**CALL, radius_y=ratio * 10e-3, grid=65, tolerance=1e-5)
    ny, nx = found.film.shape
    assert nx == 65
    assert (ny > 100) == (ratio > 1.0)
    assert np.diff(found.x) == approx(np.full(nx - 1, found.y[1] - found.y[0]))
    assert found.converged
    # multigrid is symmetric to the bit, the rows of the hybrid are as far as they are solved: L1 1e-6, points 3e-5
    exact = found.algorithm.startswith("smooth: multigrid")
    assert exact == (ratio > 1.0)
    assert found.film == approx(found.film[::-1], rel=0.0 if exact else 1e-4)
    assert np.abs(found.pressure - found.pressure[::-1]).sum() <= (0.0 if exact else 1e-5) * found.pressure.sum()


def test_one_number_and_a_domain_give_square_cells():
    found = point_contact(**CALL, radius_y=40e-3, grid=33, domain=(-4e-4, 4e-4, -8e-4, 8e-4))
    assert found.film.shape == (65, 33)


@pytest.mark.parametrize("speed", [1e-31, 1e-310, 5e-324])
def test_bodies_that_hardly_move_are_at_rest(speed):
    oil = {"viscosity": 0.01, "pressure_viscosity": 2e-8}
    still, slow = (
        point_contact(load=10.0, radius_x=0.01, reduced_modulus=2e11, speed_1=v, speed_2=v, **oil, grid=17)
        for v in (0.0, speed)
    )
    assert slow.converged
    assert slow.h_c == approx(still.h_c, rel=1e-9)
