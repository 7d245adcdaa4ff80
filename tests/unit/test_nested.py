from dataclasses import replace

import numpy as np
import pytest
from wavy_contact import axis, problem

from contact_core.kernels.far_field import far_field
from contact_core.kernels.mixed import Iterate
from contact_core.kernels.nested import coarsen, lost, nested_start, prolong
from contact_core.kernels.steady import shared_start, solve_steady


@pytest.mark.parametrize(("ny", "nx", "coarse"), [(33, 33, (17, 17)), (32, 32, (16, 16)), (33, 48, (17, 24))])
def test_the_coarser_problem_is_the_same_contact(ny, nx, coarse):
    case, _, half_space = problem(ny, nx)
    half = coarsen(case)
    assert half.undeformed.shape == half_space.coarser.shape == coarse
    assert half.spacing**2 * half.load == pytest.approx(case.spacing**2 * case.load, rel=1e-14)
    pressure = np.exp(-(axis(nx)[None, :] ** 2) - axis(ny)[:, None] ** 2)
    fewer = coarsen(replace(case, cap=pressure)).cap
    expected = coarsen(replace(case, cap=half_space.deform(pressure))).cap
    found = half_space.coarser.deform(fewer)
    inside = np.s_[3:-3, 3:-3]
    assert np.abs(found - expected)[inside].max() < 0.03 * expected.max()


def test_what_lies_beyond_the_edge_carries_over():
    x = axis(65, 7.0) - 1.0
    y = axis(65, 7.0)
    case, _, _ = problem(65, 65)
    edge, weight = far_field(x, y, 0.5)
    coarse_edge, coarse_weight = far_field(x[::2], y[::2], 0.5)
    half = coarsen(replace(case, edge=edge, weight=weight))
    inside = np.s_[1:-1, 1:-1]
    assert not half.edge[inside].any()
    assert (half.weight[inside] == 1.0).all()
    sides = ((slice(2, -2), 0), (0, slice(2, 14)), (-1, slice(2, 14)))
    for side in sides:
        assert half.edge[side] == pytest.approx(coarse_edge[side], rel=0.03)
        assert half.weight[side] - 1.0 == pytest.approx(coarse_weight[side] - 1.0, rel=1e-12)


@pytest.mark.parametrize("n", [17, 16])
def test_prolongation_is_exact_for_linear_fields(n):
    coarse = (n + 1) // 2
    at = np.arange(n)
    nodes = np.arange(coarse) * 2.0 + (0.0 if n % 2 else 0.5)
    plane = 1.0 + 0.1 * nodes[None, :] + 0.05 * nodes[:, None]
    solid = np.zeros((coarse, coarse), np.bool_)
    solid[2:5, 3:6] = True
    fine = prolong(Iterate(plane, 0.5 * plane, solid, -0.7), (n, n))
    inside = slice(1, -1)
    expected = (1.0 + 0.1 * at[None, :] + 0.05 * at[:, None])[inside, inside]
    assert fine.pressure[inside, inside] == pytest.approx(expected, rel=1e-14)
    assert fine.fluid[inside, inside] == pytest.approx(0.5 * expected, rel=1e-14)
    assert fine.rigid == -0.7
    assert 16 < fine.solid.sum() < 64


def test_roughness_of_few_nodes_is_lost_on_the_coarser_grid():
    x = np.arange(64)
    waves = {n: np.cos(2 * np.pi * x[None, :] / n) * np.cos(2 * np.pi * x[:, None] / n) for n in (4, 32)}
    assert lost(waves[32]) < 0.05 < 0.5 < lost(waves[4])


def test_a_nested_film_is_closer_to_the_steady_one_than_a_start_on_the_grid_itself():
    case, smooth, half_space = problem(65, 65, wave=0.02)
    start = shared_start(half_space, case, smooth)
    steady = solve_steady(half_space, case, start, 1e-3, 1000)
    assert steady.converged
    pressure = steady.iterate.pressure
    errors = {}
    for name, begin in (("nested", nested_start(half_space, case, smooth)), ("own", start)):
        found = solve_steady(half_space, case, begin, 0.0, 18).iterate.pressure
        errors[name] = float(np.abs(found - pressure).sum() / pressure.sum())
    assert errors["nested"] < 0.7 * errors["own"]
    assert errors["nested"] < 0.1
