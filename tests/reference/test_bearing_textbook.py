"""Textbook formulas of ball bearings: printed tables, public programs, and many balls in place of an integral."""

import math

import pytest
from closed_forms import sjovall
from comparison import approx

from system_models.machines.ball_bearing.equilibrium import RingLoads, solve
from system_models.machines.ball_bearing.geometry import BallBearingGeometry
from system_models.machines.ball_bearing.textbook import (
    ANGULAR_CONTACT,
    CATALOGUE_209,
    CATALOGUE_218,
    CatalogueBearing,
    Series,
    palmgren_torque,
    skf_torque,
)

RPM = math.pi / 30.0

SJOVALL = {  # extent: radial, axial; quadrature of the integrals, of which textbooks print most
    0.2: (0.1590, 0.1707),
    0.3: (0.1892, 0.2110),
    0.4: (0.2117, 0.2462),
    0.5: (0.2288, 0.2782),
    0.6: (0.2416, 0.3084),
    0.7: (0.2505, 0.3374),
    0.8: (0.2559, 0.3658),
    0.9: (0.2576, 0.3945),
    1.0: (0.2546, 0.4244),
    1.25: (0.2289, 0.5044),
    2.5: (0.1339, 0.7240),
    5.0: (0.0711, 0.8558),
}


@pytest.mark.parametrize("extent", SJOVALL)
def test_load_integrals_are_the_tabulated_ones(extent):
    assert sjovall(extent) == approx(SJOVALL[extent], abs=5.1e-5)


@pytest.mark.parametrize(
    ("clearance", "displacement"), [(60e-6, 50e-6), (15e-6, 60e-6), (-40e-6, 30e-6), (-60e-6, 12e-6)]
)
def test_many_small_balls_carry_what_the_integral_says(clearance, displacement):
    """With an extent below 1 for a clearance and above for a press fit; the balls' number is what is left to differ."""
    bearing = BallBearingGeometry(
        balls=150, ball_diameter=12e-3, pitch_diameter=0.65, conformity_inner=0.52, conformity_outer=0.52,
        clearance=clearance,
    )  # fmt: skip
    extent = 0.5 * (1.0 - clearance / (2.0 * displacement))
    radial, _ = sjovall(extent)
    largest = bearing.stiffness * (displacement - 0.5 * clearance) ** 1.5
    found = solve(bearing, RingLoads(y=bearing.balls * radial * largest), 0.0)
    assert found.displacement[1] == approx(displacement, rel=1e-4)
    assert found.load_inner[0] == approx(largest, rel=2e-4)


@pytest.mark.parametrize(
    ("radial", "axial", "n", "rolling", "sliding"),
    [
        (2000.0, 500.0, 200.0, 25.60098968, 102.6459456),
        (2000.0, 500.0, 1500.0, 81.31198858, 53.0834375),
        (2000.0, 500.0, 6000.0, 162.5404349, 79.79116926),
        (0.0, 3000.0, 200.0, 39.77489852, 138.8553826),
        (0.0, 3000.0, 6000.0, 235.4012818, 84.59643253),
    ],
)
def test_skf_torque_of_a_qj308_is_that_of_a_public_program(radial, axial, n, rolling, sliding):
    """N mm, by bearings.py of github.com/cfernandesFEUP/Gear-Calculation at 30 mm2/s, friction 0.12 and 0.05."""
    series = Series(True, (4.78e-7, 2.42, 1.40e-12), (1.20e-2, 0.9, 1.40e-12), 3.1, 2.0, (1e-3, 0.33))
    found = skf_torque(CatalogueBearing(series, 40e-3, 90e-3, 6e4), radial, axial, n * RPM, 30e-6)
    assert [1e3 * part for part in found] == approx([rolling, sliding], rel=1e-8)


def test_skf_torque_of_a_deep_groove_bearing_in_its_limits():
    """Without speed friction is 0.15 of G_sl = S_1 dm^-0.26 F_r^(5/3); a slow bearing rolls with (nu n)^0.6."""
    at_rest = skf_torque(CATALOGUE_209, 3000.0, 0.0, 0.0, 20e-6)
    assert at_rest == approx((0.0, 0.15e-3 * 3.23e-3 * 65.0**-0.26 * 3000.0 ** (5 / 3)), rel=1e-12)
    slow = skf_torque(CATALOGUE_209, 3000.0, 0.0, 1.0 * RPM, 20e-6, starvation=0.0)
    assert slow.speed_dependent == approx(1e-3 * 3.9e-7 * 65.0**1.96 * 3000.0**0.54 * 20.0**0.6, rel=1e-4)
    film = skf_torque(CATALOGUE_209, 3000.0, 0.0, 5000 * RPM, 100e-6, friction_film=0.03)
    assert film.load_dependent / at_rest.load_dependent == approx(0.03 / 0.15, rel=1e-6)
    # an axial load changes the formula, which is not continuous there
    assert (
        skf_torque(CATALOGUE_209, 3000.0, 1000.0, 100.0, 20e-6).total
        > skf_torque(CATALOGUE_209, 3000.0, 0.0, 100.0, 20e-6).total
    )


def test_palmgren_torque_has_both_of_its_branches():
    oil = [palmgren_torque(CATALOGUE_209, 1000.0, 0.0, n * RPM, 20e-6).speed_dependent for n in (10, 50, 99, 101, 800)]
    assert oil[:3] == approx([160e-7 * 2.0 * 65.0**3 * 1e-3] * 3)
    assert oil[3] == approx(oil[0], rel=0.02)  # the branches meet at 2000 mm2/s rpm
    assert oil[4] / oil[3] == approx((800 / 101) ** (2 / 3), rel=1e-12)
    light, heavy = (palmgren_torque(CATALOGUE_209, load, 0.0, 1.0, 20e-6).load_dependent for load in (1000.0, 2000.0))
    assert heavy / light == approx(2.0**1.55, rel=1e-12)
    assert light == approx(6e-4 * (1000.0 / 21.6e3) ** 0.55 * 1000.0 * 65e-3, rel=1e-12)
    thrust = palmgren_torque(CATALOGUE_218, 0.0, 17800.0, 1.0, 20e-6).load_dependent
    factor, exponent = ANGULAR_CONTACT.f_1
    felt = 0.9 * 17800.0 / math.tan(math.radians(40.0))
    assert thrust == approx(factor * (0.26 * 17.8 / 104.0) ** exponent * felt * 0.125, rel=1e-12)
    # a radial load beside it takes a tenth of itself off what is felt
    both = palmgren_torque(CATALOGUE_218, 5000.0, 17800.0, 1.0, 20e-6).load_dependent
    share = (CATALOGUE_218.static_load(5000.0, 17800.0) / 104e3) ** exponent
    assert both == approx(factor * share * (felt - 500.0) * 0.125, rel=1e-12)
