"""Steady films near the floor that no other algorithm finds (`kernels.mixed.held`).

Points of `benchmarks.film.hard_cases`, by their numbers, on 65 nodes.
"""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.film.hard_cases_page import LIMITS, limit
from benchmarks.film.independent import FLOOR, answer, judge
from benchmarks.film.random_points import Point
from contact_core import line_contact, point_contact
from contact_core.film import routes
from contact_core.kernels.mixed import held

NODES, TOLERANCE = 65, 3e-3
OIL_UNDER_CONTACTS = Point(14, 0.006276386, 4.616751, -5.319565e-05, 1.791374, 2.216535e-07)
NODES_AT_THE_FLOOR = Point(81, 0.01397999, 13.89818, -0.1151738, 0.0002544781, 2.16063e-07)
POCKETS = Point(238, 0.01048254, 345.1453, 1.754212, 0.001713903, 5.780584e-07)
LEAKING_POCKETS = Point(439, 0.01239344, 171.5364, 0.03745674, 0.0006539087, 4.557433e-07)
LINE = Point(273, 0.03933275, 699.0351, 0.001999361, 0.01332778, 3.584066e-08)


@pytest.fixture
def first_algorithms(monkeypatch):
    """Of every row of the table only the first algorithm: the others fail as well, and take seconds."""
    rows = tuple(replace(row, algorithms=row.algorithms[:1]) for row in routes.REGIMES)
    monkeypatch.setattr(routes, "REGIMES", rows)
    monkeypatch.setattr(routes, "_MARCHED_ITERATIONS", 1)


@pytest.mark.usefixtures("first_algorithms")
@pytest.mark.parametrize(
    "point", [*(pytest.param(p, marks=pytest.mark.long) for p in (OIL_UNDER_CONTACTS, NODES_AT_THE_FLOOR)), POCKETS]
)
def test_a_film_near_the_floor_converges_and_passes_an_independent_check(point):
    given = point.arguments(NODES)
    found = point_contact(**given, tolerance=TOLERANCE, floor=FLOOR)
    assert found.converged, found.shortfall
    assert "held" in found.algorithm
    judged = judge(answer(given, found))
    for name in LIMITS:
        assert abs(getattr(judged, name)) < limit(name, judged.beyond), name


@pytest.mark.usefixtures("first_algorithms")
def test_pockets_that_contacts_all_but_close_off_fill(monkeypatch):
    """What flows in and out is little against what flows within them: line by line their pressure would hardly move."""
    monkeypatch.setattr(held, "_LOOKS", 2)
    found = point_contact(**LEAKING_POCKETS.arguments(NODES), tolerance=TOLERANCE, floor=FLOOR)
    assert found.converged, found.shortfall
    assert "held" in found.algorithm


@pytest.mark.usefixtures("first_algorithms")
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_rough_line_near_the_floor_converges_whatever_the_last_bits(seed, monkeypatch):
    """One node in the inlet that sinks below the floor and gains mass must not decide whether a film is found."""
    monkeypatch.setattr(held, "_LOOKS", 1)
    given = LINE.line_arguments(NODES)
    off = np.random.Generator(np.random.Philox(seed)).standard_normal(given["heights_2"].shape)
    given["heights_2"] = given["heights_2"] * (1.0 + 1e-12 * off)
    found = line_contact(**given, tolerance=TOLERANCE, floor=FLOOR)
    assert found.converged, found.shortfall
    assert "held" in found.algorithm


@pytest.mark.usefixtures("first_algorithms")
def test_only_the_film_that_was_asked_for_is_sought_so_long(monkeypatch):
    sought = []

    def nothing(half_space, problem, start, tolerance, iterations):
        sought.append(problem.cap.shape)
        return routes.solve_mixed(half_space, problem, start, tolerance, 1)

    monkeypatch.setattr(routes, "solve_held", nothing)
    found = point_contact(**NODES_AT_THE_FLOOR.arguments(NODES), tolerance=TOLERANCE, floor=FLOOR)
    assert not found.converged
    assert sought == [(NODES, NODES)]  # and not the coarser grid of the error estimate
