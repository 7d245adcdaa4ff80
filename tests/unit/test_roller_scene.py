"""A scene of a short, rough roller: minutes of tribofilm and wear, of which the rows beyond its ends know nothing."""

from dataclasses import replace

import numpy as np
import pytest
from cheap_scene import cheap
from comparison import approx

from contact_core import advance, solve
from contact_core.deterministic.block import solve_block
from contact_core.deterministic.growth_and_wear import area_of_node
from contact_core.scene import Case
from contact_core.surfaces.patches import track_rows

FACE = 0.8e-3
SHORT = {
    "geometry.model": "roller", "geometry.face_width": "0.8 mm", "geometry.profile.model": "logarithmic",
    "geometry.profile.depth": "0.5 um", "operation.load": "100 N", "film.points": "33", "film.tolerance": "1e-2",
    "film.iterations": "60", "surface_1.correlation_length": "20 um", "surface_2.correlation_length": "20 um",
    "control.mixed_instants": "4", "control.dry_instants": "4",
}  # fmt: skip


@pytest.fixture(scope="module")
def run():
    scene, state, op = cheap(SHORT)
    return scene, op, *advance(scene, op, state, 60.0)


def beyond(scene, rows):
    return np.abs(np.arange(rows) - 0.5 * (rows - 1)) * scene.film.spacing >= 0.5 * FACE


def test_an_instant_is_solved_and_presses_between_the_ends_alone():
    scene, state, op = cheap(SHORT)
    found = solve(scene, op, state)
    outside = beyond(scene, scene.rows)
    assert outside.sum() >= 4
    assert found.film.pressure[outside].max() < 1.0
    assert found.film.pressure.sum() * scene.film.spacing**2 == approx(op.load, rel=2e-3)


def test_a_minute_of_film_and_wear_stays_between_the_ends(run):
    scene, op, state, outputs = run
    outside = beyond(scene, state.rows)
    for i, body in enumerate(state.bodies):
        volume = float(body.wear.sum()) * area_of_node(Case(scene, op), Case(scene, op).sides[i])
        assert volume == approx((outputs.wear_volume_1, outputs.wear_volume_2)[i], rel=1e-9)
        assert body.wear[outside].max() == body.growth[outside].max() == 0.0
    assert outputs.tribofilm_1 > 1e-9
    assert outputs.unconverged == 0.0


def test_a_dry_roller_wears_what_archard_says_of_its_load():
    scene, state, op = cheap(SHORT | {"control.driver": "dry"})
    scene = replace(scene, wear=replace(scene.wear, film=scene.wear.bare))
    outputs = advance(scene, op, state, 60.0)[1]
    volume = scene.wear.bare * op.load * abs(op.sliding_speed) * 60.0 / scene.plasticity.hardness
    assert outputs.wear_volume_1 == approx(volume, rel=1e-3)
    assert outputs.wear_volume_2 == approx(volume, rel=1e-3)


def test_tracks_end_with_the_roller(run):
    scene, _, state, outputs = run
    inside = track_rows(scene, state.rows)
    assert not (inside & beyond(scene, state.rows)).any()
    assert inside.sum() * scene.film.spacing == approx(FACE, abs=1.01 * scene.film.spacing)
    assert outputs.wear_depth_1 == approx(float(state.bodies[0].wear[inside].mean()), rel=1e-9)


def test_wear_at_the_ends_does_not_widen_the_patches():
    scene, state, op = cheap(SHORT | {"film.width": "0.84 mm"})
    assert not beyond(scene, state.rows)[2]
    worn = tuple(replace(body, wear=np.full_like(body.wear, 1e-9)) for body in state.bodies)
    assert solve_block(Case(scene, op), replace(state, bodies=worn)).rows == state.rows
