"""The instant that a run is at: of the kind that drives its block, and unnoticed by the run."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap
from comparison import approx

from contact_core import ContactState, OperatingPoint, Scene, advance
from contact_core.deterministic.present import present_instant
from contact_core.scene import Case


@cache
def rubbed(**changes: str) -> tuple[Scene, OperatingPoint, ContactState]:
    """Case A after some blocks."""
    scene, state, op = cheap(CHEAP, **changes)
    return scene, op, advance(scene, op, state, 10.0)[0]


def share_of(fields) -> float:
    return float(fields.solid_pressure.sum() / fields.pressure.sum())


def test_of_a_march_it_is_the_next_instant_a_node_on() -> None:
    scene, op, state = rubbed(control__driver="mixed")
    placed, fields = present_instant(Case.bind(scene, op), state)
    assert state.film is not None
    assert fields.route == "mixed"
    assert share_of(fields) == approx(state.outputs.contact_load_ratio, abs=0.1)
    ways = [
        (new.offset - old.offset) % scene.film.domain / scene.film.spacing
        for new, old in zip(placed.bodies, state.bodies, strict=True)
    ]
    assert ways == approx([speed / op.entrainment_speed for speed in (op.speed_1, op.speed_2)])


def test_of_a_dry_block_its_solids_carry_all_of_the_load() -> None:
    scene, op, state = rubbed(control__driver="dry")
    _, fields = present_instant(Case.bind(scene, op), state)
    assert fields.route == "dry"
    assert share_of(fields) == approx(1.0)


@pytest.mark.parametrize(
    ("change", "route"),
    [({"load": 0.0}, "open"), ({"speed_1": 0.0, "speed_2": 0.0}, "dry"), ({"load": 40.0}, "mixed")],
)
def test_of_other_inputs_than_those_of_the_block_it_is_a_steady_one(change: dict[str, float], route: str) -> None:
    scene, op, state = rubbed(control__driver="mixed")
    other = replace(op, **change)
    placed, fields = present_instant(Case.bind(scene, other), state)
    assert fields.route == route
    assert [body.offset for body in placed.bodies] == [body.offset for body in state.bodies]
    cell = float(np.diff(fields.x)[0] * np.diff(fields.y)[0])
    assert fields.pressure.sum() * cell == approx(other.load, rel=0.01)


@pytest.mark.parametrize("driver", ["mixed", "dry"])
def test_a_run_does_not_notice_it(driver: str) -> None:
    scene, op, state = rubbed(control__driver=driver)
    stored = state.to_bytes()
    unseen = advance(scene, op, ContactState.from_bytes(stored, scene), 30.0)[0].to_bytes()
    present_instant(Case.bind(scene, op), state)
    assert state.to_bytes() == stored
    assert advance(scene, op, state, 30.0)[0].to_bytes() == unseen
