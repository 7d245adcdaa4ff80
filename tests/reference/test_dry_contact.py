"""Dry contact: Hertz, the conditions of contact, and an independent solver on a dense matrix."""

import numpy as np
import pytest
from comparison import HARD, approx
from independent import deformation, gap, love_matrix
from scipy.ndimage import gaussian_filter
from scipy.optimize import brentq, lsq_linear

from contact_core import ConvergenceError, OperatingPoint, Scene, initial_state, solve
from contact_core.calls.dry_contact import dry_contact
from contact_core.kernels.dry import dry_solution, solve_dry
from contact_core.kernels.half_space import HalfSpace
from contact_core.reference import hertz_point

SMOOTH = HARD | {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm", "film.domain": "0.45 mm"}
ROUGH = HARD | {
    "film.points": "33",
    "surface_1.correlation_length": "16 um",
    "surface_2.correlation_length": "32 um",
}


def dry(**changes):
    scene = Scene.from_toml("azam_case_a", {key.replace("__", "."): str(value) for key, value in changes.items()})
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
    assert fine == approx(np.zeros(4), abs=0.02)


@pytest.mark.parametrize(("radius_y", "domain"), [("5 mm", "0.6 mm"), ("20 mm", "0.6 mm"), ("50 mm", "1.2 mm")])
def test_ellipses_long_across_and_along(radius_y, domain):
    changes = SMOOTH | {"film.points": "65", "geometry.radius_y": radius_y, "film.domain": domain}
    scene, fields = dry(**changes)
    hertz, cell = scene.hertz(scene.operation.load), scene.film.spacing**2
    assert fields.pressure.sum() * cell == approx(scene.operation.load, rel=1e-12)
    assert fields.pressure.max() == approx(hertz.pressure_max, rel=5e-3)
    assert -fields.film.rigid_gap == approx(hertz.approach, rel=5e-3)
    touched = fields.pressure > 0.0
    assert np.ptp(fields.x[touched.any(axis=0)]) == approx(2.0 * hertz.a, abs=2.1 * scene.film.spacing)
    assert np.ptp(fields.y[touched.any(axis=1)]) == approx(2.0 * hertz.b, abs=2.1 * scene.film.spacing)


def test_rough_bodies_touch_where_they_press_and_press_where_they_touch():
    scene, fields = dry(**{key.replace(".", "__"): value for key, value in ROUGH.items()})
    pressed, h = fields.pressure > 0.0, gap(scene, fields)
    floor = scene.film.floor
    inside = np.hypot(fields.x[None, :], fields.y[:, None]) < 0.8 * scene.hertz(scene.operation.load).a
    assert 0 < pressed[inside].sum() < inside.sum()
    assert fields.pressure.min() == 0.0
    assert fields.pressure.sum() * scene.film.spacing**2 == approx(scene.operation.load, rel=1e-12)
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
    assert fields.pressure.max() == approx(limit, rel=1e-12)
    assert yielding.sum() > 5
    assert fields.pressure.sum() * scene.film.spacing**2 == approx(scene.operation.load, rel=1e-12)
    below = (fields.pressure > 0.0) & ~yielding
    assert np.average(np.abs(h - floor)[below], weights=fields.pressure[below]) < 0.1 * floor
    assert h[yielding].max() < 1.1 * floor
    assert fields.overlap[yielding] == approx(np.maximum(floor - h, 0.0)[yielding], abs=1e-6 * floor)
    assert not fields.overlap[~yielding].any()


@pytest.mark.parametrize(
    ("ny", "nx", "cap", "share"),
    [
        (15, 19, np.inf, 1.0),
        pytest.param(16, 21, 0.9, 1.0, marks=pytest.mark.long),
        pytest.param(17, 17, 0.9, 0.05, marks=pytest.mark.long),
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
    assert -rigid == approx(approach, abs=1e-6)
    assert p.sum() == approx(load, rel=1e-12)


@pytest.mark.parametrize("microroughness", [True, False])
@pytest.mark.parametrize("points", [33, 34])
@pytest.mark.parametrize("load", [1e-6, 1e-3, 1.0])
def test_a_contact_smaller_than_a_node_still_carries_its_load(points, load, microroughness):
    changes = {name: value for name, value in ROUGH.items() if not (microroughness and name in HARD)}
    scene = Scene.from_toml("azam_case_a", changes | {"film.points": str(points)})
    fields = solve(scene, OperatingPoint(load, 0.0, 0.0, 363.15), initial_state(scene))
    assert np.isfinite(fields.pressure).all()
    assert fields.pressure.sum() * scene.film.spacing**2 == approx(load, rel=1e-9)
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
    assert fields.pressure.sum() * scene.film.spacing**2 == approx(load, rel=1e-9)
    assert np.isfinite(fields.gap).all()


def polonsky_keer(gap, load, spacing, reduced_modulus, tolerance=1e-12):
    """Wear 231 (1999) 206, on the independent deformation of these tests; pressure [Pa] under a load [N]."""
    total = load / spacing**2
    p, t, old, keep = np.where(gap < np.median(gap), 1.0, 0.0), np.zeros(gap.shape), 1.0, 0.0
    p *= total / p.sum()
    for _ in range(3000):
        g = gap + deformation(p, spacing, reduced_modulus)
        touch = p > 0.0
        g -= g[touch].mean()
        norm = (g[touch] ** 2).sum()
        t = np.where(touch, g + keep * norm / old * t, 0.0)
        r = deformation(t, spacing, reduced_modulus)
        r -= r[touch].mean()
        step = (g * t)[touch].sum() / (r * t)[touch].sum()
        before, old = p, norm
        p = np.maximum(p - step * t, 0.0)
        entering = (p == 0.0) & (g < 0.0)
        p[entering] = -step * g[entering]
        keep = 0.0 if entering.any() else 1.0
        p *= total / p.sum()
        if np.abs(p - before).sum() < tolerance * total:
            return p
    raise AssertionError("the solver of the test did not converge")


RADIUS, MODULUS, LOAD = 10e-3, 230.47e9, 77.85
BALL = hertz_point(LOAD, RADIUS, RADIUS, MODULUS)


def rough_ball(ny, nx, rq=1e-7, width=3.0):
    """Heights [m] with a correlation length of a few nodes, spacing [m], squared radius [m2]."""
    white = np.random.Generator(np.random.Philox(1000 * ny + nx)).normal(size=(ny, nx))
    z = gaussian_filter(white, 2.0, mode="wrap")
    spacing = width * BALL.a / (max(ny, nx) - 1)
    x, y = (spacing * (np.arange(n) - 0.5 * (n - 1)) for n in (nx, ny))
    return rq * z / z.std(), spacing, x[None, :] ** 2 + y[:, None] ** 2


@pytest.mark.parametrize(("ny", "nx"), [*(pytest.param(n, n, marks=pytest.mark.long) for n in (64, 65)), (48, 70)])
def test_rough_contacts_are_those_of_polonsky_and_keer(ny, nx):
    heights, spacing, radius_2 = rough_ball(ny, nx)
    found = dry_contact(heights, spacing, RADIUS, LOAD, MODULUS)
    expected = polonsky_keer(radius_2 / (2.0 * RADIUS) - heights, LOAD, spacing, MODULUS)
    assert found.converged
    assert found.pressure_max == approx(expected.max(), rel=1e-6)
    assert ((found.pressure > 0.0) != (expected > 0.0)).sum() <= 1
    assert np.abs(found.pressure - expected).sum() < 2e-8 * expected.sum()
    settled = deformation(found.pressure, spacing, MODULUS)
    h = radius_2 / (2.0 * RADIUS) - heights + settled - found.approach
    assert h == approx(found.gap, abs=1e-6 * heights.std())


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-6, 1e-8, 1e-11])
@pytest.mark.parametrize("hardness", [None, 2e9])
def test_the_tolerance_is_the_error_of_the_pressure(tolerance, hardness):
    heights, spacing, _ = rough_ball(90, 81)
    exact = dry_contact(heights, spacing, RADIUS, LOAD, MODULUS, hardness, 1e-12)
    found = dry_contact(heights, spacing, RADIUS, LOAD, MODULUS, hardness, tolerance)
    error = np.abs(found.pressure - exact.pressure).sum() / exact.pressure.sum()
    assert found.converged
    assert exact.converged
    assert found.error < tolerance
    assert error < 1.5 * tolerance


def test_the_call_meets_hertz_closer_on_every_finer_grid():
    errors = []
    for n in (33, 66, 131, 260):
        spacing = 3.0 * BALL.a / (n - 1)
        found = dry_contact(np.zeros((n, n)), spacing, RADIUS, LOAD, MODULUS)
        x = spacing * (np.arange(n) - 0.5 * (n - 1))
        exact = BALL.pressure_max * np.sqrt(np.maximum(1.0 - (x[None, :] ** 2 + x[:, None] ** 2) / BALL.a**2, 0.0))
        errors.append(np.abs(found.pressure - exact).sum() / exact.sum())
    coarse, middle, fine, finest = errors
    assert finest < 0.6 * fine < 0.36 * middle < 0.22 * coarse
    assert found.pressure_max == approx(BALL.pressure_max, rel=1e-4)
    assert found.approach == approx(BALL.approach, rel=1e-4)
    assert found.contact_area_ratio == approx(1.0, abs=0.01)


@pytest.mark.parametrize(("ny", "nx"), [(129, 129), (96, 130)])
@pytest.mark.parametrize("hardness", [0.3e9, 1e9, 1.7e9])
def test_a_call_with_a_hardness_keeps_to_it_and_to_the_load(ny, nx, hardness):
    heights, spacing, radius_2 = rough_ball(ny, nx, width=5.0)
    found = dry_contact(heights, spacing, RADIUS, LOAD, MODULUS, hardness)
    h = radius_2 / (2.0 * RADIUS) - heights + deformation(found.pressure, spacing, MODULUS) - found.approach
    small = 1e-6 * heights.std()
    yielding = found.pressure > hardness * (1.0 - 1e-12)
    assert found.converged
    assert found.pressure.min() == 0.0
    assert found.pressure.max() <= hardness * (1.0 + 1e-12)
    assert yielding.sum() > 5
    assert found.pressure.sum() * spacing**2 == approx(LOAD, rel=1e-12)
    assert np.abs(h[(found.pressure > 0.0) & ~yielding]).max(initial=0.0) < small
    assert h[yielding].max() < small
    assert h[found.pressure == 0.0].min() > -small
    assert found.overlap == approx(np.where(yielding, np.maximum(-h, 0.0), 0.0), abs=small)


def test_a_spot_far_from_the_contact_is_found():
    heights, spacing, radius_2 = rough_ball(97, 97, width=6.0)
    heights[3, 92] += radius_2[3, 92] / (2.0 * RADIUS)
    found = dry_contact(heights, spacing, RADIUS, LOAD, MODULUS)
    assert found.pressure[3, 92] > 0.0
    assert found.converged
    expected = polonsky_keer(radius_2 / (2.0 * RADIUS) - heights, LOAD, spacing, MODULUS, 1e-10)
    assert np.abs(found.pressure - expected).sum() < 1e-7 * expected.sum()


def hard_problem(seed):
    """A contact that is awkward in some way: (gap, cap, load), with Love's kernel times 2/pi^2 spacing."""
    random = np.random.Generator(np.random.Philox(seed))
    kind = ("smooth", "white", "along", "across", "punch", "flat", "steps", "wave", "spike", "rough")[seed % 10]
    ny, nx = random.integers(9, 90, 2)
    half = random.uniform(1.1, 3.0)
    x = np.linspace(-half, half, nx)[None, :]
    spacing = 2.0 * half / (nx - 1)
    y = (spacing * (np.arange(ny) - 0.5 * (ny - 1)))[:, None]
    gap = 0.0 * x * y if kind == "flat" else 0.5 * (x**2 + y**2)
    width = {"smooth": 3.0, "along": (0.3, 12.0), "across": (15.0, 0.5), "rough": 1.0}.get(kind, 0.0)
    z = gaussian_filter(random.normal(size=(ny, nx)), width)
    rq = 10.0 ** random.uniform(-3.0, 1.0)
    z *= rq / z.std()
    if kind == "punch":
        gap, z = np.where(x**2 + y**2 < (0.6 * half) ** 2, 0.0, 1.0), 1e-3 * z
    elif kind == "steps":
        z = rq * np.round(z / rq)
    elif kind == "wave":
        z = rq * np.cos(7.0 * x) * np.cos(9.0 * y)
    elif kind == "spike":
        z = np.zeros((ny, nx))
        z[random.integers(ny), random.integers(nx)] = 5.0 * rq
    load = 2.0 * np.pi / 3.0 / spacing**2 * 10.0 ** random.uniform(-7.0, 0.3)
    cap = (
        np.full((ny, nx), np.inf),
        np.full((ny, nx), 10.0 ** random.uniform(-1.0, 1.0)),
        random.uniform(0.3, 1.5, (ny, nx)) * random.choice([1.0, 1.0, 1.0, 0.01, 1e5, 0.0], size=(ny, nx)),
        np.full((ny, nx), load / (ny * nx) * random.uniform(1.0001, 1.3)),  # all but exhausted
    )[seed % 4]
    return gap - z, cap * max(1.0, 1.0001 * load / cap.sum()), load, 2.0 / np.pi**2 * spacing


def test_hard_contacts_are_solved_or_said_not_to_be():
    """What must hold at each solution, by the independent deformation; misses have to be rare."""
    missed = 0
    for seed in range(50):
        gap_0, cap, load, scale = hard_problem(seed)
        half_space = HalfSpace(*gap_0.shape, scale, "scipy")
        found = dry_solution(half_space, gap_0, cap, load, np.ones(gap_0.shape), 1e-8, 500)
        p, h = found.pressure, gap_0 + deformation(found.pressure, scale * np.pi / 2.0, 1.0) + found.rigid
        free = (p > 0.0) & (p < cap)
        assert (p >= 0.0).all(), seed
        assert (p <= cap).all(), seed
        assert p.sum() == approx(load, rel=1e-11), seed
        lack = np.abs(h[free]).sum() + np.maximum(-h, 0.0)[(p == 0.0) & (cap > 0.0)].sum()
        lack += np.maximum(h, 0.0)[(p >= cap) & (cap > 0.0)].sum()
        solved = lack / half_space.near[0, 0] < 1e-7 * load + 1e-13 * np.abs(gap_0).max() * gap_0.size / scale
        assert solved or not found.converged, seed
        missed += not found.converged
    assert missed <= 1


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(("ny", "nx"), [(64, 64), (65, 65), (48, 70)])
def test_tamaas_finds_the_same_contact(ny, nx):
    tamaas = pytest.importorskip("tamaas", reason="tamaas is not installed (extra: peers)")
    heights, spacing, radius_2 = rough_ball(ny, nx)
    found = dry_contact(heights, spacing, RADIUS, LOAD, MODULUS)
    tamaas.set_log_level(tamaas.LogLevel.error)
    size = [ny * spacing, nx * spacing]
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, size, [ny, nx])
    model.E, model.nu = 0.5 * MODULUS, 0.0
    tamaas.ModelFactory.registerNonPeriodic(model, "free")
    solver = tamaas.PolonskyKeerRey(model, heights - radius_2 / (2.0 * RADIUS), 1e-9)
    solver.setIntegralOperator("free")
    solver.solve(LOAD / (size[0] * size[1]))
    assert found.pressure_max == approx(model.traction.max(), rel=1e-5)
    assert ((found.pressure > 0.0) != (model.traction > 0.0)).sum() <= 1


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(("ny", "nx"), [(64, 64), (65, 65), (48, 70)])
@pytest.mark.parametrize("hardness", [None, 2e9])
def test_contact_mechanics_finds_the_same_contact(ny, nx, hardness):
    reason = "ContactMechanics is not installed (extra: peers)"
    contact_mechanics = pytest.importorskip("ContactMechanics", reason=reason)
    systems = pytest.importorskip("ContactMechanics.Systems", reason=reason)
    topography = pytest.importorskip("SurfaceTopography", reason=reason).Topography
    heights, spacing, radius_2 = rough_ball(ny, nx)
    found = dry_contact(heights, spacing, RADIUS, LOAD, MODULUS, hardness)
    size = (ny * spacing, nx * spacing)
    substrate = contact_mechanics.FreeFFTElasticHalfSpace((ny, nx), 0.5 * MODULUS, size)
    surface = topography(heights - radius_2 / (2.0 * RADIUS), size)
    limit = {} if hardness is None else {"hardness": hardness * spacing**2}
    expected = systems.NonSmoothContactSystem(substrate, surface).minimize_proxy(
        external_force=LOAD, pentol=1e-13, thermotol=1e-9, maxiter=5000, **limit
    )
    pressure = np.asarray(expected.jac)[:ny, :nx] / spacing**2
    assert found.pressure_max == approx(pressure.max(), rel=1e-5)
    assert ((found.pressure > 0.0) != (pressure > 0.0)).sum() <= 1
