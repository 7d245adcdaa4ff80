"""The processes of isolated FMUs: lost ones are replaced, none outlives its host, and nothing is left behind."""

import os
import resource
import signal
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from fmu_host import unpacked
from isolated import rows, running, started, stepped

from benchmarks.hosts.native_host import ERROR, OK, NativeHost, plain_environment
from benchmarks.hosts.processes import alive, children, descriptors, mapped, soon
from fmu_src.package.build import build

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the processes are looked at as Linux shows them")


@pytest.fixture
def host(native_program: Path) -> Iterator[NativeHost]:
    yield from running(native_program)


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


def test_a_reset_forgets_the_stop_time_for_a_new_worker_too(host, isolated_folder):
    instance = host.load(isolated_folder).instance()
    calls = (("setup", 2.0, 5.0), ("enter",), ("exit",), ("save", 0), ("reset",))
    assert [instance.ask(*call).status for call in calls] == [OK] * 5
    (supervisor,) = host.supervisors()
    for worker in children(supervisor):
        os.kill(worker, signal.SIGKILL)
    assert soon(lambda: children(supervisor) == [])
    assert instance.ask("restore", 0).status == OK
    assert instance.step(9.0) == OK


def test_signals_that_a_host_blocks_or_ignores_still_reach_the_model(native_program, isolated_folder):
    def blocked_and_ignored() -> list[str]:
        with NativeHost(native_program, plain_environment()) as host:
            started(host, isolated_folder)
            (supervisor,) = host.supervisors()
            listed = [Path(f"/proc/{pid}/status").read_text() for pid in (supervisor, *children(supervisor))]
        return [line for text in listed for line in text.splitlines() if line.startswith(("SigBlk", "SigIgn"))]

    usual = blocked_and_ignored()
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGUSR1])
    handler = signal.signal(signal.SIGUSR2, signal.SIG_IGN)
    try:
        assert blocked_and_ignored() == usual
    finally:
        signal.signal(signal.SIGUSR2, handler)
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


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
    assert "was lost between two calls" in instance.log[-1][3]  # and why, if its supervisor has come to say so


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
    limit = {"TRIBOFMU_TIMEOUT": "4"} if victim == "nobody" else {}
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
        assert ("no answer within 4 s" if victim == "nobody" else "supervisor ended") in answer.log[0][3]
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
