"""What components compute with functions of scipy and numpy, once more with bounded loops: to be written in C.

`INSTEAD` names the functions that these stand for. They agree to rounding.
"""

import inspect
import math
from collections.abc import Callable, Mapping
from itertools import product
from typing import Any

import numpy as np

from contact_core.kernels.arrays import Array

from . import linear
from .eigen import symmetric_eigen
from .part import Values
from .thermal import Course, Piece, Regimes, ThermalNetwork

_TERMS = 18  # of the series of the exponential, for a norm up to 1
_LOOKS = 61  # times in a step at which thermostats are looked at, from 1e-6 of it on
_DECADES = 6.0
_LOCATED = 1e-14  # of a step, to which a change of regime is found


# matrices


def exponential(matrix: Array) -> Array:
    """Return the exponential of a matrix [n, n], by its series for a part of it that is squared again and again."""
    norm, scale, doublings = max([sum([abs(x) for x in row]) for row in matrix]), 1.0, 0
    while norm > 1.0:
        norm, scale, doublings = 0.5 * norm, 0.5 * scale, doublings + 1
    small = matrix * scale
    found = _next(small, np.eye(len(matrix)), 1.0 / _TERMS)
    for k in range(_TERMS - 1, 0, -1):
        found = _next(small, found, 1.0 / k)
    while doublings > 0:
        found, doublings = _times(found, found), doublings - 1
    return found


def _next(small: Array, found: Array, share: float) -> Array:
    return np.eye(len(small)) + (small @ found) * share


def _times(one: Array, other: Array) -> Array:
    return one @ other


# thermal networks


def piece(
    network: ThermalNetwork, regimes: Regimes, temperatures: list[float], inputs: Values, left: float, changes: int
) -> Piece:
    """Return what happens in regimes that are known at run time only, as `ThermalNetwork._piece` does."""
    known = [*product((0, -1, 1), repeat=len(network.thermostats))]
    for each in known[:-1]:
        if regimes == each:
            return network.in_regimes(each, temperatures, inputs, left, changes)
    return network.in_regimes(known[-1], temperatures, inputs, left, changes)


def leaves(course: Course, place: int, least: float, most: float, until: float) -> tuple[float, int]:
    """Return when a node's temperature leaves a range, and -1 for below, 1 for above; (until, 0) if never."""
    earlier = 0.0
    for look in range(_LOOKS):
        time = until * math.exp(math.log(10.0) * (0.1 * look - _DECADES))
        now = course.end(time)[place]
        if now < least:
            return _crossing(course, place, -1, least, earlier, time)
        if now > most:
            return _crossing(course, place, 1, most, earlier, time)
        earlier = time
    return until, 0


def _crossing(course: Course, place: int, turn: int, level: float, before: float, after: float) -> tuple[float, int]:
    """Return when a node's temperature passes a level between two times; at once where it has by rounding."""
    low, high = before, after
    if turn * (course.end(low)[place] - level) >= 0.0:
        return low, turn
    while high - low > _LOCATED * after:
        middle = 0.5 * (low + high)
        if turn * (course.end(middle)[place] - level) < 0.0:
            low = middle
        else:
            high = middle
    return high, turn


INSTEAD: Mapping[Any, Callable[..., Any]] = {
    linear.exponential: exponential,
    ThermalNetwork._piece: piece,
    Course.leaves: leaves,
    inspect.unwrap(np.linalg.eigh): symmetric_eigen,
}
