from dataclasses import replace
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
from comparison import approx

from contact_core import Scene, SceneError, shipped_scenes
from contact_core.scene import told
from contact_core.scene.hertz_grid import inlet

TWENTY_LINES = resources.files("system_models.cli").joinpath("new_scene.toml").read_text("utf-8")
LINE = {"geometry.model": "line", "geometry.face_width": "8 mm", "operation.load": "2 kN"}
SMOOTH = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm"}


@pytest.fixture
def ball(tmp_path: Path) -> Path:
    """The file of a ball on a flat, by what a drawing and a data sheet give."""
    path = tmp_path / "ball.toml"
    path.write_text(TWENTY_LINES)
    return path


def without(path: Path, *keys: str) -> Path:
    """The same file without the lines that give some keys."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith(tuple(f"{key} =" for key in keys))]
    path.write_text("\n".join(lines))
    return path


def keys_of(path: Path, **changes: str) -> dict[str, str]:
    return {each.key: each.value for each in Scene.read(path, changes)[1]}


@pytest.mark.parametrize("name", shipped_scenes())
def test_the_shipped_scenes_leave_nothing_to_defaults(name):
    assert Scene.read(name)[1] == ()


def test_a_drawing_and_a_data_sheet_are_a_scene_and_it_says_what_it_assumes(ball):
    assert sum(bool(line) and line[0] not in "#[" for line in TWENTY_LINES.splitlines()) <= 20
    scene, assumed = Scene.read(ball)
    assert (scene.name, scene.description) == ("ball", "ball: 50 N, 1.1 m/s, 0.9 m/s, 60 degC")
    assert {each.key for each in assumed if each.kind == "off"} == {"heat", "tribofilm", "wear"}
    assert scene.geometry.radius_y == scene.geometry.radius_x
    assert scene.doubts() == scene.warnings() == []
    line = told(assumed)
    assert "lubricant.rheology eyring, eyring_stress " in line and "MPa, limiting_coefficient 0.0" in line
    assert line.endswith("; off: heat, tribofilm, wear")
    assert told(()) == ""


@pytest.mark.parametrize(
    "changes",
    [{}, {"geometry.radius_y": "200 mm"}, {"operation.load": "1 kN", "geometry.radius_x": "100 mm"}],
    ids=["ball", "ellipse", "large"],
)
def test_what_is_assumed_may_be_written_into_the_scene_bit_for_bit(ball, changes):
    scene, assumed = Scene.read(ball, changes)
    laws = {"lubricant.density", "lubricant.rheology", "boundary_friction", "plasticity"}  # named as a whole
    values = {each.key: each.value for each in assumed if each.key not in laws}
    again, left = Scene.read(ball, changes | values)
    assert replace(again, intervals=()) == replace(scene, intervals=())  # what is given is not assumed any more
    assert {each.key for each in left} == laws


def test_the_page_of_scenes_lists_every_default(ball):
    page = (Path(__file__).parents[2] / "docs" / "how-to" / "scenes.md").read_text("utf-8")
    ellipse = keys_of(ball, **{"geometry.radius_y": "200 mm"})
    assert "film.width" in ellipse
    assert [key for key in keys_of(ball) | ellipse if f"`{key}`" not in page] == []


def test_all_that_is_missing_is_one_sentence(tmp_path):
    empty = tmp_path / "empty.toml"
    empty.touch()
    with pytest.raises(SceneError) as refusal:
        Scene.from_toml(empty)
    said = str(refusal.value)
    assert said.startswith("These 9 values are missing: geometry.radius_x [m] (combined radius of curvature along x")
    for named in (
        "solids.reduced_modulus [Pa] (E' = ",
        "or solids.set = one of steel)",
        "surface_1.rq [m] (rms roughness, or surface_1.finish, such as 'ground' or 'polished', or surface_1.set = ",
        "surface_2.rq [m]",
        "lubricant.viscosity (viscosity_40 [m2/s], viscosity_100 [m2/s] and density [kg/m3] at 15 degC of the data",
        "or lubricant.set = one of azam_oil, ",
        "operation.load [N]",
        "operation.speed_1 [m/s]",
        "operation.speed_2 [m/s]",
        "operation.temperature [K]",
        "`tribofmu new NAME` writes a scene",
    ):
        assert named in said


def test_wrong_values_unknown_keys_and_missing_ones_are_said_together(ball):
    without(ball, "rq")
    without(ball, "finish")
    with pytest.raises(SceneError) as refusal:
        Scene.from_toml(ball, {"operation.load": "50 m", "operation.sped_1": "1 m/s"})
    said = str(refusal.value)
    assert "[operation] has no key 'sped_1'. Did you mean 'speed_1'?" in said
    assert "operation.load = '50 m' has the wrong unit" in said
    assert "These 2 values are missing: surface_1.rq [m] (rms roughness, or surface_1.finish, " in said


@pytest.mark.parametrize(
    "law", [{"wear.model": "archard", "wear.bare": "1e-6", "wear.film": "1e-7"}, {"tribofilm.set": "zddp_80c"}]
)
def test_what_lasts_from_pass_to_pass_needs_tracks_and_a_duration(ball, law):
    with pytest.raises(
        SceneError, match=r"These 3 values are missing: geometry\.track_length_1 .* operation\.duration"
    ):
        Scene.from_toml(ball, law | {"operation.temperature": "80 degC"})


@pytest.mark.parametrize(("duration", "interval"), [("30 s", 30.0), ("2 h", 60.0)])
def test_rows_are_a_minute_apart_or_the_duration(ball, duration, interval):
    assert Scene.from_toml(ball, {"operation.duration": duration}).operation.interval == interval


def test_keys_of_a_law_that_a_table_leaves_out_are_those_of_the_default_law_alone(ball):
    scene = Scene.from_toml(ball, {"boundary_friction.bare": "0.2"})
    assert (scene.boundary_friction.bare, scene.boundary_friction.film) == (0.2, 0.115)
    with pytest.raises(
        SceneError, match=r"'lubricant\.rheology\.critical_stress' is missing|values are missing: .*rheol"
    ):
        Scene.from_toml(ball, {"lubricant.rheology.model": "carreau"})


def test_a_named_oil_keeps_all_that_its_set_gives(ball):
    before, after = TWENTY_LINES.split("[lubricant]")
    ball.write_text(f'{before}[lubricant]\nset = "pao100"\n{after[after.index("[operation]") :]}')
    scene, assumed = Scene.read(ball)
    assert scene.lubricant.rheology.limiting_coefficient == 0.041
    assert not any(each.key.startswith("lubricant") for each in assumed)


def test_a_file_of_heights_may_be_all_of_the_roughness(ball, tmp_path):
    np.save(tmp_path / "patch.npy", 1e-7 * np.random.default_rng(1).standard_normal((64, 64)))
    without(ball, "rq")
    files = {f"surface_{body}.heights.file": "patch.npy" for body in (1, 2)}
    spacings = {f"surface_{body}.heights.spacing": "8 um" for body in (1, 2)}
    units = {f"surface_{body}.heights.unit": "m" for body in (1, 2)}
    assert keys_of(ball, **files, **spacings, **units)["surface_2.rq"] == "0 nm"


@pytest.mark.parametrize(("rq", "length"), [("20 nm", 8e-6), ("1 um", 40e-6)])
def test_rougher_bodies_have_longer_waves(ball, rq, length):
    assert Scene.from_toml(ball, {"surface_1.rq": rq}).surface_1.correlation_length == approx(length)


@pytest.mark.parametrize("at", ["40 degC", "100 degC"])
def test_the_pressure_coefficient_of_a_data_sheet_is_that_of_its_temperature(ball, at):
    usual = Scene.from_toml(ball).lubricant.viscosity
    oil = Scene.from_toml(ball, {"lubricant.viscosity.reference_temperature": at}).lubricant.viscosity
    for temperature in (313.15, 373.15):
        assert oil(1e8, temperature) == approx(usual(1e8, temperature), rel=5e-3)


@pytest.mark.parametrize(
    ("changes", "inlets"),
    [
        ({}, 3.0),
        ({"operation.speed_1": "11 m/s", "operation.speed_2": "9 m/s"}, 3.0),
        ({"operation.speed_1": "11 m/s", "operation.speed_2": "9 m/s", **SMOOTH, **LINE}, 5.0),
        ({"geometry.radius_y": "200 mm", **SMOOTH}, 3.0),
    ],
)
def test_the_grid_holds_the_contact_and_its_inlet(ball, changes, inlets):
    scene = Scene.from_toml(ball, changes)
    hertz, film = scene.hertz(scene.operation.load), scene.film
    room = 0.5 * film.domain - hertz.a
    assert room >= 0.99 * inlets * inlet(scene, scene.operation.point)
    assert film.domain >= 2.87 * hertz.a
    across = film.width or film.domain
    assert across >= 2.87 * hertz.b or scene.shape().periodic
    assert scene.shape().periodic or (scene.rows - 1) * film.spacing == approx(across, rel=0.02)


def test_the_grid_shows_short_waves(ball):
    fine = Scene.from_toml(ball, {"surface_1.correlation_length": "5 um"})
    assert fine.surface_1.correlation_length / fine.film.spacing >= 1.95
    assert fine.film.points > 129


def test_a_grid_of_the_regression_level_stays_but_where_it_is_too_small(ball):
    level = {"film.model": "regression"}
    assert Scene.from_toml(ball, level).film.domain == 0.5e-3
    large = Scene.from_toml(ball, level | {"operation.load": "1 kN", "geometry.radius_x": "100 mm"})
    assert large.film.domain > 2.87 * large.hertz(1000.0).a > 0.5e-3


def test_an_assumed_correlation_length_is_no_shorter_than_a_large_contacts_grid_shows(ball):
    large = {"operation.load": "1 kN", "geometry.radius_x": "100 mm"}
    scene = Scene.from_toml(ball, large)
    assert scene.surface_1.correlation_length == approx(2.0 * scene.film.spacing, rel=1e-3)
    assert keys_of(ball, **large)["surface_1.correlation_length"] == f"{2e6 * scene.film.spacing:.4g} um"
    with pytest.raises(SceneError, match=r"surface_1\.correlation_length = 8e-06 m is .* nodes of the grid"):
        Scene.from_toml(ball, large | {"film.points": "65"})  # a grid that is given changes no surface


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("load = 50 N", 'Values with a unit stand in quotes, and decimals have a point: load = "50 N".'),
        ("load = 0,5", "decimals have a point"),
        ('load = "50 N";', "Leave out the ';'"),
        ("load", "The line is 'load'."),
    ],
)
def test_the_line_that_is_no_toml_is_shown_with_what_it_should_be(tmp_path, line, said):
    path = tmp_path / "own.toml"
    path.write_text(f"[operation]\n{line}\n")
    with pytest.raises(SceneError) as refusal:
        Scene.from_toml(path)
    assert said in str(refusal.value)
