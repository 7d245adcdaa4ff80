"""Abilities of the embedded flavour, and each limit of pythonfmu that no guard in Python can remove.

A limit is a strict xfail of the right behaviour: its test fails as soon as pythonfmu removes the limit. Only a new
pythonfmu can change that, so these are long.
"""

import contextlib
import ctypes
import gc
import os
import signal
import subprocess
import sys
import threading
import tracemalloc
from pathlib import Path

import fmpy
import pytest
from fmpy.simulation import instantiate_fmu
from fmu_host import environment, hosted

from benchmarks.hosts.native_host import ERROR, OK, NativeHost, plain_environment
from fmu_src.runtime import slave
from fmu_src.runtime.snapshot import Snapshot

OUTPUTS = ("friction_force", "h_c", "wear_volume_1")


def limit(reason: str, raises: type[BaseException] | tuple[type[BaseException], ...] = AssertionError):
    known = pytest.mark.xfail(strict=True, reason=reason, raises=raises)
    return lambda test: pytest.mark.long(known(test))


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
    try:
        run = subprocess.run([sys.executable, "-c", script], env=variables, capture_output=True, text=True, timeout=120)
    except subprocess.TimeoutExpired:  # what a wrong pointer has hit may also go on for ever
        return -signal.SIGKILL
    if run.returncode > 0:
        raise RuntimeError(run.stderr)
    return run.returncode


@pytest.fixture(scope="module")
def quick_folder(quick, built):
    return built.unpacked(quick, "embedded")


@pytest.fixture
def c_host(native_program, embedding):
    """A host in C with the path of Python. Its exit has a limit of its own."""
    host = NativeHost(native_program, embedding)
    yield host
    host.close()


# what holds


@pytest.mark.parametrize("logging", [True, False])
def test_errors_and_rollback_in_turn_leave_the_run_as_it_was(quick_folder, monkeypatch, logging):
    def broken(*arguments):
        raise ZeroDivisionError

    with hosted(quick_folder, logging=logging) as host:
        host.initialise()
        handle = host.fmu.getFMUstate()
        expected = host.step(60.0)
        for _ in range(2):
            with monkeypatch.context() as patch:
                patch.setattr(slave, "advance", broken)
                assert not host.step(60.0)["valid"]
            gc.collect()
            host.fmu.setFMUstate(handle)
            assert host.step(60.0) == expected
        host.fmu.freeFMUstate(handle)


@pytest.mark.long
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

    cycles = 40
    tracemalloc.start()
    try:
        before, after = cycle(10), cycle(cycles)
    finally:
        tracemalloc.stop()
    changes = after.compare_to(before, "filename")
    return sum(c.size_diff for c in changes) / cycles, sum(c.count_diff for c in changes) / cycles


@pytest.mark.long
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


@pytest.mark.long
@pytest.mark.xfail(reason="pythonfmu finalises Python on another thread while the process ends", strict=False)
def test_a_host_in_c_ends_cleanly(native_program, embedding, folder):
    """Not strict: of ten hosts, none to half crash."""

    def ended() -> int:
        host = NativeHost(native_program, embedding)
        instance = host.load(folder).instance()
        instance.initialise()
        instance.free()
        return host.close()

    assert all(ended() == 0 for _ in range(10))  # the first crash settles it


@limit("a slave can answer OK or Discard, nothing else", raises=pytest.fail.Exception)
def test_an_unexpected_error_is_an_error_to_the_host(stepped, monkeypatch):
    monkeypatch.setattr(slave, "advance", lambda *arguments: 1 / 0)
    with pytest.raises(fmpy.fmi1.FMICallException):
        stepped.step(60.0)


@limit("the model runs in the process of its host")
def test_a_crash_of_the_model_leaves_the_host_alive(quick_folder):
    crash = (
        "from fmu_src.runtime import slave; import ctypes; slave.advance = lambda *a: ctypes.string_at(0); "
        "host.step(60.0)"
    )
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
    nothing = {"PYTHONPATH": "", "PATH": "/nowhere"}  # an activated environment is found by PATH
    host = NativeHost(native_program, embedding | nothing | {"TRIBOFMU_PYTHON": sys.executable})
    created = host.load(quick_folder).instance().created
    host.close()
    assert created.status == OK


@limit("pythonfmu does not look at the guid")
def test_another_guid_is_refused(c_host, quick_folder):
    instance = c_host.load(quick_folder, guid="{8c4e810f-3df3-4a00-8276-176fa3c9f9e0}").instance()
    assert instance.created.status != OK


@limit("pythonfmu does not look at the kind of interface")
def test_an_instance_for_model_exchange_is_refused(quick_folder):
    with hosted(quick_folder) as host:
        assert not instantiated(host, 0, (quick_folder / "resources").as_uri().encode())


@limit("pythonfmu makes a text of the location before it looks at it")
def test_an_instance_without_resources_does_no_harm_to_the_host(quick_folder):
    code = "from test_limits_of_pythonfmu import instantiated; instantiated(host, 1, None)"
    assert exit_code(quick_folder, code) == 0


# an error of Python left behind by the text hits whatever comes next: the process ends, or a later call fails
@limit("pythonfmu does not look whether a text could be decoded", raises=(AssertionError, RuntimeError))
def test_a_text_that_is_no_utf_8_does_no_harm_to_the_host(quick_folder):
    set_text = """
import contextlib, gc
from ctypes import c_char_p, c_uint
from fmpy.fmi1 import FMICallException
reference = host.variables["initial_state"].valueReference
host.fmu.reset()
with contextlib.suppress(FMICallException):  # it may refuse it
    host.fmu.fmi2SetString(host.fmu.component, (c_uint * 1)(reference), 1, (c_char_p * 1)(b"\\xff\\xfe"))
gc.collect()
host.initialise()
"""
    assert exit_code(quick_folder, set_text) == 0


def instantiated(host, interface: int, resources: bytes | None) -> int | None:
    """Another instance of the FMU of `host`."""
    fmu = host.fmu
    return fmu.fmi2Instantiate(b"other", interface, fmu.guid.encode(), resources, ctypes.byref(fmu.callbacks), 0, 0)


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
