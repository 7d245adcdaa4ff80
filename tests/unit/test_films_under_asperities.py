"""Films of oil under asperities below the grid: every algorithm, against closed forms, dense algebra and the others."""

from dataclasses import replace

import numpy as np
import pytest
from comparison import approx
from independent import love_matrix
from line_contact import line, roughness
from scipy.integrate import quad
from sliders import ParabolicSlider
from wavy_contact import axis, problem

from benchmarks.film.cases import RoughCase, grid_of, instant_of_call
from contact_core.film.instant import Settings
from contact_core.film.routes import solve_film
from contact_core.film.scaled import Scaled
from contact_core.film.starts import shared_start
from contact_core.kernels.half_space import PeriodicHalfSpace
from contact_core.kernels.mixed.fixed_point import solve_mixed
from contact_core.kernels.mixed.marched import solve_marched
from contact_core.kernels.mixed.newton import solve_newton
from contact_core.kernels.mixed.problem import Iterate
from contact_core.laws.asperity_layer import AsperityLayer

METHODS = {"hybrid": (solve_mixed, 600), "newton": (solve_newton, 60)}


def start(case, smooth, lift=0.15):
    pressure = smooth * (case.load / smooth.sum())
    return Iterate(pressure, pressure, np.zeros(smooth.shape, np.bool_), lift - 1.0)


def layer(h, case):
    """Pressure of asperities at gaps, in plain numpy."""
    return case.stress * np.exp(-np.maximum(h - case.floor, 0.0) / case.depth) * (h < case.floor + 14.0 * case.depth)


def outputs(found, rows=np.s_[:]):
    """Load share of the asperities, least gap and largest pressure of a solution that has converged."""
    assert found.converged, found.shortfall
    p, f, h = found.iterate.pressure[rows], found.iterate.fluid[rows], found.gap[rows]
    return np.array([(p - f).sum() / p.sum(), h.min(), p.max()])


def wavy(mobility=300.0, wave=0.02, **changes):
    case, smooth, half_space = problem(49, 49, wave, mobility=mobility)
    return replace(case, fitted=True, stress=2.0, depth=0.005, **changes), smooth, half_space


@pytest.mark.long
def test_every_algorithm_finds_the_same_film_over_waves():
    case, smooth, half_space = wavy()
    found = [outputs(solve(half_space, case, start(case, smooth), 5e-4, 2 * n)) for solve, n in METHODS.values()]
    assert 0.02 < found[0][0] < 0.05
    for other in found[1:]:
        assert other == approx(found[0], rel=0.01)


@pytest.mark.parametrize("method", ["hybrid", "newton"])
def test_oil_and_asperities_share_the_pressure_by_the_law_at_every_node(method):
    case, smooth, half_space = wavy(3e3 if method == "newton" else 300.0)
    solve, most = METHODS[method]
    found = solve(half_space, case, start(case, smooth), 2e-3, most)
    share = outputs(found)[0]
    it = found.iterate
    off = np.abs(it.pressure - it.fluid - layer(found.gap, case))[1:-1, 1:-1]
    assert share > (0.5 if method == "newton" else 0.02)
    assert off.mean() < 1e-3
    assert (it.fluid >= 0.0).all()


@pytest.mark.parametrize(("mobility", "stress", "depth"), [(300.0, 2.0, 0.005), (3e3, 2.0, 0.005), (300.0, 1.0, 0.02)])
def test_cavities_hold_their_oil_under_asperities(mobility, stress, depth):
    """At the edge of a cavity asperities still touch: the sign of p - s(h) there must not decide what a node is."""
    case, smooth, half_space = wavy(mobility, wave=0.0, conserving=True)
    case = replace(case, stress=stress, depth=depth)
    hybrid, newton = (METHODS[name][0](half_space, case, start(case, smooth), 2e-3, 150) for name in METHODS)
    assert outputs(hybrid) == approx(outputs(newton), rel=0.02)


def test_an_inlet_meniscus_leaves_more_to_asperities_and_the_law_holds_at_every_node():
    case, smooth, half_space = wavy(first=3)
    found = solve_mixed(half_space, case, start(case, smooth), 2e-3, 400)
    share = outputs(found)[0]
    assert 0.033 < share < 0.04  # flooded: 0.027
    off = np.abs(found.iterate.pressure - found.iterate.fluid - layer(found.gap, case))[1:-1, 3:-1]
    assert off.mean() < 2e-3
    assert found.iterate.fluid[:, :3].max() < 1e-3


LINES = [  # load, oil, rows, rms, stress, depth
    (20.0, 10.0, 1, 0.0, 1.0, 0.3),
    pytest.param(200.0, 10.0, 8, 2.0, 1.0, 0.5, marks=pytest.mark.long),
]


@pytest.mark.parametrize(("load", "oil", "rows", "rms", "stress", "depth"), LINES)
def test_every_algorithm_finds_the_same_film_of_a_line_steady_and_in_a_time_step(load, oil, rows, rms, stress, depth):
    case = line(load, oil, 129, rms * roughness(rows, 129) if rms else None, floor=0.05)
    steady = replace(case.problem, stress=stress, depth=depth * case.film, fitted=True)
    begin, before = case.dry_start(), None
    for per_dt, old in ((0.0, steady.mass_old), (8.0, None)):
        old = 0.9 * before.mass if old is None else old
        now = replace(steady, per_dt=per_dt, mass_old=old)
        found = {name: solve(case.half_space, now, begin, 1e-4, 3 * n) for name, (solve, n) in METHODS.items()}
        each = {name: outputs(one, np.s_[1:-1]) for name, one in found.items()}
        assert 0.03 < each["newton"][0] < 0.5
        assert each["hybrid"] == approx(each["newton"], rel=0.01)
        before = found["newton"]
        begin = before.iterate


@pytest.mark.parametrize("depth", [0.4, 0.8])
def test_under_a_rigid_roller_asperities_add_their_load_to_that_of_the_closed_form(depth):
    """The gap is a parabola; oil of constant viscosity carries what `ParabolicSlider` says at that gap."""
    case = line(1.0, 1e-3, 513)
    q, gap, mobility = case.problem, 0.3, 2.0
    thin = ParabolicSlider(gap, 1.0, 1.0 / (12.0 * mobility), 1.0, inlet=float(case.x[0]))
    ones = np.ones_like(q.fluidity)
    now = replace(q, stress=0.5, depth=depth * gap, fitted=True, fluidity=ones, density=ones)
    now = replace(now, mobility=np.full_like(q.mobility, mobility))
    alone = quad(lambda x: float(layer(np.float64(gap + 0.5 * x * x), now)), -2.5, 1.5, points=[0.0], limit=200)[0]
    dx = now.spacing
    now = replace(now, load=(thin.load + alone) / dx, compliance=1e-6 * q.compliance)
    rigid = PeriodicHalfSpace(1, 513, 1e-6 * dx, "scipy", reference=512.0)
    pressure = np.tile(np.exp(-4.0 * case.x**2), (3, 1))
    begin = Iterate(now.load * pressure / pressure[1].sum(), pressure, np.zeros_like(pressure, np.bool_), 1.1 * gap)
    found = solve_newton(rigid, now, begin, 1e-5, 60)
    share, least, _ = outputs(found, np.s_[1:-1])
    assert share == approx(alone / (thin.load + alone), rel=3e-3)
    assert 0.05 < share < 0.95
    assert least == approx(gap, rel=2e-3)
    assert found.iterate.fluid[1] == approx(thin.pressure(case.x), rel=0.01, abs=5e-3 * found.iterate.fluid.max())


def dense_contact(case, undeformed, dx):
    """Pressure p = s(h) of a dry contact by Newton's method with the dense half space, and the gap [n, n]."""
    n = undeformed.shape[0]
    by_p = 2.0 / np.pi**2 * dx * love_matrix(n, n)
    p, rigid = np.full(n * n, case.load / n**2), 0.0
    for _ in range(200):
        h = rigid + undeformed.ravel() + by_p @ p
        whole = np.ones((n * n, 1))
        system = np.block([[by_p + np.diag(case.depth / p), whole], [whole.T, np.zeros((1, 1))]])
        rest = case.floor + case.depth * np.log(case.stress / p)
        step = np.linalg.solve(system, np.append(rest - h, case.load - p.sum()))
        p = np.maximum(p + step[:-1], 0.2 * p)
        rigid += float(step[-1])
        if np.abs(step[:-1]).sum() < 1e-9 * case.load:
            break
    return p.reshape(n, n), (rigid + undeformed.ravel() + by_p @ p).reshape(n, n)


@pytest.mark.parametrize("method", METHODS)
def test_without_speed_asperities_carry_all_and_the_film_is_the_dry_contact(method):
    """At a speed of a millionth the oil that flows out takes its pressure with it."""
    case, smooth, half_space = problem(25, 25, 0.01, mobility=3e8)
    case = replace(case, fitted=True, stress=5.0, depth=0.02)
    dry, gap = dense_contact(case, case.undeformed, axis(25)[1] - axis(25)[0])
    solve, most = METHODS[method]
    begin = Iterate(start(case, smooth).pressure, 0.0 * dry, smooth > 0.0, -0.9)
    found = solve(half_space, case, begin, 1e-6, 2 * most)
    share = outputs(found)[0]
    assert share == approx(1.0, abs=2e-3)
    inside = smooth > 0.1
    assert np.abs(found.iterate.pressure - dry).sum() < 5e-3 * dry.sum()
    assert found.gap[inside] == approx(gap[inside], abs=0.05 * case.depth)


def rough(ratio, rms, nodes=65):
    """A steady, rough contact: film of smooth bodies over rms roughness, rms of the waves below the grid [m]."""
    case = RoughCase(53.70, 9.525e-3, 0.004, 14.94e-9, 131.5e-9, 20e-6, ratio)
    grid, now = grid_of(case.domain, nodes), instant_of_call(case.arguments(), case.heights(nodes), case.hardness)
    return replace(now, microroughness=AsperityLayer(rms, 4e-6)), grid


def test_a_steady_film_that_stays_short_of_its_balance_closes_at_the_end_of_a_march():
    now, grid = rough(0.05, 10e-9)
    settings = Settings(1e-9, 3e-3, 2000, "scipy", fitted=True)
    scaled = Scaled(now, grid, settings)
    case, begin = scaled.problem(), shared_start(scaled)
    alone = solve_mixed(scaled.half_space, case, begin, settings.tolerance, 300)
    assert "mass imbalance" in alone.shortfall
    closed = solve_marched(scaled.half_space, case, begin, settings.tolerance, 2000)
    share = outputs(closed)[0]
    assert closed.iterations > 300 or closed.imbalance < alone.imbalance
    it = alone.iterate
    assert share == approx((it.pressure - it.fluid).sum() / it.pressure.sum(), abs=0.05)


def test_multigrid_ignores_asperities_out_of_reach_and_declines_others():
    now, grid = rough(4.0, 10e-9)
    now, settings = replace(now, heights=np.zeros_like(now.heights)), Settings(1e-9, 3e-3, 2000, "scipy", fitted=True)
    bare, far, near = (
        solve_film(replace(now, microroughness=layer), grid, settings)
        for layer in (None, AsperityLayer(2.5e-9, 4e-6), AsperityLayer(140e-9, 4e-6))
    )
    assert bare.algorithm == far.algorithm == "smooth: multigrid from none"
    assert (far.state.pressure == bare.state.pressure).all()
    assert "multigrid" not in near.algorithm
    assert near.converged, near.shortfall
