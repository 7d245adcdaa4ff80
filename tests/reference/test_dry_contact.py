"""Dry contact: Hertz, the conditions of contact, and an independent solver on a dense matrix."""

import numpy as np
import pytest
from independent import gap, love_matrix
from scipy.optimize import brentq, lsq_linear

from contact_core import ConvergenceError, OperatingPoint, Scene, initial_state, solve
from contact_core.kernels.dry import solve_dry
from contact_core.kernels.half_space import HalfSpace

SMOOTH = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm", "film.domain": "0.45 mm"}
ROUGH = {
    "film.points": "33",
    "surface_1.correlation_length": "16 um",
    "surface_2.correlation_length": "32 um",
}


def dry(**changes):
    scene = Scene.from_toml(
        "azam_case_a", {key.replace("__", "."): str(value) for key, value in changes.items()}
    )
    return scene, solve(scene, scene.operation.point, initial_state(scene), dry=True)


def hertz_errors(points, **changes):
    """Relative errors against Hertz: pressure (mean over the grid), largest pressure, area, approach."""
    scene, fields = dry(
        film__points=points, **{key.replace(".", "__"): value for key, value in SMOOTH.items()}, **changes
    )
    hertz = scene.hertz(scene.operation.load)
    x, y = fields.x[None, :] / hertz.a, fields.y[:, None] / hertz.b
    exact = hertz.pressure_max * np.sqrt(np.maximum(1.0 - x**2 - y**2, 0.0))
    area = (fields.pressure > 0.0).sum() * scene.film.spacing**2
    return (
        np.abs(fields.pressure - exact).sum() / exact.sum(),
        abs(fields.pressure.max() / hertz.pressure_max - 1.0),
        abs(area / hertz.area - 1.0),
        abs(-fields.film.rigid_gap / hertz.approach - 1.0),
    )


def test_hertz_pressure_area_and_approach_are_met_closer_on_every_finer_grid():
    coarse, middle, fine = (np.array(hertz_errors(n)) for n in (33, 65, 129))
    assert fine[0] < 0.5 * middle[0] < 0.25 * coarse[0]
    assert fine[3] < 1.2e-3
    assert fine == pytest.approx(np.zeros(4), abs=0.02)


@pytest.mark.parametrize(
    ("radius_y", "domain"), [("5 mm", "0.6 mm"), ("20 mm", "0.6 mm"), ("50 mm", "1.2 mm")]
)
def test_ellipses_long_across_and_along(radius_y, domain):
    scene, fields = dry(
        film__points=65,
        surface_1__rq="0 nm",
        surface_2__rq="0 nm",
        geometry__radius_y=radius_y,
        film__domain=domain,
    )
    hertz, cell = scene.hertz(scene.operation.load), scene.film.spacing**2
    assert fields.pressure.sum() * cell == pytest.approx(scene.operation.load, rel=1e-12)
    assert fields.pressure.max() == pytest.approx(hertz.pressure_max, rel=5e-3)
    assert -fields.film.rigid_gap == pytest.approx(hertz.approach, rel=5e-3)
    touched = fields.pressure > 0.0
    assert np.ptp(fields.x[touched.any(axis=0)]) == pytest.approx(2.0 * hertz.a, abs=2.1 * scene.film.spacing)
    assert np.ptp(fields.y[touched.any(axis=1)]) == pytest.approx(2.0 * hertz.b, abs=2.1 * scene.film.spacing)


def test_rough_bodies_touch_where_they_press_and_press_where_they_touch():
    scene, fields = dry(**{key.replace(".", "__"): value for key, value in ROUGH.items()})
    pressed, h = fields.pressure > 0.0, gap(scene, fields)
    floor = scene.film.floor
    inside = np.hypot(fields.x[None, :], fields.y[:, None]) < 0.8 * scene.hertz(scene.operation.load).a
    assert 0 < pressed[inside].sum() < inside.sum()
    assert fields.pressure.min() == 0.0
    assert fields.pressure.sum() * scene.film.spacing**2 == pytest.approx(scene.operation.load, rel=1e-12)
    assert np.average(np.abs(h - floor)[pressed], weights=fields.pressure[pressed]) < 0.1 * floor
    assert (h - floor)[~pressed].min() > -0.1 * floor
    assert fields.route == "dry"
    assert fields.converged


@pytest.mark.parametrize("hardness", ["1.3 GPa", "2 GPa"])
def test_the_hardness_bounds_the_pressure_and_the_load_is_met_all_the_same(hardness):
    changes = {key.replace(".", "__"): value for key, value in ROUGH.items()}
    scene, fields = dry(**changes, plasticity__hardness=hardness, plasticity__film_hardness=hardness)
    limit, h, floor = scene.plasticity.hardness, gap(scene, fields), scene.film.floor
    yielding = fields.pressure > limit * (1.0 - 1e-12)
    assert fields.pressure.max() == pytest.approx(limit, rel=1e-12)
    assert yielding.sum() > 5
    assert fields.pressure.sum() * scene.film.spacing**2 == pytest.approx(scene.operation.load, rel=1e-12)
    below = (fields.pressure > 0.0) & ~yielding
    assert np.average(np.abs(h - floor)[below], weights=fields.pressure[below]) < 0.1 * floor
    assert h[yielding].max() < 1.1 * floor
    assert fields.overlap[yielding] == pytest.approx(np.maximum(floor - h, 0.0)[yielding], abs=1e-6 * floor)
    assert not fields.overlap[~yielding].any()


@pytest.mark.parametrize(
    ("ny", "nx", "cap", "share"),
    [
        (17, 17, np.inf, 1.0),
        (15, 19, np.inf, 1.0),
        (17, 17, 1.2, 1.0),
        (16, 21, 0.9, 1.0),
        (17, 17, 0.9, 0.05),
        (17, 17, 0.3, 0.01),
    ],
)
def test_pressures_are_those_of_a_quadratic_programme_on_the_dense_matrix(ny, nx, cap, share):
    """Minimise elastic and potential energy under 0 <= p <= cap; the approach that gives the load by bisection."""
    random = np.random.Generator(np.random.Philox(ny * nx))
    x, y = np.linspace(-1.4, 1.4, nx), np.linspace(-1.4, 1.4, ny)
    rough = 0.06 * random.normal(size=(ny, nx))
    shape = 0.5 * (x[None, :] ** 2 + y[:, None] ** 2) + rough
    scale, load = 2.0 / np.pi**2 * (x[1] - x[0]), share * 2.0 * np.pi / 3.0 / (x[1] - x[0]) ** 2
    upper = np.full((ny, nx), cap if np.isfinite(cap) else 1e6)
    factor = np.linalg.cholesky(scale * love_matrix(ny, nx))

    def pressed(approach):
        right = np.linalg.solve(factor, approach - shape.ravel())
        return lsq_linear(factor.T, right, (0.0, upper.ravel()), method="bvls", tol=1e-14).x

    approach = brentq(lambda d: pressed(d).sum() - load, shape.min(), 2.5, xtol=1e-10)
    expected = pressed(approach).reshape(ny, nx)
    half_space = HalfSpace(ny, nx, scale, "scipy")
    p, rigid, converged, _ = solve_dry(half_space, shape, upper, load, np.ones((ny, nx)), 1e-9, 2000)
    assert converged
    assert np.abs(p - expected).sum() < 1e-5 * load
    assert ((p > 0.0) == (expected > 1e-9)).all()
    assert -rigid == pytest.approx(approach, abs=1e-6)
    assert p.sum() == pytest.approx(load, rel=1e-12)


@pytest.mark.parametrize("points", [33, 34])
@pytest.mark.parametrize("load", [1e-6, 1e-3, 1.0])
def test_a_contact_smaller_than_a_node_still_carries_its_load(points, load):
    scene = Scene.from_toml("azam_case_a", ROUGH | {"film.points": str(points)})
    fields = solve(scene, OperatingPoint(load, 0.0, 0.0, 363.15), initial_state(scene))
    assert np.isfinite(fields.pressure).all()
    assert fields.pressure.sum() * scene.film.spacing**2 == pytest.approx(load, rel=1e-9)
    assert fields.converged


def test_more_load_than_the_grid_can_carry_is_refused_with_a_way_out():
    scene = Scene.from_toml("azam_case_a", ROUGH)
    with pytest.raises(ConvergenceError, match=r"2000 N .*Lower the load or enlarge film\.domain"):
        solve(scene, OperatingPoint(2000.0, 0.0, 0.0, 363.15), initial_state(scene), dry=True)


@pytest.mark.parametrize("load", [400.0, 1000.0, 1400.0])
def test_a_load_that_flattens_the_whole_grid_is_met_within_the_hardness(load):
    scene = Scene.from_toml("azam_case_a", ROUGH)
    fields = solve(scene, OperatingPoint(load, 0.0, 0.0, 363.15), initial_state(scene))
    assert fields.pressure.max() <= scene.plasticity.hardness * (1.0 + 1e-12)
    assert fields.pressure.sum() * scene.film.spacing**2 == pytest.approx(load, rel=1e-9)
    assert np.isfinite(fields.gap).all()
