"""The solver of `tests/periodic_contact.py` against closed forms, and the spectra of its surfaces."""

import numpy as np
import pytest
from comparison import approx
from periodic_contact import Band, PeriodicPlane, press

NODES = 128
WAVE = np.cos(2.0 * np.pi * np.arange(NODES) / NODES)


def westergaard(mean: float) -> tuple[float, float]:
    """Return contact share and mean gap of a wave cos x under a mean pressure below that of full contact, 1/2.

    2 a / lambda = (2 / pi) asin (p / p*)^(1/2), p* = pi E* amplitude / lambda (Johnson, Contact Mechanics, 1985,
    doi:10.1017/CBO9781139171731, section 13.2). The gap integrates the compliance of a row of cracks,
    d gap / dp = (amplitude / p*) ln(p / p*), from the amplitude at first touch.
    """
    ratio = mean / 0.5
    return 2.0 / np.pi * float(np.arcsin(np.sqrt(ratio))), 1.0 - ratio + ratio * float(np.log(ratio))


def light_eggbox(mean: float) -> float:
    """Return the contact share of cos x cos y under a small mean pressure: Hertz's contact at each crest.

    pi (3 p / (8 pi p*))^(2/3), p* = 2^(1/2) / 2 here (Johnson, Greenwood & Higginson, Int. J. Mech. Sci. 27 (1985) 383,
    doi:10.1016/0020-7403(85)90029-3).
    """
    return float(np.pi * (3.0 * mean / (8.0 * np.pi * np.sqrt(0.5))) ** (2.0 / 3.0))


def test_a_wave_touches_and_opens_as_westergaard_says():
    for found in press(PeriodicPlane(NODES, 1), np.tile(WAVE, (NODES, 1)), (0.02, 0.1, 0.25, 0.4)):
        area, gap = westergaard(found.pressure)
        assert found.gap == approx(gap, abs=3e-4)
        assert found.area == approx(area, abs=2.0 / NODES)


def test_westergaards_gap_is_the_integral_of_his_profile():
    """By the displacements of his pressure, from a sum over its waves; no step is that of `westergaard`."""
    ratio, n = 0.3, 4096
    x = np.pi * (np.arange(n) + 0.5) / n  # half a wave
    half = np.arcsin(np.sqrt(ratio))  # contact ends at x / 2 = half
    inside = np.maximum(np.sin(half) ** 2 - np.sin(0.5 * x) ** 2, 0.0)
    pressure = 2.0 * 0.5 * ratio / np.sin(half) ** 2 * np.cos(0.5 * x) * np.sqrt(inside)
    assert pressure.mean() == approx(0.5 * ratio, rel=1e-3)
    k = np.arange(1, 600)
    waves = 2.0 / n * np.cos(np.outer(k, x)) @ pressure
    gap = np.cos(np.outer(x, k)) @ (2.0 * waves / k) - np.cos(x)
    assert (gap - gap[0]).mean() == approx(westergaard(0.5 * ratio)[1], abs=2e-3)


def test_light_contact_of_two_crossed_waves_is_hertz_and_heavy_contact_is_full():
    eggbox = WAVE[:, None] * WAVE
    light, below, above = press(PeriodicPlane(NODES, 1), eggbox, (0.002, 0.69, 0.7072))
    assert light.area == approx(light_eggbox(0.002), rel=0.06)
    assert below.area < 1.0
    assert above.area == 1.0
    assert above.gap == approx(0.0, abs=1e-12)


def test_a_soft_body_bears_its_hardness_where_it_touches():
    """Rigid roughness sinks into it as far as its material ratio says: less than 0.02 rms heights from Gauss's."""
    band = Band(4)
    (found,) = press(PeriodicPlane(128, band.longest), band.heights(128, 3), (0.001,), 0.01)
    assert found.area == approx(0.1, rel=0.05)
    assert found.planes == approx(1.2816, abs=0.03)


@pytest.mark.parametrize("band", [Band(4), Band(4, 0.8), pytest.param(Band(16, 0.8), marks=pytest.mark.long)])
def test_a_surface_has_the_rms_height_and_slope_of_its_spectrum_on_every_grid(band):
    nodes = 4 * band.breadth * band.longest
    heights = band.heights(nodes, 5)
    assert heights.std() == approx(1.0, rel=1e-12)
    assert band.heights(2 * nodes, 5)[::2, ::2] == approx(heights, abs=1e-12)
    waves = np.fft.fftfreq(nodes, 1.0 / nodes) / band.longest
    by_x = np.fft.ifft(1j * waves * np.fft.fft(heights, axis=1), axis=1).real
    by_y = np.fft.ifft(1j * waves[:, None] * np.fft.fft(heights, axis=0), axis=0).real
    assert np.sqrt((by_x**2 + by_y**2).mean()) == approx(band.slope, rel=0.05)
