"""A variable that grows towards its limit and is rubbed off in proportion to itself, in closed form.

    dx/dt = f (X - x) - r x,   f and r in a fixed ratio

`forming` and `taking` are f and r times the time. Every law whose film grows in proportion to the room left, under a
removal in proportion to what there is, is one or two of these; so any cutting of the time gives the same.
"""

import numpy as np

from ..elementary import Numbers, expm1


def relaxed(now: Numbers, limit: float, forming: Numbers, taking: Numbers) -> Numbers:
    """Return the variable [m] after it has grown towards `limit` [m] and was rubbed off; it was `now`."""
    both = forming + taking
    return now - (limit * _share(forming, both) - now) * expm1(-both)


def formed(now: Numbers, after: Numbers, limit: float, forming: Numbers, taking: Numbers) -> Numbers:
    """Return what has grown [m] while the variable went from `now` to `after`: its gain and what was rubbed off."""
    both = forming + taking
    settled = limit * _share(forming, both)
    mean = settled + (now - settled) * (1.0 - _share(both + expm1(-both), both))
    return (after - now) + taking * mean


def _share(part: Numbers, whole: Numbers) -> Numbers:
    """Return part / whole, 0 where there is nothing."""
    if isinstance(whole, float):
        return part / whole if whole > 0.0 else 0.0
    return np.divide(part, whole, out=np.zeros_like(whole), where=whole > 0.0)
