"""A film that grows in proportion to the room left and is rubbed off in proportion to its thickness, in closed form.

    dg/dt = f (X - g) - r (g - q),   dq/dt = c (Q - q),   f : r : c fixed

g is what has formed, up to X, and q what the film loses by itself, up to Q; g - q is its thickness. `forming`, `taking`
and `losing` are f, r and c times the time. The equations are linear, so any cutting of the time gives the same. What is
rubbed off leaves room to grow in, q stays.
"""

import numpy as np

from ..elementary import Numbers, exp, expm1, minimum


def relaxed(now: Numbers, limit: float, forming: Numbers, taking: Numbers) -> Numbers:
    """Return g [m] after it was `now`, where q is zero; or q, with c as `forming` and nothing as `taking`."""
    both = forming + taking
    return now - (limit * _part(forming, both) - now) * expm1(-both)


def taken(taking: Numbers) -> bool:
    """Return True if anything is rubbed off."""
    return taking != 0.0 if isinstance(taking, float) else bool(taking.any())


def fed_back(now: Numbers, limit: float, losing: Numbers, both: Numbers) -> Numbers:
    """Return the part of g [m] per `taking` that q leaves it, while q goes from `now` towards its `limit`.

    `both` is `forming` and `taking` together.
    """
    return limit * _mean(both) + (now - limit) * exp(-minimum(both, losing)) * _mean(abs(both - losing))


def mean(now: Numbers, limit: float, losing: Numbers) -> Numbers:
    """Return the mean of q [m] over the time in which it goes from `now` towards its `limit`."""
    return limit + (now - limit) * _mean(losing)


def formed(
    now: Numbers, after: Numbers, limit: float, forming: Numbers, taking: Numbers, kept: Numbers = 0.0
) -> Numbers:
    """Return what has formed [m], f (X - g) over the time in which g went from `now` to `after`; `kept`: mean of q."""
    gain = after - now
    middle = _part(forming * limit + taking * kept - gain, forming + taking)  # the mean of g
    return gain + taking * (middle - kept)


def _mean(rate: Numbers) -> Numbers:
    """Return the mean of exp(-rate t) over t from 0 to 1."""
    return _part(-expm1(-rate), rate, 1.0)


def _part(part: Numbers, whole: Numbers, of_nothing: float = 0.0) -> Numbers:
    """Return part / whole, `of_nothing` where both are zero."""
    if isinstance(whole, float):
        return part / whole if whole > 0.0 else of_nothing
    return np.divide(part, whole, out=np.full_like(whole, of_nothing), where=whole > 0.0)
