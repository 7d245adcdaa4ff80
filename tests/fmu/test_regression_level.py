"""An FMU at the regression level: its outputs agree with the core, and its state is complete."""

import json
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from fmu_host import environment, hosted
from replay import replay
from test_run import STEPS, bits, direct

from contact_core import Scene
from contact_core.quantities import OUTPUTS
from fmu_src.package.build import build


@pytest.fixture(scope="module")
def quick() -> Scene:
    small = {"film.points": "17", "surface_1.correlation_length": "32 um", "surface_2.correlation_length": "32 um"}
    return Scene.from_toml("mtm_zddp", small).at_level("regression")


@pytest.fixture(scope="module")
def quick_folder(quick, tmp_path_factory):
    folder = tmp_path_factory.mktemp("quick")
    with zipfile.ZipFile(build(quick, folder / "quick.fmu", "embedded")) as archive:
        archive.extractall(folder)
    return folder


def test_what_the_level_cannot_tell_is_absent(quick, quick_folder):
    with hosted(quick_folder) as host:
        told = {name for name, v in host.variables.items() if v.causality == "output"}
    assert told == {q.name for q in OUTPUTS if "regression" in q.levels}
    assert {"friction_force", "h_c", "dfriction_dspeed_1"} <= told
    assert not {"h_min", "roughness_raw_1", "blocks_dry"} & told


def test_the_fmu_agrees_with_the_core_bit_for_bit(quick, quick_folder):
    with hosted(quick_folder) as host:
        host.initialise()
        rows = [host.outputs(), *(host.step(dt, **inputs) for dt, inputs in STEPS)]
        assert host.log == []
    expected = [{name: row[name] for name in bits(rows[0])} for row in direct(quick, STEPS)[0]]
    assert [bits(row) for row in rows] == expected
    assert all(row["valid"] for row in rows)


def test_radii_reach_the_core_at_every_step(quick, quick_folder):
    steps = [(1.0, {}), (1.0, {"radius_x": 8e-3, "radius_y": 9e-3}), (1.0, {"radius_y": 7e-3})]
    with hosted(quick_folder) as host:
        host.initialise()
        rows = [host.outputs(), *(host.step(dt, **inputs) for dt, inputs in steps)]
    expected = [{name: row[name] for name in bits(rows[0])} for row in direct(quick, steps)[0]]
    assert [bits(row) for row in rows] == expected
    assert len({row["approach"] for row in rows[1:]}) == 3


def test_radii_that_cannot_be_used_are_said_and_change_nothing(quick_folder):
    with hosted(quick_folder) as host:
        host.initialise()
        before = host.step(1.0)
        refused = host.step(1.0, radius_x=0.0)
        assert not refused.pop("valid")
        assert refused.items() <= before.items()
        assert "radius_x = 0 m" in str(host.log)
        assert host.step(1.0, radius_x=0.01)["valid"]


def test_a_state_of_means_goes_on_in_another_process(quick_folder, tmp_path):
    with hosted(quick_folder) as host:
        host.initialise()
        host.step(60.0)
        state = host.state()
        here = replay(host, state)
    file = tmp_path / "state"
    file.write_bytes(state)
    script = Path(__file__).with_name("replay.py")
    run = subprocess.run(
        [sys.executable, str(script), str(quick_folder), str(file)], capture_output=True, env=environment(), check=True
    )
    assert json.loads(run.stdout) == here


def test_constants_of_the_fit_are_parameters(quick, quick_folder):
    with hosted(quick_folder) as host:
        usual = host.initialise().outputs()
    with hosted(quick_folder) as host:
        stiff = host.initialise(film__sharing__load_factor=2.0 * quick.film.sharing.load_factor).outputs()
    assert stiff["contact_load_ratio"] < usual["contact_load_ratio"]
