"""Elementary functions of a number or an array, each by the faster library: a ufunc takes ten times as long as `math`.

Unlike numpy's, a float's result that is too large raises OverflowError: callers bound what they raise to a power.
"""

import math
from typing import Any

import numpy as np

Numbers = Any  # a float, or an array


def exp(x: Numbers) -> Numbers:
    """Return e^x."""
    return math.exp(x) if isinstance(x, float) else np.exp(x)


def expm1(x: Numbers) -> Numbers:
    """Return e^x - 1, exact for small x."""
    return math.expm1(x) if isinstance(x, float) else np.expm1(x)


def log(x: Numbers) -> Numbers:
    """Return the natural logarithm."""
    return math.log(x) if isinstance(x, float) else np.log(x)


def log1p(x: Numbers) -> Numbers:
    """Return ln(1 + x), exact for small x."""
    return math.log1p(x) if isinstance(x, float) else np.log1p(x)


def log10(x: Numbers) -> Numbers:
    """Return the logarithm to the base of ten."""
    return math.log10(x) if isinstance(x, float) else np.log10(x)


def sqrt(x: Numbers) -> Numbers:
    """Return the square root."""
    return math.sqrt(x) if isinstance(x, float) else np.sqrt(x)


def tanh(x: Numbers) -> Numbers:
    """Return the hyperbolic tangent."""
    return math.tanh(x) if isinstance(x, float) else np.tanh(x)


def minimum(x: Numbers, y: Numbers) -> Numbers:
    """Return the smaller of x and y."""
    return min(x, y) if isinstance(x, float) and isinstance(y, float) else np.minimum(x, y)


def maximum(x: Numbers, y: Numbers) -> Numbers:
    """Return the larger of x and y."""
    return max(x, y) if isinstance(x, float) and isinstance(y, float) else np.maximum(x, y)
