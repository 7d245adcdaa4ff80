"""What docs/tutorials tell to do works as it stands: the blocks of a page run in their order."""

import re
import shlex
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

from contact_core.laws import offered
from system_models.cli.main import main
from system_models.machines import registry

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
                if line == "pip install -e .":
                    install()
                    continue
                assert program == "tribofmu"
                assert main(arguments) == 0, line
    for value in names.values():
        if isinstance(value, xr.Dataset):
            value.close()
    return names


def install() -> None:
    """Leave in the working folder, which is on the path, what pip does beside an editable package; no network."""
    project = tomllib.loads(Path("pyproject.toml").read_text("utf-8"))["project"]
    info = Path(f"{project['name'].replace('-', '_')}-{project['version']}.dist-info")
    info.mkdir()
    heading = f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n"
    (info / "METADATA").write_text(heading, "utf-8")
    groups = project["entry-points"].items()
    text = "".join(f"[{group}]\n" + "".join(f"{n} = {v}\n" for n, v in entries.items()) for group, entries in groups)
    (info / "entry_points.txt").write_text(text, "utf-8")
    forget()


def forget() -> None:
    """Let laws and machines of other packages be looked for anew."""
    offered.of_others.cache_clear()
    registry.kinds.cache_clear()


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("TRIBOFMU_PYTHON", sys.executable)
    modules = set(sys.modules)
    yield
    monkeypatch.undo()
    forget()
    for name in {"my_oil", "flywheel_brake"} - modules:
        sys.modules.pop(name, None)


@pytest.mark.long
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


@pytest.mark.long
def test_writing_a_law(capsys: pytest.CaptureFixture[str]) -> None:
    names = followed("writing_a_law")
    assert "McEwen, J. Inst. Petroleum" in capsys.readouterr().out  # of `explain`
    assert names["worst"] < 0.02
    assert abs(names["film"] - 1.0) < 0.02
    assert 0.7 < names["friction"] < 0.8
    assert names["result"]["valid"].all()
    barus = float(names["barus"].friction_coefficient)
    assert abs(names["result"]["friction_coefficient"][-1] / barus - 1.0) < 0.02


def test_writing_a_machine() -> None:
    names = followed("writing_a_machine")
    assert 0.45 < names["stops"]["twice"] / names["stops"]["stop"] < 0.6
    assert abs(names["work"] / names["energy"] - 1.0) < 0.03
    assert names["slow"] > 2.0 * names["fast"]
    assert Path("results/stop/overview.png").is_file()
