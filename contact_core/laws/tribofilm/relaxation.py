"""A film that grows in proportion to the room left and is rubbed off in proportion to its thickness, in closed form.

    dg/dt = f (X - g) - r (g - q),   dq/dt = c (Q - q),   f : r : c fixed

g is what has formed, up to X, and q what the film loses by itself, up to Q; g - q is its thickness. `forming`, `taking`
and `losing` are f, r and c times the time. The equations are linear, so any cutting of the time gives the same. What is
rubbed off leaves room to grow in, q stays.
"""

import numpy as np

from ..elementary import Numbers, exp, expm1, minimum

Limits = tuple[float, float]


def relaxed(now: Numbers, limit: float, forming: Numbers, taking: Numbers) -> Numbers:
    """Return g [m] after it was `now`, where q is zero; or q, with c as `forming` and nothing as `taking`."""
    both = forming + taking
    return now - (limit * _part(forming, both) - now) * expm1(-both)


def rubbed(
    growth: Numbers, removal: Numbers, limits: Limits, forming: Numbers, losing: Numbers, taking: Numbers
) -> tuple[Numbers, Numbers]:
    """Return g and q [m] after they were `growth` and `removal`; `limits` are X and Q [m]."""
    grown = relaxed(growth, limits[0], forming, taking)
    if taken(taking):
        grown = grown + taking * _fed_back(removal, limits[1], losing, forming + taking)
    return grown, relaxed(removal, limits[1], losing, 0.0)


def formed(
    growth: Numbers, grown: Numbers, limit: float, forming: Numbers, taking: Numbers, kept: Numbers = 0.0
) -> Numbers:
    """Return what has formed [m], f (X - g) over the time in which g went from `growth` to `grown`; `kept`: mean q."""
    gain = grown - growth
    if not taken(taking):
        return gain
    middle = _part(forming * limit + taking * kept - gain, forming + taking)  # the mean of g
    return gain + taking * (middle - kept)


def mean(removal: Numbers, limit: float, losing: Numbers) -> Numbers:
    """Return the mean of q [m] over the time in which it goes from `removal` towards its `limit`."""
    return limit + (removal - limit) * _mean(losing)


def taken(taking: Numbers) -> bool:
    """Return True if anything is rubbed off."""
    return taking != 0.0 if isinstance(taking, float) else bool(taking.any())


def _fed_back(now: Numbers, limit: float, losing: Numbers, both: Numbers) -> Numbers:
    """Return the part of g [m] per `taking` that q leaves it, while q goes from `now` towards its `limit`.

    `both` is `forming` and `taking` together.
    """
    return limit * _mean(both) + (now - limit) * exp(-minimum(both, losing)) * _mean(abs(both - losing))


def _mean(rate: Numbers) -> Numbers:
    """Return the mean of exp(-rate t) over t from 0 to 1."""
    return _part(-expm1(-rate), rate, 1.0)


def _part(part: Numbers, whole: Numbers, of_nothing: float = 0.0) -> Numbers:
    """Return part / whole, `of_nothing` where both are zero."""
    if isinstance(whole, float):
        return part / whole if whole > 0.0 else of_nothing
    return np.divide(part, whole, out=np.full_like(whole, of_nothing), where=whole > 0.0)
