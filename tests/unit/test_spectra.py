"""Spectra in metres: self-affine roughness, and lay."""

from dataclasses import replace

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import quad
from scipy.signal import periodogram

from contact_core import Scene, SceneError
from contact_core.scene import SelfAffine, Surface
from contact_core.surfaces.patches import bare_heights
from contact_core.surfaces.roughness import generate

DOMAIN = 0.5e-3
RQ = 100e-9
ROUGH = SelfAffine(rq=RQ, hurst=0.8, roll_off=DOMAIN / 8, cut_off=DOMAIN / 128, seed=1)
SELF_AFFINE = {
    "surface_2.model": "self_affine",
    "surface_2.hurst": "0.8",
    "surface_2.roll_off": "60 um",
    "surface_2.cut_off": "8 um",
}


def patch(surface, points: int, rows: int | None = None) -> np.ndarray:
    """One period of a surface."""
    return generate(surface, points, DOMAIN, 1, rows)[:-1]


def profile_power(q: float, surface: SelfAffine) -> float:
    """One-sided power of profiles at the spatial frequency q [1/m], up to a factor: the spectrum of
    Jacobs, Junge & Pastewka 2017, summed over the wave numbers across."""
    low, high = 1.0 / surface.roll_off, 1.0 / surface.cut_off

    def spectrum(across: float) -> float:
        return max(np.hypot(q, across), low) ** (-2.0 - 2.0 * surface.hurst)

    return quad(spectrum, 0.0, np.sqrt(high**2 - q**2), limit=200)[0]


@pytest.mark.parametrize("hurst", [0.3, 0.8, 1.0])
@pytest.mark.parametrize("axis", [0, 1], ids=["across", "along"])
def test_the_periodogram_of_profiles_has_the_spectrum_asked_for(hurst, axis):
    """512 profiles that are not independent: the scatter of a mean over 8 frequencies is about 5 %."""
    surface = replace(ROUGH, hurst=hurst)
    heights = patch(surface, 513)
    frequency, power = periodogram(heights, fs=512 / DOMAIN, axis=axis, detrend=False)
    power = power.mean(axis=1 - axis)
    blocks = [slice(i, i + 8) for i in (1, 9, 17, 33, 65, 97)]  # in wave numbers of the patch
    found = np.array([power[block].mean() for block in blocks])
    expected = np.array([np.mean([profile_power(q, surface) for q in frequency[block]]) for block in blocks])
    assert found / found.sum() == approx(expected / expected.sum(), rel=0.25)
    middle = slice(12, 50)  # between roll-off and cut-off
    fitted = np.polyfit(np.log(frequency[middle]), np.log(power[middle]), 1)[0]
    exact = np.polyfit(np.log(frequency[middle]), np.log([profile_power(q, surface) for q in frequency[middle]]), 1)[0]
    assert fitted == approx(exact, abs=0.12)
    assert fitted == approx(-1.0 - 2.0 * hurst, abs=0.35)  # of an endless power law
    assert np.sum(power) * frequency[1] == approx(RQ**2, rel=1e-9)  # Parseval
    assert power[129:].max() < 1e-12 * power.max()  # nothing beyond the cut-off


def test_a_self_affine_surface_has_exactly_its_rms_roughness_and_no_mean():
    heights = patch(ROUGH, 257 + 16)
    assert np.std(heights) == approx(RQ, rel=1e-12)
    assert abs(heights.mean()) < 1e-12 * RQ


@pytest.mark.parametrize(("hurst", "cut"), [(0.3, 64), (0.8, 64), (1.0, 64), (0.8, 128)])
def test_the_rms_slope_is_that_of_the_spectrum(hurst, cut):
    """The scatter of the roll-off's few waves is some per cent."""
    surface = replace(ROUGH, hurst=hurst, cut_off=DOMAIN / cut, roll_off=DOMAIN / 16)
    heights = np.fft.fft2(patch(surface, 513))
    waves = 2.0 * np.pi * np.fft.fftfreq(512, DOMAIN / 512)
    gradient_2 = np.sum(np.abs(heights) ** 2 * (waves[:, None] ** 2 + waves[None, :] ** 2)) / 512**4
    assert surface.slope == approx(np.sqrt(gradient_2), rel=0.05)
    assert surface.length == approx(2.0 * RQ / surface.slope, rel=1e-12)


def test_the_grid_that_carries_all_waves_shows_them_on_every_finer_one():
    heights = [patch(replace(ROUGH, cut_off=DOMAIN / 30), points) for points in (65, 129, 257)]
    assert np.abs(heights[1][::2, ::2] - heights[0]).max() < 1e-12 * RQ
    assert np.abs(heights[2][::4, ::4] - heights[0]).max() < 1e-12 * RQ


@pytest.mark.parametrize("coarse", [65, 129])
def test_a_finer_grid_adds_waves_and_changes_none(coarse):
    kept = np.r_[0 : (coarse - 1) // 2, -((coarse - 1) // 2 - 1) : 0]
    one, two = (np.fft.fft2(patch(ROUGH, points), norm="forward") for points in (coarse, 257))
    assert np.abs(one[np.ix_(kept, kept)] - two[np.ix_(kept, kept)]).max() < 1e-12 * RQ


def test_a_longer_band_keeps_the_phases_of_its_waves():
    one, two = (np.fft.fft2(patch(s, 257)) for s in (ROUGH, replace(ROUGH, cut_off=DOMAIN / 64)))
    ratio = two[1:40, 1:30] / one[1:40, 1:30]
    assert ratio.real == approx(np.full(ratio.shape, ratio[0, 0].real), rel=1e-9)
    assert np.abs(ratio.imag).max() < 1e-9


def correlation_length(heights: np.ndarray, axis: int) -> float:
    """Distance [m] at which the autocorrelation falls to exp(-1)."""
    power = np.abs(np.fft.fft2(heights)) ** 2
    curve = np.fft.ifft2(power).real
    curve = np.take(curve, 0, axis=1 - axis) / curve[0, 0]
    after = int(np.argmax(curve < np.exp(-1.0)))
    part = (curve[after - 1] - np.exp(-1.0)) / (curve[after - 1] - curve[after])
    return (after - 1 + part) * DOMAIN / 512


@pytest.mark.parametrize(("along", "across"), [(20e-6, 5e-6), (5e-6, 20e-6), (12e-6, 8e-6)])
def test_lay_has_its_correlation_lengths_along_and_across(along, across):
    """Of 400 to 1000 correlation areas: 5 % scatter."""
    heights = patch(Surface(RQ, along, 3, correlation_length_across=across), 513)
    assert correlation_length(heights, 1) == approx(along, rel=0.08)
    assert correlation_length(heights, 0) == approx(across, rel=0.08)
    assert np.std(heights) == approx(RQ, rel=1e-12)


def test_lay_is_the_same_on_every_grid():
    surface = Surface(RQ, 60e-6, 3, correlation_length_across=30e-6)
    coarse, fine = patch(surface, 65), patch(surface, 257)
    assert np.abs(fine[::4, ::4] - coarse).max() < 1e-12 * RQ


def test_the_rms_slope_of_lay_is_that_of_both_directions():
    surface = Surface(RQ, 20e-6, 3, correlation_length_across=10e-6)
    steps = [np.diff(patch(surface, 1025), axis=axis) for axis in (0, 1)]
    found = np.sqrt(sum(np.mean(step**2) for step in steps)) / (DOMAIN / 1024)
    assert surface.slope == approx(found, rel=0.03)


def test_equal_lengths_are_no_lay():
    plain, given = (Surface(RQ, 20e-6, 3, correlation_length_across=across) for across in (None, 20e-6))
    assert np.array_equal(patch(plain, 129), patch(given, 129))
    assert plain.length == given.length == 20e-6
    assert plain.slope == given.slope == approx(2.0 * RQ / 20e-6, rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"roll_off": "0.4 mm"}, r"surface_2\.roll_off = 0\.0004 m is too long .* Use at most 0\.00025 m"),
        ({"roll_off": "10 um"}, r"surface_2\.roll_off = 1e-05 m is 2\.56 nodes .* film\.points = 201 or more"),
        ({"cut_off": "60 um"}, r"cut_off = 6e-05 m must be below roll_off = 6e-05 m"),
        ({"cut_off": "10 nm"}, r"cut_off = 1e-08 m is too short .* Use at least 2\.44e-07 m"),
        ({"hurst": "1.2"}, r"surface_2\.hurst = 1\.2 \(Hurst exponent\) must be above 0 and at most 1"),
        ({"correlation_length": "8 um"}, r"no key 'correlation_length'. It belongs to model = 'gaussian'"),
    ],
)
def test_a_spectrum_that_cannot_be_is_refused_with_a_way_out(changes, said):
    with pytest.raises(SceneError, match=said):
        Scene.from_toml("azam_case_a", SELF_AFFINE | {f"surface_2.{key}": value for key, value in changes.items()})


@pytest.mark.parametrize(
    ("length", "said"),
    [("0.2 mm", r"correlation_length_across = 0\.0002 m is too long"), ("1 um", r"across = 1e-06 m is 0\.26 nodes")],
)
def test_lay_that_does_not_fit_is_refused(length, said):
    with pytest.raises(SceneError, match=said):
        Scene.from_toml("azam_case_a", {"surface_2.correlation_length_across": length})


def test_waves_that_a_grid_cuts_are_told():
    scene = Scene.from_toml("azam_case_a", SELF_AFFINE)
    assert not [text for text in scene.warnings() if "surface_2" in text]  # 8 um are 2.05 nodes
    (told,) = Scene.from_toml("azam_case_a", SELF_AFFINE | {"surface_2.cut_off": "1 um"}).warnings()
    assert told.startswith("surface_2 has waves down to 1e-06 m; the grid shows those above 7.8125e-06 m, 99 % of")


@pytest.mark.parametrize("changes", [SELF_AFFINE, {"surface_2.correlation_length_across": "16 um"}])
def test_surfaces_beyond_the_fitted_curves_are_told_at_their_level(changes):
    told = "surface_2 is taken for Gaussian roughness without lay by film.model = 'regression'"
    scene = Scene.from_toml("azam_case_a", changes)
    assert not [text for text in scene.warnings() if told in text]
    assert [text for text in scene.at_level("regression").warnings() if told in text]
    assert not Scene.from_toml("azam_case_a").at_level("regression").warnings()


def test_a_self_affine_scene_is_read_written_and_realised_like_any_other():
    scene = Scene.from_toml("azam_case_a", SELF_AFFINE)
    assert Scene.from_dict(scene.to_dict()) == scene
    assert scene.to_dict()["surface_2"]["model"] == "self_affine"
    assert "model" not in scene.to_dict()["surface_1"]
    assert scene.surface_2.rq == 127e-9  # kept from the Gaussian surface
    one, two = bare_heights(scene, scene.rows)[1], bare_heights(scene.realisation(2), scene.rows)[1]
    assert np.std(one) == approx(np.std(two), rel=0.05)
    assert abs(np.corrcoef(one.ravel(), two.ravel())[0, 1]) < 0.2


def test_a_coarse_grid_for_warming_up_asks_for_no_waves_that_it_cannot_show():
    rough = replace(ROUGH, cut_off=1e-6).coarsened(20e-6)
    assert (rough.cut_off, rough.roll_off) == (40e-6, ROUGH.roll_off)
    lay = Surface(RQ, 30e-6, 1, correlation_length_across=5e-6).coarsened(20e-6)
    assert (lay.correlation_length, lay.correlation_length_across) == (30e-6, 20e-6)
