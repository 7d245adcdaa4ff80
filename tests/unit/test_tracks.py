"""The rubbed surfaces as arrays: what a picture or a profile takes."""

import numpy as np
import pytest
from comparison import approx

from contact_core import Scene, StateError, advance, initial_state, track_of

CHEAP = {
    "film.points": "33",
    "surface_1.correlation_length": "16 um",
    "surface_2.correlation_length": "16 um",
    "control.driver": "dry",
}


@pytest.fixture(scope="module")
def worn():
    scene = Scene.from_toml("azam_case_a", CHEAP)
    return scene, advance(scene, scene.operation.point, initial_state(scene), 120.0)[0]


def test_a_track_is_what_the_state_holds(worn):
    scene, state = worn
    track, body = track_of(scene, state, 2), state.bodies[1]
    assert track.wear.shape == (33, 32) == track.tribofilm.shape
    assert np.array_equal(track.wear, body.wear)
    assert track.wear.max() > 0.0 and track.tribofilm.max() > 0.0
    assert track.heights == approx(track.new - track.wear - track.plastic + track.tribofilm, abs=1e-18)
    assert track.y[16] == 0.0
    assert track.x[1] == approx(scene.film.spacing)


def test_the_patch_repeats_along_the_track(worn):
    scene, state = worn
    track = track_of(scene, state, 1, 2.5 * scene.film.domain)
    assert track.wear.shape == (33, 80)
    assert np.array_equal(track.heights[:, :32], track.heights[:, 32:64])
    assert np.array_equal(track.heights[:, :16], track.heights[:, 64:])


def test_wear_is_deepest_in_the_middle_of_the_track(worn):
    scene, state = worn
    profile = track_of(scene, state, 1).wear.mean(axis=1)
    assert profile[16] > 2.0 * profile[7] >= 0.0
    assert profile[0] == profile[-1] == 0.0


@pytest.mark.parametrize(
    ("body", "length", "told"), [(3, None, "body = 3"), (1, 0.0, "length = 0.0"), (1, 1.0, "0.062832 m")]
)
def test_a_track_that_is_not_there_is_refused(worn, body, length, told):
    with pytest.raises(StateError, match=told):
        track_of(*worn, body, length)
