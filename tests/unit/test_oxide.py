"""Oxide on the solids where no tribofilm covers them: `oxide.model = "logarithmic"`."""

import math
from dataclasses import replace

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap
from comparison import approx

from contact_core import advance, initial_state, solve
from contact_core.deterministic.friction import derivatives
from contact_core.laws.oxide import Logarithmic, NoOxide
from contact_core.regression.contact import evaluate
from contact_core.regression.exposure import oxidation, oxidised, track_area, wear_rate
from contact_core.regression.surfaces import tribofilms_of
from contact_core.scene import Case
from contact_core.surfaces.track_means import means_of

LAW = Logarithmic()
DRY = CHEAP | {"control.driver": "dry", "control.dry_instants": "2"}
ON = {"oxide.model": "logarithmic"}
BARE = {"tribofilm.model": "none"}
LEVELS = ("deterministic", "regression")
LOW, HIGH = {"oxide.friction": "0.05"}, {"oxide.friction": "0.2"}


def marched(oxide, growing, rubbing, steps=200_000):
    """Oxide and what was rubbed off it [m], by steps of Euler's rule that take no more than there is."""
    lost = 0.0
    for _ in range(steps):
        oxide += growing * math.exp(-oxide / LAW.scale) / steps
        taken = min(rubbing / steps, oxide)
        oxide, lost = oxide - taken, lost + taken
    return oxide, lost


@pytest.mark.parametrize(
    ("oxide", "growing", "rubbing"),
    [
        (0.0, 3e-7, 0.0),
        (0.0, 3e-7, 1e-9),
        (2.5e-9, 1e-9, 3e-9),  # reaches the bare solid
        (2.5e-9, 1e-9, 2e-9),
        (0.3e-9, 0.0, 1e-9),
        (0.0, 1e-10, 5e-10),  # rubbed off as it grows
    ],
)
def test_an_oxide_is_the_integral_of_its_growth_and_its_wear(oxide, growing, rubbing):
    after, lost = LAW.evolve(np.array([oxide]), np.array([growing]), np.array([rubbing]))
    expected, taken = marched(oxide, growing, rubbing)
    assert after == approx(expected, rel=2e-3, abs=1e-14)
    assert lost == approx(taken, rel=2e-3, abs=1e-14)


def test_the_default_oxide_is_about_as_thick_as_measured_on_iron_and_slows_down():
    hour = LAW.growth(300.0) * 3600.0
    films = [float(LAW.evolve(0.0, time * hour, 0.0)[0]) for time in (1.0, 10.0, 100.0)]
    assert films[0] == approx(2.5e-9, rel=0.01)
    assert np.diff(films) == approx(0.2e-9 * math.log(10.0), rel=1e-4)


def test_without_a_law_there_is_no_oxide_and_no_friction_of_it():
    scene, state, op = cheap(DRY)
    assert isinstance(scene.oxide, NoOxide)
    state, outputs = advance(scene, op, state, 5.0)
    assert outputs.oxide_1 == outputs.oxide_2 == 0.0
    assert solve(scene, op, state, dry=True).sheared.oxide is None


@pytest.mark.parametrize("level", LEVELS)
def test_an_oxide_grows_on_bare_steel_in_a_contact_without_wear_of_it_as_its_law_says(level):
    scene, _, op = cheap(DRY | BARE | ON | {"oxide.wear": "0"})
    scene = scene.at_level(level)
    state, _ = advance(scene, op, initial_state(scene), 10.0)
    _, outputs = advance(scene, op, state, 50.0)
    expected = LAW.scale * math.log1p(LAW.growth(op.temperature) * 60.0 / LAW.scale)
    assert outputs.oxide_1 == approx(expected, rel=1e-9)


def test_halfway_through_a_step_an_oxide_is_what_half_of_its_time_makes():
    """By the growth without wear, x_0 ln(1 + A t / x_0), which is more than half of what the whole step makes."""
    scene, _, op = cheap(DRY | BARE | ON | {"oxide.wear": "0"})
    scene = scene.at_level("regression")
    case = Case.bind(scene, op)
    contact = evaluate(case, tribofilms_of(means_of(scene, initial_state(scene))))
    after, halfway, lost = oxidised(case, case.sides[0], contact, 0.0, 0.0, 60.0)
    grown = LAW.growth(op.temperature) * np.array([60.0, 30.0]) / LAW.scale
    assert [after, halfway] == approx(LAW.scale * np.log1p(grown), rel=1e-9)
    assert lost == 0.0


def test_what_is_rubbed_off_bare_steel_is_what_oxidises_and_a_tribofilm_keeps_both_from_it():
    """However hard it is rubbed; 10 nm of film leave 1/e of the growth and of the wear of the oxide."""
    scene, state, op = cheap(DRY | BARE | ON | {"oxide.wear": "1", "wear.bare": "0", "wear.film": "0"})
    scene = scene.at_level("regression")
    case = Case.bind(scene, op)
    contact, side = evaluate(case, tribofilms_of(means_of(scene, state))), case.sides[1]
    growing, rubbing = oxidation(case, side, contact, 0.0)
    assert rubbing > 2.0 * growing > 0.0
    steel = track_area(case, side) / scene.oxide.volume_ratio
    assert wear_rate(case, side, contact, 0.0, 0.0) == approx(growing * steel)
    assert wear_rate(case, side, contact, 0.0, 1e-9) == approx(rubbing * steel)
    assert oxidation(case, side, contact, 10e-9) == approx((growing / np.e, rubbing / np.e))


@pytest.mark.parametrize("level", LEVELS)
def test_rubbing_thins_an_oxide_and_a_tribofilm_leaves_it_less_room(level):
    def oxide(**more):
        scene, _, op = cheap(DRY | ON | more)
        scene = scene.at_level(level)
        return advance(scene, op, initial_state(scene), 60.0)[1].oxide_2

    kept, worn = (oxide(**BARE, **{"oxide.wear": wear}) for wear in ("0", "1e-4"))
    assert 0.0 < worn < kept
    full = oxide(**{"oxide.wear": "0", "tribofilm.rate_factor": "4e-14", "tribofilm.removal_thickness": "0 m"})
    assert full < kept


@pytest.mark.parametrize("level", LEVELS)
def test_an_oxide_bears_its_own_friction_between_bare_and_covered_solids(level):
    def friction(**more):
        scene, _, op = cheap(DRY | {"boundary_friction.bare": "0.13"} | more)
        scene = scene.at_level(level)
        state, _ = advance(scene, op, initial_state(scene), 60.0)
        return advance(scene, op, replace(state, solved_for=None), 0.0)[1].friction_coefficient

    bare = friction(**BARE)
    closed = {"oxide.wear": "0", "oxide.closed": "0.5 nm"}  # it bears all of the solid
    low, high = (friction(**BARE, **ON, **closed, **change) for change in (LOW, HIGH))
    assert low < bare < high
    open_ones = friction(**BARE, **ON, **LOW, **{"oxide.wear": "0", "oxide.closed": "1 um"})
    assert low < open_ones < bare


def test_an_oxide_rubs_where_no_tribofilm_lies():
    bare, closed = LAW.friction + 0.05, np.array([0.0, 0.4, 1.0])
    assert LAW.added_friction(bare, 1.0, closed) == approx(-0.05 * np.array([1.0, 0.6, 0.0]))
    assert LAW.added_friction(bare, 0.5, 0.0) == approx(-0.025)


def test_friction_under_a_closed_oxide_is_that_of_solids_with_its_coefficient():
    scene, state, op = cheap(DRY | BARE | ON | {"oxide.friction": "0.07"})
    bodies = tuple(replace(body, oxide=np.full_like(body.oxide, 5e-9)) for body in state.bodies)
    fields = solve(scene, op, replace(state, bodies=bodies), dry=True)
    assert abs(fields.friction.force_solid) == approx(0.07 * op.load, rel=1e-6)


def test_the_derivative_by_speed_holds_the_friction_of_oxide():
    scene, state, op = cheap(DRY | BARE | ON | HIGH | {"boundary_friction.slip_speed": "10 mm/s"})
    bodies = tuple(replace(body, oxide=np.full_like(body.oxide, 1e-9)) for body in state.bodies)
    state = replace(state, bodies=bodies)
    step = 1e-5

    def force(speed):
        return solve(scene, replace(op, speed_1=speed), state, dry=True).friction.force_solid

    fields = solve(scene, op, state, dry=True)
    found = derivatives(Case(scene, op), fields.sheared)["dfriction_dspeed_1"]
    slope = (force(op.speed_1 + step) - force(op.speed_1 - step)) / (2.0 * step)
    assert found == approx(slope, rel=1e-4)


@pytest.mark.parametrize("level", LEVELS)
def test_steel_is_lost_with_the_oxide_that_is_rubbed_off_and_only_so_under_a_closed_one(level):
    """Bare solids that do not wear by themselves lose what is in the oxide: K p v / H over the volume ratio."""

    def lost(**more):
        wear = {} if "wear.model" in more else {"wear.bare": "0", "wear.film": "0"}
        scene, _, op = cheap(DRY | BARE | ON | wear | more)
        scene = scene.at_level(level)
        state, _ = advance(scene, op, initial_state(scene), 1e-3)
        before = state.outputs.wear_volume_1
        return advance(scene, op, state, 20.0)[1].wear_volume_1 - before

    mild = lost(**{"oxide.wear": "1e-6"})
    assert mild > 0.0
    assert lost(**{"oxide.wear": "1e-6", "oxide.volume_ratio": "4.28"}) == approx(0.5 * mild, rel=1e-6)
    assert lost(**{"wear.model": "none"}) == 0.0
    protected = {"oxide.wear": "0", "oxide.closed": "0.5 nm", "wear.bare": "1e-5"}
    open_ones = {"oxide.wear": "0", "oxide.closed": "1 um", "wear.bare": "1e-5"}
    assert lost(**protected) < 0.05 * lost(**open_ones)


@pytest.mark.parametrize("level", LEVELS)
def test_the_wear_rate_of_a_held_contact_is_that_of_the_next_moment(level):
    scene, _, op = cheap(DRY | BARE | ON)
    scene = scene.at_level(level)
    state, _ = advance(scene, op, initial_state(scene), 5.0)
    now = advance(scene, op, state, 0.0)[1].wear_rate_1
    assert advance(scene, op, state, 1e-4)[1].wear_rate_1 == approx(now, rel=1e-3)


def test_the_oxide_goes_through_changes_of_the_level():
    scene, state, op = cheap(DRY | ON)
    state, first = advance(scene, op, state, 5.0)
    state, second = advance(scene.at_level("regression"), op, state, 0.0)
    _, third = advance(scene, op, state, 0.0)
    assert first.oxide_1 == approx(second.oxide_1, rel=1e-12) == approx(third.oxide_1, rel=1e-12)
