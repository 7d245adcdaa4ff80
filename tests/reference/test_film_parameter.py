"""Peaks of a scene's surfaces, rigid and under oil, and the speed at which the film parameter is 1."""

import numpy as np
import pytest
from comparison import approx

from benchmarks.surfaces.film_parameter import Peaks, films, speed_of_one
from benchmarks.surfaces.transition import crossing
from contact_core import Scene
from contact_core.surfaces.patches import bare_heights

GAUSSIAN = 0.937  # Spk over the rms height, tests/reference/test_reduced_peak_height.py


def contact(name: str = "azam_case_a", **changes: str) -> Scene:
    return Scene.from_toml(
        name, {"film.points": "65"} | {key.replace("__", "."): text for key, text in changes.items()}
    )


@pytest.mark.parametrize("name", ["azam_case_a", "fzg_flank"])
def test_peaks_of_shipped_surfaces_are_those_of_gaussian_ones_of_the_same_rms(name: str) -> None:
    scene = contact(name)
    layers = [surface.microroughness.rms for surface in (scene.surface_1, scene.surface_2) if surface.microroughness]
    on_grid = [z[: scene.period].std() for z in bare_heights(scene, scene.period)]
    rms = np.linalg.norm([*on_grid, *layers])
    assert Peaks(scene).rigid == approx(GAUSSIAN * rms, rel=0.08)  # of some hundred correlation areas


def test_oil_flattens_long_waves_more_than_short_ones() -> None:
    left = []
    for length in ("8 um", "16 um", "64 um"):
        peaks = Peaks(contact(surface_1__correlation_length=length, surface_2__correlation_length=length))
        left.append(peaks.deformed(8.0) / peaks.rigid)
    assert 1.0 > left[0] > left[1] > left[2] > 0.0


def test_oil_flattens_less_at_higher_speed() -> None:
    peaks = Peaks(contact())
    left = [peaks.deformed(speed) / peaks.rigid for speed in (0.1, 1.0, 10.0)]
    assert left == sorted(left)
    assert left[0] < 0.7 * left[-1]


def test_microroughness_is_not_flattened() -> None:
    peaks = Peaks(contact(surface_1__rq="0 nm", surface_2__rq="0 nm"))
    assert peaks.deformed(0.01) == approx(peaks.rigid, rel=1e-6)
    assert peaks.rigid == approx(GAUSSIAN * np.hypot(4e-9, 16e-9), rel=0.02)


@pytest.mark.parametrize("name", ["azam_case_a", pytest.param("fzg_flank", marks=pytest.mark.long)])
@pytest.mark.parametrize("deformed", [False, pytest.param(True, marks=pytest.mark.long)])
def test_the_minimum_film_is_as_high_as_the_peaks_at_the_speed_of_one(name: str, deformed: bool) -> None:
    scene = contact(name)
    peaks = Peaks(scene)
    speed = speed_of_one(scene, peaks, deformed=deformed)
    assert films(scene, speed)[1] == approx(peaks.deformed(speed) if deformed else peaks.rigid, rel=5e-3)


@pytest.mark.parametrize("guess", [0.2, 3.0, 50.0])
def test_the_speed_is_found_at_which_the_solids_share_falls_to_a_level(guess: float) -> None:
    assert crossing(lambda speed: min(1.0, 0.01 * (speed / 3.0) ** -3.5), 0.01, guess) == approx(3.0, rel=1e-6)


def test_a_share_that_ends_at_once_is_found_within_the_last_two_speeds() -> None:
    assert crossing(lambda speed: 0.4 if speed < 5.0 else 0.0, 0.01, 1.0) == approx(5.0, rel=0.1)
