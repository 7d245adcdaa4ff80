import resource
import subprocess
import sys
from importlib import resources
from pathlib import Path

import pytest
from comparison import HARD, approx

from contact_core import OperatingPoint, Scene, shipped_scenes
from system_models.cli.main import COMMANDS, main
from system_models.machines.files import shipped
from system_models.run.duty import Duty
from system_models.store import results

STILL = [  # nothing grows or wears: one solution serves for ever
    part for setting in ("tribofilm.model=none", "wear.model=none", "heat.model=none") for part in ("--set", setting)
]

LUMPED = (
    "film.criterion = 'lumped' has one pressure for oil and solids; surface_1.microroughness.rms = 4e-09 m and "
    "surface_2.microroughness.rms = 1.6e-08 m carry a part of it. Set surface_1.microroughness.rms and "
    "surface_2.microroughness.rms to 0 nm, or use film.criterion = 'split'."
)


def test_list_names_the_shipped_scenes_and_machines(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    names = [line.split()[0] for line in lines]
    assert names == [*shipped_scenes(), *shipped()]
    assert {"mtm_zddp", "cam_tappet", "bearing_209", "gear_fzg_c"} <= set(names)
    texts = [*shipped_scenes().values(), *shipped().values()]
    assert all(text in line for text, line in zip(texts, lines, strict=True))


def test_a_reader_that_has_gone_ends_the_output_quietly() -> None:
    code = "import sys; from system_models.cli.main import main; sys.stdin.read(); sys.exit(main(['list']))"
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", code], **pipes) as process:
        process.stdout.close()
        process.stdin.close()  # only now the command writes
        assert process.stderr.read() == b""
    assert process.returncode == 141


def test_a_full_disk_is_told_in_a_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    limit = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, limit[1]))
    try:
        code = main(["new", "mine"])
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limit)
    assert code == 2
    assert "The system refuses a file: File too large. Make room" in capsys.readouterr().err


def test_list_does_not_load_what_only_a_run_needs() -> None:
    code = "import sys; from system_models.cli.main import main; main(['list']); print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    loaded = set(run.stdout.split())
    assert "system_models.cli.main" in loaded
    assert not {"matplotlib", "xarray", "fmpy", "pythonfmu", "tqdm"} & loaded


def test_a_run_prints_a_table_and_writes_three_files(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, coarse: list[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["run", "mtm_zddp", *coarse, *STILL, "--hours", "0.01"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("Azam's case B")
    assert {"friction", "h_c", "lambda", "A_c", "W_c"} < set(" ".join(out.split("\n\n")[1:3]).split())
    assert "Off, and not computed: tribofilm, wear." in out
    assert "\nBody 1: microroughness 4 nm rms, waves below 4 um (assumed: lapped steel).\nBody 2: microro" in out
    assert "0.6/0.6 min" in err
    folder = tmp_path / "results" / "mtm_zddp"
    assert {path.name for path in folder.iterdir()} == {"result.nc", "result.csv", "overview.png"}
    assert all(str(Path("results/mtm_zddp") / path.name) in out for path in folder.iterdir())
    dataset = results.read(folder / "result.nc")
    assert dataset["time"].values.tolist() == [0.0, 30.0, 36.0]
    assert dataset.attrs["scene"] == "mtm_zddp"


def test_a_run_of_the_regression_level_says_what_it_knows(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    settings = ["film.model=regression", *(f"{field}={value}" for field, value in HARD.items())]
    assert main(["run", "azam_case_a", "--set", *settings, "--hours", "2", "--out", str(tmp_path)]) == 0
    out = capsys.readouterr().out
    assert all(f"\nBody {body}: no microroughness: solids touch at the floor.\n" in out for body in (1, 2))
    assert "Load cycles: 28 361 of body 1, 7 419 of body 2." in out
    assert "Blocks" not in out
    assert (tmp_path / "overview.png").exists()


def test_a_duty_on_the_command_line_reaches_the_result(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, coarse: list[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("loads.csv").write_text("time [s],load [N]\n0,20\n10,60\n")
    settings = [*coarse, *STILL, "--duty", "loads.csv", "--hours", "0.005"]
    assert main(["run", "mtm_zddp", *settings, "--out", "out"]) == 0
    dataset = results.read(Path("out/result.nc"))
    assert dataset["load"].values.tolist() == [20.0, 20.0, 60.0]
    assert '"largest_load": "60.0 N"' in dataset.attrs["scene_json"]


def test_a_duty_in_a_scenes_file_is_looked_for_beside_it(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scenes = tmp_path / "scenes"
    scenes.mkdir()
    shipped = resources.files("contact_core") / "data" / "scenes" / "mtm_zddp.toml"
    text = shipped.read_text("utf-8") + 'file = "loads.csv"\n'  # [operation] is the last table
    (scenes / "own.toml").write_text(text, "utf-8")
    (scenes / "loads.csv").write_text("time [s],load [N]\n0,wrong\n")
    monkeypatch.chdir(tmp_path)
    assert main(["run", "scenes/own.toml"]) == 2
    assert "loads.csv, line 2, column 'load [N]', value 'wrong'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["mtm_zdp"], "There is no scene or machine 'mtm_zdp'. Did you mean 'mtm_zddp'?"),
        (["nowhere.toml"], "The scene file 'nowhere.toml' cannot be read"),
        (["mtm_zddp", "--set", "film.pionts=65"], "[film] has no key 'pionts'. Did you mean 'points'?"),
        (["mtm_zddp", "--set", "operation.load=50 kg"], "operation.load = '50 kg' has the wrong unit"),
        (["mtm_zddp", "--hours", "-1"], "operation.duration = -3600 s (test time) must be above 0"),
        (["mtm_zddp", "--hours", "nan"], "operation.duration = 'nan h' is not finite"),
        (["mtm_zddp", "--hours", ""], "--hours is empty. Give a value, or leave --hours out."),
        (["mtm_zddp", "--grid", ""], "--grid is empty."),
        (["mtm_zddp", "--duty", ""], "--duty is empty."),
        (["mtm_zddp", "--out", ""], "--out is empty."),
        (["mtm_zddp", "--grid", "40"], "surface_1.correlation_length = 8e-06 m is 0.62 nodes of the grid"),
        (["mtm_zddp", "--grid", "many"], "film.points = 'many' does not start with a number"),
        (["mtm_zddp", "--set", "film.criterion=lumped"], LUMPED),
        (["mtm_zddp", "--duty", "nowhere.csv"], "The duty file 'nowhere.csv' cannot be read"),
        (["mtm_zddp", "--out", "taken"], "The folder 'taken' cannot be made"),
    ],
)
def test_bad_input_is_refused_with_one_sentence_and_code_2(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    arguments: list[str],
    said: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("taken").write_text("a file")
    assert main(["run", *arguments]) == 2
    out, err = capsys.readouterr()
    assert not out
    assert err.startswith(f"tribofmu: {said}")
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["rn"], "there is no command 'rn'. Did you mean 'run'? `tribofmu` lists them"),
        (
            ["run", "mtm_zddp", "--hour", "3", "--dutty", "x.csv"],
            "unrecognized arguments: --dutty x.csv. Did you mean '--duty'?",
        ),
        (["run", "mtm_zddp", "--nonsense", "3"], "unrecognized arguments: --nonsense 3.\n"),
    ],
)
def test_a_mistyped_command_or_option_is_answered_with_one_like_it(
    arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        main(arguments)
    assert end.value.code == 2
    assert said in capsys.readouterr().err


def test_the_command_alone_says_how_to_start(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 2
    assert "To start: `tribofmu run mtm_zddp`" in " ".join(capsys.readouterr().err.split())


def test_files_in_the_folder_are_suggested_for_names_like_theirs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("ball.toml").write_text("", "utf-8")
    Path("loads.csv").write_text("", "utf-8")
    for given, said in (
        (["run", "ball"], "There is no scene or machine 'ball'. Did you mean 'ball.toml'?"),
        (["explain", "ball"], "There is no scene 'ball'. Did you mean 'ball.toml'?"),
        (["run", "bal.toml"], "'bal.toml' cannot be read: No such file or directory. Did you mean 'ball.toml'?"),
        (["run", "mtm_zddp", "--duty", "load.csv"], "No such file or directory. Did you mean 'loads.csv'?"),
    ):
        assert main(given) == 2
        assert said in capsys.readouterr().err


def test_one_pressure_for_oil_and_solids_goes_without_microroughness_alone(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert main(["build", "mtm_zddp", "--set", "film.criterion=lumped", "--out", str(tmp_path / "a.fmu")]) == 2
    assert capsys.readouterr().err == f"tribofmu: {LUMPED} See: tribofmu docs surfaces\n"
    assert Scene.from_toml("mtm_zddp", {"film.criterion": "lumped"} | HARD).film.lumped


@pytest.mark.parametrize("command", ["build", "stribeck"])
def test_commands_for_scenes_name_the_command_for_a_machine(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([command, "bearing_209"]) == 2
    assert "'bearing_209' is a machine: use `tribofmu run bearing_209`" in capsys.readouterr().err


def test_the_help_of_every_command_says_what_it_does(capsys: pytest.CaptureFixture[str]) -> None:
    for command, (_, text) in COMMANDS.items():
        with pytest.raises(SystemExit) as end:
            main([command, "--help"])
        assert end.value.code == 0
        assert f"{text[1:]}." in " ".join(capsys.readouterr().out.split())


def test_a_setting_without_a_value_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(["run", "mtm_zddp", "--set", "film.points"])
    assert end.value.code == 2
    assert "'film.points' is not KEY=VALUE" in capsys.readouterr().err


def test_what_a_scene_resolves_badly_is_warned_about_and_invalid_steps_give_code_1(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, coarse: list[str]
) -> None:
    impossible = OperatingPoint(load=-1.0, speed_1=0.1, speed_2=0.09, temperature=353.15)

    def of_scene(scene: Scene, folder: Path) -> Duty:
        return Duty((0.0, 10.0), (scene.operation.point, impossible))

    monkeypatch.setattr(Duty, "of_scene", of_scene)
    settings = [*coarse, *STILL, "--set", "surface_1.correlation_length=40 um", "--hours", "0.005"]
    assert main(["run", "mtm_zddp", *settings, "--out", str(tmp_path)]) == 1
    out, err = capsys.readouterr()
    assert "warning: surface_1 has 1.28 nodes per correlation length" in err
    assert "1 of 3 rows are INVALID" in out


def test_a_gear_flank_runs_to_the_end(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    settings = ["film.points=17", "film.width=0.2 mm", "surface_1.correlation_length=50 um"]
    settings += ["surface_2.correlation_length=50 um", "tribofilm.model=none", "wear.model=none"]
    assert main(["run", "fzg_flank", "--set", *settings, "--hours", "0.01", "--out", str(tmp_path)]) == 0
    out = capsys.readouterr().out
    assert "Load cycles: 1 302 of body 1, 867 of body 2." in out
    dataset = results.read(tmp_path / "result.nc")
    assert not {"radius_y", "spin", "spin_torque"} & set(dataset)
    assert dataset["radius_x"].values == approx(8.729e-3)


def test_the_stribeck_curves_of_a_line_are_swept(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--set", "film.model=regression", "--times", "0,10", "--points", "3", "--out", str(tmp_path)]
    assert main(["stribeck", "fzg_flank", *options]) == 0
    assert "All 6 points were computed. Friction is known to" in capsys.readouterr().out


def test_a_duty_of_what_a_line_does_not_have_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    duty = tmp_path / "duty.csv"
    duty.write_text("time [s],spin [rad/s]\n0,0\n10,5\n")
    assert main(["run", "fzg_flank", "--duty", str(duty), "--out", str(tmp_path)]) == 2
    assert "spin = 5 rad/s must be 0 where geometry.model = 'line'" in capsys.readouterr().err
    duty.write_text("time [s],radius_y [mm]\n0,10\n")
    assert main(["run", "fzg_flank", "--duty", str(duty), "--out", str(tmp_path)]) == 2
    assert "radius_y = 0.01 m: geometry.model = 'line' has none." in capsys.readouterr().err
