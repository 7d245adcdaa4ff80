"""`fidelity` changes the level of a contact at any step, and the contact keeps its state."""

import json
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path

import pytest
from comparison import approx
from fmu_host import environment, hosted, unpacked
from mapped_scene import mapped_scene
from replay import replay
from test_run import bits

from contact_core import RangeFlag, advance, initial_state
from contact_core.quantities import LEVELS, OUTPUTS
from fmu_src.package.build import build

FAST, FULL, AUTO, MAP = 1, 2, 3, 4
UP_AND_DOWN = [(60.0, FULL), (30.0, FAST), (300.0, FAST), (60.0, FULL), (5.0, FAST)]
FIELDS = {q.name for q in OUTPUTS if "regression" not in q.levels}


@pytest.fixture(scope="module")
def quick_folder(scene, tmp_path_factory):
    folder = tmp_path_factory.mktemp("quick")
    return unpacked(build(scene.at_level("regression"), folder / "quick.fmu", "embedded"), folder)


def core_rows(scene, steps):
    """Outputs of the core for (step, fidelity)."""
    state, rows = initial_state(scene), []
    for dt, fidelity in steps:
        state, outputs = advance(scene.at_level(LEVELS[fidelity - 1]), scene.operation.point, state, dt)
        rows.append(asdict(outputs))
    return rows


def test_each_step_is_that_of_the_core_at_its_level_and_fields_stand_meanwhile(host, scene):
    expected = core_rows(scene, [(0.0, FULL), *UP_AND_DOWN])
    host.initialise()
    rows = [host.outputs(), *(host.step(dt, fidelity=fidelity) for dt, fidelity in UP_AND_DOWN)]
    for i, (dt, fidelity) in enumerate([(0.0, FULL), *UP_AND_DOWN]):
        if fidelity == FAST:
            expected[i] |= {name: expected[i - 1][name] for name in FIELDS}
            expected[i]["range_flags"] |= RangeFlag.OTHER_LEVEL
        assert bits(rows[i]) == bits(expected[i]), (i, dt)
        assert (rows[i]["fidelity_used"], rows[i]["valid"]) == (fidelity, True)
    assert rows[2]["pressure_max"] == rows[1]["pressure_max"] > 0.0
    assert rows[4]["pressure_max"] != rows[1]["pressure_max"]


def test_the_level_in_use_changes_with_the_next_step_only(stepped):
    before = stepped.outputs()
    stepped.set(fidelity=FAST)
    assert stepped.outputs() == before
    assert before["fidelity_used"] == FULL
    assert stepped.step(1.0)["fidelity_used"] == FAST


def test_what_the_surfaces_have_become_goes_down_and_up_again(stepped):
    before = stepped.outputs()
    fast = stepped.step(600.0, fidelity=FAST)
    back = stepped.step(0.0, fidelity=FULL)
    for name in ("wear_volume_1", "wear_depth_2", "tribofilm_1", "load_cycles_2"):
        assert before[name] < fast[name] == approx(back[name], rel=1e-3)


@pytest.mark.long
def test_a_roll_back_across_a_switch_leaves_no_trace(stepped):
    handle = stepped.fmu.getFMUstate()
    first = [stepped.step(60.0), stepped.step(30.0, fidelity=FAST), stepped.step(30.0, fidelity=FULL)]
    stepped.fmu.setFMUstate(handle)
    stepped.step(90.0, fidelity=FAST)
    low = stepped.fmu.getFMUstate()
    stepped.step(30.0, fidelity=FULL)
    stepped.fmu.setFMUstate(low)
    assert stepped.get("fidelity") == FAST
    stepped.fmu.setFMUstate(handle)
    assert stepped.get("fidelity") == FULL
    assert [stepped.step(60.0), stepped.step(30.0, fidelity=FAST), stepped.step(30.0, fidelity=FULL)] == first
    for state in (handle, low):
        stepped.fmu.freeFMUstate(state)


@pytest.mark.long
def test_a_state_between_two_levels_goes_on_in_another_process(stepped, folder, tmp_path):
    stepped.step(60.0, fidelity=FAST)
    stepped.set(fidelity=FULL)  # asked for, not yet used
    file = tmp_path / "state"
    file.write_bytes(stepped.state())
    steps = [(30.0, {}), (60.0, {"fidelity": FAST}), (30.0, {"fidelity": FULL})]
    run = subprocess.run(
        [sys.executable, str(Path(__file__).with_name("replay.py")), str(folder), str(file), json.dumps(steps)],
        capture_output=True,
        check=True,
        env=environment(),
    )
    assert json.loads(run.stdout) == replay(stepped, file.read_bytes(), steps)


@pytest.mark.parametrize("fidelity", [0, 5, -1])
def test_a_level_that_there_is_not_is_refused_and_the_next_good_one_recovers(stepped, fidelity):
    before = stepped.outputs()
    assert stepped.step(60.0, fidelity=fidelity) == before | {"valid": False}
    known = "1 (regression) or 2 (deterministic) or 3 (auto) or 4 (map)"
    assert stepped.log[0][1] == f"fidelity = {fidelity} must be {known}."
    assert stepped.step(60.0, fidelity=FULL)["valid"]


def test_a_map_of_another_scene_is_refused_and_the_next_good_level_recovers(stepped):
    before = stepped.outputs()
    assert stepped.step(60.0, fidelity=MAP) == before | {"valid": False}
    assert "belongs to another contact" in stepped.log[0][1] or "There is no shipped map" in stepped.log[0][1]
    assert "tribofmu map" in stepped.log[0][1]
    assert stepped.step(60.0, fidelity=FULL)["valid"]


def test_an_fmu_takes_the_map_of_its_scene_along(tmp_path):
    design = mapped_scene(tmp_path)
    folder = unpacked(build(design, tmp_path / "mapped.fmu", "embedded"), tmp_path)
    (tmp_path / "map.json").unlink()
    design = mapped_scene(tmp_path / "again")
    with hosted(folder) as host:
        host.initialise()
        rows = [host.step(dt, fidelity=fidelity) for dt, fidelity in ((60.0, MAP), (30.0, FAST), (60.0, MAP))]
    for row, expected in zip(
        rows, core_rows(design, [(0.0, MAP), (60.0, MAP), (30.0, FAST), (60.0, MAP)])[1:], strict=True
    ):
        assert bits(row) == bits({name: expected[name] for name in bits(row)})
    assert rows[0]["fidelity_used"] == MAP
    assert rows[0]["error_friction"] < 0.5 * rows[1]["error_friction"]


def test_the_first_evaluation_is_at_the_level_asked_for_and_shows_nothing_of_another(host, scene):
    host.fmu.setupExperiment()
    host.fmu.enterInitializationMode()
    assert host.get("pressure_max") > 0.0
    host.set(fidelity=FAST)
    host.fmu.exitInitializationMode()
    found = host.outputs()
    expected = core_rows(scene, [(0.0, FAST)])[0]
    expected["range_flags"] |= RangeFlag.OTHER_LEVEL
    assert bits(found) == bits(expected)
    assert found["fidelity_used"] == FAST
    assert found["pressure_max"] == 0.0
    first = host.step(60.0)
    host.restore(state := host.state())
    assert host.state() == state
    assert first["valid"]
    assert host.log == []


def test_the_fmu_of_a_fast_scene_has_both_levels_and_the_outputs_of_its_own(quick_folder, scene):
    quick = scene.at_level("regression")
    steps = [(60.0, FAST), (30.0, FULL), (30.0, FAST)]
    with hosted(quick_folder) as host:
        assert int(host.variables["fidelity"].start) == FAST
        host.initialise()
        rows = [host.step(dt, fidelity=fidelity) for dt, fidelity in steps]
    for row, expected, (_, fidelity) in zip(rows, core_rows(quick, [(0.0, FAST), *steps])[1:], steps, strict=True):
        assert bits(row) == bits({name: expected[name] for name in bits(row)})
        assert row["fidelity_used"] == fidelity
        assert not row["range_flags"] & RangeFlag.OTHER_LEVEL


def test_fidelity_is_tunable_and_starts_at_the_level_of_the_scene(host):
    variable = host.variables["fidelity"]
    assert (variable.type, variable.causality, variable.variability) == ("Integer", "parameter", "tunable")
    assert (int(variable.start), int(variable.min), int(variable.max)) == (FULL, FAST, MAP)
    assert host.get("fidelity_used") == 0


@pytest.mark.long
def test_a_line_changes_level_like_the_core_and_rolls_back(line_folder, line_scene):
    steps = [(5.0, FULL), (10.0, FAST), (5.0, AUTO), (5.0, FULL)]
    expected = core_rows(line_scene, [(0.0, FULL), *steps])[1:]
    with hosted(line_folder) as host:
        host.initialise()
        handle, start = host.fmu.getFMUstate(), host.time
        rows = [host.step(dt, fidelity=fidelity) for dt, fidelity in steps]
        host.fmu.setFMUstate(handle)
        host.time = start
        assert [host.step(dt, fidelity=fidelity) for dt, fidelity in steps] == rows
        host.fmu.freeFMUstate(handle)
    for i in (0, 3):
        assert bits(rows[i]) == bits({name: expected[i][name] for name in bits(rows[i])})
    fast = {name for name in bits(rows[1]) if name not in FIELDS and name != "range_flags"}
    for i in (1, 2):
        assert {name: rows[i][name] for name in fast} == {name: expected[i][name] for name in fast}
