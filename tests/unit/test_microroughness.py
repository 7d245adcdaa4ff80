"""Microroughness of a surface in a scene: fields, real area, dose and dry contact, against numpy and across grids."""

import re

import numpy as np
import pytest
from cheap_scene import CHEAP
from comparison import HARD, approx

from contact_core import Scene, SceneError, advance, initial_state
from contact_core.deterministic.accumulator import Accumulator
from contact_core.deterministic.instant import solve_instant
from contact_core.deterministic.transient import dry_instant
from contact_core.laws.asperity_layer import AsperityLayer
from contact_core.scene import Case
from contact_core.surfaces.patches import on_patches

FINE = {
    "surface_1.microroughness.rms": "4 nm",
    "surface_1.microroughness.longest": "4 um",
    "surface_2.microroughness.rms": "16 nm",
    "surface_2.microroughness.longest": "4 um",
}


def scene(**changes):
    return Scene.from_toml("azam_case_a", {"film.points": "65"} | HARD | changes)


def bound(given):
    return Case.bind(given, given.operation.point)


def test_both_bodies_make_one_layer_and_a_scene_without_has_none():
    case = bound(scene(**FINE))
    assert case.microroughness.rms == approx(np.hypot(4e-9, 16e-9), rel=1e-12)
    assert case.microroughness.longest == approx(4e-6, rel=1e-12)
    assert bound(scene()).microroughness is None
    one = bound(scene(**{key: value for key, value in FINE.items() if "surface_2" in key}))
    assert one.microroughness == AsperityLayer(16e-9, 4e-6)


def test_it_survives_the_tables_of_the_scene_and_is_part_of_its_identity():
    rough = scene(**FINE)
    assert Scene.from_dict(rough.to_dict()) == rough
    assert rough.digest() != scene().digest()
    assert "microroughness" not in str(Scene.from_toml("dimple_rolling").to_dict())  # none is given


def test_heights_too_steep_for_a_surface_are_refused_with_the_field_named():
    with pytest.raises(SceneError, match=re.escape("surface_2.microroughness: rms = 1e-06 m over longest = 4e-06 m")):
        scene(**FINE | {"surface_2.microroughness.rms": "1 um"})


def test_at_both_levels_solids_carry_more_with_it_on_less_real_area_each():
    for level in ("deterministic", "regression"):
        share, pressure = {}, {}
        for floor in ("hard", "fine"):
            given = scene(**CHEAP, **(FINE if floor == "fine" else {})).at_level(level)
            out = advance(given, given.operation.point, initial_state(given), 0.0)[1]
            share[floor], pressure[floor] = out.contact_load_ratio, out.contact_load_ratio / out.contact_area_ratio
            assert not [text for text in given.warnings() if "microroughness" in text]
        assert share["fine"] > 1.2 * share["hard"] > 0.0, level
        assert pressure["fine"] > 1.2 * pressure["hard"], level


def test_the_area_and_the_share_of_the_solids_follow_from_the_pressure_at_every_node():
    given = scene(**FINE)
    case = bound(given)
    fields = solve_instant(case, initial_state(given), dry=True)
    layer, modulus, hardness = case.microroughness, given.solids.reduced_modulus, given.plasticity.hardness
    assert fields.touching == approx(layer.area(fields.solid_pressure, modulus, hardness), rel=1e-12)
    law = layer.pressure(fields.gap - given.film.floor, modulus, hardness)
    own = np.minimum(fields.solid_pressure, layer.pressure_scale(modulus, hardness))  # the rest the floor carries
    off = np.abs(own - law)[fields.solid_pressure > 0.0].sum() * given.film.spacing**2 / case.op.load
    assert off < 2e-3
    assert 0.0 < fields.touching[fields.solid_pressure > 0.0].min() < 0.01


def test_the_dose_of_a_pass_is_the_largest_share_that_touched_in_it():
    given = scene(**FINE, **{"tribofilm.dose": "clock", "heat": "none"})
    case, state = bound(given), initial_state(given)
    rate = given.tribofilm.rate(given.operation.temperature)
    sums = Accumulator.before(state)
    expected = [np.zeros_like(body.since) for body in state.bodies]
    for _ in range(3):
        state, fields = dry_instant(case, state, [given.film.spacing * 5, given.film.spacing * 3])
        sums.add(case, state, fields, (0.125, 0.125))
        for most, seen in zip(expected, on_patches(given, state, (fields.touching,) * 2), strict=True):
            np.maximum(most, seen, out=most)
    for peak, most in zip(sums.peaks, expected, strict=True):
        assert peak / rate == approx(most, rel=1e-12)
        assert ((peak > 0.01 * rate) & (peak < 0.5 * rate)).mean() > 0.05
    for _ in range(9):  # a pass and more later only what touched since counts
        state, fields = dry_instant(case, state, [0.0, 0.0])
        sums.add(case, state, fields, (0.125, 0.125))
    for peak, since, seen in zip(sums.peaks, sums.since, on_patches(given, state, (fields.touching,) * 2), strict=True):
        assert peak[since < 1.0] / rate == approx(seen[since < 1.0], rel=1e-12)


def test_real_area_and_tribofilm_of_a_dry_block_hardly_depend_on_the_grid():
    """On a hard floor the area is that of the grid's own asperities, and 20 % off."""
    found = {}
    for points in ("65", "129"):
        for fine in (True, False):
            given = scene(**(FINE if fine else {}), **{"film.points": points, "control.driver": "dry"})
            state = initial_state(given)
            for _ in range(2):
                state, out = advance(given, given.operation.point, state, 1.0)
            found[points, fine] = out
    for name in ("contact_area_ratio", "tribofilm_1"):
        one, other = (getattr(found[points, True], name) for points in ("65", "129"))
        assert one == approx(other, rel=0.08), name
    one, other = (found[points, False].contact_area_ratio for points in ("65", "129"))
    assert abs(one / other - 1.0) > 0.1
    assert found["65", True].contact_load_ratio == approx(1.0, abs=1e-6)
