"""The curves of load sharing: limits, order, arrays, and the sweep they were fitted to."""

from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from contact_core.laws.load_sharing import FittedSharing, flattening_of, rms_slope

LAW = FittedSharing()
RATIOS = np.geomspace(1e-4, 1e2, 200)
# a few points of the sweep: `python benchmarks/regression.py fit` writes it
GOLDEN = Path(__file__).parent.parent / "golden" / "load_sharing.csv"


@pytest.fixture(scope="module")
def golden():
    return np.genfromtxt(GOLDEN, delimiter=",", names=True)


@pytest.mark.parametrize("flattening", [0.1, 0.2, 0.7])
@pytest.mark.parametrize("resolution", [1.0, 2.0, 6.0])
def test_solids_carry_all_without_film_and_nothing_under_a_thick_one(flattening, resolution):
    assert LAW.load_ratio(0.0, flattening, resolution) == 1.0
    assert LAW.load_ratio(1e-9, flattening, resolution) > 0.999
    assert LAW.load_ratio(1e4, flattening, resolution) < 1e-12
    assert LAW.load_ratio(np.inf, flattening, resolution) == 0.0


@pytest.mark.parametrize("flattening", [0.1, 0.2, 0.7])
@pytest.mark.parametrize("resolution", [1.0, 2.0, 6.0])
def test_thicker_films_take_load_and_area_from_the_solids_and_part_the_bodies(flattening, resolution):
    share = LAW.load_ratio(RATIOS, flattening, resolution)
    seen = share > 1e-300  # further out exp() has no smaller numbers
    assert (np.diff(share[seen]) < 0.0).all()
    assert (np.diff(LAW.area_ratio(share, flattening)[seen]) < 0.0).all()
    assert (np.diff(LAW.film_ratio(RATIOS, share, flattening, resolution)) > 0.0).all()


def test_flatter_and_better_resolved_roughness_carries_less():
    flat = np.linspace(0.1, 0.8, 30)
    assert (np.diff(LAW.load_ratio(0.1, flat, 2.0)) < 0.0).all()
    assert (np.diff(LAW.load_ratio(0.1, 0.2, 10.0 * flat)) < 0.0).all()


def test_dry_contact_has_its_area_and_gap_whatever_the_speed():
    flat = np.linspace(0.1, 0.8, 30)
    area = LAW.area_ratio(1.0, flat)
    np.testing.assert_allclose(area, 1.0 - np.exp(-LAW.area_factor * flat), rtol=1e-14)
    np.testing.assert_allclose(LAW.film_ratio(RATIOS, 1.0, 0.2, 2.0), LAW.film_dry, rtol=1e-14)
    assert LAW.area_ratio(0.0, 0.2) == 0.0


def test_oil_carries_at_the_pressure_of_hertz_under_thick_films_and_flat_roughness_and_above_it_elsewhere():
    pressure = LAW.oil_pressure(RATIOS, 0.2)
    assert pressure[0] == pytest.approx(1.0 + LAW.oil_pressure_excess, rel=1e-3)
    assert (np.diff(pressure[RATIOS < 10.0]) < 0.0).all()
    assert LAW.oil_pressure(50.0, 0.2) == pytest.approx(1.0, abs=1e-12)
    assert LAW.oil_pressure(0.0, 1e6) == pytest.approx(1.0, abs=1e-5)


def test_a_thick_film_is_in_proportion_to_that_of_smooth_bodies():
    assert LAW.film_ratio(1e3, 0.0, 0.2, 2.0) == pytest.approx(LAW.film_factor * 1e3, rel=1e-5)


def test_the_largest_films_and_exponents_do_not_overflow():
    steep = FittedSharing(film_exponent=20.0, load_exponent=10.0)
    assert steep.load_ratio(1e60, 0.2, 2.0) == 0.0
    assert steep.film_ratio(1e30, 0.0, 0.2, 2.0) == pytest.approx(steep.film_factor * 1e30)
    assert steep.film_ratio(0.0, 0.0, 0.2, 2.0) == pytest.approx(steep.film_mixed)


def test_the_fit_covers_its_own_points_and_nothing_far_from_them(golden):
    named = ("clearance", "flattening", "resolution")
    inside = {name: (float(golden[name].min()), float(golden[name].max())) for name in named}
    middle = {name: float(np.median(golden[name])) for name in named}
    assert LAW.covers(**middle)
    for name, (low, high) in inside.items():
        assert LAW.covers(**middle | {name: high})
        assert not LAW.covers(**middle | {name: 0.5 * low})
        assert not LAW.covers(**middle | {name: 5.0 * high})


def test_the_nearest_point_of_the_fit_is_the_point_itself_or_lies_on_its_edge():
    (flat, flatter), (coarse, fine) = LAW.FITTED["flattening"], LAW.FITTED["resolution"]
    assert LAW.nearest(0.3, 3.0) == (0.3, 3.0)
    assert LAW.nearest(0.1 * flat, 10.0 * fine) == (flat, fine)
    assert LAW.nearest(10.0 * flatter, 0.1 * coarse) == (flatter, coarse)


@pytest.mark.parametrize("rougher", [True, False])
@pytest.mark.parametrize("dry", [True, False])
def test_exposure_grows_from_nothing_toward_all_with_the_area(rougher, dry):
    shares = LAW.exposed(np.linspace(0.0, 0.5, 50), rougher=rougher, dry=dry)
    assert shares[0] == 0.0
    assert (np.diff(shares) > 0.0).all()
    assert 0.4 < shares[-1] <= 1.0


def test_the_smoother_body_meets_more_of_the_other_than_the_rougher_one():
    area = np.linspace(0.01, 0.5, 50)
    for dry in (True, False):
        assert (LAW.exposed(area, rougher=False, dry=dry) > LAW.exposed(area, rougher=True, dry=dry)).all()


def test_arrays_give_what_their_numbers_give():
    clearance, flattening, resolution = np.meshgrid([0.01, 0.3, 2.0], [0.15, 0.5], [2.0, 4.0])
    share = LAW.load_ratio(clearance, flattening, resolution)
    area, film = LAW.area_ratio(share, flattening), LAW.film_ratio(clearance, share, flattening, resolution)
    exposed = LAW.exposed(area, rougher=True)
    for i in np.ndindex(share.shape):
        assert share[i] == pytest.approx(LAW.load_ratio(clearance[i], flattening[i], resolution[i]), rel=1e-13)
        assert area[i] == pytest.approx(LAW.area_ratio(share[i], flattening[i]), rel=1e-13)
        one = LAW.film_ratio(clearance[i], share[i], flattening[i], resolution[i])
        assert film[i] == pytest.approx(one, rel=1e-13)
        assert exposed[i] == pytest.approx(LAW.exposed(area[i], rougher=True), rel=1e-13)


def test_the_slope_is_that_of_a_surface_with_the_given_spectrum():
    rng = np.random.default_rng(1)
    n, length = 256, 16.0  # nodes
    q = 2.0 * np.pi * np.fft.fftfreq(n)
    q_2 = q[None, :] ** 2 + q[:, None] ** 2
    noise = np.fft.fft2(rng.standard_normal((n, n))) * np.exp(-q_2 * length**2 / 8.0)
    noise[0, 0] = 0.0
    z = np.fft.ifft2(noise).real
    found = np.sqrt(np.mean(np.abs(np.fft.ifft2(1j * q[None, :] * noise)) ** 2) * 2.0) / z.std()
    assert rms_slope(1.0, length, 0.0, 1.0) == pytest.approx(found, rel=0.05)
    assert rms_slope(3.0, 2.0, 4.0, 2.0) == pytest.approx(5.0)


def test_flattening_is_pressure_over_modulus_and_slope():
    assert flattening_of(1e9, 2e11, 0.05) == pytest.approx(0.2)


def test_shipped_constants_give_the_sweep_back_within_their_scatter(golden):
    assert golden.size >= 10
    share = LAW.load_ratio(golden["clearance"], golden["flattening"], golden["resolution"])
    off = share - golden["load_ratio"]
    assert np.sqrt(np.mean(off**2)) < 1.5 * LAW.load_scatter
    assert np.abs(off).max() < 3.5 * LAW.load_scatter
    film = LAW.film_ratio(golden["clearance"], share, golden["flattening"], golden["resolution"])
    off = np.log(film / golden["film_ratio"])
    assert np.sqrt(np.mean(off**2)) < 1.5 * LAW.film_scatter
    assert np.abs(off).max() < 3.5 * LAW.film_scatter
    area = LAW.area_ratio(golden["load_ratio"], golden["flattening"])
    np.testing.assert_allclose(area, golden["area_ratio"], atol=0.03)


def test_every_fitted_constant_has_its_interval_and_lies_in_its_range():
    constants = {f.name: f for f in fields(FittedSharing) if not f.name.endswith("_scatter")}
    assert set(FittedSharing.HALF_WIDTHS) == set(constants)
    for name, f in constants.items():
        value, width = getattr(LAW, name), FittedSharing.HALF_WIDTHS[name]
        assert 0.0 < width < value <= f.metadata["most"]
