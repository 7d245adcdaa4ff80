from dataclasses import fields, replace
from pathlib import Path

import pytest

from contact_core import OperatingPoint, Scene, SceneError
from contact_core.scene.toml import read_table
from system_models.run.duty import Duty

REFERENCE = OperatingPoint(load=50.0, speed_1=0.1, speed_2=0.2, temperature=350.0)


def write(folder: Path, text: str) -> Path:
    path = folder / "duty.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_constant_duty_holds_its_point_for_ever() -> None:
    duty = Duty.from_steps(REFERENCE)
    assert [duty.at(time) for time in (0.0, 1.0, 1e9)] == [REFERENCE] * 3


def test_each_row_holds_from_its_own_time_on(tmp_path: Path) -> None:
    duty = Duty.from_csv(write(tmp_path, "time [s],load [N]\n0,10\n20,30\n"), REFERENCE)
    assert [duty.at(time).load for time in (0.0, 19.999, 20.0, 1e6)] == [10.0, 10.0, 30.0, 30.0]


def test_columns_are_converted_from_the_units_of_the_header(tmp_path: Path) -> None:
    text = "time [min],load [kN],speed_1 [mm/s],temperature [degC]\n0,0.01,5,80\n2,0.02,6,90\n"
    duty = Duty.from_csv(write(tmp_path, text), REFERENCE)
    assert duty.times == (0.0, 120.0)
    assert duty.points[1] == OperatingPoint(20.0, 0.006, REFERENCE.speed_2, 363.15)


def test_missing_columns_keep_the_reference(tmp_path: Path) -> None:
    duty = Duty.from_csv(write(tmp_path, "time [s],speed_2 [m/s]\n0,1\n"), REFERENCE)
    assert duty.points == (OperatingPoint(50.0, 0.1, 1.0, 350.0),)


def test_spaces_blank_lines_and_a_byte_order_mark_do_no_harm(tmp_path: Path) -> None:
    duty = Duty.from_csv(write(tmp_path, "\ufefftime [s] , load [N]\n\n 0 , 1 \n\n5,2\n"), REFERENCE)
    assert [point.load for point in duty.points] == [1.0, 2.0]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("time [s],load [N]\n0,ten\n", r"duty\.csv, line 2, column 'load \[N\]', value 'ten': not a finite"),
        ("time [s],load [N]\n0,1\n9,nan\n", r"line 3, column 'load \[N\]', value 'nan': not a finite number"),
        ("time [s],load [N]\n0,-5\n", r"line 2, column 'load \[N\]', value '-5': load = -5 N .* at least 0"),
        ("time [s],temperature [degC]\n0,900\n", r"value '900': temperature = 1173\.15 K .* at most 500 K"),
        ("time [s],load [N]\n1,1\n", r"line 2: time = 1 s, but the first row must be at time 0"),
        ("time [s],load [N]\n0,1\n5,1\n5,2\n", r"line 4: time = 5 s does not come after the 5 s of the row"),
        ("time [s],load [N]\n0,1,5\n", r"line 2: 3 values for 2 columns\. Put a comma between values"),
        ("time [s],srr [%]\n0,1\n", r"line 1: there is no column 'srr'\. Give 'speed_1' and 'speed_2' \[m/s\]"),
        ("time [s],lod [N]\n0,1\n", r"line 1: there is no column 'lod'\. Did you mean 'load'\? Known are"),
        ("time [s],load\n0,1\n", r"line 1: column 'load' is not a name with a unit\. Write for example"),
        ("time [s],load [m]\n0,1\n", r"line 1: load = '1\.0 m' has the wrong unit: .* convertible to N"),
        ("time [s],load [N],load [N]\n0,1,1\n", r"line 1: column 'load' is there twice"),
        ("load [N]\n1\n", r"line 1: the columns are load; 'time' and at least one of load, speed_1"),
        ("time [s],load [N]\n", r"needs a header such as 'time \[s\],load \[N\]' and a row below it"),
    ],
)
def test_a_bad_table_is_refused_with_what_is_wrong(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(SceneError, match=said):
        Duty.from_csv(write(tmp_path, text), REFERENCE)


def test_a_missing_file_is_refused_by_name() -> None:
    with pytest.raises(SceneError, match=r"The duty file 'nowhere\.csv' cannot be read: No such file"):
        Duty.from_csv("nowhere.csv", REFERENCE)


def test_a_file_that_is_no_text_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "duty.csv"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(SceneError, match="is not a CSV file in UTF-8"):
        Duty.from_csv(path, REFERENCE)


@pytest.mark.parametrize(("times", "points"), [((), 0), ((1.0,), 1), ((0.0, 0.0), 2), ((0.0, 1.0), 1)])
def test_times_that_make_no_duty_are_refused(times: tuple[float, ...], points: int) -> None:
    with pytest.raises(SceneError, match="must start at 0, increase, and be as many as its points"):
        Duty(times, (REFERENCE,) * points)


def test_a_fingerprint_changes_with_everything_that_a_duty_sets() -> None:
    def of(time: float, **changes: float) -> str:
        return Duty((0.0, time), (REFERENCE, replace(REFERENCE, **changes))).fingerprint()

    changed = {of(1.0, **{f.name: 1.5}) for f in fields(OperatingPoint)} | {of(1.0), of(1.0 + 1e-15)}
    assert len(changed) == len(fields(OperatingPoint)) + 2
    assert of(1.0) == of(1.0)


def test_a_scene_without_a_file_has_a_constant_duty(scene: Scene) -> None:
    assert Duty.of_scene(scene) == Duty.from_steps(scene.operation.point)


def test_radii_may_change_within_a_duty(tmp_path: Path) -> None:
    text = "time [s],radius_x [mm],radius_y [mm]\n0,10,10\n5,8,9\n"
    duty = Duty.from_csv(write(tmp_path, text), REFERENCE)
    assert [(point.radius_x, point.radius_y) for point in duty.points] == [(0.01, 0.01), (0.008, 0.009)]
    steps = Duty.of_scene(with_steps([{"time": "60 s", "radius_x": "8 mm"}]))
    assert [(point.radius_x, point.radius_y) for point in steps.points] == [(None, None), (0.008, None)]


def test_radii_too_large_for_the_grid_are_refused_before_the_duty_begins(scene: Scene) -> None:
    wide = replace(REFERENCE, radius_x=0.1, radius_y=0.1)
    with pytest.raises(SceneError, match=r"radius_x = 0\.1 m .* too large for film\.domain = 0\.0005 m\. Use at most"):
        Duty((0.0, 1.0), (REFERENCE, wide)).sized(scene)
    with pytest.raises(SceneError, match=r"operation\.steps\[0\]: .*radius_x = 0\.1 m"):
        with_steps([{"time": "60 s", "radius_x": "100 mm", "radius_y": "100 mm"}])
    assert Duty((0.0,), (wide,)).sized(scene.at_level("regression")).film.name == "regression"


def test_a_scenes_file_is_looked_for_in_the_folder_given(tmp_path: Path) -> None:
    write(tmp_path, "time [s],load [N]\n0,12\n")
    scene = Scene.from_toml("mtm_zddp", {"operation.file": "duty.csv"})
    assert Duty.of_scene(scene, tmp_path).points[0].load == 12.0


def test_the_scene_is_sized_for_the_largest_load_of_the_duty(scene: Scene) -> None:
    heavy = Duty((0.0, 1.0), (REFERENCE, OperatingPoint(60.0, 0.1, 0.2, 350.0)))
    assert heavy.sized(scene).largest_load == 60.0
    assert Duty.from_steps(REFERENCE).sized(scene) is scene


def test_a_duty_too_heavy_for_the_grid_is_refused_by_the_scenes_rule(scene: Scene) -> None:
    with pytest.raises(SceneError, match=r"film\.domain = 0\.0005 m is too small: at 400 N"):
        Duty.from_steps(OperatingPoint(400.0, 0.1, 0.2, 350.0)).sized(scene)


STEPS = [{"time": "60 s", "load": "30 N"}, {"time": "2 min", "speed_1": "-0.1 m/s", "temperature": "84 degC"}]


def with_steps(steps: list[dict[str, str]], **operation: str) -> Scene:
    table = read_table("mtm_zddp")
    table["operation"] |= {"steps": steps} | operation
    return Scene.from_dict(table)


def test_steps_of_a_scene_change_what_they_name() -> None:
    scene = with_steps(STEPS)
    duty = Duty.of_scene(scene)
    first = scene.operation.point
    assert duty.times == (0.0, 60.0, 120.0)
    assert duty.points == (first, replace(first, load=30.0), replace(first, speed_1=-0.1, temperature=357.15))
    assert Scene.from_dict(scene.to_dict()) == scene


def test_a_step_with_a_larger_load_sizes_the_grid() -> None:
    assert with_steps([{"time": "1 s", "load": "60 N"}]).largest_load == 60.0
    with pytest.raises(SceneError, match=r"film\.domain = 0\.0005 m is too small: at 600 N"):
        with_steps([{"time": "1 s", "load": "600 N"}])


@pytest.mark.parametrize(
    ("steps", "sentence"),
    [
        ([{"time": "1 s", "laod": "3 N"}], r"\[operation.steps\[0\]\] has no key 'laod'. Did you mean 'load'"),
        ([{"load": "3 N"}], "'operation.steps\\[0\\].time' is missing"),
        ([{"time": "1 s", "load": "-3 N"}], "operation.steps\\[0\\].load = -3 N .* must be at least 0"),
        ([{"time": "2 s"}, {"time": "1 s"}], "must be above 0 and increase"),
        ([{"time": "0 s"}], "must be above 0 and increase"),
    ],
)
def test_a_wrong_step_is_refused_by_name(steps: list[dict[str, str]], sentence: str) -> None:
    with pytest.raises(SceneError, match=sentence):
        with_steps(steps)


def test_steps_and_a_file_exclude_each_other() -> None:
    with pytest.raises(SceneError, match=r"operation\.steps and operation\.file = .duty\.csv. exclude each other"):
        with_steps(STEPS, file="duty.csv")
