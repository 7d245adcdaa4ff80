from pathlib import Path

import numpy as np
import pytest
from comparison import approx

import contact_core
from contact_core import Scene, shipped_scenes
from contact_core.laws.tribofilm import NoTribofilm

WHITE = [f"surface_{i} has 1.00 nodes per correlation length; 2 or more resolve it." for i in (1, 2)]
WARNED = {"azam_case_a_thesis": WHITE, "mtm_zddp_thesis": WHITE}  # white on the grid, as the thesis is read


@pytest.mark.parametrize("name", shipped_scenes())
def test_a_shipped_scene_has_no_error_and_no_warning_but_of_white_roughness(name):
    scene = Scene.from_toml(name)
    assert scene.name == name
    assert scene.description == shipped_scenes()[name]
    assert scene.warnings() == WARNED.get(name, [])
    scene.operation.point.check()


@pytest.mark.parametrize("name", shipped_scenes())
def test_a_shipped_scene_runs_without_additive(name):
    scene = Scene.from_toml(name, {"tribofilm.model": "none"})
    assert scene.tribofilm == NoTribofilm()
    assert scene.digest() == Scene.from_toml(name).digest()


@pytest.mark.parametrize("name", shipped_scenes())
@pytest.mark.parametrize("overrides", [{}, {"tribofilm.model": "none", "wear.model": "none", "heat.model": "none"}])
def test_a_scene_survives_its_own_tables_bit_for_bit(name, overrides):
    scene = Scene.from_toml(name, overrides)
    assert Scene.from_dict(scene.to_dict()) == scene


def test_the_dimple_is_that_of_its_source():
    """Mourier et al., Tribol. Int. 39 (2006) 1745: r0 = 15.5 um, 175 nm, in nodes 1 um apart."""
    heights = Scene.from_toml("dimple_rolling").surface_2.heights
    at = 1e-6 * (np.arange(40) - 19.5)
    r = np.hypot(at[:, None], at[None, :]) / (1.2 * 15.5e-6)
    exact = np.where(r < 1.0, -175e-9 * np.cos(0.5 * np.pi * r) * np.exp(-2.0 * r**2), 0.0)
    assert heights.spacing == 1e-6
    assert np.abs(heights.values - exact).max() <= 0.0051e-9


def test_a_scene_file_and_the_shipped_name_give_the_same_scene(tmp_path: Path):
    shipped = Path(contact_core.__file__).parent / "data" / "scenes" / "mtm_zddp.toml"
    path = tmp_path / "mine.toml"
    path.write_bytes(shipped.read_bytes())
    assert Scene.from_toml(path) == Scene.from_toml("mtm_zddp")


@pytest.mark.parametrize(
    ("name", "pressure", "half_width", "tracks"),
    [
        ("azam_case_a", 1.26e9, 171.75e-6, (62.832e-3, 245.04e-3)),
        ("azam_case_a_thesis", 1.26e9, 171.75e-6, (62.832e-3, 245.04e-3)),
        ("mtm_zddp", 1.15e9, 149.3e-6, (59.847e-3, 144.51e-3)),
    ],
)
def test_a_shipped_contact_has_the_pressure_and_size_of_its_source(name, pressure, half_width, tracks):
    scene = Scene.from_toml(name)
    hertz = scene.hertz(scene.operation.load)
    assert hertz.pressure_max == approx(pressure, rel=1e-4)
    assert hertz.a == hertz.b == approx(half_width, rel=2e-4, abs=0.0)
    assert (scene.geometry.track_length_1, scene.geometry.track_length_2) == approx(tracks, rel=1e-12, abs=0.0)


@pytest.mark.parametrize(
    ("name", "entrainment", "slide_to_roll"), [("azam_case_a", 0.25, -0.02), ("mtm_zddp", 0.1, 0.05)]
)
def test_a_shipped_duty_has_the_speeds_of_its_source(name, entrainment, slide_to_roll):
    point = Scene.from_toml(name).operation.point
    assert point.entrainment_speed == approx(entrainment, rel=1e-12)
    assert point.sliding_speed / point.entrainment_speed == approx(slide_to_roll, rel=1e-12)


def test_the_gear_flank_is_point_d_of_its_gear():
    """FZG type C: base radii 33.829 and 50.743 mm, 34.925 mm of line of action, 2170 rpm of the pinion, 135.3 Nm."""
    scene, s, length = Scene.from_toml("fzg_flank"), 17.767e-3, 34.925e-3
    spin_1 = 2170.0 * 2.0 * np.pi / 60.0
    spin_2 = spin_1 * 16.0 / 24.0
    point, geometry = scene.operation.point, scene.geometry
    assert geometry.radius_x == approx(s * (length - s) / length, rel=1e-3)
    assert (point.speed_1, point.speed_2) == approx((spin_1 * s, spin_2 * (length - s)), rel=1e-3)
    assert point.load == approx(135.3 / 33.829e-3, rel=1e-3)
    ways = (point.speed_1 * 2.0 * np.pi / spin_1, point.speed_2 * 2.0 * np.pi / spin_2)
    assert (geometry.track_length_1, geometry.track_length_2) == approx(ways, rel=1e-3)
    assert scene.hertz(point.load).pressure_max == approx(1.1e9, rel=0.01)


def test_the_bearing_ball_is_that_of_its_bearing():
    """209: ball 12.7 mm, pitch circle 65 mm, conformity 0.52, 9 balls; pure rolling but for the slip, 3000 rpm."""
    scene, ball, pitch, speed = Scene.from_toml("ball_209_inner"), 12.7e-3, 65e-3, 3000.0 * 2.0 * np.pi / 60.0
    point, geometry, ratio = scene.operation.point, scene.geometry, ball / pitch
    assert geometry.radius_x == approx(0.5 * ball * (1.0 - ratio), rel=1e-3)
    assert geometry.radius_y == approx(1.0 / (2.0 / ball - 1.0 / (0.52 * ball)), rel=1e-3)
    assert point.entrainment_speed == approx(0.25 * pitch * (1.0 - ratio**2) * speed, rel=1e-3)
    assert point.sliding_speed / point.entrainment_speed == approx(0.01, rel=0.03)
    assert geometry.track_length_1 == approx(np.pi * ball, rel=1e-3)
    assert geometry.track_length_2 == approx(np.pi * (pitch - ball) / 9.0, rel=1e-3)
    hertz = scene.hertz(4526.6)  # the most loaded ball under 8.9 kN
    assert (hertz.b, hertz.a, hertz.pressure_max) == approx((2.548e-3, 0.2744e-3, 3.091e9), rel=0.01)
