"""The command `tribofmu map`: histories, resumption, accuracy, refusals and report, on made-up solutions."""

import json
import math
import re
import shutil
import sys
from dataclasses import replace
from itertools import islice
from pathlib import Path

import pytest
from comparison import approx
from mapped_scene import SMALL, made_up

from contact_core import ContactError, Scene, advance, initial_state
from contact_core.corrections.knot import History, Plan, coarser, solve
from contact_core.corrections.map import read
from system_models.cli.main import main
from system_models.run import map_build
from system_models.run.map_build import Order, is_held, scene_of_histories, tasks
from system_models.run.map_ranges import Ranges
from system_models.run.workers import done_by, workers

RANGES = ("--temperature", "350K:356K")
CHANGES = ("--set", *(f"{key}={value}" for key, value in SMALL.items()))


@pytest.fixture
def solved(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Numbers of the histories that are solved, by the made-up level."""
    numbers = list[int]()

    def solve_one(scene: Scene, number: int, fine: bool, plan: Plan) -> History:
        numbers.append(number)
        return made_up(scene, number, fine, plan)

    monkeypatch.setattr(map_build, "solve", solve_one)
    return numbers


def command(folder: Path, *more: str) -> int:
    return main(["map", "mtm_zddp", "--out", str(folder), *RANGES, *more, *CHANGES])


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a map that is accurate to 8 %."""
    folder = tmp_path_factory.mktemp("map")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(map_build, "solve", made_up)
        assert command(folder, "--accuracy", "8 %") == 0
    return folder


def test_a_map_is_made_until_it_is_accurate_and_corrects_the_scene_that_names_it(
    tmp_path: Path, solved: list[int], capsys: pytest.CaptureFixture[str], drawn: bool
) -> None:
    assert command(tmp_path, "--accuracy", "8 %") == 0
    out = capsys.readouterr().out
    assert "No more because the accuracy is reached." in out
    assert solved == list(range(len(solved)))
    assert len(solved) in {10, 20, 30}
    page = (tmp_path / "report.md").read_text("utf-8")
    assert "held back" in page and "| friction |" in page and "![held-back knots](held_back.png)" in page
    assert (tmp_path / "held_back.png").stat().st_size > (10_000 if drawn else 0)
    file = tmp_path / "mtm_zddp.json"
    assert file.stat().st_size < 2_000_000
    table = Scene.from_toml("mtm_zddp", SMALL).at_level("map").to_dict()
    table["film"]["file"] = str(file)
    scene = Scene.from_dict(table)
    outputs = advance(scene, scene.operation.point, initial_state(scene), 0.0)[1]
    assert outputs.error_friction < 0.1


def test_held_back_histories_leave_no_trace_in_the_map(finished: Path, tmp_path: Path, solved: list[int]) -> None:
    first, *lines = (finished / "histories.jsonl").read_text("utf-8").splitlines()
    histories = [json.loads(line) for line in lines]
    held = [history for history in histories if is_held(order(), history["number"])]
    assert len(held) >= 2
    for knot in [knot for history in held for knot in history["knots"]]:
        knot["found"] = [2.0 * x for x in knot["found"]]
    (tmp_path / "histories.jsonl").write_text("\n".join([first, *map(json.dumps, histories), ""]), "utf-8")
    command(tmp_path, "--accuracy", "8 %")
    assert read(str(tmp_path / "mtm_zddp.json")) == read(str(finished / "mtm_zddp.json"))


def test_a_build_that_goes_on_gives_the_map_of_one_that_was_not_interrupted(
    finished: Path, tmp_path: Path, solved: list[int]
) -> None:
    lines = (finished / "histories.jsonl").read_text("utf-8").splitlines(keepends=True)
    cut = "".join(lines[:6]) + lines[6][:40]  # a kill in the middle of a line
    (tmp_path / "histories.jsonl").write_text(cut, "utf-8")
    command(tmp_path, "--accuracy", "8 %")
    assert solved == list(range(5, len(lines) - 1))
    assert (tmp_path / "mtm_zddp.json").read_text("utf-8") == (finished / "mtm_zddp.json").read_text("utf-8")


def test_when_the_time_is_over_the_map_of_what_is_solved_is_written_and_the_exit_code_says_so(
    finished: Path, tmp_path: Path, solved: list[int], capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copy(finished / "histories.jsonl", tmp_path)
    assert command(tmp_path, "--accuracy", "0.1 %", "--time", "0.001s") == 1
    assert len(solved) <= 1
    assert "because the time was over" in capsys.readouterr().out


def test_too_few_histories_are_refused_and_kept(
    tmp_path: Path, solved: list[int], capsys: pytest.CaptureFixture[str]
) -> None:
    assert command(tmp_path, "--time", "0.001s") == 2
    assert re.search(r"too few for a map: it takes 30 of 3\. Give more --time", capsys.readouterr().err)
    assert (tmp_path / "histories.jsonl").exists()


def test_histories_of_other_ranges_are_refused(
    finished: Path, tmp_path: Path, solved: list[int], capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copy(finished / "histories.jsonl", tmp_path)
    assert command(tmp_path, "--load", "20:30") == 2
    assert "of another scene, or of other ranges" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--load", "10"), "--load = '10' is not LOW:HIGH"),
        (("--load", "80:10"), "must begin below its end"),
        (("--temperature", "60:100"), "60 may be degC or K. Write 60degC or 60K"),
        (("--radius-x", "5mm:12mm"), "geometry.model = 'point' has two radii"),
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
    assert found.load == approx((0.5 * 53.7, 1.5 * 53.7))
    narrow = Ranges.of(Scene.from_toml("mtm_zddp", SMALL | {"film.domain": "0.37 mm"}), {})
    assert narrow.load[1] < found.load[1]
    for number in range(20):
        plan = found.draw(1, number)
        for point in (plan.rubbing, *(point for _, point in plan.elsewhere)):
            assert found.load[0] <= point.load <= found.load[1]
            assert found.slide_roll[0] <= abs(point.sliding_speed / point.entrainment_speed) <= found.slide_roll[1]
    assert found.draw(1, 0).rubbing == scene.operation.point


def test_radii_of_lines_are_drawn_from_their_range() -> None:
    found = Ranges.of(Scene.from_toml("fzg_flank"), {"radius_x": "5 mm:12 mm"})
    radii = [found.draw(1, number).rubbing.radius_x for number in range(1, 20)]
    assert 5e-3 <= min(radii) < 7e-3 and 10e-3 < max(radii) <= 12e-3


def order() -> Order:
    scene = Scene.from_toml("mtm_zddp", SMALL)
    return Order(scene, Ranges.of(scene, {}), 0.05, 1.0)


def test_a_history_is_that_of_the_deterministic_level_on_the_surfaces_that_the_regression_level_has() -> None:
    scene = scene_of_histories(Scene.from_toml("mtm_zddp", SMALL))
    plan = Ranges.of(scene, {}).draw(1, 3)
    plan = plan._replace(times=(0.0, 20.0, 40.0), elsewhere=((1, plan.elsewhere[0][1]),))
    history = solve(scene, 3, True, plan)
    assert History.from_dict(json.loads(json.dumps(history.to_dict()))) == history
    assert (history.number, history.fine, history.refused) == (3, True, ())
    assert [knot.point for knot in history.knots] == [plan.rubbing] * 2 + [plan.elsewhere[0][1], plan.rubbing]
    deep, fast = (scene.at_level(name) for name in ("deterministic", "regression"))
    state, quick = initial_state(deep), initial_state(fast)
    for dt in (0.0, 20.0, 20.0):
        state, out = advance(deep, plan.rubbing, state, dt)
        quick, _ = advance(fast, plan.rubbing, quick, dt)
    last = history.knots[-1]
    assert last.found == (out.friction_coefficient, out.h_c, out.contact_load_ratio)
    assert last.means == quick.means
    for knot in history.knots:
        for whole, shared, scatter in zip(knot.errors, knot.shared, knot.scatter, strict=True):
            assert shared**2 + scatter**2 <= whole**2 * 1.0001


def test_most_histories_are_solved_on_a_coarser_grid_and_some_on_both() -> None:
    assert coarser(Scene.from_toml("mtm_zddp", SMALL)) is None
    assert coarser(Scene.from_toml("mtm_zddp")).film.points == 65
    both = replace(order(), scene=Scene.from_toml("mtm_zddp"))
    assert list(islice(tasks(both), 6)) == [(0, True), (0, False), (1, False), (2, False), (3, False), (4, True)]
    assert list(islice(tasks(order()), 3)) == [(0, True), (1, True), (2, True)]


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
