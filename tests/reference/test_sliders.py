"""The closed form of a rigid roller against quadrature and a march of Reynolds' equation."""

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import quad, solve_ivp
from sliders import ParabolicSlider

from contact_core.reference import moes_line_film

FLOODED = ParabolicSlider(gap=1e-6, radius=0.01, viscosity=0.02, entrainment_speed=1.5)
LATE = ParabolicSlider(1e-6, 0.01, 0.02, 1.5, inlet=-1.2e-4)


def gap_of(slider: ParabolicSlider, x):
    return slider.gap + x * x / (2.0 * slider.radius)


@pytest.mark.parametrize("slider", [LATE, ParabolicSlider(1e-6, 0.01, 0.02, 1.5, inlet=-5e-4)])
def test_pressure_is_that_of_reynolds_equation_from_the_inlet_on(slider):
    def slope(x, _):
        gap = gap_of(slider, x)
        return [12.0 * slider.viscosity * slider.entrainment_speed * (gap - slider.film) / gap**3]

    marched = solve_ivp(slope, (slider.inlet, slider.outlet), [0.0], rtol=1e-11, atol=1e-3, dense_output=True)
    x = np.linspace(slider.inlet, slider.outlet, 40)
    largest = slider.pressure(x).max()
    assert slider.pressure(x) == approx(marched.sol(x)[0], rel=1e-7, abs=1e-7 * largest)
    assert marched.y[0, -1] == approx(0.0, abs=1e-7 * largest)
    assert gap_of(slider, slider.outlet) == approx(slider.film, rel=1e-12)  # no slope at the outlet either
    assert slider.load == approx(quad(slider.pressure, slider.inlet, slider.outlet)[0], rel=1e-9)


def test_nothing_presses_outside_of_the_film():
    assert np.all(LATE.pressure(np.array([-1.0, LATE.inlet, LATE.outlet, 1.0])) == 0.0)


def test_the_oil_that_flows_is_the_same_everywhere():
    x = np.linspace(-4e-4, 4e-4, 4001)
    gap, oil = gap_of(LATE, x), LATE.oil(x)
    assert np.all(oil[(x < LATE.inlet) | (x > LATE.outlet)] <= gap[(x < LATE.inlet) | (x > LATE.outlet)])
    slope = np.gradient(LATE.pressure(x), x)
    flow = LATE.entrainment_speed * oil - gap**3 / (12.0 * LATE.viscosity) * slope
    kink = np.minimum(np.abs(x - LATE.inlet), np.abs(x - LATE.outlet)) < 1e-6
    assert flow[~kink] == approx(LATE.entrainment_speed * LATE.film, rel=1e-4)


def test_a_flooded_roller_is_the_rigid_isoviscous_limit_of_line_contacts():
    modulus = 230e9
    speed = 2.0 * FLOODED.viscosity * FLOODED.entrainment_speed / (modulus * FLOODED.radius)
    load = FLOODED.load / (modulus * FLOODED.radius) * speed**-0.5
    film = FLOODED.film / FLOODED.radius * speed**-0.5
    assert film * load == approx(moes_line_film(1e-2, 1e-3) * 1e-2, rel=1e-3)
    assert FLOODED.outlet / np.sqrt(2.0 * FLOODED.radius * FLOODED.gap) == approx(0.47513, abs=1e-5)
    assert ParabolicSlider(1e-6, 0.01, 0.02, 1.5, inlet=-1.0).load == approx(FLOODED.load, rel=1e-6)


def test_a_layer_of_oil_finds_its_inlet():
    for supply in (1.01e-6, 1.1e-6, 1.2e-6, 1.22e-6):
        slider = ParabolicSlider.supplied(supply, 1e-6, 0.01, 0.02, 1.5)
        again = ParabolicSlider(1e-6, 0.01, 0.02, 1.5, slider.inlet)
        assert again.film == approx(supply, rel=1e-10)
        assert slider.outlet < -slider.inlet
        assert 0.0 < slider.load < FLOODED.load
    for supply in (1.0e-6, 1.3e-6):
        with pytest.raises(ValueError, match="flooded"):
            ParabolicSlider.supplied(supply, 1e-6, 0.01, 0.02, 1.5)
