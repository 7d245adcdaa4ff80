import csv
import math
from dataclasses import replace
from multiprocessing import active_children
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from comparison import approx

from contact_core import ContactState, ConvergenceError, OperatingPoint, Outputs, RangeFlag, Scene, advance
from contact_core.errors import ContactError
from contact_core.quantities import TABLE
from system_models.charts import files
from system_models.cli import stribeck as command
from system_models.cli.main import main
from system_models.run import stribeck, stribeck_report, workers
from system_models.run.duty import Duty
from system_models.run.stribeck import Curves, Plan, measure, rubbing, transition_speed
from system_models.store import results

FAST, SLOW = 8.0, 0.008
DRY = ["--processes", "1", "--set", "control.driver=dry"]  # costs next to nothing


def curves_of(scene: Scene, duty: Duty, plan: Plan, processes: int = 1) -> Curves:
    curves = Curves(plan)
    measure(scene, duty, curves, processes=processes)
    return curves


@pytest.fixture(scope="module")
def plan(duty: Duty) -> Plan:
    return Plan.of(duty, [0.0, 72.0], FAST, SLOW, 3)


@pytest.fixture(scope="module")
def light(scene: Scene) -> Scene:
    """The same with so little load that a fast film does not fit on the grid."""
    return replace(scene, operation=replace(scene.operation, load=1.0))


@pytest.fixture(scope="module")
def swept(scene: Scene, duty: Duty, plan: Plan) -> xr.Dataset:
    return curves_of(scene, duty, plan).dataset(scene, duty)


def refusing(monkeypatch: pytest.MonkeyPatch, error: BaseException, after: int) -> None:
    """Let one advance without rubbing end with an error, `after` as many that went well."""
    count = 0

    def advanced(scene: Scene, op: OperatingPoint, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
        nonlocal count
        if dt == 0.0 and state.solved_for is not None:
            count += 1
            if count == after + 1:
                raise error
        return advance(scene, op, state, dt)

    monkeypatch.setattr(stribeck, "advance", advanced)


@pytest.mark.parametrize("level", [0.5, 0.3])
def test_the_transition_of_a_straight_line_in_log_speed_is_exact(level: float) -> None:
    speeds = np.geomspace(0.01, 10.0, 7)
    shares = 0.4 - 0.25 * np.log10(speeds)
    assert transition_speed(speeds, shares, level) == approx(10.0 ** ((0.4 - level) / 0.25), rel=1e-12)


def test_the_transition_does_not_depend_on_the_order_of_the_speeds() -> None:
    speeds, shares = np.geomspace(10.0, 0.01, 6), np.array([0.01, 0.2, 0.4, 0.7, 0.9, 0.95])
    assert speeds[3] < transition_speed(speeds, shares) < speeds[2]
    assert transition_speed(speeds[::-1], shares[::-1]) == transition_speed(speeds, shares)


def test_a_speed_right_at_the_level_is_the_transition() -> None:
    assert transition_speed([0.1, 1.0, 10.0], [0.9, 0.5, 0.1]) == approx(1.0, rel=1e-12)


@pytest.mark.parametrize(
    "shares", [[0.9, 0.8, 0.6], [0.4, 0.2, 0.1], [0.1, 0.5, 0.9], [math.nan] * 3, [math.nan, 0.9, 0.8]]
)
def test_a_level_that_is_not_bracketed_has_no_transition(shares: list[float]) -> None:
    assert math.isnan(transition_speed([0.1, 1.0, 10.0], shares))


def test_points_without_a_solution_are_passed_over() -> None:
    assert transition_speed([0.1, 1.0, 10.0], [0.75, math.nan, 0.25]) == approx(1.0, rel=1e-12)


def test_of_several_crossings_the_fastest_is_the_transition() -> None:
    assert 10.0 < transition_speed([0.1, 1.0, 10.0, 100.0], [0.9, 0.4, 0.6, 0.1]) < 100.0


def test_speeds_are_evenly_spaced_in_their_logarithm_and_fall(duty: Duty) -> None:
    plan = Plan.of(duty, [60.0, 0.0, 60.0], 10.0, 0.01, 4)
    assert plan.speeds == approx((10.0, 1.0, 0.1, 0.01), rel=1e-12)
    assert plan.times == (0.0, 60.0)


def test_the_slide_to_roll_ratio_is_the_dutys_unless_given(duty: Duty, scene: Scene) -> None:
    own = Plan.of(duty, [0.0], 10.0, 0.01, 4).point(2.0)
    assert (own.speed_1, own.speed_2) == approx((2.05, 1.95), rel=1e-12)
    given = Plan.of(duty, [0.0], 10.0, 0.01, 4, srr=-0.5).point(2.0)
    assert (given.speed_1, given.speed_2) == (1.5, 2.5)
    assert replace(given, speed_1=own.speed_1, speed_2=own.speed_2) == own
    assert own.load == scene.operation.load


def test_a_contact_entrained_the_other_way_is_swept_the_other_way(scene: Scene) -> None:
    point = replace(scene.operation.point, speed_1=-0.3, speed_2=-0.1)
    swept = Plan.of(Duty.from_steps(point), [0.0], 10.0, 0.01, 4).point(2.0)
    assert (swept.speed_1, swept.speed_2) == approx((-3.0, -1.0), rel=1e-12)


def test_a_duty_without_entrainment_needs_a_slide_to_roll_ratio(scene: Scene) -> None:
    duty = Duty.from_steps(replace(scene.operation.point, speed_1=0.1, speed_2=-0.1))
    with pytest.raises(ContactError, match="Give one with --srr"):
        Plan.of(duty, [0.0], 10.0, 0.01, 4)
    assert Plan.of(duty, [0.0], 10.0, 0.01, 4, srr=0.1).slide_roll_ratio == 0.1


def test_variables_lie_along_both_dimensions_with_units_and_texts_of_the_quantity_table(swept: xr.Dataset) -> None:
    for name in (
        "friction_coefficient",
        "lambda_ratio",
        "contact_load_ratio",
        "contact_area_ratio",
        "h_c",
        "range_flags",
    ):
        assert swept[name].dims == ("rubbing_time", "entrainment_speed")
        error = {"ancillary_variables": f"{name}_error"} if TABLE[name].error else {}
        assert swept[name].attrs == {"units": TABLE[name].unit or "1", "long_name": TABLE[name].text} | error
        assert all(half in swept.coords for half in error.values())
    assert swept.sizes == {"rubbing_time": 2, "entrainment_speed": 3}
    assert all({"units", "long_name"} <= set(swept[name].attrs) for name in swept.variables)
    assert swept["valid"].values.all()
    assert swept.attrs["failures"] == ""


def test_from_fast_to_slow_the_film_gets_thinner_and_the_solids_take_over(swept: xr.Dataset) -> None:
    for curve in (swept.isel(rubbing_time=i) for i in (0, 1)):
        assert (np.diff(curve["lambda_ratio"]) < 0.0).all()
        assert (np.diff(curve["contact_load_ratio"]) > 0.0).all()
        assert (np.diff(curve["friction_coefficient"]) > 0.0).all()
        assert curve["contact_load_ratio"][0] < 0.2
        assert curve["contact_load_ratio"][-1] > 0.5


def test_each_point_is_the_contact_at_that_speed_with_the_surfaces_of_that_time(
    scene: Scene, duty: Duty, plan: Plan, swept: xr.Dataset
) -> None:
    *_, (state, _) = rubbing(scene, duty, plan.times)
    before = state.to_bytes()
    _, outputs = advance(scene, plan.point(plan.speeds[1]), state, 0.0)
    assert state.to_bytes() == before
    for name in ("friction_coefficient", "contact_load_ratio", "h_c", "range_flags"):
        assert float(swept[name][1, 1]) == getattr(outputs, name)
    assert float(swept["tribofilm_2"][1]) == outputs.tribofilm_2 > 0.0


def test_a_sweep_does_not_depend_on_its_other_speeds(scene: Scene, duty: Duty, plan: Plan, swept: xr.Dataset) -> None:
    ends = curves_of(scene, duty, replace(plan, times=(0.0,), speeds=(SLOW, FAST))).dataset(scene, duty)
    assert ends["friction_coefficient"].values[0].tolist() == swept["friction_coefficient"].values[0, [-1, 0]].tolist()


def test_a_speed_within_the_scenes_tolerance_of_the_duty_is_solved_for_itself(scene: Scene, duty: Duty) -> None:
    tolerant = replace(scene, control=replace(scene.control, input_change=1.0))
    near = Plan.of(duty, [0.0], 0.11, 0.1095, 2)
    found = curves_of(tolerant, duty, near).dataset(tolerant, duty)["h_c"].values[0]
    ((state, outputs),) = rubbing(tolerant, duty, near.times)
    assert advance(tolerant, near.point(near.speeds[0]), state, 0.0)[1].h_c == outputs.h_c
    assert len({*found.tolist(), outputs.h_c}) == 3


def test_films_settle_at_each_speed_also_where_they_follow_the_inputs_of_the_duty(
    scene: Scene, duty: Duty, plan: Plan, swept: xr.Dataset
) -> None:
    following = replace(scene, control=replace(scene.control, inputs="transient"))
    found = curves_of(following, duty, replace(plan, times=(0.0,))).dataset(following, duty)
    assert found["h_c"].values[0].tolist() == swept["h_c"].values[0].tolist()


def test_rubbing_is_that_of_a_run_bit_for_bit(scene: Scene, duty: Duty, dataset: xr.Dataset) -> None:
    (_, first), (_, last) = rubbing(scene, duty, (0.0, 72.0))
    for name in ("friction_coefficient", "tribofilm_1", "wear_depth_2", "roughness_2"):
        assert getattr(first, name) == float(dataset[name][0])
        assert getattr(last, name) == float(dataset[name][-1])


def test_rubbing_stops_between_the_steps_of_a_run(scene: Scene, duty: Duty) -> None:
    assert [state.time for state, _ in rubbing(scene, duty, (10.0, 35.0))] == approx([10.0, 35.0], rel=1e-12)


def test_several_processes_find_the_same_to_the_bit(
    scene: Scene, duty: Duty, plan: Plan, swept: xr.Dataset, capfd: pytest.CaptureFixture[str]
) -> None:
    shown: list[tuple[str, int]] = []
    curves = Curves(plan)
    measure(scene, duty, curves, lambda *told: shown.append(told), 2)
    xr.testing.assert_identical(curves.dataset(scene, duty), swept)
    assert [count for _, count in shown] == sorted(count for _, count in shown)
    assert "rubbed 1 min" in dict(shown)
    assert {f"{time} min, {speed} m/s" for time in ("0", "1.2") for speed in ("8", "0.253", "0.008")} <= {*dict(shown)}
    assert shown[-1] == ("done", 6)
    assert capfd.readouterr() == ("", "")


def test_a_point_that_has_no_solution_in_another_process_is_the_same(
    light: Scene, caplog: pytest.LogCaptureFixture
) -> None:
    duty = Duty.of_scene(light)
    plan = Plan.of(duty, [0.0, 30.0], 40.0, 0.01, 2)
    alone, shared = (curves_of(light, duty, plan, processes).dataset(light, duty) for processes in (1, 2))
    xr.testing.assert_identical(shared, alone)
    first, second = shared.attrs["failures"].splitlines()
    assert first.startswith("After 0 min at 40 m/s: No solution was found for an oil film of about")
    assert second.startswith("After 0.5 min at 40 m/s: ")
    assert caplog.text.count(first) == caplog.text.count(second) == 2


def test_points_of_a_process_that_is_lost_are_solved_in_this_one(
    scene: Scene, duty: Duty, plan: Plan, swept: xr.Dataset, caplog: pytest.LogCaptureFixture
) -> None:
    def kill(stage: str, count: int) -> None:
        for child in active_children() if count == 1 else ():
            child.kill()

    curves = Curves(plan)
    measure(scene, duty, curves, kill, 2)
    xr.testing.assert_identical(curves.dataset(scene, duty), swept)
    assert caplog.messages == [
        "A worker process has ended before its task: killed, or out of memory. With less memory use fewer --processes. "
        "What is left is solved in one process."
    ]


@pytest.mark.parametrize(
    ("asked", "level", "given"), [(None, "deterministic", 7), (None, "regression", 1), (3, "regression", 3)]
)
def test_by_default_each_core_has_a_process_where_contacts_are_solved(
    scene: Scene, monkeypatch: pytest.MonkeyPatch, asked: int | None, level: str, given: int
) -> None:
    monkeypatch.setattr(workers, "cores", lambda: 7)
    assert command._processes(asked, scene.at_level(level)) == given


@pytest.mark.long
def test_a_rougher_disc_needs_more_speed() -> None:
    found = []
    for rq, fine in (("60 nm", "8 nm"), ("120 nm", "16 nm")):  # twice as rough at all lengths
        scene = Scene.from_toml(
            "mtm_zddp",
            {
                "film.points": "33",
                "surface_1.correlation_length": "16 um",
                "surface_2.correlation_length": "16 um",
                "surface_2.rq": rq,
                "surface_2.microroughness.rms": fine,
            },
        )
        duty = Duty.of_scene(scene)
        curves = curves_of(scene, duty, Plan.of(duty, [0.0], 5.0, 0.001, 4)).dataset(scene, duty)
        found.append(float(curves["transition_speed"][0]))
    assert found[1] > 1.5 * found[0] > 0.0


def test_composite_roughness_is_that_of_both_surfaces(swept: xr.Dataset) -> None:
    both = swept["composite_roughness"]
    np.testing.assert_allclose(both**2, swept["roughness_1"] ** 2 + swept["roughness_2"] ** 2, rtol=1e-12)
    assert both.attrs["units"] == "m"


def test_the_transitions_are_those_of_the_curves(swept: xr.Dataset) -> None:
    level = swept.attrs["friction_midway"]
    friction = swept["friction_coefficient"]
    assert level == approx(0.5 * float(friction.min() + friction.max()), rel=1e-12)
    for i in (0, 1):
        speeds = swept["entrainment_speed"]
        assert float(swept["transition_speed"][i]) == transition_speed(speeds, swept["contact_load_ratio"][i])
        assert float(swept["transition_speed_friction"][i]) == transition_speed(speeds, friction[i], level)


def test_a_point_without_a_solution_is_nan_and_says_why(
    scene: Scene, duty: Duty, plan: Plan, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    dry = replace(scene, control=replace(scene.control, driver="dry"))
    whole = curves_of(dry, duty, plan).dataset(dry, duty)
    refusing(monkeypatch, ConvergenceError("No solution was found. Use a finer grid."), after=4)
    found = curves_of(dry, duty, plan).dataset(dry, duty)
    assert np.argwhere(~found["valid"].values).tolist() == [[1, 1]]
    assert np.argwhere(np.isnan(found["friction_coefficient"].values)).tolist() == [[1, 1]]
    assert found.attrs["failures"] == "After 1.2 min at 0.253 m/s: No solution was found. Use a finer grid."
    assert found.attrs["failures"] in caplog.text
    rest = found["valid"].values
    assert found["h_c"].values[rest].tolist() == whole["h_c"].values[rest].tolist()
    assert stribeck_report.closing_lines(found)[:2] == ["Validity: 1 of 6 points are INVALID.", found.attrs["failures"]]


def test_the_table_has_a_row_for_each_speed_and_a_column_for_each_time(swept: xr.Dataset) -> None:
    head, units, *rows = (line.split() for line in stribeck_report.table(swept).splitlines())
    assert head == ["speed", "friction", "friction"]
    assert units == ["m/s", "0", "min", "1.2", "min"]
    assert [float(row[0]) for row in rows] == approx([8.0, 0.253, 0.008])
    printed = np.array([[float(cell) for cell in row[1:]] for row in rows])
    np.testing.assert_allclose(printed, swept["friction_coefficient"].values.T, atol=5.1e-5)


def test_the_shift_is_told_for_each_time_and_in_all(swept: xr.Dataset) -> None:
    speeds = swept["transition_speed"].copy(data=[0.1, 0.25])
    films = swept["tribofilm_roughness_2"].copy(data=[0.0, 30e-9])
    rough = swept["composite_roughness"].copy(data=[100e-9, 150e-9])
    changed = swept.assign(transition_speed=speeds, tribofilm_roughness_2=films, composite_roughness=rough)
    first, second, verdict = stribeck_report.shift_lines(changed)
    assert first.startswith("After 0 min: W_c = 0.5 at 0.1 m/s")
    assert second.startswith("After 1.2 min: W_c = 0.5 at 0.25 m/s")
    assert "30.0 nm (body 2), of both surfaces together 150.0 nm" in second
    assert "after 1.2 min by 2.50, roughness by 1.50." in verdict
    assert "highest speed after 1.2 min, the surfaces are roughest after 1.2 min" in verdict
    assert "10.1007/s11249-019-1148-9" in verdict


def test_a_curve_without_a_transition_says_so(swept: xr.Dataset) -> None:
    changed = swept.assign(transition_speed=swept["transition_speed"].copy(data=[0.1, math.nan]))
    lines = stribeck_report.shift_lines(changed)
    assert len(lines) == 2
    assert "W_c = 0.5 at no speed of the sweep" in lines[1]


def test_the_picture_has_four_panels_with_a_line_for_each_time(swept: xr.Dataset) -> None:
    charts = [chart for chart in stribeck_report.sheet(swept).charts if chart]
    names = ("friction_coefficient", "lambda_ratio", "contact_load_ratio", "contact_area_ratio")
    assert len({chart.y_label for chart in charts}) == 4
    for chart, name in zip(charts, names, strict=True):
        assert chart.logarithmic_x
        for line, values in zip([line for line in chart.lines if line.dash], swept[name].values, strict=True):
            np.testing.assert_array_equal(line.x, swept["entrainment_speed"])
            np.testing.assert_array_equal(line.y, values)
    assert [line.label for line in charts[0].keyed] == ["0", "1.2"]


def test_points_that_are_not_converged_are_hollow(swept: xr.Dataset) -> None:
    flags = np.zeros(swept["range_flags"].shape, int)
    flags[1, 2] = int(RangeFlag.NOT_CONVERGED | RangeFlag.INLET_UNRESOLVED)
    flags[0, 0] = int(RangeFlag.INLET_UNRESOLVED)
    changed = swept.assign(range_flags=swept["range_flags"].copy(data=flags))
    axis = files.figure(stribeck_report.sheet(changed)).axes[0]
    hollow = [line for line in axis.lines if str(line.get_markerfacecolor()) == "white"]
    drawn = [(x, y) for line in hollow for x, y in zip(line.get_xdata(), line.get_ydata(), strict=True)]
    assert drawn == [(swept["entrainment_speed"][2], swept["friction_coefficient"][1, 2])]
    assert axis.get_legend().get_texts()[-1].get_text() == "not converged"


@pytest.mark.usefixtures("drawn")
def test_the_command_prints_a_table_and_writes_three_files(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, coarse: list[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    options = ["--times", "0", "0.5,1", "--points", "2", "--fastest", "2", "--slowest", "5 mm/s", "--srr", "50 %"]
    assert main(["stribeck", "mtm_zddp", *coarse, *DRY, *options]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("Azam's case B")
    assert "After 0.5 min: W_c = 0.5 at" in out
    assert "6/6 points" in err
    folder = tmp_path / "results" / "mtm_zddp"
    assert {path.name for path in folder.iterdir()} == {"stribeck.nc", "stribeck.csv", "stribeck.png"}
    assert all(str(Path("results/mtm_zddp") / path.name) in out for path in folder.iterdir())
    dataset = results.read(folder / "stribeck.nc")
    assert dataset["rubbing_time"].values.tolist() == [0.0, 30.0, 60.0]
    assert dataset["entrainment_speed"].values.tolist() == approx([2.0, 0.005])
    assert float(dataset["slide_roll_ratio"]) == 0.5
    assert dataset.attrs["scene"] == "mtm_zddp"
    expected = dataset["friction_coefficient"].values.ravel().tolist()
    with (folder / "stribeck.csv").open(newline="") as file:
        header, *rows = csv.reader(file)
    assert header[:3] == ["rubbing_time [s]", "entrainment_speed [m/s]", "friction_coefficient [1]"]
    assert [float(row[0]) for row in rows] == [0.0, 0.0, 30.0, 30.0, 60.0, 60.0]
    assert [float(row[2]) for row in rows] == expected


def test_an_interrupt_keeps_what_was_measured(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, coarse: list[str]
) -> None:
    refusing(monkeypatch, KeyboardInterrupt(), after=3)
    options = ["--times", "0,1", "--points", "2", "--out", str(tmp_path)]
    assert main(["stribeck", "mtm_zddp", *coarse, *DRY, *options]) == 130
    assert f"tribofmu: Interrupted. The 3 points measured so far are in '{tmp_path}" in capsys.readouterr().err
    dataset = results.read(tmp_path / "stribeck.nc")
    assert dataset["valid"].values.tolist() == [[True, True], [False, True]]
    assert np.isfinite(dataset["friction_coefficient"].values).tolist() == [[True, True], [False, True]]
    assert dataset.attrs["failures"] == "1 points were not reached."


@pytest.mark.parametrize("processes", ["1", "2"])
def test_rubbing_that_cannot_go_on_keeps_what_was_measured(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    coarse: list[str],
    processes: str,
) -> None:
    def stuck(scene: Scene, op: OperatingPoint, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
        if dt > 0.0:
            raise ConvergenceError("No solution was found. Use a finer grid.")
        return advance(scene, op, state, dt)

    monkeypatch.setattr(stribeck, "advance", stuck)
    options = ["--times", "0,1", "--points", "2", "--out", str(tmp_path), "--processes", processes]
    assert main(["stribeck", "mtm_zddp", *coarse, *DRY, *options]) == 2
    err = capsys.readouterr().err
    assert "tribofmu: No solution was found. Use a finer grid. The 2 points measured so far are in" in err
    dataset = results.read(tmp_path / "stribeck.nc")
    assert dataset["valid"].values.tolist() == [[True, True], [False, False]]
    assert np.isnan(dataset["composite_roughness"].values).tolist() == [False, True]
    assert dataset.attrs["failures"] == "2 points were not reached."


def test_an_interrupt_before_the_first_point_leaves_an_older_result(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, coarse: list[str]
) -> None:
    (tmp_path / "stribeck.nc").write_text("older")
    refusing(monkeypatch, KeyboardInterrupt(), after=0)
    assert main(["stribeck", "mtm_zddp", *coarse, *DRY, "--points", "2", "--out", str(tmp_path)]) == 130
    assert (tmp_path / "stribeck.nc").read_text() == "older"


def test_a_point_without_a_solution_gives_code_1(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, coarse: list[str]
) -> None:
    refusing(monkeypatch, ConvergenceError("None was found. Refine."), after=1)
    options = ["--times", "0", "--points", "2", "--out", str(tmp_path)]
    assert main(["stribeck", "mtm_zddp", *coarse, *DRY, *options]) == 1
    assert "After 0 min at 10 m/s: None was found. Refine." in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--times", "soon"], "--times = 'soon' must be numbers of minutes, such as 0,5,30."),
        (["--times=-5,0"], "The rubbing times must be"),
        (["--times", "nan"], "The rubbing times must be"),
        (["--times", ""], "The rubbing times must be"),
        (["--fastest", "0.001"], "The speeds of a sweep, 0.001 m/s down to 0.003 m/s, must be above 0 and fall."),
        (["--slowest", "0"], "The speeds of a sweep, 10 m/s down to 0 m/s"),
        (["--slowest", "quick"], "--slowest = 'quick' does not start with a number"),
        (["--fastest", "1 kg"], "--fastest = '1 kg' has the wrong unit"),
        (["--fastest", "1000"], "speed_1 = 1025 m/s"),
        (["--points", "1"], "A sweep of 1 speeds is no curve."),
        (["--srr", "much"], "--srr = 'much"),
        (["--grid", "40"], "surface_1.correlation_length = 8e-06 m is 0.62 nodes of the grid"),
        (["--out", ""], "--out is empty."),
    ],
)
def test_bad_input_is_refused_before_anything_is_computed(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], said: str
) -> None:
    monkeypatch.chdir(tmp_path)

    def never(*_: Any) -> None:
        raise AssertionError("computed")

    monkeypatch.setattr(stribeck, "advance", never)
    assert main(["stribeck", "mtm_zddp", *arguments]) == 2
    out, err = capsys.readouterr()
    assert not out
    assert err.startswith(f"tribofmu: {said}")
    assert not list(tmp_path.iterdir())
