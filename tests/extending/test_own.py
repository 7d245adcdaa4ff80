"""docs/extending.md: a law and a machine of one's own, in packages beside tribofmu, as a reader makes them."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from followed import followed, forget

from contact_core.errors import SceneError
from system_models.machines import reading


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
def test_a_law_of_your_own(capsys: pytest.CaptureFixture[str]) -> None:
    names = followed("extending", "A law of your own: an oil from your viscometer")
    assert "McEwen, J. Inst. Petroleum" in capsys.readouterr().out  # of `explain`
    assert names["worst"] < 0.02
    assert abs(names["film"] - 1.0) < 0.02
    assert 0.7 < names["friction"] < 0.8
    assert names["result"]["valid"].all()
    barus = float(names["barus"].friction_coefficient)
    assert abs(names["result"]["friction_coefficient"][-1] / barus - 1.0) < 0.02


def test_a_machine_of_your_own() -> None:
    names = followed("extending", "A machine of your own: a flywheel and its brake")
    assert 0.45 < names["stops"]["twice"] / names["stops"]["stop"] < 0.6
    assert abs(names["work"] / names["energy"] - 1.0) < 0.03
    assert names["slow"] > 2.0 * names["fast"]
    assert Path("results/stop/overview.png").is_file()
    machine = reading.read("stop.toml")
    del machine.table["duty"]["compression"]
    with pytest.raises(SceneError, match="compression"):
        reading.assemble(machine)
