"""What the embedded flavour can do, and each limit of pythonfmu that no guard in Python can cure.

A limit is a strict xfail of what should hold: the day that pythonfmu cures it, its test says so.
"""

import contextlib
import ctypes
import gc
import os
import subprocess
import sys
import threading
import tracemalloc
from pathlib import Path

import fmpy
import pytest
from conftest import SMALL, unpacked
from fmpy.simulation import instantiate_fmu
from fmu_host import environment, hosted
from native_host import ERROR, OK, NativeHost, plain_environment

from contact_core import Scene
from fmu_src import build, slave
from fmu_src.snapshot import Snapshot

OUTPUTS = ("friction_force", "h_c", "wear_volume_1")


def limit(reason: str, raises: type[BaseException] = AssertionError):
    return pytest.mark.xfail(strict=True, reason=reason, raises=raises)


def exit_code(folder: Path, code: str = "") -> int:
    """Exit code of a Python host of its own in which `code` uses `host`, an instance that is ready to step."""
    script = f"""
from pathlib import Path
from fmu_host import Host
host = Host(Path({str(folder)!r})).initialise()
{code}
"""
    variables = environment()
    variables["PYTHONPATH"] = os.pathsep.join([str(Path(__file__).parent), variables["PYTHONPATH"]])
    run = subprocess.run([sys.executable, "-c", script], env=variables, capture_output=True, text=True)
    if run.returncode > 0:
        raise RuntimeError(run.stderr)
    return run.returncode


@pytest.fixture(scope="module")
def quick_file(tmp_path_factory):
    """A contact at the fast level: many instances cost little."""
    scene = Scene.from_toml("mtm_zddp", SMALL).at_level("regression")
    return build(scene, tmp_path_factory.mktemp("quick") / "quick.fmu")


@pytest.fixture(scope="module")
def quick_folder(quick_file, tmp_path_factory):
    return unpacked(quick_file, tmp_path_factory.mktemp("quick"))


@pytest.fixture
def c_host(native_program, embedding):
    """A host in C, told where Python is. How it ends is a limit of its own."""
    host = NativeHost(native_program, embedding)
    yield host
    host.close()


# what holds


def test_fifty_instances_live_at_once(c_host, quick_folder):
    fmu = c_host.load(quick_folder)
    instances = [fmu.instance(k) for k in range(50)]
    for k, instance in enumerate(instances):
        assert instance.initialise(load=40.0 + k) == [OK] * 4
    assert {instance.step(60.0) for instance in instances} == {OK}
    assert len({instance.get("friction_force")[0] for instance in instances}) == 50


def test_two_contacts_in_a_host_in_c_keep_to_themselves(c_host, folder, quick_folder):
    fmus = [c_host.load(folder), c_host.load(quick_folder)]
    instances = [fmu.instance(k) for k, fmu in enumerate(fmus)]
    for instance in instances:
        instance.initialise()
        assert instance.step(60.0) == OK
    assert instances[0].get("friction_force") != instances[1].get("friction_force")
    assert "h_min" not in fmus[1].variables
    assert instances[0].get("h_min")[0] > 0.0


def test_eight_threads_give_the_bits_of_one(c_host, quick_folder):
    fmu = c_host.load(quick_folder)
    alone = fmu.instance()
    alone.initialise()
    assert [alone.step(60.0) for _ in range(3)] == [OK] * 3
    crowd = range(1, 9)
    calls = [("instantiate", 0, 1), ("setup",), ("enter",), ("exit",), *(("step", 60.0 * n, 60.0) for n in range(3))]
    for command, *words in calls:
        assert c_host.together((command, k, *words) for k in crowd).status == OK
    references = [fmu.variables[name].valueReference for name in OUTPUTS]
    assert {tuple(c_host.ask("getr", k, *references).reals) for k in crowd} == {tuple(alone.get(*OUTPUTS))}


def test_every_log_entry_has_a_category(c_host, quick_folder):
    """A host may take it for a string without looking."""
    instance = c_host.load(quick_folder).instance()
    instance.initialise()
    instance.step(60.0, load=-1.0)
    assert [(status, category) for _, status, category, _ in instance.log] == [(1, "logStatusWarning")]


def test_the_reason_of_a_failed_instantiation_reaches_the_log(c_host, quick_file, tmp_path):
    folder = unpacked(quick_file, tmp_path / "copy")
    (folder / "resources" / "versions.json").write_text('{"contact_core": "0.0.1"}')
    created = c_host.load(folder).instance().created
    assert any("0.0.1" in text for *_, text in created.log)


@pytest.mark.parametrize("logging", [True, False])
def test_errors_and_rollback_in_turn_leave_the_run_as_it_was(quick_folder, monkeypatch, logging):
    def broken(*arguments):
        raise ZeroDivisionError

    with hosted(quick_folder, logging=logging) as host:
        host.initialise()
        handle = host.fmu.getFMUstate()
        expected = host.step(60.0)
        for _ in range(20):
            with monkeypatch.context() as patch:
                patch.setattr(slave, "advance", broken)
                assert not host.step(60.0)["valid"]
            gc.collect()
            host.fmu.setFMUstate(handle)
            assert host.step(60.0) == expected
        host.fmu.freeFMUstate(handle)


def test_a_python_host_that_frees_no_instance_ends_cleanly(quick_folder):
    assert exit_code(quick_folder, "assert host.step(60.0)['valid']") == 0


@pytest.fixture(scope="module")
def kept(quick_folder) -> tuple[float, float]:
    """Bytes and blocks of Python's memory that an instance keeps for good."""
    description = fmpy.read_model_description(str(quick_folder))

    def cycle(count: int) -> tracemalloc.Snapshot:
        for _ in range(count):
            instantiate_fmu(str(quick_folder), description).freeInstance()
        gc.collect()
        return tracemalloc.take_snapshot().filter_traces([tracemalloc.Filter(False, tracemalloc.__file__)])

    cycles = 100
    tracemalloc.start()
    try:
        before, after = cycle(20), cycle(cycles)
    finally:
        tracemalloc.stop()
    changes = after.compare_to(before, "filename")
    return sum(c.size_diff for c in changes) / cycles, sum(c.count_diff for c in changes) / cycles


def test_an_instance_leaves_little_behind(kept):
    assert kept[0] < 2000


# what does not


@limit("pythonfmu leaves some references behind in each fmi2Instantiate")
def test_an_instance_leaves_nothing_behind(kept):
    assert kept[1] < 1.0


@pytest.mark.parametrize("character", ["#", "ü", "+", "(", "@"])
@limit("of what a URI must escape, pythonfmu decodes the space only, and crashes")
def test_the_folder_may_have_any_name(quick_folder, tmp_path, character):
    odd = tmp_path / f"a{character}b"
    odd.symlink_to(quick_folder)
    assert exit_code(odd) == 0


@limit("pythonfmu's binary wants Python's symbols of its host")
def test_a_host_without_python_can_load_it(native_program, folder):
    with NativeHost(native_program, plain_environment()) as host:
        assert host.load(folder).loaded.status == OK


@limit("pythonfmu finalises Python on another thread while the process ends; it mostly crashes")
def test_a_host_in_c_ends_cleanly(native_program, embedding, quick_folder):
    def ended() -> int:
        host = NativeHost(native_program, embedding)
        host.load(quick_folder).instance().free()
        return host.close()

    assert all(ended() == 0 for _ in range(10))  # the first crash settles it


@limit("a slave can answer OK or Discard, nothing else", raises=pytest.fail.Exception)
def test_an_unexpected_error_is_an_error_to_the_host(stepped, monkeypatch):
    monkeypatch.setattr(slave, "advance", lambda *arguments: 1 / 0)
    with pytest.raises(fmpy.fmi1.FMICallException):
        stepped.step(60.0)


@limit("the model runs in the process of its host")
def test_a_crash_of_the_model_leaves_the_host_alive(quick_folder):
    crash = "from fmu_src import slave; import ctypes; slave.advance = lambda *a: ctypes.string_at(0); host.step(60.0)"
    assert exit_code(quick_folder, crash) == 0


@limit("nothing can stop a call in the process of its host")
def test_a_model_that_hangs_is_given_up(stepped, monkeypatch):
    monkeypatch.setenv("TRIBOFMU_TIMEOUT", "0.05")
    released = threading.Event()
    timer = threading.Timer(0.5, released.set)
    timer.start()
    monkeypatch.setattr(slave, "advance", lambda *arguments: released.wait())
    with contextlib.suppress(fmpy.fmi1.FMICallException):
        stepped.fmu.doStep(stepped.time, 60.0)
    assert not released.is_set()


@limit("the interpreter and its packages are the host's")
def test_the_host_need_not_have_the_packages(native_program, embedding, quick_folder):
    host = NativeHost(native_program, embedding | {"PYTHONPATH": "", "TRIBOFMU_PYTHON": sys.executable})
    created = host.load(quick_folder).instance().created
    host.close()
    assert created.status == OK


@limit("pythonfmu does not look at the guid")
def test_another_guid_is_refused(c_host, quick_folder):
    instance = c_host.load(quick_folder, guid="{8c4e810f-3df3-4a00-8276-176fa3c9f9e0}").instance()
    assert instance.created.status != OK


@limit("pythonfmu overwrites the handle it is given, and what that pointed to is kept for good")
def test_a_state_that_is_saved_over_another_replaces_it(stepped):
    handle = stepped.fmu.getFMUstate()
    before = states_alive()
    for _ in range(5):
        stepped.fmu.fmi2GetFMUstate(stepped.fmu.component, ctypes.byref(handle))
    stepped.fmu.freeFMUstate(handle)
    assert states_alive() < before


def states_alive() -> int:
    gc.collect()
    return sum(isinstance(thing, Snapshot) for thing in gc.get_objects())


@limit("pythonfmu has no directional derivatives; the outputs dfriction_d... tell them")
def test_directional_derivatives_are_given(c_host, quick_folder):
    fmu = c_host.load(quick_folder)
    instance = fmu.instance()
    instance.initialise()
    instance.step(60.0)
    unknown, known = (fmu.variables[name].valueReference for name in ("friction_force", "load"))
    assert instance.ask("derivative", unknown, known).status != ERROR
