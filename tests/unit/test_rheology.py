from dataclasses import replace

import numpy as np
import pytest
from comparison import approx

from contact_core.laws.rheology import Carreau, Eyring, Newtonian

EXPONENTS = (1.0, 0.8, 0.5, 0.3, 0.1, 0.01)
LAWS = [Newtonian(), Eyring(5e6), *(Carreau(2e6, n) for n in EXPONENTS)]
THINNING = [law for law in LAWS if law.thins and getattr(law, "exponent", 0.0) != 1.0]
NEWTONIAN = np.concatenate([[0.0], np.logspace(-3, 12, 301)])  # Pa
PRESSURE = np.full_like(NEWTONIAN, 1e9)
LIMIT = 0.05

by_name = pytest.mark.parametrize("law", LAWS, ids=repr)


@by_name
def test_a_gentle_shear_is_newtonian(law):
    gentle = np.array([1.0, 1e3])
    assert law(gentle, np.full(2, 1e9)) == approx(gentle, rel=1e-6)
    assert law.ease(gentle) == approx(1.0, rel=1e-6)
    assert law.slopes(gentle, np.full(2, 1e9))[0] == approx(1.0, rel=1e-6)


@by_name
def test_ease_undoes_the_law(law):
    stress = law(NEWTONIAN, PRESSURE)
    rounding = 1e-14 / getattr(law, "exponent", 1.0)  # the inverse of a power n magnifies rounding by 1 / n
    assert law.ease(stress) * stress == approx(NEWTONIAN, rel=10.0 * rounding, abs=0.0)
    assert np.array_equal(law.ease(-stress), law.ease(stress))


@pytest.mark.parametrize("exponent", [1.0, 0.9, 0.5, 0.1, 0.01, 1e-3, 1e-6, 1e-300])
@pytest.mark.parametrize("critical", [1e3, 1e6, 1e9])
def test_carreaus_law_can_be_inverted_for_any_exponent_and_stress(exponent, critical):
    law = Carreau(critical, exponent)
    around = critical * (1.0 + np.linspace(-1e-3, 1e-3, 21))
    stress = np.concatenate([[0.0], np.logspace(-12, 9, 400), around, np.nextafter(critical, [0.0, np.inf])])
    ease = law.ease(stress)
    assert np.all(np.isfinite(ease) & (ease >= 1.0))
    flows = ease < np.exp(499.0)
    assert np.count_nonzero(flows) > 100
    assert law((ease * stress)[flows], stress[flows]) == approx(stress[flows], rel=1e-12, abs=0.0)


@pytest.mark.parametrize("law", THINNING, ids=repr)
def test_more_stress_thins_more_up_to_a_cap_far_beyond_any_oil(law):
    ease = law.ease(np.logspace(5, 12, 200))
    assert np.all(np.diff(ease) >= 0.0)
    assert 10.0 < ease[-1] <= np.exp(500.0)


@by_name
@pytest.mark.parametrize("limit", [0.0, LIMIT])
def test_slopes_are_those_of_finite_differences(law, limit):
    law = replace(law, limiting_coefficient=limit)
    newtonian, pressure = np.logspace(0, 11, 56), np.full(56, 1e9)
    newtonian = np.concatenate([-newtonian[::-1], newtonian])
    pressure = np.concatenate([pressure, pressure])
    by_newtonian, by_pressure = law.slopes(newtonian, pressure)
    step, rise = 1e-5 * np.abs(newtonian), 1e4
    differences = (law(newtonian + step, pressure) - law(newtonian - step, pressure)) / (2.0 * step)
    assert by_newtonian == approx(differences, rel=1e-7, abs=1e-12)
    differences = (law(newtonian, pressure + rise) - law(newtonian, pressure - rise)) / (2.0 * rise)
    assert by_pressure == approx(differences, rel=1e-7, abs=1e-12)
    assert np.any(by_pressure != 0.0) == (limit > 0.0 and np.abs(law(newtonian, pressure)).max() >= limit * 1e9)


@by_name
@pytest.mark.parametrize("limit", [0.0, LIMIT])
def test_stress_is_odd_and_slopes_by_shear_are_even(law, limit):
    law = replace(law, limiting_coefficient=limit)
    assert np.array_equal(law(-NEWTONIAN, PRESSURE), -law(NEWTONIAN, PRESSURE))
    forward, backward = law.slopes(NEWTONIAN, PRESSURE), law.slopes(-NEWTONIAN, PRESSURE)
    assert np.array_equal(backward[0], forward[0])
    assert np.array_equal(backward[1], -forward[1])
    assert law(np.zeros(1), np.zeros(1))[0] == 0.0


@by_name
def test_the_limit_is_reached_and_never_passed(law):
    stress = replace(law, limiting_coefficient=LIMIT)(NEWTONIAN, PRESSURE)
    free = law(NEWTONIAN, PRESSURE)
    assert np.array_equal(stress, np.minimum(free, LIMIT * 1e9))
    if free[-1] > LIMIT * 1e9:
        assert stress[-1] == LIMIT * 1e9


@by_name
def test_an_oil_as_stiff_as_glass_does_not_overflow(law):
    newtonian = np.array([1e100, 1e200, 1e230])  # e^500 times a mineral oil's viscosity, sheared fast
    stress, slope = law(newtonian, np.full(3, 1e9)), law.slopes(newtonian, np.full(3, 1e9))[0]
    assert np.all(np.isfinite(stress) & (stress > 0.0) & (stress <= newtonian))
    assert np.all(np.isfinite(slope) & (slope >= 0.0) & (slope <= 1.0))


def test_a_fast_carreau_film_thins_by_the_power():
    law = Carreau(1e6, 0.4)
    assert law(np.array([1e12]), np.array([1e9]))[0] == approx(1e6 * 1e6**0.4, rel=1e-11)
    assert law.ease(np.array([1e6 * 1e6**0.4]))[0] == approx(1e6**0.6, rel=1e-11)


def test_a_carreau_film_of_exponent_one_is_newtonian():
    assert np.array_equal(Carreau(1e6, 1.0)(NEWTONIAN, PRESSURE), NEWTONIAN)


def test_a_fast_eyring_film_shears_exponentially_with_stress():
    assert Eyring(5e6).ease(np.array([50e6]))[0] == approx(np.sinh(10.0) / 10.0, rel=1e-14)


@by_name
def test_a_warm_oil_slips_at_less_stress_than_one_of_40_degrees(law):
    law = replace(law, limiting_coefficient=LIMIT)
    assert law.limiting_left(373.15) == 1.0
    falling = replace(law, limiting_fall=0.0055)
    assert falling.limiting_left(313.15) == 1.0
    warm = np.array([293.15, 353.15, 393.15])
    assert falling.limiting_left(warm) == approx(np.exp(-0.0055 * (warm - 313.15)), rel=1e-14)
    stress = falling(np.full(3, 1e200), 1e9 * falling.limiting_left(warm))
    assert stress == approx(LIMIT * 1e9 * falling.limiting_left(warm), rel=1e-14)


# tau_L [MPa] of mineral oils in disc machines at a mean pressure [GPa] and a temperature [degC]: Dyson 1970
DISCS = [(0.79, 40, 43.1), (0.79, 70, 31.4), (1.1, 40, 69.8), (1.1, 70, 53.6), (1.1, 100, 42.1)]


@pytest.mark.parametrize(("pressure", "celsius", "measured"), DISCS)
def test_the_limit_recommended_for_mineral_oils_bounds_what_discs_measure(pressure, celsius, measured):
    law = Newtonian(0.061, 0.0055)
    limit = law(np.array([1e20]), np.array([1e9 * pressure * law.limiting_left(celsius + 273.15)]))[0]
    assert 0.95 < limit / (1e6 * measured) < 1.5  # an Eyring oil stays below it where pressure is low
