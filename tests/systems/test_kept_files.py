"""What is in a folder already is not lost without a word, and numbers that look like mistakes are asked back."""

import zipfile
from pathlib import Path

import pytest
from comparison import HARD

from contact_core import Scene, shipped_scenes
from contact_core.errors import ContactError
from system_models.cli import fit
from system_models.cli.compare import _page_of
from system_models.cli.main import main
from system_models.cli.overwriting import refuse_existing
from system_models.cli.report import written
from system_models.machines import plausibility, reading
from system_models.machines.files import shipped
from system_models.run.map_ranges import Ranges
from system_models.sweep.plan import plan_of

PAGE = "<title>{}</title> Made by tribofmu."


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_page_of_another_run_is_replaced_with_a_word_and_another_file_never(
    capsys: pytest.CaptureFixture[str],
) -> None:
    page = Path("page.html")
    written(page, PAGE.format("one"))
    written(page, PAGE.format("one") + " newer")
    assert not capsys.readouterr().err
    written(page, PAGE.format("two"))
    assert capsys.readouterr().err == "tribofmu: note: 'page.html', the page 'one', is replaced.\n"
    page.write_text("my own", "utf-8")
    with pytest.raises(ContactError, match=r"'page.html' is there already, and no page of tribofmu"):
        written(page, PAGE.format("two"))
    assert page.read_text("utf-8") == "my own"


@pytest.mark.parametrize(
    ("folders", "page"),
    [(("results/coarse", "results/fine"), "results/compare_coarse_fine.html"), (("a", "b/c"), "compare_a_c.html")],
)
def test_compared_runs_have_their_page_beside_the_first(folders: tuple[str, ...], page: str) -> None:
    assert _page_of([Path(each) for each in folders]) == Path(page)


def test_a_page_of_the_run_in_the_working_folder_lies_beside_it(folder: Path) -> None:
    assert _page_of([Path(), Path("../b")]).resolve() == folder.parent / f"compare_{folder.name}_b.html"


def test_files_named_on_the_command_line_are_replaced_by_force_alone() -> None:
    Path("mine.toml").write_text("a scene", "utf-8")
    with pytest.raises(ContactError, match=r"'mine.toml' is there already\. Use another --out, or --force"):
        refuse_existing([Path("new.npy"), Path("mine.toml")], force=False)
    refuse_existing([Path("mine.toml")], force=True)
    refuse_existing([Path("new.npy")], force=False)


def test_a_log_and_a_surface_do_not_write_over_files_that_are_there(capsys: pytest.CaptureFixture[str]) -> None:
    Path("rig.csv").write_text("Time (s),Load (N),Traction Coefficient\n0,50,0.1\n10,50,0.11\n", "utf-8")
    Path("rig_duty.csv").write_text("my own", "utf-8")
    assert main(["log", "rig.csv"]) == 2
    assert "'rig_duty.csv' is there already" in capsys.readouterr().err
    assert not Path("rig_data.csv").exists()
    assert main(["log", "rig.csv", "--force"]) == 0
    Path("disc.toml").write_text("my own", "utf-8")
    assert main(["surface-file", "disc.x3p"]) == 2
    assert "'disc.toml' is there already" in capsys.readouterr().err


def test_a_fit_to_other_data_is_kept_and_a_scene_of_its_name_too(capsys: pytest.CaptureFixture[str]) -> None:
    origin = {"data": "a.csv", "scene": "mine"}
    fit._ask_before(Path(), "a", origin, force=False)
    Path("fit.json").write_text('{"data": "a.csv", "scene": "mine", "level": "regression"}', "utf-8")
    fit._ask_before(Path(), "a", origin, force=False)
    assert "'fit.json', an earlier fit, will be replaced" in capsys.readouterr().err
    with pytest.raises(ContactError, match=r"'fit.json' is the fit to 'a.csv' in scene 'mine', and this is to 'b.csv'"):
        fit._ask_before(Path(), "b", origin | {"data": "b.csv"}, force=False)
    fit._ask_before(Path(), "b", origin | {"data": "b.csv"}, force=True)
    Path("fit.json").unlink()
    Path("mine.toml").write_text("a scene", "utf-8")
    with pytest.raises(ContactError, match=r"'mine.toml' is there already"):
        fit._ask_before(Path(), "mine", origin, force=False)


def test_an_fmu_of_another_scene_is_kept(capsys: pytest.CaptureFixture[str]) -> None:
    out, build = Path("contact.fmu"), ["build", "mtm_zddp", "--set", "film.model=regression", "--out", "contact.fmu"]
    with zipfile.ZipFile(out, "w") as fmu:
        fmu.writestr("modelDescription.xml", '<fmiModelDescription description="another: 1 N"/>')
    before = out.read_bytes()
    assert main(build) == 2
    assert "'contact.fmu' is there already: the FMU 'another: 1 N'. Use another --out" in capsys.readouterr().err
    assert out.read_bytes() == before
    out.write_text("my own", "utf-8")
    assert main(build) == 2
    assert "'contact.fmu' is there already: no FMU." in capsys.readouterr().err
    assert main([*build, "--flavour", "embedded", "--force"]) == 0
    assert main([*build, "--flavour", "embedded"]) == 0
    assert "Note: 'contact.fmu' is replaced." in capsys.readouterr().err


def test_a_sweep_says_that_it_replaces_one_of_other_values(capsys: pytest.CaptureFixture[str]) -> None:
    given = ["sweep", "mtm_zddp", "--out", "out", "--set", "film.model=regression", "operation.duration=1 min"]
    assert main([*given, "--vary", "operation.load=20 N:40 N:2"]) == 0
    assert main([*given, "--vary", "operation.load=20 N:40 N:2"]) == 0
    assert "will be replaced" not in capsys.readouterr().err
    assert main([*given, "--vary", "operation.load=20 N:60 N:2"]) == 0
    assert "sweep.nc', a result of another run, will be replaced" in capsys.readouterr().err
    assert main(["sweep", "azam_case_a", *given[2:], "--vary", "operation.load=20 N:40 N:2"]) == 2
    assert "sweep.nc' is the result of 'mtm_zddp', and this is 'azam_case_a'" in capsys.readouterr().err


def test_samples_of_another_seed_are_another_plan() -> None:
    plans = [plan_of(["operation.load=20 N:40 N"], 4, "lhs", seed) for seed in (1, 1, 2)]
    assert plans[0].text == plans[1].text != plans[2].text


DOUBTFUL = {
    "row": "time [s],speed_2 [m/s]\n0,0.0975\n30,-0.1\n60,-0.1005\n",
    "film": "time [s],load [N],speed_1 [m/s],speed_2 [m/s]\n0,50,0.1,0.1\n30,0.1,90,90\n",
}


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("row", "Row 2 of 'duty.csv' (at 30 s): speed_1 = 0.1025 m/s and speed_2 = -0.1 m/s are against each other"),
        ("film", "Row 2 of 'duty.csv' (at 30 s): the film of smooth bodies would be"),
    ],
)
@pytest.mark.parametrize("command", ["run", "stribeck"])
def test_every_row_of_a_duty_is_doubted(command: str, kind: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("duty.csv").write_text(DOUBTFUL[kind], "utf-8")
    settings = ["film.model=regression", "operation.file=duty.csv", *(f"{key}={value}" for key, value in HARD.items())]
    assert main([command, "mtm_zddp", "--set", *settings]) == 2
    err = capsys.readouterr().err
    assert err.startswith(f"tribofmu: {said}")
    assert "If this is meant, add --force." in err
    assert not Path("results").exists()


def test_speeds_of_a_stribeck_curve_are_doubted(capsys: pytest.CaptureFixture[str]) -> None:
    given = ["--set", "film.model=regression", "operation.load=0.1 N", "--fastest", "90", "--slowest", "1"]
    assert main(["stribeck", "mtm_zddp", *given]) == 2
    assert "The sweep at 90 m/s: the film of smooth bodies would be" in capsys.readouterr().err


def test_points_of_a_sweep_that_look_like_mistakes_are_refused_unless_forced(
    capsys: pytest.CaptureFixture[str],
) -> None:
    given = ["sweep", "mtm_zddp", "--set", "film.model=regression", "operation.duration=1 min"]
    given += ["--vary", "operation.speed_2=0.1 m/s,-0.1 m/s"]
    assert main(given) == 1
    assert "Refused: 1 of 2 points. The first: operation: speed_1 = 0.1025 m/s" in capsys.readouterr().out
    assert main([*given, "--force"]) == 0


def test_a_map_and_an_fmu_of_numbers_that_look_like_mistakes_are_asked_back(
    capsys: pytest.CaptureFixture[str],
) -> None:
    rough = ["--set", "surface_2.rq=20 um", "film.model=regression"]
    for command in ("map", "build"):
        assert main([command, "mtm_zddp", *rough]) == 2
        assert "surface_2 has an rms slope of 5" in capsys.readouterr().err
    assert main(["map", "mtm_zddp", "--load", "0.001:0.1", "--entrainment", "1:90"]) == 2
    assert "The map's range: the film of smooth bodies would be" in capsys.readouterr().err


@pytest.mark.parametrize("name", shipped())
def test_no_shipped_machine_is_doubted(name: str) -> None:
    machine = reading.read(name)
    assert plausibility.doubts(machine, reading.assemble(machine)) == []


def test_a_rough_contact_of_a_machine_and_a_rig_by_per_cent_are_asked_back(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["run", "gear_fzg_c", "--set", "contact.surface_2.rq=0.1 mm"]) == 2
    assert capsys.readouterr().err.count("surface_2 has 0.0001 m rms") == 1
    Path("duty.csv").write_text(
        "time [s],slide_roll_ratio [1],entrainment_speed [m/s]\n0,0.1,1\n9,10,1\n20,10,1\n", "utf-8"
    )
    assert main(["run", "mtm_rig", "--duty", "duty.csv"]) == 2
    err = capsys.readouterr().err
    assert "contact: row 2 of " in err
    assert "duty.csv' (at 9 s): speed_1 = 6 m/s and speed_2 = -4 m/s are against each other" in err


@pytest.mark.parametrize("name", shipped_scenes())
def test_no_map_about_a_shipped_scene_is_doubted(name: str) -> None:
    scene = Scene.from_toml(name)
    assert scene.doubts([("map", Ranges.of(scene, {}).extreme())]) == []
