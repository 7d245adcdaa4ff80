"""The isolated flavour in a host that knows nothing of Python: whatever the model does, the host lives and goes on."""

import ctypes
import itertools
import math
import os
import resource
import shutil
import signal
import subprocess
import sys
import threading
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from fmpy.fmi1 import FMICallException
from fmu_host import hosted, unpacked
from native_host import ERROR, NONE, OK, WARNING, Fmu, Instance, NativeHost, plain_environment
from processes import alive, children, descriptors, mapped, soon

from contact_core import Scene
from fmu_src.build import build
from fmu_src.resources import module_name

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the processes are looked at as Linux shows them")

# What the load does to a faulty model.
FAULTS = {
    1001.0: ("raise ValueError('bad 50%')", "ValueError: bad 50%"),
    1002.0: ("raise SystemExit(3)", "SystemExit: 3"),
    1003.0: ("raise KeyboardInterrupt", "KeyboardInterrupt"),
    1004.0: ("raise MemoryError", "MemoryError"),
    1005.0: ("ctypes.string_at(0)", "killed by signal 11 (Segmentation fault).\nFatal Python error"),
    1006.0: ("os._exit(7)", "ended with exit status 7"),
    1007.0: ("os.kill(os.getpid(), 9)", "killed by signal 9"),
    1008.0: ("while True: pass", "no answer within 2.75 s"),
    1009.0: ("sum(range(10**12))", "no answer within 2.75 s"),  # does not let go of the interpreter
    1010.0: ("slave.advance = None", "TypeError: 'NoneType' object is not callable"),  # within the slave's own guard
    1011.0: ("slave.advance = interrupted", "The step was interrupted"),
}
ENDLESS = (1008.0, 1009.0)
UNSAVED = 2000.0  # the load at which a faulty model cannot be saved
SCRIPT = """
import ctypes, os
from fmu_src import slave
from contact_core import advance

def interrupted(*arguments):
    raise KeyboardInterrupt

class MixedContact(slave.ContactSlave):
    def do_step(self, time, step):
        slave.advance = advance
        load = self.values[self._references["load"]]{faults}
        return super().do_step(time, step)

    def _get_fmu_state(self):
        if self.values[self._references["load"]] == {unsaved}:
            raise MemoryError
        return super()._get_fmu_state()
"""
STEPS = [(1.0, {"load": 40.0}), (2.0, {}), (0.5, {"speed_1": 0.2, "load": 60.0})]


@pytest.fixture(scope="module")
def faulty_folder(quick: Scene, isolated_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("faulty") / "fmu"
    shutil.copytree(isolated_folder, folder)
    faults = "".join(f"\n        if load == {load}:\n            {what}" for load, (what, _) in FAULTS.items())
    (folder / "resources" / f"{module_name(quick)}.py").write_text(SCRIPT.format(faults=faults, unsaved=UNSAVED))
    return folder


@pytest.fixture
def host(native_program: Path) -> Iterator[NativeHost]:
    """A host that must end by itself, without a fault, whatever the test did."""
    with NativeHost(native_program, plain_environment()) as host:
        yield host
    assert host.code == 0


def rows(instance: Instance) -> list[dict[str, object]]:
    """Outputs of the steps that all runs are compared by."""
    found = []
    for dt, inputs in STEPS:
        assert instance.step(dt, **inputs) == OK
        found.append(instance.outputs())
    return found


def started(host: NativeHost, folder: Path, number: int = 0) -> Instance:
    return stepped(host.load(folder), number)


def stepped(fmu: Fmu, number: int) -> Instance:
    """An instance after its first step."""
    instance = fmu.instance(number)
    assert instance.created.status == OK, instance.log
    assert set(instance.initialise()) == {OK}
    assert instance.step(1.0, load=50.0) == OK
    return instance


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
        host.ask("environment", "TRIBOFMU_TIMEOUT", "2.75")
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


def test_an_interrupt_is_not_for_the_model(host, isolated_folder):
    instance = started(host, isolated_folder)
    (supervisor,) = host.supervisors()
    (worker,) = children(supervisor)
    for process in (supervisor, worker):
        os.kill(process, signal.SIGINT)
    instance.ask("save", 0)
    first = rows(instance)
    instance.ask("restore", 0)
    assert rows(instance) == first
    assert alive(supervisor)
    assert alive(worker)


def test_a_worker_that_ends_between_calls_is_replaced(host, isolated_folder):
    instance = started(host, isolated_folder)
    instance.ask("save", 0)
    expected = rows(instance)
    (supervisor,) = host.supervisors()
    (worker,) = children(supervisor)
    os.kill(worker, signal.SIGKILL)
    assert soon(lambda: not alive(worker))
    assert instance.ask("restore", 0).status == OK
    assert rows(instance) == expected


def test_a_stop_time_stands_after_the_worker_was_lost(host, isolated_folder):
    instance = host.load(isolated_folder).instance()
    calls = (("setup", 2.0, 5.0), ("enter",), ("exit",), ("save", 0))
    assert [instance.ask(*call).status for call in calls] == [OK] * 4
    (supervisor,) = host.supervisors()
    for worker in children(supervisor):
        os.kill(worker, signal.SIGKILL)
    assert soon(lambda: children(supervisor) == [])
    assert instance.ask("restore", 0).status == OK
    assert instance.step(3.5) == ERROR
    assert "goes beyond stopTime = 5.0 s" in instance.log[-1][3]
    assert instance.step(3.0) == OK
    assert instance.ask("reset").status == OK
    assert set(instance.initialise()) == {OK}
    assert instance.step(9.0) == OK


def test_that_a_worker_has_ended_shows_before_its_supervisor_says_so(host, isolated_folder):
    instance = started(host, isolated_folder)
    instance.ask("save", 0)
    expected = rows(instance)
    (supervisor,) = host.supervisors()
    (worker,) = children(supervisor)
    os.kill(supervisor, signal.SIGSTOP)
    os.kill(worker, signal.SIGKILL)
    assert soon(lambda: not alive(worker))
    goes_on = threading.Timer(0.2, os.kill, (supervisor, signal.SIGCONT))
    goes_on.start()
    assert instance.ask("restore", 0).status == OK
    goes_on.join()
    assert rows(instance) == expected
    assert "killed by signal 9" in instance.log[-1][3]


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


def test_a_worker_that_ends_after_a_restore_is_replaced_at_the_next(host, isolated_folder):
    instance = started(host, isolated_folder)
    instance.ask("save", 0)
    expected = rows(instance)
    assert instance.ask("restore", 0).status == OK
    (supervisor,) = host.supervisors()
    (worker,) = children(supervisor)
    os.kill(worker, signal.SIGKILL)
    assert soon(lambda: not alive(worker))
    assert instance.step(1.0) == ERROR
    assert instance.ask("restore", 0).status == OK
    assert rows(instance) == expected


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


def test_a_lost_supervisor_is_replaced(host, isolated_folder):
    instances = [started(host, isolated_folder, k) for k in range(2)]
    for k, instance in enumerate(instances):
        instance.ask("save", k)
    expected = rows(instances[0])
    (supervisor,) = host.supervisors()
    workers = children(supervisor)
    os.kill(supervisor, signal.SIGKILL)
    assert soon(lambda: not any(map(alive, workers)))
    assert instances[0].step(1.0) == ERROR
    assert "supervisor ended" in instances[0].log[-1][3]
    for k, instance in enumerate(instances):
        assert instance.ask("restore", k).status == OK
        assert rows(instance) == expected


def test_the_reason_of_a_loss_between_calls_is_told(host, isolated_folder):
    first, second = started(host, isolated_folder), started(host, isolated_folder, 1)
    for number, instance in enumerate((first, second)):
        instance.ask("save", number)
    (supervisor,) = host.supervisors()
    workers = children(supervisor)
    for worker in workers:
        os.kill(worker, signal.SIGKILL)
    assert soon(lambda: children(supervisor) == [])
    first.log.clear()
    assert first.step(1.0) == ERROR
    assert "was lost: It was killed by signal 9 (Killed)" in first.log[0][3]
    answer = second.ask("restore", 1)
    assert answer.status == OK
    assert "lost between two calls: It was killed by signal 9 (Killed)" in answer.log[0][3]
    assert first.ask("restore", 0).status == OK

    os.kill(supervisor, signal.SIGKILL)
    assert soon(lambda: not alive(supervisor))
    assert first.ask("reset").status == OK
    answer = second.ask("step", 1.0, 1.0)
    assert answer.status == ERROR
    assert "was lost: Its supervisor ended." in answer.log[0][3]


@pytest.mark.parametrize("victim", ["nobody", "supervisor"])
def test_signals_to_the_host_neither_disturb_nor_delay(native_program, faulty_folder, victim):
    """A periodic signal ends every wait early: limits and losses are noticed all the same, and none is made up."""
    limit = {"TRIBOFMU_TIMEOUT": "3"} if victim == "nobody" else {}
    with NativeHost(native_program, plain_environment() | limit) as host:
        instance = started(host, faulty_folder)
        instance.ask("save", 0)
        (supervisor,) = host.supervisors()
        assert host.ask("alarms", 1000).status == OK
        for _ in range(300):
            assert instance.ask("restore", 0).status == OK
        assert host.supervisors() == [supervisor]
        instance.set(load=1008.0)
        host.tell("step", 0, 1.0, 1.0)
        if victim == "supervisor":
            os.kill(supervisor, signal.SIGKILL)
        answer = host.answer()
        assert answer.status == ERROR
        assert ("no answer within 3 s" if victim == "nobody" else "supervisor ended") in answer.log[0][3]
        assert host.ask("alarms", 0).status == OK


def test_an_instance_for_which_there_is_no_descriptor_is_refused_alone(host, isolated_folder):
    resource.prlimit(host.process.pid, resource.RLIMIT_NOFILE, (40, 40))
    fmu = host.load(isolated_folder)
    instances = []
    while (instance := fmu.instance(len(instances))).created.status == OK:
        instances.append(instance)
        assert set(instance.initialise()) == {OK}
    assert 5 < len(instances) < 20
    assert "Free other instances, or raise limits" in instance.log[0][3]
    assert {instance.step(1.0) for instance in instances} == {OK}
    instances.pop().free()
    (supervisor,) = host.supervisors()
    assert soon(lambda: len(children(supervisor)) == len(instances))
    assert fmu.instance(len(instances)).created.status == OK


def test_the_models_processes_take_the_descriptors_that_they_may_and_need(host, isolated_folder):
    resource.prlimit(host.process.pid, resource.RLIMIT_NOFILE, (40, 4096))
    fmu = host.load(isolated_folder)
    for number in range(25):
        assert fmu.instance(number).created.status == OK
    (supervisor,) = host.supervisors()
    assert len({descriptors(worker) for worker in children(supervisor)}) == 1  # none holds its siblings' files


@pytest.mark.parametrize("load", [None, 1008.0, 1009.0])
def test_the_models_processes_end_with_a_host_that_is_killed(native_program, faulty_folder, load):
    host = NativeHost(native_program, plain_environment())
    instance = started(host, faulty_folder)
    (supervisor,) = host.supervisors()
    processes = [supervisor, *children(supervisor)]
    if load:
        instance.set(load=load)
        host.tell("step", 0, 1.0, 1.0)
    host.process.kill()
    host.close()
    assert len(processes) == 2
    assert soon(lambda: not any(map(alive, processes)))


def test_the_models_processes_end_with_a_host_that_forgets_to_free(native_program, isolated_folder):
    with NativeHost(native_program, plain_environment()) as host:
        started(host, isolated_folder)
        (supervisor,) = host.supervisors()
        processes = [supervisor, *children(supervisor)]
    assert host.code == 0
    assert soon(lambda: not any(map(alive, processes)))


def test_a_child_forked_from_the_host_does_not_keep_the_model_alive(native_program, isolated_folder):
    host = NativeHost(native_program, plain_environment())
    started(host, isolated_folder)
    child = int(host.ask("fork").values[0])
    (supervisor,) = host.supervisors()
    host.process.kill()
    host.close()
    try:
        assert soon(lambda: not alive(supervisor))
    finally:
        os.kill(child, signal.SIGKILL)


@pytest.mark.parametrize("name", ["with space", "Reibschlüssel", "hash#", "plus+", "percent%20", "at@(x)"])
def test_the_fmu_may_lie_in_any_folder(host, isolated_folder, tmp_path, name):
    folder = shutil.copytree(isolated_folder, tmp_path / name)
    assert started(host, folder).step(1.0) == OK


def test_the_resources_are_found_by_their_uri_where_the_library_lies_elsewhere(host, isolated_folder, tmp_path):
    folder = shutil.copytree(isolated_folder, tmp_path / "ü#%20")
    away = tmp_path / "away" / "binaries" / "linux64"
    shutil.copytree(folder / "binaries" / "linux64", away)
    shutil.copy(folder / "modelDescription.xml", tmp_path / "away")
    assert host.load(tmp_path / "away", (folder / "resources").as_uri()).instance().created.status == OK


@pytest.mark.parametrize(
    ("python", "reason"),
    [
        ("/nowhere/python3", "TRIBOFMU_PYTHON names the Python '/nowhere/python3', which cannot be run (No such file"),
        ("no-such-python", "TRIBOFMU_PYTHON names the Python 'no-such-python', which cannot be run (No such file"),
        ("/50%s/python3", "TRIBOFMU_PYTHON names the Python '/50%s/python3', which cannot be run (No such file"),
        (__file__, "which cannot be run (Permission denied)"),
        ("/bin/true", "'/bin/true' ended before it was ready"),
    ],
)
def test_a_python_that_cannot_run_is_named(native_program, isolated_folder, python, reason):
    with NativeHost(native_program, plain_environment() | {"TRIBOFMU_PYTHON": python}) as host:
        instance = host.load(isolated_folder).instance()
    assert instance.created.status == NONE
    assert reason in instance.log[0][3]
    assert "Set TRIBOFMU_PYTHON to the Python of an environment in which tribofmu is installed" in instance.log[0][3]


@pytest.mark.parametrize("limit", ["no", "0", "-1", "1,5", "1e3", "nan", " 1"])
def test_a_limit_that_is_no_number_of_seconds_is_refused(native_program, isolated_folder, limit):
    with NativeHost(native_program, plain_environment() | {"TRIBOFMU_TIMEOUT": limit}) as host:
        instance = host.load(isolated_folder).instance()
    assert instance.created.status == NONE
    assert f"TRIBOFMU_TIMEOUT = '{limit}' must be a number of seconds above 0" in instance.log[0][3]


def test_a_python_without_the_packages_is_named(native_program, isolated_folder, tmp_path):
    bare = tmp_path / "python3"
    bare.write_text(f'#!/bin/sh\nexec {sys.executable} -S "$@"\n')
    bare.chmod(0o755)
    with NativeHost(native_program, plain_environment() | {"TRIBOFMU_PYTHON": str(bare)}) as host:
        instance = host.load(isolated_folder).instance()
    assert instance.created.status == NONE
    assert "No module named" in instance.log[0][3]
    assert f"It was run by '{bare}'." in instance.log[0][3]


def test_the_python_recorded_at_build_is_taken_where_the_variable_is_not_set(native_program, quick, tmp_path):
    folder = unpacked(build(quick, tmp_path / "quick.fmu", python=sys.executable), tmp_path / "quick")
    environment = plain_environment() | {"PATH": "/nowhere"}
    del environment["TRIBOFMU_PYTHON"]
    with NativeHost(native_program, environment) as host:
        assert started(host, folder).step(1.0) == OK


def test_python3_on_the_path_is_the_last_resort(native_program, isolated_folder, tmp_path):
    (tmp_path / "python3").symlink_to(sys.executable)
    environment = plain_environment() | {"PATH": "/nowhere"}
    del environment["TRIBOFMU_PYTHON"]
    with NativeHost(native_program, environment) as host:
        assert "There is no python3 on PATH" in host.load(isolated_folder).instance().log[0][3]
    with NativeHost(native_program, environment | {"PATH": f"/nowhere:{Path(sys.executable).parent}"}) as host:
        assert started(host, isolated_folder).step(1.0) == OK


def test_a_hosts_own_python_settings_do_not_reach_the_model(native_program, isolated_folder):
    foreign = {"PYTHONHOME": "/nowhere", "PYTHONPATH": "/nowhere", "LD_LIBRARY_PATH": "/nowhere"}
    with NativeHost(native_program, plain_environment() | foreign) as host:
        assert started(host, isolated_folder).step(1.0) == OK


def test_a_guid_of_another_fmu_is_refused(host, isolated_folder):
    instance = host.load(isolated_folder, guid="{another}").instance()
    assert instance.created.status == NONE
    assert instance.log[0][3].startswith("The host asks for the FMU with guid '{another}'")


def test_two_contact_fmus_live_in_one_host(host, isolated_folder, other_scene, tmp_path):
    other_folder = unpacked(build(other_scene.at_level("regression"), tmp_path / "other.fmu"), tmp_path / "other")
    first = started(host, isolated_folder)
    second = started(host, other_folder, 1)
    assert first.outputs() != second.outputs()
    alone = started(host, isolated_folder, 2)
    assert rows(first) == rows(alone)
    assert len(host.supervisors()) == 2


def test_fifty_instances_live_at_once(host, isolated_folder):
    fmu = host.load(isolated_folder)
    instances = [stepped(fmu, k) for k in range(50)]
    (supervisor,) = host.supervisors()
    assert len(children(supervisor)) == 50
    first = rows(instances[0])
    assert all(rows(instance) == first for instance in instances[1:])
    for instance in instances:
        instance.free()
    assert soon(lambda: children(supervisor) == [])


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


def test_a_library_loaded_by_a_relative_path_finds_its_resources(isolated_folder):
    guid = (isolated_folder / "resources" / "guid.txt").read_text()
    code = f"""
import ctypes, os
os.chdir({str(isolated_folder / "binaries" / "linux64")!r})
library = ctypes.CDLL("./MixedContact.so")
os.chdir("/")
library.fmi2Instantiate.restype = ctypes.c_void_p
assert library.fmi2Instantiate(b"contact", 1, {guid!r}.encode(), None, (ctypes.c_void_p * 5)(), 0, 0)
"""
    subprocess.run([sys.executable, "-c", code], env=plain_environment(), check=True)


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


def test_instances_that_come_and_go_leave_nothing_behind(host, isolated_folder):
    fmu = host.load(isolated_folder)
    host.ask("cycles", fmu.number, 20)
    size = mapped(host.process.pid)
    assert host.ask("cycles", fmu.number, 100).status == OK
    assert mapped(host.process.pid) - size < 500  # kB
    (supervisor,) = host.supervisors()
    assert soon(lambda: children(supervisor) == [])
    assert descriptors(host.process.pid) < 10
    assert descriptors(supervisor) < 12


def test_states_that_come_and_go_leave_nothing_behind(host, isolated_folder):
    """Each is saved, left by a step, restored and freed; it has some kB on either side."""
    instance = started(host, isolated_folder)
    load, h_c = (instance.fmu.variables[name].valueReference for name in ("load", "h_c"))
    (supervisor,) = host.supervisors()
    processes = [host.process.pid, *children(supervisor)]
    retry = ("retry", 2000, 1.0, 1e-3, load, 50.0, 40.0, h_c)
    assert instance.ask(*retry).status == OK
    sizes = [mapped(pid) for pid in processes]
    assert instance.ask(*retry).status == OK
    assert [mapped(pid) - size < 1000 for pid, size in zip(processes, sizes, strict=True)] == [True, True]  # kB


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


def test_the_fmu_needs_no_python_of_its_host(isolated_folder, tmp_path):
    with zipfile.ZipFile(isolated_folder.parent / "quick.fmu") as archive:
        library = archive.read("binaries/linux64/MixedContact.so")
    assert b"Py_" not in library
    assert b"libpython" not in library
