"""What one instant gives to the outputs, and what its overlap does to the bodies."""

from dataclasses import replace

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap
from comparison import approx

from contact_core import solve
from contact_core.deterministic import oil_temperature as oil
from contact_core.deterministic.observed import observed
from contact_core.deterministic.transient import rolled, yielded
from contact_core.laws.temperatures import Rubbing
from contact_core.reference import hamrock_dowson
from contact_core.scene import Case
from contact_core.shapes import Point
from contact_core.surfaces.patches import bare_heights, between, facing_surfaces, heights_of, on_grid, patch_nodes


@pytest.fixture(scope="module")
def instant():
    scene, state, op = cheap()
    return scene, op, solve(scene, op, state)


def inside(scene, op, fields):
    """Nodes within two thirds of Hertz's radius."""
    radius = (1.5 * op.load * scene.geometry.radius_x / scene.solids.reduced_modulus) ** (1.0 / 3.0)
    return np.hypot(fields.x[None, :], fields.y[:, None]) < 2.0 / 3.0 * radius


def test_lambda_is_the_film_over_the_rms_roughness_where_both_are_measured(instant):
    scene, op, fields = instant
    here, seen = inside(scene, op, fields), observed(Case(scene, op), fields)
    assert here.sum() > 30
    assert seen["h_c"] == approx(fields.gap[here].mean(), rel=1e-12)
    heights = fields.roughness[here]
    sigma = np.sqrt(((heights - heights.mean()) ** 2).mean())
    assert seen["lambda_ratio"] == approx(fields.gap[here].mean() / sigma, rel=1e-12)
    oil = scene.lubricant.viscosity, op.temperature
    smooth = scene.shape(op).smooth(op.load, op.entrainment_speed, *oil, scene.solids.reduced_modulus)
    assert seen["lambda_conventional"] == approx(hamrock_dowson(smooth)[0] / sigma, rel=1e-12)


def test_what_lies_outside_the_contact_decides_no_mean_over_its_middle(instant):
    scene, op, fields = instant
    outside, seen = ~inside(scene, op, fields), observed(Case(scene, op), fields)
    other = {
        name: np.where(outside, 5.0, 1.0) * getattr(fields, name)
        for name in ("roughness", "gap", "pressure", "solid_pressure")
    }
    changed = observed(Case(scene, op), replace(fields, **other))
    for name in ("lambda_ratio", "lambda_conventional", "h_c", "contact_area_ratio_disc", "contact_load_ratio_disc"):
        assert changed[name] == seen[name] > 0.0, name


@pytest.mark.parametrize("steps", [(0.0, 0.0), (3.2e-5, -1.1e-4)])
def test_the_bodies_give_way_by_the_overlap_and_by_nothing_else(steps):
    scene, state, _ = cheap()
    spacing = scene.film.spacing
    state = rolled(scene, state, [round(step / spacing) * spacing for step in steps])
    overlap = np.zeros((state.rows, scene.film.points))
    overlap[10:20, 5:25] = np.random.Generator(np.random.Philox(1)).uniform(0.0, 3e-8, (10, 20))

    def together(at):
        bodies = zip(bare_heights(scene, at.rows), at.bodies, strict=True)
        return sum(on_grid(heights_of(bare, body), patch_nodes(scene, body)) for bare, body in bodies)

    after = yielded(scene, state, overlap)
    lost = together(state) - together(after)
    assert lost == approx(overlap, rel=1e-9, abs=1e-20)
    first, second = (body.plastic.sum() for body in after.bodies)
    assert first == approx(second, rel=1e-12)  # half each
    again = yielded(scene, after, overlap)
    assert together(state) - together(again) == approx(2.0 * overlap, rel=1e-9, abs=1e-20)


def test_rolling_resistance_is_the_oils_pressure_slope_along_x_over_half_the_gap(instant):
    scene, op, fields = instant
    x, y = np.meshgrid(fields.x, fields.y)
    even = replace(fields, gap=np.full_like(fields.gap, 2e-7), fluid_pressure=1e12 * x + 3e12 * y)
    expected = 0.5 * 2e-7 * 1e12 * x.size * scene.film.spacing**2
    assert observed(Case(scene, op), even)["rolling_resistance"] == approx(expected, rel=1e-9)


@pytest.mark.parametrize("i", [0, 1])
def test_wear_of_either_body_takes_its_waves_out_of_the_roughness(i):
    scene, state, op = cheap()
    body = state.bodies[i]
    wave = (
        1e-9 * np.cos(2.0 * np.pi * 3.0 * np.arange(body.wear.shape[1]) / body.wear.shape[1]) * np.ones_like(body.wear)
    )
    bodies = tuple(replace(each, wear=wave * (k == i)) for k, each in enumerate(state.bodies))
    before, after = (solve(scene, op, at, dry=True) for at in (state, replace(state, bodies=bodies)))
    lost = on_grid(wave, patch_nodes(scene, body))
    assert before.roughness - after.roughness == approx(lost, rel=1e-6, abs=1e-18)
    assert before.heights - after.heights == approx(lost, rel=1e-6, abs=1e-18)


def test_an_ellipse_turned_by_a_quarter_is_as_deep_with_its_axes_swapped():
    one, turned = Point(5e-3, 30e-3), Point(30e-3, 5e-3)
    assert one.depths(1e-7, 2e-4, 6e-4) == approx(turned.depths(1e-7, 6e-4, 2e-4)[::-1], rel=1e-12)


def test_the_heat_of_a_line_spreads_along_its_whole_face(monkeypatch):
    seen = []
    monkeypatch.setattr(oil, "Rubbing", lambda **given: seen.append(given["face"]) or Rubbing(**given))
    scene, state, op = cheap(
        CHEAP | {"geometry.model": "line", "geometry.face_width": "8 mm", "operation.load": "2 kN"}
    )
    solve(scene, op, state, dry=True)
    assert seen
    assert seen == approx([8e-3] * len(seen), rel=1e-9)


@pytest.mark.parametrize("part", [0.5, -0.5, 0.31, -0.07])
def test_a_patch_between_nodes_is_the_wave_that_it_samples(part):
    nodes = np.arange(40)
    for length in (2.5, 5.0, 20.0):
        wave = np.sin(2.0 * np.pi * nodes / length)[None]
        assert between(wave, part) == approx(np.sin(2.0 * np.pi * (nodes - part) / length)[None], abs=1e-12)


def test_roughness_of_a_nodes_length_keeps_its_rms_between_nodes():
    rough = np.random.default_rng(4).normal(size=(50, 64))
    assert between(rough, 0.5).std() == approx(rough.std(), rel=0.02)


def test_bodies_move_by_parts_of_a_node():
    """The sum of two bodies' heights is that at their places, not at the nodes nearest to them."""
    scene, state, _ = cheap()
    spacing = scene.film.spacing
    wave = np.tile(1e-8 * np.sin(2.0 * np.pi * np.arange(scene.film.points - 1) / 16.0), (state.rows, 1))
    bodies = tuple(replace(body, wear=sign * wave) for body, sign in zip(state.bodies, (1.0, -1.0), strict=True))
    flat = replace(scene, surface_1=replace(scene.surface_1, rq=0.0), surface_2=replace(scene.surface_2, rq=0.0))
    state = rolled(flat, replace(state, bodies=bodies), (0.3 * spacing, 0.3 * spacing))
    assert np.abs(facing_surfaces(flat, state, moving=True).heights).max() < 1e-20
    apart = facing_surfaces(flat, rolled(flat, state, (0.0, 0.4 * spacing)), moving=True).heights
    assert np.abs(apart).max() == approx(2e-8 * np.sin(0.4 * np.pi / 16.0), rel=0.03)
