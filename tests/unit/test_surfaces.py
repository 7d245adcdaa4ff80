import numpy as np
import pytest
from comparison import approx
from scipy.special import erf
from scipy.stats import kurtosis, skew

from contact_core import Scene, SceneError
from contact_core.scene import Surface
from contact_core.surfaces.roughness import generate, groove_free, rms_roughness

DOMAIN = 0.5e-3
ALL = slice(None)


def patch(points: int, length: float = 40e-6, seed: int = 1, body: int = 1, rq: float = 127e-9) -> np.ndarray:
    """One period of a surface, [points - 1, points - 1]."""
    return generate(Surface(rq, length, seed), points, DOMAIN, body)[:-1]


@pytest.mark.parametrize("points", [64, 65, 66, 130, 257])
def test_a_patch_repeats_along_both_axes_and_has_one_row_more_than_columns(points):
    heights = generate(Surface(127e-9, 40e-6, 1), points, DOMAIN, 1)
    assert heights.shape == (points, points - 1)
    assert np.array_equal(heights[0], heights[-1])
    steps = np.abs(np.diff(heights, axis=1)).max()
    assert np.abs(heights[:, 0] - heights[:, -1]).max() <= 1.2 * steps  # no seam


@pytest.mark.parametrize(("rq", "length", "points"), [(127e-9, 40e-6, 65), (12e-9, 8e-6, 257), (1e-6, 60e-6, 130)])
def test_a_resolved_surface_has_exactly_its_rms_roughness_and_no_mean(rq, length, points):
    heights = patch(points, length, rq=rq)
    assert rms_roughness(heights, ALL) == approx(rq, rel=1e-12, abs=0.0)
    assert abs(heights.mean()) < 1e-12 * rq


@pytest.mark.parametrize("rows", [512, 1280, 300], ids=["square", "longer across", "shorter across"])
def test_the_autocorrelation_is_gaussian_with_the_correlation_length_in_every_direction(rows):
    length = 4.0 * DOMAIN / 512.0  # 75 correlation lengths per side or more: the sampling scatter is below 2 %
    heights = generate(Surface(127e-9, length, 1), 513, DOMAIN, 1, rows)[:-1]
    correlation = np.fft.irfft2(np.abs(np.fft.rfft2(heights)) ** 2)
    correlation /= correlation[0, 0]
    for nodes in (1, 2, 4, 6, 8):
        expected = np.exp(-((nodes / 4.0) ** 2))
        assert correlation[0, nodes] == approx(expected, abs=0.02)
        assert correlation[nodes, 0] == approx(expected, abs=0.02)
        assert correlation[nodes, nodes] == approx(expected**2, abs=0.02)


def test_heights_are_gaussian():
    heights = patch(513, 4.0 * DOMAIN / 512.0).ravel()
    assert abs(skew(heights)) < 0.03
    assert abs(kurtosis(heights)) < 0.06


@pytest.mark.parametrize("points", [65, 129])
def test_a_finer_grid_shows_the_same_surface(points):
    coarse, fine = patch(points), patch(2 * points - 1)
    assert np.abs(fine[::2, ::2] - coarse).max() < 1e-12 * 127e-9


def test_a_grid_of_two_nodes_per_correlation_length_misses_only_the_waves_it_cannot_carry():
    nodes, length = 128, 8e-6
    difference = patch(257, length)[::2, ::2] - patch(129, length)
    share = 1.0 - erf(np.pi * length * nodes / DOMAIN / 2.0) ** 2  # of the power beyond the coarse grid's Nyquist
    assert 0.5 < rms_roughness(difference, ALL) / (127e-9 * np.sqrt(share)) < 2.0
    assert share < 2e-5


def test_waves_beyond_the_grid_are_left_out_and_not_folded_back():
    length = DOMAIN / 64.0  # one node per correlation length on the coarse grid
    coarse, fine = np.fft.fft2(patch(65, length)), np.fft.fft2(patch(257, length))
    kept = np.r_[0:32, -31:0]
    ratio = 256.0**2 / 64.0**2
    assert np.allclose(
        coarse[np.ix_(kept, kept)] * ratio,
        fine[np.ix_(kept, kept)],
        rtol=0.0,
        atol=1e-10 * np.abs(fine).max(),
    )
    assert np.abs(coarse[32]).max() < 1e-12 * np.abs(coarse).max()
    assert rms_roughness(patch(65, length), ALL) / 127e-9 == approx(erf(np.pi / 2.0), abs=0.01)


def test_a_surface_depends_on_nothing_but_its_numbers():
    first = patch(129, seed=5)
    patch(65, seed=6)
    np.random.default_rng(0).normal(size=10)
    assert np.array_equal(patch(129, seed=5), first)


def test_the_bodies_of_all_realisations_are_independent_of_each_other():
    """The standard deviation of independent patches is 0.02: 0.1 is far out for the largest of 66 pairs."""
    scenes = [Scene.from_toml("mtm_zddp").realisation(seed) for seed in range(6)]
    surfaces = [(1, scene.surface_1) for scene in scenes] + [(2, scene.surface_2) for scene in scenes]
    heights = [generate(surface, 129, DOMAIN, body)[:-1].ravel() for body, surface in surfaces]
    assert np.abs(np.corrcoef(heights) - np.eye(len(heights))).max() < 0.1


@pytest.mark.parametrize("other", [{"seed": 2}, {"body": 2}, {"seed": 2**31 - 1}])
def test_another_seed_or_body_has_an_independent_surface(other):
    one, two = patch(129, 8e-6), patch(129, 8e-6, **other)
    assert abs(np.mean(one * two)) < 0.06 * 127e-9**2  # standard deviation of independent patches: 0.02


def test_the_surface_of_a_seed_stays_what_it_was():
    heights = patch(65)
    found = [heights[0, 0], heights[10, 20], heights[40, 63]]
    assert found == approx([3.413327291914e-08, 1.694963207489e-07, 3.408913102427e-08], rel=1e-9, abs=0.0)


def test_no_roughness_gives_zeros():
    heights = generate(Surface(0.0, 8e-6, 1), 65, DOMAIN, 1)
    assert heights.shape == (65, 64)
    assert not heights.any()


def test_a_correlation_length_beyond_the_domain_is_refused_with_a_way_out():
    with pytest.raises(SceneError, match=r"correlation_length = 0\.001 m is too long .* rq = 0 for a smooth surface"):
        patch(65, 1e-3)


def test_a_groove_leaves_the_roughness_free_of_it():
    heights = patch(65)
    groove = 1e-6 * np.exp(-(np.linspace(-3.0, 3.0, 64) ** 2))[:, None]
    assert np.allclose(groove_free(heights - groove), groove_free(heights), rtol=0.0, atol=1e-19)
    assert rms_roughness(heights - groove, ALL) > 2.0 * rms_roughness(groove_free(heights - groove), ALL)


def test_roughness_is_taken_over_the_rows_asked_for():
    heights = np.array([[1.0, 3.0], [10.0, 10.0], [5.0, 7.0]])
    assert rms_roughness(heights, slice(0, 1)) == 1.0
    assert rms_roughness(heights, np.array([True, False, True])) == approx(np.sqrt(5.0), rel=1e-15)
