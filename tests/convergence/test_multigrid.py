"""Full multigrid for smooth films: against equations written again, closed forms, finer grids and the hybrid."""

from dataclasses import replace

import numpy as np
import pytest
from comparison import approx
from independent import love
from scipy.signal import fftconvolve

from contact_core.kernels.far_field import far_field
from contact_core.kernels.half_space import HalfSpace
from contact_core.kernels.mixed.fixed_point import solve_mixed
from contact_core.kernels.mixed.problem import Problem
from contact_core.kernels.multigrid.coarsest import solve_dense
from contact_core.kernels.multigrid.cycle import extrapolated, is_applicable, is_symmetric, solve_smooth
from contact_core.kernels.multigrid.mirrored import MirroredHalfSpace
from contact_core.reference import moes_film

P0 = 1.0 / 5.1e-9  # Pa, of Roelands' law
WIDE, CLOSE, FILM_SIZED = (-4.5, 1.5, 3.0), (-1.6, 1.3, 1.45), (-4.5, 2.5, 3.5)


class Case:
    """A ball of Moes' M and L on a square grid. domain: left, right and half side in the unit of length.

    That is Hertz's a, or for light loads the size of the film, s a; pressures are in p_H / s^2, gaps in (s a)^2 / R.
    """

    def __init__(self, M, L, points, domain, light=False, far=False, oil="barus", alpha=2.2e-8, eta0=0.04):
        mobility = 1.0 / (np.pi * (128.0 / (3.0 * M**4)) ** (1.0 / 3.0))
        hertz_alpha = L / np.pi * (1.5 * M) ** (1.0 / 3.0)  # alpha p_H
        per_moes = np.sqrt(6.0 * np.pi * mobility)
        film = moes_film(M, max(L, 1e-9)) / per_moes
        s = np.sqrt(1.0 + 1.4 * film) if light else 1.0
        left, right, side = domain
        self.x, self.y = np.linspace(left, right, points), np.linspace(-side, side, points)
        self.film, self.moes = film / s**2, s**2 * per_moes  # gap by which a unit of h is Moes' H
        dx = self.x[1] - self.x[0]
        undeformed = 0.5 * (self.x[None, :] ** 2 + self.y[:, None] ** 2)
        pressure = np.linspace(0.0, 12.0, 16385)
        exponent, density = hertz_alpha / s**2 * pressure, np.ones_like(pressure)
        if oil == "roelands":
            pa, log_range = pressure / s**2 * hertz_alpha / alpha, np.log(eta0) + 9.67
            exponent = log_range * ((1.0 + pa / P0) ** (alpha * P0 / log_range) - 1.0)
            density = (5.9e8 + 1.34 * pa) / (5.9e8 + pa)
        edge, weight = np.zeros_like(undeformed), np.ones_like(undeformed)
        if far:
            edge, weight = far_field(self.x, self.y, self.film)
        self.problem = Problem(
            undeformed=undeformed,
            cap=np.full_like(undeformed, 12.0),
            floor=1e-9,
            spacing=dx,
            load=2.0 * np.pi / 3.0 / dx**2,
            mobility=np.full_like(undeformed, s * mobility),
            thinned=np.zeros_like(undeformed),
            per_dt=0.0,
            wedge=1.0,
            mass_old=np.zeros_like(undeformed),
            fluidity=np.exp(-np.minimum(exponent, 500.0)),
            density=density,
            step=pressure[1],
            compliance=s**-3,
            edge=edge,
            weight=weight,
        )

    def solve(self, tolerance=1e-4, cycles=25, library="pyfftw"):
        return solve_smooth(self.problem, self.x, self.y, library, self.film, tolerance, cycles)

    def films(self, solution):
        """Central and least film in Moes' units."""
        centre = solution.gap[np.abs(self.y).argmin(), np.abs(self.x).argmin()]
        return np.array([centre, solution.gap.min()]) * self.moes


def balance(problem, iterate):
    """Gap, mass and net inflow of mass at every node, the last zero on the edge: numpy only."""
    p, dx = iterate.pressure, problem.spacing
    ny, nx = p.shape
    kernel = love(np.arange(1 - nx, nx)[None, :], np.arange(1 - ny, ny)[:, None])
    settled = (
        problem.compliance * 2.0 / np.pi**2 * dx * fftconvolve(kernel, p)[ny - 1 : 2 * ny - 1, nx - 1 : 2 * nx - 1]
    )
    h = iterate.rigid + problem.undeformed + settled
    table = problem.step * np.arange(problem.density.size)
    mass = np.interp(p, table, problem.density) * h
    ease = problem.mobility * mass * h**2 * np.interp(p, table, problem.fluidity)
    along = 0.5 * (ease[:, 1:] + ease[:, :-1]) * np.diff(p, axis=1) / dx
    across = 0.5 * (ease[1:] + ease[:-1]) * np.diff(p, axis=0) / dx
    inflow = np.zeros_like(p)
    inflow[1:-1, 1:-1] = (np.diff(along, axis=1)[1:-1] + np.diff(across, axis=0)[:, 1:-1]) / dx
    inflow[1:-1, 2:-1] -= (1.5 * mass[:, 2:] - 2.0 * mass[:, 1:-1] + 0.5 * mass[:, :-2])[1:-1, :-1] / dx
    inflow[1:-1, 1] -= (mass[1:-1, 1] - mass[1:-1, 0]) / dx
    return h, mass, inflow


@pytest.mark.parametrize(
    "case",
    [Case(200.0, 10.0, 65, CLOSE, oil="roelands"), Case(2.0, 5.0, 65, FILM_SIZED, light=True, far=True)],
    ids=["elastic", "rigid"],
)
def test_a_film_satisfies_the_equations_written_independently(case):
    solution, _ = case.solve(tolerance=1e-6)
    problem, p = case.problem, solution.iterate.pressure
    assert solution.converged
    h, mass, inflow = balance(problem, solution.iterate)
    assert np.abs(h - solution.gap).max() < 1e-12
    assert np.abs(mass - solution.mass).max() < 1e-6
    assert (problem.weight * p).sum() == approx(problem.load, rel=1e-5)
    wet = p > 0.0
    assert np.abs(inflow[wet]).sum() < 1e-4 * np.abs(np.diff(mass, axis=1)).sum() / problem.spacing
    assert inflow[~wet].max(initial=0.0) <= 1e-12  # no oil comes into the cavity
    assert p[0, 1:-1] == approx((problem.edge[0] * p[1])[1:-1], abs=1e-14)
    imbalance = (np.abs(inflow) * p)[1:-1, 1:-1].sum() / (mass * p)[1:-1, 1:-1].sum()
    assert solution.imbalance == approx(imbalance, rel=1e-3, abs=1e-9)


def test_the_film_converges_to_second_order_on_the_limit_of_finer_grids():
    """Barus, M = 20, L = 10: H_c = 4.804, H_min = 2.961 by Richardson from 129, 257 and 513 nodes."""
    cases = [Case(20.0, 10.0, points, WIDE) for points in (33, 65, 129)]
    found = [case.solve() for case in cases]
    assert all(solution.converged for solution, _ in found)
    films = np.array([case.films(solution) for case, (solution, _) in zip(cases, found, strict=True)])
    orders = np.log2((films[1] - films[0]) / (films[2] - films[1]))
    assert 1.9 < orders[0] < 2.1
    assert 1.7 < orders[1] < 2.4
    limit = films[2] + (films[2] - films[1]) / 3.0
    assert limit == approx([4.804, 2.961], rel=5e-3)


def test_one_cycle_on_the_finest_grid_errs_less_than_a_third_of_what_the_grid_does():
    """And the films of two levels together tell that of an infinitely fine grid: 3.686 and 1.750."""
    case = Case(200.0, 10.0, 129, WIDE, oil="roelands")
    exact = case.films(case.solve(tolerance=1e-6)[0])
    once, levels = case.solve(tolerance=0.0, cycles=1)
    limit = np.array([3.686, 1.750])
    assert once.iterations == 1
    assert (np.abs(case.films(once) - exact) < np.abs(exact - limit) / 3.0).all()
    assert (np.abs(exact / limit - 1.0) > 0.05).all()
    assert np.array(extrapolated(levels)) * case.moes == approx(limit, rel=0.02)


def test_the_rigid_ball_floats_on_kapitzas_film():
    """H_c M^2 = 35.03 where neither bodies nor oil feel the pressure; needs what lies beyond the grid."""
    for load in (0.1, 1.0):
        case = Case(load, 0.0, 65, FILM_SIZED, light=True, far=True)
        solution, levels = case.solve()
        assert solution.converged
        assert extrapolated(levels)[0] * case.moes * load**2 == approx(35.03, rel=0.01)
    without = Case(1.0, 0.0, 65, FILM_SIZED, light=True)
    assert without.films(without.solve()[0])[0] < 20.0


def test_case_a_has_fourteen_nanometres():
    """W = 77.85 N, R = 10 mm, E' = 230.47 GPa, 4 mPa s, 14.94 / GPa, 0.25 m/s: 14.4 nm on ever finer grids."""
    case = Case(3756.92, 3.32329, 257, CLOSE, oil="roelands", alpha=14.94e-9, eta0=0.004)
    solution, levels = case.solve(tolerance=0.0, cycles=1)
    moes_unit = 10e-3 * np.sqrt(2.0 * 0.004 * 0.25 / (230.47e9 * 10e-3))
    assert case.films(solution)[0] * moes_unit < 13.5e-9
    assert extrapolated(levels)[0] * case.moes * moes_unit == approx(14.4e-9, rel=0.05)


def test_multigrid_and_hybrid_agree_on_the_same_grid():
    case = Case(200.0, 10.0, 65, CLOSE, oil="roelands")
    solution, _ = case.solve(tolerance=1e-6)
    problem, ours = case.problem, solution.iterate
    half_space = HalfSpace(65, 65, problem.compliance * 2.0 / np.pi**2 * problem.spacing, "pyfftw")
    start = replace(ours, pressure=0.95 * ours.pressure, fluid=0.95 * ours.pressure)
    hybrid = solve_mixed(half_space, problem, start, 1e-5, 400)
    assert hybrid.converged
    assert not hybrid.iterate.solid.any()
    assert case.films(hybrid)[0] == approx(case.films(solution)[0], rel=1e-3)
    assert np.abs(hybrid.iterate.pressure - ours.pressure).sum() < 3e-3 * ours.pressure.sum()


@pytest.mark.parametrize(
    ("load", "lubricant", "points", "domain", "light"),
    [
        (20.0, 10.0, 65, FILM_SIZED, True),
        (200.0, 15.0, 257, (-2.2, 1.4, 1.7), False),
        (1000.0, 15.0, 257, CLOSE, False),
    ],
)
def test_a_fitted_flow_converges_where_viscosity_rises_from_node_to_node(load, lubricant, points, domain, light):
    case = Case(load, lubricant, points, domain, light=light)
    case.problem = replace(case.problem, fitted=True)
    solution, _ = case.solve(tolerance=3e-4, cycles=15)
    assert solution.converged, solution.shortfall


def test_multigrid_and_hybrid_agree_on_a_fitted_flow():
    case = Case(200.0, 10.0, 65, CLOSE)
    case.problem = problem = replace(case.problem, fitted=True)
    solution, _ = case.solve(tolerance=1e-6, cycles=60)
    assert solution.converged, solution.shortfall
    ours = solution.iterate
    half_space = HalfSpace(65, 65, problem.compliance * 2.0 / np.pi**2 * problem.spacing, "pyfftw")
    start = replace(ours, pressure=0.95 * ours.pressure, fluid=0.95 * ours.pressure)
    hybrid = solve_mixed(half_space, problem, start, 1e-5, 400)
    assert hybrid.converged, hybrid.shortfall
    assert case.films(hybrid) == approx(case.films(solution), rel=1e-3)
    assert np.abs(hybrid.iterate.pressure - ours.pressure).sum() < 3e-3 * ours.pressure.sum()


def test_smooth_films_of_any_light_or_moderate_load_converge():
    rng = np.random.Generator(np.random.Philox(7))
    for _ in range(20):
        load, oil = np.exp(rng.uniform(np.log(0.01), np.log(50.0))), rng.uniform(0.5, 20.0)
        case = Case(load, oil, 65, FILM_SIZED, light=True, far=load < 10.0, oil=rng.choice(["barus", "roelands"]))
        solution, _ = case.solve(tolerance=1e-4, cycles=15)
        problem = case.problem
        assert solution.converged, (load, oil, solution.shortfall)
        assert (problem.weight * solution.iterate.pressure).sum() == approx(problem.load, rel=1e-3)
        _, mass, inflow = balance(problem, solution.iterate)
        p = solution.iterate.pressure
        assert (np.abs(inflow) * p)[1:-1, 1:-1].sum() < 1e-3 * (mass * p).sum()


@pytest.mark.parametrize("load", [3e3, 5e4])
@pytest.mark.parametrize("oil", ["barus", "roelands"])
def test_a_film_too_thin_for_the_grid_is_not_called_converged(load, oil):
    for points, lubricant in ((65, 2.0), (65, 15.0)):
        case = Case(load, lubricant, points, (-2.0, 2.0, 2.0), oil=oil)
        solution, levels = case.solve(tolerance=1e-3, cycles=15)
        assert not solution.converged
        assert solution.shortfall
        for field in (solution.iterate.pressure, solution.gap, solution.mass):
            assert np.isfinite(field).all()
        assert all(np.isfinite([level.central, level.least, level.change]).all() for level in levels)


def test_half_of_a_symmetric_contact_gives_what_the_whole_does():
    case = Case(100.0, 10.0, 65, CLOSE)
    half, _ = case.solve(tolerance=1e-6)
    tilted = case.problem.undeformed.copy()
    tilted[0] += 1e-7  # too little to be felt, enough to be no mirror image
    case.problem = replace(case.problem, undeformed=tilted)
    assert not is_symmetric(case.problem)
    whole, _ = case.solve(tolerance=1e-6)
    assert half.converged
    assert whole.converged
    assert np.abs(half.iterate.pressure - whole.iterate.pressure).max() < 1e-4
    assert half.gap == approx(whole.gap, abs=1e-6)


def test_the_libraries_of_transforms_give_the_same_film():
    case = Case(100.0, 10.0, 33, CLOSE)
    ours, theirs = (case.solve(tolerance=1e-6, library=name)[0] for name in ("pyfftw", "scipy"))
    assert ours.converged
    assert np.abs(ours.iterate.pressure - theirs.iterate.pressure).max() < 1e-8


def test_a_repeated_solution_has_the_same_bits():
    case = Case(100.0, 10.0, 33, CLOSE)
    first, second = (case.solve()[0] for _ in range(2))
    assert (first.iterate.pressure == second.iterate.pressure).all()
    assert (first.gap == second.gap).all()


@pytest.mark.parametrize("shape", [(9, 9), (17, 33), (37, 51), (13, 41)])
@pytest.mark.parametrize("library", ["pyfftw", "scipy"])
def test_mirrored_deformation_is_that_of_the_whole_grid(shape, library):
    ny, nx = shape
    p = np.random.Generator(np.random.Philox(3)).random(shape)
    p += p[::-1]
    whole = HalfSpace(ny, nx, 1.0, library).deform(p)
    rows = (ny + 1) // 2
    half = MirroredHalfSpace(ny, nx, library).deform(np.ascontiguousarray(p[:rows]))
    assert np.abs(half - whole[:rows]).max() < 1e-13 * whole.max()


def test_dense_elimination_agrees_with_lapack():
    rng = np.random.Generator(np.random.Philox(5))
    a, b = rng.standard_normal((40, 40)), rng.standard_normal(40)
    x = b.copy()
    assert solve_dense(a.copy(), x)
    assert x == approx(np.linalg.solve(a, b), rel=1e-9)
    assert not solve_dense(np.zeros((3, 3)), np.ones(3))


@pytest.mark.parametrize(("points", "per_dt"), [(65, 1.0), (64, 0.0), (35, 0.0), (1 + 2 * 127, 0.0)])
def test_what_multigrid_cannot_do_is_refused(points, per_dt):
    case = Case(100.0, 10.0, points, CLOSE)
    case.problem = replace(case.problem, per_dt=per_dt)
    assert not is_applicable(case.problem)
    with pytest.raises(ValueError, match="multigrid"):
        case.solve()
