"""Sums over nodes become loops in C; powers by roots and products with zero need no function there."""

import math
import random
import shutil

import numpy as np
import pytest
from comparison import approx
from translated import translated, unknown

from contact_core.laws.elementary import exp

pytestmark = [pytest.mark.unit, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]

PARTS = np.array([0.05, 0.3, 0.5, 0.7, 0.95])
WEIGHTS = np.array([0.1, 0.2, 0.4, 0.2, 0.1])


def quadrature(x, y):
    thinned = exp(-((PARTS * x + 1.0) ** 0.7) * (y - 1.0) ** 0.3)
    total = WEIGHTS @ thinned
    return 2.0 * total


def two_of_the_same_nodes(x, y):
    local = PARTS * x
    grown = exp(local)
    product, shifted = grown * y, grown + y
    first, second = WEIGHTS @ product, WEIGHTS @ shifted
    return first, second


def in_a_branch(x, y):
    if x > 2.0:
        grown = exp(PARTS * y)
        total = WEIGHTS @ grown
    else:
        total = x
    return total


def a_node_is_read_elsewhere(x, y):
    local = exp(PARTS * x)
    total = WEIGHTS @ local
    return total + local[2] * y


def in_a_loop(x, y):
    count, total = 0.0, 0.0
    while count < y:
        local = exp(-PARTS * (x + count))
        count = count + 1.0
        part = WEIGHTS @ local
        total = total + part
    return total


def a_node_differs(x, y):
    local = exp(PARTS * x)
    first, second, third, fourth, fifth = local
    total = 0.1 * first + 0.2 * second + 0.4 * third + 0.2 * fourth + 0.1 * math.log(y)
    return total + fifth


@pytest.mark.parametrize(
    ("function", "loops"),
    [
        (quadrature, 3),
        (two_of_the_same_nodes, 2),
        (in_a_branch, 2),
        (in_a_loop, 3),
        (a_node_is_read_elsewhere, 0),
        (a_node_differs, 0),
    ],
)
def test_a_sum_over_nodes_is_a_loop_that_gives_what_python_gives(tmp_path, function, loops):
    in_c, rng = translated(tmp_path, function, unknown(2)), random.Random(1)
    assert in_c.text.count("for (") == loops, in_c.text
    for _ in range(20):
        x, y = rng.uniform(0.0, 4.0), rng.uniform(1.0, 5.0)
        assert in_c(x, y) == approx(function(x, y), rel=1e-13)


def test_a_call_that_no_node_changes_stands_before_the_loop(tmp_path):
    text = translated(tmp_path, quadrature, unknown(2)).text
    assert text.count("own_pow(") == text.count("own_pows(") == 1
    assert text.index("0.3)") < text.index("for (")


POWERS = (0.25, 0.5, 0.75, 1.5, 2.0, 3.0, 4.0, 8.0)


def powers(x):
    return tuple(x**power for power in POWERS) + tuple(x**-power for power in POWERS)


def test_quarter_and_whole_powers_need_no_logarithm_and_are_right_to_six_units(tmp_path):
    in_c, rng = translated(tmp_path, powers, unknown(1)), random.Random(2)
    assert "own_pow" not in in_c.text
    for _ in range(200):
        x = 10.0 ** rng.uniform(-20.0, 20.0)
        for found, expected in zip(in_c(x), powers(x), strict=True):
            assert abs(found - expected) <= 6.0 * math.ulp(expected)


def nothing(x, y):
    lost = 0.0 * x
    if lost / y != 0.0 or x - x != 0.0:
        return exp(y)
    return max(x, x) * (y / y) + 0.5


def test_arithmetic_that_gives_nothing_is_left_out(tmp_path):
    in_c = translated(tmp_path, nothing, unknown(2))
    assert "own_exp" not in in_c.text
    assert "if" not in in_c.text
    assert in_c(3.0, 2.0) == 3.5


def test_a_variable_is_declared_with_its_first_value(tmp_path):
    text = translated(tmp_path, in_a_loop, unknown(2)).text
    assert "double total = 0.0;" in text
    assert "double total;" not in text
