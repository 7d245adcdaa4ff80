"""Life of a rolling contact by its stress: scaling laws, what friction and a limit do, and material that passes."""

import math

import numpy as np
from comparison import approx

from benchmarks.machines.bearing_life import passing
from benchmarks.stress.closed_forms import ellipse_axis_stress
from contact_core.kernels.stress_measures import von_mises
from contact_core.kernels.subsurface import Subsurface
from system_models.machines.ball_bearing import rating
from system_models.machines.ball_bearing.geometry import BEARING_209, RACES
from system_models.machines.ball_bearing.stress_life import (
    DEPTH_POWER,
    STRESS_POWER,
    SmoothContact,
    factor,
    risk,
    smooth_contact,
)

INNER = SmoothContact(BEARING_209.inner.ellipse(1000.0), 0.3)


def test_the_risk_of_even_stress_is_its_closed_form() -> None:
    depths, spacing, width, limit = np.linspace(1e-6, 2e-3, 801), 1e-4, 50, 0.2
    stress = np.full((801, width), 1.2)
    mean = 0.5 * depths[-1]
    whole = 1.0**STRESS_POWER * depths[-1] * width * spacing / mean**DEPTH_POWER
    assert risk(stress, depths, spacing, limit) == approx(whole, rel=1e-3)
    assert risk(stress, depths, spacing, 1.2) == 0.0


def test_the_mean_of_sections_is_taken_before_the_depth() -> None:
    depths = np.linspace(1e-5, 1e-3, 100)
    one, two = np.ones((100, 4)), np.full((100, 4), 1.1)
    powers = 1.0, 1.1**STRESS_POWER
    found = risk(np.stack([one, two]), depths, 1e-5)
    assert found == approx(risk(one, depths, 1e-5) * sum(powers) / 2.0, rel=1e-12)


def test_life_falls_with_the_cube_of_the_load() -> None:
    double = SmoothContact(BEARING_209.inner.ellipse(2000.0), 0.3)
    assert factor(double.risk(), INNER.risk()) == approx(1.0 / 8.0, rel=1e-9)


def test_the_largest_stress_is_about_that_of_a_line_below_a_slim_ellipse() -> None:
    stress = INNER.stress()
    assert stress.max() == approx(0.56 * INNER.hertz.pressure_max, rel=0.03)  # von Mises, line: 0.557 at 0.70 a
    assert INNER.depths[stress.max(axis=1).argmax()] == approx(0.7 * INNER.hertz.a, rel=0.15)


def test_the_stress_below_the_centre_is_that_in_closed_form() -> None:
    h, depths = INNER.hertz, INNER.depths
    closed = von_mises(np.concatenate([ellipse_axis_stress(depths, h.a, h.b, h.pressure_max, 0.3), np.zeros((3, 19))]))
    deep = depths > 0.5 * h.a  # nearer to the surface the largest stress is not below the centre
    np.testing.assert_allclose(INNER.stress()[deep, 0], closed[deep], rtol=0.01)


def test_one_constant_holds_for_both_races() -> None:
    """ISO 16281 rates the races by Lundberg and Palmgren's approximations of the same integral."""
    geometry, million = BEARING_209, 1e6
    c, constants = rating.dynamic_rating(geometry), []
    for race, sign in zip(RACES, (1.0, -1.0), strict=True):
        contact = SmoothContact(geometry.race(race).ellipse(rating.contact_rating(geometry, c, race)), 0.3)
        passes = 0.5 * geometry.balls * (1.0 + sign * geometry.ratio) * million
        constants.append(passes**rating.WEIBULL * 2.0 * math.pi * geometry.race(race).track * contact.risk())
    assert constants[0] == approx(constants[1], rel=0.2)


def test_friction_shortens_life_and_does_so_at_any_load() -> None:
    factors = INNER.life_factor(np.array([0.0, 0.05, 0.1, 0.2]))
    assert factors[0] == 1.0
    assert np.all(np.diff(factors) < 0.0)
    lighter = smooth_contact(BEARING_209.inner, 0.3).life_factor(np.array([-0.1]))
    assert float(lighter[0]) == approx(float(factors[2]), rel=1e-6)


def test_below_the_limit_a_contact_lives_for_ever_and_above_it_longer() -> None:
    weak = SmoothContact(BEARING_209.inner.ellipse(500.0), 0.3)
    assert weak.hertz.pressure_max < rating.FATIGUE_PRESSURE < INNER.hertz.pressure_max
    assert factor(weak.risk(0.0, weak.fatigue_limit), weak.risk()) == math.inf
    assert 1.0 < factor(INNER.risk(0.0, INNER.fatigue_limit), INNER.risk()) < math.inf


def bump(shape: tuple[int, int], middle: float) -> np.ndarray:
    y, x = np.mgrid[: shape[0], : shape[1]]
    return np.asarray(np.sqrt(np.maximum(1.0 - ((x - middle) / 6.0) ** 2 - ((y - 10.0) / 6.0) ** 2, 0.0)))


def test_all_material_that_passes_a_steady_contact_sees_its_largest_stress() -> None:
    shape, depths = (21, 31), np.array([0.3e-3, 2e-3])
    pressure, shear = bump(shape, 15.0), 0.1 * bump(shape, 15.0)
    steps = [(pressure, shear, moved) for moved in range(36)]
    found = passing(steps, 1e-3, depths, 0.3, keep=4)
    seen = Subsurface(shape, 1e-3, depths, 0.3, "scipy").stress(pressure, shear)
    for k in range(2):
        largest = von_mises(seen[:, k]).max(axis=-1)
        for column in found[:, k]:
            np.testing.assert_allclose(column, largest, rtol=1e-9)


def test_a_spike_that_moves_with_the_body_is_seen_by_its_material_only() -> None:
    shape, depths, keep = (21, 31), np.array([0.5e-3]), 12
    marked, steps = 6, []  # the column that enters when the body has moved by 6
    for moved in range(keep + 32):
        pressure, at = bump(shape, 15.0), moved - marked
        if 0 <= at < shape[1]:
            pressure[10, at] *= 3.0
        steps.append((pressure, np.zeros(shape), moved))
    found = passing(steps, 1e-3, depths, 0.3, keep)[:, 0].max(axis=-1)
    assert int(found.argmax()) == marked - 1
    assert found[0] == approx(found[-1], rel=0.05)
    assert found[marked - 1] > 1.5 * found[0]


def test_half_of_the_track_stands_for_both() -> None:
    """The risk is that of the stress on the whole width, which is alike on both sides."""
    h, step = INNER.hertz, INNER.spacing
    x, y = (np.arange(-n, n + 1) * step for n in (18, int(h.b / step) + 2))
    pressure = h.pressure_max * np.sqrt(np.maximum(1.0 - (x[None] / h.a) ** 2 - (y[:, None] / h.b) ** 2, 0.0))
    below = Subsurface(pressure.shape, step, INNER.depths, 0.3, "scipy")
    stress = np.stack([von_mises(layer).max(axis=-1) for layer in below.layers(pressure)])
    assert INNER.risk() == approx(risk(stress, INNER.depths, step), rel=1e-9)
