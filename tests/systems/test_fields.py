"""Fields of a run: what they are, that the run does not notice them, and that a kill does not change them."""

import logging
import re
import shutil
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest
import xarray as xr
from built import Built
from comparison import approx
from test_resume import KILLED, bits

from contact_core import ContactError, OperatingPoint, Scene, StateError, initial_state, solve
from contact_core.surfaces.patches import widened
from system_models.charts import files
from system_models.charts.chart import Chart
from system_models.cli.main import main
from system_models.run import maps, origin, track_picture
from system_models.run.contact import communication_points, run
from system_models.run.duty import Duty
from system_models.run.fields import Fields
from system_models.store import results
from system_models.store.checkpoint import Checkpoint

PAGE = (Path(__file__).parents[2] / "docs" / "how-to" / "fields.md").read_text("utf-8")
CONTACT = ("pressure", "fluid_pressure", "solid_pressure", "gap")
KINDS = ("tribofilm", "wear", "plastic")
END = 200.0


@pytest.fixture(scope="module")
def scene(fine: Scene) -> Scene:
    return fine


@pytest.fixture(scope="module")
def fmu(scene: Scene, built: Built) -> Path:
    return built.fmu(scene, "embedded")


@pytest.fixture(scope="module")
def changing(scene: Scene) -> Duty:
    """Rolling and sliding, then without a load, an impossible load, and pure rolling."""
    point = scene.operation.point
    unloaded, impossible, rolling = (
        OperatingPoint(load, 0.1, 0.1 - slip, 353.15) for load, slip in ((0.0, 0.01), (-1.0, 0.01), (40.0, 0.0))
    )
    return Duty((0.0, 90.0, 120.0, 150.0), (point, unloaded, impossible, rolling))


def every_row(scene: Scene, duty: Duty) -> Fields:
    points = communication_points(duty, END, 50.0)
    return Fields(scene, duty, points, len(points))


@pytest.fixture(scope="module")
def plain(fmu: Path, changing: Duty) -> xr.Dataset:
    return run(fmu, changing, END, 50.0)


@pytest.fixture(scope="module")
def found(fmu: Path, scene: Scene, changing: Duty, plain: xr.Dataset) -> xr.Dataset:
    """The fields of every row; the run with them is the one without."""
    fields = every_row(scene, changing)
    assert bits(run(fmu, changing, END, 50.0, None, None, fields)) == bits(plain)
    return fields.dataset()


def test_maps_are_at_the_rows_and_their_means_are_the_outputs(found: xr.Dataset, plain: xr.Dataset) -> None:
    assert found["field_time"].values.tolist() == plain["time"].values.tolist()
    track = np.abs(found["y"]) < found["half_width_y"]
    for body in (1, 2):
        for kind, output in (("tribofilm", "tribofilm"), ("wear", "wear_depth")):
            means = found[f"{kind}_map_{body}"].where(track).mean(("y", "x_track"))
            assert means.values[-1] > 0.0
            assert means.values == approx(plain[f"{output}_{body}"].values, rel=1e-5)
            profile = found[f"{kind}_profile_{body}"]
            assert profile.where(track).mean("y").values == approx(means.values, rel=1e-5)
        film, worn, pressed = (found[f"{kind}_map_{body}"] for kind in KINDS)
        heights = (film - worn - pressed + found[f"new_heights_{body}"]).mean("x_track")
        assert heights.values == approx(found[f"heights_profile_{body}"].values, abs=1e-13)


def test_pressures_carry_the_load_and_the_solids_carry_their_share(found: xr.Dataset, plain: xr.Dataset) -> None:
    cell = float(np.diff(found["x"].values)[0] * np.diff(found["y"].values)[0])
    solved = plain["valid"].values & (plain["load"].values > 0.0)
    assert solved.sum() == 4
    carried = found["pressure"].sum(("x", "y")).values * cell
    assert carried[solved] == approx(plain["load"].values[solved], rel=0.01)
    both = found["fluid_pressure"] + found["solid_pressure"]
    assert both.values[solved] == approx(found["pressure"].values[solved], rel=1e-6)
    share = found["solid_pressure"].sum(("x", "y")).values[solved] * cell / plain["load"].values[solved]
    assert share == approx(plain["contact_load_ratio"].values[solved], abs=0.1)
    assert found["gap"].values[solved].min() == approx(1e-9, rel=1e-6), "the floor"


def test_each_instant_says_how_it_was_solved(found: xr.Dataset) -> None:
    assert found["field_time"].values.tolist() == [0.0, 50.0, 90.0, 100.0, 120.0, 150.0, 200.0]
    names = found["instant_route"].attrs["flag_meanings"].split()
    routes = [names[code] for code in found["instant_route"].values]
    assert routes[3:6] == ["open", "open", "none"], "no load, and a load that is refused"
    assert {*routes[:3], routes[6]} <= {"mixed", "dry"}
    assert found["instant_converged"].values.tolist() == [name != "none" for name in routes]
    assert np.isnan(found["gap"].values[5]).all()
    assert not np.isnan(found["tribofilm_map_1"].values).any()
    assert not found["pressure"].values[3].any()


def test_the_file_gives_back_every_map_compressed_and_the_table_stays(
    found: xr.Dataset, plain: xr.Dataset, scene: Scene, changing: Duty, tmp_path: Path
) -> None:
    described = origin.with_scene(plain, scene, changing, 7)
    binary, table = results.write(described, tmp_path, maps=found)
    assert results.write_csv(described, tmp_path / "alone.csv").read_bytes() == table.read_bytes()
    with xr.open_dataset(binary) as read:
        xr.testing.assert_identical(read[list(found.data_vars)].drop_attrs(deep=False).load(), found)
        assert read.attrs["fields"] == 7
        xr.testing.assert_identical(read[list(plain.data_vars)].drop_attrs(), plain.drop_attrs())
        for name in (*CONTACT, *(f"{kind}_map_{body}" for kind in KINDS for body in (1, 2))):
            along = "x" if name in CONTACT else "x_track"
            assert read[name].dims == ("field_time", "y", along)
            assert read[name].dtype == np.float32
            encoding = read[name].encoding
            assert encoding["zlib"] and encoding["shuffle"] and encoding["chunksizes"][0] == 1
        for name, variable in read[list(found.variables)].variables.items():
            assert variable.attrs["units"] in ("m", "Pa", "s", "1"), name
            assert variable.attrs["long_name"], name
        assert read["x"].values[0] == approx(-0.25e-3)
        assert (read.sizes["x"], read.sizes["x_track"], read.sizes["y"]) == (33, 32, 33)


def test_the_page_reads_what_is_there(
    found: xr.Dataset, plain: xr.Dataset, scene: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    folder = Path("results/mtm_zddp")
    folder.mkdir(parents=True)
    results.write(plain, folder, maps=found)
    matplotlib.use("Agg")
    names: dict[str, Any] = {}
    for block in re.findall("```python\n(.*?)```", PAGE, re.DOTALL):
        exec(block, names)
    assert names["cover"].values == approx(plain["coverage_2"].values, rel=1e-6)
    assert names["outputs"].sizes["time"] == 7
    assert names["rough"].values[-1] > 0.1
    shift = float(found["offset_2"].values[-1]) / scene.film.spacing
    assert names["under"][:, round(shift) % 32] == approx(found["tribofilm_map_2"].values[-1, :, 0])
    table = PAGE.partition("## What there is")[2].partition("\n- ")[0]
    told = set(re.findall(r"`(\w+)`", table)) - {"_2"}
    assert {name for name in found.data_vars if not name.endswith("_2")} <= told <= set(found.data_vars)


def test_patches_lie_under_the_contact_at_their_offsets(found: xr.Dataset, scene: Scene) -> None:
    """Solids press where both patches are high, at these places and at no others."""
    now = found.isel(field_time=2)
    heights = {
        body: now[f"new_heights_{body}"] + now[f"tribofilm_map_{body}"] - now[f"wear_map_{body}"] for body in (1, 2)
    }
    inner = np.hypot(now["x"].values[:-1], now["y"].values[:, None]) < 0.7 * float(now["half_width_x"])
    rubbed = now["solid_pressure"].values[:, :-1] > 0.0

    def above(beside: int) -> float:
        """Return by how many standard deviations the rubbed nodes lie higher than the others."""
        nodes = [round(float(now[f"offset_{body}"]) / scene.film.spacing) + beside for body in (1, 2)]
        both = sum(np.roll(heights[body].values, shift, axis=1) for body, shift in zip((1, 2), nodes, strict=True))
        return float((both[rubbed & inner].mean() - both[~rubbed & inner].mean()) / both[inner].std())

    assert above(0) > 1.2
    assert all(abs(above(beside)) < 0.5 * above(0) for beside in (-9, -5, 5, 9))


@pytest.mark.long
def test_a_run_with_fields_goes_on_from_its_rows_bit_for_bit(
    fmu: Path,
    scene: Scene,
    changing: Duty,
    found: xr.Dataset,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    who, folder = origin.identity(scene, changing, 7), tmp_path / "run"
    folder.mkdir()
    saved: list[Path] = []
    save = Checkpoint.save

    def save_and_copy(self: Checkpoint, *arguments: Any) -> None:
        save(self, *arguments)
        saved.append(Path(shutil.copytree(folder, tmp_path / f"killed at {len(saved)}")))

    with monkeypatch.context() as patch:
        patch.setattr(Checkpoint, "save", save_and_copy)
        patch.setattr(Checkpoint, "due", lambda self: True)
        run(fmu, changing, END, 50.0, None, Checkpoint(folder, who), every_row(scene, changing))
    assert len(saved) == 7
    with pytest.raises(StateError, match="fields = 7 there, 'nothing' here"):
        Checkpoint.resume(saved[2], origin.identity(scene, changing))
    sizes = [(left / "checkpoint.kept").stat().st_size for left in saved]
    assert sorted(set(sizes)) == sizes, "the file of the records only grows"
    for count in (4, 7):
        checkpoint, fields = Checkpoint.resume(saved[count - 1], who), every_row(scene, changing)
        assert len(checkpoint.kept) == count
        caplog.clear()
        run(fmu, changing, END, 50.0, None, checkpoint, fields)
        assert bits(fields.dataset()) == bits(found)
        missing = [r for r in caplog.records if "The contact has no fields at 150 s." in r.getMessage()]
        assert len(missing) == (count < 6), "only what is left is solved"


@pytest.fixture
def no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Spare the time of drawing."""
    monkeypatch.setattr(files, "save", lambda sheet, path, dpi=150: path)


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
def test_a_run_with_fields_that_is_killed_again_and_again_writes_the_same_files(
    tmp_path: Path, coarse: list[str], no_pictures: None
) -> None:
    command = ["run", "mtm_zddp", *coarse, "--set", "operation.interval=12 s", "--fields", "4", "--resume"]
    whole, killed = tmp_path / "whole", tmp_path / "killed"
    assert main([*command, "--out", str(whole)]) == 0
    for where, last in (("before the checkpoint is replaced", 2), ("between two steps", 4)):
        child = subprocess.run(
            [sys.executable, "-c", KILLED, where, str(last), *command, "--out", str(killed)],
            capture_output=True,
            text=True,
        )
        assert child.returncode == -signal.SIGKILL, child.stderr
        assert (killed / "checkpoint.kept").exists()
    assert main([*command, "--out", str(killed)]) == 0
    names = ["result.csv", "result.nc"]
    for folder in (whole, killed):
        assert sorted(path.name for path in folder.iterdir()) == names
    assert all((whole / name).read_bytes() == (killed / name).read_bytes() for name in names)
    read = results.read(whole / "result.nc")
    assert read["field_time"].values.tolist() == [0.0, 24.0, 48.0, 72.0]
    assert set(read["field_time"].values) <= set(read["time"].values)
    assert (read["tribofilm_map_1"].max(("y", "x_track")).diff("field_time") > 0.0).all()


@pytest.mark.long
def test_other_fields_are_another_run_and_a_result_without_them_is_not_finished(
    tmp_path: Path, coarse: list[str], capsys: pytest.CaptureFixture[str], no_pictures: None
) -> None:
    still = [part for law in ("tribofilm", "wear", "heat") for part in ("--set", f"{law}.model=none")]
    command = ["run", "mtm_zddp", *coarse, *still, "--hours", "0.005", "--resume", "--out", str(tmp_path)]
    assert main(command) == 0
    capsys.readouterr()
    assert main([*command, "--fields", "1"]) == 0
    assert "There is no checkpoint" in capsys.readouterr().err
    for same in ([*command, "--fields", "1"], command):
        assert main(same) == 0
        assert "This run is finished" in capsys.readouterr().err
    read = results.read(tmp_path / "result.nc")
    assert read["field_time"].values.tolist() == [18.0]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--fields", "0"], "--fields 0 must be at least 1 and at most 5, the rows of this run."),
        (["--fields", "6"], "--fields 6 must be at least 1 and at most 5, the rows of this run."),
        (["--fields", "-1"], "--fields = '-1' must be a whole number of times, at least 1"),
        (["--fields", "2.5"], "--fields = '2.5' must be a whole number of times"),
        (["--fields", ""], "--fields is empty. Give a value, or leave --fields out."),
        (["--fields", "2", "--set", "film.model=regression"], "Use --set film.model=deterministic, or leave"),
        (["--fields", "2", "--set", "film.model=auto"], "film.model = 'regression' has no fields"),
    ],
)
def test_numbers_of_fields_that_cannot_be_kept_are_refused(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, coarse: list[str], arguments: list[str], said: str
) -> None:
    settings = [*coarse, "--set", "operation.interval=20 s"]
    assert main(["run", "mtm_zddp", *settings, *arguments, "--out", str(tmp_path / "none")]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1
    assert not (tmp_path / "none").exists()


def test_a_machine_has_no_fields(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "bearing_209", "--fields", "2"]) == 2
    assert "'bearing_209' is a machine. Leave it out" in capsys.readouterr().err


def test_fields_that_fill_the_memory_are_refused_and_large_ones_warned_of(
    scene: Scene, changing: Duty, caplog: pytest.LogCaptureFixture
) -> None:
    fine = replace(scene, film=replace(scene.film, points=1025))
    points = [float(k) for k in range(200)]
    assert maps.size_of(fine) == 1025 * (4 * 1025 + 6 * 1024) * 4
    with pytest.raises(
        ContactError, match=r"would keep 8\.4 GB of maps, 42 MB at each time; .* Use --fields 95 or less"
    ):
        Fields(fine, changing, points, 200)
    Fields(fine, changing, points, 20)
    assert "--fields 20 keeps 0.84 GB of maps in memory" in caplog.text


@pytest.mark.parametrize(
    ("points", "count", "times"),
    [
        ([0.0, 1.0, 2.0, 3.0, 4.0], 1, [4.0]),
        ([0.0, 1.0, 2.0, 3.0, 4.0], 2, [0.0, 4.0]),
        ([0.0, 1.0, 2.0, 3.0, 4.0], 3, [0.0, 2.0, 4.0]),
        ([0.0, 1.0, 2.0, 3.0, 4.0], 5, [0.0, 1.0, 2.0, 3.0, 4.0]),
        ([0.0, 0.1, 0.2, 9.0, 10.0], 4, [0.0, 0.2, 9.0, 10.0]),
        ([0.0, 9.8, 9.9, 10.0], 4, [0.0, 9.8, 9.9, 10.0]),
        ([0.0, 0.1, 0.2, 10.0], 3, [0.0, 0.2, 10.0]),
    ],
)
def test_times_are_rows_evenly_spread_from_start_to_end(
    scene: Scene, changing: Duty, points: list[float], count: int, times: list[float]
) -> None:
    assert Fields(scene, changing, points, count).times == times


def test_a_patch_that_has_got_more_rows_is_as_new_there_before(scene: Scene) -> None:
    state = initial_state(scene)
    first, second = (
        replace(body, wear=np.full_like(body.wear, 1e-9), growth=np.full_like(body.wear, 2e-9)) for body in state.bodies
    )
    early = replace(state, bodies=(first, second))
    later = replace(early, bodies=(widened(first, 8), widened(second, 8)))
    point = scene.operation.point
    found = maps.dataset_of(scene, [0.0, 1.0], [maps.taken(scene, point, each, 0.0) for each in (early, later)])
    assert found.sizes["y"] == 33 + 16
    assert found["y"].values[[0, 24, -1]] == approx([-24 * scene.film.spacing, 0.0, 24 * scene.film.spacing])
    before, after = found.isel(field_time=0), found.isel(field_time=1)
    for body in (1, 2):
        for name in ("wear", "tribofilm", "plastic"):
            assert (before[f"{name}_map_{body}"] == after[f"{name}_map_{body}"]).all()
        heights = (each[f"heights_profile_{body}"].values for each in (before, after))
        assert next(heights) == approx(next(heights), abs=1e-20)
    assert np.isnan(before["gap"].values).sum() == 16 * 33
    assert not np.isnan(after["gap"].values).any()


def test_a_contact_that_was_never_set_up_has_no_fields(scene: Scene, caplog: pytest.LogCaptureFixture) -> None:
    found = maps.dataset_of(scene, [5.0], [maps.taken(scene, scene.operation.point, None, 5.0)])
    assert "The contact has no fields at 5 s. It could not be set up." in caplog.text
    assert np.isnan(found["pressure"].values).all()
    assert found["instant_route"].values == [0]


def shown(plain: xr.Dataset, found: xr.Dataset) -> dict[str, Chart]:
    """The charts of the picture by their titles."""
    return {chart.title: chart for chart in track_picture.picture(plain, found).charts if chart}


def test_the_picture_shows_pads_tracks_profiles_and_coverage(
    found: xr.Dataset, plain: xr.Dataset, tmp_path: Path, drawn: bool
) -> None:
    panels = shown(plain, found)
    times = ("50 s", "100 s", "120 s", "200 s")
    for body in (1, 2):
        for time in times:
            pad = panels[f"tribofilm of body {body}, {time}"].map
            assert pad is not None
            values = found[f"tribofilm_map_{body}"].sel(field_time=float(time[:-2])).values
            assert pad.values == approx(1e9 * values)
            assert pad.y == approx((-250.0 * 33 / 32, 250.0 * 33 / 32))
            assert pad.keyed == (time == times[-1])
        wear = panels[f"wear of body {body}, 200 s"].map
        assert wear is not None and wear.values.max() > 1.0
        assert len(panels[f"Wear, body {body}"].lines) == 6  # of seven times; at the first nothing is worn
    assert {"pressure, 200 s", "gap, 200 s", "Coverage of the track", "Cross-section of body 2"} < {*panels}
    path = files.save(track_picture.picture(plain, found), tmp_path / "track.png")
    assert path.stat().st_size > (100_000 if drawn else 0)


@pytest.mark.parametrize("count", [1, *(pytest.param(count, marks=pytest.mark.long) for count in (2, 3))])
def test_the_picture_of_few_times_has_no_empty_panel(found: xr.Dataset, plain: xr.Dataset, count: int) -> None:
    panels = shown(plain, found.isel(field_time=range(7 - count, 7)))
    assert all(chart.map or chart.lines for chart in panels.values())
    assert len([title for title in panels if title.startswith("tribofilm of body 1, ")]) == count


def test_the_picture_of_a_smooth_line_has_curves(plain: xr.Dataset, tmp_path: Path) -> None:
    smooth = {f"surface_{body}.{key}": "0 nm" for body in (1, 2) for key in ("rq", "microroughness.rms")}
    scene = Scene.from_toml("fzg_flank", {"film.points": "33", "film.width": "0 mm", **smooth})
    found = maps.dataset_of(scene, [200.0], [maps.taken(scene, scene.operation.point, initial_state(scene), 200.0)])
    assert found.sizes["y"] == 1
    panels = shown(plain, found)
    assert panels["pressure, 200 s"].lines[0].y.max() == approx(1100.0, rel=0.1)  # MPa
    files.save(track_picture.picture(plain, found), tmp_path / "track.png")
    exact = solve(scene, scene.operation.point, initial_state(scene))
    assert found["pressure"].values[0] == approx(exact.pressure, rel=1e-6)


def test_without_fields_nothing_of_them_is_written(
    tmp_path: Path, coarse: list[str], no_pictures: None, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.WARNING)
    assert main(["run", "mtm_zddp", *coarse, "--hours", "0.005", "--out", str(tmp_path)]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["result.csv", "result.nc"]
    read = results.read(tmp_path / "result.nc")
    assert read.sizes == {"time": 2}
    assert "fields" not in read.attrs
