import numpy as np
import pytest

from contact_core.laws.boundary_friction import FilmBlend
from contact_core.laws.density import DowsonHigginson, Incompressible
from contact_core.laws.heat import FlashTemperature, NoHeat
from contact_core.laws.plasticity import ElasticPerfectlyPlastic
from contact_core.laws.rheology import EyringLimited
from contact_core.laws.tribofilm import Ghanbarzadeh, NoTribofilm, thickness
from contact_core.laws.viscosity import Barus, Roelands
from contact_core.laws.wear import Archard, NoWear

PRESSURE = np.linspace(0.0, 6e9, 40).reshape(5, 8)


@pytest.mark.parametrize("law", [Roelands, Barus])
def test_a_viscosity_has_the_value_and_the_slopes_it_is_given(law):
    oil = law(0.004, 363.15, 14.94e-9, 0.03)
    zero, dp, dt = np.zeros(1), 1e5, 1e-2
    assert oil(zero, 363.15)[0] == pytest.approx(0.004, rel=1e-14, abs=0.0)
    in_pressure = np.log(oil(zero + dp, 363.15) / oil(zero - dp, 363.15))[0] / (2.0 * dp)
    assert in_pressure == pytest.approx(14.94e-9, rel=1e-6, abs=0.0)
    in_temperature = np.log(oil(zero, 363.15 + dt) / oil(zero, 363.15 - dt))[0] / (2.0 * dt)
    assert in_temperature == pytest.approx(-0.03, rel=1e-6)


def test_barus_is_an_exponential_that_does_not_overflow():
    oil = Barus(0.004, 363.15, 20e-9, 0.03)
    assert oil(np.array([0.5e9]), 353.15)[0] == pytest.approx(0.004 * np.exp(10.0 + 0.3), rel=1e-14)
    assert np.all(np.isfinite(oil(np.array([1e11, 1e12]), 230.0)))


def test_density_rises_from_one_to_no_more_than_a_third_above():
    law = DowsonHigginson()
    assert law(np.array([0.0, 5.9e8, 1e15])) == pytest.approx([1.0, 1.17, 1.34], rel=1e-6)
    assert law(np.array([1e3]))[0] - 1.0 == pytest.approx(0.34 * 1e3 / 5.9e8, rel=1e-4, abs=0.0)


def test_an_incompressible_lubricant_keeps_its_density():
    assert np.array_equal(Incompressible()(PRESSURE), np.ones((5, 8)))


FLUID = EyringLimited(eyring_stress=5e6, limiting_coefficient=0.047)


def stress(viscosity: float, rate: float, pressure: float) -> float:
    return float(FLUID(np.array([viscosity]), np.array([rate]), np.array([pressure]))[0])


def test_a_slow_film_is_newtonian():
    assert stress(0.1, 1e3, 1e9) == pytest.approx(100.0, rel=1e-9)


def test_a_fast_film_thins_by_eyring():
    assert stress(10.0, 1e7, 1e9) == pytest.approx(5e6 * np.arcsinh(20.0), rel=1e-14)


def test_no_film_carries_more_than_the_limiting_shear_stress():
    assert stress(1e6, 1e9, 0.2e9) == pytest.approx(0.047 * 0.2e9, rel=1e-14)
    assert stress(1e6, 1e9, 0.0) == 0.0


def test_the_film_pulls_with_the_sliding():
    rate = np.linspace(-1e8, 1e8, 11)
    forward = FLUID(np.full(11, 3.0), rate, np.full(11, 1e9))
    assert np.array_equal(forward, -forward[::-1])
    assert np.all(np.diff(forward) > 0.0)
    assert forward[5] == 0.0


def test_hardness_falls_from_the_solids_to_the_full_films():
    law = ElasticPerfectlyPlastic(hardness=6e9, film_hardness=2e9)
    assert law.limit(np.array([0.0, 0.25, 1.0])) == pytest.approx([6e9, 5e9, 2e9], rel=1e-15)


BLEND = FilmBlend(bare=0.13, film=0.115, slip_speed=1e-4)


def test_boundary_friction_lies_between_bare_and_full_film():
    pressure = np.full(3, 1e9)
    found = BLEND(pressure, np.array([0.0, 0.5, 1.0]), 0.02)
    assert found == pytest.approx([0.13e9, 0.1225e9, 0.115e9], rel=1e-12)


def test_boundary_friction_is_odd_in_sliding_and_fades_over_the_slip_speed():
    pressure, cover = np.array([1e9]), np.array([0.3])
    assert BLEND(pressure, cover, -3e-5)[0] == -BLEND(pressure, cover, 3e-5)[0]
    assert BLEND(pressure, cover, 0.0)[0] == 0.0
    assert BLEND(pressure, cover, 1e-4)[0] / BLEND(pressure, cover, 1.0)[0] == pytest.approx(np.tanh(1.0), rel=1e-14)


def test_wear_is_linear_in_pressure_and_sliding_and_blind_to_direction():
    law = Archard(bare=1e-5, film=1e-6)
    rate = law.rate(np.array([[1e9, 2e9]]), np.zeros((1, 2)), 0.005, 6e9)
    assert rate == pytest.approx(np.array([[1e-5 / 6.0 * 0.005, 1e-5 / 3.0 * 0.005]]), rel=1e-14, abs=0.0)
    assert np.array_equal(law.rate(np.array([[1e9, 2e9]]), np.zeros((1, 2)), -0.005, 6e9), rate)
    assert law.rate(np.array([1e9]), np.zeros(1), 0.01, 6e9)[0] == pytest.approx(2.0 * rate[0, 0], rel=1e-14, abs=0.0)


def test_a_full_tribofilm_wears_with_its_own_coefficient():
    law = Archard(bare=1e-5, film=1e-6)
    rate = law.rate(np.full(3, 1e9), np.array([0.0, 0.5, 1.0]), 1.0, 6e9)
    assert rate / rate[0] == pytest.approx([1.0, 0.55, 0.1], rel=1e-14)


def test_wear_coefficients_are_those_of_the_source_in_cubic_millimetres_per_newton_metre():
    law = Archard(bare=1e-5, film=1e-6)
    per_pascal = law.rate(np.ones(2), np.array([0.0, 1.0]), 1.0, 6e9)  # m of depth per Pa and m of sliding = m2/N
    assert per_pascal * 1e9 == pytest.approx([1.7e-6, 1.7e-7], abs=0.05e-6)


def test_what_is_switched_off_gives_zeros():
    assert not NoWear().rate(PRESSURE, PRESSURE, 1.0, 6e9).any()
    assert not NoHeat().rise(PRESSURE, PRESSURE, 1.0).any()
    growth, removal = NoTribofilm().evolve(np.zeros((2, 3)), np.zeros((2, 3)), np.full((2, 3), 1e4), 363.15)
    assert not thickness(growth, removal).any()
    assert NoTribofilm().covers(230.0)


FILM = Ghanbarzadeh(176e-9, 4.13e-16, 112.5e-9, 6.799e-4, 363.15)


def test_a_point_that_is_not_rubbed_keeps_its_film():
    growth, removal = np.array([0.0, 50e-9]), np.array([0.0, 20e-9])
    after = FILM.evolve(growth, removal, np.zeros(2), 363.15)
    assert np.array_equal(after[0], growth)
    assert np.array_equal(after[1], removal)


def test_a_film_never_gets_thinner_than_nothing():
    assert np.array_equal(thickness(np.array([3.0, 1.0]), np.array([1.0, 3.0])), [2.0, 0.0])


def test_film_constants_hold_within_five_kelvin():
    assert FILM.covers(368.15)
    assert not FILM.covers(368.2)
    assert not FILM.covers(358.1)


STEEL = FlashTemperature(46.0, 46.0, 1.25e-5, 1.25e-5)


def rise(law: FlashTemperature, radius: float, heat: float, speed: float) -> float:
    """Temperature rise for a heat flux tau |u_s| [W/m2]."""
    return float(law.rise(np.array([radius]), np.array([heat / speed]), speed)[0])


def test_a_slow_spot_of_two_equal_bodies_sends_half_its_heat_into_each():
    average = 8.0 / (3.0 * np.pi) * 0.5 * 1e9 * 10e-6 / 46.0  # of a uniform, static circular source
    assert rise(STEEL, 10e-6, 1e9, 1e-9) == pytest.approx(average, rel=1e-4)


def test_a_slow_spot_against_an_insulator_sends_all_its_heat_into_the_conductor():
    law = FlashTemperature(46.0, 46e-12, 1.25e-5, 1.25e-5)
    assert rise(law, 10e-6, 1e9, 1e-9) == pytest.approx(8.0 / (3.0 * np.pi) * 1e9 * 10e-6 / 46.0, rel=1e-4)


def test_a_fast_spot_warms_with_the_inverse_root_of_its_speed():
    assert rise(STEEL, 10e-6, 1e9, 4e6) / rise(STEEL, 10e-6, 1e9, 1e6) == pytest.approx(0.5, rel=1e-5)


def test_the_flash_temperature_is_blind_to_the_direction_of_sliding():
    radius, shear = np.array([1e-6, 1e-5]), np.array([1e8, -2e8])
    assert np.array_equal(STEEL.rise(radius, shear, 0.3), STEEL.rise(radius, -shear, -0.3))
    assert not STEEL.rise(radius, shear, 0.0).any()


def test_flash_temperatures_of_the_shipped_cases_are_below_one_kelvin():
    radius, shear = np.array([1e-6, 20e-6]), np.array([0.2e9, 0.6e9])
    found = STEEL.rise(radius, shear, 0.005)
    assert np.all(found > 0.005)
    assert np.all(found < 0.7)
