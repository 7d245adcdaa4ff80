"""Several surfaces in a scene: which members they make, and what takes one contact only."""

from pathlib import Path

import numpy as np
import pytest
from comparison import approx

from contact_core import Scene, SceneError
from contact_core.scene.ensemble import members
from contact_core.scene.toml import given

SET = """[{name}.surface_2]
model = "gaussian"
rq = "{rq} nm"
correlation_length = "8 um"
seed = 1
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of sets and a scene, which is not the working folder; that has another set of the same name."""
    (tmp_path / "scenes").mkdir()
    (tmp_path / "work").mkdir()
    for place, name, rq in (("scenes", "one", 50), ("scenes", "two", 60), ("work", "one", 70)):
        (tmp_path / place / f"{name}.toml").write_text(SET.format(name=name, rq=rq))
    shipped = (Path(__file__).parents[2] / "contact_core/data/scenes/mtm_zddp.toml").read_text("utf-8")
    begin, end = shipped.index("[surface_2]"), shipped.index("[lubricant]")
    surface = '[surface_2]\nfiles = ["one.toml", "two.toml:two"]\nseed = 9\n\n'
    (tmp_path / "scenes" / "own.toml").write_text(f"{shipped[:begin]}{surface}{shipped[end:]}", "utf-8")
    monkeypatch.chdir(tmp_path / "work")
    return tmp_path / "scenes"


def test_each_file_of_a_list_is_a_scene_whose_own_keys_win(folder: Path) -> None:
    found = members(given(folder / "own.toml", {})[0])
    assert found is not None and found.names == ("one.toml", "two.toml:two")
    scenes = [Scene.from_toml(folder / "own.toml", dict(settings)) for settings in found.settings]
    assert [scene.surface_2.rq for scene in scenes] == approx([50e-9, 60e-9], rel=1e-12)  # not 70: beside the scene
    assert {scene.surface_2.seed for scene in scenes} == {9}


def test_one_file_is_a_surface_and_one_of_an_option_replaces_the_scenes(folder: Path) -> None:
    text = (folder / "own.toml").read_text("utf-8").replace('files = ["one.toml", "two.toml:two"]', 'file = "two.toml"')
    (folder / "single.toml").write_text(text, "utf-8")
    assert Scene.from_toml(folder / "single.toml").surface_2.rq == approx(60e-9, rel=1e-12)
    scene = Scene.from_toml("mtm_zddp", {"surface_2.file": "one.toml"})
    assert (scene.surface_2.rq, scene.surface_2.microroughness) == (approx(70e-9, rel=1e-12), None)


def test_files_of_heights_keep_the_spacing_that_stands_beside_them(folder: Path) -> None:
    wave = 40.0 * np.cos(2.0 * np.pi * np.arange(64) / 16.0)
    np.save("wave.npy", np.tile(wave, (64, 1)))
    settings = {"surface_2.files": "wave.npy,other.npy", "surface_2.heights.spacing": "1 um"}
    settings |= {"surface_2.heights.unit": "nm", "surface_2.rq": "0 nm"}
    found = members(given("mtm_zddp", settings)[0])
    assert found is not None
    scene = Scene.from_toml("mtm_zddp", settings | dict(found.settings[0]))
    assert scene.surface_2.rms == approx(40e-9 / np.sqrt(2.0), rel=1e-9)
    assert scene.surface_2.seed == 2  # of the shipped scene: only a set replaces all


def test_lists_of_both_bodies_are_paired() -> None:
    found = members({"surface_1": {"seeds": [1, 2]}, "surface_2": {"files": ["a.npy", "b.npy"]}})
    assert found is not None
    assert found.settings[1] == (("surface_1.seed", "2"), ("surface_2.file", "b.npy"))
    assert members({"surface_1": {"seed": 1}, "surface_2": {"file": "a.npy"}}) is None


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ({"surface_1": {"seeds": [1, 2]}, "surface_2": {"seeds": [1, 2, 3]}}, "surface_1.seeds has 2 and"),
        ({"surface_2": {"files": ["a.toml"]}}, "two or more"),
        ({"surface_2": {"files": 3}}, "two or more"),
        ({"surface_2": {"files": ["a.toml", 3]}}, "two or more"),
        ({"surface_2": {"seeds": [1, 1]}}, "is there twice"),
    ],
)  # fmt: skip
def test_lists_that_make_no_members_are_refused(table: dict[str, dict[str, object]], said: str) -> None:
    with pytest.raises(SceneError, match=said):
        members(table)


def test_one_contact_is_no_ensemble_and_the_way_out_works(folder: Path) -> None:
    with pytest.raises(SceneError, match=r"ensemble of 2 surfaces.*--set surface_2.file=one.toml"):
        Scene.from_toml(folder / "own.toml")
    with pytest.raises(SceneError, match=r"--set surface_2.seed=4"):
        Scene.from_toml("mtm_zddp", {"surface_2.seeds": "4,5"})
    scene = Scene.from_toml("mtm_zddp", {"surface_2.seeds": "4,5", "surface_2.seed": "5"})
    assert scene.surface_2.seed == 5
    assert Scene.from_toml(folder / "own.toml", {"surface_2.set": "one.toml:one"}).surface_2.seed == 1
