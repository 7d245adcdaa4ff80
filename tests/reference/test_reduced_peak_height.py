"""Spk of surfaces whose bearing curves are known in closed form."""

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import quad
from scipy.stats import norm

from benchmarks.surfaces.peaks import BearingCurve

NODES = (np.arange(20000) + 0.5) / 20000


def gaussian_peaks() -> float:
    """Return Spk of a Gaussian surface over its rms height, by quadrature: the secant is at 30-70 %."""
    top = norm.isf(0.3) + 0.3 * (norm.isf(0.3) - norm.isf(0.7)) / 0.4
    return 2.0 * quad(norm.sf, top, np.inf)[0] / norm.sf(top)


def test_gaussian_heights_have_the_reduced_peak_height_of_the_integral() -> None:
    heights = 1e-7 * norm.ppf(NODES)
    assert BearingCurve.of(heights).reduced_peak_height == approx(1e-7 * gaussian_peaks(), rel=0.01)


def test_exponential_heights_have_twice_their_scale() -> None:
    # least slope from 0 to 40 % of the lowest heights; above the core the rest is an exponential again
    heights = -3e-8 * np.log(NODES)
    assert BearingCurve.of(heights).reduced_peak_height == approx(6e-8, rel=0.01)


def test_evenly_spread_heights_have_no_peaks() -> None:
    assert BearingCurve.of(1e-7 * NODES).reduced_peak_height < 1e-9


def test_the_reduced_peak_height_does_not_depend_on_the_mean_height() -> None:
    heights = 1e-7 * norm.ppf(NODES)
    low, high = (BearingCurve.of(heights + mean).reduced_peak_height for mean in (-1e-6, 1e-6))
    assert low == approx(high, rel=1e-3)


@pytest.mark.parametrize("below", [2e-8, 1e-7])
def test_roughness_below_the_grid_adds_by_squares_to_gaussian_heights(below: float) -> None:
    spk = BearingCurve.of(1e-7 * norm.ppf(NODES[::10]), below).reduced_peak_height
    assert spk == approx(np.hypot(1e-7, below) * gaussian_peaks(), rel=0.02)


def test_two_gaussian_surfaces_add_by_squares() -> None:
    first, second = (BearingCurve.of(rms * norm.ppf(NODES)) for rms in (6e-8, 8e-8))
    assert first.beside(second).reduced_peak_height == approx(1e-7 * gaussian_peaks(), rel=0.01)
