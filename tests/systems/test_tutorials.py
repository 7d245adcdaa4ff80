"""What docs/tutorials tell to do works as it stands: the blocks of a page run in their order."""

import sys
from pathlib import Path

import pytest
from followed import DOCS, followed

FOLDER = DOCS / "tutorials"


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("TRIBOFMU_PYTHON", sys.executable)


@pytest.mark.long
def test_zddp_running_in() -> None:
    names = followed("tutorials/zddp_running_in")
    assert names["wear_without"] > 2.0 * names["wear_with"]
    assert set(names["stribeck"].friction_coefficient.dims) == {"rubbing_time", "entrainment_speed"}


@pytest.mark.long
def test_pin_on_disc() -> None:
    names = followed("tutorials/pin_on_disc")
    assert names["ratio"] > 100.0
    assert 1.9 < float(names["twice"].wear_depth_1[-1]) / names["ball"] < 2.1


@pytest.mark.long
def test_gear_elsewhere() -> None:
    result = followed("tutorials/gear_elsewhere")["result"]
    assert result["valid"].all() and (result["h_c"] > 0.0).all()


def test_every_tutorial_is_followed() -> None:
    tests = {name.removeprefix("test_") for name in globals() if name.startswith("test_")}
    assert {path.stem for path in FOLDER.glob("*.md")} <= tests


@pytest.mark.long
def test_own_oil() -> None:
    names = followed("tutorials/own_oil")
    assert float(names["friction"].max() / names["friction"].min()) > 1.1
    assert float(names["film"].max() / names["film"].min()) < 1.02
