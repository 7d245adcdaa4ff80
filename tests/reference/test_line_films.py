"""Film formulas of line contacts and the factors of heat and shear-thinning, against integrals of the inlet."""

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

from contact_core import line_contact
from contact_core.laws.density import DowsonHigginson
from contact_core.laws.rheology import Carreau
from contact_core.reference import (
    SmoothContact,
    SmoothLine,
    bair_thinning_factor,
    dowson_line,
    hertz_line,
    hertz_point,
    inlet_shear_factor,
    moes_film,
    moes_line,
    moes_line_film,
)

ROLLER = SmoothLine(2e5, 1.0, 0.05, 18e-9, 0.01, 230e9)


def rigid_roller() -> tuple[float, float, float]:
    """Film where the pressure is largest, load and largest pressure of a rigid roller in an oil of constant viscosity.

    In units of the smallest gap h0, of 12 eta (u1 + u2) R / h0 [N/m] and of 6 eta (u1 + u2) (2 R)^0.5 h0^-1.5 [Pa],
    x = (2 R h0)^0.5 tan(t); the film breaks where pressure and its slope vanish (Reynolds).
    """

    def pressure(angle: float, exit_angle: float) -> float:
        film = 1.0 + np.tan(exit_angle) ** 2
        return quad(lambda t: np.cos(t) ** 2 - film * np.cos(t) ** 4, -np.pi / 2, angle, epsabs=1e-13)[0]

    end = brentq(lambda t: pressure(t, t), 0.1, 1.0, xtol=1e-13)
    load = quad(lambda t: pressure(t, end) / np.cos(t) ** 2, -np.pi / 2 + 1e-6, end)[0]
    return 1.0 + np.tan(end) ** 2, load, pressure(-end, end)


def test_thin_oil_under_light_load_reaches_the_rigid_isoviscous_roller():
    film, load, _ = rigid_roller()
    constant = film * 12.0 * load  # (h / R) U^-1/2 times M
    print(f"h M = {constant:.4f}")
    assert moes_line_film(1e-2, 1e-3) * 1e-2 == approx(constant, rel=1e-3)


def test_thick_oil_under_light_load_reaches_the_rigid_piezoviscous_roller():
    film, _, largest = rigid_roller()
    # Barus' oil does not flow where the isoviscous pressure is 1 / alpha: 6 U 2^0.5 (h0 / R)^-1.5 p' = 1 / (alpha E')
    constant = film * (6.0 * np.sqrt(2.0) * largest) ** (2.0 / 3.0)  # (h / R) U^-1/2 L^(-2/3)
    print(f"h L^(-2/3) = {constant:.4f}")
    assert moes_line_film(0.1, 1e8) / 1e8 ** (2.0 / 3.0) == approx(constant, rel=2e-3)


def test_thin_oil_under_heavy_load_reaches_the_elastic_isoviscous_limit():
    assert moes_line_film(1e6, 1e-6) == approx(2.621 * 1e6**-0.2, rel=1e-3)


def of_moes(load: float, lubricant: float, speed: float = 1e-11) -> SmoothLine:
    """A line contact with given M and L; the speed parameter is of the sum of surface speeds."""
    radius, modulus, viscosity = 0.01, 230e9, 0.01
    return SmoothLine(
        load * speed**0.5 * modulus * radius, 0.5 * speed * modulus * radius / viscosity, viscosity,
        lubricant * speed**-0.25 / modulus, radius, modulus,
    )  # fmt: skip


@pytest.mark.parametrize(("load", "lubricant"), [(20.0, 5.0), (50.0, 10.0), (100.0, 10.0), (200.0, 15.0)])
def test_two_formulas_of_line_contacts_agree_to_two_percent_where_bodies_deform_and_oil_stiffens(load, lubricant):
    contact = of_moes(load, lubricant)
    assert contact.moes_parameters == approx((load, lubricant), rel=1e-12)
    central, minimum = dowson_line(contact)
    assert moes_line(contact) == approx(central, rel=0.02)
    assert moes_line(contact) / contact.radius / np.sqrt(1e-11) == approx(moes_line_film(load, lubricant))
    assert 0.65 < minimum / central < 0.8


@pytest.mark.parametrize(("load", "speed"), [(2e5, 1.0), (5e5, 1.0), (2e5, 0.2)])
def test_the_formula_is_that_of_incompressible_oils_and_compressed_ones_are_thinner_by_their_density(load, speed):
    contact = SmoothLine(load, speed, 0.03, 18e-9, 0.01, 230e9)
    case = {
        "load": load, "radius": 0.01, "reduced_modulus": 230e9, "speed_1": speed, "speed_2": speed,
        "viscosity": 0.03, "pressure_viscosity": 18e-9, "viscosity_law": "barus", "grid": 513,
    }  # fmt: skip
    full = line_contact(**case, density_law="none").h_central
    dense = line_contact(**case, density_law="dowson_higginson").h_central
    density = float(DowsonHigginson()(hertz_line(load, 0.01, 1.0, 230e9).pressure_max))
    print(f"M, L = {contact.moes_parameters}: solved / formula {full / moes_line(contact):.3f}")
    assert full == approx(moes_line(contact), rel=0.03)
    assert full == approx(dowson_line(contact)[0], rel=0.03)
    assert dense * density == approx(full, rel=0.04)


@pytest.mark.parametrize(("load", "lubricant"), [(20.0, 5.0), (100.0, 10.0)])
def test_a_line_contact_has_the_film_of_a_very_wide_ellipse_under_the_same_pressure(load, lubricant):
    line = of_moes(load, lubricant)
    pressure = np.sqrt(line.load * line.reduced_modulus / (2.0 * np.pi * line.radius))  # Hertz
    wide = line.radius * 1e5

    def excess(log_load: float) -> float:
        return hertz_point(np.exp(log_load), line.radius, wide, line.reduced_modulus).pressure_max - pressure

    point_load = np.exp(brentq(excess, 0.0, 20.0)) / (line.reduced_modulus * line.radius**2) * 1e-11**-0.75
    assert moes_line_film(load, lubricant) == approx(moes_film(point_load, lubricant, 1e-5), rel=0.05)


def test_inlet_heat_thins_the_film_of_a_fast_contact():
    # Q = 0.05 * 0.03 * 100 / 0.14 = 1.0714
    heat = 0.05 * 0.03 * 10.0**2 / 0.14
    rolling = (1.0 - 13.2 * 1.0e9 / 230e9 * heat**0.42) / (1.0 + 0.213 * heat**0.64)
    assert inlet_shear_factor(0.05, 0.03, 10.0, 0.0, 0.14, 1.0e9, 230e9) == approx(rolling, rel=1e-14)
    assert rolling == approx(0.769, abs=1e-3)
    sliding = rolling * (1.0 + 0.213 * heat**0.64) / (1.0 + 0.213 * 3.23 * heat**0.64)
    for ratio in (-1.0, 1.0):
        assert inlet_shear_factor(0.05, 0.03, 10.0, ratio, 0.14, 1.0e9, 230e9) == approx(sliding, rel=1e-14)


def test_inlet_heat_leaves_a_slow_film_as_it_is_and_no_film_negative():
    assert inlet_shear_factor(0.05, 0.03, 0.0, 0.5, 0.14, 1.0e9, 230e9) == 1.0
    assert inlet_shear_factor(0.004, 0.03, 0.25, 0.02, 0.14, 1.26e9, 230e9) == approx(1.0, abs=0.01)
    speeds = np.logspace(-6, 6, 40)
    factors = np.array([inlet_shear_factor(0.05, 0.03, u, 0.5, 0.14, 3.0e9, 230e9) for u in (*speeds, *-speeds)])
    assert np.all(np.diff(factors[:40]) <= 0.0)
    assert np.array_equal(factors[:40], factors[40:])
    assert factors.min() == 0.01


def inlet_film(oil: Carreau) -> float:
    """Film [m] of a purely rolling roller (Grubin): the pressure rises without bound in the inlet of Hertz's gap.

    A wall stress t drives the volume h^2 / (2 eta) F(t) per time and width, F(t) the integral of s t s ease(t s) over
    the share s of half the film; it has to be u (h - film).
    """
    share, weight = np.polynomial.legendre.leggauss(40)
    share, weight = 0.5 * (share + 1.0), 0.5 * weight
    wall = np.logspace(-2, 12, 800)
    flow = np.log((wall[:, None] * share**2 * oil.ease(wall[:, None] * share)) @ weight)
    half_width = np.sqrt(8.0 * ROLLER.load * ROLLER.radius / (np.pi * ROLLER.reduced_modulus))

    def missing(log_film: float) -> float:
        film = np.exp(log_film)

        def rise(travel: float, reduced):  # of (1 - exp(-alpha p)) / alpha
            x = 20.0 - travel
            gap = film + half_width**2 / (2.0 * ROLLER.radius) * (x * np.sqrt(x * x - 1.0) - np.arccosh(x))
            fluidity = np.maximum(1.0 - ROLLER.pressure_coefficient * reduced, 1e-6)
            driven = 2.0 * ROLLER.viscosity / fluidity * ROLLER.entrainment_speed * (gap - film) / gap**2
            stress = np.exp(np.interp(np.log(driven), flow, np.log(wall)))
            return fluidity * 2.0 * stress / gap * half_width

        reached = solve_ivp(rise, (0.0, 19.0 - 1e-9), [0.0], rtol=1e-5, atol=1e-3).y[0, -1]
        return ROLLER.pressure_coefficient * reached - 0.99

    return float(np.exp(brentq(missing, np.log(1e-9), np.log(3e-6), xtol=1e-4)))


def test_bairs_factor_follows_the_inlet_of_a_rolling_carreau_film_to_ten_percent():
    newtonian = inlet_film(Carreau(1e12, 1.0))
    assert newtonian == approx(moes_line(ROLLER), rel=0.1)
    for exponent in (0.4, 0.6, 0.8):
        for critical in (3e5, 1e5):
            thin = inlet_film(Carreau(critical, exponent)) / newtonian
            factor = bair_thinning_factor(newtonian, ROLLER.entrainment_speed, ROLLER.viscosity, critical, exponent)
            print(f"n = {exponent}, G = {critical:g} Pa: inlet {thin:.3f}, Bair {factor:.3f}")
            assert factor == approx(thin, rel=0.1)
            assert thin < 0.95


def test_bairs_factor_is_one_for_newtonian_oils_and_falls_with_sliding():
    assert bair_thinning_factor(1e-7, 1.0, 0.05, 1e5, 1.0) == 1.0
    assert bair_thinning_factor(1e-7, 1.0, 0.05, 1e12, 0.5) == approx(1.0, abs=1e-5)
    slip = [bair_thinning_factor(3e-7, 1.0, 0.05, 1e5, 0.5, ratio) for ratio in (0.0, 0.1, 0.5, 1.0)]
    assert np.all(np.diff(slip) < 0.0)
    assert bair_thinning_factor(3e-7, -1.0, 0.05, 1e5, 0.5, -0.5) == slip[2]


def test_the_circular_load_of_a_line_is_that_of_a_circle_whose_contact_is_as_deep():
    line, a = ROLLER, hertz_line(ROLLER.load, ROLLER.radius, 1.0, ROLLER.reduced_modulus).a
    load = a**3 * line.reduced_modulus / (1.5 * line.radius)  # of a ball of that radius with this half width
    assert hertz_point(load, line.radius, line.radius, line.reduced_modulus).a == approx(a)
    oil = (line.entrainment_speed, line.viscosity, line.pressure_coefficient)
    circle = SmoothContact(load, *oil, line.radius, line.radius, line.reduced_modulus)
    assert line.circular_load == approx(circle.moes_parameters[0], rel=1e-9)
