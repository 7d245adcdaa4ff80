"""Tribofilms at temperatures between those of the fits."""

import tomllib
from dataclasses import fields, replace
from functools import reduce
from pathlib import Path

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap
from comparison import approx
from scipy.integrate import solve_ivp

import contact_core
from contact_core import Scene, advance, initial_state
from contact_core.laws.tribofilm import Arrhenius, Ghanbarzadeh, thickness
from contact_core.reference import ghanbarzadeh_thickness

PUBLISHED = {name: Scene.from_toml(name).tribofilm for name in ("mtm_zddp", "azam_case_a")}  # 80 and 90 degC
MINUTES = np.array([1.0, 5.0, 20.0, 60.0, 120.0])
GAS = 8.31446261815324  # J/(mol K)


def law_of(name):
    return Scene.from_toml("mtm_zddp", {"tribofilm.set": name}).tribofilm


def films(law, temperature, minutes=MINUTES):
    """Film [m] of a point that is always in contact, after several times."""
    alone = replace(law, dose="clock")
    pressure, zero = np.ones_like(minutes), np.zeros_like(minutes)
    exposed = alone.exposure(pressure, zero, 0.005, temperature) * 60.0 * minutes
    return thickness(*alone.evolve(zero, zero, exposed, zero, temperature))


def closed_form(law, minutes=MINUTES):
    published = law.full_thickness, law.rate_factor, law.removal_thickness, law.removal_rate
    return ghanbarzadeh_thickness(60.0 * minutes, law.fit_temperature, *published)


@pytest.mark.parametrize(
    ("name", "met"), [("zddp_60_100c", ["mtm_zddp"]), ("zddp_80_90c", ["mtm_zddp", "azam_case_a"])]
)
def test_a_shipped_set_grows_the_published_films_at_their_temperatures(name, met):
    for case in met:
        found = films(law_of(name), PUBLISHED[case].fit_temperature)
        assert found == approx(closed_form(PUBLISHED[case]), rel=1e-5, abs=0.0)


def test_a_law_through_two_fits_meets_both_and_is_the_shipped_one():
    law, *misses = Arrhenius.through(list(PUBLISHED.values()), contact_share=7.1e-4)
    assert misses == approx(np.zeros(4), abs=1e-12)
    shipped = law_of("zddp_80_90c")
    for f in fields(Arrhenius):
        if f.metadata["unit"]:
            assert getattr(shipped, f.name) == approx(getattr(law, f.name), rel=1e-6, abs=0.0)


def at(celsius, growing, taking, full, taken):
    """Constants of a fit at one temperature, by rates [1/s] and thicknesses [m]."""
    warm = celsius + 273.15
    by_factor = growing / Ghanbarzadeh(full, 1.0, taken, taking, warm).rate(warm)
    return Ghanbarzadeh(full, by_factor, taken, taking, warm)


def test_a_law_through_three_fits_that_follow_arrhenius_has_their_barriers():
    def rate(first, kilojoules, celsius):
        return first * np.exp(-kilojoules * 1e3 / GAS * (1.0 / (celsius + 273.15) - 1.0 / 333.15))

    def straight(cold, hot, celsius):
        return np.interp(-1.0 / (celsius + 273.15), [-1.0 / 333.15, -1.0 / 373.15], [cold, hot])

    fits = [
        at(c, rate(3e-4, 70.0, c), rate(1e-4, 40.0, c), straight(180e-9, 150e-9, c), straight(20e-9, 60e-9, c))
        for c in (60.0, 80.0, 100.0)
    ]
    law, *misses = Arrhenius.through(fits)
    assert misses == approx(np.zeros(4), abs=1e-10)
    moles = 6.02214076e23
    assert (law.activation_energy * moles, law.removal_energy * moles) == approx((70e3, 40e3), rel=1e-9)
    assert (law.fitted_from, law.fit_temperature, law.fitted_to) == (333.15, 353.15, 373.15)
    for fit in fits:
        assert films(law, fit.fit_temperature) == approx(closed_form(fit), rel=1e-8, abs=0.0)
    assert law.full_thickness == approx(180e-9, rel=1e-12, abs=0.0)


def test_a_law_through_three_fits_that_do_not_says_by_how_much_it_misses_them():
    fits = [
        at(60.0, 3e-4, 1e-4, 150e-9, 30e-9),
        at(80.0, 1.4e-3, 5e-4, 200e-9, 50e-9),
        at(100.0, 2e-3, 4e-4, 160e-9, 10e-9),
    ]
    law, *misses = Arrhenius.through(fits)
    warm = np.array([fit.fit_temperature for fit in fits])
    design = np.stack([np.ones(3), 1.0 / warm], axis=1)

    def off(values):
        return design @ np.linalg.lstsq(design, values, rcond=None)[0]

    growing, taking = np.array([3e-4, 1.4e-3, 2e-3]), np.array([1e-4, 5e-4, 4e-4])
    full, taken = np.array([150e-9, 200e-9, 160e-9]), np.array([30e-9, 50e-9, 10e-9])
    expected = [np.exp(off(np.log(v))) / v - 1.0 for v in (growing, taking)] + [off(v) - v for v in (full, taken)]
    assert misses == approx([np.max(np.abs(e)) for e in expected], rel=1e-6, abs=0.0)
    assert all(miss > 0.0 for miss in misses)
    assert law.rate(353.15) == approx(1.4e-3 * (1.0 + expected[0][1]), rel=1e-9)


def test_a_rate_that_falls_with_temperature_gets_no_barrier():
    law = Arrhenius.through([at(60.0, 2e-3, 1e-4, 2e-7, 0.0), at(80.0, 1e-3, 1e-4, 2e-7, 0.0)]).law
    assert law.activation_energy == 0.0
    assert law.rate(333.15) == law.rate(353.15) == approx(np.sqrt(2.0) * 1e-3, rel=1e-12)


def test_one_temperature_or_no_growth_is_too_little_for_a_dependence():
    with pytest.raises(ValueError, match="two temperatures"):
        Arrhenius.through([PUBLISHED["mtm_zddp"]] * 2)
    with pytest.raises(ValueError, match="rate_factor"):
        Arrhenius.through([PUBLISHED["azam_case_a"], replace(PUBLISHED["mtm_zddp"], rate_factor=0.0)])


def test_the_shipped_set_speeds_up_by_its_barrier_from_temperature_to_temperature():
    law = law_of("zddp_60_100c")
    for celsius in (60.0, 70.0, 90.0, 100.0):
        faster = np.exp(-65e3 / GAS * (1.0 / (celsius + 273.15) - 1.0 / 353.15))
        assert films(law, celsius + 273.15, MINUTES / faster) == approx(films(law, 353.15), rel=1e-9, abs=0.0)


WARMING = Arrhenius(333.15, 373.15, 353.15, 1e-3, 1.1e-19, 5e-4, 6e-20, 120e-9, 200e-9, 60e-9, 20e-9, dose="clock")
DUTY = [(340.0, 900.0), (368.0, 300.0), (352.0, 1500.0), (335.0, 600.0), (375.0, 200.0)]  # K, s


def rubbed(law, film, temperature, seconds):
    exposed = law.exposure(np.ones(1), np.zeros(1), 0.005, temperature) * seconds
    return law.evolve(*film, exposed, np.zeros(1), temperature)


@pytest.mark.parametrize("parts", [1, 2, 7, 100])
def test_a_film_over_changing_temperatures_is_that_of_the_differential_equation_however_time_is_cut(parts):
    """What has grown at one temperature does not go at another with a smaller h_max, and what has gone stays away."""

    def changing(_, film, warm):
        growing = 1e-3 * np.exp(1.1e-19 / 1.380649e-23 * (1.0 / 353.15 - 1.0 / warm))
        taking = 5e-4 * np.exp(6e-20 / 1.380649e-23 * (1.0 / 353.15 - 1.0 / warm))
        full, taken = (
            np.interp(-1.0 / warm, [-1.0 / 333.15, -1.0 / 373.15], ends) for ends in ([120.0, 200.0], [60.0, 20.0])
        )
        return [growing * max(full - film[0], 0.0), taking * max(taken - film[1], 0.0)]

    expected, film = [0.0, 0.0], (np.zeros(1), np.zeros(1))
    for warm, seconds in DUTY:
        solved = solve_ivp(changing, (0.0, seconds), expected, args=(warm,), rtol=1e-10, atol=1e-10, max_step=20.0)
        expected = solved.y[:, -1]
        film = reduce(lambda now, _, w=warm, s=seconds: rubbed(WARMING, now, w, s / parts), range(parts), film)
    assert 1e9 * np.array([film[0][0], film[1][0]]) == approx(expected, rel=1e-6, abs=0.0)
    assert expected[0] > 120.0  # thicker than the coldest fit would allow, and it went through colder times


def test_a_hot_spot_grows_by_its_own_temperature():
    found = WARMING.exposure(np.array([0.0, 1e9, 1e9]), np.zeros(3), 0.005, np.array([400.0, 353.15, 393.15]))
    assert found[0] == 0.0
    assert found[1] == 1e-3
    assert found[2] / found[1] == approx(np.exp(1.1e-19 / 1.380649e-23 * (1.0 / 353.15 - 1.0 / 393.15)), rel=1e-12)


def test_constants_are_of_the_time_of_tests_and_contact_is_a_share_of_it():
    by_contact = replace(WARMING, dose="residence", contact_share=1e-3)
    assert by_contact.exposure(1e9, 0.0, 0.005, 353.15) == approx(1e3 * 1e-3, rel=1e-12)
    assert replace(WARMING, dose="contact_length").exposure(1e9, 0.0, 0.005, 353.15) == 1e-3


def test_it_answers_between_the_fits_and_five_kelvin_beyond_and_says_where_it_ends():
    law = law_of("zddp_60_100c")
    answered = [328.15, 333.15, 341.0, 373.15, 378.15]
    assert all(law.covers(t) and law.refusal(t) == "" for t in answered)
    for t in (328.1, 378.2):
        said = law.refusal(t)
        assert not law.covers(t)
        for words in (f"{t:g} K", "328.15 K to 378.15 K", "tribofilm.fitted_to", "tribofilm.beyond_fit ="):
            assert words in said
    assert replace(law, beyond_fit="extrapolate").refusal(300.0) == ""
    beyond = replace(law, full_thickness_to=150e-9)
    assert beyond.largest(500.0) == 150e-9 and beyond.largest(300.0) == 200e-9


def test_the_ends_of_the_fits_may_be_named_in_either_order():
    turned = replace(
        WARMING,
        fitted_from=WARMING.fitted_to,
        fitted_to=WARMING.fitted_from,
        full_thickness_from=WARMING.full_thickness_to,
        full_thickness_to=WARMING.full_thickness_from,
        removal_thickness_from=WARMING.removal_thickness_to,
        removal_thickness_to=WARMING.removal_thickness_from,
    )
    assert turned.full_thickness == WARMING.full_thickness == 200e-9
    for warm in (320.0, 333.15, 350.0, 373.15, 390.0):
        assert turned.largest(warm) == approx(WARMING.largest(warm), rel=1e-12, abs=0.0)
        assert turned.largest_removal(warm) == approx(WARMING.largest_removal(warm), rel=1e-12, abs=0.0)
        assert turned.covers(warm) is WARMING.covers(warm)


def test_a_range_of_one_temperature_has_the_thickness_of_its_start():
    law = replace(WARMING, fitted_to=WARMING.fitted_from)
    assert law.largest(300.0) == law.largest(400.0) == WARMING.full_thickness_from


@pytest.mark.parametrize("level", ["regression", pytest.param("deterministic", marks=pytest.mark.long)])
def test_a_warmer_rig_grows_a_film_faster_at_both_levels(level):
    grown = []
    for celsius in (60, 80, 100):
        scene, _, op = cheap(CHEAP | {"tribofilm.set": "zddp_60_100c", "operation.temperature": f"{celsius} degC"})
        scene = scene if level == "deterministic" else scene.at_level("regression")
        grown.append(advance(scene, op, initial_state(scene), 10.0)[1].tribofilm_1)
    assert np.all(np.diff(grown) > 0.0)
    assert grown[2] > 2.0 * grown[0]


PATH = Path(contact_core.__file__).parent / "data" / "tribofilms.toml"
SETS = tomllib.loads(PATH.read_text("utf-8"))
STATED = [(name, keys) for name, table in SETS.items() for keys in table.get("intervals", {})]


@pytest.mark.parametrize(("name", "keys"), STATED)
def test_an_interval_is_of_parameters_of_its_set_and_holds_their_values(name, keys):
    scene = Scene.from_toml("azam_case_a" if name.endswith("_90c") else "mtm_zddp", {"tribofilm.set": name})
    (interval,) = (each for each in scene.intervals if each.key == keys)
    least, most = interval.ends(scene)
    for key in interval.keys:
        assert least[key] < getattr(scene.tribofilm, key.removeprefix("tribofilm.")) < most[key]


CALIBRATED = [(name, keys) for name, keys in STATED if "prefactor" in keys]


@pytest.mark.parametrize(("name", "keys"), CALIBRATED)
def test_a_prefactor_at_the_ends_of_its_interval_grows_as_much_with_the_barrier_of_the_same_end(name, keys):
    scene = Scene.from_toml("mtm_zddp", {"tribofilm.set": name})
    (interval,) = (each for each in scene.intervals if each.key == keys)
    pressure = 2.0 / 3.0 * scene.hertz(scene.operation.load).pressure_max

    def start(law):
        return law.exposure(np.array([pressure]), np.array([0.115 * pressure]), 0.005, 353.15)[0]

    for end in interval.ends(scene):
        law = replace(scene.tribofilm, **{key.removeprefix("tribofilm."): value for key, value in end.items()})
        assert start(law) == approx(start(scene.tribofilm), rel=2e-3, abs=0.0)


def test_a_scene_takes_a_law_through_constants_of_ones_own():
    scene, _, op = cheap(CHEAP)
    law = Arrhenius.through([at(60.0, 3e-4, 1e-4, 150e-9, 30e-9), at(100.0, 2e-3, 4e-4, 160e-9, 10e-9)]).law
    warmer = replace(scene, tribofilm=law).at_level("regression")
    found = [
        advance(warmer, replace(op, temperature=t), initial_state(warmer), 120.0)[1].tribofilm_1
        for t in (333.15, 350.0, 373.15)
    ]
    assert 0.0 < found[0] < found[1] < found[2]
