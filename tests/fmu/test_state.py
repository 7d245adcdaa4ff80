"""Save, step, restore, step: the same bits, in this process and in another."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import unpacked
from fmu_host import environment, hosted
from replay import STEPS, replay

from fmu_src import build


@pytest.fixture
def live(host):
    """An FMU that has never been restored."""
    host.initialise()
    host.step(60.0, load=50.0)
    return host


def steps(host):
    return [{k: float(v).hex() for k, v in host.step(dt, **inputs).items()} for dt, inputs in STEPS]


def test_a_state_in_memory_replays_bit_for_bit_as_often_as_asked(live):
    handle = live.fmu.getFMUstate()
    first = steps(live)
    for _ in range(2):
        live.fmu.setFMUstate(handle)
        assert steps(live) == first
    live.fmu.freeFMUstate(handle)
    assert first[0] != first[1]


def test_a_serialised_state_replays_bit_for_bit(live):
    state = live.state()
    first = steps(live)
    assert replay(live, state) == first
    assert live.log == []


def test_the_same_state_has_the_same_bytes_also_after_a_round_trip(live):
    state = live.state()
    assert live.state() == state
    live.step(60.0)
    live.restore(state)
    assert live.state() == state


def test_another_instance_continues_where_the_first_stood(live, folder):
    state = live.state()
    with hosted(folder) as second:
        assert replay(second, state) == steps(live)


def test_a_fresh_process_continues_bit_for_bit(live, folder, tmp_path):
    file = tmp_path / "fmu.state"
    file.write_bytes(live.state())
    run = subprocess.run(
        [sys.executable, str(Path(__file__).with_name("replay.py")), str(folder), str(file)],
        capture_output=True,
        text=True,
        check=True,
        env=environment(),
    )
    assert json.loads(run.stdout) == steps(live)


def test_parameters_travel_with_the_state(host, folder):
    host.initialise(boundary_friction__bare=0.2)
    state, first = host.state(), host.step(60.0)
    with hosted(folder) as second:
        second.initialise()
        second.restore(state)
        assert second.get("boundary_friction.bare") == 0.2
        assert second.step(60.0) == first


def test_a_state_before_initialisation_can_be_kept_and_initialised_later(host):
    state = host.state()
    first = host.initialise().outputs()
    host.restore(state)
    assert not host.get("valid")
    assert host.initialise().outputs() == first


@pytest.mark.parametrize(
    "damage",
    [
        lambda data: b"",
        lambda data: b"something else",
        lambda data: data[:40],
        lambda data: data[:-8],
        lambda data: data.replace(b'"values": [', b'"values": {', 1),
    ],
)
def test_a_damaged_state_is_refused_and_the_contact_stands(stepped, damage):
    state, before = stepped.state(), stepped.outputs()
    stepped.restore(damage(state))
    assert stepped.outputs() == before | {"valid": False}
    assert len(stepped.log) == 1
    assert stepped.step(60.0)["valid"]


def test_a_state_of_another_scene_is_refused(stepped, other_scene, tmp_path):
    with hosted(unpacked(build(other_scene, tmp_path / "other.fmu", "embedded"), tmp_path / "other")) as other:
        state = other.initialise().state()
    before = stepped.outputs()
    stepped.restore(state)
    assert stepped.outputs() == before | {"valid": False}
    assert stepped.step(60.0)["valid"]
