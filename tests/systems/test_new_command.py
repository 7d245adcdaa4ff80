"""`tribofmu new`, and what the commands say before they run: what is assumed, looks like a mistake or is replaced."""

from pathlib import Path

import pytest

from contact_core import Scene
from system_models.cli.main import main
from system_models.store import results

COARSE = ["--set", "film.model=regression"]


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The empty working folder of a newcomer."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_new_scene_runs_at_once_and_says_what_it_assumes(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "mine"]) == 0
    assert "run it: tribofmu run mine.toml" in capsys.readouterr().out
    assert main(["run", "mine.toml", *COARSE]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("mine: 50 N, 1.1 m/s, 0.9 m/s, 60 degC\nContact: Hertz pressure 1.09 GPa")
    (said,) = [line for line in err.splitlines() if line.startswith("tribofmu: note: assumed: ")]
    assert "lubricant.viscosity.pressure_coefficient 19.93 GPa^-1" in said
    result = results.read(Path("results/mine/result.nc"))
    assert result["valid"].all()
    assert 100e-9 < float(result["h_c"][0]) < 200e-9


@pytest.mark.parametrize("like", ["mtm_zddp", "dimple_rolling"])
def test_a_scene_like_a_shipped_one_is_that_scene_under_another_name(folder: Path, like: str) -> None:
    assert main(["new", "mine", "--like", like]) == 0
    mine, shipped = (Scene.from_toml(source).to_dict() for source in (folder / "mine.toml", like))
    assert mine.pop("name") == "mine"
    assert shipped.pop("name") == like
    assert mine == shipped
    assert "# " in (folder / "mine.toml").read_text(), "its comments say where the values are from"


def test_a_machine_may_be_copied_with_its_tables(folder: Path) -> None:
    assert main(["new", "rig", "--like", "mtm_rig"]) == 0
    assert sorted(path.name for path in folder.iterdir()) == ["mtm_rig.csv", "rig.toml"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["two words"], "must be of letters, digits"),
        (["there"], "'there.toml' is there already"),
        (["mine", "--like", "mtm_zdd"], "Did you mean 'mtm_zddp'?"),
    ],
)
def test_what_cannot_be_written_is_refused(
    folder: Path, arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "there.toml").write_text("kept")
    assert main(["new", *arguments]) == 2
    assert said in capsys.readouterr().err
    assert [(path.name, path.read_text()) for path in folder.iterdir()] == [("there.toml", "kept")]


def test_likely_mistakes_are_asked_back_and_computed_if_they_are_meant(capsys: pytest.CaptureFixture[str]) -> None:
    main(["new", "mine"])
    command = ["run", "mine.toml", *COARSE, "--set", "operation.speed_2=-0.9 m/s"]
    assert main(command) == 2
    err = capsys.readouterr().err
    assert "the slide-to-roll ratio is +2000 %" in err
    assert "If this is meant, add --force." in err
    assert not Path("results").exists()
    assert main([*command, "--force"]) == 0
    assert "tribofmu: warning: operation: speed_1 = 1.1" in capsys.readouterr().err


def test_a_ratio_without_a_unit_that_looks_like_per_cent_is_asked_back(capsys: pytest.CaptureFixture[str]) -> None:
    sweep = ["stribeck", "mtm_zddp", *COARSE, "--times", "0", "--points", "2"]
    assert main([*sweep, "--srr", "10"]) == 2
    assert "--srr = 10 is 1000 %" in capsys.readouterr().err
    assert main([*sweep, "--srr", "10 %", "--fastest", "2", "--slowest", "1"]) in (0, 1)


@pytest.mark.long
def test_the_result_of_another_scene_is_not_replaced_without_force(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["new", "mine"])
    main(["new", "other"])
    assert main(["run", "mine.toml", *COARSE]) == 0
    before = (folder / "results/mine/result.nc").read_bytes()
    command = ["run", "other.toml", *COARSE, "--out", "results/mine"]
    capsys.readouterr()
    assert main(command) == 2
    assert "is the result of 'mine', and this is 'other'. Use another --out, or --force" in capsys.readouterr().err
    assert (folder / "results/mine/result.nc").read_bytes() == before
    assert main([*command, "--force"]) == 0
    assert "a result of 'mine', will be replaced" in capsys.readouterr().err
    result = results.read(Path("results/mine/result.nc"))
    assert result.attrs["scene"] == "other"


def test_a_result_of_other_settings_is_replaced_with_a_word_and_the_same_one_without(
    capsys: pytest.CaptureFixture[str],
) -> None:
    main(["new", "mine"])
    command = ["run", "mine.toml", *COARSE]
    assert main(command) == 0
    capsys.readouterr()
    assert main(command) == 0
    assert "will be replaced" not in capsys.readouterr().err
    assert main([*command, "--set", "operation.load=60 N"]) == 0
    assert "with other settings (" in (err := capsys.readouterr().err)
    assert "operation.load 50.0 N, now 60.0 N" in err
    assert "stop and use another --out" in err


def test_a_larger_load_of_a_duty_gets_the_grid_that_it_needs(folder: Path) -> None:
    main(["new", "mine"])
    (folder / "loads.csv").write_text("time [s],load [N]\n0,50\n30,800\n")
    duty = ["--duty", "loads.csv", "--set", "operation.duration=60 s"]
    assert main(["run", "mine.toml", *COARSE, *duty]) == 0


def test_a_table_with_semicolons_is_refused_by_them(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "loads.csv").write_text("time [s];load [N]\n0;50,5\n")
    assert main(["run", "mtm_zddp", "--duty", "loads.csv"]) == 2
    assert "has semicolons. Put commas between columns, and a point before decimals." in capsys.readouterr().err
