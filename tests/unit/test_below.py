"""Stresses and damage below the surfaces in a scene, and what it costs one that does not ask for them."""

from dataclasses import replace

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap
from comparison import approx

from contact_core import ContactState, RangeFlag, SceneError, advance, initial_state
from contact_core.deterministic import damage
from contact_core.deterministic.subsurface import Traction, passed
from contact_core.scene import Case
from contact_core.surfaces.patches import heights_of, track_rows

DRY = CHEAP | {"control.driver": "dry", "control.dry_instants": "3"}
STRESSED = DRY | {"stress.model": "half_space", "stress.layers": "6"}
TIRED = STRESSED | {
    "stress.pits": "open",
    "fatigue.model": "basquin",
    "fatigue.reference_stress": "800 MPa",
    "fatigue.reference_cycles": "1e4",
    "fatigue.life_exponent": "6",
}
SMOOTH = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm", "wear.model": "none", "tribofilm.model": "none"}
OLD = ("friction_coefficient", "h_c", "wear_depth_1", "tribofilm_1", "contact_load_ratio")
OF_STRESS = ("von_mises_max", "von_mises_depth", "near_surface_share", "dang_van_ratio", "crossland_ratio")


def run(changes, *steps, **more):
    """The scene, and states and outputs after steps [s]."""
    scene, state, op = cheap(changes, **more)
    found = []
    for step in steps:
        state, outputs = advance(scene, op, state, step)
        found.append((state, outputs))
    return scene, op, found


def test_a_scene_that_does_not_ask_has_nothing_below_and_one_that_asks_samples_other_places_of_the_same_contact():
    _, _, plain = run(DRY, 20.0, 20.0)
    _, _, asked = run(STRESSED, 20.0, 20.0)
    for (state, bare), (_, seen) in zip(plain, asked, strict=True):
        assert state.below is None
        assert not any(getattr(bare, name) for name in (*OF_STRESS, "damage_1", "micropitted_area_1", "error_damage"))
        assert [getattr(bare, name) for name in OLD] == approx([getattr(seen, name) for name in OLD], rel=0.25)
    assert all(getattr(asked[-1][1], name) > 0.0 for name in OF_STRESS)


def test_smooth_bodies_have_hertz_s_stress():
    """Von Mises .62 p0 at .48 a without friction, and Tresca's .31 p0: Johnson 1985, section 3.4, for nu = 0.3."""
    changes = STRESSED | SMOOTH | {"film.points": "65", "stress.layers": "16", "film.tolerance": "1e-3"}
    scene, op, _ = run(changes)
    rolling = replace(op, speed_1=0.25, speed_2=0.25)
    hertz = scene.hertz(op.load)
    _, outputs = advance(scene, rolling, initial_state(scene), 1.0)
    assert outputs.von_mises_max == approx(0.62 * hertz.pressure_max, rel=0.02)
    assert outputs.von_mises_depth == approx(0.48 * hertz.a, rel=0.2)  # of the nearest layer
    assert outputs.near_surface_share < 0.02


@pytest.mark.parametrize("driver", ["dry", "mixed"])
def test_the_first_block_of_an_operating_point_is_a_whole_pass(driver):
    """A known pass is as long as the grid, its instants evenly apart; a change of the load begins another one."""
    scene, op, found = run(STRESSED | {"control.driver": driver}, 0.0)
    state = found[0][0]
    again, outputs = advance(scene, replace(op, load=0.7 * op.load), state, 0.0)
    columns, instants = scene.film.points - 1, scene.stress.instants
    for each in (state, again):
        places = each.below.places[:, 0 if abs(op.speed_1) > abs(op.speed_2) else 1]
        assert len(places) == instants
        assert set(np.diff(places) % columns) <= {columns // instants, columns // instants + 1}
    assert outputs.von_mises_max < found[0][1].von_mises_max


def test_a_point_under_a_fixed_pressure_sees_it_pass():
    """Of a pressure that stands still over a moving body each column of the patch has the same history."""
    scene, op, _ = run(STRESSED | SMOOTH)
    op = replace(op, speed_1=0.25, speed_2=0.25)
    state, _ = advance(scene, op, initial_state(scene), 0.0)
    case = Case.bind(scene, op)
    below, rows = state.below, state.rows
    columns = scene.film.points - 1
    found = passed(case, rows, [Traction(below.pressure[:rows], below.shear[:rows], (k, k)) for k in range(columns)])
    shear = found.cycles[0].shear
    assert np.ptp(shear, axis=2).max() < 1e-9 * shear.max()


def test_damage_under_constant_cycles_is_their_number_times_that_of_one():
    changes = TIRED | {"wear.model": "none", "control.longest": "1e6 s", "tribofilm.model": "none"}
    scene, op, found = run(changes, 0.0, 3.0, 4.0, 5.0)
    first, last = found[0][0], found[-1][0]
    side = Case.bind(scene, op).sides[0]
    assert first.below is not None
    assert len(last.below.places) == len(first.below.places)  # one block
    exact = damage.cycles_in(side, 12.0) * first.below.per_cycle_1
    assert last.below.damage_1 == approx(exact, rel=1e-14)
    assert last.outputs.load_cycles_1 == approx(damage.cycles_in(side, 12.0), rel=1e-14)


def test_wear_takes_damage_away():
    gone = [run(TIRED, 30.0, 30.0, wear__bare=bare)[2][-1] for bare in ("1e-9", "3e-4")]
    (_, kept), (_, worn) = gone
    assert worn.wear_depth_1 > 100.0 * kept.wear_depth_1
    assert worn.damage_1 < 0.9 * kept.damage_1


def test_what_fails_breaks_out_of_the_surface_with_its_tribofilm():
    scene, _, found = run(TIRED, 30.0, 30.0, 60.0, fatigue__reference_cycles=60)
    state, outputs = found[-1]
    for i, body in enumerate(state.bodies):
        pitted = body.pits > 0.0
        track = track_rows(scene, state.rows)
        assert outputs_of(outputs, "micropitted_area", i) == approx(float(pitted[track].mean()), rel=1e-12)
        lost = (body.wear + body.pits)[track].mean()
        assert outputs_of(outputs, "profile_loss", i) == approx(float(lost), rel=1e-12)
        bare = np.zeros_like(body.wear)
        assert np.array_equal(heights_of(bare, body), -body.wear - body.plastic - body.opened + body.tribofilm)
    assert outputs.micropitted_area_1 > 0.0
    flagged = [RangeFlag.PITTED in RangeFlag(out.range_flags) for _, out in found]
    assert flagged == [out.micropitted_area_1 + out.micropitted_area_2 > 0.0 for _, out in found]
    assert state.below.damage_1.max() < 1.0
    earlier = [out.micropitted_area_1 for _, out in found]
    assert earlier == sorted(earlier)


def outputs_of(outputs, name, i):
    return getattr(outputs, f"{name}_{i + 1}")


def test_pits_that_are_only_counted_change_nothing_but_their_outputs():
    """The contact is that of a scene without fatigue, bit for bit; the area is that of what has failed."""
    tired = TIRED | {"stress.pits": "counted", "fatigue.reference_cycles": "60"}
    scene, _, counted = run(tired, 20.0, 20.0)
    _, _, none = run(STRESSED, 20.0, 20.0)
    state, outputs = counted[-1]
    for name in (*OLD, *OF_STRESS, "roughness_1", "h_min"):
        assert getattr(outputs, name) == getattr(none[-1][1], name)
    failed = state.below.damage_1.reshape(6, state.rows, -1).max(axis=0) >= 1.0
    track = track_rows(scene, state.rows)
    assert 0.0 < failed[track].mean() <= outputs.micropitted_area_1  # wear has taken some that failed
    assert outputs.profile_loss_1 > outputs.wear_depth_1
    assert state.below.damage_1.max() == 1.0
    assert not state.bodies[0].opened.any()


def test_in_near_rolling_a_pass_keeps_the_same_asperities_facing_until_it_is_over():
    scene, op, found = run(STRESSED, 0.0, control__longest="1 s", control__change="1 um")
    state, slips = found[0][0], []
    columns = scene.film.points - 1
    for _ in range(8):
        state, _ = advance(scene, op, state, 1.0)
        slips.append({round(a - b) % columns for a, b in state.below.places})
    assert all(max(slip) - min(slip) <= 1 for slip in slips)
    assert len(set().union(*slips)) > 2


def test_a_block_ends_when_much_of_a_track_breaks_out():
    scene, state, op = cheap(TIRED | {"control.change": "1 um", "control.longest": "200 s"})
    state, _ = advance(scene, op, state, 0.0)
    case = Case.bind(scene, op)
    due = damage.pit_time(case, state)
    assert 0.05 * scene.control.longest < state.hold <= due < np.inf
    after, _ = damage.fatigued(case, state, state.bodies, due * (1.0 + 1e-9))
    _, pitted = damage.fatigued(case, state, state.bodies, due * (1.0 + 1e-9))
    shares = [float((body.pits[track_rows(scene, state.rows)] > 0.0).mean()) for body in pitted]
    assert after is not None
    assert max(shares) == approx(damage._BATCH, abs=0.003)


def test_without_a_load_nothing_tires():
    scene, state, op = cheap(TIRED)
    state, _ = advance(scene, op, state, 5.0)
    harmed = state.below.damage_1
    state, outputs = advance(scene, replace(op, load=0.0), state, 50.0)
    assert np.array_equal(state.below.damage_1, harmed)
    assert outputs.von_mises_max == 0.0
    state, outputs = advance(scene, op, state, 5.0)
    assert outputs.von_mises_max > 0.0
    assert state.below.damage_1.max() > harmed.max()


def test_a_state_with_damage_is_stored_and_goes_on_bit_for_bit():
    scene, op, found = run(TIRED, 10.0, 10.0)
    state = found[-1][0]
    back = ContactState.from_bytes(state.to_bytes(), scene)
    assert back.to_bytes() == state.to_bytes()
    one, other = (advance(scene, op, each, 20.0)[0] for each in (state, back))
    assert one.to_bytes() == other.to_bytes()
    again, _ = advance(scene, op, found[0][0], 10.0)  # rolled back
    assert again.to_bytes() == state.to_bytes()


def test_a_state_of_other_depths_is_refused():
    scene, _, found = run(TIRED, 1.0)
    other, _, _ = cheap(TIRED, stress__layers=7)
    with pytest.raises(Exception, match="another contact"):
        ContactState.from_bytes(found[0][0].to_bytes(), other)
    assert scene.digest() != other.digest()


def test_wider_patches_keep_their_damage_in_its_rows():
    _, _, found = run(TIRED, 5.0)
    state = found[0][0]
    more = 8
    wide = damage.widened(state.below, state.rows, more)
    layers = state.below.damage_1.reshape(6, state.rows, -1)
    wider = wide.damage_1.reshape(6, state.rows + 2 * more, -1)
    assert np.array_equal(wider[:, more:-more], layers)
    assert not wider[:, :more].any()


def test_damage_stays_within_its_stated_error_when_blocks_are_half_as_long():
    def after(longest):
        _, _, found = run(TIRED, 240.0, control__longest=f"{longest} s", control__change="1 um")
        return found[-1][1]

    long, short = after(40.0), after(20.0)
    for i in (1, 2):
        one, other = getattr(long, f"damage_{i}"), getattr(short, f"damage_{i}")
        stated = np.hypot(one * long.error_damage, other * short.error_damage)
        assert abs(one - other) < stated


def test_the_error_by_few_instants_covers_what_many_find_and_a_tenth_of_it_would_not():
    def after(instants):
        given = {"stress__instants": instants, "control__dry_instants": instants, "control__longest": "20 s"}
        _, _, found = run(TIRED, 20.0, **given)
        return found[-1]

    (state, few), (_, many) = after(8), after(32)
    for i in (0, 1):
        missed = abs(outputs_of(few, "damage", i) - outputs_of(many, "damage", i))
        stated = np.hypot(*state.below.errors(i))
        assert 0.1 * stated < missed < stated


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"fatigue.model": "basquin", "fatigue.reference_stress": "1 GPa", "fatigue.life_exponent": "9"}, "needs the"),
        ({"stress.model": "half_space", "stress.bending_limit": "9 GPa"}, "1 to 2 times"),
        ({"stress.model": "half_space", "stress.layers": "1"}, "at least 2"),
    ],
)
def test_tables_that_cannot_be_are_refused_with_a_way_out(changes, said):
    with pytest.raises(SceneError, match=said):
        cheap(DRY | changes)


def test_a_pit_is_no_deeper_before_the_contact_is_solved_again():
    """Its ground is out of contact; the caller's steps decide nothing."""
    changes = TIRED | {"fatigue.reference_stress": "300 MPa", "control.longest": "1e6 s", "control.change": "1e-6 m"}
    _, _, found = run(changes | {"wear.model": "none", "tribofilm.model": "none"}, 0.0, *[200.0] * 8)
    states = [state for state, _ in found]
    assert states[0].outputs.blocks_dry == states[-1].outputs.blocks_dry  # one solution
    broke = 0
    for body in (0, 1):
        first = np.zeros_like(states[0].bodies[body].pits)
        for state in states:
            pits = state.bodies[body].pits
            first = np.where(first > 0.0, first, pits)
            assert np.array_equal(pits, first)
        broke += int((first > 0.0).sum())
    assert broke > 0
