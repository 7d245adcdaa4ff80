"""Pages of the documentation, by name, and those that errors name."""

import fnmatch
import re
import tomllib
from pathlib import Path

import pytest

from contact_core.errors import ContactError, ConvergenceError, SceneError
from system_models.cli import pages
from system_models.cli.main import main
from system_models.cli.pages import NAMED, page_of

ROOT = Path(__file__).parents[2]


def test_pages_that_errors_name_are_there() -> None:
    assert NAMED - set(pages.files()) == set()


def test_every_page_but_the_index_has_a_name_and_a_title_in_the_list(capsys: pytest.CaptureFixture[str]) -> None:
    place = next(place for place in pages._PLACES if (place / "index.md").is_file())
    found = {str(file.relative_to(place)) for file in pages.files().values()}
    assert found == {str(file.relative_to(ROOT / "docs")) for file in (ROOT / "docs").rglob("*.md")} - {"index.md"}
    assert main(["docs"]) == 0
    out = capsys.readouterr().out
    assert re.search(r"^  scenes +A scene of your own$", out, re.MULTILINE)
    assert re.search(r"^  measured/film +One contact at one instant", out, re.MULTILINE)


@pytest.mark.parametrize("name", ["scenes", "how-to/scenes", "docs/how-to/scenes.md"])
def test_a_page_is_shown_by_its_name_or_path(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["docs", name]) == 0
    assert capsys.readouterr().out.rstrip() == (ROOT / "docs/how-to/scenes.md").read_text("utf-8").rstrip()


def test_a_page_that_is_not_there_is_refused_with_one_like_it(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["docs", "scene"]) == 2
    said = "tribofmu: There is no page 'scene'. Did you mean 'scenes'? `tribofmu docs` lists them.\n"
    assert capsys.readouterr().err == said


def test_an_installed_package_finds_its_own_pages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    places = tmp_path / "system_models" / "docs", tmp_path / "docs"
    monkeypatch.setattr(pages, "_PLACES", places)
    places[0].mkdir(parents=True)
    for name in ("index", "how-to/scenes"):
        copied = places[0] / f"{name}.md"
        copied.parent.mkdir(exist_ok=True)
        copied.write_text((ROOT / "docs" / f"{name}.md").read_text("utf-8"), "utf-8")
    assert pages.files()["scenes"] == places[0] / "how-to" / "scenes.md"


def test_a_wheel_carries_the_text_of_all_pages() -> None:
    """Its rules in pyproject.toml: pages where an installed package looks for them, pictures left out."""
    wheel = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["hatch"]["build"]["targets"]["wheel"]
    assert {"docs", "system_models"} <= set(wheel["only-include"])
    assert wheel["sources"] == {"docs": str(pages._PLACES[0].relative_to(pages._PACKAGE.parent))}
    written = [str(file.relative_to(ROOT)) for file in (ROOT / "docs").rglob("*.md")]
    assert not any(fnmatch.fnmatch(file, rule) for file in written for rule in wheel["exclude"])


@pytest.mark.parametrize(
    ("error", "command", "page"),
    [
        (SceneError("surface_1.correlation_length = 1 m is"), "run", "surfaces"),
        (SceneError("operation.load has no unit."), "run", "scenes"),
        (ConvergenceError("No solution was found."), "run", "numerics"),
        (ContactError("The FMU has no load."), "cosim", "cosim"),
        (SceneError("There is no FMU of FMI 3.0 with flavour = 'embedded'."), "build", "fmu"),
        (ContactError("The folder cannot be made."), "list", "run"),
    ],
)
def test_an_error_names_the_page_of_what_it_is_about(error: ContactError, command: str, page: str) -> None:
    assert page_of(error, command) == page


def test_a_refused_command_ends_with_its_page(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "mtm_zddp", "--set", "surface_1.rq=3"]) == 2
    assert capsys.readouterr().err.endswith("See: tribofmu docs surfaces\n")
