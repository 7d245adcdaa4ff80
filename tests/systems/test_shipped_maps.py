"""Shipped maps beside runs of hours at the deterministic level, which are kept."""

import json
from pathlib import Path

import pytest

from contact_core import Outputs, Scene, advance, initial_state
from contact_core.corrections.map import shipped_maps

RUNS = json.loads((Path(__file__).parents[1] / "golden" / "map_runs.json").read_text("utf-8"))
ERRORS = {"friction_coefficient": "error_friction", "h_c": "error_film", "contact_load_ratio": "error_load_ratio"}


def along(name: str) -> list[Outputs]:
    """Return the outputs of a scene's own operation at the level of its map, at the times of the kept run."""
    scene = Scene.from_toml(name).at_level("map")
    state, before, found = initial_state(scene), 0.0, []
    for time in RUNS[name]["time"]:
        state, out = advance(scene, scene.operation.point, state, time - before)
        before = time
        found.append(out)
    return found


def inside(name: str, outs: list[Outputs], output: str, narrower: float = 1.0) -> float:
    """Return the share of the times at which the deterministic level is within the stated error."""
    within = 0
    for out, exact in zip(outs, RUNS[name][output], strict=True):
        value = getattr(out, output)
        half = narrower * getattr(out, ERRORS[output]) * (1.0 if output == "contact_load_ratio" else value)
        within += abs(value - exact) <= half
    return within / len(outs)


@pytest.mark.parametrize("name", shipped_maps())
def test_a_shipped_map_covers_two_hours_of_its_scene_and_would_not_with_a_tenth_of_its_errors(name: str) -> None:
    outs = along(name)
    assert {output: inside(name, outs, output) >= 0.9 for output in ERRORS} == dict.fromkeys(ERRORS, True)
    assert {output: inside(name, outs, output, 0.1) < 0.6 for output in ERRORS} == dict.fromkeys(ERRORS, True)
