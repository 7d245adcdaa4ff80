"""At which instants a block solves the contact, and what stands for mixed lubrication."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.signal
from cheap_scene import CHEAP, cheap
from comparison import HARD, approx

from contact_core import ContactState, RangeFlag, advance, initial_state, solve
from contact_core.deterministic.accumulator import Accumulator
from contact_core.deterministic.evolution import geometry_change
from contact_core.deterministic.rolling import beyond_grid, couple
from contact_core.deterministic.sampling import sample_dry, sample_mixed
from contact_core.scene import Case
from contact_core.surfaces.patches import patch_nodes

DRY = CHEAP | {"control.driver": "dry"}


@pytest.mark.parametrize("points", [33, 36, pytest.param(65, marks=pytest.mark.long)])
def test_dry_instants_let_every_two_points_meet_once_before_any_meet_again(points):
    scene, state, op = cheap(film__points=points, surface_1__rq="0 nm", surface_2__rq="0 nm", control__dry_instants=1)
    met, first = [], []
    for _ in range(points - 1):
        state = sample_dry(Case(scene, op), state, Accumulator.before(state), same=True)
        one, two = (patch_nodes(scene, body) for body in state.bodies)
        met.append((one - two) % (points - 1))
        first.append(one)
    assert sorted(met) == list(range(points - 1))
    assert len(set(first)) > 0.6 * (points - 1)  # and at many places of the contact


def test_the_march_moves_the_rougher_body_a_node_at_a_time_and_lets_the_other_jump():
    scene, state, op = cheap(control__mixed_instants=6)
    state = sample_mixed(Case(scene, op), state, Accumulator.before(state), False)
    places = []
    for _ in range(3):
        before = [patch_nodes(scene, body) for body in state.bodies]
        state = sample_mixed(Case(scene, replace(op)), state, Accumulator.before(state), True)
        places.append([(patch_nodes(scene, b) - k) % 32 for b, k in zip(state.bodies, before, strict=True)])
    assert all(disc in (6, 7) for _, disc in places)  # it runs a little ahead of the oil
    assert all(ball not in (6, 7) for ball, _ in places)


def test_bodies_of_like_roughness_do_not_jump_while_the_film_is_sampled():
    scene, state, op = cheap(surface_1__rq="100 nm", control__mixed_instants=4)
    state = sample_mixed(Case(scene, op), state, Accumulator.before(state), False)
    sweep = Accumulator.before(state)
    after = sample_mixed(Case(scene, op), state, sweep, True)
    moved = (patch_nodes(scene, after.bodies[1]) - patch_nodes(scene, state.bodies[1])) % 32
    assert sweep.count == 4
    # it calmed down after one jump of the other before it was sampled; it runs ahead of the oil, which moves by a node
    assert moved in (28, 29)
    assert op.speed_2 * 28 / op.entrainment_speed == approx(28.28, rel=1e-3)


# asperities below the grid are cut off where they press by e^-14 of their most: together that is no more than 1e-6
@pytest.mark.parametrize(("floor", "near"), [(HARD, 1e-9), ({}, 1e-6)], ids=["hard", "microrough"])
@pytest.mark.parametrize("share", [1.0, 0.8, 0.4])
def test_solids_of_a_dry_contact_under_oil_carry_their_share(share, floor, near):
    scene, state, op = cheap(CHEAP | floor)
    fields = solve(scene, op, state, dry=True, solid_share=share)
    cell = scene.film.spacing**2
    assert fields.solid_pressure.sum() * cell == approx(share * op.load, rel=near)
    assert fields.pressure.sum() * cell == approx(op.load, rel=near)
    assert fields.gap.min() >= scene.film.floor * (1.0 - 1e-9)
    assert fields.converged


def test_the_patches_grow_when_the_scar_reaches_their_edge():
    scene, state, op = cheap(DRY | {"tribofilm.model": "none"}, wear__sliding="surface_speed", wear__bare="2e-4")
    volume = 0.0
    for _ in range(40):
        state, outputs = advance(scene, op, state, 3.0)
        volume += 3.0 * outputs.wear_rate_1
        if state.rows > 33:
            break
    assert state.rows > 33
    assert state.bodies[0].wear[[0, -1]].max() == 0.0  # the new rows are fresh
    assert np.array_equal(state.bodies[0].wear.shape, state.bodies[1].since.shape)
    assert not RangeFlag(outputs.range_flags) & RangeFlag.DOMAIN_EDGE
    assert outputs.wear_volume_1 == approx(volume, rel=1e-12)
    restored = ContactState.from_bytes(state.to_bytes(), scene)
    assert advance(scene, op, restored, 1.0)[0].to_bytes() == advance(scene, op, state, 1.0)[0].to_bytes()


def test_own_surface_speed_wears_by_the_cycle_and_not_by_sliding():
    """Wear per cycle is the same at any slide-to-roll ratio; by |u1 - u2| it is in proportion to it."""
    depths = {}
    for sliding in ("difference", "surface_speed"):
        for srr in (0.02, 0.08):
            scene, state, op = cheap(DRY | {"tribofilm.model": "none"}, wear__sliding=sliding, wear__bare="1e-7")
            point = replace(op, speed_1=0.25 * (1 + srr / 2), speed_2=0.25 * (1 - srr / 2))
            outputs = advance(scene, point, state, 30.0)[1]
            depths[sliding, srr] = outputs.wear_depth_1 / outputs.load_cycles_1
    assert depths["surface_speed", 0.08] == approx(depths["surface_speed", 0.02], rel=0.02)
    assert depths["difference", 0.08] == approx(4.0 * depths["difference", 0.02], rel=0.04)


def test_blocks_are_shorter_than_the_stable_time_of_wear():
    scene, state, op = cheap(DRY, wear__sliding="surface_speed", control__change="1 um")
    state, outputs = advance(scene, op, state, 0.0)
    assert outputs.suggested_step < 60.0
    slow, still, _ = cheap(DRY, control__change="1 um")
    assert advance(slow, op, still, 0.0)[1].suggested_step == slow.control.longest


def test_the_sequence_of_instants_goes_on_after_a_restart():
    scene, state, op = cheap()
    state, _ = advance(scene, op, state, 6.0)
    assert state.film is not None
    restored = ContactState.from_bytes(state.to_bytes(), scene)
    assert advance(scene, op, restored, 15.0)[0].to_bytes() == advance(scene, op, state, 15.0)[0].to_bytes()


def test_another_tribofilm_law_asks_for_a_new_solution():
    """What the last one has stored as exposure means something else to it."""
    scene, state, op = cheap(DRY, control__change="1 um")
    state, first = advance(scene, op, state, 1.0)
    assert advance(scene, op, state, 1e-3)[1].blocks_dry == first.blocks_dry
    other = cheap(DRY, control__change="1 um", tribofilm__dose="contact_length")[0]
    assert advance(other, op, state, 1e-3)[1].blocks_dry == first.blocks_dry + 1.0


def test_a_dose_of_the_contact_length_is_the_clock_of_a_point_on_the_middle_of_a_smooth_track():
    """It counts for as long as the point is between Hertz's ends, and no longer for a wider grid."""
    smooth = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm", "tribofilm.dose": "contact_length"} | HARD
    for domain in ("0.5 mm", "0.7 mm"):
        scene, state, op = cheap(DRY | smooth, film__points=65, film__domain=domain, control__dry_instants=64)
        state, _ = advance(scene, op, state, 0.0)
        rate = scene.tribofilm.rate(op.temperature)
        for body in state.bodies:
            assert body.exposure[32].mean() / rate == approx(
                1.0, abs=2.0 * scene.film.spacing / (2.0 * scene.hertz(op.load).a)
            )


@pytest.mark.parametrize("level", ["deterministic", "regression"])
def test_a_body_at_rest_is_exposed_all_the_time_by_the_contact_length_as_by_the_clock(level):
    smooth = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm"}
    films = []
    for dose in ("clock", "contact_length"):
        scene = cheap(DRY | smooth, tribofilm__dose=dose)[0].at_level(level)
        _, outputs = advance(scene, replace(scene.operation.point, speed_1=0.0), initial_state(scene), 20.0)
        films.append(outputs.tribofilm_1)
    assert films[0] > 0.0
    assert films[1] == approx(films[0], rel=2e-2)  # the other body grows by another dose


def test_a_groove_counts_for_a_fifth_of_what_happens_to_asperities():
    _, state, _ = cheap()
    body, ones = state.bodies[0], np.ones_like(state.bodies[0].wear)
    wavy = ones * np.sin(np.arange(ones.shape[1]) * (2.0 * np.pi / ones.shape[1]))
    assert geometry_change(body, replace(body, wear=1e-9 * ones)) == approx(0.2e-9)
    assert geometry_change(body, replace(body, growth=1e-9 * ones)) == approx(1e-9)
    assert geometry_change(body, replace(body, wear=2e-9 * wavy)) == approx(2e-9 / np.sqrt(2.0))


def test_rolling_is_that_of_the_mean_film_for_flanks_give_back_what_they_take():
    """Roughness at rest or passing: over a pass the couple is that of the inlet, with what lies beyond the grid."""
    scene, state, op = cheap()
    sums, case = Accumulator.before(state), Case(scene, op)
    x = case.grid(state.rows).x
    inlet, wave = 2e-7 * (1.0 - 1e3 * x), 2.0 * np.pi * np.arange(x.size) / (x.size - 1)
    fields = solve(scene, op, state)
    for k in range(8):
        turn = 4.0 * wave - 0.25 * np.pi * k
        gap = np.tile(inlet + 1e-7 * np.cos(turn), (state.rows, 1))
        pressure = np.tile(1e7 + 1e12 * x + 1e9 * np.sin(turn), (state.rows, 1))
        sums.add(case, state, replace(fields, gap=gap, fluid_pressure=pressure))
    grid = case.grid(state.rows)
    steady = couple(grid, np.tile(inlet, (state.rows, 1)), np.tile(1e7 + 1e12 * x, (state.rows, 1)))
    beyond = beyond_grid(case, grid)
    assert 0.0 < beyond < 0.1
    assert sums.means()["rolling_resistance"] == approx(steady + beyond, rel=1e-6)
    assert abs(np.mean([seen["rolling_resistance"] for seen in sums.outputs]) / steady - 1.0) > 0.5


def test_the_mean_of_alike_instants_scatters_more_than_they_do():
    """A stationary sequence of known correlation, four neighbours at a time."""
    state = cheap()[1]
    random, correlation = np.random.default_rng(5), 0.9
    noise = random.normal(size=40_000)
    values = scipy.signal.lfilter([(1.0 - correlation**2) ** 0.5], [1.0, -correlation], noise)
    alike = np.mean([correlation**k for k in (1, 1, 1, 2, 2, 3)])
    stated, means = [], []
    for block in values.reshape(-1, 4):
        sums = Accumulator.before(state)
        sums.outputs = [{"contact_load_ratio": float(value), "rolling_resistance": 0.0} for value in block]
        stated.append(sums.spread(alike)["contact_load_ratio"])
        means.append(block.mean())
    assert np.sqrt(np.mean(np.square(stated))) == approx(np.std(means), rel=0.05)
