"""Search of an isolated FMU for its resources and its Python, and its messages where that fails."""

import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from fmu_host import unpacked
from isolated import running, started

from benchmarks.hosts.native_host import NONE, OK, NativeHost, plain_environment
from fmu_src.package.build import build

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the processes are looked at as Linux shows them")


@pytest.fixture
def host(native_program: Path) -> Iterator[NativeHost]:
    yield from running(native_program)


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


def test_a_recorded_python_of_another_machine_is_not_the_last_word(native_program, isolated_folder, tmp_path):
    folder = Path(shutil.copytree(isolated_folder, tmp_path / "fmu"))
    (folder / "resources" / "python.txt").write_text("/of/another/machine/python")
    environment = plain_environment() | {"PATH": "/nowhere"}
    del environment["TRIBOFMU_PYTHON"]
    with NativeHost(native_program, environment) as host:
        said = host.load(folder).instance().log[0][3]
        assert "The FMU names the Python '/of/another/machine/python', which cannot be run" in said
    with NativeHost(native_program, environment | {"PATH": f"/nowhere:{Path(sys.executable).parent}"}) as host:
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


def test_the_fmu_needs_no_python_of_its_host(isolated_folder):
    library = (isolated_folder / "binaries/linux64/MixedContact.so").read_bytes()
    assert b"Py_" not in library
    assert b"libpython" not in library
