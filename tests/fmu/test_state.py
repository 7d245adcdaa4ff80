"""Save, step, restore, step: the same bits, in this process and in another."""

import contextlib
import importlib
import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import fmi2Error
from fmu_host import environment, hosted, unpacked
from hypothesis import given
from hypothesis import strategies as st
from replay import STEPS, replay

from contact_core import StateError
from contact_core.quantities import LEVELS
from fmu_src.package.build import build
from fmu_src.runtime.resources import module_name
from fmu_src.runtime.snapshot import Layout, Snapshot
from fmu_src.variables import variables


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
        lambda data: data + b"\0",
        lambda data: data.replace(b'"stepping"', b'"standing"', 1),
        lambda data: data.replace(b"tribofmu", b"tribofmo", 2),
        lambda data: data.replace(b"FMU 3", b"FMU 2", 1),
    ],
)
def test_a_damaged_state_is_refused_and_the_contact_stands(stepped, damage):
    state, before = stepped.state(), stepped.outputs()
    assert damage(state) != state
    stepped.restore(damage(state))
    assert stepped.outputs() == before | {"valid": False}
    assert len(stepped.log) == 1
    assert stepped.log[0][0] == fmi2Error
    first = stepped.step(60.0)
    stepped.restore(state)
    assert stepped.step(60.0) == first


@pytest.fixture(scope="module")
def read(scene):
    """Read a serialised state as the slave does, with existing scenes."""
    table = variables(scene)
    scenes = tuple(scene.at_level(level) for level in LEVELS)

    module, layout = module_name(scene), Layout([v.start for v in table])

    def read(data):
        return Snapshot.from_bytes(data, module, layout, lambda values: scenes)

    return read


def positions(data):
    """Every byte up to the contact state's arrays, and then one in about a hundred; the last one too."""
    front = data.index(b"tribofmu", 1) + 2_000
    return [*range(front), *range(front, len(data), 101), len(data) - 1]


def test_a_state_is_refused_wherever_it_was_cut(read, stored):
    assert read(stored).data == stored
    for length in positions(stored):
        with pytest.raises(StateError, match=r"(Use|Give) .*\."):
            read(stored[:length])


@pytest.mark.parametrize("mask", [0x01, 0x20, 0xFF])
def test_a_state_is_refused_wherever_a_byte_was_changed(read, stored, mask):
    for position in positions(stored):
        changed = bytearray(stored)
        changed[position] ^= mask
        with pytest.raises(StateError, match=r"(Use|Give) .*\."):
            read(bytes(changed))


@given(data=st.binary(max_size=200), kept=st.integers(0, 60))
def test_no_bytes_do_more_than_be_refused(read, stored, data, kept):
    with pytest.raises(StateError):
        read(stored[:kept] + data)


def test_the_length_of_a_header_that_is_not_there_is_refused_before_it_is_read(read, stored):
    start = stored.index(b'["') - 8
    with pytest.raises(StateError, match="was cut or changed"):
        read(stored[:start] + b"\xff\xff\xff\xff" + stored[start + 4 :])


def test_the_contact_of_another_state_is_no_part_of_this_one(read, live, stored):
    other = live.state()
    head, tail = other[: other.index(b"tribofmu", 1)], stored[stored.index(b"tribofmu", 1) :]
    assert head + tail not in (other, stored)
    with pytest.raises(StateError, match="was cut or changed"):
        read(head + tail)


def test_a_well_made_state_of_other_variables_is_refused(read, stored):
    snapshot = read(stored)
    assert read(snapshot.data).values == snapshot.values
    for values in (snapshot.values[:-1], ("text", *snapshot.values[1:]), (1, *snapshot.values[1:])):
        with pytest.raises(StateError, match="other variables"):
            read(replace(snapshot, values=values, layout=Layout(values)).data)


def test_a_state_of_another_scene_is_refused(stepped, other_scene, tmp_path):
    with hosted(unpacked(build(other_scene, tmp_path / "other.fmu", "embedded"), tmp_path / "other")) as other:
        state = other.initialise().state()
    before = stepped.outputs()
    stepped.restore(state)
    assert stepped.outputs() == before | {"valid": False}
    assert "belongs to another FMU" in other.log[0][1]  # fmpy's logger gives all to the last host made
    assert stepped.step(60.0)["valid"]


def test_the_list_of_values_is_the_same_one_after_a_restore(folder, monkeypatch):
    """Readers of the slave's list keep a valid reference."""
    monkeypatch.syspath_prepend(str(folder / "resources"))
    module = importlib.import_module((folder / "resources/slavemodule.txt").read_text())
    instance = module.MixedContact(instance_name="contact", resources=str(folder / "resources"))
    values, layout = instance.values, instance.layout
    assert len(values) == len(layout)
    instance.enter_initialization_mode()
    instance.exit_initialization_mode()
    load = layout.index(("Real", "input"))
    state, before = instance._get_fmu_state(), list(values)
    instance.set_real([load], [30.0])
    instance.do_step(0.0, 60.0)
    assert instance.values is values
    assert values != before
    instance._set_fmu_state(instance._fmu_state_to_bytes(state))
    assert instance.values is values
    assert values == before


def test_inputs_set_before_a_state_that_is_refused_stand_in_every_flavour(flavoured_folder):
    with hosted(flavoured_folder) as host:
        host.initialise()
        state = host.state()
        host.set(load=20.0)
        with contextlib.suppress(FMICallException):  # of the isolated flavour
            host.restore(state[:-1])
        assert host.get("load") == 20.0
        assert host.step(60.0)["valid"]
        told = host.outputs()
        host.restore(state)
        assert host.step(60.0, load=20.0) == told
