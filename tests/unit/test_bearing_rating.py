"""Rating life of ball bearings: the standards' formulas against their tables, catalogues, closed forms and laws."""

import math
from dataclasses import replace

import numpy as np
import pytest
from closed_forms import sjovall
from comparison import approx

from contact_core.errors import ContactError
from system_models.machines.ball_bearing import rating
from system_models.machines.ball_bearing.equilibrium import RingLoads, solve
from system_models.machines.ball_bearing.geometry import BEARING_209, BEARING_218, BallBearingGeometry

RPM = math.pi / 30.0
# ISO 281:2007, Table 2, radial and angular contact: D cos a / d_m, f_c
TABLE_2 = {0.01: 29.1, 0.05: 46.7, 0.1: 55.5, 0.14: 58.8, 0.19: 60.0, 0.22: 59.6, 0.26: 58.2, 0.3: 56.0, 0.4: 48.4}


def bearing(**changes: float) -> BallBearingGeometry:
    return replace(BEARING_209, **{"clearance": 0.0, **changes})  # type: ignore[arg-type]


@pytest.mark.parametrize(("gamma", "factor"), TABLE_2.items())
def test_the_load_factor_is_that_of_the_standards_table(gamma: float, factor: float) -> None:
    assert rating.load_factor(bearing(pitch_diameter=12.7e-3 / gamma)) == approx(factor, rel=2e-3)


def test_bearing_209_has_about_the_rating_of_catalogues() -> None:
    own = rating.dynamic_rating(BEARING_209)
    assert 31.5e3 < own < 35.1e3  # 6209: 31.5 to 33.2 kN in older catalogues, 35.1 in SKF's (from memory)


def test_wider_grooves_bear_less() -> None:
    assert rating.dynamic_rating(bearing(conformity_inner=0.53)) < 0.95 * rating.dynamic_rating(bearing())


def test_catalogue_example_of_6309() -> None:
    # SKF, Rolling Bearings, example 1: C = 55.3 kN, 10 kN, 3000 rpm: 169 million revolutions, 940 h
    life = rating.rating_life(55.3e3, 10e3)
    assert life == approx(169e6, rel=2e-3)
    assert life / 3000.0 / 60.0 == approx(940.0, rel=2e-3)


def test_life_falls_with_the_cube_of_the_load_of_all_balls() -> None:
    loads = np.array([900.0, 500.0, 0.0, 0.0, 500.0])
    one, two = (rating.reference_life(BEARING_209, 33e3, k * loads, k * loads) for k in (1.0, 2.0))
    assert float(one / two) == approx(8.0, rel=1e-12)


def test_without_load_life_has_no_end_and_takes_nothing_from_others() -> None:
    loads = np.array([[0.0, 0.0, 0.0], [500.0, 100.0, 0.0]])
    life = rating.reference_life(BEARING_209, 33e3, loads, loads)
    assert life[0] == math.inf
    assert rating.rating_life(33e3, 0.0) == math.inf
    assert rating.reference_load(33e3, life)[0] == 0.0
    assert rating.consumed(np.array([0.0, 9.0]), np.array([0.0, 100.0]), life[::-1]) == 0.0


def test_both_races_together_give_the_rating_of_the_bearing() -> None:
    # half of the balls carry with no clearance (epsilon = 0.5): that load distribution is what C_r is made for
    rest = solve(bearing(), RingLoads(0.0, 2000.0), 0.0)
    c = rating.dynamic_rating(bearing())
    life = rating.reference_life(bearing(), c, rest.load_inner, rest.load_outer)
    assert float(rating.reference_load(c, life)) == approx(2000.0, rel=0.01)


# 6 balls of 11.1 mm on 43.5 mm, C = 23.4 kN, 1 kN: published with the program github.com/minzhun/ISO16281
@pytest.mark.parametrize(("clearance", "life"), [(0.0, 12008.9256e6), (10e-6, 9323.8946e6)])
def test_published_examples_of_the_reference_life(clearance: float, life: float) -> None:
    geometry = BallBearingGeometry(
        balls=6,
        ball_diameter=11.1e-3,
        pitch_diameter=43.5e-3,
        conformity_inner=5.772 / 11.1,
        conformity_outer=5.883 / 11.1,
        clearance=clearance,
    )
    rest = solve(geometry, RingLoads(0.0, 1000.0), 0.0)
    found = rating.reference_life(geometry, 23.4e3, rest.load_inner, rest.load_outer)
    assert float(found) == approx(life, rel=4e-3)


def test_the_mean_load_of_many_balls_is_that_of_sjovalls_distribution() -> None:
    many = BallBearingGeometry(
        balls=120, ball_diameter=1e-3, pitch_diameter=65e-3, conformity_inner=0.52, conformity_outer=0.52
    )
    rest = solve(many, RingLoads(0.0, 100.0), 0.0)
    largest = 100.0 / (120.0 * sjovall(0.5)[0])
    angle = np.linspace(-0.5 * math.pi, 0.5 * math.pi, 20001)
    for power in (rating.TURNING, rating.STANDING):
        share = np.trapezoid(np.maximum(np.cos(angle), 0.0) ** (1.5 * power), angle) / (2.0 * math.pi)
        assert float(rating.mean_load(rest.load_inner, power)) == approx(largest * share ** (1.0 / power), rel=0.01)


def test_more_clearance_shortens_the_life_that_iso_281_does_not_see() -> None:
    lives = []
    for clearance in (0.0, 15e-6, 40e-6):
        geometry = bearing(clearance=clearance)
        rest = solve(geometry, RingLoads(0.0, 2000.0), 0.0)
        lives.append(float(rating.reference_life(geometry, 33e3, rest.load_inner, rest.load_outer)))
    assert lives[0] > lives[1] > lives[2]


def test_axial_loads_count_by_the_table_of_radial_and_of_angular_contact() -> None:
    assert rating.equivalent_load(BEARING_209, 2000.0, 0.0) == 2000.0
    area = 9 * 12.7**2  # mm2
    assert rating.equivalent_load(BEARING_209, 1000.0, 1.38 * area) == approx(560.0 + 1.45 * 1.38 * area)
    assert rating.equivalent_load(BEARING_218, 1000.0, 2000.0) == approx(0.35 * 1000.0 + 0.57 * 2000.0)
    assert rating.equivalent_load(BEARING_218, 1000.0, 1000.0) == 1000.0


def test_contact_angles_that_the_table_lacks_are_refused_with_what_is_known() -> None:
    with pytest.raises(ContactError, match=r"contact_angle = 15 degrees.*20 to 45"):
        rating.equivalent_load(bearing(contact_angle=math.radians(15.0)), 1.0, 1.0)


def test_the_fatigue_load_limit_presses_the_worst_contact_with_1500_mpa() -> None:
    limit = rating.fatigue_load_limit(BEARING_209)
    ball = limit / (0.2288 * 9)
    assert BEARING_209.inner.ellipse(ball).pressure_max == approx(1.5e9, rel=1e-9)
    assert BEARING_209.outer.ellipse(ball).pressure_max < 1.5e9
    assert limit == approx(rating.simple_fatigue_load_limit(BEARING_209), rel=0.2)
    assert limit == approx(0.915e3, rel=0.2)  # 6209 in SKF's catalogue (from memory)


def test_the_life_factor_is_below_that_of_skf_for_better_steel() -> None:
    # SKF's calculator for an Explorer bearing 6309: P_u = 1.34 kN, 4 kN, eta_c = 0.55, kappa = 2.08 give a_SKF = 20.7
    found = float(rating.life_factor(np.array(2.08), np.array(0.55 * 1.34 / 4.0)))
    assert 0.5 * 20.7 < found < 20.7


@pytest.mark.parametrize("edge", [0.4, 1.0])
def test_the_life_factor_has_no_step_where_its_formulas_meet(edge: float) -> None:
    below, above = (float(rating.life_factor(np.array(k * edge), np.array(0.2))) for k in (1.0 - 1e-9, 1.0 + 1e-9))
    assert below == approx(above, rel=2e-3)


def test_the_life_factor_ends_at_a_tenth_and_at_fifty() -> None:
    assert float(rating.life_factor(np.array(2.0), np.array(0.0))) == approx(0.1, rel=1e-12)
    assert float(rating.life_factor(np.array(2.0), np.array(5.0))) == 50.0
    beyond, most = (float(rating.life_factor(np.array(k), np.array(0.05))) for k in (40.0, 4.0))
    assert beyond == most


def test_the_reference_viscosity_is_about_that_of_the_diagram() -> None:
    # SKF's diagram in the example of 6309: 8.15 mm2/s at 3000 rpm and 72.5 mm; ISO's formula gives more
    found = float(rating.reference_viscosity(72.5e-3, np.array(3000.0 * RPM)))
    assert found == approx(4500.0e-6 / math.sqrt(3000.0 * 72.5), rel=1e-12)
    assert found == approx(8.15e-6, rel=0.2)
    slow, fast = (float(rating.reference_viscosity(72.5e-3, np.array(n * RPM))) for n in (999.999, 1000.0))
    assert slow == approx(fast, rel=0.03)


def test_miner_adds_revolutions_over_lives() -> None:
    time = np.array([0.0, 10.0, 30.0])
    speed = np.array([5.0, 2.0 * math.pi, -4.0 * math.pi])  # one turn a second, then two backward
    life = np.array([1.0, 100.0, 400.0])
    assert rating.consumed(time, speed, life) == approx(10.0 / 100.0 + 40.0 / 400.0, rel=1e-12)


def test_the_fatigue_load_limit_of_large_bearings_falls_behind_their_size() -> None:
    """C_u grows as the square of alike bearings, from d_m = 100 mm on times (100 / d_m)^0.5: ISO 281, B.3."""
    lengths = {"ball_diameter": BEARING_209.ball_diameter, "pitch_diameter": BEARING_209.pitch_diameter}
    large, larger = (
        bearing(**{name: size * pitch / BEARING_209.pitch_diameter for name, size in lengths.items()})
        for pitch in (0.1, 0.4)
    )
    for limit in (rating.fatigue_load_limit, rating.simple_fatigue_load_limit):
        assert limit(large) / limit(bearing()) == approx((0.1 / BEARING_209.pitch_diameter) ** 2)
        assert limit(larger) / limit(large) == approx(16.0 * 0.5)
