"""Corrections of a fitted flow by coarser grids: their mobilities, and what of them is added beside the outlet."""

import numpy as np
from comparison import approx

from contact_core.kernels.multigrid.blended import blend
from contact_core.kernels.multigrid.transfer import add_interpolated, interpolate_cubic

THICKENING = 1.3  # fluidity exp(-THICKENING p)


def blended(per_stiff, thinned=0.0):
    """Ratio of the mobilities along and across to the upwind ones, between pressures of 0, 2 and 5."""
    p = np.array([[0.0, 2.0], [5.0, 5.0]])
    fluid = np.exp(-THICKENING * p)
    ex, ey = np.ones((2, 2)), np.ones((2, 2))
    potential = (1.0 - fluid) / THICKENING
    blend(p, fluid, potential, np.full((2, 2), thinned), per_stiff, 1e-3, ex, ey)
    return ex, ey


def test_where_the_film_is_stiff_a_correction_has_the_upwind_mobility():
    ex, ey = blended(1e-9)
    assert ex == approx(1.0, rel=1e-12)
    assert ey == approx(1.0, rel=1e-12)


def test_where_pressure_flow_rules_a_correction_has_the_mean_fluidity_over_pressure():
    ex, ey = blended(1e9, thinned=0.2)

    def ratio(low, high):
        mean = (np.exp(-THICKENING * low) - np.exp(-THICKENING * high)) / (THICKENING * (high - low))
        return (mean + 0.2) / (0.5 * (np.exp(-THICKENING * low) + np.exp(-THICKENING * high)) + 0.2)

    assert ex[0, 0] == approx(ratio(0.0, 2.0), rel=1e-9)
    assert ex[1, 0] == 1.0  # equal pressures
    assert (ey[0, 0], ey[0, 1]) == (approx(ratio(0.0, 5.0), rel=1e-9), approx(ratio(2.0, 5.0), rel=1e-9))
    assert ratio(0.0, 5.0) < ratio(0.0, 2.0) < 1.0


def test_in_between_the_share_of_each_mobility_is_that_of_the_flow():
    stiff, half, flowing = (blended(per_stiff)[0][0, 0] for per_stiff in (1e-9, 1.0, 1e9))
    assert half == approx(0.5 * (stiff + flowing), rel=1e-12)


def test_a_steep_end_of_the_pressure_takes_its_part_of_a_correction_and_a_straight_slope_all_of_it():
    old = np.array([[4.0, 2.0, 0.0]] * 3)
    new = old + 0.4
    straight = np.array([[4.0, 3.0, 2.0, 1.0, 0.0]] * 5)
    ending = np.array([[4.0, 3.0, 2.0, 0.1, 0.0]] * 5)
    for steep, added in ((False, 0.4), (True, 0.04)):
        p = straight.copy()
        add_interpolated(new, old, p, steep)
        assert p - straight == approx(np.array([[0.4, 0.4, 0.4, 0.4, 0.0]] * 5), rel=1e-12)
        p = ending.copy()
        add_interpolated(new, old, p, steep)
        assert (p - ending)[:, 3] == approx(added, rel=1e-12)


def test_half_of_a_symmetric_field_is_interpolated_as_the_whole():
    whole = np.random.default_rng(2).uniform(size=(9, 7))
    whole += whole[::-1]
    fine, half = np.empty((17, 13)), np.empty((9, 13))
    interpolate_cubic.py_func(whole, False, fine)
    interpolate_cubic.py_func(np.ascontiguousarray(whole[:5]), True, half)
    assert np.abs(half - fine[:9]).max() < 1e-15
