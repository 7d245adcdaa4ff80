"""A moving film over a time step: what lies between asperities moves along unchanged, and nothing hangs on the step."""

import math
from dataclasses import replace

import numpy as np
import pytest
from comparison import approx
from wavy_contact import problem

from contact_core import Scene, advance, initial_state, march
from contact_core.deterministic.instant import Transient, instant_of, instant_time, solve_instant
from contact_core.deterministic.transient import begin, longest_instant, next_instant
from contact_core.errors import OperatingPointError
from contact_core.film.routes import solve_film
from contact_core.film.slow_film import SlowFilm, slow_film
from contact_core.kernels.mixed.flow import gap_of_step
from contact_core.kernels.mixed.stopping_rule import allowed_imbalance
from contact_core.scene import Case


def test_what_deviates_from_the_film_that_stands_still_moves_by_whole_nodes_unchanged():
    rough = np.random.default_rng(1).uniform(0.5, 1.5, (3, 65))
    film = SlowFilm(np.full((3, 65), 2.0), np.full((3, 65), 3.0))
    for rolled in (0, 1, 3):
        carried = film.carried(2.0 + rough, rolled)
        assert carried[:, rolled:] == approx(3.0 + rough[:, : 65 - rolled], rel=1e-14)
    assert film.carried(2.0 + rough, 1, 2.25)[:, :2] == approx(3.0 + np.minimum(rough[:, [0, 0]], 0.25), rel=1e-14)


def still_film(case, points, part):
    """Return the film that stands still on so many nodes across the same width, moved on by a part of one."""
    scene = case.scene.film
    grid = replace(case.scene, film=replace(scene, points=points)).grid(points)
    now = instant_of(case, np.zeros(grid.shape), np.full(grid.shape, case.scene.plasticity.hardness))
    moved = grid.shifted(part * grid.spacing)
    return slow_film(now, moved, part, scene.settings, solve_film)


def test_the_film_that_stands_still_is_known_between_the_nodes():
    """Moved on by half a node they are every other node of a grid twice as fine, by a whole one their neighbours."""
    case = bound({})
    next_node, coarse, fine = still_film(case, 65, 1.0), still_film(case, 65, 0.5), still_film(case, 129, 0.0)
    assert next_node.now[:, 4:-5] == approx(next_node.before[:, 5:-4], rel=1e-6)
    on_nodes, between = (
        float(np.sqrt(np.mean((film[:, 4:-4] / exact[:, 4:-4] - 1.0) ** 2)))
        for film, exact in ((coarse.before[:, :-1], fine.now[::2, :-1:2]), (coarse.now[:, :-1], fine.now[::2, 1::2]))
    )
    assert between < 1.1 * on_nodes < 0.06  # no worse than what the coarser grid itself makes


def test_answers_of_a_block_do_not_hang_on_the_step():
    """The way of the oil in an instant: whatever an iteration leaves out of balance, none of it may be lost."""
    found = []
    for nodes in ("1", "0.25"):
        scene = Scene.from_toml("azam_case_a", {"film.points": "65", "control.nodes_per_instant": nodes})
        found.append(advance(scene, scene.operation.point, initial_state(scene), 0.0)[1])
    one, quarter = found
    assert one.contact_load_ratio == approx(quarter.contact_load_ratio, rel=0.025)
    assert one.friction_coefficient == approx(quarter.friction_coefficient, rel=0.02)
    assert one.h_c == approx(quarter.h_c, rel=0.03)


def test_answers_of_bodies_that_slide_do_not_hang_on_the_step():
    """Asperities that pass each other close and open the gap within a step, by orders of its conductance."""
    speeds = {"operation.speed_1": "0.3375 m/s", "operation.speed_2": "0.1625 m/s"}
    found = []
    for nodes in ("1", "0.25"):
        changes = {"film.points": "65", "control.nodes_per_instant": nodes} | speeds
        scene = Scene.from_toml("azam_case_a", changes)
        found.append(advance(scene, scene.operation.point, initial_state(scene), 0.0)[1])
    one, quarter = found
    assert one.contact_load_ratio == approx(quarter.contact_load_ratio, rel=0.025)
    assert one.friction_coefficient == approx(quarter.friction_coefficient, rel=0.02)


def test_bodies_slide_by_half_a_correlation_length_in_an_instant_at_most():
    for speeds in ((0.0, 0.5), (0.5, 0.0), (0.15, 0.35), (-0.1, 0.5)):
        for points in ("65", "129"):
            given = {f"operation.speed_{body}": f"{speed} m/s" for body, speed in enumerate(speeds, 1)}
            case = bound(given | {"film.points": points})
            for time in (instant_time(case), longest_instant(case)):  # of blocks and of a march
                slid = abs(case.op.sliding_speed) * time
                assert slid <= 0.5 * max(case.scene.surface_2.length, case.scene.film.spacing) * (1.0 + 1e-12)


def test_the_gap_of_a_step_lets_through_what_its_way_lets_through_on_average():
    """The mean of 1 / h^3 over the gaps between both."""
    before, now, found = np.array([[1.0, 2.0, 5.0]]), np.array([[4.0, 2.0, 0.5]]), np.zeros((1, 3))
    gap_of_step(before, now, 1.0, found)
    between = np.linspace(before, now, 100_001)
    assert found**-3 == approx(np.trapezoid(between**-3, axis=0, dx=1e-5), rel=1e-6)


def test_oil_is_neither_made_nor_lost_by_an_iteration_that_stops_early():
    case = bound({})
    state = replace(initial_state(case.scene), film=None)
    state = replace(state, film=solve_instant(case, state, dry=True).film)
    dt = case.scene.film.spacing / case.op.entrainment_speed
    steps = [speed * dt for speed in case.speeds]
    for _ in range(60):
        state, _ = next_instant(case, state, steps, Transient(dt, 0, 300))
    inside, masses = case.hertz.inside(case.grid(65).x, case.grid(65).y, 0.6), []
    for tolerance in (3e-3, 1e-5):
        strict = replace(case, scene=replace(case.scene, film=replace(case.scene.film, tolerance=tolerance)))
        after, _ = next_instant(strict, state, steps, Transient(dt, 0, 2000))
        masses.append(float(after.film.mass[inside].sum()))
    assert masses[0] == approx(masses[1], rel=2e-3)


def test_cavities_conserve_their_oil_in_a_march_whichever_way_they_are_solved_otherwise():
    found = []
    for cavitation in ("reynolds", "mass_conserving"):
        case = bound({"lubricant.cavitation": cavitation})
        state = initial_state(case.scene)
        state = replace(state, film=solve_instant(case, state, dry=True).film)
        found.append(marched(case, state, 12)[1])
    assert found[0].gap == approx(found[1].gap, rel=1e-12)


def test_a_step_that_carries_the_film_over_has_to_balance_it_better():
    case, _, _ = problem(17, 17)
    step = replace(case, per_dt=20.0)
    assert allowed_imbalance(step) == 100.0
    assert allowed_imbalance(replace(step, slow_mass=np.ones((17, 17)))) == 40.0
    assert allowed_imbalance(case) == allowed_imbalance(replace(case, slow_mass=np.ones((17, 17)))) == 5.0


def marched(case, state, instants):
    """Return the fields after so many instants, a node of the faster body apart."""
    dt = case.scene.film.spacing / case.fastest
    for _ in range(instants):
        state, fields = next_instant(case, state, [speed * dt for speed in case.speeds], Transient(dt, 0, 150))
    return state, fields


def bound(changes):
    scene = Scene.from_toml("azam_case_a", {"film.points": "65", "film.flux": "fitted"} | changes)
    return Case.bind(scene, scene.operation.point)


def test_a_marched_smooth_film_is_the_steady_one():
    case = bound({"surface_1.rq": "0 m", "surface_2.rq": "0 m"})
    state, steady = begin(case, initial_state(case.scene))
    _, fields = marched(case, state, 100)
    middle = steady.gap.shape[0] // 2
    assert fields.converged
    assert fields.gap[middle, middle] == approx(steady.gap[middle, middle], rel=0.04)


@pytest.mark.long
def test_without_sliding_rough_bodies_keep_the_oil_that_is_between_their_asperities():
    """Bodies of one speed roll their pattern of oil through the contact: gap and pressure only move along."""
    case = bound({"operation.speed_1": "0.25 m/s", "operation.speed_2": "0.25 m/s"})
    state, _ = begin(case, initial_state(case.scene))
    state, before = marched(case, state, 40)
    _, after = marched(case, state, 4)
    inner = np.abs(before.x) < 0.5 * case.hertz.a
    one = before.gap[28:37][:, inner]
    other = after.gap[28:37][:, np.roll(inner, 4)]
    stayed = float(np.abs(after.gap[28:37][:, inner] - one).mean())
    assert float(np.abs(other - one).mean()) < 0.35 * stayed


def test_instants_of_rough_bodies_close_where_asperities_below_the_grid_carry_most():
    """Asperities are stiff there: oil and solids have to be told apart, or their pressures swing about for ever."""
    fine = {f"surface_{k}.microroughness.rms": "14 nm" for k in (1, 2)}
    fine |= {f"surface_{k}.microroughness.longest": "4 um" for k in (1, 2)}
    scene = Scene.from_toml("mtm_zddp", {"film.points": "65", "film.flux": "fitted"} | fine)
    case = Case.bind(scene, scene.operation.point)
    state, dt = initial_state(scene), scene.film.spacing / case.fastest
    state = replace(state, film=solve_instant(case, state, dry=True, solid_share=0.9).film)
    iterations, share = [], []
    for _ in range(16):
        state, fields = next_instant(case, state, [speed * dt for speed in case.speeds], Transient(dt, 0, 150))
        assert fields.converged, fields.shortfall
        iterations.append(fields.iterations)
        share.append(float(fields.solid_pressure.sum() / fields.pressure.sum()))
    assert max(iterations[4:]) < 30  # 37 to 51 if they are not
    assert min(share) > 0.7


@pytest.mark.parametrize(("supply", "part"), [("3 nm", 0.05), ("14 nm", 0.1), ("30 nm", 0.2)])
def test_a_starved_film_keeps_its_oil_in_a_march(supply, part):
    smooth = {f"surface_{body}.{key}": "0 m" for body in (1, 2) for key in ("rq", "microroughness.rms")}
    case = bound(
        smooth
        | {"lubricant.cavitation": "mass_conserving"}
        | {"lubricant.supply.model": "film", "lubricant.supply.thickness": supply}
    )
    state, steady = begin(case, initial_state(case.scene))
    _, fields = marched(case, state, 80)
    middle = steady.gap.shape[0] // 2
    assert fields.converged
    assert fields.gap[middle, middle] == approx(steady.gap[middle, middle], rel=part)  # it swings where oil fills up


def test_a_node_half_way_to_the_next_stays_there_at_rest():
    """Rounding puts a window just beyond half a node: bodies at rest move no oil, and their film goes on."""
    wave = dict.fromkeys(("surface_1.correlation_length", "surface_2.correlation_length"), "20 um")
    more = {"film.points": "33", "film.domain": "0.55 mm", "control.inputs": "transient"}
    scene = Scene.from_toml("azam_case_a", more | wave)
    op = scene.operation.point
    state, _ = advance(scene, op, initial_state(scene), 0.0)
    spacing = scene.film.spacing
    for window in (-0.5000000000000001, 0.5000000000000001):
        at = replace(state, window=window * spacing)
        after, out = advance(scene, replace(op, speed_1=0.0, speed_2=0.0), at, 1e-4)
        assert after.window == at.window
        assert math.isfinite(out.h_c)


@pytest.mark.parametrize(
    ("distance", "steps", "part"), [("1 m", "1", 0.0), ("0.19 mm", "1", 0.02), ("0.19 mm", "0.25", 0.02)]
)
def test_oil_behind_a_meniscus_is_carried_along_with_moving_asperities(distance, steps, part):
    """A meniscus a little before the contact leaves the solids nearly the load they carry when flooded, at any step."""
    flooded, starved = (
        Scene.from_toml("azam_case_a", {"film.points": "65", "control.nodes_per_instant": steps} | supply)
        for supply in ({}, {"lubricant.supply.model": "meniscus", "lubricant.supply.distance": distance})
    )
    outs = [advance(scene, scene.operation.point, initial_state(scene), 0.0)[1] for scene in (flooded, starved)]
    assert outs[1].contact_load_ratio == approx(outs[0].contact_load_ratio, abs=part)


def test_march_refuses_the_second_order_where_roughness_moves():
    scene = Scene.from_toml("azam_case_a", {"film.points": "65"})
    state, _ = advance(scene, scene.operation.point, initial_state(scene), 0.0)
    with pytest.raises(OperatingPointError, match="order = 1"):
        next(march(scene, state, lambda time: scene.operation.point, (0.0, 1e-5), order=2))
