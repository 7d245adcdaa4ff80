"""Points drawn far beyond a machine's: they converge, and what is called converged solves the equations."""

import math
from dataclasses import replace
from itertools import islice

import pytest

from benchmarks.film.hard_cases_kept import TOLERANCE
from benchmarks.film.independent import answer, judge
from benchmarks.film.random_points import draw
from contact_core.calls.point_contact import point_contact

POINTS = list(islice((point for point in draw(2) if point is not None), 14))
GRIDS = (33, 49, 65)


def test_the_points_cover_light_and_heavy_smooth_and_rough_both_directions_and_standstill():
    loads = [point.contact.moes_parameters[0] for point in POINTS if point.speed != 0.0]
    assert min(loads) < 50.0
    assert max(loads) > 1e5
    assert {point.rq > 0.0 for point in POINTS} == {True, False}
    assert {math.copysign(1.0, point.speed) for point in POINTS} == {1.0, -1.0}


@pytest.mark.parametrize(("point", "nodes"), [(point, GRIDS[k % 3]) for k, point in enumerate(POINTS)])
def test_a_random_contact_meets_the_stopping_rule_and_an_independent_check(point, nodes):
    given = point.arguments(nodes)
    found = point_contact(**given, tolerance=TOLERANCE)
    assert found.converged, found.shortfall
    judgement = judge(answer(given, found))
    assert not judgement.failures, judgement


@pytest.mark.parametrize(
    ("wrong", "failure"),
    [
        (lambda at: {"pressure": 1.01 * at.pressure, "fluid": 1.01 * at.fluid}, "force"),
        (lambda at: {"speed": 1.5 * at.speed}, "imbalance"),
        (lambda at: {"rigid": at.rigid - 2.0 * at.film.max()}, "complementarity"),
        (lambda at: {"film": at.film + 1e-10}, "gap"),
        (lambda at: {"fluid": 0.99 * at.fluid}, "bounds"),
    ],
)
def test_the_check_tells_a_wrong_answer(wrong, failure):
    given = POINTS[-1].arguments(33)  # a film that roughness hardly touches
    at = answer(given, point_contact(**given, tolerance=TOLERANCE))
    assert failure not in judge(at).failures
    assert failure in judge(replace(at, **wrong(at))).failures
