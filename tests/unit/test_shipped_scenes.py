from pathlib import Path

import pytest

import contact_core
from contact_core import Scene, shipped_scenes
from contact_core.laws.tribofilm import NoTribofilm


@pytest.mark.parametrize("name", shipped_scenes())
def test_a_shipped_scene_has_no_error_and_no_warning(name):
    scene = Scene.from_toml(name)
    assert scene.name == name
    assert scene.description == shipped_scenes()[name]
    assert scene.warnings() == []
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


def test_a_scene_file_and_the_shipped_name_give_the_same_scene(tmp_path: Path):
    shipped = Path(contact_core.__file__).parent / "data" / "scenes" / "mtm_zddp.toml"
    path = tmp_path / "mine.toml"
    path.write_bytes(shipped.read_bytes())
    assert Scene.from_toml(path) == Scene.from_toml("mtm_zddp")


@pytest.mark.parametrize(
    ("name", "pressure", "half_width", "tracks"),
    [
        ("azam_case_a", 1.26e9, 171.75e-6, (62.832e-3, 245.04e-3)),
        ("mtm_zddp", 1.15e9, 149.3e-6, (59.847e-3, 144.51e-3)),
    ],
)
def test_a_shipped_contact_has_the_pressure_and_size_of_its_source(name, pressure, half_width, tracks):
    scene = Scene.from_toml(name)
    hertz = scene.hertz(scene.operation.load)
    assert hertz.pressure_max == pytest.approx(pressure, rel=1e-4)
    assert hertz.a == hertz.b == pytest.approx(half_width, rel=2e-4, abs=0.0)
    assert (scene.geometry.track_length_1, scene.geometry.track_length_2) == pytest.approx(tracks, rel=1e-12, abs=0.0)


@pytest.mark.parametrize(
    ("name", "entrainment", "slide_to_roll"), [("azam_case_a", 0.25, -0.02), ("mtm_zddp", 0.1, 0.05)]
)
def test_a_shipped_duty_has_the_speeds_of_its_source(name, entrainment, slide_to_roll):
    point = Scene.from_toml(name).operation.point
    assert point.entrainment_speed == pytest.approx(entrainment, rel=1e-12)
    assert point.sliding_speed / point.entrainment_speed == pytest.approx(slide_to_roll, rel=1e-12)
