"""Dry contact with asperities below the grid, held against its own law and against limits in closed form."""

import numpy as np
import pytest
from comparison import approx
from wavy_contact import problem

from contact_core.kernels.dry import solve_dry
from contact_core.kernels.dry_asperities import solve_dry_asperities
from contact_core.kernels.mixed.asperities import carried_at

STRESS = 2.0


def contact(depth, n=49, wave=0.02, cap=5.0, stress=STRESS, tolerance=1e-6):
    case, smooth, half_space = problem(n, n, wave)
    given = (half_space, case.undeformed, np.full((n, n), cap), case.load, smooth)
    p, rigid, converged, iterations = solve_dry_asperities(*given, (stress, depth), tolerance, 2000)
    assert converged
    return p, rigid + case.undeformed + half_space.deform(p), iterations, given


@pytest.mark.parametrize("depth", [0.002, 0.02, 0.2])
def test_asperities_carry_what_their_law_gives_at_the_gap_of_every_node(depth):
    p, h, iterations, given = contact(depth)
    law = np.array([carried_at(value, 0.0, STRESS, depth) for value in h.ravel()]).reshape(h.shape)
    above = h > 1e-9
    assert float(np.abs(p - law)[above].sum()) < 2e-5 * given[3]
    assert (p[~above] >= STRESS * (1.0 - 1e-5)).all()  # on the floor they carry more than they can above it
    assert p.sum() == approx(given[3], rel=1e-6)
    assert iterations < 400


def test_shallow_asperities_are_a_hard_floor():
    p, _, _, given = contact(1e-5)
    hard = solve_dry(*given, 1e-6, 1000)[0]
    assert float(np.abs(p - hard).sum()) < 0.01 * given[3]
    deep = contact(0.02)[0]
    assert float(np.abs(deep - hard).sum()) > 0.1 * given[3]


def test_nodes_at_their_cap_yield_and_carry_no_more():
    p, h, _, given = contact(0.02, cap=0.9)
    assert p.max() == 0.9
    capped = p >= 0.9
    assert 0.02 < capped.mean() < 0.5
    assert (h[capped] <= 0.02 * np.log(STRESS / 0.9) + 1e-6).all()
    assert p.sum() == approx(given[3], rel=1e-6)


def test_rigid_flat_bodies_part_by_the_law_alone():
    """Without waves, and so soft a law that elasticity does not matter, the gap is depth ln(stress / p)."""
    n, depth = 33, 1e6
    _, smooth, half_space = problem(n, n)
    load = 0.5 * n * n
    p, rigid, converged, _ = solve_dry_asperities(
        half_space, np.zeros((n, n)), np.full((n, n), 5.0), load, smooth, (STRESS, depth), 1e-6, 500
    )
    assert converged
    assert p == approx(np.full((n, n), 0.5), rel=1e-5)
    assert rigid == approx(depth * np.log(STRESS / 0.5), rel=1e-3)
