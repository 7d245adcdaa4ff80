from dataclasses import replace

import numpy as np
import pytest
from cheap_scene import cheap
from comparison import approx

from contact_core import Scene, advance, initial_state, solve
from contact_core.deterministic.friction import Film, derivatives, friction, shear, sliding
from contact_core.film.instant import Grid
from contact_core.scene import Case

SCENE, _, POINT = cheap()
GRID = Grid.centred(161, 161, 2e-6)
RADIUS = 150e-6
INSIDE = np.sqrt(np.maximum(1.0 - GRID.radius_2 / RADIUS**2, 0.0))
HERTZ = 1e9 * INSIDE
LOAD = float(HERTZ.sum()) * GRID.spacing**2
NOTHING = np.zeros_like(HERTZ)


def dry(**more):
    return Film(GRID, NOTHING, HERTZ, np.full_like(HERTZ, 1e-9), NOTHING, POINT.temperature)


def wet(share=0.3):
    gap = 40e-9 + 20e-9 * np.cos(GRID.x[None, :] / 1e-5) * np.cos(GRID.y[:, None] / 1.3e-5)
    return Film(GRID, (1.0 - share) * HERTZ, share * HERTZ, gap, 0.4 * INSIDE, POINT.temperature)


def at(**values):
    return replace(POINT, load=LOAD, **values)


def force(op, film, scene=SCENE):
    found = friction(shear(Case(scene, op), film), film.grid)
    return found.force_solid + found.force_fluid


def test_solids_alone_rub_with_the_coefficient_of_the_boundary_law():
    found = friction(shear(Case(SCENE, at(speed_1=0.2, speed_2=0.1)), dry()), GRID)
    assert found.force_solid == approx(-SCENE.boundary_friction.bare * LOAD, rel=1e-12)
    assert found.force_fluid == found.spin_torque == 0.0


def test_friction_is_odd_in_sliding_and_zero_without():
    film = wet()
    assert force(at(speed_1=0.2, speed_2=0.1), film) == -force(at(speed_1=0.1, speed_2=0.2), film)
    assert force(at(speed_1=0.1, speed_2=0.1), film) == 0.0


def test_a_ball_that_only_spins_feels_the_torque_of_hertzs_pressure():
    found = friction(shear(Case(SCENE, at(speed_1=0.1, speed_2=0.1, spin=200.0)), dry()), GRID)
    assert found.spin_torque == approx(-3.0 * np.pi / 16.0 * SCENE.boundary_friction.bare * LOAD * RADIUS, rel=2e-3)
    assert found.force_solid == approx(0.0, abs=1e-12 * LOAD)


@pytest.mark.parametrize("spin", [0.0, 300.0, -5e3])
def test_the_power_is_what_force_and_torque_take_from_the_motion(spin):
    op = at(speed_1=0.26, speed_2=0.24, spin=spin)
    found = friction(shear(Case(SCENE, op), wet()), GRID)
    lost = -(found.force_solid + found.force_fluid) * op.sliding_speed - found.spin_torque * spin
    assert found.power == approx(lost, rel=1e-12)
    assert found.power > 0.0


def test_much_spin_turns_friction_away_from_the_sliding():
    forces = [abs(force(at(speed_1=0.26, speed_2=0.24, spin=spin), dry())) for spin in (0.0, 1e2, 1e3, 1e4)]
    assert forces == sorted(forces, reverse=True)
    assert forces[-1] < 0.05 * forces[0]


@pytest.mark.parametrize("slide", [1e-7, 1e-5, 1e-3])
def test_friction_under_spin_is_in_proportion_to_a_little_sliding(slide):
    """At the regression level: its slope was a difference that rounding ruled, and its size changed with the slide."""
    scene = Scene.from_toml("ball_209_inner").at_level("regression")
    state, op = initial_state(scene), scene.operation.point

    def found(sliding):
        u = op.entrainment_speed
        return advance(scene, replace(op, speed_1=u + sliding / 2, speed_2=u - sliding / 2, spin=1000.0), state, 0.0)[1]

    out, most = found(slide), found(2e-3)
    assert out.friction_force / slide == approx(most.friction_force / 2e-3, rel=1e-4)
    assert out.dfriction_dspeed_1 == approx(out.friction_force / slide, rel=1e-3)


def test_spin_has_no_direction_of_its_own():
    left, right = (friction(shear(Case(SCENE, at(spin=spin)), wet()), GRID) for spin in (500.0, -500.0))
    assert left.power == approx(right.power, rel=1e-12)
    assert left.spin_torque == approx(-right.spin_torque, rel=1e-12)
    speed, along_x, along_y = sliding(at(speed_1=0.1, speed_2=0.1, spin=100.0), GRID)
    assert speed[80, 80] == 0.0
    assert (along_x[80, 80], along_y[80, 80]) == (1.0, 0.0)
    assert speed[80, 160] == approx(100.0 * GRID.x[160], rel=1e-14)
    assert along_y[80, 160] == 1.0  # where x > 0 a body that turns from x to y moves along +y


NAMES = ("speed_1", "speed_2", "load", "temperature")


@pytest.mark.parametrize("spin", [0.0, 400.0])
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("speed_1", "speed_2"), [(0.2, 0.1), (0.1, 0.4), (0.2000005, 0.2)])
def test_derivatives_are_those_of_a_held_film(name, spin, speed_1, speed_2):
    op, film = at(speed_1=speed_1, speed_2=speed_2, spin=spin), wet()

    def moved(by):
        value = getattr(op, name) + by
        if name == "load":
            scale = value / LOAD
            return force(replace(op, load=value), replace(film, fluid=film.fluid * scale, solid=film.solid * scale))
        if name == "temperature":
            return force(op, replace(film, temperature=value))
        return force(replace(op, **{name: value}), film)

    step = {"load": 1e-4 * LOAD, "temperature": 0.01}.get(name, 1e-9 if spin == 0.0 else 1e-7)
    expected = (moved(step) - moved(-step)) / (2.0 * step)
    assert derivatives(Case(SCENE, op), film)[f"dfriction_d{name}"] == approx(expected, rel=1e-3)
    assert abs(expected) > 0.0


@pytest.mark.parametrize("fall", [0.0, 0.006])
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(
    ("thinner", "slide", "least", "most"), [(1.0, 0.1, 0.0, 0.05), (100.0, 0.1, 0.6, 0.95), (1e6, 5e-7, 0.3, 0.6)]
)
def test_derivatives_know_where_the_oil_is_at_its_limiting_stress(name, thinner, slide, least, most, fall):
    """Nowhere, in most of the contact, and where the law of boundary friction lowers the limit."""
    film, op = replace(wet(), gap=wet().gap / thinner), at(speed_1=0.2 + slide, speed_2=0.2)
    law, left = SCENE.lubricant.rheology, np.exp(fall * (313.15 - film.temperature))
    rheology = replace(law, limiting_coefficient=law.limiting_coefficient / left, limiting_fall=fall)
    scene = replace(SCENE, lubricant=replace(SCENE.lubricant, rheology=rheology))
    limit = rheology.limiting_coefficient * film.fluid * scene.boundary_friction.grip(slide)
    limited = shear(Case(scene, op), film).fluid >= 0.999 * limit * left
    assert least <= limited[HERTZ > 0.0].mean() <= most

    def moved(by):
        new, load = replace(op, **{name: getattr(op, name) + by}), 1.0 + by / LOAD * (name == "load")
        moved = replace(film, fluid=load * film.fluid, solid=load * film.solid, temperature=new.temperature)
        return force(new, moved, scene)

    step = {"load": 1e-4 * LOAD, "temperature": 0.01}.get(name, 1e-5 * slide)
    expected = (moved(step) - moved(-step)) / (2.0 * step)
    assert derivatives(Case(scene, op), film)[f"dfriction_d{name}"] == approx(expected, rel=5e-3)
    assert abs(expected) > 0.0


def test_solids_and_oil_at_its_limit_rub_in_proportion_to_the_load():
    film, op = replace(wet(), gap=np.full_like(HERTZ, 1e-14)), at(speed_1=0.3, speed_2=0.2)
    assert derivatives(Case(SCENE, op), film)["dfriction_dload"] == approx(force(op, film) / LOAD, rel=1e-9)


def test_solids_and_oil_share_the_friction():
    op = at(speed_1=0.2, speed_2=0.1)
    both = friction(shear(Case(SCENE, op), wet(0.3)), GRID)
    cover = 0.4 * INSIDE
    law = SCENE.boundary_friction
    solid = float(((law.bare + (law.film - law.bare) * cover) * 0.3 * HERTZ).sum()) * GRID.spacing**2
    assert both.force_solid == approx(-solid, rel=1e-12)
    assert both.force_fluid < 0.0


@pytest.mark.parametrize("entrainment", [0.0, 1e-6, -1e-6])
def test_at_rest_and_just_beside_it_the_contact_rubs_by_the_boundary_law(entrainment):
    scene, state, point = cheap(tribofilm__model="none")
    op = replace(point, speed_1=0.01 + entrainment, speed_2=-0.01 + entrainment)
    fields = solve(scene, op, state)
    assert fields.converged, fields.shortfall
    assert fields.route == ("dry" if entrainment == 0.0 else "mixed")
    found = abs(fields.friction.force_solid + fields.friction.force_fluid) / op.load
    assert found == approx(scene.boundary_friction.bare, rel=1e-3)


def test_the_boundary_limit_lies_where_additives_are_measured():
    for name in ("azam_case_a", "mtm_zddp"):
        law = Scene.from_toml(name).boundary_friction
        assert all(0.09 <= law.coefficient(cover) <= 0.14 for cover in (0.0, 0.5, 1.0))


@pytest.mark.parametrize("level", ["deterministic", "regression"])
def test_the_slope_of_friction_through_zero_sliding_is_bounded_by_the_slip_speed(level):
    scene, state, point = cheap()
    scene = scene.at_level(level)
    op = replace(point, speed_1=point.speed_2)
    _, outputs = advance(scene, op, state, 0.0)
    law, oil = scene.boundary_friction, scene.lubricant.rheology
    steepest = max(law.bare, oil.limiting_coefficient) * op.load / law.slip_speed
    assert -1.01 * steepest < outputs.dfriction_dspeed_1 < -0.1 * steepest
    assert outputs.dfriction_dspeed_2 == approx(-outputs.dfriction_dspeed_1, rel=1e-3)


def test_oil_at_its_limit_grips_as_solids_do():
    scene, _, _ = cheap(lubricant__rheology__model="newtonian")
    stiff = replace(wet(0.0), fluid=np.full_like(HERTZ, 6e9))  # beyond its limit at any speed
    full, part = (
        friction(shear(Case(scene, at(speed_1=0.1 + speed, speed_2=0.1)), stiff), GRID).force_fluid
        for speed in (0.1, 1e-7)
    )
    assert part == approx(scene.boundary_friction.grip(1e-7) * full, rel=1e-6)
