"""Several FMUs and many instances live in one process."""

import atexit
import ctypes
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from fmu_host import environment, hosted, unpacked

from fmu_src.package.build import build
from fmu_src.runtime import loader


def test_two_scenes_in_one_process_keep_to_themselves(folder, other_scene, tmp_path):
    other_folder = unpacked(build(other_scene, tmp_path / "other.fmu", "embedded"), tmp_path / "other")
    with hosted(folder) as alone:
        expected = alone.initialise().step(60.0)
    with hosted(other_folder) as other, hosted(folder) as mine:
        other.initialise()
        mine.initialise()
        other_outputs, outputs = other.step(60.0), mine.step(60.0)
        assert outputs == expected
        assert outputs["tribofilm_1"] > other_outputs["tribofilm_1"] == 0.0
        assert other.get("surface_1.rq") == other_scene.surface_1.rq


def test_two_instances_of_one_fmu_keep_to_themselves(folder):
    with hosted(folder) as first, hosted(folder) as second:
        first.initialise(load=30.0)
        second.initialise()
        assert first.step(60.0)["friction_force"] != second.step(60.0)["friction_force"]


def test_twenty_instances_come_and_go_and_leave_no_path_behind(folder):
    before = list(sys.path)
    for _ in range(20):
        with hosted(folder) as host:
            assert host.get("load") == 53.7
    assert sys.path == before


def test_a_folder_with_a_space_in_its_name_works(fmu_file, tmp_path):
    with hosted(unpacked(fmu_file, tmp_path / "a folder")) as host:
        assert host.initialise().step(60.0)["valid"]


@pytest.mark.long
def test_a_process_that_only_runs_the_fmu_ends_cleanly(fmu_file):
    """The binary of pythonfmu frees its interpreter twice at exit unless the slave sees to it."""
    code = f"import fmpy; print(len(fmpy.simulate_fmu({str(fmu_file)!r}, stop_time=2.0, output_interval=1.0)))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment())
    assert (run.returncode, run.stdout, run.stderr) == (0, "3\n", "")


@pytest.mark.skipif(sys.platform != "linux", reason="only there must it be released")
def test_the_binary_is_found_at_exit_though_its_folder_is_gone_and_its_uri_had_a_slash_more(
    folder, tmp_path, monkeypatch
):
    copy, registered = shutil.copytree(folder, tmp_path / "copy"), []
    ctypes.CDLL(str(copy / "binaries/linux64/MixedContact.so"))
    monkeypatch.setattr(atexit, "register", lambda _, *arguments: registered.extend(arguments))
    loader.tidy(f"/{copy}/resources", "MixedContact")
    shutil.rmtree(copy)
    (library,) = registered
    assert ctypes.CDLL(str(library), mode=os.RTLD_NOLOAD | os.RTLD_LAZY).finalizePythonInterpreter


def test_an_fmu_of_another_version_is_refused_by_name(folder, tmp_path, capfd):
    copy = shutil.copytree(folder, tmp_path / "copy")
    (copy / "resources/versions.json").write_text(json.dumps({"contact_core": "0.0.1"}))
    with pytest.raises(Exception, match="Failed to instantiate"), hosted(copy):
        pass
    assert "built with contact_core 0.0.1" in capfd.readouterr().err
    with hosted(folder) as host:
        assert host.get("load") == 53.7


def test_an_edited_scene_is_refused(folder, tmp_path, capfd):
    copy = shutil.copytree(folder, tmp_path / "copy")
    file = copy / "resources/scene.json"
    file.write_text(file.read_text().replace("0.0095", "0.0096"))
    with pytest.raises(Exception, match="Failed to instantiate"), hosted(copy):
        pass
    assert "was changed after building" in capfd.readouterr().err


@pytest.mark.parametrize("name", ["scene.json", "versions.json"])
def test_missing_resources_are_refused(folder, tmp_path, capfd, name):
    copy = shutil.copytree(folder, tmp_path / "copy")
    (copy / "resources" / name).unlink()
    with pytest.raises(Exception, match="Failed to instantiate"), hosted(copy):
        pass
    assert "cannot be read" in capfd.readouterr().err


def test_a_host_may_fork_after_the_isolated_library_was_unloaded(isolated_folder):
    """The handler that keeps a forked child from its parent's processes goes with the library."""
    code = f"""
import os
from pathlib import Path
from fmu_host import hosted
with hosted(Path({str(isolated_folder)!r})) as host:
    assert host.initialise().step(1.0)["valid"]
child = os.fork()
if not child:
    os._exit(0)
assert os.waitpid(child, 0)[1] == 0
"""
    variables = environment()
    variables["PYTHONPATH"] = os.pathsep.join([str(Path(__file__).parent), variables["PYTHONPATH"]])
    subprocess.run([sys.executable, "-c", code], env=variables, check=True)


def test_a_forked_child_can_neither_use_nor_disturb_its_parents_instance(isolated_folder):
    code = f"""
import os
from pathlib import Path
from fmpy.fmi1 import FMICallException
from fmu_host import hosted
with hosted(Path({str(isolated_folder)!r})) as host:
    host.initialise().step(1.0)
    state = host.fmu.getFMUstate()
    expected = host.step(1.0)
    host.fmu.setFMUstate(state)
    child = os.fork()
    if not child:
        try:
            host.fmu.doStep(1.0, 1.0)
        except FMICallException:
            os._exit(0)
        os._exit(1)
    assert os.waitpid(child, 0)[1] == 0
    assert host.step(1.0) == expected
"""
    variables = environment()
    variables["PYTHONPATH"] = os.pathsep.join([str(Path(__file__).parent), variables["PYTHONPATH"]])
    subprocess.run([sys.executable, "-c", code], env=variables, check=True)
