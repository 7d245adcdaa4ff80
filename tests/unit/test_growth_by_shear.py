"""Tribofilms that stress grows: where, how fast, how thick, and what a law without removal does not pay for."""

from dataclasses import replace

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap
from comparison import HARD, approx
from scipy.constants import Boltzmann

from contact_core import ContactState, Scene, advance, initial_state, solve
from contact_core.deterministic.accumulator import Accumulator
from contact_core.laws.tribofilm import Andersson, Combined, Ghanbarzadeh, Gosvami, NoTribofilm, ZhangSpikes
from contact_core.laws.tribofilm.activated import edge_tension
from contact_core.regression.contact import MeanContact
from contact_core.regression.exposure import _oiled
from contact_core.scene import Case
from contact_core.surfaces.patches import across_track, on_patch, patch_nodes

WARM = 353.15
BELL = ZhangSpikes(200e-9, 20.0, 1.08e-19, 0.13e-27, 2e-8)
PRESSED = Gosvami(200e-9, 6e3, 1.28e-19, 3.8e-30, 2e-8)
SHEAR, NONE = np.array([0.1e9, 0.2e9, 0.4e9]), np.zeros(3)


def rate(law, pressure, shear, temperature=WARM):
    return law.exposure(np.asarray(pressure, float), np.asarray(shear, float), 0.01, temperature)


def test_doubled_shear_stress_speeds_growth_up_by_the_work_on_the_activation_volume():
    once, twice = rate(BELL, [0.0], [0.1e9]), rate(BELL, [0.0], [0.2e9])
    assert twice / once == approx(np.exp(0.1e9 * 0.13e-27 / (Boltzmann * WARM)), rel=1e-12)
    assert twice > 10.0 * once


def test_doubled_normal_stress_speeds_growth_up_by_the_work_on_its_own_volume():
    once, twice = rate(PRESSED, [2e9], [0.0]), rate(PRESSED, [4e9], [0.0])
    assert twice / once == approx(np.exp(2e9 * 3.8e-30 / (Boltzmann * WARM)), rel=1e-12)


@pytest.mark.parametrize(("law", "stress"), [(BELL, 0.1e9), (PRESSED, 2e9)])
def test_heat_speeds_growth_up_by_the_barrier_that_the_stress_leaves(law, stress):
    cold, hot = (rate(law, [stress], [stress], t) for t in (333.15, 393.15))
    left = law.activation_energy - stress * law.activation_volume
    assert hot / cold == approx(np.exp(left / Boltzmann * (1 / 333.15 - 1 / 393.15)), rel=1e-12)
    assert hot > 5.0 * cold


def test_without_a_barrier_more_stress_does_not_speed_growth_up_any_further():
    enough = BELL.activation_energy / BELL.activation_volume
    assert np.array_equal(rate(BELL, [0.0, 0.0], [enough, 3.0 * enough]), np.full(2, 20.0 / 200e-9))


def test_shear_grows_a_film_in_oil_and_in_contact_and_normal_stress_in_contact_alone():
    pressure = np.array([0.0, 1e9, 2e9])
    assert np.all(rate(BELL, pressure, SHEAR) > 0.0)
    assert np.array_equal(rate(BELL, pressure, SHEAR), rate(BELL, NONE, SHEAR))
    assert np.array_equal(rate(PRESSED, pressure, SHEAR) > 0.0, pressure > 0.0)


def test_hardly_sheared_oil_grows_nothing_by_temperature_alone():
    assert np.array_equal(rate(BELL, NONE, [0.0, 1e7, 1.01e7]) > 0.0, [False, False, True])


def test_growth_stops_where_removal_keeps_up_with_it():
    growing, taking = 3e-3, 1e-3
    film = np.array([0.0, 100e-9, 200e-9]), NONE
    settled, removal = BELL.evolve(*film, np.full(3, growing * 1e5), np.full(3, taking * 1e5), WARM)
    assert settled == approx(200e-9 * growing / (growing + taking), rel=1e-12, abs=0.0)
    assert not removal.any()


def test_a_film_that_another_law_left_goes_on_from_its_thickness():
    growth, removal = BELL.evolve(np.array([90e-9, 20e-9]), np.array([30e-9, 40e-9]), np.zeros(2), np.zeros(2), WARM)
    assert growth == approx([60e-9, 0.0], rel=1e-15, abs=0.0)
    assert not removal.any()


def test_removal_is_in_proportion_to_thickness_pressure_and_sliding():
    assert BELL.abrasion(np.array([1e9]), -0.01, None)[0] == approx(2e-8 * 1e9 * 0.01, rel=1e-14)
    taken = BELL.evolve(np.array([50e-9, 100e-9]), np.zeros(2), np.zeros(2), np.full(2, 1e-6), WARM)[0]
    assert np.array([50e-9, 100e-9]) - taken == approx([50e-15, 100e-15], rel=1e-5, abs=0.0)


def test_the_tension_across_a_track_rises_from_its_middle_to_its_edge():
    tension = edge_tension(np.linspace(0.0, 1.0, 1001))
    assert tension[0] == approx(0.0, abs=1e-12)
    assert tension[-1] == approx(1.0, rel=1e-12)
    assert np.all(np.diff(tension) > 0.0)
    assert np.array_equal(edge_tension(np.array([1.0, 1.5, 9.0])), np.ones(3))
    in_between = 0.4 / 3.0 * (1.0 - 0.75**1.5) / 0.25 - 0.75**0.5  # of p0, half way out
    assert edge_tension(np.array([0.5]))[0] == approx((in_between + 0.8) / (0.4 / 3.0 + 0.8), rel=1e-12)


def test_removal_prefers_the_edges_by_its_weight_and_needs_no_position_without():
    pressure, position = np.full((3, 4), 1e9), np.array([[1.0], [0.0], [1.0]])
    even = BELL.abrasion(pressure, 0.01, position)
    assert np.array_equal(even, BELL.abrasion(pressure, 0.01, None))
    edgy = replace(BELL, edge_weight=3.0).abrasion(pressure, 0.01, position)
    assert edgy / even == approx(np.array([[4.0], [1.0], [4.0]]) * np.ones((1, 4)), rel=1e-12)


CONTACTS = Ghanbarzadeh(200e-9, 1.66e-16, 0.0, 0.0, WARM, dose="contact_length")
SHEARED = replace(BELL, dose="contact_length", edge_weight=2.0)
BOTH = Combined(200e-9, 1.0, 1.0, 1.66e-16, WARM, 20.0, 1.08e-19, 0.13e-27, 2e-8, edge_weight=2.0)


def grown(law, seconds):
    """Film [m] of nodes of three kinds, after a time under held stresses."""
    pressure = np.array([0.0, 1e9, 2e9])
    exposed = law.exposure(pressure, SHEAR, 0.01, WARM) * seconds
    abraded = law.abrasion(pressure, 0.01, np.array([0.0, 0.5, 1.0])) * seconds
    return law.evolve(NONE, NONE, exposed, abraded, WARM)[0]


@pytest.mark.parametrize("seconds", [1e-3, 1.0, 1e3])
def test_a_combined_law_of_one_weight_is_the_single_law(seconds):
    by_shear = replace(BOTH, contact_weight=0.0)
    assert by_shear.dose == SHEARED.dose == CONTACTS.dose
    assert np.array_equal(grown(by_shear, seconds), grown(SHEARED, seconds))
    in_contacts = replace(BOTH, stress_weight=0.0, removal_coefficient=0.0)
    assert grown(in_contacts, seconds) == approx(grown(CONTACTS, seconds), rel=1e-13, abs=0.0)
    assert grown(in_contacts, seconds)[0] == 0.0 < grown(by_shear, seconds)[0]


def test_a_combined_law_adds_the_rates_of_both():
    pressure = np.array([0.0, 1e9, 2e9])
    both = replace(BOTH, contact_weight=0.3, stress_weight=0.7).exposure(pressure, SHEAR, 0.01, WARM)
    alone = CONTACTS.exposure(pressure, SHEAR, 0.01, WARM)
    assert both == approx(0.3 * alone + 0.7 * rate(BELL, pressure, SHEAR), rel=1e-14, abs=0.0)


def test_activated_laws_go_to_any_temperature_and_say_where_they_hold():
    for law in (BELL, PRESSED):
        assert [law.covers(t) for t in (333.0, 333.15, 393.15, 393.3)] == [False, True, True, False]
        assert law.refusal(250.0) == law.refusal(450.0) == ""
    assert [BOTH.covers(t) for t in (WARM, 360.0)] == [True, False]
    assert "tribofilm.beyond_fit = 'extrapolate'" in BOTH.refusal(360.0)
    by_shear = replace(BOTH, contact_weight=0.0)
    assert by_shear.covers(360.0) and by_shear.refusal(360.0) == ""
    for law in (by_shear, replace(BOTH, fit_temperature=400.0)):
        assert "333.15 K to 393.15 K" in law.refusal(400.0)
        assert replace(law, beyond_fit="extrapolate").refusal(400.0) == ""


FULL_FILM = CHEAP | {
    "surface_1.rq": "0 nm",
    "surface_2.rq": "0 nm",
    "lubricant.viscosity.viscosity": "0.1 Pa s",
    "control.mixed_instants": "4",
}


def on_full_film(name):
    """Outputs after three minutes of the MTM's contact on a thick film, sliding much."""
    scene = Scene.from_toml("mtm_zddp", FULL_FILM | {"tribofilm.set": name})
    op = replace(scene.operation.point, speed_1=2.2, speed_2=1.8)
    return advance(scene, op, initial_state(scene), 180.0)[1]


def test_a_full_film_grows_a_tribofilm_by_shear_and_none_by_contact():
    sheared = on_full_film("zhang_spikes_80c_ethylhexyl")
    assert sheared.contact_load_ratio == 0.0
    assert sheared.h_min > 100e-9
    assert sheared.tribofilm_1 > 1e-9 and sheared.tribofilm_2 > 1e-9
    for name in ("zddp_80c", "gosvami"):
        found = on_full_film(name)
        assert found.contact_load_ratio == found.tribofilm_1 == found.tribofilm_2 == 0.0


def test_on_a_full_film_both_bodies_grow_in_proportion_to_their_share_of_time_under_stress():
    found = on_full_film("zhang_spikes_80c_octyl")
    assert found.tribofilm_1 / found.tribofilm_2 == approx(144.51 / 59.847, rel=0.05)  # of track lengths


def test_each_body_is_exposed_at_the_temperature_of_its_own_surface():
    scene, state, op = cheap(CHEAP | {"tribofilm.set": "zhang_spikes_80c_ethylhexyl"})
    fields = solve(scene, op, state)
    hot = np.full(fields.gap.shape, op.temperature + 40.0)
    cool = replace(fields.temperatures, surface_1=op.temperature, surface_2=op.temperature)
    warmed = replace(fields, temperatures=replace(cool, surface_2=hot))
    apart, even = Accumulator.before(state), Accumulator.before(state)
    apart.add(Case(scene, op), state, warmed)
    even.add(Case(scene, op), state, replace(fields, temperatures=cool))
    (first, second), alike = apart.exposures, even.exposures
    assert np.array_equal(first, alike[0])
    rubbed = alike[1] > 0.0
    assert rubbed.any() and np.all(second[rubbed] >= alike[1][rubbed]) and second.max() > alike[1].max()


@pytest.mark.parametrize(("floor", "once"), [(HARD, 1), ({}, 2)], ids=["hard", "microrough"])
def test_a_law_is_asked_once_for_two_bodies_of_one_temperature(monkeypatch, floor, once):
    """Microroughness touches on a share of a node's area: the law is asked for that share and for the rest."""
    scene, state, op = cheap(CHEAP | {"control.mixed_instants": "3"} | floor)
    asked = []

    def counted(self, *node):
        asked.append(1)
        return np.zeros_like(node[0])

    monkeypatch.setattr(Ghanbarzadeh, "exposure", counted)
    sums = Accumulator.before(state)
    fields = solve(scene, op, state)
    sums.add(Case(scene, op), state, fields)
    assert len(asked) == once
    warmer = replace(fields.temperatures, surface_2=fields.temperatures.surface_1 + 1.0)
    sums.add(Case(scene, op), state, replace(fields, temperatures=warmer))
    assert len(asked) == 3 * once


DRY = CHEAP | {"control.driver": "dry", "control.dry_instants": "4"}


def test_a_body_is_abraded_by_the_mean_of_its_instants():
    edges = {"tribofilm.set": "gosvami", "tribofilm.edge_weight": "2"}
    scene, state, op = cheap(DRY | edges, film__points=33)
    fields = solve(scene, op, state, dry=True)
    sums = Accumulator.before(state)
    for _ in range(2):
        sums.add(Case(scene, op), state, fields)
    mean = sums.pressures[0] / sums.count
    reach = scene.film.domain / scene.geometry.track_length_1
    across = across_track(scene, state.rows)
    assert across.shape == (33, 1) and across.min() == 0.0
    assert across.max() == approx(0.5 * scene.film.domain / scene.hertz(op.load).b, rel=1e-12)
    now = scene.tribofilm.abrasion(on_patch(fields.solid_pressure, patch_nodes(scene, state.bodies[0])), 0.005, across)
    assert scene.tribofilm.abrasion(mean * reach, 0.005, across) == approx(now * reach, rel=1e-12, abs=0.0)
    after, _ = advance(scene, op, state, 0.0)
    for body in after.bodies:
        expected = scene.tribofilm.abrasion(body.pressure, op.sliding_speed, across)
        assert body.abrasion.any() and np.array_equal(body.abrasion, expected)


def test_removal_at_the_edges_leaves_the_middle_of_the_track_as_thick():
    films = {}
    for weight in ("0", "5"):
        changes = DRY | HARD | {"tribofilm.set": "gosvami", "tribofilm.edge_weight": weight, "wear.model": "none"}
        changes |= {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm"}
        scene, state, op = cheap(changes, control__longest="600 s", control__change="1 um")
        state, _ = advance(scene, op, state, 3600.0)
        films[weight] = state.bodies[0].growth.mean(axis=1)
    share = films["5"] / np.maximum(films["0"], 1e-12)
    across = across_track(scene, state.rows)[:, 0]
    assert share[across < 0.1] == approx(1.0, abs=0.03)
    edge = (across > 0.7) & (across < 0.9)
    assert np.all(share[edge] < 0.85)


@pytest.mark.parametrize("law", [NoTribofilm, Ghanbarzadeh, Andersson])
def test_laws_without_first_order_removal_abrade_nothing(law):
    assert not law.abrades
    changes = {"none": {"tribofilm.model": "none"}, "andersson": {"tribofilm.set": "andersson_90c"}}
    scene, state, op = cheap(DRY | changes.get(law.name, {}))
    assert isinstance(scene.tribofilm, law)
    state, _ = advance(scene, op, state, 30.0)
    assert not any(body.abrasion.any() for body in state.bodies)


def test_a_run_with_removal_is_cut_and_continued_to_the_same_bits():
    scene, state, op = cheap(DRY | {"tribofilm.set": "gosvami"})
    state, _ = advance(scene, op, state, 40.0)
    restored = ContactState.from_bytes(state.to_bytes(), scene)
    assert advance(scene, op, restored, 40.0)[0].to_bytes() == advance(scene, op, state, 40.0)[0].to_bytes()


@pytest.mark.parametrize(("volume", "more"), [(0.13e-27, 1.1), (1e-31, 0.98)])
def test_the_regression_level_takes_the_oils_stress_by_the_pressure_not_by_its_mean(volume, more):
    scene = Scene.from_toml("ball_209_inner", {"film.model": "regression", "tribofilm.set": "zhang_spikes_80c_octyl"})
    law = replace(scene.tribofilm, activation_volume=volume)
    case = Case.bind(replace(scene, tribofilm=law), scene.operation.point)
    contact = MeanContact(**{name: 0.0 for name in MeanContact._fields} | {"fluid_shear": 60e6, "slide": 0.05})
    radius = np.linspace(0.0, 1.0, 20001)
    shear = 1.5 * 60e6 * np.sqrt(1.0 - radius**2)
    mean = np.trapezoid(2.0 * radius * law.exposure(0.0 * shear, shear, 0.05, WARM), radius)
    assert _oiled(case, contact, WARM) == approx(mean, rel=0.01)
    assert mean > more * float(law.exposure(0.0, 60e6, 0.05, WARM))
