"""Rolling resistance: the closed forms against solved films, and what the regression level makes of them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from comparison import HARD, approx
from scipy.optimize import brentq

from contact_core import Scene, advance, initial_state, line_contact, point_contact
from contact_core.laws.supply import SupplyFilm
from contact_core.reference import rolling_beyond_point, rolling_line, rolling_point
from contact_core.regression.smooth_film import smooth_film
from contact_core.scene import Case

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
        return rolled(changes, speed_1=3.0, speed_2=3.0).rolling_resistance

    assert force(load=0.0) == force(speed_1=0.0, speed_2=0.0) == force(speed_1=0.5, speed_2=-0.5) == 0.0
    found = advance(scene, op, state, 0.0)[1]
    formula = rolling_point(
        op.load, op.entrainment_speed, float(scene.lubricant.viscosity(0.0, op.temperature)),
        scene.geometry.radius_x, scene.geometry.radius_y, scene.solids.reduced_modulus,
    )  # fmt: skip
    smooth = Case(scene, op).smooth_film
    held = math.sqrt(found.contact_load_ratio) * (1.0 - math.sqrt(smooth / found.h_c))
    assert found.contact_load_ratio > 0.8
    assert found.rolling_resistance == approx((1.0 - held) * formula, rel=0.05)  # another formula of the film
    assert 0.0 < of_oil({"heat.inlet_shear": "gupta"}) < 0.99 * of_oil()
    starved = {"lubricant.supply.model": "film", "lubricant.supply.thickness": "50 nm"}
    starved["lubricant.cavitation"] = "mass_conserving"
    assert 0.0 < of_oil(starved) < 0.3 * of_oil()


def quadrature_beyond(viscosity_speed: float, radius_y: float, before: float, beside: float) -> float:
    """Integral of (h/2) dp/dx outside a rectangle up to the gap of R / 18, of p = 12 eta u |x| / [(3 + 2 k) h^2]."""
    slim = RADIUS / radius_y
    angle = 0.5 * math.pi * (np.arange(20_000) + 0.5) / 20_000  # of the quarter x < 0, y sqrt(k) > 0
    along, across = np.cos(angle), np.sin(angle)
    edge = np.minimum(before / along, beside * math.sqrt(slim) / across)
    decades = np.log(np.maximum(RADIUS / 3.0 / edge, 1.0))
    peak = 12.0 * viscosity_speed / (3.0 + 2.0 * slim)
    return 2.0 * float((0.25 * peak * RADIUS * (16.0 * along**2 - 4.0) * decades).mean()) * 0.5 * math.pi / slim**0.5


@pytest.mark.parametrize(("times_wider", "beside"), [(1, 2e-4), (1, 1.0), (4, 6e-4), (10, 9e-4)])
def test_what_lies_beyond_a_grid_is_the_quadrature_of_kapitzas_pressure(times_wider, beside):
    found = rolling_beyond_point(2.0, 0.03, RADIUS, times_wider * RADIUS, 2e-4, beside)
    assert found == approx(quadrature_beyond(0.06, times_wider * RADIUS, 2e-4, beside), rel=0.02)


def test_a_point_rolls_as_hard_on_a_grid_half_as_wide_with_what_lies_beyond_either():
    """Of steel on steel; that of the smaller grid without is a fifth less."""
    bare, whole = [], []
    for half in (20, 40):
        step = 1.2e-5
        contact = point_contact(
            load=20.0, radius_x=RADIUS, reduced_modulus=MODULUS, speed_1=1.0, speed_2=1.0, viscosity=0.03,
            pressure_viscosity=PRESSURE, grid=(2 * half + 1, half + 21),
            domain=(-half * step, 20 * step, -half * step, half * step),
        )  # fmt: skip
        bare.append(rolling(contact) * step)
        whole.append(bare[-1] + rolling_beyond_point(1.0, 0.03, RADIUS, RADIUS, half * step, half * step))
    assert bare[0] < 0.88 * bare[1]
    assert whole[0] == approx(whole[1], rel=0.05)
    assert whole[1] == approx(rolling_point(20.0, 1.0, 0.03, RADIUS, RADIUS, MODULUS), rel=0.1)


@pytest.mark.parametrize(
    "name", ["fzg_flank", *(pytest.param(name, marks=pytest.mark.long) for name in ("azam_case_a", "cam_tappet"))]
)
def test_both_levels_roll_alike_within_the_error_of_the_regression_level(name):
    """Flanks of moving roughness take and give: on single instants they turn the sign in mixed lubrication."""
    fast, deep = (_at(Scene.from_toml(name, {"film.model": level})) for level in ("regression", "deterministic"))
    off = abs(deep.rolling_resistance - fast.rolling_resistance)
    assert deep.rolling_resistance > 0.0
    assert off < fast.error_rolling * fast.rolling_resistance < fast.rolling_resistance
    assert 0.0 < deep.error_rolling < 1.0


def _at(scene):
    return advance(scene, scene.operation.point, initial_state(scene), 0.0)[1]


@pytest.mark.parametrize("oil", [0.5, 1.0, 4.0, 16.0])
def test_a_starved_inlet_resists_as_a_solved_one_with_as_much_oil(oil):
    """Both over what a flooded one has, by a layer of `oil` times its film."""
    step, given = 1.2e-5, {"load": 20.0, "radius_x": RADIUS, "reduced_modulus": MODULUS, "speed_1": 1.0}
    given |= {"speed_2": 1.0, "viscosity": 0.03, "pressure_viscosity": PRESSURE, "grid": (81, 61)}
    given |= {"domain": (-40 * step, 20 * step, -40 * step, 40 * step)}
    flooded = point_contact(**given)
    whole = rolling(flooded) * step + rolling_beyond_point(1.0, 0.03, RADIUS, RADIUS, 40 * step, 40 * step)
    solved = point_contact(**given, cavitation="mass_conserving", supply=oil * flooded.h_central)
    scene = Scene.from_toml("ball_209_inner", SMOOTH | {
        "geometry.radius_x": "8 mm", "geometry.radius_y": "8 mm", "heat.inlet_shear": "none",
        "lubricant.cavitation": "mass_conserving",
    })  # fmt: skip
    case = Case(scene, replace(scene.operation.point, load=20.0, speed_1=1.0, speed_2=1.0))
    film = smooth_film(case, 1e-6).film
    short = replace(scene.lubricant, supply=SupplyFilm(thickness=oil * film))
    found = smooth_film(Case(replace(scene, lubricant=short), case.op), 1e-6)
    assert found.supplied == approx(rolling(solved) * step / whole, rel=0.35)
