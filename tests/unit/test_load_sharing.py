"""The curves of load sharing: limits, order, arrays, printed equations, and the sweep they were fitted to."""

import math
import re
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
from comparison import approx
from scipy.special import hyp1f1

from contact_core.film.regression import Regression
from contact_core.laws import load_sharing
from contact_core.laws.asperity_layer import SLOPE
from contact_core.laws.load_sharing import FittedSharing, LineSharing, flattening_of, rms_slope

LAW = FittedSharing()
LAWS = [FittedSharing(), LineSharing()]
BELOW = 0.3  # flattening of what is below the grid
SLIP, PRESSED = 0.1, 0.2  # sliding over entrainment speed, Hertz's largest pressure over the hardness
REST = BELOW, SLIP, PRESSED
RATIOS = np.geomspace(1e-4, 1e2, 200)
# solved contacts of both cases of the thesis: some of those that the constants were fitted to
GOLDEN = Path(__file__).parent.parent / "golden" / "load_sharing.csv"


def load_ratio(law, clearance, layers, flattening, below, slip, pressed):
    return law.load_ratio_at(slip, law.parting(clearance, layers, flattening, below, pressed))


def area_ratio(law, share, flattening, below):
    return law.dry_area(flattening, below) * share**law.area_exponent


def film_ratio(law, dense, share, flattening, layer):
    return law.films(dense, flattening, layer).ratio(share)


@pytest.fixture(scope="module")
def golden():
    return np.genfromtxt(GOLDEN, delimiter=",", names=True)


@pytest.mark.parametrize("flattening", [0.1, 0.2, 0.7])
def test_solids_carry_all_without_film_and_nothing_under_a_thick_one(flattening):
    for law in LAWS:
        assert load_ratio(law, 0.0, 0.0, flattening, *REST) == 1.0
        assert load_ratio(law, 1e-7, 1e-6, flattening, *REST) > 0.9999
        assert load_ratio(law, 1e3, 1e4, flattening, *REST) < 1e-12
        assert load_ratio(law, np.inf, np.inf, flattening, *REST) == 0.0


def sides(printed, names):
    """Return the values of both sides of the first equation; those after it define names that it needs."""
    signs = {"−": "-", "′": "_prime", "[": "(", "]": ")", "{": "(", "}": ")", "^": "**", "h_c/σ": "film_ratio"}
    for sign, python in signs.items():
        printed = printed.replace(sign, python)
    printed = re.sub(r"(?<=[\w)]) +(?=[\w(])", "*", printed)
    (left, right), *definitions = (equation.split(" = ") for equation in re.split(r",   |\n", printed))
    names = names | {"exp": math.exp, "ln": math.log, "max": max}
    for name, value in definitions:
        names[name] = eval(value, names)
    return eval(left, names), eval(right, names)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("clearance", "flattening", "layers"), [(1.0, 0.6, 7.0), (0.03, 0.1, 0.3)])
def test_the_printed_equations_are_those_that_are_evaluated(law, clearance, flattening, layers):
    """By the symbols that the texts of the constants begin with, for points and lines."""
    load, area, film, of_film = law.equations.lines
    names = {f.metadata["text"].split(",")[0]: getattr(law, f.name) for f in fields(law) if "exposure" not in f.name}
    names |= {"Z": clearance, "s": flattening, "s_m": BELOW, "f": layers, "ρ": 1.2, "Σ": SLIP, "Π": PRESSED}
    names["W_c"] = load_ratio(law, clearance, layers, flattening, *REST)
    names["A_c"] = area_ratio(law, names["W_c"], flattening, BELOW)
    names["film_ratio"] = film_ratio(law, clearance / names["ρ"], names["W_c"], flattening, clearance / layers)
    for printed in (load, area, f"{film}\n{of_film}"):
        found, expected = sides(printed, names)
        assert found == approx(expected, rel=1e-9), printed
    # in which a and b are the half widths of the contact
    names |= {"h_s": 1e-7, "R_x": 0.01, "R_y": 0.02, "a": 1e-4, "b": 2e-4}
    names["k"] = law.oil_pressure(clearance, flattening, 0.1, 0.05)
    found, expected = sides(Regression.friction.lines[-1], names)
    assert found == approx(expected, rel=1e-9)


@pytest.mark.parametrize("flattening", [0.1, 0.2, 0.7])
def test_thicker_films_take_load_and_area_from_the_solids_and_part_the_bodies(flattening):
    share = load_ratio(LAW, 0.1 * RATIOS, RATIOS, flattening, *REST)
    seen = share > 1e-300  # further out exp() has no smaller numbers
    assert (np.diff(share[seen]) < 0.0).all()
    assert (np.diff(area_ratio(LAW, share, flattening, BELOW)[seen]) < 0.0).all()
    assert (np.diff(film_ratio(LAW, RATIOS, share, flattening, 0.1)) > 0.0).all()


def test_flatter_roughness_carries_less():
    flat = np.linspace(0.1, 0.8, 30)
    assert (np.diff(load_ratio(LAW, 0.1, 1.0, flat, *REST)) < 0.0).all()


@pytest.mark.parametrize("law", LAWS)
def test_asperities_that_slide_past_each_other_carry_less_up_to_a_quarter_beyond_the_fit(law):
    slips = np.array([0.0, 0.01, 0.1, 1.0])
    assert (np.diff(load_ratio(law, 0.3, 3.0, 0.2, BELOW, slips, PRESSED)) < 0.0).all()
    fastest = law.FITTED["slip"][1]
    ends = [load_ratio(law, 0.3, 3.0, 0.2, BELOW, slip, PRESSED) for slip in (1.25 * fastest, 10.0 * fastest, math.inf)]
    assert ends == [ends[0]] * 3


def test_asperities_of_lines_that_yield_carry_more():
    pressed = np.array([0.0, 0.1, 0.5])
    assert (np.diff(load_ratio(LineSharing(), 0.3, 6.0, 0.2, BELOW, SLIP, pressed)) > 0.0).all()


def test_dry_contact_has_its_area_and_gap_whatever_the_speed():
    flat = np.linspace(0.1, 0.8, 30)
    area = area_ratio(LAW, 1.0, flat, np.inf)
    np.testing.assert_allclose(area, 1.0 - np.exp(-LAW.area_factor * flat), rtol=1e-9)
    gap = LAW.film_dry * np.log1p(LAW.film_parted) / LAW.film_parted + 0.1 * LAW.film_layer
    np.testing.assert_allclose(film_ratio(LAW, RATIOS, 1.0, 0.2, 0.1), gap, rtol=1e-14)
    assert area_ratio(LAW, 0.0, 0.2, BELOW) == 0.0


def test_oil_carries_at_the_pressure_of_hertz_under_thick_films_and_flat_roughness_and_above_it_elsewhere():
    for law in LAWS:
        pressure = law.oil_pressure(RATIOS, 0.2, 0.0, 0.0)
        assert pressure[0] == approx(1.0 + law.oil_pressure_excess, rel=1e-3)
        assert (np.diff(pressure[RATIOS < 10.0]) < 0.0).all()
        assert law.oil_pressure(80.0, 0.2, 0.0, 0.0) == approx(1.0, abs=1e-9)
        assert law.oil_pressure(0.0, 1e9, 0.0, 0.0) == approx(1.0, abs=1e-5)


def test_films_thick_beside_hertzs_contact_spread_the_load_along_both_axes():
    """Far beyond, the pressure falls with the film as the area grows that it opens: sqrt(R h) along each axis."""
    found = [LAW.oil_pressure(1e4, 5.0, x, y) for x, y in ((0.0, 0.0), (1e6, 0.0), (1e8, 0.0), (1e6, 1e6), (1e8, 1e8))]
    assert found[0] == approx(1.0, abs=1e-9)
    assert found[1] / found[2] == approx(10.0, rel=1e-3)
    assert found[3] / found[4] == approx(100.0, rel=1e-3)


def test_a_thick_film_is_in_proportion_to_that_of_smooth_bodies():
    assert film_ratio(LAW, 1e3, 0.0, 0.2, 0.1) == approx(LAW.film_factor * 1e3, rel=1e-3)


def test_the_largest_films_and_exponents_do_not_overflow():
    steep = FittedSharing(film_exponent=20.0, load_exponent=10.0)
    assert load_ratio(steep, 1e60, 1e60, 1e60, np.inf, np.inf, 0.0) == 0.0
    assert film_ratio(steep, 1e30, 0.0, 0.2, 0.1) == approx(steep.film_factor * 1e30)
    assert film_ratio(steep, 0.0, 0.0, 0.2, 0.1) == approx(steep.film_mixed)


def test_the_fit_covers_its_own_points_and_nothing_beyond_its_edges(golden):
    named = ("clearance", "layers", "flattening", "below", "slip", "pressed")
    assert all(LAW.covers(*row) for row in zip(*(golden[name].tolist() for name in named), strict=True))
    for law in LAWS:
        middle = {name: float(np.sqrt(low * high)) for name, (low, high) in law.FITTED.items()}
        assert law.covers(**middle)
        for name, (low, high) in law.FITTED.items():
            # none slides too little, or yields too little
            assert law.covers(**middle | {name: 0.99 * low}) is (name in ("slip", "pressed"))
            assert law.covers(**middle | {name: 1.01 * high}) is (name == "layers")  # none reaches across thick films


def test_the_nearest_point_of_the_fit_is_the_point_itself_or_lies_on_its_edge_or_is_flatter():
    flat, flatter = LAW.FITTED["flattening"]
    assert LAW.nearest(0.3) == 0.3
    assert LAW.nearest(0.1 * flat) == flat
    assert LAW.nearest(10.0 * flatter) == 10.0 * flatter


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


@pytest.mark.parametrize("rougher", [True, False])
def test_coverage_is_that_of_exposures_of_a_beta_distribution(rougher):
    """Of the law's variance, for growth by 1 - exp(-exposure): its mean is 1 - 1F1(a; a + b; -s)."""
    spread = LAW.exposure_spread_rougher if rougher else LAW.exposure_spread_smoother
    for mean in (0.01, 0.1, 0.3, 0.6):
        a, both = mean * (1.0 / spread - 1.0), 1.0 / spread - 1.0
        times = np.geomspace(1e-6, 10.0 / mean, 40)
        growth = 1.0 - hyp1f1(a, both, -times)
        where = 1.0 - hyp1f1(a + 1.0, both + 1.0, -times)  # each point counting by its exposure
        found = LAW.coverage(mean, growth, rougher=rougher)
        assert found[0] == approx(growth[0] / where[0], rel=1e-4)  # new surfaces: the variance alone counts
        assert found == approx(growth / where, rel=0.12)
        assert (np.diff(found) >= 0.0).all()
        assert (found >= growth).all()  # no film where it is rubbed is thicker than a full one


@pytest.mark.parametrize("rougher", [True, False])
def test_coverage_goes_to_all_with_the_exposure_and_to_nothing_with_none(rougher):
    assert LAW.coverage(1.0, 0.3, rougher=rougher) == approx(1.0)
    assert 0.0 < LAW.coverage(1e-200, 0.0, rougher=rougher) < 1e-198
    assert replace(LAW, exposure_spread_rougher=0.99).coverage(0.2, 0.19, rougher=True) == approx(0.2, rel=0.01)


def test_arrays_give_what_their_numbers_give():
    clearance, flattening, layers = np.meshgrid([0.01, 0.3, 2.0], [0.15, 0.5], [2.0, 50.0])
    share = load_ratio(LAW, clearance, layers, flattening, *REST)
    area, film = area_ratio(LAW, share, flattening, BELOW), film_ratio(LAW, clearance, share, flattening, 0.1)
    exposed = LAW.exposed(area, rougher=True)
    for i in np.ndindex(share.shape):
        assert share[i] == approx(load_ratio(LAW, clearance[i], layers[i], flattening[i], *REST), rel=1e-13)
        assert area[i] == approx(area_ratio(LAW, share[i], flattening[i], BELOW), rel=1e-13)
        one = film_ratio(LAW, clearance[i], share[i], flattening[i], 0.1)
        assert film[i] == approx(one, rel=1e-13)
        assert exposed[i] == approx(LAW.exposed(area[i], rougher=True), rel=1e-13)


def test_the_slope_is_that_of_a_surface_with_the_given_spectrum():
    rng = np.random.default_rng(1)
    n, length = 256, 16.0  # nodes
    q = 2.0 * np.pi * np.fft.fftfreq(n)
    q_2 = q[None, :] ** 2 + q[:, None] ** 2
    noise = np.fft.fft2(rng.standard_normal((n, n))) * np.exp(-q_2 * length**2 / 8.0)
    noise[0, 0] = 0.0
    z = np.fft.ifft2(noise).real
    found = np.sqrt(np.mean(np.abs(np.fft.ifft2(1j * q[None, :] * noise)) ** 2) * 2.0) / z.std()
    assert rms_slope(1.0, length, 0.0, 1.0) == approx(found, rel=0.05)
    assert rms_slope(3.0, 2.0, 4.0, 2.0) == approx(5.0)


def test_the_slope_of_all_waves_below_the_grid_is_that_of_the_asperity_layer():
    assert load_sharing._ALL_WAVES == SLOPE


def test_flattening_is_pressure_over_modulus_and_slope():
    assert flattening_of(1e9, 2e11, 0.05) == approx(0.2)


def test_shipped_constants_give_the_sweep_back_within_their_half_widths(golden):
    assert golden.size >= 10
    named = ("clearance", "layers", "flattening", "below", "slip", "pressed")
    share = load_ratio(LAW, *(golden[name] for name in named))
    off = np.abs(share - golden["load_ratio"])
    widths = [LAW.WIDTHS.of_load(*pair) for pair in zip(share, golden["clearance"], strict=True)]
    assert np.mean(off < widths) > 0.85  # of 17 points
    assert off.max() < 0.3
    film = film_ratio(LAW, golden["dense"], share, golden["flattening"], golden["clearance"] / golden["layers"])
    off = np.abs(golden["film_ratio"] / film - 1.0)
    assert np.mean(off < [LAW.WIDTHS.of_film(ratio) for ratio in golden["clearance"]]) > 0.9
    assert off.max() < 0.6
    area = area_ratio(LAW, golden["load_ratio"], golden["flattening"], golden["below"])
    np.testing.assert_allclose(area, golden["area_ratio"], atol=0.03)


@pytest.mark.parametrize("law", LAWS)
def test_every_fitted_constant_has_its_interval_and_lies_in_its_range(law):
    constants = {f.name: f for f in fields(law)}
    borrowed = {name for name in constants if name.startswith("exposure_")} if isinstance(law, LineSharing) else set()
    assert set(law.HALF_WIDTHS) - borrowed == set(constants) - law.CHOSEN - borrowed
    for name, width in law.HALF_WIDTHS.items():
        assert width > 0.0
        assert 0.0 < getattr(law, name) <= constants[name].metadata["most"]


@pytest.mark.parametrize("law", LAWS)
def test_half_widths_narrow_where_there_is_less_to_be_wrong_about(law):
    widths = law.WIDTHS
    assert widths.of_load(1.0, 0.1) == 0.0 < widths.of_load(0.0, 50.0) < 1e-10
    assert widths.of_load(0.0, 1.0) < widths.of_load(1e-3, 1.0) < widths.of_load(0.1, 1.0) < 0.25
    assert widths.of_load(0.5, 1.0) > widths.of_load(0.9, 1.0) > widths.of_load(0.99, 1.0)
    assert 0.5 > widths.of_film(0.05) > widths.of_film(2.0) >= widths.of_film(50.0) >= 0.08
    assert widths.of_oil(5.0, 0.0) < widths.of_oil(5.0, 1.0) == widths.of_oil(5.0, 3.0) < widths.of_oil(0.01, 1.0)
