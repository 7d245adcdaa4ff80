"""The isolated flavour in hosts that load its library anew, unload it early, fork, or wait for children not theirs."""

import os
import signal
import sys
from pathlib import Path

import pytest

from benchmarks.hosts.native_host import ERROR, OK, Fmu, Instance, NativeHost, plain_environment
from benchmarks.hosts.processes import alive, children, soon

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the processes are looked at as Linux shows them")

STEPS = [(1.0, {"load": 40.0}), (2.0, {"speed_1": 0.2}), (0.5, {"load": 60.0})]


def started(fmu: Fmu, number: int = 0) -> Instance:
    instance = fmu.instance(number)
    assert instance.created.status == OK, instance.log
    assert set(instance.initialise()) == {OK}
    return instance


def rows(*instances: Instance) -> list[list[dict[str, object]]]:
    """Outputs of the same steps, made in turn by all instances."""
    found: list[list[dict[str, object]]] = [[] for _ in instances]
    for dt, inputs in STEPS:
        for instance, own in zip(instances, found, strict=True):
            assert instance.step(dt, **inputs) == OK, instance.log
            own.append(instance.outputs())
    return found


def test_instances_live_on_in_a_host_that_loads_the_library_again_for_each(
    native_program: Path, isolated_folder: Path
) -> None:
    with NativeHost(native_program, plain_environment()) as host:
        fmu = host.load(isolated_folder)
        instances = []
        for number in range(3):
            assert host.ask("reload", fmu.number).status == OK
            instances.append(started(fmu, number))
        (supervisor,) = host.supervisors()
        assert len(children(supervisor)) == 3
        first, *others = rows(*instances)
        assert all(row["valid"] for row in first)
        assert others == [first, first]
        for instance in instances:
            instance.free()
        assert host.ask("unload", fmu.number).status == OK
        assert soon(lambda: not alive(supervisor))
    assert host.code == 0


def test_an_instance_may_be_freed_after_the_host_has_unloaded_the_library(
    native_program: Path, isolated_folder: Path
) -> None:
    with NativeHost(native_program, plain_environment()) as host:
        fmu = host.load(isolated_folder)
        instances = [started(fmu, number) for number in range(2)]
        assert host.ask("unload", fmu.number).status == OK
        assert len({str(row) for row in rows(*instances)}) == 1
        (supervisor,) = host.supervisors()
        for instance in instances:
            instance.free()
        assert soon(lambda: not alive(supervisor))  # the library is gone, and with it what it has started
        assert str(isolated_folder) not in Path(f"/proc/{host.process.pid}/maps").read_text()
    assert host.code == 0


def test_a_child_forked_while_other_threads_call_the_fmu_can_call_it_too(
    native_program: Path, isolated_folder: Path
) -> None:
    with NativeHost(native_program, plain_environment()) as host:
        fmu = host.load(isolated_folder)
        instance = started(fmu)
        assert host.ask("forks", 0, 60, fmu.number).values == ["0"]
        assert instance.step(1.0) == OK
    assert host.code == 0


def test_children_forked_while_an_instance_starts_do_not_hide_that_its_processes_have_ended(
    native_program: Path, isolated_folder: Path
) -> None:
    with NativeHost(native_program, plain_environment() | {"TRIBOFMU_TIMEOUT": "20"}) as host:
        fmu = host.load(isolated_folder)
        answer = host.ask("offspring", 0, fmu.number, 60)
        assert answer.status == OK
        instance = Instance(fmu, 0, answer)
        try:
            assert set(instance.initialise()) == {OK}
            (supervisor,) = host.supervisors()
            for pid in (supervisor, *children(supervisor)):
                os.kill(pid, signal.SIGKILL)
            assert instance.step(1.0) == ERROR
            assert "Its supervisor ended" in instance.log[-1][3]
        finally:
            for child in map(int, answer.values):
                os.kill(child, signal.SIGKILL)
    assert host.code == 0


def test_the_models_processes_are_no_children_of_the_host(native_program: Path, isolated_folder: Path) -> None:
    """A host that waits for all of its children would wait for ever."""
    with NativeHost(native_program, plain_environment()) as host:
        instance = started(host.load(isolated_folder))
        assert children(host.process.pid) == []
        assert host.ask("wait").status == OK
        assert instance.step(1.0) == OK
    assert host.code == 0


def stop(supervisor: int) -> list[int]:
    """Halt a supervisor and its workers."""
    halted = [*children(supervisor), supervisor]
    for pid in halted:
        os.kill(pid, signal.SIGSTOP)
    return halted


def test_a_supervisor_that_does_not_answer_is_replaced(native_program: Path, isolated_folder: Path) -> None:
    with NativeHost(native_program, plain_environment() | {"TRIBOFMU_TIMEOUT": "4"}) as host:
        instance = started(host.load(isolated_folder))
        instance.ask("save", 0)
        (expected,) = rows(instance)
        halted = stop(*host.supervisors())
        assert instance.step(1.0) == ERROR
        assert "no answer within 4 s" in instance.log[-1][3]
        assert instance.ask("restore", 0).status == OK
        assert rows(instance) == [expected]
        assert soon(lambda: not any(map(alive, halted)))
    assert host.code == 0


def test_a_start_that_hangs_ends_at_its_limit_and_holds_up_nobody_else(
    native_program: Path, isolated_folder: Path, tmp_path: Path
) -> None:
    """While one thread waits for a new supervisor, another frees an instance of the old one."""
    python = tmp_path / "python3"
    python.write_text(f'#!/bin/sh\n[ -e {tmp_path}/hang ] && exec sleep 600\nexec {sys.executable} "$@"\n')
    python.chmod(0o755)
    with NativeHost(native_program, plain_environment() | {"TRIBOFMU_PYTHON": str(python)}) as host:
        fmu = host.load(isolated_folder)
        first, second = started(fmu), started(fmu, 1)
        host.ask("environment", "TRIBOFMU_START_TIMEOUT", "6")  # of the next instance alone
        (tmp_path / "hang").touch()
        stop(*host.supervisors())
        answer = host.together([("instantiate", 2, fmu.number, 1), ("later", 8000, "free", first.number)])
        assert answer.values == ["1", "0"]  # it was freed first
        assert "was not ready within 6 s. TRIBOFMU_START_TIMEOUT sets the limit" in answer.log[-1][3]
        (tmp_path / "hang").unlink()
        assert second.ask("reset").status == OK
        assert set(second.initialise()) == {OK}
        assert len(host.supervisors()) == 1
    assert host.code == 0


@pytest.mark.parametrize("limit", ["no", "0", "1,5"])
def test_a_limit_of_a_start_that_is_no_number_of_seconds_is_refused(
    native_program: Path, isolated_folder: Path, limit: str
) -> None:
    with NativeHost(native_program, plain_environment() | {"TRIBOFMU_START_TIMEOUT": limit}) as host:
        created = host.load(isolated_folder).instance().created
    assert f"TRIBOFMU_START_TIMEOUT = '{limit}' must be a number of seconds above 0" in created.log[0][3]
