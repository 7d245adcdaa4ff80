"""Films of contacts that repeat along y: what repeats or moves with the roughness, and the equations at first hand."""

from dataclasses import replace

import numpy as np
import pytest
from comparison import approx
from line_contact import line, roughness, with_images

from contact_core.kernels.mixed.fixed_point import solve_mixed
from contact_core.kernels.mixed.newton import solve_newton
from contact_core.kernels.mixed.problem import Iterate
from contact_core.kernels.multigrid.cycle import is_applicable

NX = 129


def solve(method, case, start=None, tolerance=1e-6, **changes):
    solver, most = {
        "newton": (solve_newton, 60),
        "hybrid": (solve_mixed, 600),
    }[method]
    return solver(case.half_space, replace(case.problem, **changes), start or case.start, tolerance, most)


def inner(found):
    """Pressure without its images, which have to be images."""
    it = found.iterate
    for field in (it.pressure, it.fluid, it.solid, found.gap, found.mass):
        assert (field[0] == field[-2]).all()
        assert (field[-1] == field[1]).all()
    return it.pressure[1:-1]


def apart(one, other):
    return np.abs(one - other).sum() / one.sum()


def net_inflow(problem, found):
    """Net inflow of every node of a period but its ends, and its mass; neighbours across by rolling."""
    it, dx = found.iterate, problem.spacing
    gap, f = found.gap[1:-1], it.fluid[1:-1]
    at = np.arange(problem.density.size) * problem.step
    flow = np.where(it.solid[1:-1], problem.floor, np.maximum(gap, problem.floor))
    mass = np.interp(f, at, problem.density) * flow
    ease = problem.mobility[1:-1] * mass * flow**2 * np.interp(f, at, problem.fluidity)
    along = 0.5 * (ease[:, 1:] + ease[:, :-1]) * np.diff(f, axis=1) / dx
    across = 0.5 * (np.roll(ease, -1, axis=0) + ease) * (np.roll(f, -1, axis=0) - f) / dx
    net = np.diff(along, axis=1) / dx + (across - np.roll(across, 1, axis=0))[:, 1:-1] / dx
    behind = np.concatenate((mass[:, :1], mass[:, :-3]), axis=1)
    carried = 1.5 * mass[:, 1:-1] - 2.0 * mass[:, :-2] + 0.5 * behind
    carried[:, 0] = mass[:, 1] - mass[:, 0]
    return net - carried / dx, mass


CASES = [  # method, load, oil, rms roughness over the film of the formula
    ("newton", 5.0, 5.0, 0.4),
    pytest.param("newton", 5.0, 5.0, 1.5, marks=pytest.mark.long),
    ("hybrid", 200.0, 10.0, 0.3),
    pytest.param("hybrid", 200.0, 10.0, 4.0, marks=pytest.mark.long),
]
DEEPER = ("hybrid", 200.0, 10.0, 2.0)  # solids at the floor's edge


@pytest.mark.parametrize(("method", "load", "oil", "rms"), CASES)
def test_a_moved_roughness_moves_the_film_and_two_periods_are_as_good_as_one(method, load, oil, rms):
    z = rms * roughness(8, NX)
    rough = (z, np.roll(z, 3, axis=0), np.tile(z, (2, 1)))
    one, moved, twice = (solve(method, line(load, oil, NX, part, floor=0.05), tolerance=1e-5) for part in rough)
    p = inner(one)
    assert np.ptp(p, axis=0).max() > 0.1  # the roughness is felt
    assert one.iterate.solid.any() == (rms > 1.0)
    assert apart(np.roll(p, 3, axis=0), inner(moved)) < 3e-5
    assert apart(np.tile(p, (2, 1)), inner(twice)) < 3e-5
    for found in (one, moved, twice):
        assert found.pressure_change < 1e-5
        assert abs(found.load_error) < 1e-4


@pytest.mark.parametrize(("method", "load"), [("newton", 5.0), ("hybrid", 100.0)])
def test_equal_rows_are_as_good_as_one_row(method, load):
    wave = 0.2 * np.cos(7.0 * np.linspace(-2.5, 1.5, NX))
    found = [solve(method, line(load, 8.0, NX, np.tile(wave, (rows, 1)))) for rows in (1, 2, 3, 4)]
    p = inner(found[0])
    for more in found[1:]:
        assert apart(np.broadcast_to(p, inner(more).shape), inner(more)) < 1e-5
        assert more.iterate.rigid == approx(found[0].iterate.rigid, abs=1e-5)


@pytest.mark.parametrize(("method", "load", "oil", "rms"), [*CASES, DEEPER])
@pytest.mark.parametrize("rows", [2, 5])
def test_films_satisfy_the_equations(method, load, oil, rms, rows):
    case = line(load, oil, NX, rms * roughness(rows, NX), floor=0.05)
    found = solve(method, case, tolerance=1e-5)
    q, p = case.problem, inner(found)
    net, mass = net_inflow(q, found)
    solid, f = found.iterate.solid[1:-1], found.iterate.fluid[1:-1]
    assert p.sum() == approx(q.load, rel=1e-4)
    assert p.min() >= 0.0
    assert (p - f).min() >= 0.0
    assert (p == f)[~solid].all()
    settled = case.half_space.deform(p)
    assert found.iterate.rigid + q.undeformed[1:-1] + settled == approx(found.gap[1:-1], abs=1e-9)
    wet = ((p > 0.0) & ~solid & (found.gap[1:-1] > 1.2 * q.floor))[:, 1:-1]  # at the floor, solids may hold a node
    weight = p[:, 1:-1][wet]
    assert (weight * np.abs(net[wet])).sum() < 2e-4 * (weight * mass[:, 1:-1][wet]).sum()
    assert net[((p <= 0.0) & ~solid)[:, 1:-1]].max() < 1e-3 * mass.max()
    assert (p * np.abs(found.gap[1:-1] - q.floor))[solid].sum() < 1e-3 * q.floor * p.sum()


def test_cavities_that_hold_their_oil_move_with_the_roughness():
    z = 0.3 * roughness(8, NX)
    rough = (z, np.roll(z, 3, axis=0), np.tile(z, (2, 1)))
    one, moved, twice = (solve("hybrid", line(60.0, 8.0, NX, part), tolerance=1e-5, conserving=True) for part in rough)
    cavity, mass = inner(one) <= 0.0, one.mass[1:-1]
    assert (mass[cavity] < 0.9 * one.gap[1:-1][cavity]).any()  # not full
    assert apart(np.roll(inner(one), 3, axis=0), inner(moved)) < 3e-5
    assert apart(np.roll(mass, 3, axis=0), moved.mass[1:-1]) < 3e-5
    assert apart(np.tile(mass, (2, 1)), twice.mass[1:-1]) < 3e-5


def test_all_methods_agree_on_a_rough_film():
    """From a Hertz-like film Newton's method goes astray under more load than this."""
    case = line(20.0, 5.0, NX, 0.3 * roughness(4, NX))
    found = [solve(method, case) for method in ("newton", "hybrid")]
    for one in found:
        assert one.converged
        assert apart(inner(found[0]), inner(one)) < 1e-5


def test_a_dry_start_touches_where_the_dry_contact_does():
    case = line(200.0, 10.0, NX, 20.0 * roughness(16, NX))
    start = case.dry_start()
    found = solve("hybrid", case, start, tolerance=1e-3)
    share = (found.iterate.pressure - found.iterate.fluid)[1:-1].sum() / case.problem.load
    assert inner(found).sum() == approx(case.problem.load, rel=1e-4)
    assert 0.3 < share < 1.0
    touching = found.iterate.solid[1:-1] & (inner(found) > 0.0)
    assert (touching & start.solid[1:-1]).sum() > 0.8 * touching.sum()


def test_time_steps_tend_to_the_steady_film():
    case = line(100.0, 8.0, NX, 0.2 * roughness(6, NX))
    steady = solve("hybrid", case)
    now = solve("hybrid", case, mobility=case.problem.mobility / 1.5)
    before = apart(inner(steady), inner(now))
    for _ in range(12):
        it = Iterate(now.iterate.pressure, now.iterate.fluid, now.iterate.solid, now.iterate.rigid)
        now = solve("hybrid", case, it, tolerance=1e-5, per_dt=2.0, mass_old=now.mass)
        inner(now)
    assert apart(inner(steady), inner(now)) < 0.01 * before


def test_multigrid_does_not_claim_contacts_that_repeat():
    case = line(100.0, 8.0, NX, np.zeros((127, NX)))
    assert not is_applicable(case.problem)
    assert is_applicable(replace(case.problem, wrapped=False))


def test_images_are_rows_of_the_other_end():
    field = np.arange(12.0).reshape(4, 3)
    assert (with_images(field)[[0, -1]] == field[[-1, 0]]).all()
