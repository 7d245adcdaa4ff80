"""A run through the FMU is a run of the core."""

from dataclasses import asdict, replace

import pytest
from fmu_host import hosted

from contact_core import advance, initial_state
from contact_core.quantities import OF_CALLER
from contact_core.scene import with_values

STEPS = [
    (60.0, {}),
    (20.0, {"load": 40.0}),
    (0.5, {"speed_1": 0.2, "speed_2": 0.19}),
    (300.0, {"temperature": 357.0, "load": 53.7}),
]


def bits(outputs):
    return {name: float(value).hex() for name, value in outputs.items() if name not in OF_CALLER}


def direct(scene, steps, state=None):
    """Outputs after initialisation and after each step, and the last state."""
    point = scene.operation.point
    state, outputs = advance(scene, point, state or initial_state(scene), 0.0)
    rows = [outputs]
    for dt, inputs in steps:
        point = replace(point, **inputs)
        state, outputs = advance(scene, point, state, dt)
        rows.append(outputs)
    return [bits(asdict(row)) for row in rows], state


def test_fmu_and_core_agree_bit_for_bit(host, scene):
    host.initialise()
    rows = [host.outputs(), *(host.step(dt, **inputs) for dt, inputs in STEPS)]
    assert [bits(row) for row in rows] == direct(scene, STEPS)[0]
    assert all(row["valid"] for row in rows)
    assert host.log == []


def test_the_outputs_after_initialisation_are_those_of_the_inputs_set_before(host, scene):
    host.initialise(load=30.0)
    point = replace(scene.operation.point, load=30.0)
    assert bits(host.outputs()) == bits(asdict(advance(scene, point, initial_state(scene), 0.0)[1]))


def test_outputs_read_during_initialisation_follow_the_inputs(host):
    host.fmu.setupExperiment()
    host.fmu.enterInitializationMode()
    first = host.get("friction_force")
    host.set(load=30.0)
    second = host.get("friction_force")
    host.fmu.exitInitializationMode()
    assert 0.0 < abs(second) < abs(first)
    assert host.get("friction_force") == second


def test_parameters_set_before_initialisation_make_another_scene(host, scene):
    changed = with_values(scene, {"boundary_friction.bare": 0.2, "surface_1.seed": 7})
    host.initialise(boundary_friction__bare=0.2, surface_1__seed=7)
    rows = [host.outputs(), host.step(60.0)]
    assert [bits(row) for row in rows] == direct(changed, STEPS[:1])[0]


def test_a_run_in_contact_is_the_start_when_initial_state_names_its_file(host, scene, tmp_path):
    _, state = direct(scene, STEPS)
    file = tmp_path / "run in.state"
    file.write_bytes(state.to_bytes())
    host.initialise(initial_state=str(file))
    rows = [host.outputs(), host.step(60.0)]
    assert [bits(row) for row in rows] == direct(scene, STEPS[:1], state)[0]
    assert rows[0]["wear_volume_1"] > 0.0
    assert host.get("initial_state") == str(file).encode()


def test_the_second_run_after_a_reset_is_the_first_run(host):
    first = host.initialise().step(60.0, load=40.0)
    host.fmu.reset()
    assert host.get("load") != 40.0
    assert host.initialise().step(60.0, load=40.0) == first


def test_a_run_does_not_depend_on_logging(host, folder):
    with hosted(folder, logging=False) as silent:
        assert silent.initialise().step(60.0) == host.initialise().step(60.0)


@pytest.mark.parametrize("name", ["load", "temperature"])
def test_inputs_read_back_as_set(host, name):
    host.initialise(**{name: 300.0})
    assert host.get(name) == 300.0
