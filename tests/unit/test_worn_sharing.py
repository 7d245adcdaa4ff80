"""The regression level on worn surfaces: peaks that wear levels stay in contact, until little roughness is left."""

from dataclasses import replace
from itertools import pairwise

import pytest
from comparison import approx

from contact_core import Scene, advance, initial_state
from contact_core.state import Mean

SCENES = ("mtm_zddp", "fzg_flank")


def load_ratio(name: str, left: float) -> float:
    """Load ratio of surfaces without a tribofilm that have this share of their roughness left."""
    scene = Scene.from_toml(name).at_level("regression")
    blank = Mean(growth=0.0, removal=0.0, coverage=0.0, wear=1e-8, roughness=0.0, worn=1e-15, cycles=1e3)
    first, second = (replace(blank, roughness=left * s.rms) for s in (scene.surface_1, scene.surface_2))
    point = replace(scene.operation.point, speed_1=0.2, speed_2=0.19)
    _, found = advance(scene, point, replace(initial_state(scene), means=(first, second)), 0.0)
    return found.contact_load_ratio


@pytest.mark.parametrize("name", SCENES)
def test_levelled_peaks_carry_as_much_down_to_a_quarter_of_the_roughness(name):
    new = load_ratio(name, 1.0)
    assert new > 0.05
    assert load_ratio(name, 0.5) == approx(new, rel=1e-12)
    assert load_ratio(name, 0.26) == approx(new, rel=1e-12)


@pytest.mark.parametrize("name", SCENES)
def test_with_less_roughness_left_solids_carry_less_so_that_wear_ends(name):
    shares = [load_ratio(name, left) for left in (0.25, 0.1, 0.03, 0.01)]
    assert all(more > less for more, less in pairwise(shares))
    assert shares[-1] < 0.7 * shares[0]
