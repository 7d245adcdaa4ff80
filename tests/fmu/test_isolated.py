"""The isolated flavour in a host without Python: the host survives every failure of the model."""

import ctypes
import itertools
import math
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from fmpy.fmi1 import FMICallException
from fmu_host import hosted
from isolated import ENDLESS, FAULTS, STEPS, UNSAVED, rows, running, started

from benchmarks.hosts.native_host import ERROR, OK, WARNING, NativeHost

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the processes are looked at as Linux shows them")


@pytest.fixture
def host(native_program: Path) -> Iterator[NativeHost]:
    yield from running(native_program)


def test_the_c_host_and_the_core_agree_bit_for_bit(host, quick, isolated_folder):
    from test_run import bits, direct

    instance = host.load(isolated_folder).instance()
    assert set(instance.initialise()) == {OK}
    found = [instance.outputs(), *rows(instance)]
    expected = [{name: row[name] for name in found[0] if name in row} for row in direct(quick, STEPS)[0]]
    assert {name for name in found[0] if name not in expected[0]} == {"fidelity_used", "valid"}
    assert [{name: bits(row)[name] for name in expected[0]} for row in found] == expected
    assert {status for _, status, _, _ in instance.log} <= {OK}


@pytest.mark.parametrize("load", FAULTS)
def test_a_fault_of_the_model_is_an_error_and_the_saved_state_goes_on_bit_for_bit(host, faulty_folder, load):
    other = started(host, faulty_folder, 1)
    if load in ENDLESS:
        host.ask("environment", "TRIBOFMU_TIMEOUT", "3.75")
    instance = started(host, faulty_folder)
    assert instance.ask("save", 0).status == OK
    expected = rows(instance)
    reason = FAULTS[load][1]
    for _ in range(1 if load in ENDLESS else 2):
        instance.log.clear()
        assert instance.step(1.0, load=load) == ERROR
        assert any(status == ERROR and reason in text for _, status, _, text in instance.log), instance.log
        assert other.step(1.0) == OK
        assert instance.ask("restore", 0).status == OK
        assert rows(instance) == expected


def test_two_hundred_failures_leave_no_trace(host, faulty_folder):
    """Every round fails in one of three ways or more: bad input, a fault in the model, a process that is lost."""
    instance, undisturbed = started(host, faulty_folder), started(host, faulty_folder, 1)
    failures = itertools.cycle([-1.0, 1001.0, math.nan, 1006.0, math.inf, 1010.0, 1e30])
    for round_, load in zip(range(200), failures, strict=False):
        assert instance.ask("save", 0).status == OK
        before = instance.outputs()
        assert instance.step(1.0, load=load) == (ERROR if load in FAULTS else WARNING)
        if load not in FAULTS:
            assert instance.outputs() == before | {"valid": 0}
        assert instance.ask("restore", 0).status == OK
        assert instance.outputs() == before
        for each in (instance, undisturbed):
            assert each.step(0.5, load=20.0 + round_) == OK
    assert instance.outputs() == undisturbed.outputs()


def test_a_lost_worker_says_so_at_every_call_until_a_state_is_restored(host, faulty_folder):
    instance = started(host, faulty_folder)
    instance.step(1.0, load=1006.0)
    calls = [("step", 1.0, 1.0), ("setr", 0, 1.0), ("getr", 0), ("save", 1), ("terminate",)]
    for call in calls:
        answer = instance.ask(*call)
        assert answer.status == ERROR
        assert "Restore a saved state, or reset the FMU" in answer.log[0][3]
    assert instance.ask("reset").status == OK
    assert set(instance.initialise()) == {OK}
    fresh = host.load(faulty_folder).instance(1)
    fresh.initialise()
    assert rows(instance) == rows(fresh)


def test_bytes_of_a_state_survive_the_worker_that_wrote_them(host, faulty_folder, tmp_path):
    instance, file = started(host, faulty_folder), tmp_path / "state"
    assert [instance.ask(*call).status for call in (("save", 0), ("serialize", 0, file), ("freestate", 0))] == [OK] * 3
    expected = rows(instance)
    instance.step(1.0, load=1007.0)
    assert instance.ask("deserialize", 1, file).status == OK
    assert instance.ask("restore", 1).status == OK
    assert rows(instance) == expected


def test_a_state_saved_after_one_that_could_not_be_is_whole(host, faulty_folder, tmp_path):
    instance, file = started(host, faulty_folder), tmp_path / "state"
    instance.ask("save", 0)
    instance.step(1.0)
    instance.set(load=UNSAVED)
    assert instance.ask("save", 1).status == ERROR
    instance.set(load=50.0)
    assert [instance.ask(*call).status for call in (("save", 2), ("serialize", 2, file))] == [OK] * 2
    expected = rows(instance)
    instance.step(1.0, load=1007.0)
    assert [instance.ask(*call).status for call in (("deserialize", 3, file), ("restore", 3))] == [OK] * 2
    assert rows(instance) == expected


def test_a_state_that_is_restored_shows_at_once_and_what_was_set_before_is_gone(host, isolated_folder):
    instance = started(host, isolated_folder)
    instance.ask("save", 0)
    told, expected = [*instance.outputs().items(), instance.get("load")], rows(instance)
    instance.ask("save", 1)
    instance.set(load=60.0, speed_1=0.3)
    for slot in (1, 0):  # the last one counts
        assert instance.ask("restore", slot).status == OK
    assert [*instance.outputs().items(), instance.get("load")] == told
    assert rows(instance) == expected
    assert instance.ask("restore", 0).status == OK
    instance.ask("save", 2)  # which is the same state then
    instance.step(1.0, load=60.0)
    assert instance.ask("restore", 2).status == OK
    assert rows(instance) == expected


def test_a_state_may_be_freed_as_soon_as_it_was_restored(host, isolated_folder):
    instance = started(host, isolated_folder)
    instance.ask("save", 0)
    expected = rows(instance)
    assert [instance.ask(command, 0).status for command in ("restore", "freestate")] == [OK] * 2
    assert rows(instance) == expected
    assert {status for _, status, _, _ in instance.log} <= {OK}


def test_texts_come_back_with_the_state(host, isolated_folder):
    instance = started(host, isolated_folder)
    instance.ask("save", 0)
    expected = rows(instance)
    assert instance.ask("reset").status == OK
    instance.initialise(initial_state="/nowhere")
    instance.step(1.0)
    assert [*instance.get("valid"), *instance.get("initial_state")] == [0, "/nowhere"]
    for _ in range(2):
        assert instance.ask("restore", 0).status == OK
        assert [*instance.get("valid"), *instance.get("initial_state")] == [1, ""]
        assert rows(instance) == expected


def test_calls_that_fmi_does_not_allow_are_errors_and_change_nothing(host, isolated_folder):
    instance = started(host, isolated_folder)
    before = instance.outputs()
    wear, h_c = (instance.fmu.variables[name].valueReference for name in ("wear.bare", "h_c"))
    refused = [
        (("getr", 9999), "There is no Real variable with value reference 9999."),
        (("setb", 0, 1), "There is no Boolean variable with value reference 0."),
        (("setr", h_c, 1.0), "is an output and cannot be set"),
        (("setr", wear, 1.0), "is a fixed parameter"),
        (("derivative", 0, 1), "fmi2GetDirectionalDerivative is not supported"),
    ]
    for call, reason in refused:
        answer = instance.ask(*call)
        assert answer.status == ERROR
        assert reason in answer.log[0][3]
    assert instance.outputs() == before


def test_calls_out_of_turn_are_errors_and_change_nothing(host, isolated_folder):
    instance = host.load(isolated_folder).instance()
    before = [instance.ask(*call) for call in (("step", 0.0, 1.0), ("exit",), ("terminate",))]
    instance.ask("enter")
    within = [instance.ask(*call) for call in (("setup", 0.0), ("enter",), ("step", 0.0, 1.0), ("terminate",))]
    instance.ask("exit")
    outputs = instance.outputs()
    after = [instance.ask(*call) for call in (("setup", 0.0), ("enter",), ("exit",))]
    assert instance.outputs() == outputs
    instance.ask("save", 0)
    assert instance.ask("terminate").status == OK
    ended = [instance.ask(*call) for call in (("step", 0.0, 1.0), ("setr", 0, 1.0), ("terminate",))]
    assert instance.outputs() == outputs
    told = ("before initialisation", "in initialisation mode", "after initialisation", "after fmi2Terminate")
    for when, answers in zip(told, (before, within, after, ended), strict=True):
        assert {answer.status for answer in answers} == {ERROR}
        assert all(f"is not allowed {when}" in answer.log[0][3] for answer in answers)
    assert instance.ask("restore", 0).status == OK
    assert instance.step(1.0) == OK


def test_freed_instances_and_states_are_errors_not_crashes(host, isolated_folder):
    instance = started(host, isolated_folder)
    instance.ask("save", 0)
    instance.ask("save", 1)
    instance.ask("freestate", 0)
    instance.free()
    assert [instance.ask(*call).status for call in (("step", 0.0, 1.0), ("restore", 1), ("save", 2))] == [ERROR] * 3
    instance.free()
    assert started(host, isolated_folder).step(1.0) == OK


def test_a_damaged_state_is_refused_and_nothing_changes(host, isolated_folder, tmp_path):
    instance, file = started(host, isolated_folder), tmp_path / "state"
    instance.ask("save", 0)
    instance.ask("serialize", 0, file)
    data, before = file.read_bytes(), instance.outputs()
    for damaged in (data[:-1], data[: len(data) // 2], b"", data[:200] + bytes([data[200] ^ 1]) + data[201:]):
        file.write_bytes(damaged)
        instance.log.clear()
        assert instance.ask("deserialize", 1, file).status == OK
        assert instance.ask("restore", 1).status == ERROR
        assert "The stored" in instance.log[0][3]
        assert "Use an earlier one" in instance.log[0][3] or "Give one" in instance.log[0][3]
        assert instance.outputs() == before | {"valid": 0}
        assert instance.ask("restore", 0).status == OK
        assert instance.outputs() == before


def test_a_state_is_not_written_beyond_the_room_that_there_is(isolated_folder):
    with hosted(isolated_folder) as host:
        host.initialise()
        state, size = host.fmu.getFMUstate(), ctypes.c_size_t()
        host.fmu.fmi2SerializedFMUstateSize(host.fmu.component, state, ctypes.byref(size))
        room = (ctypes.c_char * size.value)(*b"." * size.value)
        with pytest.raises(FMICallException):
            host.fmu.fmi2SerializeFMUstate(host.fmu.component, state, room, size.value - 1)
        assert room.raw == b"." * size.value
        assert f"The FMU state has {size.value} bytes; there is room for {size.value - 1} only." in host.log[-1][1]
