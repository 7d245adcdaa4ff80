"""States of the film, and what an instant takes over from the one before."""

from dataclasses import fields, replace

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap
from comparison import approx

from contact_core import advance, solve
from contact_core.deterministic.instant import instant_of
from contact_core.film.instant import FilmState, Grid, Settings, Step
from contact_core.film.outputs import at_centre
from contact_core.film.scaled import Scaled
from contact_core.reference import hertz_point
from contact_core.scene import Case

RANDOM = np.random.Generator(np.random.Philox(1))


def test_a_mirrored_state_has_every_field_mirrored_and_comes_back():
    names = [each.name for each in fields(FilmState)]
    shapes = {name: RANDOM.uniform(size=(3, 5)) for name in names if name not in ("rigid_gap", "dt")}
    state = FilmState(**shapes | {"solid": shapes["solid"] > 0.5, "rigid_gap": 2.0, "dt": 3.0})
    there, back = state.mirrored(), state.mirrored().mirrored()
    for name in names:
        value = getattr(state, name)
        np.testing.assert_array_equal(getattr(there, name), value[:, ::-1] if np.ndim(value) else value, name)
        np.testing.assert_array_equal(getattr(back, name), value, name)


@pytest.mark.parametrize("ratio", [0.5, 1.0, 1.7])
def test_a_step_of_second_order_knows_the_slope_of_a_parabola_however_uneven_the_steps(ratio):
    scene, state, op = cheap()
    grid, dt = scene.grid(state.rows), 1e-5
    shape, level = grid.shape, 1e-7

    def mass(time):  # now at 0
        return np.full(shape, level * (1.0 + 0.1 * time / dt + 0.03 * (time / dt) ** 2))

    zeros, touching = np.zeros(shape), np.zeros(shape, np.bool_)
    before = mass(-dt - dt / ratio)
    start = FilmState(zeros + 1e9, zeros + 1e9, touching, mass(-dt), 0.0, mass_before=before, dt=dt / ratio)
    now = instant_of(Case(scene, op), zeros, np.full(shape, scene.plasticity.hardness))
    settings = Settings(1e-9, 1e-3, 100, "scipy")
    scaled = Scaled(now, grid, settings, start, Step(dt, order=2))
    problem = scaled.problem()
    slope = (mass(0.0) / scaled.h_unit - problem.mass_old) * problem.per_dt * scaled.speed / scaled.size * scaled.h_unit
    assert slope == approx(0.1 * level / dt, rel=1e-9)


@pytest.mark.parametrize(("left", "below"), [(0.3, 0.8), (1.0, 0.25), (0.5, 0.5)])
def test_the_value_at_the_centre_is_exact_for_a_twisted_plane_wherever_the_nodes_lie(left, below):
    grid = Grid((np.arange(7) - 3 - left) * 2e-6, (np.arange(5) - 1 - below) * 2e-6)
    x, y = grid.x[None, :], grid.y[:, None]
    assert at_centre(grid, 3.0 + 1e6 * x - 4e5 * y + 1e11 * x * y) == approx(3.0, rel=1e-9)


def test_what_has_been_pressed_into_either_body_hardens_the_film_alike():
    layer = {"plasticity.film_hardness": "1.2 GPa", "plasticity.hardness": "3 GPa", "plasticity.indentation": "total"}
    scene, state, op = cheap(CHEAP | layer)
    full = scene.tribofilm.full_thickness
    bodies = [replace(body, growth=np.full_like(body.growth, 0.5 * full)) for body in state.bodies]
    depth = np.full_like(bodies[0].plastic, 0.4 * full)

    def pressed(*into):
        pair = tuple(replace(body, plastic=depth * part) for body, part in zip(bodies, into, strict=True))
        return solve(scene, op, replace(state, bodies=pair), dry=True).pressure

    none, first, second, halves = pressed(0.0, 0.0), pressed(1.0, 0.0), pressed(0.0, 1.0), pressed(0.5, 0.5)
    assert first == approx(second, rel=1e-9, abs=1.0)
    assert first == approx(halves, rel=1e-9, abs=1.0)
    assert first.max() > 1.05 * none.max()


@pytest.mark.parametrize("radius_y", [4e-3, 10e-3, 40e-3])
def test_a_spinning_ellipse_rubs_with_the_mean_lever_of_hertzs_pressure(radius_y):
    """At the regression level, where solids carry next to all of the load."""
    scene, state, op = cheap({"film.model": "regression", "surface_2.rq": "800 nm", "tribofilm.model": "none"})
    op = replace(op, radius_x=10e-3, radius_y=radius_y, speed_1=1e-9, speed_2=1e-9, spin=10.0)
    found = advance(scene, op, state, 0.0)[1]
    assert found.contact_load_ratio > 0.98
    hertz = hertz_point(op.load, 10e-3, radius_y, scene.solids.reduced_modulus)
    r, angle = np.meshgrid((np.arange(400) + 0.5) / 400, (np.arange(400) + 0.5) / 400 * 2.0 * np.pi)
    pressure = np.sqrt(1.0 - r**2) * r
    lever = (pressure * r * np.hypot(hertz.a * np.cos(angle), hertz.b * np.sin(angle))).sum() / pressure.sum()
    expected = -scene.boundary_friction.bare * found.contact_load_ratio * op.load * lever
    assert found.spin_torque == approx(expected, rel=0.02)
