"""What docs/tutorials tell to do works as it stands: the blocks of a page run in their order."""

import re
import shlex
import sys
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

from system_models.cli.main import main

FOLDER = Path(__file__).parents[2] / "docs" / "tutorials"
_BLOCK = re.compile(r"(?:^`([^`\n]+)`, new:\n\n)?^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def followed(page: str) -> dict[str, Any]:
    """Run the blocks of a tutorial in the working folder; return the names that its Python has made."""
    names: dict[str, Any] = {}
    for file, language, text in _BLOCK.findall((FOLDER / f"{page}.md").read_text("utf-8")):
        if file:
            Path(file).write_text(text, "utf-8")
        elif language == "python":
            exec(compile(text, page, "exec"), names)
        elif language == "sh":
            for line in text.splitlines():
                program, *arguments = shlex.split(line)
                assert program == "tribofmu"
                assert main(arguments) == 0, line
    for value in names.values():
        if isinstance(value, xr.Dataset):
            value.close()
    return names


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("TRIBOFMU_PYTHON", sys.executable)


def test_zddp_running_in() -> None:
    names = followed("zddp_running_in")
    assert names["wear_without"] > 2.0 * names["wear_with"]
    assert set(names["stribeck"].friction_coefficient.dims) == {"rubbing_time", "entrainment_speed"}


@pytest.mark.long
def test_pin_on_disc() -> None:
    names = followed("pin_on_disc")
    assert names["ratio"] > 100.0
    assert 1.9 < float(names["twice"].wear_depth_1[-1]) / names["ball"] < 2.1


@pytest.mark.long
def test_gear_elsewhere() -> None:
    result = followed("gear_elsewhere")["result"]
    assert result["valid"].all() and (result["h_c"] > 0.0).all()


def test_every_tutorial_is_followed() -> None:
    tests = {name.removeprefix("test_") for name in globals() if name.startswith("test_")}
    assert {path.stem for path in FOLDER.glob("*.md")} <= tests


@pytest.mark.long
def test_own_oil() -> None:
    names = followed("own_oil")
    assert float(names["friction"].max() / names["friction"].min()) > 1.1
    assert float(names["film"].max() / names["film"].min()) < 1.02
