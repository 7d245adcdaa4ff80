"""A moving film over a time step: a pattern keeps its shape, a steady film keeps its thickness."""

from dataclasses import replace

import numpy as np
import pytest
from comparison import approx
from wavy_contact import problem

from contact_core import Scene, initial_state
from contact_core.deterministic.instant import Transient, solve_instant
from contact_core.deterministic.transient import begin, next_instant
from contact_core.kernels.mixed.flow import carried_over
from contact_core.kernels.mixed.stopping_rule import allowed_imbalance
from contact_core.scene import Case

X = np.arange(65.0)


def rows(values):
    return np.repeat(np.asarray(values, np.float64)[None, :], 3, axis=0)


def moved(mass, slow, nodes):
    """Return the mass after a step without pressure: what the faces pass is taken from one node to the next."""
    passed = np.zeros_like(mass)
    carried_over(mass, slow, nodes, passed)
    after = mass.copy()
    after[:, 1:-1] -= nodes * np.diff(passed, axis=1)[:, :-1]
    return after


def test_a_pattern_of_any_length_moves_by_a_whole_node_unchanged():
    rough = rows(np.random.default_rng(1).uniform(0.5, 1.5, 65))
    assert moved(rough, np.zeros_like(rough), 1.0)[1, 2:-1] == approx(rough[1, 1:-2], rel=1e-14)


@pytest.mark.parametrize("nodes", [0.5, 0.9])
def test_a_smooth_pattern_moves_by_part_of_a_node_at_third_order(nodes):
    def error(length):
        wave = lambda x: 2.0 + np.sin(2 * np.pi * x / length)  # noqa: E731
        cells = lambda x: wave(x) * np.sinc(1.0 / length) + 2.0 * (1.0 - np.sinc(1.0 / length))  # noqa: E731
        after = moved(rows(cells(X)), np.zeros((3, 65)), nodes)
        rising = np.abs(np.cos(2 * np.pi * (X - nodes) / length)) > 0.3  # the crests are kept between neighbours
        return float(np.abs(after[1] - cells(X - nodes))[4:-4][rising[4:-4]].max())

    assert np.log2(error(12) / error(24)) > 2.7


def test_of_a_slowly_changing_film_a_face_carries_the_mass_at_it():
    """A steady profile loses nothing to the step: no first order in the spacing is left."""
    profile = 1.0 + 0.002 * (X - 70.0) ** 2
    passed = np.zeros((3, 65))
    carried_over(rows(profile), rows(profile), 1.0, passed)
    assert passed[1, 2:-2] == approx(1.0 + 0.002 * (X[2:-2] + 0.5 - 70.0) ** 2, rel=1e-3)
    carried_over(rows(profile), np.zeros((3, 65)), 1.0, passed)
    assert np.abs(passed[1, 2:-2] / (1.0 + 0.002 * (X[2:-2] + 0.5 - 70.0) ** 2) - 1.0).max() > 0.01


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
    state, dt = replace(initial_state(scene), share=0.9), scene.film.spacing / case.fastest
    state = replace(state, film=solve_instant(case, state, dry=True, solid_share=0.9).film)
    iterations, share = [], []
    for _ in range(16):
        state, fields = next_instant(case, state, [speed * dt for speed in case.speeds], Transient(dt, 0, 150))
        assert fields.converged, fields.shortfall
        iterations.append(fields.iterations)
        share.append(float(fields.solid_pressure.sum() / fields.pressure.sum()))
    assert max(iterations[4:]) < 30  # 37 to 51 if they are not
    assert min(share) > 0.7
