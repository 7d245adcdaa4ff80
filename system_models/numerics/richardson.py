"""Error of a step from its two halves, for inputs held as polynomials through any nodes.

Step doubling: a step is made whole and as two halves, and

    error of the two halves = factor x (whole - halves).

The held input is exact at its nodes n_j and has the error c (s - n_0)(s - n_1)... at the time s of the step. c is taken
as the same for the step and its halves, so that it cancels in the factor. The factor follows from the nodes. It is
1 / (2^p - 1) with p = hold order + 1 if the nodes lie at the same fractions of the step and of its halves. The errors
of the halves are added by their amounts: they are not allowed to cancel.
"""

import math
from typing import NamedTuple

_GAUSS = 0.5 - 0.5 / math.sqrt(3.0), 0.5 + 0.5 / math.sqrt(3.0)  # exact up to the third degree


class Halves(NamedTuple):
    """The error of a state after the two halves of a step."""

    error: float  # up to the constant c and the response of the FMU
    per_difference: float  # over the difference between the step and its halves


def halves(size: float, whole: list[float], first: list[float], second: list[float]) -> Halves:
    """Return the error of a state after the two halves of a step.

    The nodes of a step [s] are given from its start, and those of its halves, each from its own start. Where the second
    half has more nodes than the first, as after an event, its error is of higher order: none.
    """
    half = 0.5 * size
    of_whole, of_first = _integral(size, whole), _integral(half, first)
    of_second = _integral(half, second) if len(second) == len(first) else 0.0
    error = abs(of_first) + abs(of_second)
    difference = abs(of_whole - of_first - of_second)
    return Halves(error, error / difference if difference else 1.0)  # a step too small for its cube to be a number


def _product(s: float, nodes: list[float]) -> float:
    return math.prod(s - node for node in nodes)


def _integral(size: float, nodes: list[float]) -> float:
    return 0.5 * size * sum(_product(size * place, nodes) for place in _GAUSS)
