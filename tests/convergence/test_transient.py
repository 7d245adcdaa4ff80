"""Films that follow load, speeds and radii in time: against a closed form, and their order in time."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from comparison import HARD, approx

from contact_core import Scene, initial_state, march
from contact_core.film.instant import FilmState, Grid, Instant, Settings, Step
from contact_core.film.routes import solve_film
from contact_core.laws.density import Incompressible
from contact_core.shapes import Line, Point

R, ETA, LOAD, H0 = 10e-3, 0.1, 1e-3, 20e-6
TAU = 6.0 * np.pi * ETA * R**2 / LOAD


def isoviscous(pressure, temperature):
    return np.full_like(pressure, ETA)


@lru_cache
def sunk(points, steps, order=1, width=6.0, speed=0.0, conserving=False):
    """Gap over h0 of a ball that sinks towards a plane through oil for the time tau = 6 pi eta R^2 / W."""
    grid = Grid.centred(points, points, 2.0 * width * np.sqrt(2.0 * R * H0) / (points - 1))
    now = Instant(
        load=LOAD,
        entrainment_speed=speed,
        temperature=300.0,
        shape=Point(R, R),
        reduced_modulus=1e18,
        viscosity=isoviscous,
        density=Incompressible(),
        heights=np.zeros(grid.shape),
        limit=np.full(grid.shape, 1e12),
        hardness=1e12,
        conserving=conserving,
    )
    zeros = np.zeros(grid.shape)
    state = FilmState(zeros, zeros, zeros > 0.0, H0 + grid.radius_2 / (2.0 * R), H0)
    for _ in range(steps):
        found = solve_film(now, grid, Settings(1e-9, 1e-7, 200, "scipy"), state, Step(TAU / steps, 0, order, True))
        assert found.converged, found.shortfall
        state = found.state
    return state.rigid_gap / H0


def extrapolated(points, width=6.0):
    """The same at a time step of zero."""
    coarse, fine = (sunk(points, steps, 2, width) for steps in (10, 20))
    return fine + (fine - coarse) / 3.0


def test_a_ball_sinks_as_by_its_closed_form_at_second_order_in_space():
    # W = 6 pi eta R^2 V / h of a rigid ball, so h = h0 exp(-W t / (6 pi eta R^2)): exp(-1) after tau
    errors = [extrapolated(points) * np.e - 1.0 for points in (25, 49)]
    assert errors[1] + (errors[1] - errors[0]) / 3.0 == approx(0.0, abs=0.01)
    assert np.log2(errors[0] / errors[1]) == approx(2.0, abs=0.15)


def test_what_lies_beyond_the_grid_carries_its_part():
    narrow, wide = (extrapolated(points, width) for points, width in ((25, 3.0), (49, 6.0)))  # the same nodes
    assert narrow == approx(wide, rel=2e-3)


@pytest.mark.parametrize("order", [1, 2])
def test_sinking_has_the_order_in_time_that_was_asked_for(order):
    coarse, middle, fine = (sunk(17, steps, order) for steps in (10, 20, 40))
    assert np.log2((coarse - middle) / (middle - fine)) == approx(order, abs=0.25)


def test_sinking_does_not_notice_a_slight_entrainment_either_way():
    rest, forward, back = (sunk(25, 5, speed=speed) for speed in (0.0, 1e-7, -1e-7))
    assert forward == approx(rest, rel=1e-4)
    assert back == approx(forward, rel=1e-10)


def test_a_film_without_cavities_sinks_the_same_where_cavities_would_keep_their_oil():
    assert sunk(25, 5, conserving=True) == approx(sunk(25, 5), rel=1e-6)


def test_a_cylinder_sinks_as_by_its_closed_form():
    # p = 6 eta V R / h^2, so W / L = 3 pi sqrt(2) eta V (R / h)^1.5 and 1 / sqrt(h) grows at a steady rate
    load, first = 10.0, 2e-6  # N/m, m
    grid = Grid(np.linspace(-1.0, 1.0, 513) * 12.0 * np.sqrt(2.0 * R * first), np.zeros(1), periodic=True)
    zeros = np.zeros(grid.shape)
    now = Instant(
        load=load * grid.spacing,
        entrainment_speed=0.0,
        temperature=300.0,
        shape=Line(R, grid.spacing),
        reduced_modulus=1e18,
        viscosity=isoviscous,
        density=Incompressible(),
        heights=zeros,
        limit=np.full(grid.shape, 1e15),
        hardness=1e15,
    )
    rate = load / (6.0 * np.sqrt(2.0) * np.pi * ETA * R**1.5)
    time = 0.5 / np.sqrt(first) / rate  # until 1 / sqrt(h) is one and a half times what it was
    ends = []
    for steps in (10, 20):
        state = FilmState(zeros, zeros, zeros > 0.0, first + grid.x[None, :] ** 2 / (2.0 * R), first)
        for _ in range(steps):
            step = Step(time / steps, 0, 2, True)
            found = solve_film(now, grid, Settings(1e-11, 1e-7, 200, "scipy"), state, step)
            assert found.converged, found.shortfall
            state = found.state
        ends.append(state.rigid_gap)
    assert ends[1] + (ends[1] - ends[0]) / 3.0 == approx(first / 2.25, rel=4e-3)


RAMP = 1e-4  # s: about a passage of the oil; in 32 steps or fewer more than a node each, in 64 less


@lru_cache
def rolling():
    """A smooth scene and the first instant of its marches."""
    changes = HARD | {
        "film.points": "65",
        "film.domain": "0.4 mm",
        "surface_1.rq": "0 m",
        "surface_2.rq": "0 m",
        "film.tolerance": "1e-6",
        "operation.load": "10 N",
    }
    scene = Scene.from_toml("mtm_zddp", changes)
    op = replace(scene.operation.point, speed_1=3.2, speed_2=2.8)
    return scene, op, next(march(scene, initial_state(scene), lambda time: op, [0.0]))


def ramped(name, time):
    """An operating point after some of the ramp."""
    scene, op, _ = rolling()
    x = min(max(time / RAMP, 0.0), 1.0)
    part = x * x * (3.0 - 2.0 * x)
    radius = scene.radii(op)[0] * (1.0 + 0.5 * part)
    return {
        "load": replace(op, load=10.0 * (1.0 + part)),
        "speed": replace(op, speed_1=3.2 * (1.0 + 0.5 * part), speed_2=2.8 * (1.0 + 0.5 * part)),
        "radius": replace(op, radius_x=radius, radius_y=radius),
    }[name]


@lru_cache
def after_ramp(name, steps, order):
    scene, _, first = rolling()
    times = np.linspace(0.0, RAMP, steps + 1)
    *_, last = march(scene, first.state, lambda time: ramped(name, time), times, order=order)
    assert last.fields.converged, last.fields.shortfall
    return np.array([last.outputs[each] for each in ("h_c", "h_central", "friction_force")])


@pytest.mark.parametrize(
    ("name", "order"),
    [*(pytest.param(*each, marks=pytest.mark.long) for each in [("speed", 2), ("radius", 1)]), ("radius", 2)],
)
def test_ramps_converge_in_time_with_the_order_asked_for(name, order):
    exact = (4.0 * after_ramp(name, 64, 2) - after_ramp(name, 32, 2)) / 3.0
    errors = [np.abs(after_ramp(name, steps, order) / exact - 1.0).max() for steps in (8, 16, 32)]
    assert 0.5 * np.log2(errors[0] / errors[2]) == approx(order, abs=0.4)
    assert errors[2] < 4e-3 / order


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "steps", "near"),
    [("load", 32, 1e-3), ("load", 128, 2e-3), ("radius", 32, 1e-3), ("radius", 128, 2e-3)],
)
def test_both_orders_converge_to_the_same_films(name, steps, near):
    """First-order steps of less than a node carry the film over by another rule, which differs on this grid."""
    first = 2.0 * after_ramp(name, steps, 1) - after_ramp(name, steps // 2, 1)
    assert first == approx(after_ramp(name, 64, 2), rel=near)


@pytest.mark.long
def test_a_film_settles_to_the_steady_one_of_the_new_load():
    scene, op, first = rolling()
    more = replace(op, load=20.0)
    times = np.linspace(0.0, 4.0 * RAMP, 41)
    *_, last = march(scene, first.state, lambda time: more if time > 0.0 else op, times)
    steady = next(march(scene, initial_state(scene), lambda time: more, [0.0]))
    for name in ("h_c", "h_central", "friction_force", "approach"):
        assert last.outputs[name] == approx(steady.outputs[name], rel=1e-3)
    assert abs(first.outputs["h_c"] / steady.outputs["h_c"] - 1.0) > 0.02
