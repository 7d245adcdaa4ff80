"""The command line of build_fmu.py."""

import zipfile

import pytest
from conftest import SMALL

from contact_core.scene import read_table
from fmu_src.build import main

CHANGES = [f"{key}={value}" for key, value in SMALL.items()]


def test_a_shipped_scene_is_built_under_its_name_by_default(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["mtm_zddp", "--set", *CHANGES]) == 0
    assert capsys.readouterr().out == "mtm_zddp.fmu\n"
    with zipfile.ZipFile("mtm_zddp.fmu") as archive:
        names = set(archive.namelist())
    assert "modelDescription.xml" in names
    assert {"binaries/linux64/MixedContact.so", "binaries/win64/MixedContact.dll"} <= names


def test_a_scene_file_is_built_where_out_says(tmp_path, capsys):
    file, out = tmp_path / "mine.toml", tmp_path / "made" / "mine.fmu"
    file.write_text("""
name = "mine"
description = "a smooth contact"
geometry = { radius_x = "10 mm", radius_y = "10 mm", track_length_1 = "60 mm", track_length_2 = "60 mm" }
solids = { set = "steel" }
surface_1 = { rq = "0 nm", correlation_length = "16 um", seed = 1 }
surface_2 = { rq = "0 nm", correlation_length = "16 um", seed = 2 }
lubricant = { set = "azam_oil" }
plasticity = { set = "steel" }
boundary_friction = { model = "film_blend", bare = 0.13, film = 0.115, slip_speed = "0.1 mm/s" }
heat = { model = "none" }
tribofilm = { model = "none" }
wear = { model = "none" }
control = { change = "4 nm", steps = 4, dry_above = 0.95, input_change = 0.02 }

[film]
model = "deterministic"
points = 33
domain = "0.5 mm"
floor = "1 nm"
tolerance = 3e-3
iterations = 150

[operation]
load = "50 N"
speed_1 = "1 m/s"
speed_2 = "1 m/s"
temperature = "80 degC"
duration = "1 h"
interval = "60 s"
""")
    assert main([str(file), "--out", str(out)]) == 0
    assert out.is_file()


@pytest.mark.parametrize(("arguments", "named"), [
    (["mtm_zdd"], "Did you mean 'mtm_zddp'"),
    (["nowhere.toml"], "'nowhere.toml' cannot be read"),
    (["mtm_zddp", "--set", "wear.bar=1"], "no key 'bar'"),
    (["mtm_zddp", "--set", "operation.load=50 K"], "operation.load = '50 K' has the wrong unit"),
    (["mtm_zddp", "--set", "plasticity.hardness=-1 GPa"], "plasticity.hardness = -1e+09 Pa"),
    (["mtm_zddp", "--set", "surface_1.correlation_length=1 um"], "nodes of the grid"),
    (["mtm_zddp", "--set", "film.points"], "has no '='"),
])
def test_a_bad_scene_is_refused_with_a_sentence(tmp_path, monkeypatch, capsys, arguments, named):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    printed = capsys.readouterr()
    assert named in printed.err
    assert printed.out == ""
    assert list(tmp_path.iterdir()) == []


def test_a_place_that_cannot_be_written_is_named(tmp_path, capsys):
    (tmp_path / "file").write_text("")
    assert main(["mtm_zddp", "--set", *CHANGES, "--out", str(tmp_path / "file" / "x.fmu")]) == 2
    assert "The FMU cannot be written" in capsys.readouterr().err


def test_a_scene_that_is_not_well_resolved_is_built_with_a_note(tmp_path, capsys):
    assert main(["mtm_zddp", "--set", *CHANGES, "--out", str(tmp_path / "x.fmu")]) == 0
    assert "Note: surface_1 has 1.02 nodes per correlation length" in capsys.readouterr().err
    assert read_table("mtm_zddp")["film"]["points"] == 129
