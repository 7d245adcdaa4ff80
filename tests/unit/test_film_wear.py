"""Tribofilm worn before the solid (`wear.model = "film_first"`), and the ledger of what grows and is removed."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap
from comparison import approx

from contact_core import ContactState, Scene, SceneError, advance, initial_state, run_cycle
from contact_core.deterministic.growth_and_wear import evolved
from contact_core.laws.tribofilm import Ghanbarzadeh, thickness
from contact_core.laws.wear import Archard, FilmFirst
from contact_core.regression.contact import evaluate
from contact_core.regression.exposure import abrasion, track_area
from contact_core.regression.surfaces import tribofilms_of
from contact_core.scene import Case
from contact_core.surfaces.track_means import means_of

FIRST = FilmFirst(1e-5, 1e-6)
FULL = 176e-9
WARM = 363.15
DRY = CHEAP | {"control.driver": "dry", "control.dry_instants": "2"}
WORN = {"wear.model": "film_first", "wear.bare": "1e-5", "wear.film": "1e-4"}  # a film that wears fast
SETS = ("zddp_90c", "andersson_90c", "zhang_spikes_80c_ethylhexyl", "combined_80c")
LEVELS = ("deterministic", "regression")
DUTY = ((5.0, 60.0, 0.26), (20.0, 40.0, 0.25), (7.0, 70.0, 0.3), (40.0, 0.0, 0.2), (9.0, 77.0, 0.24))  # s, N, m/s


def of_set(name):
    """Changes of a scene to a named set, also where its temperature is not that of the fit."""
    by_stress = name.startswith("zhang")
    return {"tribofilm.set": name} | ({} if by_stress else {"tribofilm.beyond_fit": "extrapolate"})


def rates_of(law):
    """The rates of growth and of the law's own removal per exposure, over the room left, as a fresh film shows them."""
    tiny = np.array(
        [1e-9 * law.full_thickness / max(getattr(law, "growth_per_energy", 0.0), law.full_thickness * 1e-3)]
    )
    growth, removal = law.evolve(np.zeros(1), np.zeros(1), tiny, np.zeros(1), WARM)
    limit = getattr(law, "removal_thickness", 0.0)
    losing = removal[0] / limit / tiny[0] if limit > 0.0 else 0.0
    return growth[0] / law.full_thickness / tiny[0], losing, limit


def marched(law, film, exposing, abrading, steps=2_000):
    """The film [m], and what grew and what rubbing took, after a unit of time, by the midpoint rule on the rates."""
    per_exposure, own, limit = rates_of(law)
    forming, losing = per_exposure * exposing, own * exposing
    growth, removal = film
    grown = rubbed = 0.0

    def rates(growth, removal):
        return forming * (law.full_thickness - growth), abrading * (growth - removal), losing * (limit - removal)

    for _ in range(steps):
        up, off, own = rates(growth, removal)
        half = 0.5 / steps
        up, off, own = rates(growth + half * (up - off), removal + half * own)
        growth, removal = growth + (up - off) / steps, removal + own / steps
        grown, rubbed = grown + up / steps, rubbed + off / steps
    return growth - removal, grown, rubbed


@pytest.mark.parametrize("name", SETS)
@pytest.mark.parametrize(("forming", "abrading"), [(3.0, 0.0), (3.0, 0.3), (6.0, 4.0), (0.0, 1.5)])
def test_film_and_what_has_grown_are_the_integrals_of_their_rates(name, forming, abrading):
    law = Scene.from_toml("azam_case_a", of_set(name)).tribofilm
    exposing = forming / rates_of(law)[0]
    start = np.array([30e-9]), np.array([10e-9 if hasattr(law, "removal_thickness") else 0.0])
    dose = np.array([exposing]), np.array([abrading]), WARM
    after = law.evolve(*start, *dose)
    film, grown, rubbed = marched(law, start, exposing, abrading)
    assert thickness(*after) == approx(film, rel=1e-5)
    found = law.formed(*start, after[0], *dose)
    assert found == approx(grown, rel=1e-5, abs=1e-20)
    own = after[1] - start[1]  # of the law itself
    assert (start[0] - start[1]) + found - own - rubbed == approx(thickness(*after), rel=1e-5)


def test_steel_wears_e_times_less_under_every_ten_nanometres_of_film():
    covers = np.array([0.0, 10e-9, 20e-9]) / FULL
    found = FIRST.rate(np.full(3, 1e8), covers, (0.2, 0.25), 0, 6e9, FULL)
    assert found == approx(1e-5 * 1e8 * 0.05 / 6e9 * np.exp([0.0, -1.0, -2.0]), rel=1e-12, abs=0.0)


def test_a_full_film_loses_an_archard_volume_with_its_own_coefficient_and_hardness():
    rate = FIRST.film_removal(1e8, (0.2, 0.25), 0, 2e9, FULL)
    assert rate * FULL == approx(1e-6 * 1e8 * 0.05 / 2e9, rel=1e-12, abs=0.0)
    assert Archard(1e-5, 1e-6).film_removal(1e8, (0.2, 0.25), 0, 2e9, FULL) == 0.0


@pytest.mark.parametrize(
    ("speeds", "part"),
    [((0.3, 0.25), 1.0), ((0.05, 0.0), 1.0), ((0.3, 0.25), 0.3)],
    ids=["both move", "one is at rest", "a part of the load"],
)
def test_tracks_of_the_regression_level_lose_archards_volume_of_film_for_the_force_on_their_solids(speeds, part):
    """K W v / H with the hardness of a full film, however long and wide the tracks are."""
    scene, state, op = cheap(DRY | WORN)
    scene, op = scene.at_level("regression"), replace(op, load=part * op.load, speed_1=speeds[0], speed_2=speeds[1])
    case = Case.bind(scene, op)
    contact = evaluate(case, tribofilms_of(means_of(scene, state)))
    force, sliding = contact.load_ratio * op.load, abs(speeds[0] - speeds[1])
    assert scene.plasticity.film_hardness < 0.9 * scene.plasticity.hardness
    for side in case.sides:
        lost = abrasion(case, side, contact) * scene.tribofilm.full_thickness * track_area(case, side)
        assert lost == approx(1e-4 * force * sliding / scene.plasticity.film_hardness, rel=1e-9)


def test_wear_of_steel_falls_while_the_film_covers_and_rises_again_where_it_is_rubbed_away():
    scene, state, op = cheap(DRY | WORN)
    state, _ = advance(scene, op, state, 1.0)
    case = Case(scene, op)
    side, body = case.sides[1], state.bodies[1]
    rubbed = (body.exposure > 0.0) & (body.pressure > 0.0)
    worn = []
    for _ in range(6):
        before, body = body, evolved(case, side, body, 100.0, 0.0)
        worn.append(float((body.wear - before.wear)[rubbed].mean()))
    assert all(late < early for early, late in pairwise(worn))
    assert worn[-1] < 0.5 * worn[0]
    body = replace(body, exposure=np.zeros_like(body.exposure), pressure=np.full_like(body.pressure, 2e6))
    bare = []
    for _ in range(6):
        before, body = body, evolved(case, side, body, 100.0, 0.0)
        bare.append(float((body.wear - before.wear)[rubbed].mean()))
    assert all(late > early for early, late in pairwise(bare))
    assert body.tribofilm[rubbed].mean() < 0.5 * body.formed[rubbed].mean()


def test_a_film_that_wears_faster_is_thinner():
    films = []
    for wear in (0.0, 1e-5, 1e-4, 1e-3):
        scene, state, op = cheap(WORN | {"wear.film": str(wear)})
        scene = scene.at_level("regression")
        films.append(advance(scene, op, state, 1800.0)[1].tribofilm_1)
    assert all(more > less for more, less in pairwise(films))
    assert films[-1] < 0.7 * films[0]


def driven(scene, state, duty=DUTY, kill=None):
    """States and outputs of a duty; before step `kill` the state goes through its bytes."""
    found = []
    for i, (time, load, speed) in enumerate(duty):
        if i == kill:
            state = ContactState.from_bytes(state.to_bytes(), scene)
        op = replace(scene.operation.point, load=load, speed_1=speed)
        state, outputs = advance(scene, op, state, time)
        found.append((state, outputs))
    return found


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("name", SETS)
def test_film_grown_less_film_removed_is_the_film_in_every_row_and_neither_ever_falls(level, name):
    scene = cheap(DRY | WORN | of_set(name))[0].at_level(level)
    rows = [outputs for _, outputs in driven(scene, initial_state(scene))]
    for body in (1, 2):
        grown, removed, film = (
            np.array([getattr(row, f"{of}_{body}") for row in rows])
            for of in ("tribofilm_grown", "tribofilm_removed", "tribofilm")
        )
        assert grown - removed == approx(film, rel=1e-12)
        assert grown[-1] > 1e-10
        assert np.all(np.diff(grown) >= 0.0)
        assert np.all(np.diff(removed) >= -1e-12 * grown[-1])


@pytest.mark.parametrize("level", LEVELS)
def test_without_wear_of_the_film_the_ledger_is_growth_and_removal_of_the_law(level):
    scene = cheap(DRY)[0].at_level(level)
    state, _ = driven(scene, initial_state(scene))[-1]
    for surface in state.means or state.bodies:
        assert surface.formed == approx(surface.growth, rel=1e-12, abs=1e-21)
        removed = surface.formed - thickness(surface.growth, surface.removal)
        assert removed == approx(surface.removal, rel=1e-12, abs=1e-21)


@pytest.mark.parametrize("level", LEVELS)
def test_a_run_that_is_killed_and_resumed_keeps_film_ledger_and_oxide_to_the_bit(level):
    scene = cheap(DRY | WORN | {"oxide.model": "logarithmic"})[0].at_level(level)
    straight = driven(scene, initial_state(scene))
    resumed = driven(scene, initial_state(scene), kill=3)
    assert resumed[-1][0].to_bytes() == straight[-1][0].to_bytes()
    assert resumed[-1][1] == straight[-1][1]
    assert straight[-1][1].oxide_1 > 0.0


def test_the_ledger_is_the_same_for_any_cutting_of_a_held_block():
    scene, state, op = cheap(DRY | WORN)
    state, _ = advance(scene, op, state, 1.0)
    case = Case(scene, op)
    whole = evolved(case, case.sides[0], state.bodies[0], 40.0, 0.5)
    body = state.bodies[0]
    for step in (0.5, 3.0, 11.5, 25.0):
        body = evolved(case, case.sides[0], body, step, 0.5)
    for name in ("growth", "removal", "formed"):
        assert getattr(body, name) == approx(getattr(whole, name), rel=1e-12, abs=1e-21)
    volume = float((body.formed - body.tribofilm).sum())  # removed, over the whole body
    assert volume == approx(float((whole.formed - whole.tribofilm).sum()), rel=1e-12, abs=0.0)


def test_the_ledger_closes_through_changes_of_the_level():
    scene, state, op = cheap(DRY | WORN)
    mean = scene.at_level("regression")
    before = 0.0
    for step, at in ((20.0, scene), (300.0, mean), (5.0, scene), (200.0, mean), (0.0, scene)):
        state, outputs = advance(at, op, state, step)
        assert outputs.tribofilm_grown_2 - outputs.tribofilm_removed_2 == approx(outputs.tribofilm_2, rel=1e-12)
        assert outputs.tribofilm_grown_2 >= before
        before = outputs.tribofilm_grown_2 * (1.0 - 1e-12)


def test_cycles_of_a_duty_keep_the_ledger():
    scene, state, op = cheap(DRY | WORN, operation__speed_1="1 m/s")
    spacing = scene.film.spacing
    times = np.linspace(0.0, 6.0 * spacing, 4)
    state, _ = run_cycle(scene, state, lambda _: op, times, 1e4)
    for body in state.bodies:
        assert body.formed.max() > 0.0
        assert np.all(body.formed - body.tribofilm >= -1e-12 * body.formed.max())
        assert np.any(body.formed > body.growth + 1e-15)  # some was rubbed off


def test_a_tribofilm_without_a_closed_form_under_wear_is_refused(monkeypatch):
    monkeypatch.setattr(Ghanbarzadeh, "takes_abrasion", False)
    with pytest.raises(SceneError, match=r"'film_first' takes tribofilm .* Use wear.model = 'archard'"):
        Scene.from_toml("azam_case_a", WORN)
