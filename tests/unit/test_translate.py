"""Python that the translator writes as C: every construct gives what Python gives."""

import math
import random
import re
import shutil
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import pytest
from comparison import approx
from translated import translated, unknown

from contact_core.laws.elementary import exp, log, sqrt, tanh
from fmu_src.native.translate import Untranslatable, leaves

pytestmark = [pytest.mark.unit, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]

VALUES = (-3.0, -1.0, -0.5, 0.0, 0.25, 1.0, 2.0, 7.5)


class Pair(NamedTuple):
    left: float
    right: float


@dataclass(frozen=True)
class Record:
    size: float
    power: float = 2.0

    @property
    def grown(self):
        return self.size**self.power

    def times(self, factor):
        return replace(self, size=self.size * factor)


def early_return(x, y):
    if x < 0.0:
        return -x
    if y > 1.0 and x != y:
        x = x + y
    elif not y:
        return 5.0
    else:
        y = 3.0
    return x - y


def loop_with_carried_names(x, y):
    total, count, step = 0.0, 0, abs(x) + 0.5
    while total < 20.0:
        if step > 3.0:
            total += 10.0
            continue
        total, step = total + step, step * 1.5
        count += 1
        if count == 6:
            break
    return total + count * y


def swapped_in_a_loop(x, y):
    i = 0
    while i < 5:
        x, y = y, x + 0.5 * y
        i += 1
    return x, y


def endless(x, y):
    step = 4.0
    while True:
        after = x + step
        if abs(after) < 0.7 * abs(x) + 5.0:
            return after, step
        step = 0.5 * step - 0.25 * after + y * 0.0


def tuples(x, y):
    first, *rest = (x, y, x * y, 4.0)
    (a, b), c = (first, rest[1]), rest[-1]
    return a + b, c, sum(rest)


def named_tuple(x, y):
    pair = Pair(x, y)._replace(right=x + y)
    other = pair if x > y else Pair(y, 1.0)
    return other.left - other.right


def record(x, y):
    found = Record(abs(x)).times(y)
    if x > 0.0:
        found = replace(found, size=found.size + 1.0)
    return found.grown


def comprehensions(x, y):
    squares = [each * each for each in (x, y, x - y) if each is not None]
    named = {name: value for name, value in zip("ab", squares, strict=False)}
    return sum(squares), named["a"], max(value for _, value in enumerate(squares))


def and_or_with_values(x, y):
    return (x and y) + (x or 2.0) + ((x > 0.0 and y > 0.0) or x < -2.0)


def chained_comparison(x, y):
    return 1.0 if -1.0 <= x < y <= 2.0 else 0.0


def extremes(x, y):
    return min(x, y, 1.0), max(0.5, x, y), np.minimum(x, y), float(np.maximum(y, x))


def closures(x, y):
    def scaled(z, by=2.0):
        return z * by + y

    more = lambda z: scaled(z, by=x)  # noqa: E731
    return scaled(x), more(3.0)


def arrays(x, y):
    values = np.array([x, y, x + y])
    table = np.array([1.0, 2.0, 3.0])
    found = np.where(values > 0.0, values * table, -values)
    return found.max(), float(found @ table), np.abs(values[:2]).sum()


def elementary(x, y):
    size = abs(x) + 0.1
    return exp(-size) + log(size) + sqrt(size) + tanh(y) + math.hypot(x, y) + size**y + size**0.5 + size**-2.0


def whole_numbers(x, y):
    flags = 0
    if x > 0.0:
        flags |= 4
    if y > 0.0:
        flags |= 1 << 3
    return flags | int(x > y)


def named_expression(x, y):
    return z * z if (z := x - y) > 0.0 else z


def unrolled(x, y):
    total = 0.0
    for i, factor in enumerate((1.0, 2.0, 3.0)):
        if i == 1:
            continue
        if i == 2:
            total += 100.0
            break
        if x > 0.0:
            total = total + factor * x
    return total + y


WEIGHTS = np.array([0.1, 0.2, 0.3, 0.25, 0.15])
NODES = np.array([0.125, 0.25, 0.5, 0.75, 1.5])


def quadrature(x, y):
    base = NODES * np.abs(y) + 1.0
    each = np.exp(NODES * x) + np.arcsinh(np.abs(NODES * x)) * base ** (0.3 * y) / base**-1.7
    total = WEIGHTS @ each
    return float(total) + x


def powers(x, y):
    base, other = abs(x) + 0.5, abs(y) + 0.25
    one = base**0.3
    two = other**1.7 * one
    if two > 2.0:
        return (two + base ** (other**-0.6)) ** 0.9 + (one * base) ** 0.2
    three = (two + 1.0) ** 0.4
    return Pair(base**-0.7 + three**0.35, other**0.1 if x > 0.0 else base**0.6).left


def chosen_constants(x, y):
    limit = math.inf if x > y else 3
    return min(limit, 10.0) + (x == y)


def mixed_kinds(x, y):
    return [x, Pair(y, -0.0)], {"sum": x + y}


CONSTRUCTS = (
    early_return,
    loop_with_carried_names,
    swapped_in_a_loop,
    endless,
    tuples,
    named_tuple,
    record,
    comprehensions,
    and_or_with_values,
    chained_comparison,
    extremes,
    closures,
    arrays,
    elementary,
    whole_numbers,
    named_expression,
    unrolled,
    quadrature,
    powers,
    chosen_constants,
    mixed_kinds,
)


def flat(value):
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, tuple | list | np.ndarray):
        return [number for item in value for number in flat(item)]
    return [float(value)]


@pytest.mark.parametrize("function", CONSTRUCTS)
def test_a_construct_is_the_same_in_c(function, tmp_path):
    in_c = translated(tmp_path, function, unknown(2))
    rng = random.Random(1)
    pairs = [(x, y) for x in VALUES for y in VALUES] + [(rng.gauss(0, 3), rng.gauss(0, 3)) for _ in range(50)]
    for x, y in pairs:
        assert flat(in_c(x, y)) == approx(flat(function(x, y)), rel=1e-14, abs=0.0), (x, y)


def test_elementary_functions_of_nodes_take_arrays(tmp_path):
    in_c = translated(tmp_path, quadrature, unknown(2))
    for call in ("own_exps(5, ", "own_asinhs(5, ", "own_pows(5, "):
        assert in_c.text.count(call) >= 1
    assert not re.search(r"own_(exp|asinh)\(", in_c.text)


def in_turn(x, y):
    base = abs(x) + 0.5
    first = base**0.3
    second = first**1.7
    apart = (y * y + 1.0) ** 0.6
    return second + apart


def test_powers_are_in_pairs_where_neither_needs_the_other(tmp_path):
    in_c = translated(tmp_path, in_turn, unknown(2))
    assert in_c.text.count("own_two_powers(base, 0.3, y * y + 1.0, 0.6)") == 1
    assert in_c.text.count("own_pow(first, 1.7)") == 1


def refusing(x, y):
    if x > y:
        raise ValueError(f'load = {x:.3g} N (100 %) is above {y:g} N at {1.5:g} m. Use "less".')
    if y < 0.0:
        raise ValueError("50 % of \\ it")
    return x + y


def careful(x, y):
    return refusing(x, y) * 2.0


def test_messages_of_errors_are_those_of_python(tmp_path):
    in_c = translated(tmp_path, careful, unknown(2))
    assert in_c(1.0, 2.0) == 6.0
    for pair in ((3.5, 2.0), (-2.0, -1.0)):
        with pytest.raises(ValueError, match=r".") as error:
            careful(*pair)
        assert in_c(*pair) == str(error.value)


def careless(x, y):
    _ = refusing(x, y)
    __, ___ = both(x, y)
    return x - y


def both(x, y):
    refusing(y, x + 5.0)
    return x * 2.0, y * 2.0


def test_an_error_of_a_call_whose_result_nothing_reads_is_kept(tmp_path):
    in_c = translated(tmp_path, careless, unknown(2))
    assert in_c(1.0, 2.0) == -1.0
    for pair in ((3.5, 2.0), (1.0, 7.0)):
        with pytest.raises(ValueError, match=r".") as error:
            careless(*pair)
        assert in_c(*pair) == str(error.value)


def unending(x, y):
    while x > 0.0:
        x = x + 1.0
    return x + y


def test_a_loop_without_end_is_refused(tmp_path):
    in_c = translated(tmp_path, unending, unknown(2))
    assert in_c(-1.0, 0.5) == -0.5
    assert "parts" in in_c(1.0, 0.0)


def known(x, y, factor):
    return x * factor + (y if factor > 1.0 else 0.0)


def test_what_is_known_is_computed_and_what_nothing_reads_is_left_out(tmp_path):
    in_c = translated(tmp_path, known, [*unknown(2), 0.5])
    assert in_c(3.0, 9.0) == 1.5
    assert "double y" not in in_c.text
    assert "factor" not in in_c.text


def twice(x, y):
    return inner(x, 1) + inner(y, 2)


def inner(x, label):
    if x > 0.0:
        return x * 2.0
    return -x


def test_functions_that_are_alike_are_written_once(tmp_path):
    in_c = translated(tmp_path, twice, unknown(2))
    assert in_c(2.0, -3.0) == 7.0
    assert in_c.text.count("static double inner") == 1


def by_other_names(x, y):
    return first_of({"left": x, "right": y}) - first_of({"above": y, "below": x}) / first_of({"one": x, "two": x})


def first_of(sides):
    one, other = sides.values()
    total = one * 2.0
    if one > 0.0:
        return total + other
    return -total


def test_functions_that_are_alike_but_for_names_are_written_once(tmp_path):
    in_c = translated(tmp_path, by_other_names, unknown(2))
    assert in_c(2.0, -3.0) == by_other_names(2.0, -3.0)
    assert in_c.text.count("static double first_of(") == 1
    assert in_c.text.count("static double first_of") == 2  # one body, or both the same


def places(x, y):
    return ({"one": 1.0}, {"one": x})[int(x > y)]


def tried(x, y):
    try:
        return x / y
    except ZeroDivisionError:
        return 0.0


def other_forms(x, y):
    found = None
    if x > y:
        found = x
    return found + 1.0


def bound_in_a_branch(x, y):
    if x > y:
        late = x
    return late + y


def bound_in_a_loop(x, y):
    while x < 5.0:
        x = x + abs(y) + 1.0
        late = x
    return late


def left_at_run_time(x, y):
    for each in (x, y):
        if each > 0.0:
            break
    return each


def loop_with_else(x, y):
    while x < 1.0:
        x = x + 1.0
    else:
        x = y
    return x


def unbound(x, y):
    return x + not_there(y)  # noqa: F821


@pytest.mark.parametrize(
    ("function", "said"),
    [
        (places, "place"),
        (tried, "no Try"),
        (other_forms, "a number"),
        (bound_in_a_branch, "'late'.*one branch"),
        (bound_in_a_loop, "'late'.*loop"),
        (left_at_run_time, "break"),
        (loop_with_else, "else"),
        (unbound, "not_there"),
    ],
)
def test_what_has_no_counterpart_names_the_function_and_its_line(function, said, tmp_path):
    with pytest.raises(Untranslatable, match=said) as error:
        translated(tmp_path, function, unknown(2))
    place = str(error.value).splitlines()[-1]
    assert f"test_translate.{function.__name__}, line " in place
    line = int(place.split("line ")[1].split(":")[0])
    code = function.__code__
    assert code.co_firstlineno < line <= code.co_firstlineno + 6


def test_numbers_at_run_time_keep_their_order():
    value = {"a": [unknown(1)[0], 2.0], "b": Pair(*unknown(2))}
    assert [number.text for _, number in leaves(value)] == ["x0", "x0", "x1"]
