"""Pages of results: they need nothing else, have the numbers of the result, and a browser shows them."""

import base64
import json
import math
import shutil
import subprocess
import zlib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from comparison import approx
from parsed_page import COARSE, Parsed, self_contained

from contact_core.state import RangeFlag
from system_models.charts.scale import ticks
from system_models.charts.units import stated, unit_for
from system_models.cli.main import main
from system_models.explain import left_out
from system_models.html_report import compare, errors, trust
from system_models.html_report.maps import encoded
from system_models.html_report.opened import Run, open_run
from system_models.html_report.page import page
from system_models.run.assumed import ATTRIBUTE as ASSUMED
from system_models.run.assumed import stored as stored_values
from system_models.run.causes import ATTRIBUTE
from system_models.store import results
from system_models.store.checkpoint import Checkpoint

RUN = ["run", "mtm_zddp", "--set", *COARSE, "--hours", "0.025", "--fields", "3"]
BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
LARGEST = 3e6  # bytes
CODES = 65534  # largest code of a value; the next one is no value


def decoded(low: float, high: float, codes: str, shape: tuple[int, ...]) -> np.ndarray:
    """Return the values of `encoded`, as the script has them."""
    found = np.frombuffer(zlib.decompress(base64.b64decode(codes)), "<u2").reshape(shape)
    values = low + (high - low) * found / CODES
    return np.where(found > CODES, np.nan, values)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results of a short run with maps."""
    out = tmp_path_factory.mktemp("report") / "run"
    assert main([*RUN, "--out", str(out)]) == 0
    return out


@pytest.fixture(scope="module")
def result(folder: Path) -> xr.Dataset:
    return results.read(folder / "result.nc")


@pytest.fixture(scope="module")
def opened(folder: Path) -> Run:
    return open_run(folder)


@pytest.fixture(scope="module")
def parsed(opened: Run) -> Parsed:
    return Parsed(page(opened))


def test_a_command_writes_a_page_that_needs_no_other_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["report", str(folder)]) == 0
    file = folder / "report.html"
    assert f"Written: {file}" in capsys.readouterr().out
    assert 5e4 < file.stat().st_size < LARGEST
    found = Parsed(file.read_text("utf-8"))
    assert self_contained(found)
    assert {"summary", "histories", "maps", "profiles", "errors", "flags", "solver", "scene", "modelled", "origin"} <= {
        *found.ids
    }


@pytest.mark.parametrize(
    "foreign",
    [
        '<img src="https://example.org/a.png">',
        "<style>p { background: url(a.png) }</style>",
        '<a href="#nowhere">x</a>',
    ],
)
def test_what_a_page_would_load_is_found(foreign: str) -> None:
    assert not self_contained(Parsed(f"<p>text</p>{foreign}"))


def test_charts_have_the_values_and_bands_of_the_result(parsed: Parsed, result: xr.Dataset) -> None:
    shown = {key: value for key, value in parsed.data.items() if key.startswith("points-history-0")}
    names = [["friction_coefficient"], ["h_c"], ["lambda_ratio"], ["contact_load_ratio"]]
    names += [[f"{name}_1", f"{name}_2"] for name in ("tribofilm", "wear_depth")]
    factors = (1.0, 1e9, 1.0, 1.0, 1e9, 1e9)
    assert len(shown) == len(names)
    for chart, variables, factor in zip(shown.values(), names, factors, strict=True):
        for line, name in zip(chart["lines"], variables, strict=True):
            assert line["x"] == approx(result["time"].values, rel=1e-4)
            assert line["y"] == approx(factor * result[name].values, rel=1e-4)
            if name == "lambda_ratio":  # without an error
                assert not line.get("half")
            else:
                assert line["half"] == approx(factor * result[f"{name}_error"].values, rel=1e-4)


def test_maps_are_those_of_the_result(parsed: Parsed, result: xr.Dataset) -> None:
    maps = {each["title"]: each for each in parsed.data["maps-data"]["maps"]}
    wanted = {
        "Pressure": "pressure",
        "Gap": "gap",
        "Tribofilm, body 2": "tribofilm_map_2",
        "Wear, body 1": "wear_map_1",
    }
    for title, name in wanted.items():
        each, expected = maps[title], result[name].values
        values = decoded(each["low"], each["high"], each["data"], (3, *each["shape"]))
        factor = {"Pa": 1.0, "kPa": 1e-3, "MPa": 1e-6, "GPa": 1e-9, "nm": 1e9, "µm": 1e6}[each["unit"]]
        assert np.abs(values - factor * expected).max() < 1e-4 * factor * np.abs(expected).max(), title
    assert len(parsed.data["maps-data"]["times"]) == 3


def test_codes_keep_missing_values() -> None:
    values = np.array([[1.0, np.nan], [-3.0, 2.0]])
    back = decoded(*encoded(values), values.shape)
    np.testing.assert_allclose(back, values, atol=1e-4)


def test_causes_add_up_to_the_stated_error(result: xr.Dataset, opened: Run, parsed: Parsed) -> None:
    causes = json.loads(result.attrs[ATTRIBUTE])
    assert causes == opened.causes[""]
    for name in ("h_c", "friction_coefficient", "contact_load_ratio", "tribofilm_1"):
        assert math.hypot(*causes[name].values()) == approx(float(result[f"{name}_error"].values[-1]), rel=1e-9)
        assert causes[name]["grid"] > 0.0
    assert "central film thickness" in parsed.text


def test_results_of_versions_that_knew_fewer_causes_can_be_read(opened: Run) -> None:
    known = {name: {c: half for c, half in each.items() if c != "inlet"} for name, each in opened.causes[""].items()}
    older = replace(opened, causes={"": known})
    assert known != opened.causes[""]
    assert "steps in time" in errors.sections(older)


def test_scene_laws_versions_and_digests_are_told(parsed: Parsed, opened: Run) -> None:
    assert opened.scene is not None
    for words in ("53.7 N", "9.525 mm", "Ghanbarzadeh et al. 2016", *opened.files.values()):
        assert words in parsed.text, words
    assert opened.scene.digest() in parsed.text
    on, off = parsed.text.split("What was modelled, and what was not")[1].split("Left out")
    assert "A circular or elliptical contact." in on
    assert all(each.cost in off for each in left_out.of(opened.scene))
    assert "fatigue" in off
    assert "https://doi.org/10.1016/j.triboint.2014.12.018" in parsed.links


def with_flags(run: Run, flags: list[int]) -> Run:
    changed = run.dataset.copy(deep=True)
    changed["range_flags"].values[:] = flags
    return replace(run, dataset=changed)


def test_a_flag_is_told_with_its_time_and_a_remedy(opened: Run) -> None:
    none = Parsed(page(with_flags(opened, [0, 0, 0, 0])))
    assert "No flag was raised" in none.text
    found = Parsed(page(with_flags(opened, [0, 0, RangeFlag.SCUFFING, 0])))
    assert "hotter than the critical temperature" in found.text
    assert "30 to 60 s, 1 of 4 rows" in found.text
    assert "Lower load, sliding or oil temperature." in found.text


def test_every_flag_has_a_remedy(opened: Run) -> None:
    every = int(sum(RangeFlag))
    assert set(trust.raised(with_flags(opened, [every] * 4))) == {*RangeFlag}
    text = Parsed(page(with_flags(opened, [every] * 4))).text
    assert all(flag.text[1:] in text for flag in RangeFlag)


def test_rows_that_could_not_be_computed_are_told(opened: Run) -> None:
    changed = opened.dataset.copy(deep=True)
    changed["valid"].values[2] = False
    text = Parsed(page(replace(opened, dataset=changed))).text
    assert "Rows are not valid from 30 to 60 s: inputs could not be used" in text


def test_a_title_cannot_become_markup(opened: Run) -> None:
    evil = "<script>alert('x')</script>"
    found = Parsed(page(replace(opened, dataset=opened.dataset.assign_attrs(title=evil))))
    assert evil in found.text
    assert "alert" not in found.own


@pytest.mark.long
def test_an_interrupted_run_is_shown_as_far_as_it_went(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    save = Checkpoint.save

    def saved_and_interrupted(self: Checkpoint, time: float, *rest: Any) -> None:
        save(self, time, *rest)
        if time >= 60.0:
            raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(Checkpoint, "save", saved_and_interrupted)
        patch.setattr(Checkpoint, "due", lambda self: True)
        assert main([*RUN, "--out", str(tmp_path)]) == 130
    run = open_run(tmp_path)
    assert (run.finished, run.reached, run.planned, run.dataset.sizes["field_time"]) == (False, 60.0, 90.0, 2)
    found = Parsed(page(run))
    assert "UNFINISHED" in found.text
    assert "at 60 s of 90 s" in found.text
    line = found.data["points-history-0-1"]["lines"][0]
    assert line["y"] == approx(1e9 * run.dataset["h_c"].values, rel=1e-4)
    assert run.causes[""]["h_c"]["grid"] > 0.0
    assert main(["report", str(tmp_path)]) == 0
    capsys.readouterr()


def test_a_level_without_maps_says_so(other: Path) -> None:
    found = Parsed(page(open_run(other)))
    assert "This level of the model has no maps" in found.text
    assert "maps-data" not in found.data
    assert "fitted curves" in found.text
    assert self_contained(found)


def test_assumed_values_are_told_where_the_result_has_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "own"]) == 0
    scene = tmp_path / "own.toml"
    out = tmp_path / "run"
    quick = ["--set", "film.model=regression", "operation.duration=2 min"]
    assert main(["run", str(scene), *quick, "--out", str(out)]) == 0
    run = open_run(out)
    told = Parsed(page(run)).text.split("what the scene does not say")[1]
    assert "surface_1.correlation_length" in told and "of a polished surface" in told
    attributes = {key: value for key, value in run.dataset.attrs.items() if key != ASSUMED}
    bare = run.dataset.copy()
    bare.attrs = attributes
    older = replace(run, dataset=bare, assumed=stored_values(attributes))
    assert "This result does not say it: an older version has made it." in Parsed(page(older)).text


def test_a_share_that_may_be_anything_is_not_called_known(opened: Run) -> None:
    changed = opened.dataset.copy(deep=True)
    changed["contact_load_ratio"].values[:], changed["contact_load_ratio_error"].values[:] = 1e-30, 1.0
    text = Parsed(page(replace(opened, dataset=changed))).text
    assert "Load carried by solids is not known: its error leaves all open." in text
    assert "unknown" in text
    assert "00000%" not in text


def test_a_folder_without_results_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["report", str(tmp_path)]) == 2
    assert "has neither a result.nc nor a checkpoint. Give the folder of --out" in capsys.readouterr().err
    (tmp_path / "result.nc").write_bytes(b"no netCDF")
    assert main(["report", str(tmp_path)]) == 2
    assert "cannot be read" in capsys.readouterr().err


@pytest.fixture(scope="module")
def other(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A longer run of the same contact at another level and speed."""
    out = tmp_path_factory.mktemp("report") / "other"
    settings = ["film.model=regression", "operation.speed_1=0.5m/s", "operation.speed_2=0.4m/s"]
    assert (
        main(["run", "mtm_zddp", "--set", *settings, "operation.interval=30s", "--hours", "0.05", "--out", str(out)])
        == 0
    )
    return out


def test_runs_are_compared_at_the_last_time_that_all_have_reached(
    folder: Path, other: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "both.html"
    assert main(["compare", str(folder), str(other), "--out", str(file)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["at", "90", "s", "unit", "run", "other", "bands"]
    assert any("The runs end at different times (run 90 s, other 180 s)" in line for line in lines)
    runs = compare.open_runs([folder, other])
    film = next(each for each in compare.end_values(runs, "") if each.title == "Central film thickness")
    later = runs[1].dataset["h_c"].sel(time=90.0)
    assert film.found[1] == approx(1e9 * float(later), rel=1e-9)
    found = Parsed(file.read_text("utf-8"))
    assert self_contained(found)
    assert [line["label"] for line in found.data["points-compare-0-h_c"]["lines"]] == ["run", "other"]
    assert "film.model" in found.text
    assert "film.sharing.load_factor" not in found.text  # which only the regression level has


def test_one_folder_cannot_be_compared(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare", str(folder)]) == 2
    assert "give at least 2 and at most 7" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("found", "halves", "verdict"),
    [
        ((1.0, 1.5), (0.3, 0.3), "overlap"),
        ((1.0, 1.5), (0.2, 0.2), "apart"),
        ((1.0, 1.5, 1.25), (0.2, 0.2, 0.2), "apart"),
        ((1.0, 1.5), (math.nan, 0.2), "–"),
        ((1.0, math.nan, 1.1), (0.2, math.nan, 0.2), "overlap"),
    ],
)
def test_bands_overlap_or_not(found: tuple[float, ...], halves: tuple[float, ...], verdict: str) -> None:
    assert compare.EndValue("", unit_for("1", [1.0]), found, halves).verdict == verdict


@pytest.mark.parametrize(
    ("si", "value", "name", "shown"),
    [
        ("m", 5.2e-8, "nm", 52.0),
        ("Pa", 1.15e9, "MPa", 1150.0),
        ("K", 353.15, "°C", 80.0),
        ("s", 7200.0, "min", 120.0),
        ("m2/s", 1.25e-5, "m²/s", 1.25e-5),
        ("rad/s", 100.0, "rpm", 954.93),
        ("m/s", 0.1, "m/s", 0.1),
    ],
)
def test_quantities_are_shown_in_units_that_people_read(si: str, value: float, name: str, shown: float) -> None:
    unit = unit_for(si, [value])
    assert unit.name == name
    assert float(unit.of(value)) == approx(shown, rel=1e-5)


def test_a_difference_of_temperatures_stays_in_kelvin() -> None:
    assert float(unit_for("K", [3.0], difference=True).of(3.0)) == 3.0


@pytest.mark.parametrize(
    ("value", "half", "text"),
    [
        (0.1037, 0.0084, "0.104 ± 0.008"),
        (52.3, 5.6, "52 ± 6"),
        (5.2, 0.14, "5.20 ± 0.14"),
        (1.0, math.inf, "1 ± ?"),
        (1.7e-7, 5e-8, "1.7e-07 ± 5e-08"),
        (3.9e-208, 4e-16, "0"),
    ],
)
def test_values_are_stated_to_the_digits_of_their_error(value: float, half: float, text: str) -> None:
    assert stated(value, half) == text


def test_ticks_are_round_and_within() -> None:
    assert ticks(0.0, 0.12) == approx([0.0, 0.025, 0.05, 0.075, 0.1], abs=1e-12)
    assert ticks(-250.0, 250.0) == [-200.0, -100.0, 0.0, 100.0, 200.0]


@pytest.mark.skipif(BROWSER is None, reason="no Chromium")
def test_a_browser_shows_the_page_without_an_error(opened: Run, tmp_path: Path) -> None:
    file = tmp_path / "page.html"
    file.write_text(page(opened), "utf-8")
    assert BROWSER is not None
    options = [
        "--headless=new",
        "--no-sandbox",
        "--disable-gpu",
        "--enable-logging=stderr",
        "--virtual-time-budget=5000",
    ]
    shown = subprocess.run(
        [BROWSER, *options, f"--user-data-dir={tmp_path}", "--dump-dom", file.as_uri()],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    assert [line for line in shown.stderr.splitlines() if "CONSOLE" in line] == []
    assert '<output class="now">90 s</output>' in shown.stdout  # the script has unpacked and drawn the maps
