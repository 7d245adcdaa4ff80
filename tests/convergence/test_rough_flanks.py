"""Blocks of rough flanks whose oil presses at the hardness, against the same solved ten times as closely."""

import pytest
from comparison import approx

from contact_core import RangeFlag, Scene, advance, initial_state

SOFT = {  # a flank at load stage 9 with the hardness of its tribofilm
    "surface_1.rq": "0.23 um",
    "surface_2.rq": "0.23 um",
    "plasticity.hardness": "2.6 GPa",
    "plasticity.film_hardness": "2.6 GPa",
    "film.width": "0.05 mm",
    "operation.load": "6400 N",
}


@pytest.mark.long
def test_a_block_of_flanks_under_high_load_is_that_of_a_tenth_of_the_tolerance():
    found = []
    for changes in ({}, {"film.tolerance": "1e-4"}):
        scene = Scene.from_toml("fzg_flank", SOFT | changes)
        found.append(advance(scene, scene.operation.point, initial_state(scene), 0.0)[1])
    usual, closely = found
    for out in found:
        assert not out.range_flags & RangeFlag.NOT_CONVERGED
        assert out.pressure_max == approx(2.6e9)
    assert usual.friction_coefficient == approx(closely.friction_coefficient, rel=0.02)
    assert usual.h_c == approx(closely.h_c, rel=0.02)
    assert usual.contact_load_ratio == approx(closely.contact_load_ratio, abs=0.01)
