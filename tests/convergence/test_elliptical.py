"""Elliptical contacts: dry ones against Hertz, films of second order along and across, continuous with the circle."""

import numpy as np
import pytest
from comparison import approx

from contact_core.calls.dry_contact import dry_contact
from contact_core.calls.point_contact import point_contact
from contact_core.film.fitted import Extent
from contact_core.reference import SmoothContact, hertz_point, nijenbanning_venner_moes
from contact_core.shapes import Point

RADIUS, MODULUS, LOAD = 10e-3, 230e9, 50.0


def of_moes(load, lubricant, ratio):
    """Arguments of a contact of Moes' M and L on radius_x, Barus' oil."""
    alpha, viscosity = 2.2e-8, 0.04
    speed_number = (lubricant / (alpha * MODULUS)) ** 4
    speed = 0.5 * speed_number * MODULUS * RADIUS / viscosity
    return {
        "load": load * speed_number**0.75 * MODULUS * RADIUS**2,
        "radius_x": RADIUS,
        "radius_y": ratio * RADIUS,
        "reduced_modulus": MODULUS,
        "speed_1": speed,
        "speed_2": speed,
        "viscosity": viscosity,
        "pressure_viscosity": alpha,
        "viscosity_law": "barus",
        "density_law": "none",
    }


def formula(given):
    names = ("load", "speed_1", "viscosity", "pressure_viscosity", "radius_x", "radius_y", "reduced_modulus")
    return nijenbanning_venner_moes(SmoothContact(*(given[name] for name in names)))


def films(given, grids, tolerance=1e-4, by="smooth: multigrid", flux="fitted"):
    """Central films on one domain, `grids` nodes along its shorter side, solved `by` that wherever 65 see the inlet."""
    bodies = Point(given["radius_x"], given["radius_y"])
    ny, nx = Extent.of(bodies, given["load"], MODULUS, formula(given)).shape(shorter=grids[0])
    found = []
    for nodes in grids:
        factor = (nodes - 1) // (grids[0] - 1)
        shape = (ny - 1) * factor + 1, (nx - 1) * factor + 1
        answer = point_contact(**given, grid=shape, tolerance=tolerance, flux=flux)
        assert answer.converged
        assert answer.algorithm.startswith(by) or nodes < 65
        found.append(answer.h_central)
    return np.array(found)


@pytest.mark.parametrize(("ratio", "turned"), [(0.1, 10.0), (10.0, 0.1), (0.5, 2.0)])
def test_a_dry_ellipse_converges_to_hertz_and_lies_the_other_way_if_turned(ratio, turned):
    hertz = hertz_point(LOAD, RADIUS, ratio * RADIUS, MODULUS)
    errors = []
    for nodes in (16, 32, 64):  # across the shorter axis
        spacing = 2.3 * min(hertz.a, hertz.b) / nodes
        ny, nx = (round(2.3 * side / spacing) for side in (hertz.b, hertz.a))
        found = dry_contact(np.zeros((ny, nx)), spacing, RADIUS, LOAD, MODULUS, radius_y=ratio * RADIUS)
        assert found.converged
        x, y = (spacing * (np.arange(n) - 0.5 * (n - 1)) for n in (nx, ny))
        exact = hertz.pressure_max * np.sqrt(
            np.maximum(1.0 - (x[None, :] / hertz.a) ** 2 - (y[:, None] / hertz.b) ** 2, 0.0)
        )
        touch = found.pressure > 0.0
        errors.append(
            (
                np.abs(found.pressure - exact).sum() / exact.sum(),
                abs(found.approach / hertz.approach - 1.0),
            )
        )
        assert found.contact_area_ratio == approx(1.0, abs=4.0 / nodes)
        assert found.pressure_max == approx(hertz.pressure_max, rel=0.5 / nodes)
        for axis, side in ((0, hertz.a), (1, hertz.b)):
            assert touch.any(axis=axis).sum() * spacing == approx(2.0 * side, abs=2.1 * spacing)
    errors = np.array(errors)
    assert (np.log2(errors[0] / errors[2]) / 2.0 > (1.0, 1.0)).all()
    assert errors[2] == approx([0.0, 0.0], abs=(8e-3))
    across = dry_contact(np.zeros((nx, ny)), spacing, ratio * RADIUS, LOAD, MODULUS, radius_y=turned * ratio * RADIUS)
    assert across.pressure == approx(found.pressure.T, abs=1e-6 * hertz.pressure_max)


LIMITS = pytest.mark.parametrize(
    ("ratio", "load", "limit"),
    [(0.3518, 100.0, 3.644), (2.843, 100.0, 5.397), (11.83, 200.0, 5.768)],
    ids=["along the long axis", "across the long axis", "far across"],
)
UNIT = RADIUS * np.sqrt((10.0 / (2.2e-8 * MODULUS)) ** 4)


@LIMITS
def test_films_of_the_upwind_flow_converge_to_second_order_on_the_limit_of_finer_grids(ratio, load, limit):
    """Limits in Moes' units: extrapolated from 129 and 257 nodes along the shorter side."""
    found = films(of_moes(load, 10.0, ratio), (33, 65, 129), flux="upwind") / UNIT
    order = np.log2((found[1] - found[0]) / (found[2] - found[1]))
    assert 1.8 < order < 2.2
    assert found[2] + (found[2] - found[1]) / 3.0 == approx(limit, rel=0.01)


@LIMITS
def test_films_of_the_fitted_flow_are_near_that_limit_on_33_nodes_already(ratio, load, limit):
    found = films(of_moes(load, 10.0, ratio), (33, 65)) / UNIT
    assert found == approx(np.full(2, limit), rel=0.03)


@pytest.mark.parametrize(("ratio", "load"), [(2.843, 20.0), (2.843, 500.0)])
def test_films_across_the_long_axis_are_those_of_the_formula(ratio, load):
    given = of_moes(load, 10.0, ratio)
    coarse, fine = films(given, (65, 129))
    assert fine + (fine - coarse) / 3.0 == approx(formula(given), rel=0.05)


def test_slim_contacts_tend_to_a_film_without_leakage_round_the_tip():
    """H of b/a = 0.2 over that of the circle rises toward (p_H / sqrt(a))^(-1/2) with the load, where formulas stay at
    0.3.
    """
    ratio = 0.08456
    slim, circle = (hertz_point(LOAD, RADIUS, k * RADIUS, MODULUS) for k in (ratio, 1.0))
    limit = (slim.pressure_max / circle.pressure_max) ** -0.5 * (slim.a / circle.a) ** 0.25
    loads = (20.0, 100.0, 200.0)
    shares = []
    for load in loads:  # the slim inlets are too short for 65 nodes: the hybrid takes over
        one, other = (films(of_moes(load, 6.0, k), (65,), 1e-3, "smooth")[0] for k in (ratio, 1.0))
        shares.append(one / other)
    assert 0.35 < shares[0] < shares[1] < shares[2] < limit
    assert limit == approx(0.67, abs=0.01)


@pytest.mark.parametrize("load", [1.0, 100.0])
def test_a_nearly_circular_contact_is_nearly_that_of_the_circle(load):
    """Light ones reach beyond the grid; every unit, guess and far field of ellipses goes over into the circle's."""
    circle, ellipse = of_moes(load, 5.0, 1.0), of_moes(load, 5.0, 1.0 + 1e-6)
    first = point_contact(**circle, grid=65, tolerance=1e-5)
    domain = (first.x[0], first.x[-1], first.y[0], first.y[-1])
    second = point_contact(**ellipse, grid=(65, 65), domain=domain, tolerance=1e-5)
    assert second.pressure == approx(first.pressure, abs=1e-4 * first.pressure_max)
    assert second.h_central == approx(first.h_central, rel=1e-4)
    assert second.approach == approx(first.approach, rel=1e-4)
    assert second.load_beyond == approx(first.load_beyond, abs=1e-5)
