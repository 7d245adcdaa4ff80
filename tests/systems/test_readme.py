"""README is short, and the examples of docs/how-to that any reader tries first run as they stand."""

import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
from comparison import approx

from contact_core import Scene, advance, initial_state
from contact_core.scene.toml import read_table
from system_models.run.duty import Duty

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text("utf-8")
PAGES = "".join((ROOT / "docs" / "how-to" / f"{name}.md").read_text("utf-8") for name in ("run", "python", "scenes"))


def block(language: str, start: str) -> str:
    (found,) = re.findall(rf"```{language}\n({re.escape(start)}.*?)```", PAGES, re.DOTALL)
    return found


def test_the_python_example_runs(capsys: pytest.CaptureFixture[str]) -> None:
    names: dict[str, Any] = {}
    exec(block("python", "from contact_core import Scene, advance").replace("60.0", "10.0"), names)
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == ["1", "2", "3"]
    assert isinstance(names["memory"], bytes)
    exec(block("python", "from contact_core import track_of"), names)
    error, depth = names["error"], names["out"].wear_depth_1
    assert all(0.0 < part < depth for part in (error.time, error.sampling, error.grid, error.iteration))
    assert max(error) < error.together < depth
    assert names["profile"].shape == (65,)


def test_the_example_of_one_call_runs(capsys: pytest.CaptureFixture[str]) -> None:
    exec(block("python", "from contact_core import dry_contact"), {})
    film, error, *_ = capsys.readouterr().out.split()
    assert float(film) == approx(14.37e-9, rel=0.02)  # on 513 nodes, and the accuracy asked for
    assert 0.0 < float(error) <= 0.02 * float(film)


def test_the_example_of_shapes_runs(capsys: pytest.CaptureFixture[str]) -> None:
    names: dict[str, Any] = {}
    exec(block("python", "from contact_core import Logarithmic"), names)
    assert all(names[shape].converged for shape in ("ball", "flank", "roller"))
    film = 0.2e-6 / 1.2  # all that the surfaces bring, denser under pressure
    assert film < names["flank"].h_central * 1.05 < 0.2e-6
    assert names["roller"].pressure_max > 1.1e9  # above that of the line without ends


def test_the_scene_of_ones_own_is_a_scene() -> None:
    (text,) = re.findall(r"```toml\n(.*?)```", README, re.DOTALL)
    scene = Scene.from_dict(tomllib.loads(text) | {"name": "mine"})
    assert scene.hertz(scene.operation.load).pressure_max == approx(1.09e9, rel=0.01)  # 3 W / (2 pi a2)


def test_the_duty_is_a_duty(tmp_path: Path, scene: Scene) -> None:
    path = tmp_path / "duty.csv"
    path.write_text(block("", "time [min]"))
    assert Duty.from_csv(path, scene.operation.point).times == (0.0, 1800.0, 3600.0)


def test_the_example_of_friction_and_heat_runs() -> None:
    changes = tomllib.loads(block("toml", "[lubricant]"))
    table = read_table("mtm_zddp") | changes
    coarse = {"film": {"points": 17}} | {f"surface_{body}": {"correlation_length": "32 um"} for body in (1, 2)}
    scene = Scene.from_dict(table | {name: table[name] | change for name, change in coarse.items()})
    assert (scene.lubricant.flow, scene.heat.name, scene.heat.bulk.name) == ("local", "field", "lumped")
    state, outputs = advance(scene, scene.operation.point, initial_state(scene), 0.02)
    assert outputs.heat_flow_1 + outputs.heat_flow_2 == approx(outputs.power_loss, rel=1e-12)
    assert state.temperatures is not None and state.temperatures[0] > scene.operation.temperature


def test_the_example_of_the_regression_level_runs(capsys: pytest.CaptureFixture[str]) -> None:
    scene = Scene.from_toml("mtm_zddp", {"film.points": "65"})
    names: dict[str, Any] = {
        "scene": scene,
        "state": initial_state(scene),
        "point": scene.operation.point,
        "advance": advance,
    }
    exec(block("python", "fast = scene.at_level"), names)
    friction, slope, error = (float(word) for word in capsys.readouterr().out.split())
    assert 0.01 < friction < 0.2
    assert slope != 0.0
    assert 0.0 < error < 1.0


def test_the_example_of_a_duty_and_of_stribeck_curves_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    exec(block("python", "from dataclasses import replace"), names)
    load = names["done"].dataset["load"].values
    assert load[-1] == 2.0 * load[0]
    assert names["swept"]["friction_coefficient"].shape == (2, 5)


def test_readme_is_short() -> None:
    assert len(README) < 6000
