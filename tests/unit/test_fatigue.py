"""Laws of fatigue against the numbers that define them."""

import numpy as np
import pytest
from comparison import approx

from contact_core.kernels.load_cycle import Cycle
from contact_core.laws.fatigue import Basquin, DangVan, Morrow, NoFatigue

LINE = {"reference_stress": 1e9, "life_exponent": 10.0, "reference_cycles": 1e7}


def mises(stress):
    """A cycle of a von Mises amplitude."""
    shear = np.atleast_1d(np.asarray(stress, float)) / np.sqrt(3.0)
    return Cycle(shear, 0.0 * shear, 0.0 * shear)


def dang_van(stress):
    found = np.atleast_1d(np.asarray(stress, float))
    return Cycle(np.full_like(found, 1e9), 0.0 * found, found)


@pytest.mark.parametrize(("law", "cycle"), [(Basquin, mises), (DangVan, dang_van)])
def test_a_line_of_lives_goes_through_its_reference_with_its_exponent_and_ends_at_one_cycle(law, cycle):
    found = law(**LINE).per_cycle(cycle([1e9, 2e9, 0.5e9, 0.0, 1e30]))
    assert found == approx([1e-7, 1024e-7, 1e-7 / 1024.0, 0.0, 1.0], rel=1e-12)


@pytest.mark.parametrize(("law", "cycle"), [(Basquin, mises), (DangVan, dang_van)])
def test_nothing_counts_up_to_an_endurance_limit(law, cycle):
    found = law(**LINE, endurance_limit=7e8).per_cycle(cycle([6.999e8, 7.001e8]))
    assert found[0] == 0.0
    assert found[1] == approx(1e-7 * 0.7001**10, rel=1e-12)


def test_dang_vans_stress_under_pressure_is_below_zero_and_counts_nothing():
    assert not DangVan(**LINE).per_cycle(dang_van([-1e9, -1e12])).any()


def test_a_million_cycles_do_the_damage_of_one_a_million_times():
    law = Basquin(**LINE)
    once = law.per_cycle(mises([3e8, 8e8]))
    assert np.array_equal(1e6 * once, law.per_cycle(mises([3e8, 8e8])) * 1e6)
    assert 1e6 * once == approx(0.1 * np.array([0.3, 0.8]) ** 10, rel=1e-12)


def test_work_and_strain_lives_agree_where_the_cyclic_curve_is_theirs():
    """Life by plastic strain, eps_f (2N)^c, and by stress, sigma_f (2N)^b: the work per cycle gives the same life."""
    sigma, b, eps, c = 2.6e9, -0.09, 0.18, -0.56
    n = b / c
    law = Morrow(sigma / eps**n, n, 4.0 * sigma * eps * (c - b) / (c + b), -1.0 / (b + c))
    reversals = np.array([1e2, 1e4, 1e6, 1e9])
    assert law.per_cycle(mises(sigma * reversals**b)) == approx(2.0 / reversals, rel=1e-10)


def test_the_work_per_cycle_is_the_area_of_the_loop_of_masings_rule():
    stress, K, n = 1.2e9, 3e9, 0.2
    law = Morrow(K, n, 1e9, 1.0)
    span = np.linspace(0.0, 2.0 * stress, 200001)
    strain = 2.0 * (span / (2.0 * K)) ** (1.0 / n)  # plastic, along a branch
    area = 2.0 * np.trapezoid(span, strain) - 2.0 * stress * strain[-1]  # both branches, less the rectangle
    assert law.per_cycle(mises(stress)) == approx(2.0 * area / 1e9, rel=1e-6)


def test_without_a_law_nothing_is_damaged():
    assert not NoFatigue.damages
    assert not NoFatigue().per_cycle(mises([1e9, 1e12])).any()
