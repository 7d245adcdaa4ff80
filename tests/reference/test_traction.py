"""Traction curves mu(SRR) of a uniform film under Hertz's pressure, against integrals in closed form."""

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import quad

from contact_core.laws.rheology import Carreau, Eyring, Newtonian
from contact_core.laws.viscosity import AstmD341, Barus, Modulus, Roelands

TEMPERATURE = 363.15
HALF_WIDTH, PEAK, FILM, SPEED = 150e-6, 0.8e9, 100e-9, 2.0  # m, Pa, m, m/s
LIMIT = 0.05
RHEOLOGIES = [
    Newtonian(LIMIT), Eyring(5e6, LIMIT), Carreau(5e6, 0.8, LIMIT), Carreau(5e6, 0.5, LIMIT), Carreau(5e6, 0.3, LIMIT)
]  # fmt: skip
VISCOSITIES = [
    Barus(0.01, TEMPERATURE, 12e-9, 0.03),
    Roelands(0.01, TEMPERATURE, 15e-9, 0.03),
    Modulus(86.86e-6, 890.0, -182.0, -2.28e7, 2.26e5, -68.2e-3, 27.68e-5),
    AstmD341(99.4e-6, 10.99e-6, 900.0, 18.8e-9, 313.15),
]

by_rheology = pytest.mark.parametrize("rheology", RHEOLOGIES, ids=repr)
by_viscosity = pytest.mark.parametrize("viscosity", VISCOSITIES, ids=lambda law: law.name)


def traction(rheology, viscosity, ratio: float, nodes: int = 401) -> float:
    """Friction / load from a sum over the nodes of a grid, as in a contact."""
    x = np.linspace(-1.0, 1.0, nodes)
    pressure = PEAK * np.sqrt(np.maximum(1.0 - x[None, :] ** 2 - x[:, None] ** 2, 0.0))
    newtonian = viscosity(pressure, TEMPERATURE) * ratio * SPEED / FILM
    return float(rheology(newtonian, pressure)[pressure > 0.0].sum() / pressure.sum())


def over_contact(stress) -> float:
    """Integral of a stress [Pa] of the pressure [Pa] over Hertz's circle / load; dA = 2 pi a^2 q dq, q = p / p_H."""
    area = quad(lambda q: stress(PEAK * q) * 2.0 * np.pi * HALF_WIDTH**2 * q, 0.0, 1.0, epsrel=1e-9, limit=200)[0]
    return area / (2.0 / 3.0 * np.pi * HALF_WIDTH**2 * PEAK)


def at(viscosity, pressure: float) -> float:
    return float(viscosity(np.array([pressure]), TEMPERATURE)[0])


def gentle(viscosity) -> float:
    """A slide-to-roll ratio that stresses a Newtonian oil by no more than 10 kPa, far below what thins an oil."""
    return 1e4 * FILM / SPEED / at(viscosity, PEAK)


@by_rheology
@by_viscosity
def test_small_slip_finds_the_newtonian_slope(rheology, viscosity):
    ratio = gentle(viscosity)
    slope = over_contact(lambda p: at(viscosity, p)) * SPEED / FILM
    found = traction(rheology, viscosity, ratio) / ratio
    print(f"{viscosity.name}, {rheology}: slope {found:.5g}, closed form {slope:.5g}")
    assert found == approx(slope, rel=0.01)
    assert traction(rheology, viscosity, -ratio) == -traction(rheology, viscosity, ratio)


def test_the_newtonian_slope_of_barus_oil_is_that_of_the_integral_by_hand():
    oil, z = VISCOSITIES[0], 12e-9 * PEAK
    # integral of exp(z q) 2 q dq from 0 to 1
    mean = 2.0 * ((z - 1.0) * np.exp(z) + 1.0) / z**2
    slope = 1.5 / PEAK * 0.01 * mean * SPEED / FILM
    assert over_contact(lambda p: at(oil, p)) * SPEED / FILM == approx(slope, rel=1e-8)
    ratio = gentle(oil)
    assert traction(RHEOLOGIES[1], oil, ratio) / ratio == approx(slope, rel=0.01)


@by_rheology
@by_viscosity
def test_large_slip_finds_the_limiting_coefficient(rheology, viscosity):
    found = traction(rheology, viscosity, 1e9)
    print(f"{viscosity.name}, {rheology.name}: {found:.5f}")
    assert found == approx(LIMIT, rel=0.01)  # Lambda times the mean pressure / the mean pressure
    assert found <= LIMIT * (1.0 + 1e-12)


CURVES = {
    "newtonian": lambda law, x: x,
    "eyring": lambda law, x: law.eyring_stress * np.log(x / law.eyring_stress + np.hypot(x / law.eyring_stress, 1.0)),
    "carreau": lambda law, x: x * (1.0 + (x / law.critical_stress) ** 2) ** ((law.exponent - 1.0) / 2.0),
}


@by_rheology
@by_viscosity
def test_between_them_a_traction_curve_is_the_integral_of_its_law(rheology, viscosity):
    curve = CURVES[rheology.name]
    found = []
    for ratio in np.array([10.0, 1e3, 1e4, 1e5]) * gentle(viscosity):
        expected = over_contact(
            lambda p, ratio=ratio: min(curve(rheology, at(viscosity, p) * ratio * SPEED / FILM), LIMIT * p)
        )
        found.append(traction(rheology, viscosity, ratio))
        assert found[-1] == approx(expected, rel=0.01)
    assert np.all(np.diff(found) > 0.0)
    assert found[-1] < LIMIT


def test_a_thinner_oil_in_shear_pulls_less():
    oil = VISCOSITIES[1]
    ratio = 1e4 * gentle(oil)
    free = [traction(law, oil, ratio) for law in (Newtonian(), Carreau(5e6, 0.8), Carreau(5e6, 0.5), Carreau(5e6, 0.3))]
    assert np.all(np.diff(free) < 0.0)
