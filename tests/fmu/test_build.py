"""The command line of build_fmu.py."""

import zipfile
from importlib.resources import files

import pytest
from fmu_host import SMALL

from fmu_src.package.command import main

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
    shipped = files("contact_core") / "data" / "scenes" / "azam_case_a.toml"
    file.write_text(shipped.read_text("utf-8").replace("azam_case_a", "mine"))
    assert main([str(file), "--set", *CHANGES, "--out", str(out)]) == 0
    with zipfile.ZipFile(out) as archive:
        assert b'"name": "mine"' in archive.read("resources/scene.json")


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["mtm_zdd"], "Did you mean 'mtm_zddp'"),
        (["nowhere.toml"], "'nowhere.toml' cannot be read"),
        (["mtm_zddp", "--set", "wear.bar=1"], "no key 'bar'"),
        (["mtm_zddp", "--set", "operation.load=50 K"], "operation.load = '50 K' has the wrong unit"),
        (["mtm_zddp", "--set", "plasticity.hardness=-1 GPa"], "plasticity.hardness = -1e+09 Pa"),
        (["mtm_zddp", "--set", "surface_1.correlation_length=1 um"], "nodes of the grid"),
        (["mtm_zddp", "--set", "film.points"], "has no '='"),
    ],
)
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


def test_a_script_of_an_earlier_build_is_refused_with_a_way_out():
    with pytest.raises(ImportError, match="Build it again"):
        from fmu_src import slave  # noqa: F401
    with pytest.raises(ImportError, match="cannot import name 'slaves'"):
        from fmu_src import slaves  # noqa: F401
