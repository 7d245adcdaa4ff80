"""Safety of gears against micropitting and scuffing: formulas by hand, scaling, and what tests of oils must give."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from closed_forms import blok_line
from comparison import approx

from contact_core import Scene
from contact_core.reference import hertz_line
from system_models.machines.gear_pair import micropitting, scuffing
from system_models.machines.gear_pair.geometry import FZG_A, FZG_C, FZG_STAGES, load_stages
from system_models.machines.gear_pair.rating import Rating
from system_models.machines.gear_pair.safety import Safeties
from system_models.machines.gear_pair.sharing import Sharing
from system_models.machines.gear_pair.textbook import schlenk
from system_models.machines.gear_pair.working import Working

OIL = Scene.from_toml("fzg_flank").lubricant.viscosity
HOT = 363.15
FRICTIONLESS = Rating(oil_factor=0.0)
SMOOTH = Sharing("elastic")


def type_c(stage: int, rating: Rating | None = None, **changes) -> Working:
    """As in FVA 54/7."""
    torque, speed = FZG_STAGES[0.35][stage - 1], 2250.0 * math.pi / 30.0
    return replace(
        Working(FZG_C, SMOOTH, torque, speed, HOT, OIL, 0.5e-6, rating or Rating(supply_factor=1.2)), **changes
    )


def type_a(stage: int, failing: int = 10, **changes) -> Working:
    """As in A/8.3/90."""
    torque, speed = FZG_STAGES[0.5][stage - 1], 2170.0 * math.pi / 30.0
    return replace(Working(FZG_A, SMOOTH, torque, speed, HOT, OIL, 0.35e-6, Rating(scuffing_stage=failing)), **changes)


def blok(working: Working, friction: float) -> np.ndarray:
    """Blok's flash temperature at all places."""
    u1, u2 = working.speeds
    width, modulus = working.pair.face_width, working.pair.reduced_modulus
    return np.array([
        blok_line(f, width, friction, a, b, hertz_line(f, r, width, modulus).a, 435.0 * math.sqrt(1000.0))
        for f, r, a, b in zip(working.load, working.radius, u1, u2, strict=True)
    ])  # fmt: skip


def beside_c(working: Working) -> int:
    return int(np.abs(working.places - working.pair.pitch_point).argmin())


# micropitting


def test_the_film_by_hand_in_the_units_of_the_standard():
    """At A of load stage 10: h = 1600 rho G^0.6 U^0.7 W^-0.13 S^0.22, in um from N, mm, s; viscosities of the oil."""
    working = type_c(10)
    found = micropitting.films(working)
    bulk, contact = found.bulk, float(found.temperature[0])
    own = 1.0 / (32.77918e6 + 0.29862e6 * 37.85)  # FVA 3 at 311 K, Wingertszahn et al. 2023

    def alpha(t):
        return own * (1.0 + 516.0 * (1.0 / t - 1.0 / 311.0))

    rho, pressure, modulus = 1e3 * working.radius[0], 1e-6 * working.pressure[0], 206000.0 / 0.91
    g = 1e6 * alpha(bulk) * modulus
    u = OIL(0.0, bulk) * sum(speed[0] for speed in working.speeds) / (2000.0 * modulus * rho)
    w = 2.0 * math.pi * pressure**2 / modulus**2
    s = alpha(contact) * OIL(0.0, contact) / (alpha(bulk) * OIL(0.0, bulk))
    assert 1e6 * found.film[0] == approx(1600.0 * rho * g**0.6 * u**0.7 * w**-0.13 * s**0.22, rel=0.02)
    assert found.least == approx(found.film[0] / 0.5e-6)  # A is where it is thinnest


def test_the_measured_pressure_coefficient_of_the_oil_is_a_sixth_above_the_estimate_for_mineral_oils():
    """AGMA 925-A03: 0.010471 eta^0.1348 mm2/N, eta in mPa s; as Gold's, it is a secant."""
    found = micropitting.pressure_coefficient(OIL, np.array([311.0]))[0]
    assert 1e6 * found == approx(1.17 * 0.010471 * (1e3 * OIL(0.0, 311.0)) ** 0.1348, rel=0.05)


def test_without_friction_films_follow_speed_and_load_by_their_powers_and_nothing_is_warmed():
    usual = type_c(8, FRICTIONLESS)
    film = micropitting.films(usual)
    assert film.bulk == HOT
    assert film.temperature == approx(HOT)
    faster = micropitting.films(replace(usual, speed=2.0 * usual.speed))
    heavier = micropitting.films(replace(usual, torque=2.0 * usual.torque))
    np.testing.assert_allclose(faster.film, 2.0**0.7 * film.film, rtol=1e-12)
    np.testing.assert_allclose(heavier.film, 2.0**-0.13 * film.film, rtol=1e-12)
    rougher = micropitting.films(replace(usual, ra=1e-6))
    np.testing.assert_allclose(rougher.ratio, 0.5 * film.ratio, rtol=1e-12)


def test_flash_is_bloks_along_the_path_and_none_where_flanks_roll():
    working = type_c(9)
    friction = micropitting.mean_friction(working)
    found = micropitting.flash(working, friction)
    np.testing.assert_allclose(found, blok(working, friction), rtol=0.02)
    assert found[beside_c(working)] < 1e-4 * found.max()


def test_the_bulk_temperature_by_hand():
    """Load stage 10: 62.44 kW, H_V = 0.195, 91.5 mm x 14 mm."""
    working = type_c(10)
    friction = micropitting.mean_friction(working)
    rise = 7400.0 * (62.44 * friction * 0.195 / (91.5 * 14.0)) ** 0.72
    assert micropitting.bulk_temperature(working, friction) - HOT == approx(rise, rel=1e-3)  # 1.2 / 1.2: oil jet
    assert 0.8 < friction / schlenk(FZG_C, working.force, working.speed, working.oil_viscosity, 0.5e-6) < 1.3


@pytest.mark.parametrize("failing", [6, 8, 10])
def test_gears_as_in_the_oils_own_test_have_the_films_that_it_fails_with_at_its_load_stage(failing):
    """And a safety of 1 / (1.4 W_W) there, more before and less after it."""
    rating = Rating(micropitting_stage=failing, supply_factor=1.2)
    limit = micropitting.limit(type_a(5, rating=rating))  # whatever gears ask
    least = {stage: micropitting.films(type_c(stage, rating)).least for stage in (failing - 1, failing, failing + 1)}
    assert least[failing - 1] > least[failing] > least[failing + 1]
    assert least[failing] == approx(limit, rel=1e-12)
    assert micropitting.safety(least[failing], limit, 1.5) == approx(1.0 / 2.1)


def test_classes_of_load_stages():
    by_stage = {stage: micropitting.gf_class(stage) for stage in (5, 7, 8, 9, 10)}
    assert by_stage == {5: "low", 7: "low", 8: "medium", 9: "medium", 10: "high"}
    assert micropitting.gf_class(None) == "high"
    assert load_stages((28.79, 265.4)) == [3, 10]
    assert load_stages((3.3, 135.3)) == [1, 6]
    assert load_stages((28.79, 135.3)) is load_stages((135.3,), (0.35,)) is None


# scuffing


def test_flash_of_scuffing_is_bloks_but_for_the_approach_before_the_pitch_point():
    working = type_a(9)
    found, expected = scuffing.flash(working), blok(working, scuffing.mean_friction(working))
    after = working.places > FZG_A.pitch_point
    np.testing.assert_allclose(found[after], expected[after], rtol=0.04)
    np.testing.assert_allclose(found, expected * scuffing.approach_factor(working), rtol=0.04)
    assert found[beside_c(working)] < 1e-4 * found.max()


def test_teeth_approach_softly_with_the_relief_that_they_bend_by():
    working = type_a(9)
    assert scuffing.approach_factor(working).max() > 1.0001
    best = scuffing.best_relief(working)
    assert 5e-6 < best < 50e-6
    relieved = replace(working, sharing=Sharing("elastic", best, best, 3e-3, 3e-3))
    assert scuffing.approach_factor(relieved) == approx(1.0)


def test_the_torques_of_the_test_are_those_of_its_formula():
    """The limit of the integral temperature by hand: stage 8, 238.5 Nm, an oil of 99.4 mm2/s."""
    for stage, torque in enumerate(FZG_STAGES[0.5][:12], 1):
        assert stage < 4 or 3.726 * stage**2 == approx(torque, rel=0.02)
    found = scuffing.by_integral(type_a(5, failing=8))
    assert found.limit - 273.15 == approx(80.0 + 0.23 * 238.5 + 1.5 * 0.2 * 238.5, rel=1e-3)


def test_the_scuffing_temperature_by_hand():
    """Stage 10, 12.85 mPa s: 80 + 2.25 12.85^-0.05 100 degC; nitrided steel, 80 + 2.95 ..."""
    assert scuffing.scuffing_temperature(type_a(5)) - 273.15 == approx(80.0 + 225.0 * 12.85**-0.05, rel=1e-3)
    nitrided = type_a(5, rating=Rating(scuffing_stage=10, structural_factor=1.5))
    assert scuffing.scuffing_temperature(nitrided) - 273.15 == approx(80.0 + 295.0 * 12.85**-0.05, rel=1e-3)


@pytest.mark.parametrize("stage", [5, 7, 9, 11])
def test_oils_are_just_not_safe_at_the_load_stage_that_they_fail(stage):
    """By both methods, within what separates them from the tests that they were fitted to."""
    working = type_a(stage, failing=stage)
    integral = scuffing.by_integral(working)
    assert scuffing.by_flash(working).safety == approx(1.0, abs=0.2)
    assert integral.safety == approx(1.0, abs=0.25)
    assert scuffing.by_flash(type_a(stage + 1, failing=stage)).safety < scuffing.by_flash(working).safety


@pytest.mark.parametrize("pair", [FZG_A, FZG_C])
def test_the_contact_ratio_factor_is_about_the_mean_flash_over_that_at_the_tip(pair):
    """With a load that rises from a third to two thirds while two pairs of teeth carry, to the power of 3/4."""
    place = np.linspace(pair.start, pair.end, 4001)
    other = pair.line_length - place
    shape = np.abs(np.sqrt(place) - np.sqrt(other / pair.ratio)) / (place * other) ** 0.25
    inside = np.minimum(place - pair.start, pair.end - place) / (pair.single_start - pair.start)
    load = np.where(inside < 1.0, (1.0 + inside) / 3.0, 1.0)
    mean = np.trapezoid(load**0.75 * shape, place) / (pair.end - pair.start)
    found = scuffing.contact_ratio_factor(*type_c(8, pair=pair).contact_ratios)
    assert found == approx(mean / shape[-1], rel=0.15)


@pytest.mark.parametrize("other", [0.2, 0.5, 0.9])
def test_the_contact_ratio_factor_goes_on_smoothly_where_its_formulas_meet(other):
    at, below = scuffing.contact_ratio_factor(1.0, other), scuffing.contact_ratio_factor(1.0 - 1e-9, other)
    assert at == approx(below)
    at, below = scuffing.contact_ratio_factor(other, 1.0), scuffing.contact_ratio_factor(other, 1.0 - 1e-9)
    assert at == approx(below)


def test_the_bulk_is_the_oil_and_a_part_of_the_mean_flash():
    """0.47 of that along the path, or 0.7 of that of the integral temperature, of which the contact has 1.5 more."""
    working = type_a(8)
    rise, integral = working.mean(scuffing.flash(working)), scuffing.by_integral(working)
    assert scuffing.by_flash(working).bulk - HOT == approx(0.47 * rise)
    assert (integral.bulk - HOT) / (integral.temperature - integral.bulk) == approx(0.7 / 1.5)


def test_a_jet_of_oil_lets_the_bulk_rise_by_a_fifth_more():
    bath, jet = (scuffing.by_flash(type_a(8, rating=Rating(supply_factor=factor))) for factor in (1.0, 1.2))
    assert jet.bulk - HOT == approx(1.2 * (bath.bulk - HOT))
    assert jet.temperature - jet.bulk == approx(bath.temperature - bath.bulk)


def test_contacts_no_hotter_than_the_oil_are_safe():
    assert scuffing.margin(500.0, 400.0, 350.0) == 3.0
    assert scuffing.margin(500.0, 350.0, 350.0) == math.inf


@pytest.mark.parametrize(("first", "second"), [(1.3, 0.9), (0.4, 0.4), (1.4, -0.1)])
def test_contact_ratios_that_the_integral_method_is_not_for_have_none(first, second):
    assert scuffing.contact_ratio_factor(first, second) is None


def test_teeth_approach_with_the_relief_of_the_wheels_tip():
    """Before C the wheel's tip meets the pinion's root, whatever the relief of the pinion's tip."""
    working = type_a(9)
    best = scuffing.best_relief(working)
    on_pinion = replace(working, sharing=Sharing("elastic", relief_1=best, relief_length_1=3e-3))
    on_wheel = replace(working, sharing=Sharing("elastic", relief_2=best, relief_length_2=3e-3))
    np.testing.assert_allclose(scuffing.approach_factor(on_pinion), scuffing.approach_factor(working), rtol=1e-12)
    assert scuffing.approach_factor(on_wheel) == approx(1.0)


def with_contact_ratios(first: float, second: float, eased: bool = False) -> Working:
    """Gears as of type C but for the tips, which give these contact ratios after and before C; relieved by C_eff."""
    pair = FZG_C
    after = pair.pitch_point + first * pair.base_pitch
    before = pair.line_length - pair.pitch_point + second * pair.base_pitch
    tips = {
        "tip_diameter_1": 2.0 * math.hypot(pair.base_radius_1, after),
        "tip_diameter_2": 2.0 * math.hypot(pair.base_radius_2, before),
    }
    working = type_c(8, pair=replace(pair, **tips))
    best = scuffing.best_relief(working)
    return replace(working, sharing=Sharing("elastic", best, best, 3e-3, 3e-3)) if eased else working


@pytest.mark.parametrize(
    ("second", "entry", "tips"), [(0.25, 1.0, 1.035), (0.75, 1.0, 1.05625), (1.125, 0.8, 1.0928125), (1.5, 0.6, 1.135)]
)
def test_the_flash_at_the_tip_rises_with_the_contact_ratio_before_c(second, entry, tips):
    """X_Q falls from 1 at 1.5 times the contact ratio after C to 0.6 at 3; X_Ca = 1 + 0.06 e + 0.02 e^2, larger e."""
    found = scuffing.tip_flash(with_contact_ratios(0.5, second)) / scuffing.tip_flash(with_contact_ratios(0.5, 0.5))
    assert found == approx(1.035 / (entry * tips))


@pytest.mark.parametrize(("first", "second"), [(1.1, 0.25), (0.7, 1.0)])
def test_relief_of_the_tips_counts_by_the_larger_contact_ratio(first, second):
    """X_Ca = 1 + 0.24 e + 0.71 e^2 with C_a = C_eff: 2.1231 for 1.1, 1.95 for 1; without relief 1.0902 and 1.08."""
    sharp, eased = (scuffing.tip_flash(with_contact_ratios(first, second, each)) for each in (False, True))
    assert sharp / eased == approx({1.1: 2.1231 / 1.0902, 1.0: 1.95 / 1.08}[max(first, second)])


def test_load_stages_before_the_failing_one_have_thicker_films():
    """One stage before that at which an oil fails is the stage at which a weaker one does."""
    working = type_a(5, rating=Rating(micropitting_stage=8))
    weaker = type_a(5, rating=Rating(micropitting_stage=7))
    assert micropitting.limit(working, 1) == micropitting.limit(weaker) > micropitting.limit(working)


def test_gears_of_a_worse_material_need_thicker_films_for_the_same_class():
    """W_W times the geometric mean of the ratios at which the oil still passes and fails."""
    assembly = SimpleNamespace(reported={"rating": Rating(material_factor=1.5)})
    assert Safeties(SimpleNamespace(assembly=assembly))._needed(0.2 * 0.8) == approx(1.5 * 0.4)
