"""Stresses and damage below the surfaces in a scene, and what it costs one that does not ask for them."""

from dataclasses import replace

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap
from comparison import approx

from benchmarks.stress.closed_forms import line_stress
from contact_core import ContactState, RangeFlag, Scene, SceneError, advance, initial_state, subsurface_stress
from contact_core.deterministic import damage
from contact_core.deterministic.subsurface import Pass, Traction, of_a_pass, outputs_of_stress, passed
from contact_core.kernels.load_cycle import Cycle
from contact_core.scene import Case
from contact_core.state.below import nothing_below
from contact_core.surfaces.patches import heights_of, on_grid, track_rows

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
        rubbed = each.below.shear[:, :-1].sum() * scene.film.spacing**2 / instants
        assert rubbed == approx(-each.outputs.friction_force, rel=0.02)  # on body 2; of all instants every fourth or so
    assert outputs.von_mises_max < found[0][1].von_mises_max


def test_a_point_under_a_fixed_pressure_sees_it_pass():
    """Of a pressure that stands still over a moving body each column of the patch has the same history.

    Every other instant passes all of the body, too: each second column has one history, a little milder.
    """
    scene, op, _ = run(STRESSED | SMOOTH)
    op = replace(op, speed_1=0.25, speed_2=0.25)
    state, _ = advance(scene, op, initial_state(scene), 0.0)
    case = Case.bind(scene, op)
    below, rows = state.below, state.rows
    columns = scene.film.points - 1
    found = passed(case, rows, [Traction(below.pressure[:rows], below.shear[:rows], (k, k)) for k in range(columns)])
    shear = found.cycles[0].shear
    assert np.ptp(shear, axis=2).max() < 1e-9 * shear.max()
    fewer = found.halved[0].shear
    assert np.ptp(fewer[:, :, ::2], axis=2).max() < 1e-9 * shear.max()
    assert np.all(fewer <= shear * (1.0 + 1e-6)) and fewer.max() < shear.max()


def test_each_body_is_stretched_behind_what_rubs_along_it():
    """Closed form of a line: friction on body 2 is along +x, that on body 1 against it, and a cycle keeps tension."""
    flank = {"film.model": "deterministic", "film.points": "129", "film.domain": "1 mm", "film.width": "62.5 um"}
    scene = Scene.from_toml("fzg_flank", flank | {"stress.model": "half_space", "stress.layers": "6"})
    case, rows, a, friction = Case.bind(scene, scene.operation.point), scene.rows, 0.2e-3, 0.3
    x = scene.grid(rows).x
    p = np.tile(1e9 * np.sqrt(np.maximum(1.0 - (x / a) ** 2, 0.0)), (rows, 1))
    found = passed(case, rows, [Traction(p, friction * p, (0, 0))] * 2)
    deep = scene.depths > 3.0 * scene.film.spacing
    for sign, cycle in ((-1.0, found.cycles[0]), (1.0, found.cycles[1])):
        exact = line_stress(x[:-1], scene.depths[deep, None], a, 1e9, 0.3, sign * friction)[:3].sum(axis=0) / 3.0
        assert cycle.hydrostatic[deep, 0] == approx(np.maximum(exact, 0.0), abs=0.02 * exact.max())


def test_the_scatter_of_a_pass_is_the_standard_error_of_the_mean_of_its_instants():
    """Of tractions 10 % above and below their mean: it falls with the root of their number."""
    _, state, case = pressed()
    p = state.below.pressure[: state.rows]
    for instants in (4, 16):
        tractions = [Traction(factor * p, 0.0 * p, (0, 0)) for factor in (0.9, 1.1)] * (instants // 2)
        found = passed(case, state.rows, tractions)
        assert found.scatter == approx(0.1 / np.sqrt(instants), rel=1e-9)
        assert found.von_mises == approx(passed(case, state.rows, [Traction(p, 0.0 * p, (0, 0))]).von_mises)


def test_the_stress_of_an_instant_is_that_of_the_worse_body_in_any_layer():
    """Friction toward the steep side of a pressure and away from it: beside two half spaces, one for each body."""
    scene, state, case = pressed()
    x = np.linspace(-1.0, 1.0, scene.film.points)
    p = 1e9 * np.outer(np.maximum(1.0 - np.linspace(-2.0, 2.0, state.rows) ** 2, 0.0), np.where(x < 0.5, 1.0 + x, 0.0))
    found = passed(case, state.rows, [Traction(p, 0.4 * p, (0, 0))]).von_mises
    bodies = [
        subsurface_stress(p, way * p, None, scene.film.spacing, scene.depths, poisson_ratio=0.3).von_mises
        for way in (-0.4, 0.4)
    ]
    alone = np.array([body.max(axis=(1, 2)) for body in bodies])
    assert np.abs(alone[0] / alone[1] - 1.0).max() > 0.02
    assert found == approx(alone.max(axis=0), rel=1e-9)


def test_what_a_body_carries_along_presses_one_place_of_it():
    """A bump on body 1 crosses the grid with its patch; body 2 stands still and is pressed all along the way."""
    scene, state, case = pressed()
    bump = np.zeros((state.rows, scene.film.points - 1))
    bump[state.rows // 2, 5] = 1e9
    tractions = [Traction(on_grid(bump, k), np.zeros((state.rows, scene.film.points)), (k, 0)) for k in range(0, 24, 3)]
    carried, crossed = (cycle.shear[0, state.rows // 2] for cycle in passed(case, state.rows, tractions).cycles)
    assert carried.argmax() == 5
    assert np.sort(carried)[-4] < 0.2 * carried.max()
    assert np.all(crossed[5:27:3] > 0.9 * carried.max())


def test_a_residual_stress_is_there_before_under_and_after_a_load():
    """It adds 2/3 of itself to hydrostatic stresses and nothing to the amplitude of shear."""
    (scene, state, case), (_, _, strained) = pressed(), pressed(stress__residual="-300 MPa")
    tractions = [Traction(state.below.pressure[: state.rows], state.below.shear[: state.rows], (0, 0))] * 2
    none, found = (passed(each, state.rows, tractions).cycles[1] for each in (case, strained))
    assert found.shear == approx(none.shear, rel=1e-6)
    assert found.hydrostatic - none.hydrostatic == approx(np.full_like(none.shear, -200e6), rel=1e-6)
    shift = -200e6 * scene.stress.dang_van_slope
    assert found.dang_van - none.dang_van == approx(np.full_like(none.shear, shift), rel=1e-4)


@pytest.mark.parametrize("speeds", [(0.3, 0.2), (0.2, 0.3), (-0.3, -0.2), (-0.2, -0.3)])
def test_a_pass_is_that_of_the_faster_body_whichever_way_it_moves(speeds):
    """Of instants a node apart every fourth counts, until the faster body has passed the grid."""
    scene, state, case = pressed()
    case = Case.bind(scene, replace(case.op, speed_1=speeds[0], speed_2=speeds[1]))
    nothing, fastest = np.zeros((1, 1)), max(abs(speed) for speed in speeds)
    ways = [[round(k * speed / fastest) % 32 for k in range(40)] for speed in speeds]
    found = of_a_pass(case, state, [Traction(nothing, nothing, places) for places in zip(*ways, strict=True)], False)
    fast = [each.places[int(abs(speeds[1]) > abs(speeds[0]))] for each in found]
    assert fast == [(4 * k if speeds[0] > 0.0 else -4 * k) % 32 for k in range(8)]
    assert [damage.cycles_in(side, 2.0) for side in case.sides] == approx(
        [2.0 * abs(side.speed) / side.track_length for side in case.sides]
    )


def test_the_share_near_the_surface_is_of_what_may_fail_in_either_body():
    scene, state, case = pressed(stress__near_surface="0.4")
    shape = scene.depths.size, state.rows, scene.film.points - 1
    top, bottom = (np.zeros(shape) for _ in range(2))
    top[0], bottom[-1] = 1.1e9, 1.0e9
    track = track_rows(scene, state.rows)
    top[0, ~track] = 3e9  # where nobody looks

    def share(*shears):
        cycles = tuple(Cycle(shear, 0.0 * shear, shear) for shear in shears)
        found = outputs_of_stress(case, state.rows, Pass(cycles, cycles, scene.depths, 0.0))
        worst = max(shear[:, track].max() for shear in shears) / scene.stress.torsion_limit
        assert (found["dang_van_ratio"], found["crossland_ratio"]) == approx((worst, worst))
        return found["near_surface_share"]

    assert (share(top, top), share(bottom, bottom)) == (1.0, 0.0)
    assert 0.01 < share(top, bottom) == share(bottom, top) < 0.99
    assert share(top + bottom, 0.0 * top) == share(top, bottom)


def pressed(changes=TIRED, **more):
    """A scene with its first pass, and its case."""
    scene, state, op = cheap(changes, **more)
    return scene, advance(scene, op, state, 0.0)[0], Case.bind(scene, op)


def test_few_instants_miss_what_half_of_them_find_less():
    """The rate of damage of a pass less that of a pass of every other of its instants."""
    _, state, case = pressed()
    below, rows = state.below, state.rows
    fields = zip(np.split(below.pressure, 8), np.split(below.shear, 8), below.places.astype(int).tolist(), strict=True)
    tractions = [Traction(p, q, tuple(places)) for p, q, places in fields]
    half = damage.with_cycles(case, below, passed(case, rows, tractions[::2]))
    assert below.short == approx(below.rate - half.rate, rel=1e-9)
    assert np.all(below.short > 0.02 * below.rate)


def test_the_rate_of_damage_scatters_from_pass_to_pass_as_its_stresses_do():
    """By the exponent of the first pass, and by what later ones differ by, which is the scatter of two."""
    scene, state, case = pressed()
    draw, power, shape = np.random.default_rng(1), scene.fatigue.life_exponent, state.below.damage_1.shape

    def after(below, times):
        stress = np.full((scene.depths.size, state.rows, shape[1]), 2e8 * times)
        cycle = Cycle(stress, 0.0 * stress, 0.0 * stress)
        return damage.with_cycles(case, below, Pass((cycle, cycle), (cycle, cycle), scene.depths, 0.01))

    below = after(replace(state.below, rate=np.zeros(2)), 1.0)
    rate, squares = below.rate, []
    assert below.spread == approx(0.01 * power * rate, rel=0.02)
    for times in 1.0 + 0.01 * draw.normal(size=600):
        below = after(below, times)
        squares.append(below.spread**2)
    assert np.sqrt(np.mean(squares[20:], axis=0)) == approx(0.01 * power * rate, rel=0.15)


def test_wear_of_a_body_takes_its_own_damage_and_a_pit_its_tribofilm_and_oxide():
    scene, state, case = pressed()
    layers = np.repeat(np.linspace(0.9, 0.1, scene.depths.size), state.rows)
    fields = np.tile(layers[:, None], scene.film.points - 1)
    failed = fields.copy()
    failed[: state.rows, :5] = 1.0
    films = {name: np.full_like(state.bodies[0].wear, 1e-9) for name in ("growth", "removal", "oxide")}
    state = replace(state, below=replace(state.below, damage_1=fields, damage_2=failed))
    first, second = (replace(body, **films) for body in state.bodies)
    worn = replace(first, wear=first.wear + scene.depths[1])
    (still, _), (below, bodies) = (damage.fatigued(case, state, (body, second), 1e-6) for body in (first, worn))
    assert np.all(below.damage_1[: state.rows] < 0.95 * still.damage_1[: state.rows])
    assert np.array_equal(below.damage_2, still.damage_2)
    for name in films:
        assert np.array_equal(getattr(bodies[1], name), np.where(bodies[1].pits > 0.0, 0.0, 1e-9))
    assert bodies[1].pits[:, :5].min() > 0.0 == bodies[1].pits[:, 5:].max()


def test_a_rate_that_is_held_while_it_rises_is_late_by_what_is_stated():
    """Found anew every minute, a rate that rises steadily lags by half of each change, the last included."""
    scene, state, case = pressed(TIRED | {"wear.model": "none"})
    shape = scene.depths.size, state.rows, scene.film.points - 1
    below, rates = replace(state.below, rate=np.zeros(2)), []
    for rising in (1.0, 1.1, 1.2, 1.3, 1.4):
        stress = 2e8 * rising ** (1.0 / scene.fatigue.life_exponent)
        cycle = Cycle(*(np.full(shape, part) for part in (stress, 0.0, 0.0)))
        below = damage.with_cycles(case, below, Pass((cycle, cycle), (cycle, cycle), scene.depths, 0.0))
        rates.append(below.rate)
        below, _ = damage.fatigued(case, replace(state, below=below), state.bodies, 60.0)
    found = [damage.damage_of_track(scene, replace(state, below=below), i) for i in (0, 1)]
    assert rates == approx(rates[0] * np.array([[1.0], [1.1], [1.2], [1.3], [1.4]]), rel=1e-9)
    exact = rates[0] * 300.0 * 1.25
    assert [below.errors(i)[0] for i in (0, 1)] == approx(exact - found, rel=1e-6)


def test_damage_under_constant_cycles_is_their_number_times_that_of_one():
    """And its error that of one pass times the time it is held, however that is cut."""
    changes = TIRED | {"wear.model": "none", "control.longest": "1e6 s", "tribofilm.model": "none"}
    scene, op, found = run(changes, 0.0, 3.0, 4.0, 5.0)
    first, last = found[0][0], found[-1][0]
    side = Case.bind(scene, op).sides[0]
    assert first.below is not None
    assert len(last.below.places) == len(first.below.places)  # one block
    exact = damage.cycles_in(side, 12.0) * first.below.per_cycle_1
    assert last.below.damage_1 == approx(exact, rel=1e-14)
    assert last.outputs.load_cycles_1 == approx(damage.cycles_in(side, 12.0), rel=1e-14)
    once = advance(scene, op, first, 12.0)[0].below
    assert np.all(once.variance > 0.0)
    for body in (0, 1):
        assert last.below.errors(body) == approx(once.errors(body), rel=1e-12)


@pytest.mark.long
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
    stated = [state.below.errors(i) for i in (0, 1)]
    state, _ = advance(scene, replace(op, load=0.0), state, 5000.0)
    assert [state.below.errors(i) for i in (0, 1)] == stated  # nor gets less sure
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


@pytest.mark.long
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


def test_the_error_of_a_mean_damage_is_two_deviations_and_half_of_what_the_last_rate_has_changed_by():
    """A rate is late by half of its change for as long as it has been held; 95 % lie within two deviations."""
    below = nothing_below(2, 3, 4)
    given = {"late": [1e-3, 0.0], "step": [2e-6, -4e-6], "few": [0.0, -2e-3], "variance": [4e-6, 0.0]}
    below = replace(below, held=500.0, **{name: np.array(pair) for name, pair in given.items()})
    assert below.errors(0) == approx((1e-3 + 0.5 * 2e-6 * 500.0, 2.0 * 2e-3))
    assert below.errors(1) == approx((0.5 * 4e-6 * 500.0, 2e-3))


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
