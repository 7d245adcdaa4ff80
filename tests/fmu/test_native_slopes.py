"""The derivatives of friction in C: those that a step of 0 after a step has in Python."""

from dataclasses import replace

import pytest
from comparison import approx
from mapped_scene import mapped_scene

from benchmarks.fmu import native_scenes
from contact_core import ContactState, OperatingPoint, Outputs, Scene, advance, initial_state
from contact_core.regression import evolution
from contact_core.scene import Case
from fmu_src.native import program

pytestmark = pytest.mark.fmu

LUMPED = {"heat.model": "field", "heat.bulk.model": "lumped"} | {
    f"heat.bulk.{name}_{body}": value
    for body in (1, 2)
    for name, value in (("heat_capacity", "5 J/K"), ("conductance", "0.5 W/K"))
}
GIVEN = {"heat.model": "field", "heat.bulk.model": "inputs"}
POINT = OperatingPoint(load=30.0, speed_1=0.3, speed_2=0.2, temperature=353.0)


def _slopes(outputs: Outputs) -> tuple[float, ...]:
    return tuple(getattr(outputs, name) for name in program.SLOPES)


def _run(scene: Scene) -> tuple[OperatingPoint, ContactState, Outputs]:
    """Return the inputs of a last step, and state and outputs after it."""
    bodies = {"body_temperature_1": 355.0, "body_temperature_2": 351.0} if scene.heat.bulk.from_inputs else {}
    point, state = replace(POINT, **bodies), initial_state(scene)
    for step in (5.0, 1.0, 0.01):
        state, outputs = advance(scene, point, state, step)
    return point, state, outputs


@pytest.mark.parametrize(
    "changes", [{}, LUMPED, GIVEN, {"surface_1.rq": "0 nm"}], ids=["held", "lumped", "given", "rough"]
)
def test_they_are_the_outputs_of_a_step_of_zero_to_the_last_bit(changes):
    scene = native_scenes.scene_of(changes)
    point, state, _ = _run(scene)
    _, after = advance(scene, point, state, 0.0)
    assert program.derivatives(Case(scene, point), state) == _slopes(after)


def test_with_a_map_too(tmp_path):
    scene = mapped_scene(tmp_path)
    point, state, _ = _run(scene)
    _, after = advance(scene, point, state, 0.0)
    assert program.derivatives(Case(scene, point), state) == _slopes(after)


def test_outputs_of_a_step_differ_from_them_only_by_surfaces_that_it_changed_a_little(monkeypatch):
    scene = native_scenes.scene_of({})
    point, state, outputs = _run(scene)
    after = program.derivatives(Case(scene, point), state)
    assert after != _slopes(outputs)
    assert after == approx(_slopes(outputs), rel=1e-3)
    monkeypatch.setattr(evolution, "_SAME", 0.0)  # the contact is evaluated anew after every change
    point, state, outputs = _run(scene)
    assert program.derivatives(Case(scene, point), state) == _slopes(outputs)
