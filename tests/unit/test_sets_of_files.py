"""Named sets of constants from a file beside a scene."""

from pathlib import Path

import pytest
from comparison import approx

from contact_core import Scene, SceneError

SETS = """
[Mine]
source = "a test"
[Mine.tribofilm]
model = "ghanbarzadeh"
full_thickness = "111 nm"
rate_factor = 2e-16
removal_thickness = "10 nm"
removal_rate = "1e-4 s^-1"
fit_temperature = "80 degC"
[Mine.wear]
model = "archard"
bare = 3e-5
film = 2e-6
[other]
source = "without a table of tribofilms"
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a scene and a file of sets; the working folder is another one."""
    (tmp_path / "scenes").mkdir()
    (tmp_path / "work").mkdir()
    shipped = (Path(__file__).parents[2] / "contact_core/data/scenes/mtm_zddp.toml").read_text("utf-8")
    text = shipped.replace('set = "zddp_80c"', 'set = "sets/fitted.toml:mine"')
    assert text != shipped
    (tmp_path / "scenes" / "own.toml").write_text(text, encoding="utf-8")
    (tmp_path / "scenes" / "sets").mkdir()
    (tmp_path / "scenes" / "sets" / "fitted.toml").write_text(SETS, encoding="utf-8")
    monkeypatch.chdir(tmp_path / "work")
    return tmp_path


def test_a_set_comes_from_a_file_beside_the_scene(folder: Path) -> None:
    assert Scene.from_toml(folder / "scenes" / "own.toml").tribofilm.full_thickness == approx(111e-9)
    assert Scene.from_toml("../scenes/own.toml").tribofilm.full_thickness == approx(111e-9)


def test_an_override_names_a_file_from_the_working_folder_and_any_table_may_have_a_set(folder: Path) -> None:
    (folder / "work" / "fitted.toml").write_text(SETS, encoding="utf-8")
    changes = {"tribofilm.set": "fitted.toml:MINE", "wear.set": "fitted.toml:Mine", "wear.film": "5e-6"}
    scene = Scene.from_toml("mtm_zddp", changes)
    assert scene.tribofilm.full_thickness == approx(111e-9)
    assert (scene.wear.bare, scene.wear.film) == (3e-5, 5e-6)
    other = Scene.from_toml(folder / "scenes" / "own.toml", {"tribofilm.set": "zddp_80c"})
    assert other.tribofilm.full_thickness == approx(200e-9)


def test_a_model_chosen_beside_a_set_of_a_file_keeps_what_both_have(folder: Path) -> None:
    changes = {"tribofilm.model": "none"}
    assert Scene.from_toml(folder / "scenes" / "own.toml", changes).tribofilm.name == "none"


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("absent.toml:mine", "The file of sets 'absent.toml' is not in "),
        ("fitted.toml", "names a file alone. Write 'fitted.toml:NAME'"),
        ("fitted.toml:min", "[tribofilm] has no set 'min' in '"),
        ("fitted.toml:min", "Did you mean 'mine'? Known are mine."),
        ("fitted.toml:other", "Known are mine."),
        ("empty.toml:mine", "There is no [NAME.tribofilm] in that file."),
        ("broken.toml:mine", "is not valid TOML"),
    ],
)
def test_what_is_wrong_with_a_set_of_a_file_is_said(folder: Path, value: str, said: str) -> None:
    for name, text in (("fitted", SETS), ("empty", ""), ("broken", "[")):
        (folder / "work" / f"{name}.toml").write_text(text, encoding="utf-8")
    with pytest.raises(SceneError) as refused:
        Scene.from_toml("mtm_zddp", {"tribofilm.set": value})
    assert said in str(refused.value)
