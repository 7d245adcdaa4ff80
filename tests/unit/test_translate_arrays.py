"""Arrays at run time that the translator writes as C: every construct gives what numpy gives."""

import random
import shutil

import numpy as np
import pytest
from comparison import approx
from test_translate import VALUES, flat
from translated import translated, unknown

from fmu_src.native.translate import Untranslatable

pytestmark = [pytest.mark.unit, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]

TABLE = np.linspace(-1.0, 3.0, 12).reshape(4, 3)
LONG = np.linspace(-2.0, 5.0, 90)  # what is computed with it is a loop


def jit(function):
    """Mark a function as one that would be compiled: the translator goes by the name."""
    return function


def place_at_run_time(x, y):
    k = min(int(abs(x)), 3)
    return TABLE[k], TABLE[k, 1], TABLE[:, min(k, 2)], TABLE[k - 1 if k > 0 else 0, ::-1].sum()


def places_from_the_end(x, y):
    k = -1 if x > 0.0 else -2
    return TABLE[k + int(y > 0.0) - 1], (x, y, 1.0)[-1 - int(x > y)]


def places_at_run_time(x, y):
    k = np.minimum(np.abs(np.array([x, y, x + y])), 2.0).astype(np.int64)
    share = np.array([x, y, 1.0])
    low = TABLE[k]
    return low + share[:, None] * (TABLE[k + 1] - low), TABLE[k, k]


def loops_over_elements(x, y):
    grown = np.exp(-((LONG * x) ** 2)) + y
    rows = grown.reshape(9, 10)
    return grown[::7], rows.sum(axis=0), rows.max(axis=1), rows.mean(), rows[:, 2:5].min(axis=(0, 1))


def broadcast(x, y):
    values = (x * LONG).reshape(3, 30)
    many = values[:, None, :] * np.array([y, 1.0])[:, None]
    return many.shape, many[2, 1, ::9], np.broadcast_to(values[0, :4], (2, 4)), values[..., 1:3].T


def places_of_extremes(x, y):
    values = np.abs(LONG - x).reshape(9, 10)
    deep = np.argmin(values > y, axis=1)
    return values.argmin(), values.argmax(), deep, values.argmax(axis=0)


def sum_by_mask(x, y):
    return (LONG * y)[x >= LONG].sum()


def chosen_by_element(x, y):
    values = LONG * x
    share = np.divide(y, values, out=np.ones_like(values), where=values > 1.0)
    return (
        np.where(values > y, share, -1.0)[::11],
        np.any(values > 6.0 * y),
        np.all(values < 1e3),
        np.sign(values)[::13],
    )


def products(x, y):
    square = np.array([[x, 1.0, 0.5], [0.0, y, 2.0], [1.0, x, y]])
    long = (LONG * x).reshape(30, 3)
    return (long @ square)[::7], long[3:5] @ np.array([1.0, y, 2.0]), square @ long[4]


def joined(x, y):
    values = LONG * x
    return (
        np.append(values, y)[-3:],
        np.array([values, values + y])[:, ::30],
        np.full((2, 3), y),
        np.stack([values])[0, :2],
    )


def carried(x, y):
    values, count = LONG * 0.0, 0
    while values.max() < 10.0 and count < 9:
        if y > 0.0:
            more = abs(x) * LONG
            values = values + more
        else:
            values = values + 1.0
        count += 1
    return values[::10], count


def set_by_place(x, y):
    found = np.zeros(5)
    found[0], found[1] = x, y
    found[0], found[1] = found[1], found[0]
    found[2:] = x * y
    found[3] += found[0]
    found[min(int(abs(x)), 4)] = 7.0
    return found


@jit
def _summed_up(values, below):
    """Set each element to the sum of it and those before; return the last."""
    total = 0.0
    for i in range(values.size):
        if values[i] < below:
            continue
        total += values[i]
        values[i] = total
        if total > 50.0:
            break
    return total


@jit
def _triangle(size, x):
    table = np.zeros((size, size))
    for i in range(size):
        for k in range(i + 1):
            table[i, k] = x * i + k
        for k in range(i + 1, size):
            table[i, k] = -1.0
    return table


def changed_by_a_call(x, y):
    values = LONG * x
    before = values[3]
    last = _summed_up(values, y)
    table = _triangle(4, y)
    row = table[2]
    row += 1.0
    both = table[3, 0] + _summed_up(table[3], -5.0), values[4], _summed_up(values, y)
    return both[0], both[1], both[2], before, last, values[::9], table, _summed_up(table[1], -5.0), table[1]


def handed_on(x, y):
    def forwards(values):
        first = values[0]
        return values, first

    values = LONG * x
    same, first = forwards(values)
    return same[:2], first + y


def chosen_by_an_input(x, y):
    values = LONG * y if x > y else np.zeros(90)
    if x < 0.0:
        part = values[:3]
    else:
        least = np.array([x, y, 1.0])
        part = least + values[3:6]
    return part, values[-1]


CONSTRUCTS = (
    place_at_run_time,
    places_from_the_end,
    places_at_run_time,
    loops_over_elements,
    broadcast,
    places_of_extremes,
    sum_by_mask,
    chosen_by_element,
    products,
    joined,
    carried,
    set_by_place,
    changed_by_a_call,
    handed_on,
    chosen_by_an_input,
)


def listed(result):
    """Return a result with arrays as lists, and whole numbers as they are."""
    return flat(
        [np.asarray(each, np.float64).tolist() for each in (result if isinstance(result, tuple) else (result,))]
    )


@pytest.mark.parametrize("function", CONSTRUCTS)
def test_arrays_are_the_same_in_c(function, tmp_path):
    in_c = translated(tmp_path, function, unknown(2))
    rng = random.Random(1)
    pairs = [(x, y) for x in VALUES for y in VALUES] + [(rng.gauss(0, 3), rng.gauss(0, 3)) for _ in range(50)]
    for x, y in pairs:
        assert flat(in_c(x, y)) == approx(listed(function(x, y)), rel=1e-12, abs=1e-13), (x, y)


def test_an_array_does_not_decide(tmp_path):
    def decided(x, y):
        return x if LONG * y else y

    with pytest.raises(Untranslatable, match="write any or all"):
        translated(tmp_path, decided, unknown(2))
