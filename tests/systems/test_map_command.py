"""The command `tribofmu map`: knots, resumption, accuracy, refusals and report, on made-up solutions."""

import json
import math
import re
import sys
from pathlib import Path

import pytest
from comparison import approx
from mapped_scene import SMALL, made_up

from contact_core import ContactError, Scene, advance, initial_state
from contact_core.mapped.knot import Knot, solve
from contact_core.mapped.map import read
from system_models.cli.main import main
from system_models.run import map_build
from system_models.run.map_build import scene_of_knots
from system_models.run.map_ranges import Ranges
from system_models.run.map_workers import done_by, workers

RANGES = ("--temperature", "350:356")
CHANGES = ("--set", *(f"{key}={value}" for key, value in SMALL.items()))


@pytest.fixture
def solved(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Numbers of the knots that are solved, by the made-up level."""
    numbers = list[int]()

    def solve_one(scene: Scene, number: int, *drawn: object) -> Knot:
        numbers.append(number)
        return made_up(scene, number, *drawn)

    monkeypatch.setattr(map_build, "solve", solve_one)
    return numbers


def command(folder: Path, *more: str) -> int:
    return main(["map", "mtm_zddp", "--out", str(folder), *RANGES, *more, *CHANGES])


def test_a_map_is_made_until_it_is_accurate_and_corrects_the_scene_that_names_it(
    tmp_path: Path, solved: list[int], capsys: pytest.CaptureFixture[str]
) -> None:
    assert command(tmp_path, "--accuracy", "8 %") == 0
    out = capsys.readouterr().out
    assert "No more because the accuracy is reached." in out
    assert solved == list(range(len(solved)))
    assert 40 <= len(solved) <= 100
    page = (tmp_path / "report.md").read_text("utf-8")
    assert "held back" in page and "| friction |" in page and "![held-back knots](held_back.png)" in page
    assert (tmp_path / "held_back.png").stat().st_size > 10_000
    file = tmp_path / "mtm_zddp.json"
    assert file.stat().st_size < 2_000_000
    table = Scene.from_toml("mtm_zddp", SMALL).at_level("map").to_dict()
    table["film"]["file"] = str(file)
    scene = Scene.from_dict(table)
    outputs = advance(scene, scene.operation.point, initial_state(scene), 0.0)[1]
    assert outputs.error_friction < 0.1


def test_held_back_knots_leave_no_trace_in_the_map(tmp_path: Path, solved: list[int]) -> None:
    command(tmp_path, "--accuracy", "8 %")
    first, *lines = (tmp_path / "knots.jsonl").read_text("utf-8").splitlines()
    knots = [json.loads(line) for line in lines]
    for knot in knots:
        if knot["number"] % 5 == 4:
            knot["found"] = [2.0 * x for x in knot["found"]]
    other = tmp_path / "other"
    other.mkdir()
    (other / "knots.jsonl").write_text("\n".join([first, *map(json.dumps, knots), ""]), "utf-8")
    command(other, "--accuracy", "8 %")
    assert read(str(other / "mtm_zddp.json")) == read(str(tmp_path / "mtm_zddp.json"))


def test_a_build_that_goes_on_gives_the_map_of_one_that_was_not_interrupted(tmp_path: Path, solved: list[int]) -> None:
    whole, cut = tmp_path / "whole", tmp_path / "cut"
    command(whole, "--accuracy", "8 %")
    count = len(solved)
    cut.mkdir()
    text = (whole / "knots.jsonl").read_text("utf-8")
    lines = text.splitlines(keepends=True)
    (cut / "knots.jsonl").write_text("".join(lines[:30]) + lines[30][:40], "utf-8")  # a kill in the middle of a line
    solved.clear()
    command(cut, "--accuracy", "8 %")
    assert solved == list(range(29, count))
    assert (cut / "mtm_zddp.json").read_text("utf-8") == (whole / "mtm_zddp.json").read_text("utf-8")


def test_when_the_time_is_over_the_map_of_what_is_solved_is_written_and_the_exit_code_says_so(
    tmp_path: Path, solved: list[int], capsys: pytest.CaptureFixture[str]
) -> None:
    command(tmp_path, "--accuracy", "8 %")
    solved.clear()
    assert command(tmp_path, "--accuracy", "0.1 %", "--time", "0.001s") == 1
    assert len(solved) <= 1
    assert "because the time was over" in capsys.readouterr().out


def test_too_few_knots_are_refused_and_kept(
    tmp_path: Path, solved: list[int], capsys: pytest.CaptureFixture[str]
) -> None:
    assert command(tmp_path, "--time", "0.001s") == 2
    assert re.search(r"too few for a map: it takes 30\. Give more --time", capsys.readouterr().err)
    assert (tmp_path / "knots.jsonl").exists()


def test_knots_of_other_ranges_are_refused(
    tmp_path: Path, solved: list[int], capsys: pytest.CaptureFixture[str]
) -> None:
    command(tmp_path, "--accuracy", "8 %")
    assert command(tmp_path, "--load", "20:30") == 2
    assert "of another scene, or of other ranges" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--load", "10"), "--load = '10' is not LOW:HIGH"),
        (("--load", "80:10"), "must begin below its end"),
        (("--slide-roll", "0:0.5"), "The range of slide_roll begins at 0"),
        (("--entrainment", "a:b"), "--entrainment = 'a' does not start with a number"),
        (("--accuracy", "0 %"), "--accuracy = 0 % must be above 0"),
        (("--time", "soon"), "--time = 'soon' is not a time such as"),
        (("--time", "1.2.3h"), "--time = '1.2.3h' is not a time such as"),
        (("--processes", "0"), "--processes = 0 must be at least 1"),
        (("--executor", "there"), "--executor = 'there' is not dask://HOST:PORT"),
    ],
)
def test_options_that_cannot_be_used_are_refused_with_a_way_out(
    tmp_path: Path, solved: list[int], capsys: pytest.CaptureFixture[str], options: tuple[str, ...], message: str
) -> None:
    assert command(tmp_path, *options) == 2
    assert message in capsys.readouterr().err
    assert not solved


def test_ranges_are_about_the_operation_within_grid_and_hardness() -> None:
    scene = Scene.from_toml("mtm_zddp", SMALL)
    found = Ranges.of(scene, {"temperature": "60 degC:90 degC"})
    assert found.temperature == approx((333.15, 363.15))
    assert found.load == approx((0.2 * 53.7, 2.0 * 53.7))
    narrow = Ranges.of(Scene.from_toml("mtm_zddp", SMALL | {"film.domain": "0.4 mm"}), {})
    assert narrow.load[1] < found.load[1]
    for number in range(20):
        point = found.draw(1, number).point
        assert found.load[0] <= point.load <= found.load[1]
        assert found.slide_roll[0] <= abs(point.sliding_speed / point.entrainment_speed) <= found.slide_roll[1]


def test_a_knot_is_a_block_on_rubbed_surfaces_and_comes_back_from_its_text() -> None:
    scene = scene_of_knots(Scene.from_toml("mtm_zddp", SMALL))
    drawn = Ranges.of(scene, {}).draw(1, 0)
    knot = solve(scene, 3, *drawn._replace(rubbed=30.0))
    assert Knot.from_dict(json.loads(json.dumps(knot.to_dict()))) == knot
    assert knot.number == 3
    assert knot.means is not None and knot.means[1].growth > 0.0
    assert min(knot.found) > 0.0
    for whole, shared, scatter in zip(knot.errors, knot.shared, knot.scatter, strict=True):
        assert shared**2 + scatter**2 <= whole**2 * 1.0001


def test_other_processes_find_the_same() -> None:
    found = []
    for processes in (1, 2):
        with workers(processes, None) as given:
            found.append(sorted(done_by(given, math.ldexp, ((0.5, k) for k in range(20)))))
    assert found[0] == found[1] == [math.ldexp(0.5, k) for k in range(20)]


def test_without_the_package_of_clusters_the_way_to_it_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ContactError, match=r"pip install 'tribofmu\[dask\]'"), workers(1, "dask://localhost:1"):
        pass
