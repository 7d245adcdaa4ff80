"""Measured images for scenes: form, gaps and waves, and the roughness below the patch."""

from pathlib import Path

import numpy as np
import pytest
from comparison import approx

from contact_core import Scene
from contact_core.errors import ContactError
from system_models.instruments.image import HeightImage
from system_models.instruments.patch import patch_of, without_form
from system_models.instruments.surface_set import write

STEP = 0.5e-6


def waves(*lengths: float, n: int = 128, height: float = 10e-9) -> np.ndarray:
    """Cosines along x, each an even half wave of the image."""
    x = (np.arange(n) + 0.5) * STEP
    return np.tile(sum(height * np.cos(2.0 * np.pi * x / length) for length in lengths), (n, 1))


def image(z: np.ndarray) -> HeightImage:
    return HeightImage(z, (STEP, STEP), "made.x3p", "0" * 64)


def rough(exponent: float, n: int = 128) -> np.ndarray:
    k = np.hypot(*np.meshgrid(np.fft.fftfreq(n), np.fft.rfftfreq(n), indexing="ij"))
    k[0, 0] = np.inf
    z = np.fft.irfft2(np.maximum(k, 0.02) ** -exponent * np.fft.rfft2(np.random.default_rng(3).normal(size=(n, n))))
    return 50e-9 * z / z.std()


def test_the_form_of_a_ball_is_found_and_removed_without_the_waves() -> None:
    x = (np.arange(128) + 0.5) * STEP - 32e-6
    ball = -(x[None] ** 2) / 2 / 9.5e-3 - x[:, None] ** 2 / 2 / 12e-3 + 2e-3 * x[None] + 3e-7
    rest, removed = without_form(image(ball + waves(4e-6)), "curvature")
    assert removed.radius == approx((9.5e-3, 12e-3), rel=0.02)
    assert removed.slope == approx((2e-3, 0.0), rel=0.01, abs=1e-6)
    assert np.std(rest - waves(4e-6)) < 2e-10
    plane, left = without_form(image(ball), "plane")
    assert left.slope[0] == approx(2e-3, rel=1e-6)
    assert np.ptp(plane) > 3e-8


def test_gaps_follow_their_surroundings_and_do_not_count_for_the_form() -> None:
    x = np.arange(64) * STEP
    z = np.tile(3e-3 * x, (64, 1))
    holed = z.copy()
    holed[20:30, 40:50] = np.nan
    found = patch_of(image(holed), "none", None, None)
    assert found.missing == approx(100 / 64**2, rel=1e-12)
    assert found.heights == approx(z - z.mean(), abs=1e-11)


@pytest.mark.parametrize(
    ("longest", "shortest", "left"), [(None, 3e-6, (32e-6, 4e-6)), (8e-6, 3e-6, (4e-6,)), (8e-6, None, (4e-6, 2e-6))]
)
def test_waves_beyond_the_cuts_go_and_the_others_stay_whole(
    longest: float, shortest: float, left: tuple[float, ...]
) -> None:
    found = patch_of(image(waves(32e-6, 4e-6, 2e-6)), "none", longest, shortest)
    assert found.spacing == approx(0.5 * shortest if shortest else STEP, rel=1e-12)
    count = found.heights.shape[1]
    x = 0.5 * (64e-6 - count * found.spacing) + (np.arange(count) + 0.5) * found.spacing
    exact = sum(10e-9 * np.cos(2.0 * np.pi * x / length) for length in left)
    assert found.heights == approx(np.tile(exact, (found.heights.shape[0], 1)), abs=1e-15)


def test_patch_and_roughness_below_it_share_the_variance() -> None:
    found = patch_of(image(rough(1.8)), "plane", None, 4e-6)
    whole, kept = (z.Sq for z in list(found.stages.values())[1:])
    assert found.below.rms is not None
    corners = patch_of(image(rough(1.8)), "plane", None, None, 1e-6).stages["in the patch"].Sq
    assert corners == approx(whole, rel=1e-9)
    assert kept**2 + found.below.rms**2 == approx(whole**2, rel=2e-3)  # but waves below two points, in the diagonals
    assert found.below.longest == 4e-6


def test_noise_is_not_told_as_roughness() -> None:
    found = patch_of(image(rough(0.0)), "plane", None, 4e-6)
    assert found.below.rms is None
    assert "noise" in found.below.why


def test_an_image_that_resolves_too_little_gives_no_roughness_below() -> None:
    assert patch_of(image(rough(1.8)), "plane", None, 3e-6).below.rms is None
    assert patch_of(image(rough(1.8)), "plane", None, 4e-6, resolution=1.5e-6).below.rms is None


@pytest.mark.parametrize(
    ("longest", "shortest", "said"),
    [(None, 0.5e-6, "shows waves down to 1 um"), (2e-6, 4e-6, "not above the shortest"), (1e-6, None, "not above")],
)
def test_impossible_cuts_are_refused(longest: float | None, shortest: float | None, said: str) -> None:
    with pytest.raises(ContactError, match=said):
        patch_of(image(rough(1.8)), "plane", longest, shortest)


def test_an_image_with_many_gaps_is_refused() -> None:
    z = rough(1.8)
    z[:64, :70] = np.nan
    with pytest.raises(ContactError, match="Choose a --window"):
        patch_of(image(z), "plane", None, None)
    assert image(z).window((40e-6, 64e-6), (0.0, 32e-6)).missing == 0.0
    with pytest.raises(ContactError, match="0 to 64 um"):
        image(z).window((40e-6, 70e-6), (0.0, 32e-6))


def test_rectangular_points_become_a_square_lattice() -> None:
    z = np.tile(waves(8e-6)[0, ::2], (128, 1))  # points twice as far apart along x
    found = patch_of(HeightImage(z, (STEP, 2 * STEP), "made"), "none", None, None)
    assert found.heights.shape == (64, 64)
    assert found.spacing == approx(2 * STEP, rel=1e-12)
    assert image(waves(8e-6)).turned().heights[:, 3] == approx(waves(8e-6)[0], rel=1e-12)


def test_a_scene_takes_the_set_from_any_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "sets").mkdir()
    whole = image(rough(1.8))
    found = patch_of(whole, "plane", None, 4e-6)
    write("disc_1", tmp_path / "sets", whole, found)
    monkeypatch.chdir(tmp_path)
    surface = Scene.from_toml("mtm_zddp", {"surface_2.set": "sets/disc_1.toml:disc_1"}).surface_2
    assert surface.heights is not None and surface.microroughness is not None
    assert surface.heights.values == approx(found.heights, rel=1e-12)
    assert surface.heights.spacing == approx(2e-6, rel=1e-12)
    assert surface.microroughness.rms == approx(found.below.rms, rel=1e-3)
    assert surface.rq == 0.0


@pytest.mark.parametrize("mark", [1e30, -1e30, 3.4e38, -9.0, np.inf])
def test_heights_that_stand_for_none_are_gaps(mark: float) -> None:
    z = waves(4e-6)
    marked = z.copy()
    marked[20:24, 40:44] = mark
    found = patch_of(image(marked).without_marks(), "none", None, None)
    assert found.missing == approx(16 / 128**2, rel=1e-12)
    assert np.ptp(found.heights) == approx(np.ptp(z), rel=1e-6)
    assert image(z).without_marks().missing == 0.0


@pytest.mark.parametrize(
    ("height", "step", "said"),
    [
        (1e-14, STEP, r"rms height of 'made.x3p' is 1e-14 m; 2e-10 to 0\.0001 m is plausible"),
        (1.0, 1.0, "rms height of 'made.x3p' is 1 m"),
        (1e-6, 1e-8, "rms slope of 'made.x3p' is"),
        (1e-5, 2e-3, r"distance of neighbours of 'made.x3p' is 0.002 m; above 0, up to 0\.001 m is plausible"),
    ],
)
def test_a_surface_of_impossible_size_is_refused_before_a_scene_does(height: float, step: float, said: str) -> None:
    z = waves(4e-6, height=np.sqrt(2.0) * height)
    with pytest.raises(ContactError, match=said):
        patch_of(HeightImage(z, (step, step), "made.x3p"), "none", None, None)
