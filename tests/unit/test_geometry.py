"""Shapes of a contact in a scene: what is read, refused and derived; and what a face width stands for."""

from dataclasses import asdict, replace

import numpy as np
import pytest
from comparison import approx

from contact_core import ContactState, OperatingPointError, Scene, SceneError, advance, initial_state, solve
from contact_core.scene import tunables, with_values
from contact_core.shapes import LineGeometry, PointGeometry, RollerGeometry

LINE = {
    "film.points": "33",
    "film.width": "0.2 mm",
    "surface_1.correlation_length": "50 um",
    "surface_2.correlation_length": "50 um",
    "film.tolerance": "1e-2",
    "control.mixed_instants": "2",
}
ELLIPSE = {"geometry.radius_y": "30 mm", "film.width": "1 mm"}
ROLLER = {
    "geometry.model": "roller",
    "geometry.face_width": "2 mm",
    "geometry.profile.model": "logarithmic",
    "geometry.profile.depth": "1 um",
    "film.width": "0 m",
    "operation.load": "500 N",
}
ROUNDED = {name: value for name, value in ROLLER.items() if not name.endswith("depth")} | {
    "geometry.profile.model": "rounded",
    "geometry.profile.straight": "1 mm",
    "geometry.profile.radius": "1 m",
}
SHAPES = {
    "point": ("mtm_zddp", {}),
    "ellipse": ("mtm_zddp", ELLIPSE),
    "line": ("fzg_flank", {}),
    "roller": ("fzg_flank", ROLLER),
    "rounded": ("fzg_flank", ROUNDED),
}
IN_NEWTONS = (
    "friction_force", "friction_solid", "friction_fluid", "rolling_resistance", "power_loss", "heat_flow_1",
    "heat_flow_2", "wear_volume_1", "wear_volume_2", "wear_rate_1", "dfriction_dspeed_1", "dfriction_dtemperature",
)  # fmt: skip
THE_SAME = (
    "friction_coefficient", "h_c", "h_central", "h_min", "lambda_ratio", "contact_area_ratio", "contact_load_ratio",
    "pressure_max", "tribofilm_1", "tribofilm_2", "wear_depth_1", "wear_depth_2", "roughness_1", "coverage_1",
    "flash_temperature_rise", "load_cycles_1", "dfriction_dload", "error_friction", "suggested_step",
)  # fmt: skip


def refusal(name: str, **overrides: str) -> str:
    """The sentence with which a shipped scene is refused after some of its keys (__ for a dot) were changed."""
    with pytest.raises(SceneError) as error:
        Scene.from_toml(name, {key.replace("__", "."): value for key, value in overrides.items()})
    return str(error.value)


# reading


@pytest.mark.parametrize("shape", SHAPES)
def test_every_geometry_survives_its_own_tables_bit_for_bit(shape):
    name, changes = SHAPES[shape]
    scene = Scene.from_toml(name, changes)
    again = Scene.from_dict(scene.to_dict())
    assert again == scene
    assert again.digest() == scene.digest()


def test_a_geometry_without_a_model_is_a_point():
    assert isinstance(Scene.from_toml("mtm_zddp").geometry, PointGeometry)
    assert isinstance(Scene.from_toml("fzg_flank").geometry, LineGeometry)
    assert isinstance(Scene.from_toml("fzg_flank", ROLLER).geometry, RollerGeometry)


def test_states_of_different_shapes_cannot_be_mixed_up():
    scenes = [Scene.from_toml(name, changes) for name, changes in SHAPES.values()]
    scenes += [Scene.from_toml("fzg_flank", {"film.width": "0.3 mm"})]
    scenes += [Scene.from_toml("fzg_flank", ROLLER | {"geometry.profile.depth": "2 um"})]
    assert len({scene.digest() for scene in scenes}) == len(scenes)


def test_a_missing_face_width_is_named_with_its_meaning():
    sentence = refusal("mtm_zddp", geometry__model="line")
    assert "'geometry.face_width' is missing. Give it [m]: length of the line that carries the load." in sentence


def test_a_roller_without_a_profile_is_told_the_choices():
    sentence = refusal("mtm_zddp", geometry__model="roller", geometry__face_width="2 mm")
    assert "'geometry.profile' is missing. Add the table, with a 'model': rounded, logarithmic, measured." in sentence


def test_an_unknown_geometry_or_profile_is_refused_with_the_one_that_was_meant():
    assert "[geometry] has no model 'lines'. Did you mean 'line'?" in refusal("fzg_flank", geometry__model="lines")
    profile = {key.replace(".", "__"): value for key, value in ROLLER.items()} | {
        "geometry__profile__model": "logaritmic"
    }
    assert "[geometry.profile] has no model 'logaritmic'. Did you mean 'logarithmic'?" in refusal(
        "fzg_flank", **profile
    )


def test_a_key_of_another_geometry_is_told_whose_it_is():
    sentence = refusal("fzg_flank", geometry__radius_y="10 mm")
    assert "[geometry] has no key 'radius_y'. It belongs to model = 'point'" in sentence
    assert ", not to 'line'." in sentence
    sentence = refusal("mtm_zddp", geometry__face_width="10 mm")
    assert "[geometry] has no key 'face_width'. It belongs to model = 'line' or 'roller'" in sentence
    assert ", not to 'point'." in sentence


# what a shape does not have


def test_a_line_has_neither_a_second_radius_nor_spin():
    scene = Scene.from_toml("fzg_flank", LINE).at_level("regression")
    state, point = initial_state(scene), scene.operation.point
    with pytest.raises(OperatingPointError, match=r"radius_y = 0.01 m: geometry.model = 'line' has none. Leave it out"):
        advance(scene, replace(point, radius_y=0.01), state, 1.0)
    with pytest.raises(OperatingPointError, match=r"spin = 3 rad/s must be 0 .* Use geometry.model = 'roller'"):
        advance(scene, replace(point, spin=3.0), state, 1.0)
    assert "operation: spin = 1 rad/s must be 0" in refusal("fzg_flank", operation__spin="1 rad/s")


def test_a_roller_has_spin_but_no_second_radius():
    scene = Scene.from_toml("fzg_flank", ROLLER).at_level("regression")
    state, point = initial_state(scene), scene.operation.point
    _, spun = advance(scene, replace(point, spin=100.0), state, 1.0)
    assert spun.spin_torque < 0.0
    with pytest.raises(OperatingPointError, match=r"radius_y = 0.01 m: geometry.model = 'roller' has none"):
        advance(scene, replace(point, radius_y=0.01), state, 1.0)


def test_a_face_width_is_a_number_to_change_unless_it_decides_the_grid():
    line, roller = Scene.from_toml("fzg_flank"), Scene.from_toml("fzg_flank", ROLLER)
    assert "geometry.face_width" in tunables(line)
    assert "geometry.face_width" not in tunables(roller)
    assert "geometry.profile.depth" in tunables(roller)
    assert with_values(line, {"geometry.face_width": 0.02}).repeats == approx(line.repeats * 20.0 / 14.0)


# the grid


@pytest.mark.parametrize("width", ["0.2 mm", "0.33 mm", "0.7 mm"])
def test_the_rows_of_a_line_are_even_and_make_up_its_face(width):
    scene = Scene.from_toml("fzg_flank", {"film.width": width})
    period = scene.rows * scene.film.spacing
    assert scene.rows % 2 == 0
    assert period == approx(float(width.split()[0]) * 1e-3, rel=0.05)
    assert scene.repeats * period == approx(14e-3, rel=1e-12)


def test_a_smooth_line_is_one_row():
    smooth = {"surface_1.rq": "0 m", "surface_2.rq": "0 m", "film.width": "0 m"}
    assert Scene.from_toml("fzg_flank", smooth).rows == 1
    assert Scene.from_toml("fzg_flank", smooth | {"surface_2.rq": "0.1 um"}).rows == 128  # as deep as long


def test_the_grid_of_a_roller_holds_its_ends_and_one_that_does_not_is_refused():
    scene = Scene.from_toml("fzg_flank", ROLLER)
    assert (scene.rows - 1) * scene.film.spacing >= 1.02 * 2e-3
    assert scene.repeats == 1.0
    changes = {key.replace(".", "__"): value for key, value in ROLLER.items()} | {"film__width": "1.5 mm"}
    assert "film.width = 0.0015 m is too small: the ends of geometry.face_width = 0.002 m" in refusal(
        "fzg_flank", **changes
    )


def test_a_square_grid_has_as_much_room_across_as_along():
    along, across = Scene.from_toml("mtm_zddp").room
    assert across == approx(along, rel=1e-12)


def test_an_ellipse_that_a_square_grid_cannot_hold_asks_for_a_width():
    changes = {"geometry__radius_y": "100 mm", "operation__load": "150 N"}
    assert "is too small" in refusal("mtm_zddp", **changes, film__width="0.6 mm")
    fits = Scene.from_toml("mtm_zddp", {"geometry.radius_y": "100 mm", "operation.load": "150 N", "film.width": "3 mm"})
    assert fits.rows == 769


# what a face width stands for


def rubbed(scene: Scene, steps=(20.0,)) -> tuple[ContactState, dict[str, float]]:
    """The contact after some steps."""
    state, outputs = advance(scene, scene.operation.point, initial_state(scene), 0.0)
    for dt in steps:
        state, outputs = advance(scene, scene.operation.point, state, dt)
    return state, asdict(outputs)


@pytest.fixture(scope="module", params=["deterministic", "regression"])
def line(request) -> Scene:
    return Scene.from_toml("fzg_flank", LINE).at_level(request.param)


def doubled(scene: Scene) -> Scene:
    """The same load on every millimetre of twice the face."""
    table = scene.to_dict()
    wider, heavier = ({"face_width": "28 mm"}, {"load": "8000 N"})
    return Scene.from_dict(table | {"geometry": table["geometry"] | wider, "operation": table["operation"] | heavier})


def test_a_face_twice_as_wide_under_twice_the_load_is_two_of_them(line):
    found, double = rubbed(line)[1], rubbed(doubled(line))[1]
    for name in IN_NEWTONS:
        assert double[name] == approx(2.0 * found[name], rel=1e-7), name
    for name in THE_SAME:
        assert double[name] == approx(found[name], rel=1e-9), name
    assert found["friction_force"] != 0.0
    assert found["wear_volume_1"] > 0.0


@pytest.mark.parametrize("heat", ["flash", "field"])
def test_the_fields_of_a_line_do_not_know_how_long_its_face_is(heat):
    film = {"surface_1.rq": "20 nm", "surface_2.rq": "20 nm", "film.tolerance": "1e-5", "heat.model": heat}
    line = Scene.from_toml("fzg_flank", LINE | film)
    found, double = (solve(scene, scene.operation.point, initial_state(scene)) for scene in (line, doubled(line)))
    assert found.converged
    assert double.pressure == approx(found.pressure, rel=1e-9, abs=1e-9 * found.pressure.max())
    assert double.gap == approx(found.gap, rel=1e-9)
    assert double.friction.power == approx(2.0 * found.friction.power, rel=1e-9)
    assert double.friction.force_fluid == approx(2.0 * found.friction.force_fluid, rel=1e-9)
    warm = [part.temperatures.into_1 * repeats for part, repeats in ((found, line.repeats), (double, 2 * line.repeats))]
    assert warm[1] == approx(2.0 * warm[0], rel=1e-3)


def test_a_state_of_a_line_goes_on_bit_for_bit(line):
    state, _ = rubbed(line)
    restored = ContactState.from_bytes(state.to_bytes(), line)
    assert restored.to_bytes() == state.to_bytes()
    steps = [advance(line, line.operation.point, start, 20.0) for start in (state, restored)]
    assert steps[0][0].to_bytes() == steps[1][0].to_bytes()
    assert steps[0][1] == steps[1][1]


def test_a_line_of_one_row_is_solved_with_a_field_of_temperature():
    """The field of temperature warms the oil of a gear flank; without sliding it does not."""
    smooth = {"surface_1.rq": "0 m", "surface_2.rq": "0 m", "film.width": "0 m", "tribofilm.model": "none"}
    cold = Scene.from_toml("fzg_flank", smooth | {"film.points": "65", "heat.model": "none"})
    warm = Scene.from_toml("fzg_flank", smooth | {"film.points": "65", "heat.model": "field"})
    hot, still = rubbed(warm, ())[1], rubbed(cold, ())[1]
    assert 0.3 * still["friction_coefficient"] < hot["friction_coefficient"] < 0.98 * still["friction_coefficient"]
    assert hot["heat_flow_1"] + hot["heat_flow_2"] == approx(hot["power_loss"], rel=1e-9)
    assert hot["heat_flow_1"] > hot["heat_flow_2"] > 0.0  # the faster body takes up more
    assert np.isfinite(list(map(float, hot.values()))).all()
