"""Laws of fatigue against the numbers that define them."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from comparison import approx

import contact_core
from benchmarks.stress.closed_forms import line_stress
from contact_core import Scene
from contact_core.kernels.load_cycle import Cycle, cycle_of
from contact_core.laws.fatigue import Basquin, DangVan, Morrow, NoFatigue

LINE = {"reference_stress": 1e9, "life_exponent": 10.0, "reference_cycles": 1e7}


def mises(stress):
    """A cycle of a von Mises amplitude."""
    shear = np.atleast_1d(np.asarray(stress, float)) / np.sqrt(3.0)
    return Cycle(shear, 0.0 * shear, 0.0 * shear)


def dang_van(stress):
    found = np.atleast_1d(np.asarray(stress, float))
    return Cycle(np.full_like(found, 1e9), 0.0 * found, found)


def test_basquins_line_goes_through_its_reference_with_its_exponent_and_ends_at_one_cycle():
    found = Basquin(**LINE).per_cycle(mises([1e9, 2e9, 0.5e9, 0.0, 1e60]))
    assert found == approx([1e-7, 1024e-7, 1e-7 / 1024.0, 0.0, 1.0], rel=1e-12)


def test_woehlers_line_falls_by_the_same_stress_for_each_factor_of_the_life_and_ends_at_one_cycle():
    """The line of Morales-Espejel & Brizmer 2011: (1220 - 43 ln N) MPa / sqrt(3)."""
    law = DangVan(1220e6 / np.sqrt(3.0), 43e6 / np.sqrt(3.0))
    lives = np.array([1.0, 1e3, 1e6, 1e9])
    found = law.per_cycle(dang_van((1220e6 - 43e6 * np.log(lives)) / np.sqrt(3.0)))
    assert found == approx(1.0 / lives, rel=1e-12)
    assert law.per_cycle(dang_van(1e30)) == 1.0


def test_nothing_counts_up_to_an_endurance_limit():
    found = Basquin(**LINE, endurance_limit=7e8).per_cycle(mises([6.999e8, 7.001e8]))
    assert found[0] == 0.0
    assert found[1] == approx(1e-7 * 0.7001**10, rel=1e-12)
    found = DangVan(7e8, 2.5e7, torsion_endurance=3e8).per_cycle(dang_van([2.999e8, 3.001e8]))
    assert found[0] == 0.0
    assert found[1] == approx(np.exp(-399.9 / 25.0), rel=1e-10)


def test_dang_vans_stress_under_pressure_is_below_zero_and_counts_nothing():
    assert not DangVan(7e8, 2.5e7).per_cycle(dang_van([0.0, -1e9, -1e12])).any()


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


SETS = tomllib.loads((Path(contact_core.__file__).parent / "data" / "fatigue.toml").read_text("utf-8"))


def named(name):
    return Scene.from_toml("mtm_zddp", {"stress.model": "half_space", "fatigue.set": name}).fatigue


def rolling(pressure_max, slope):
    """The worst cycle below a smooth line contact that rolls under a pressure [Pa]."""
    x, depths = np.linspace(-6.0, 6.0, 1201), np.linspace(0.3, 0.8, 51)
    history = np.zeros((x.size, 6, depths.size))
    for i, z in enumerate(depths):
        history[:, :, i] = line_stress(x, z, 1.0, pressure_max, 0.3).T
    found = cycle_of(history, np.zeros(6), slope)
    return Cycle(*(field.max(keepdims=True) for field in found))


@pytest.mark.parametrize("name", SETS)
def test_every_named_steel_makes_a_scene(name):
    assert SETS[name]["source"]
    assert named(name).name == SETS[name]["fatigue"]["model"]


@pytest.mark.parametrize("name", [name for name, tables in SETS.items() if "stress" in tables])
def test_a_named_steel_gives_limits_in_torsion_and_bending_of_which_dang_vans_slope_is_von_misess(name):
    stress = Scene.from_toml("mtm_zddp", {"stress.set": name, "stress.layers": "6"}).stress
    assert stress.layers == 6
    assert stress.dang_van_slope == approx(0.232, rel=1e-2)


def test_lines_of_52100_are_one_line_and_its_tangent():
    line, tangent = named("bearing_52100"), named("bearing_52100_basquin")
    for bending, life in ((1220e6 - 43e6 * np.log(1e6), 1e6), (1220e6 - 43e6 * np.log(1e7), 1e7)):
        assert line.per_cycle(dang_van(bending / np.sqrt(3.0))) == approx(1.0 / life, rel=2e-3)
        assert tangent.per_cycle(mises(bending)) == approx(1.0 / life, rel=0.2)
    work = named("bearing_52100_morrow").per_cycle(mises(2585e6 * (2e7) ** -0.09))
    assert work == approx(1e-7, rel=5e-3)


def test_flanks_of_case_carburised_steel_last_in_rolling_as_long_as_the_standard_says():
    basquin, line = named("gear_case_carburised_basquin"), named("gear_case_carburised")
    slope = 3.0 * (1.0 / np.sqrt(3.0) - 0.5)
    assert basquin.per_cycle(rolling(1500e6, slope)) == approx(1.0 / 5e7, rel=5e-3)
    assert basquin.per_cycle(rolling(2400e6, slope)) == approx(1.0 / 1e5, rel=5e-3)
    assert line.per_cycle(rolling(1500e6, slope)) == approx(1.0 / 5e7, rel=0.02)
    rise = line.per_cycle(rolling(1515e6, slope)) / line.per_cycle(rolling(1500e6, slope))
    assert rise == approx(np.exp(0.01 * 13.22), rel=2e-3)
