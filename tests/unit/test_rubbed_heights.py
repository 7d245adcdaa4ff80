"""Bodies with heights from an array are rubbed: they wear, grow tribofilm, and their states are stored."""

import numpy as np
import pytest
from cheap_scene import CHEAP
from comparison import approx

from contact_core import ContactState, Scene, advance, initial_state, warm_up
from contact_core.surfaces.patches import bare_heights
from contact_core.surfaces.profiles import track_of

FEW = {"control.mixed_instants": "4", "control.dry_instants": "4", "surface_2.rq": "0 nm"}
LINE = {
    "film.points": "33", "film.width": "0.2 mm", "surface_1.correlation_length": "50 um", "film.tolerance": "1e-2",
    "film.iterations": "60", "operation.speed_1": "0.4 m/s", "operation.speed_2": "0.26 m/s",  # for solids that touch
}  # fmt: skip
SCENES = {"point": ("azam_case_a", CHEAP | FEW), "line": ("fzg_flank", LINE | FEW)}


def texture() -> np.ndarray:
    """Twelve waves along and ten across, 100 nm rms, with flattened tops."""
    at = 2.0 * np.pi * (np.arange(120) + 0.5) / 120
    z = np.sin(12.0 * at)[None, :] + np.cos(10.0 * at)[:, None] - 0.4
    return 100e-9 * np.minimum(z, 0.5) / np.std(np.minimum(z, 0.5))


@pytest.fixture(scope="module", params=SCENES)
def run(request: pytest.FixtureRequest):
    name, changes = SCENES[request.param]
    scene = Scene.from_toml(name, changes)
    scene = scene.with_heights(2, texture(), scene.film.domain / 120, beyond="mirrored")
    return scene, *advance(scene, scene.operation.point, initial_state(scene), 60.0)


def test_they_wear_and_grow_tribofilm_where_they_are_high(run):
    scene, state, outputs = run
    track, body = track_of(scene, state, 2), state.bodies[1]
    assert np.array_equal(track.new, bare_heights(scene, state.rows)[1])
    assert body.wear.max() > 0.0
    assert body.growth.max() > 1e-9
    high = track.new > np.quantile(track.new, 0.75)
    rubbed = body.wear.max(axis=1) > 0.0
    assert body.wear[rubbed][high[rubbed]].mean() > 1.5 * body.wear[rubbed][~high[rubbed]].mean()
    assert np.abs(track.heights - (track.new - body.wear - body.plastic + body.tribofilm)).max() < 1e-20
    assert outputs.roughness_2 > 10e-9


def test_their_stored_state_goes_on_as_the_state_itself(run):
    scene, state, _ = run
    again = ContactState.from_bytes(state.to_bytes(), scene)
    one, two = (advance(scene, scene.operation.point, s, 0.0)[1] for s in (state, again))
    assert one == two


def test_the_regression_level_takes_the_same_state(run):
    scene, state, outputs = run
    fast = scene.at_level("regression")
    found = advance(fast, scene.operation.point, ContactState.from_bytes(state.to_bytes(), fast), 0.0)[1]
    assert found.roughness_2 == approx(outputs.roughness_2, rel=0.3)


def test_a_process_is_warmed_up_for_them(run):
    warm_up(run[0])
