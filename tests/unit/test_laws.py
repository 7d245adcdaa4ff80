from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest
from comparison import approx

from contact_core import Scene, SceneError, advance, initial_state
from contact_core.laws.boundary_friction import FilmBlend
from contact_core.laws.density import DowsonHigginson, Incompressible
from contact_core.laws.plasticity import ElasticPerfectlyPlastic
from contact_core.laws.rheology import Eyring
from contact_core.laws.tribofilm import Andersson, Ghanbarzadeh, Gosvami, NoTribofilm, thickness
from contact_core.laws.viscosity import AstmD341, Barus, Modulus, Roelands, kinematic_viscosity
from contact_core.laws.wear import Archard, NoWear

PRESSURE = np.linspace(0.0, 6e9, 40).reshape(5, 8)
FULL = 100e-9  # full tribofilm [m]


@pytest.mark.parametrize("law", [Roelands, Barus])
def test_a_viscosity_has_the_value_and_the_slopes_it_is_given(law):
    oil = law(0.004, 363.15, 14.94e-9, 0.03)
    zero, dp, dt = np.zeros(1), 1e5, 1e-2
    assert oil(zero, 363.15)[0] == approx(0.004, rel=1e-14, abs=0.0)
    in_pressure = np.log(oil(zero + dp, 363.15) / oil(zero - dp, 363.15))[0] / (2.0 * dp)
    assert in_pressure == approx(14.94e-9, rel=1e-6, abs=0.0)
    in_temperature = np.log(oil(zero, 363.15 + dt) / oil(zero, 363.15 - dt))[0] / (2.0 * dt)
    assert in_temperature == approx(-0.03, rel=1e-6)


def test_barus_is_an_exponential_that_does_not_overflow():
    oil = Barus(0.004, 363.15, 20e-9, 0.03)
    assert oil(np.array([0.5e9]), 353.15)[0] == approx(0.004 * np.exp(10.0 + 0.3), rel=1e-14)
    assert np.all(np.isfinite(oil(np.array([1e11, 1e12]), 230.0)))


CURVED = Modulus(86.86e-6, 890.0, -182.0, -2.28e7, 2.26e5, -68.2e-3, 27.68e-5)


def test_the_modulus_equation_is_vogels_law_times_an_exponential_of_pressure():
    temperature, pressure = 350.0, np.array([0.0, 0.1e9, 1e9])
    vogel = 86.86e-6 * np.exp(890.0 / 168.0)
    modulus = -2.28e7 + 2.26e5 * 350.0 + (-68.2e-3 + 27.68e-5 * 350.0) * pressure
    assert CURVED(pressure, temperature) == approx(vogel * np.exp(pressure / modulus), rel=1e-7)


@pytest.mark.parametrize("bend", [-0.3, -0.0682, 0.0, 0.1])
@pytest.mark.parametrize("modulus", [-5e8, -2.28e7, 0.0])
def test_beyond_its_pole_the_modulus_equation_is_stiff_and_never_turns_back(bend, modulus):
    oil = replace(CURVED, bend=bend, bend_slope=0.0, modulus=modulus)
    pressure = np.concatenate([[0.0], np.logspace(-3, np.log10(2e10), 200)])[:, None]
    found = oil(pressure, np.linspace(230.0, 900.0, 68))
    assert found.shape == (201, 68)
    assert np.all(np.isfinite(found))
    assert np.all(np.diff(found, axis=0) >= 0.0)
    assert np.all(np.diff(found, axis=1) <= 0.0)
    assert found[0] == approx(oil(np.zeros(1), np.linspace(230.0, 900.0, 68)), rel=1e-14)
    if bend < 0.0:
        assert found[-1, 0] == 86.86e-6 * np.exp(500.0)


SHEET = AstmD341(99.4e-6, 10.99e-6, 900.0, 18.8e-9, 333.15, 6e-4)


def test_the_kinematic_viscosity_is_the_data_sheets_or_that_of_an_assumed_density():
    assert kinematic_viscosity(SHEET, 313.15) == approx(99.4e-6, rel=1e-12)
    assert kinematic_viscosity(SHEET, np.array([313.15, 373.15])) == approx([99.4e-6, 10.99e-6], rel=1e-12)
    assert kinematic_viscosity(Barus(0.087, 353.15, 2e-8, 0.03), 353.15) == approx(1e-4, rel=1e-12)  # 870 kg/m3


def test_an_oil_has_the_kinematic_viscosities_and_the_density_of_its_data_sheet():
    temperature = np.array([313.15, 373.15])
    density = 900.0 * (1.0 - 6e-4 * np.array([25.0, 85.0]))
    found = SHEET(np.zeros(2), temperature)
    assert found == approx(density * np.array([99.4e-6, 10.99e-6]), rel=1e-12)


def test_between_the_two_viscosities_the_double_logarithm_is_straight_in_the_logarithm_of_temperature():
    temperature = np.array([283.15, 313.15, 343.15, 373.15, 423.15])
    kinematic = SHEET(np.zeros(5), temperature) / (900.0 * (1.0 - 6e-4 * (temperature - 288.15)))
    double_log = np.log10(np.log10(1e6 * kinematic + 0.7))
    slope = np.diff(double_log) / np.diff(np.log10(temperature))
    assert slope == approx(np.full(4, slope[0]), rel=1e-9)


def test_an_oil_has_its_pressure_coefficient_where_it_was_measured_and_falls_as_roelands_has_it():
    temperature, step = np.array([313.15, 333.15, 373.15]), 1e5
    low, high = SHEET(np.array([[0.0], [step]]), temperature)
    coefficient = np.log(high / low) / step
    assert coefficient[1] == approx(18.8e-9, rel=1e-3)
    exponent = coefficient / (5.1e-9 * (np.log(low) + 9.67))
    assert exponent == approx(np.full(3, exponent[0]), rel=1e-4)


@pytest.mark.parametrize(("kelvin", "bend"), [(313.15, 0.0175), (373.15, 0.0348), (343.15, 0.02615)])
def test_under_pressure_an_oil_of_a_data_sheet_follows_the_modulus_equation(kelvin, bend):
    pressure = np.array([1e8, 1e9, 2e9])
    slope = np.log(SHEET(1e3, kelvin) / SHEET(0.0, kelvin)) / 1e3
    expected = SHEET(0.0, kelvin) * np.exp(pressure / (1.0 / slope + bend * pressure))
    assert SHEET(pressure, kelvin) == approx(expected, rel=1e-3)


@pytest.mark.parametrize("oil", [SHEET, AstmD341(0.1, 1e-6, 2500.0, 1e-7, 500.0, 1e-3)], ids=["usual", "extreme"])
def test_an_oil_of_a_data_sheet_does_not_overflow(oil):
    pressure = np.concatenate([[0.0], np.logspace(3, np.log10(2e10), 100)])[:, None]
    found = oil(pressure, np.linspace(230.0, 900.0, 68))
    assert np.all(np.isfinite(found) & (found > 0.0))
    assert np.all(np.diff(found, axis=0) >= 0.0)
    assert np.all(np.diff(found, axis=1) <= 0.0)


def test_density_rises_from_one_to_no_more_than_a_third_above():
    law = DowsonHigginson()
    assert law(np.array([0.0, 5.9e8, 1e15])) == approx([1.0, 1.17, 1.34], rel=1e-6)
    assert law(np.array([1e3]))[0] - 1.0 == approx(0.34 * 1e3 / 5.9e8, rel=1e-4, abs=0.0)


def test_an_incompressible_lubricant_keeps_its_density():
    assert np.array_equal(Incompressible()(PRESSURE), np.ones((5, 8)))


FLUID = Eyring(eyring_stress=5e6, limiting_coefficient=0.047)


def stress(viscosity: float, rate: float, pressure: float) -> float:
    return float(FLUID(np.array([viscosity * rate]), np.array([pressure]))[0])


def test_a_slow_film_is_newtonian():
    assert stress(0.1, 1e3, 1e9) == approx(100.0, rel=1e-9)


def test_a_fast_film_thins_by_eyring():
    assert stress(10.0, 1e7, 1e9) == approx(5e6 * np.arcsinh(20.0), rel=1e-14)


def test_no_film_carries_more_than_the_limiting_shear_stress():
    assert stress(1e6, 1e9, 0.2e9) == approx(0.047 * 0.2e9, rel=1e-14)
    assert stress(1e6, 1e9, 0.0) == 0.0


def test_the_film_pulls_with_the_sliding():
    rate = np.linspace(-1e8, 1e8, 11)
    forward = FLUID(3.0 * rate, np.full(11, 1e9))
    assert np.array_equal(forward, -forward[::-1])
    assert np.all(np.diff(forward) > 0.0)
    assert forward[5] == 0.0


LAYERED = ElasticPerfectlyPlastic(hardness=6e9, film_hardness=2e9)
FULL = 100e-9


def limit(film_1: float, film_2: float, depth: float) -> float:
    return float(LAYERED.limit(np.array([film_1]), np.array([film_2]), np.array([depth]), FULL)[0])


def test_without_depth_the_hardness_falls_from_the_solids_to_the_full_films_with_the_thicker_film():
    thicker, none = np.array([0.0, 25e-9, 100e-9]), np.zeros(3)
    for thinner in (none, thicker):
        assert LAYERED.limit(thicker, thinner, none, FULL) == approx([6e9, 5e9, 2e9], rel=1e-15)
        assert LAYERED.limit(thinner, thicker, none, FULL) == approx([6e9, 5e9, 2e9], rel=1e-15)


@pytest.mark.parametrize(
    ("depth", "expected"),
    [
        (20e-9, 6e9 - 4e9 * 60e-9 / FULL),  # in the thicker film: 80 - 20 nm of it are left
        (50e-9, 6e9 - 4e9 * 30e-9 / FULL),  # first joint, |h1 - h2|: from both sides 80 - 50 = (110 - 50) / 2
        (70e-9, 6e9 - 4e9 * 20e-9 / FULL),  # in both films: half of what is left of the two
        (110e-9, 6e9),  # second joint, h1 + h2: through both
        (200e-9, 6e9),  # in the steel
    ],
)
def test_a_hardness_is_that_of_the_layer_that_the_plastic_depth_has_reached(depth, expected):
    assert limit(80e-9, 30e-9, depth) == approx(expected, rel=1e-14)
    assert limit(30e-9, 80e-9, depth) == approx(expected, rel=1e-14)


def test_no_film_is_softer_than_a_full_one():
    assert limit(3.0 * FULL, 0.0, 0.0) == limit(3.0 * FULL, 3.0 * FULL, 0.0) == 2e9


def test_plastic_depth_is_left_out_of_the_hardness_unless_asked_for():
    assert LAYERED.indentation == "none"


BLEND = FilmBlend(bare=0.13, film=0.115, slip_speed=1e-4)


def test_boundary_friction_lies_between_bare_and_full_film():
    pressure = np.full(3, 1e9)
    found = BLEND(pressure, np.array([0.0, 0.5, 1.0]), 0.02)
    assert found == approx([0.13e9, 0.1225e9, 0.115e9], rel=1e-12)


def test_boundary_friction_is_odd_in_sliding_and_fades_over_the_slip_speed():
    pressure, cover = np.array([1e9]), np.array([0.3])
    assert BLEND(pressure, cover, -3e-5)[0] == -BLEND(pressure, cover, 3e-5)[0]
    assert BLEND(pressure, cover, 0.0)[0] == 0.0
    assert BLEND(pressure, cover, 1e-4)[0] / BLEND(pressure, cover, 1.0)[0] == approx(np.tanh(1.0), rel=1e-14)


WEAR = Archard(bare=1e-5, film=1e-6)


def test_wear_is_linear_in_pressure_and_sliding_and_blind_to_direction():
    pressure, bare = np.array([[1e9, 2e9]]), np.zeros((1, 2))
    rate = WEAR.rate(pressure, bare, (0.255, 0.25), 0, 6e9, FULL)
    assert rate == approx(np.array([[1e-5 / 6.0 * 0.005, 1e-5 / 3.0 * 0.005]]), rel=1e-12, abs=0.0)
    assert np.array_equal(WEAR.rate(pressure, bare, (0.25, 0.255), 0, 6e9, FULL), rate)
    assert WEAR.rate(pressure, bare, (0.26, 0.25), 0, 6e9, FULL) == approx(2.0 * rate, rel=1e-12, abs=0.0)


def test_both_bodies_slide_at_the_difference_of_their_speeds():
    for speeds, slide in (((0.3, 0.1), 0.2), ((0.1, 0.3), 0.2), ((-0.1, 0.3), 0.4), ((0.2, 0.2), 0.0)):
        assert WEAR.slide(speeds, 0) == WEAR.slide(speeds, 1) == approx(slide, rel=1e-14)


def test_by_surface_speed_a_body_slides_the_contact_length_in_each_pass_whatever_the_slide_to_roll_ratio():
    law = Archard(bare=1e-5, film=1e-6, sliding="surface_speed")
    for ratio in (-0.1, 0.0, 0.1):
        speeds = 0.25 * (1.0 + ratio / 2.0), -0.25 * (1.0 - ratio / 2.0)
        for body in (0, 1):
            assert law.slide(speeds, body) * (1e-4 / abs(speeds[body])) == approx(1e-4, rel=1e-14, abs=0.0)


def test_by_surface_speed_the_faster_ball_wears_more_at_any_sign_of_sliding():
    law = Archard(bare=1e-5, film=1e-6, sliding="surface_speed")
    ratios = np.array([-0.1, -0.05, -0.02, -0.005, 0.005, 0.02, 0.05, 0.1])
    speeds = [(0.25 * (1.0 + ratio / 2.0), 0.25 * (1.0 - ratio / 2.0)) for ratio in ratios]
    ball = [law.rate(np.array([1e9]), np.zeros(1), pair, 0, 6e9, FULL)[0] for pair in speeds]
    disc = [law.rate(np.array([1e9]), np.zeros(1), pair, 1, 6e9, FULL)[0] for pair in speeds]
    assert np.all(np.diff(ball) > 0.0)
    assert np.all(np.diff(disc) < 0.0)
    assert ball[-1] / ball[0] == approx(0.2625 / 0.2375, rel=1e-12)


def test_a_full_tribofilm_wears_with_its_own_coefficient():
    cover = np.array([0.0, 0.5, 1.0])
    assert WEAR.coefficient(cover, FULL) == approx([1e-5, 5.5e-6, 1e-6], rel=1e-14, abs=0.0)
    rate = WEAR.rate(np.full(3, 1e9), cover, (1.0, 0.0), 1, 6e9, FULL)
    assert rate / rate[0] == approx([1.0, 0.55, 0.1], rel=1e-14)


def test_wear_coefficients_are_those_of_the_source_in_cubic_millimetres_per_newton_metre():
    # m of depth per Pa and m of sliding = m2/N
    per_pascal = WEAR.rate(np.ones(2), np.array([0.0, 1.0]), (1.0, 0.0), 0, 6e9, FULL)
    assert per_pascal * 1e9 == approx([1.7e-6, 1.7e-7], abs=0.05e-6)


def test_what_is_switched_off_gives_zeros():
    assert not NoWear().rate(PRESSURE, PRESSURE, (1.0, 0.0), 0, 6e9, FULL).any()
    assert not NoWear().coefficient(PRESSURE, FULL).any()
    assert NoWear().slide((1.0, 0.0), 0) == 0.0
    growth, removal = NoTribofilm().evolve(*np.zeros((2, 2, 3)), *np.full((2, 2, 3), 1e4), 363.15)
    assert not thickness(growth, removal).any()
    assert not NoTribofilm().exposure(PRESSURE, PRESSURE, 1.0, 363.15).any()
    assert NoTribofilm().covers(230.0)
    assert NoTribofilm().refusal(230.0) == ""


FILM = Ghanbarzadeh(176e-9, 4.13e-16, 112.5e-9, 6.799e-4, 363.15)


def test_a_point_that_is_not_rubbed_keeps_its_film():
    growth, removal = np.array([0.0, 50e-9]), np.array([0.0, 20e-9])
    after = FILM.evolve(growth, removal, np.zeros(2), np.zeros(2), 363.15)
    assert np.array_equal(after[0], growth)
    assert np.array_equal(after[1], removal)


def test_a_film_never_gets_thinner_than_nothing():
    assert np.array_equal(thickness(np.array([3.0, 1.0]), np.array([1.0, 3.0])), [2.0, 0.0])


SOLID = np.array([0.0, 0.0, 1.0, 2e9])
SHEAR = np.array([50e6, 150e6, 50e6, 250e6])


def test_a_film_grows_where_solids_touch_at_the_rate_of_the_node_s_temperature():
    law = replace(FILM, dose="clock")
    assert np.array_equal(law.exposure(SOLID, SHEAR, 0.005, 363.15), law.rate(363.15) * np.array([0.0, 0.0, 1.0, 1.0]))
    warm = np.array([353.15, 353.15, 363.15, 373.15])
    assert law.exposure(SOLID, SHEAR, 0.005, warm)[2:] == approx(law.rate(warm)[2:], rel=1e-15)


def test_time_in_solid_contact_counts_over_its_share_in_the_tests_of_the_fit():
    assert FILM.dose == "residence"
    law = replace(FILM, contact_share=2e-3)
    found, tested = (one.exposure(SOLID, SHEAR, 0.005, 363.15) for one in (law, replace(law, dose="clock")))
    assert 2e-3 * found == approx(tested, rel=1e-15)


def test_supply_caps_the_growth_of_every_law_by_the_same_speed():
    laws = FILM, Andersson(176e-9, 2e-13, 0.0, 363.15), Gosvami(200e-9, 6e3, 1.28e-19, 3.8e-30, 2e-8)
    for law in (replace(law, supply_rate=2e-10) for law in laws):
        film = law.evolve(np.zeros(1), np.zeros(1), np.full(1, 1e-3 * law.most_exposure), np.zeros(1), 363.15)
        assert film[0][0] == approx(2e-13, rel=1e-5, abs=0.0)


@pytest.mark.parametrize(("least", "expected"), [(100e6, [0, 1, 1, 1]), (200e6, [0, 0, 1, 1]), (0.0, [1, 1, 1, 1])])
def test_enough_shear_stress_rubs_a_film_through_oil_if_asked_for(least, expected):
    law = replace(FILM, dose="clock", nodes="stressed", least_shear=least)
    rate = law.rate(363.15)
    assert np.array_equal(law.exposure(SOLID, SHEAR, -0.005, 363.15) / rate, expected)
    alone = replace(law, nodes="contacts").exposure(SOLID, SHEAR, -0.005, 363.15)
    assert np.array_equal(alone / rate, [0.0, 0.0, 1.0, 1.0])


ENERGY = Andersson(176e-9, 2e-13, 1e5, 363.15)


def test_frictional_power_above_the_threshold_exposes_nodes_in_contact():
    assert ENERGY.dose == "residence"
    assert ENERGY.exposure(SOLID, SHEAR, 0.005, 363.15) == approx([0.0, 0.0, 1.5e5, 11.5e5], rel=1e-12, abs=0.0)
    assert np.array_equal(ENERGY.exposure(SOLID, SHEAR, -0.005, 363.15), ENERGY.exposure(SOLID, SHEAR, 0.005, 363.15))
    assert not ENERGY.exposure(SOLID, SHEAR, 0.0001, 363.15).any()


def test_friction_forms_a_volume_in_proportion_to_its_energy_until_the_film_is_full():
    zero = np.zeros(3)
    energy = np.array([1.0, 1e3, 1e9])  # J/m2
    growth, removal = ENERGY.evolve(zero, zero, energy, zero, 363.15)
    assert growth[:2] == approx(2e-13 * energy[:2], rel=1e-3, abs=0.0)
    assert growth[2] == 176e-9
    assert not removal.any()


@pytest.mark.parametrize("law", [FILM, ENERGY])
def test_film_constants_hold_within_five_kelvin(law):
    assert law.covers(368.15)
    assert law.covers(358.15)
    assert not law.covers(368.2)
    assert not law.covers(358.1)
    assert law.refusal(368.15) == law.refusal(358.15) == ""


@pytest.mark.parametrize(("law", "extrapolated"), [(FILM, "+-6 %"), (ENERGY, "as it is")])
def test_another_temperature_is_refused_with_what_would_be_right(law, extrapolated):
    sentence = law.refusal(343.15)
    for said in (
        "temperature = 343.15 K",
        "358.15 K to 368.15 K",
        "tribofilm.fit_temperature = 363.15 K",
        "Use a set fitted at that temperature",
        "tribofilm.beyond_fit = 'extrapolate'",
        extrapolated,
    ):
        assert said in sentence
    beyond = replace(law, beyond_fit="extrapolate")
    assert beyond.refusal(343.15) == ""
    assert not beyond.covers(343.15)


@pytest.mark.parametrize("degrees", range(20, 200, 10))
def test_a_border_of_five_kelvin_survives_rounding(degrees):
    law = replace(FILM, fit_temperature=degrees + 273.15)
    assert law.covers(degrees + 5.0 + 273.15)
    assert law.covers(degrees - 5.0 + 273.15)


def test_extrapolation_changes_the_rate_by_six_percent_between_sixty_and_a_hundred_degrees():
    rates = np.array([FILM.rate(t) for t in (333.15, 373.15)]) / FILM.rate(353.15)
    assert rates == approx([0.943, 1.057], abs=1e-3)


@dataclass(frozen=True)
class PerPascal(Archard):
    """A law whose coefficient has another unit than its rate asks for."""

    name: ClassVar[str] = "per_pascal"

    def rate(self, pressure, cover, speeds, body, hardness, full_thickness):
        return super().rate(pressure, cover, speeds, body, 1.0, full_thickness)


def test_a_law_that_is_put_into_a_scene_has_to_agree_with_itself_and_be_in_range():
    scene = Scene.from_toml("mtm_zddp", {"film.model": "regression"})
    state, op = initial_state(scene), scene.operation.point
    off, beyond = (replace(scene, wear=law) for law in (PerPascal(1e-5, 1e-6), Archard(-5.0, 1e-6)))
    with pytest.raises(SceneError, match=r"wear\.model = 'per_pascal' contradicts itself"):
        advance(off, op, state, 1.0)
    with pytest.raises(SceneError, match=r"wear\.bare = -5 \(.*\) must be at least 0"):
        advance(beyond, op, state, 1.0)
