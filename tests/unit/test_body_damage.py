"""Damage in layers below a surface that is worn: `kernels.damage`."""

from itertools import pairwise

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import quad

from contact_core.errors import ContactError
from contact_core.kernels.damage import accumulated, faces_of, pits_of, worn_away

GRADED = np.concatenate(([0.0], np.geomspace(0.02, 2.0, 15)))
EVEN = 0.1 * (np.arange(12) + 0.5)


def column(values):
    return np.asarray(values, float)[:, None, None]


def worn_by(depth):
    return np.full((1, 1), depth)


def means(function, faces):
    """Mean of a function over each layer."""
    return np.array([quad(function, a, b)[0] / (b - a) for a, b in pairwise(faces)])


def test_at_rest_damage_adds_up_exactly():
    rng = np.random.default_rng(1)
    damage, gained = rng.random((16, 3, 4)), 1e5 * (1e-7 * rng.random((16, 3, 4)))
    assert np.array_equal(accumulated(damage, GRADED, gained, np.zeros((3, 4))), damage + gained)
    removed = np.zeros((3, 4))
    removed[1, 2] = 0.01
    found = accumulated(damage, GRADED, gained, removed)
    still = removed == 0.0
    assert np.array_equal(found[:, still], (damage + gained)[:, still])
    assert np.all(found[:4, 1, 2] != (damage + gained)[:4, 1, 2])


def test_a_whole_layer_worn_off_brings_the_next_one_to_the_surface():
    damage = column(np.random.default_rng(2).random(12))
    found = worn_away(damage, EVEN, worn_by(0.3))
    assert found[:-3] == approx(damage[3:], rel=1e-12)
    assert found[-3:] == approx(np.repeat(damage[-1:], 3, axis=0), rel=1e-12)  # below the last one nothing changes


@pytest.mark.parametrize("depths", [GRADED, EVEN, np.array([0.3]), np.array([0.0, 0.5])])
def test_wear_makes_no_new_extreme(depths):
    rng = np.random.default_rng(3)
    for _ in range(50):
        damage = rng.random((depths.size, 4, 5)) ** rng.integers(1, 9)
        found = worn_away(damage, depths, 10.0 ** rng.uniform(-6.0, 1.0, (4, 5)))
        assert np.all((found >= damage.min(axis=0)) & (found <= damage.max(axis=0)))


def test_what_comes_into_a_layer_is_between_the_means_of_those_it_comes_from_and_their_neighbours():
    rng = np.random.default_rng(7)
    damage, faces, last = rng.random((16, 20, 20)) ** 4, faces_of(GRADED), GRADED.size - 1
    for depth in 10.0 ** rng.uniform(-5.0, 0.0, 30):
        found = worn_away(damage, GRADED, np.full((20, 20), depth))
        for i in range(GRADED.size):
            first, final = np.searchsorted(faces, (faces[i] + depth, faces[i + 1] + depth)) - 1
            reached = damage[max(first - 1, 0) : min(final + 1, last) + 1]
            assert np.all(found[i] >= reached.min(axis=0) - 1e-12)
            assert np.all(found[i] <= reached.max(axis=0) + 1e-12)


def test_what_layers_gain_is_in_them_or_has_been_worn_off():
    """A uniform gain in a uniform body stays uniform, and what a lone layer has moves up with the material."""
    even = accumulated(column(np.full(12, 0.3)), EVEN, column(np.full(12, 0.2)), worn_by(0.037))
    assert even == approx(column(np.full(12, 0.5)), rel=1e-12)
    deep = 0.1 * (np.arange(60) + 0.5)
    for steps in (1, 10, 100):
        lone = column(np.eye(60)[50])
        for _ in range(steps):
            lone = worn_away(lone, deep, worn_by(0.37 / steps))
        assert lone.sum() == approx(1.0, rel=1e-12)
        centre = float((lone[:, 0, 0] * deep).sum())
        assert centre == approx(deep[50] - 0.37, abs=0.025)  # a quarter of a layer
        assert np.sqrt((lone[:, 0, 0] * (deep - centre) ** 2).sum()) < 0.13


def worn_steadily(rate, depths, speed, time, steps):
    damage, gained = np.zeros((depths.size, 1, 1)), column([rate(z) for z in depths]) * (time / steps)
    for _ in range(steps):
        damage = accumulated(damage, depths, gained, worn_by(speed * time / steps))
    return damage[:, 0, 0]


@pytest.mark.parametrize("steps", [60, 600])
def test_under_steady_wear_damage_settles_at_the_integral_of_its_rate_over_the_depth(steps):
    """D(0) = integral of d dz / w; the mean of the first layer is below that at the surface itself."""
    w, scale = 0.5, 0.2
    errors = []
    for count in (12, 24, 48):
        depths = np.concatenate(([0.0], np.geomspace(0.02, 2.0, count - 1)))
        first = faces_of(depths)[1]
        exact = scale / w * means(lambda z: np.exp(-z / scale), np.array([0.0, first]))[0]
        errors.append(worn_steadily(lambda z: np.exp(-z / scale), depths, w, 8.0, steps)[0] / exact - 1.0)
    assert abs(errors[0]) < 0.05
    assert abs(errors[1]) < 0.012
    assert abs(errors[2]) < 0.004


@pytest.mark.parametrize("time", [0.1, 0.4, 1.0])
def test_damage_on_the_way_is_the_integral_over_the_way_of_the_material(time):
    w, scale = 1.0, 0.2
    found = worn_steadily(lambda z: np.exp(-z / scale), GRADED, w, time, 25)

    def exact(z):
        return scale / w * np.exp(-z / scale) * (1.0 - np.exp(-w * time / scale))

    expected = means(exact, faces_of(GRADED))
    assert np.abs(found - expected).max() < 0.025 * expected.max()


def test_a_step_cut_into_pieces_changes_the_damage_by_less_than_the_layers_blur_it():
    """At most by the change of damage from layer to layer; here of a smooth one by 2 %."""
    damage = column(np.exp(-GRADED / 0.2))
    gained = column(0.5 * np.exp(-GRADED / 0.3))
    at_once = accumulated(damage, GRADED, gained, worn_by(0.2))
    for pieces in (2, 7, 50):
        found = damage
        for _ in range(pieces):
            found = accumulated(found, GRADED, gained / pieces, worn_by(0.2 / pieces))
        assert np.abs(found - at_once).max() < 0.02 * at_once.max()


def test_all_above_the_deepest_failed_layer_breaks_out():
    damage = np.zeros((12, 1, 3))
    damage[:, 0, 0] = np.linspace(0.9, 0.1, 12)  # nothing
    damage[2, 0, 1] = damage[4, 0, 1] = 1.0  # down to the lower face of the fifth
    damage[5:, 0, 1] = np.linspace(0.7, 0.1, 7)
    damage[0, 0, 2], damage[1:, 0, 2] = 3.0, 0.999
    depth, after = pits_of(damage, EVEN)
    assert depth[0] == approx([0.0, 0.5, 0.1], rel=1e-12, abs=1e-15)
    assert np.array_equal(after[:, 0, 0], damage[:, 0, 0])
    assert after[:7, 0, 1] == approx(damage[5:, 0, 1], rel=1e-12)
    assert np.all(after < 1.0)
    assert not pits_of(after, EVEN)[0].any()


def test_what_breaks_out_to_the_last_layer_leaves_new_material():
    damage = column(np.full(12, 1.5))
    depth, after = pits_of(damage, EVEN)
    assert depth == approx(1.2, rel=1e-12)
    assert not after.any()


def test_pits_leave_nothing_failed_in_graded_layers():
    rng = np.random.default_rng(6)
    damage = 1.3 * rng.random((16, 30, 30))
    depth, after = pits_of(damage, GRADED)
    assert np.all(after < 1.0)
    assert np.all((depth > 0.0) == np.any(damage >= 1.0, axis=0))


@pytest.mark.parametrize("removed", [-1e-9, np.nan, np.inf])
def test_a_surface_is_lowered_by_a_number_that_is_not_negative(removed):
    with pytest.raises(ContactError, match="finite and 0 or more"):
        worn_away(np.zeros((12, 1, 1)), EVEN, worn_by(removed))
