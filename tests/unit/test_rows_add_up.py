"""Friction, power and heat of every row: parts that oppose the sliding and add up, whatever drives the blocks."""

from dataclasses import replace

import pytest
from cheap_scene import CHEAP, cheap
from comparison import approx

from contact_core import Scene, advance, initial_state, shipped_scenes

COARSE = CHEAP | {"film.points": "25", "surface_1.correlation_length": "22 um", "surface_2.correlation_length": "22 um"}
FIELD = {"heat.model": "field", "heat.bulk.model": "lumped"} | {
    f"heat.bulk.{name}_{body}": value
    for name, value in (("heat_capacity", "500 J/K"), ("conductance", "0.05 W/K"))
    for body in (1, 2)
}
SMALL_SHIPPED = {"film.points": "25", "surface_1.correlation_length": "50 um", "surface_2.correlation_length": "50 um"}


def checked(op, outputs, *, equal_bodies=True):
    """The row's parts oppose the sliding and add up."""
    slide, spin = op.sliding_speed, op.spin
    assert outputs.friction_force == approx(outputs.friction_solid + outputs.friction_fluid, rel=1e-14, abs=0.0)
    power = -outputs.friction_force * slide - outputs.spin_torque * spin
    assert outputs.power_loss == approx(power, rel=1e-9, abs=1e-15)
    assert outputs.heat_flow_1 + outputs.heat_flow_2 == approx(outputs.power_loss, rel=1e-14, abs=0.0)
    assert outputs.power_loss >= 0.0
    assert 0.0 <= outputs.contact_load_ratio <= 1.0 + 1e-9
    if spin == 0.0:
        assert outputs.friction_solid * slide <= 0.0
        assert outputs.friction_fluid * slide <= 0.0
    if spin == 0.0 == slide:
        assert outputs.friction_solid == outputs.friction_fluid == 0.0
    if equal_bodies:
        assert outputs.heat_flow_1 >= 0.0 and outputs.heat_flow_2 >= 0.0


def points(op):
    """A duty: the point of reference, sliding the other way, pure rolling, rest of one body, spin, no load."""
    slower = replace(op, speed_1=op.speed_2, speed_2=op.speed_1)
    return [
        op,
        slower,
        replace(op, speed_1=op.speed_2),
        replace(op, speed_2=0.0),
        replace(op, spin=30.0),
        replace(op, speed_1=-op.speed_2),
        replace(op, load=0.0),
        op,
    ]


MIXED = {"control.longest": "60 s", "control.mixed_instants": "2"}


@pytest.mark.parametrize(
    ("level", "changes"),
    [
        pytest.param("deterministic", MIXED | FIELD, id="field"),
        pytest.param("deterministic", {"control.driver": "dry"}, id="dry"),
        pytest.param("deterministic", MIXED, id="mixed", marks=pytest.mark.long),
        pytest.param("regression", {}, id="regression"),
        pytest.param("regression", FIELD, id="regression_field"),
        pytest.param("auto", MIXED, id="auto", marks=pytest.mark.long),
    ],
)
def test_every_row_of_a_changing_duty_adds_up_and_opposes_the_sliding(level, changes):
    scene, state, op = cheap(COARSE | {"tribofilm.beyond_fit": "extrapolate"} | changes)
    scene, equal = scene.at_level(level), "heat.model" not in changes
    for now in points(op):
        for dt in (0.0, 0.5):
            state, outputs = advance(scene, now, state, dt)
            checked(now, outputs, equal_bodies=equal)


def test_rows_add_up_while_a_film_follows_its_inputs_and_where_time_stands_still():
    """Before the first instant after a change, the row is that of the film as it was: power by its own speeds."""
    scene, state, op = cheap(control__inputs="transient", control__mixed_instants=3)
    back = replace(op, speed_1=op.speed_2, speed_2=op.speed_1)
    state, outputs = advance(scene, op, state, 1.0)
    _, still = advance(scene, back, state, 0.0)
    checked(op, still)
    for now in (back, replace(back, load=0.8 * op.load), op):
        state, outputs = advance(scene, now, state, 2e-4)
        checked(now, outputs)


@pytest.mark.parametrize("level", ["deterministic", "regression"])
@pytest.mark.parametrize("name", shipped_scenes())
def test_rows_of_a_shipped_scene_add_up(name, level):
    scene = Scene.from_toml(name, SMALL_SHIPPED).at_level(level)
    state, op = initial_state(scene), scene.operation.point
    for dt in (0.0, 5.0):
        state, outputs = advance(scene, op, state, dt)
        checked(op, outputs)
