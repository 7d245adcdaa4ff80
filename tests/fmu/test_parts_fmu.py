"""The FMU of every component: valid, the component's own functions bit for bit, and it continues after a bad input."""

import math
import re
import sys
import zipfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.model_description import read_model_description
from fmpy.validation import validate_fmu
from fmu_host import Host, hosted, unpacked

from contact_core.errors import SceneError
from system_models.machines.ball_bearing.geometry import BEARING_209
from system_models.machines.ball_bearing.part import BallBearing
from system_models.machines.gear_pair.geometry import FZG_C
from system_models.machines.gear_pair.mesh import GearMesh
from system_models.machines.gear_pair.shafts import GearShafts
from system_models.parts.build import build
from system_models.parts.part import Part, Start, indexed
from system_models.parts.shaft import Shaft
from system_models.parts.timetable import Entry, Signal, Timetable

sys.path.insert(0, str(Path(__file__).parents[1]))
from component_examples import EXAMPLES

BEARING = {"force_y": 2000.0, "speed": 300.0, indexed("friction_force_inner", 1): 0.4}
MESH = {"torque": 135.0, "speed_1": 230.0, "speed_2": 153.0, indexed("friction_force", 2): -30.0}
SHAFTS = {"drive_torque": 60.0, "speed_drive": 205.0, "brake_torque": 90.0, "friction_torque_1": -1.0}
SIGNAL = Signal("load", "N", (Entry(0.0, 20.0), Entry(0.06, 35.0), Entry(0.5, 5.0)))
SYSTEMS: dict[str, tuple[Part, dict[str, float]]] = {
    "bearing": (BallBearing(dimensions=BEARING_209, levels=2), BEARING),
    "mesh": (GearMesh(pair=FZG_C, stations=5), MESH),
    "shafts": (
        GearShafts(pair=FZG_C, inertia_1=0.01, inertia_2=0.03, stiffness=1e8, coupling=2.0, start_speed=200.0),
        SHAFTS,
    ),
    "timetable": (Timetable((SIGNAL,)), {}),
}
STEPS = (0.01, 0.05, 1e-4, 2.0, 300.0)


@pytest.fixture(scope="module", params=[*EXAMPLES, *SYSTEMS])
def example(request: pytest.FixtureRequest) -> tuple[Part, dict[str, float]]:
    """A component with a value for each of its inputs."""
    part, given = (EXAMPLES | SYSTEMS)[request.param]
    return part, {q.name: q.start for q in part.inputs} | given


@pytest.fixture(scope="module")
def file(example: tuple[Part, dict[str, float]], tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build(example[0], tmp_path_factory.mktemp("part") / "part.fmu", "embedded")


@pytest.fixture(scope="module")
def folder(file: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return unpacked(file, tmp_path_factory.mktemp("unpacked"))


@pytest.fixture
def host(folder: Path) -> Iterator[Host]:
    with hosted(folder) as found:
        yield found


def told(host: Host) -> dict[str, float]:
    return {name: value for name, value in host.outputs().items() if name != "valid"}


def at_rest(part: Part) -> dict[str, float]:
    return {q.name: q.start for q in part.inputs}


def own(part: Part, inputs: dict[str, float], steps: tuple[float, ...], first=None) -> list[dict[str, float]]:
    """Outputs at the start, for the inputs `first` if others, and after each step."""
    state = part.initial(first or inputs)
    found = [part.outputs(state, first or inputs)]
    for step in steps:
        state = part.advance(state, inputs, step)
        found.append(part.outputs(state, inputs))
    return found


def test_the_file_is_valid_and_says_what_the_component_has(file, example):
    part, _ = example
    assert validate_fmu(str(file)) == []
    description = read_model_description(str(file))
    names = {v.name: v for v in description.modelVariables}
    assert [n for n, v in names.items() if v.causality == "input"] == [q.name for q in part.inputs]
    assert [n for n, v in names.items() if v.causality == "output"] == [*(q.name for q in part.responses), "valid"]
    assert all(names[q.name].unit == (q.unit or None) for q in (*part.inputs, *part.responses))
    with zipfile.ZipFile(file) as archive:
        assert "documentation/index.html" in archive.namelist()


def test_the_description_names_what_the_first_outputs_depend_on_unless_it_is_all(file, example):
    part, inputs = example
    description = read_model_description(str(file))
    parameters = {v.name for v in description.modelVariables if v.causality == "parameter"}
    direct = {q.name: q.direct for q in part.responses} | {"valid": ()}
    every = {*parameters, *inputs}
    assert [u.variable.name for u in description.initialUnknowns] == list(direct)
    for unknown in description.initialUnknowns:
        expected = {*parameters, *part.at_start, *direct[unknown.variable.name]}
        found = None if unknown.dependencies is None else {v.name for v in unknown.dependencies}
        assert found == (None if expected == every else expected)


def test_a_run_is_that_of_the_component(host, example):
    part, inputs = example
    host.initialise(**at_rest(part))
    found = [told(host)]
    for step in STEPS:
        host.step(step, **inputs)
        found.append(told(host))
    assert found == own(part, inputs, STEPS, at_rest(part))
    assert host.log == []
    assert found[-1] != found[0]


def test_fmpy_simulates_what_the_component_says(file, example):
    part, inputs = example
    names = [q.name for q in part.responses]
    step, count = 0.02, 5
    rows = simulate_fmu(str(file), stop_time=count * step, output_interval=step, start_values=inputs, output=names)
    expected = own(part, inputs, (step,) * count)
    assert len(rows) == count + 1
    for row, values in zip(rows, expected, strict=True):
        np.testing.assert_allclose([row[name] for name in names], list(values.values()), rtol=1e-9, atol=1e-12)


def test_a_state_goes_back_and_into_another_instance_bit_for_bit(host, folder, example):
    _, inputs = example
    host.initialise(**inputs)
    host.step(0.05)
    data = host.state()
    handle = host.fmu.getFMUstate()
    once = [host.step(0.01), host.step(7.0)]
    host.fmu.setFMUstate(handle)
    assert [host.step(0.01), host.step(7.0)] == once
    host.fmu.freeFMUstate(handle)
    host.restore(data)
    assert host.state() == data
    assert [host.step(0.01), host.step(7.0)] == once
    with hosted(folder) as other:
        other.initialise()
        other.restore(data)
        assert [other.step(0.01), other.step(7.0)] == once


def test_time_is_where_the_last_step_ended_and_travels_with_the_state(host, example):
    _, inputs = example
    host.fmu.setupExperiment(startTime=5.0)
    host.fmu.enterInitializationMode()
    assert host.get("time") == 5.0
    host.fmu.exitInitializationMode()
    host.time = 5.0
    host.step(0.5, **inputs)
    state = host.state()
    host.step(2.0)
    assert host.get("time") == 7.5
    host.restore(state)
    assert host.get("time") == 5.5
    host.fmu.reset()
    assert host.get("time") == 0.0


def test_a_bad_input_makes_it_invalid_and_it_goes_on(host, example):
    part, inputs = example
    if not part.inputs:
        pytest.skip("it has no inputs")
    host.initialise(**inputs)
    before = host.step(0.05)
    bad = part.inputs[-1].name
    stuck = host.step(0.05, **{bad: math.nan})
    assert stuck == before | {"valid": False}
    assert any(bad in text for _, text in host.log)
    assert host.step(0.05, **inputs) == own(part, inputs, (0.05, 0.05))[-1] | {"valid": True}


def raises(*_):
    raise ZeroDivisionError("surprising")


def overflows(*_):
    return {q.name: sign * math.inf for q, sign in zip(Shaft(1.0).responses, (1, -1, 1), strict=True)}


def no_number(*_):
    return (math.nan, 0.0)


@pytest.mark.parametrize("broken", [{"outputs": raises}, {"outputs": overflows}, {"advance": no_number}])
def test_a_step_that_fails_in_any_way_leaves_no_trace_in_the_state(broken, tmp_path, monkeypatch):
    folder = unpacked(build(Shaft(0.02, 0.1), tmp_path / "shaft.fmu", "embedded"), tmp_path / "shaft")
    with hosted(folder) as host:
        host.initialise(torque_drive=1.0)
        before, state = host.step(0.05), host.state()
        with monkeypatch.context() as patch:
            for name, instead in broken.items():
                patch.setattr(Shaft, name, instead)
            assert host.step(0.05) == before | {"valid": False}
        stepped = host.step(0.05)
        host.restore(state)
        assert stepped | {"valid": True} == host.step(0.05)


def test_the_first_outputs_depend_only_on_the_inputs_named_for_them(example):
    part, inputs = example
    assert set(part.at_start) <= set(inputs)
    first = own(part, inputs, ())[0]
    for name in inputs.keys() - set(part.at_start):
        others = own(part, inputs | {name: inputs[name] + 1.0}, ())[0]
        assert {n for n in first if others[n] != first[n]} <= {q.name for q in part.responses if name in q.direct}


def test_each_input_named_for_the_start_matters_there(example):
    part, inputs = example
    for name in part.at_start:
        assert part.initial(inputs | {name: inputs[name] + 1.0}) != part.initial(inputs)


def test_inputs_start_where_the_component_says(tmp_path: Path) -> None:
    part = replace(EXAMPLES["load_arm"][0], starts=(Start("load_setpoint", 40.0),))
    folder = unpacked(build(part, tmp_path / "arm.fmu", "embedded"), tmp_path / "arm")
    starts = {v.name: v.start for v in read_model_description(str(folder)).modelVariables if v.causality == "input"}
    assert starts == {"load_setpoint": "40.0"}
    with hosted(folder) as host:
        host.initialise()
        assert host.outputs()["load"] == part.outputs((40.0, 0.0), {})["load"]


@pytest.mark.parametrize(
    ("start", "says"),
    [
        (Start("load_setpiont", 40.0), "starts names no input: 'load_setpiont'. Did you mean 'load_setpoint'?"),
        (
            Start("load_setpoint", -1.0),
            "starts: load_setpoint = -1 N (load to reach, ",
        ),
    ],
)
def test_starts_that_cannot_be_used_are_refused(start: Start, says: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=re.escape(says)):
        build(replace(EXAMPLES["load_arm"][0], starts=(start,)), tmp_path / "arm.fmu", "embedded")
