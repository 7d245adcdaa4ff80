"""Rolling resistance: the closed forms against solved films, and what the regression level makes of them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from comparison import HARD, approx
from scipy.optimize import brentq

from contact_core import Scene, advance, initial_state, line_contact, point_contact
from contact_core.reference import rolling_line, rolling_point

MODULUS, RADIUS, PRESSURE = 2.27e11, 8e-3, 18e-9  # Pa, m, 1/Pa


def rolling(contact, rows: int = 1) -> float:
    """Integral of (h/2) dp/dx of a solved film."""
    spacing = contact.x[1] - contact.x[0]
    slope = np.gradient(contact.fluid_pressure, spacing, axis=1)
    return 0.5 * float((contact.film * slope).sum()) * spacing**2 / (rows * spacing)


def exact_rigid_line(load: float, speed: float, viscosity: float) -> float:
    """Of rigid bodies: Reynolds' equation by quadrature over g, tan(g) = x / sqrt(2 R h0), up to Reynolds' outlet."""

    def upto(outlet: float):
        step = (0.5 * math.pi + outlet) / 20_000
        cosine = np.cos(-0.5 * math.pi + step * (np.arange(20_000) + 0.5)) ** 2
        return cosine, np.cumsum(cosine - cosine**2 / math.cos(outlet) ** 2) * step, step

    outlet = brentq(lambda outlet: upto(outlet)[1][-1], 0.1, 1.0)  # where the pressure ends as flat as it begins
    cosine, pressure, step = upto(outlet)
    gap = 24.0 * viscosity * speed * RADIUS / load * float((pressure / cosine).sum()) * step  # in the middle
    force = float((1.0 - cosine / math.cos(outlet) ** 2).sum()) * step
    return 6.0 * viscosity * speed * math.sqrt(2.0 * RADIUS / gap) * force


def test_rigid_lines_roll_as_reynolds_equation_says():
    exact, found = exact_rigid_line(3.0, 5.0, 0.1), rolling_line(3.0, 5.0, 0.1, RADIUS, 1e13)
    assert exact == approx(2.079 * math.sqrt(0.1 * 5.0 * 3.0), rel=1e-3)
    assert found == approx(exact, rel=0.04)


@pytest.mark.parametrize("load, speed, viscosity", [(3e4, 1.0, 0.03), (3e5, 1.0, 0.03), (3e5, 0.5, 0.01)])
def test_solved_lines_roll_as_hard_with_what_their_inlet_lacks(load, speed, viscosity):
    """A solved film ends at the edge of its grid, beyond which h is x^2 / (2 R): 12 eta u R / X are missing."""
    contact = line_contact(
        load=load, radius=RADIUS, reduced_modulus=MODULUS, speed_1=speed, speed_2=speed, viscosity=viscosity,
        pressure_viscosity=PRESSURE, grid=1025,
    )  # fmt: skip
    beyond = 12.0 * viscosity * speed * RADIUS / -contact.x[0]
    found = rolling(contact, contact.y.size) + beyond
    assert rolling_line(load, speed, viscosity, RADIUS, MODULUS) == approx(found, rel=0.12)


@pytest.mark.parametrize("times_wider", [1, pytest.param(10, marks=pytest.mark.long)])
def test_solved_points_roll_the_harder_the_wider_their_inlet_and_come_near_the_formula(times_wider):
    """What the inlet adds from afar falls as slowly as a logarithm does."""
    step, half, found = 1.2e-5, 16 if times_wider == 1 else 48, []
    for wide in (1, 2, 3):
        contact = point_contact(
            load=20.0, radius_x=RADIUS, radius_y=times_wider * RADIUS, reduced_modulus=MODULUS, speed_1=1.0,
            speed_2=1.0, viscosity=0.03, pressure_viscosity=PRESSURE, grid=(2 * half * wide + 1, 40 * wide + 25),
            domain=(-40 * wide * step, 24 * step, -half * wide * step, half * wide * step),
        )  # fmt: skip
        found.append(rolling(contact) * step / rolling_point(20.0, 1.0, 0.03, RADIUS, times_wider * RADIUS, MODULUS))
    assert 0.0 < found[2] - found[1] < found[1] - found[0]
    assert 0.6 < found[0] < 0.7
    assert 0.85 < found[2] < 1.05


SMOOTH = HARD | {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm", "film.model": "regression"}


@pytest.mark.parametrize("name", ["mtm_zddp", "ball_209_inner", "fzg_flank"])
def test_the_regression_level_rolls_smooth_bodies_by_the_formula_of_their_shape(name):
    scene = Scene.from_toml(name, SMOOTH)
    op = replace(scene.operation.point, speed_1=2.0, speed_2=2.0)
    shape, modulus = scene.geometry, scene.solids.reduced_modulus
    oil = float(scene.lubricant.viscosity(0.0, op.temperature))
    if name == "fzg_flank":
        formula = shape.face_width * rolling_line(op.load / shape.face_width, 2.0, oil, shape.radius_x, modulus)
    else:
        formula = rolling_point(op.load, 2.0, oil, shape.radius_x, shape.radius_y, modulus)
    found = advance(scene, op, initial_state(scene), 0.0)[1]
    assert found.rolling_resistance == approx(formula, rel=1e-6)
    back = advance(scene, replace(op, speed_1=-2.0, speed_2=-2.0), initial_state(scene), 0.0)[1]
    assert back.rolling_resistance == -found.rolling_resistance


def test_nothing_rolls_at_rest_without_load_or_on_solids_and_less_with_a_warm_or_starved_inlet():
    scene = Scene.from_toml("mtm_zddp", {"film.model": "regression"})
    state, op = initial_state(scene), scene.operation.point

    def rolled(changes=None, **inputs):
        asked = Scene.from_toml("mtm_zddp", {"film.model": "regression"} | (changes or {}))
        return advance(asked, replace(op, **inputs), state, 0.0)[1]

    def force(**inputs):
        return rolled(**inputs).rolling_resistance

    def of_oil(changes=None):
        found = rolled(changes, speed_1=3.0, speed_2=3.0)
        return found.rolling_resistance / (1.0 - found.contact_load_ratio)

    assert force(load=0.0) == force(speed_1=0.0, speed_2=0.0) == force(speed_1=0.5, speed_2=-0.5) == 0.0
    found = advance(scene, op, state, 0.0)[1]
    formula = rolling_point(
        op.load, op.entrainment_speed, float(scene.lubricant.viscosity(0.0, op.temperature)),
        scene.geometry.radius_x, scene.geometry.radius_y, scene.solids.reduced_modulus,
    )  # fmt: skip
    assert found.rolling_resistance == approx((1.0 - found.contact_load_ratio) * formula, rel=1e-6)
    assert 0.0 < of_oil({"heat.inlet_shear": "gupta"}) < 0.99 * of_oil()
    starved = {"lubricant.supply.model": "film", "lubricant.supply.thickness": "50 nm"}
    starved["lubricant.cavitation"] = "mass_conserving"
    assert 0.0 < of_oil(starved) < 0.9 * of_oil()
