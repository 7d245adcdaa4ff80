"""Flow through the faces between nodes, held against an ordinary differential equation and against finer grids."""

from dataclasses import replace

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import quad
from wavy_contact import problem

from contact_core.kernels.mixed.asperities import REACH, carried_at, rest_gap
from contact_core.kernels.mixed.fixed_point import solve_mixed
from contact_core.kernels.mixed.flow import Flow, properties
from contact_core.kernels.mixed.problem import Iterate

STEP, BARUS = 1e-3, 8.0
TABLE = np.arange(0.0, 4.0, STEP)
SOFT = 1e-9  # 1 / (compliance dx^2) at which nothing is stiff against the flow


def flow(gap, f, per_stiff, fitted=True, mobility=1.0):
    """Return the flows through the faces of one row under given gaps and pressures, at constant density."""
    rows = np.repeat(np.asarray(gap, np.float64)[None, :], 3, axis=0)
    pressure = np.repeat(np.asarray(f, np.float64)[None, :], 3, axis=0)
    flows = Flow(rows.shape, 1e-6, STEP, per_stiff, fitted)
    fluidity = np.exp(-BARUS * TABLE)
    potential = np.concatenate([[0.0], np.cumsum(0.5 * STEP * (fluidity[1:] + fluidity[:-1]))])
    flows.gap[:] = rows
    for at in np.ndindex(rows.shape):
        dense = properties(pressure[at], STEP, np.ones_like(TABLE), fluidity, potential)
        flows.rho[at], flows.fluid[at], flows.potential[at] = dense
    flows.measure()
    flows.drive(pressure, rows, np.full_like(rows, mobility), np.zeros_like(rows))
    return flows


@pytest.mark.parametrize("through", [0.2, 0.9, 1.4])
@pytest.mark.parametrize("gap", [(1.2, 1.0, 0.5, 0.3), (0.3, 0.5, 0.9, 1.6), (2.0, 1.0, 0.8, 1.1)])
def test_a_constant_flow_passes_a_face_exactly_however_much_gap_and_viscosity_change(through, gap):
    """The pressure at the end of a cell follows from its flow by quadrature, without the code of the face."""
    inside = np.polynomial.Polynomial(np.polyfit([-1.0, 0.0, 1.0, 2.0], gap, 3)[::-1])
    push, begin = quad(lambda s: (inside(s) - through) / inside(s) ** 3, 0.0, 1.0, epsabs=1e-12)[0], 0.1
    mobility = abs(push) / 0.03  # for which the viscosity changes a lot along the cell
    driven = push / mobility
    end = -np.log(np.exp(-BARUS * begin) - BARUS * driven) / BARUS
    assert abs(end - begin) > 0.05
    faces = flow(gap, [begin, begin, end, end], per_stiff=1e9, mobility=mobility)
    found = faces.carried[1, 1] - faces.ex[1, 1] * (end - begin)
    assert found == approx(through, rel=3e-3)
    plain = flow(gap, [begin, begin, end, end], per_stiff=1e9, fitted=False, mobility=mobility)
    assert abs(plain.carried[1, 1] - plain.ex[1, 1] * (end - begin) - through) > 0.03  # the means of the nodes


def test_a_film_that_elasticity_holds_is_carried_along_by_third_order_within_its_nodes():
    def error(n):
        x = np.linspace(0.0, 1.0, n)
        gap = 1.0 + 0.3 * np.sin(x)
        faces = flow(gap, np.full(n, 0.5), per_stiff=SOFT)
        middle = 1.0 + 0.3 * np.sin(0.5 * (x[1:-2] + x[2:-1]))
        return float(np.abs(faces.carried[1, 1 : n - 2] - middle).max())

    assert np.log2(error(33) / error(65)) > 2.7
    rough = np.random.default_rng(3).uniform(0.5, 1.5, 40)
    carried = flow(rough, np.full(40, 0.5), per_stiff=SOFT).carried[1, :-1]
    assert (carried >= np.minimum(rough[:-1], rough[1:])).all()
    assert (carried <= np.maximum(rough[:-1], rough[1:])).all()


def test_asperities_carry_at_their_rest_gap_what_they_rest_under():
    floor, stress, depth = 0.1, 2.0, 0.3
    for q in (1e-4, 0.01, 0.5, 1.9):
        assert carried_at(rest_gap(q, floor, stress, depth), floor, stress, depth) == approx(q, rel=1e-12)
    assert rest_gap(2.5, floor, stress, depth) == floor
    assert carried_at(floor + REACH * depth, floor, stress, depth) == 0.0
    assert rest_gap(0.7, floor, stress, 0.0) == floor  # a hard floor


def start(case, smooth, lift=0.15):
    pressure = smooth * (case.load / smooth.sum())
    return Iterate(pressure, pressure, np.zeros(smooth.shape, np.bool_), lift - 1.0)


def test_fitted_flow_gives_on_a_coarse_grid_the_film_of_fine_ones():
    """A smooth film at whose inlet the plain flow is far off."""
    central = {}
    for n in (33, 129):
        for fitted in (True, False):
            case, smooth, half_space = problem(n, n, mobility=300.0)
            found = solve_mixed(half_space, replace(case, fitted=fitted), start(case, smooth), 1e-4, 600)
            assert found.converged, found.shortfall
            central[n, fitted] = float(found.gap[n // 2, n // 2])
    assert central[33, True] == approx(central[129, True], rel=0.02)
    assert abs(central[33, False] / central[129, True] - 1.0) > 0.05


@pytest.mark.parametrize("mobility", [300.0, 3e3])
def test_oil_and_asperities_share_the_pressure_by_the_law_at_every_node(mobility):
    case, smooth, half_space = problem(49, 49, 0.02, mobility=mobility)
    case = replace(case, fitted=True, stress=2.0, depth=0.005)
    found = solve_mixed(half_space, case, start(case, smooth), 2e-3, 600)
    assert found.converged, found.shortfall
    it, inner = found.iterate, np.s_[1:-1, 1:-1]
    alone = (it.pressure - it.fluid)[inner]
    law = np.array([carried_at(h, *case.layer) for h in found.gap[inner].ravel()]).reshape(alone.shape)
    above = (found.gap[inner] > case.floor) & (it.pressure[inner] < case.cap[inner])
    assert 0.02 < alone.sum() / case.load < 0.98
    off = np.abs(alone - law)[above]
    assert (off > 0.02).mean() < 0.01  # nodes that lose all of their oil are as far as the stopping rule lets them
    assert off.mean() < 2e-3
    assert (it.fluid >= 0.0).all()
    hard = solve_mixed(half_space, replace(case, depth=0.0), start(case, smooth), 2e-3, 600)
    assert float((hard.iterate.pressure - hard.iterate.fluid).sum()) < 0.8 * alone.sum()
