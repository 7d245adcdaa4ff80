"""What one instant gives to the outputs, and what its overlap does to the bodies."""

from dataclasses import replace

import numpy as np
import pytest
from cheap_scene import cheap
from comparison import approx

from contact_core import solve
from contact_core.patches import bare_heights, heights_of, on_grid, patch_nodes, rolled, yielded
from contact_core.reference import hamrock_dowson
from contact_core.sweep import observed


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
    here, seen = inside(scene, op, fields), observed(scene, op, fields)
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
    outside, seen = ~inside(scene, op, fields), observed(scene, op, fields)
    other = {
        name: np.where(outside, 5.0, 1.0) * getattr(fields, name)
        for name in ("roughness", "gap", "pressure", "solid_pressure")
    }
    changed = observed(scene, op, replace(fields, **other))
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
