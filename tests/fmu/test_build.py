"""The command line of build_fmu.py."""

import sys
import zipfile
from importlib import import_module
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
        (["mtm_zddp", "--flavour", "native", "--set", "film.model=deterministic"], "a native FMU has no solver"),
    ],
)
def test_a_bad_scene_is_refused_with_a_sentence(tmp_path, monkeypatch, capsys, arguments, named):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    printed = capsys.readouterr()
    assert named in printed.err
    assert "Note: the contact is solved" not in printed.err
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


@pytest.fixture
def asked(tmp_path, monkeypatch):
    """What the command asks of `build`, which is not called: the scene, and the options."""

    def of(*arguments):
        found = []

        def build(scene, out, *_, **options):
            found.append((scene, options))
            return out

        monkeypatch.setattr(import_module("fmu_src.package.build"), "build", build)
        assert main([*arguments, "--out", str(tmp_path / "x.fmu")]) == 0
        return found[0]

    return of


@pytest.mark.parametrize(
    ("prefix", "arguments", "recorded"),
    [
        ("/an/environment", [], sys.executable),
        (sys.base_prefix, [], None),
        ("/an/environment", ["--portable"], None),
        ("/an/environment", ["--flavour", "embedded"], None),
        ("/an/environment", ["--python", "no-such-python"], "no-such-python"),
    ],
)
def test_a_virtual_environment_is_recorded(asked, monkeypatch, prefix, arguments, recorded):
    monkeypatch.setattr(sys, "prefix", prefix)
    assert asked("mtm_zddp", "--set", *CHANGES, *arguments)[1]["python"] == recorded


def test_an_interpreter_is_not_named_and_left_out_at_once(capsys):
    assert main(["mtm_zddp", "--portable", "--python"]) == 2
    assert "--portable records no interpreter" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("scene", "settings", "level"),
    [
        ("mtm_zddp", [], "map"),
        ("mtm_zddp", ["surface_2.rq=120 nm"], "regression"),
        ("fzg_flank", [], "regression"),
    ],
)
def test_a_native_fmu_takes_a_level_that_solves_nothing_and_says_so(asked, capsys, scene, settings, level):
    taken = asked(scene, "--flavour", "native", *(["--set", *settings] if settings else []))[0]
    assert taken.film.fidelity == level
    said = capsys.readouterr().err
    assert f"the level '{level}' in place of 'deterministic'" in said
    assert "friction_coefficient +- " in said


@pytest.mark.parametrize("level", ["deterministic", "regression"])
def test_that_kernels_may_compile_is_said_where_the_contact_is_solved(asked, capsys, level):
    asked("mtm_zddp", "--set", f"film.model={level}")
    assert ("kernels compile" in capsys.readouterr().err) is (level == "deterministic")


def test_a_native_fmu_of_a_level_that_is_asked_for_is_left_alone(asked, capsys):
    assert asked("mtm_zddp", "--flavour", "native", "--set", "film.model=regression")[0].film.name == "regression"
    assert "in place of" not in capsys.readouterr().err
