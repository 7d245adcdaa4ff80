"""Asperities shorter than the grid: the pressure that they carry at a gap, and the gap at which they carry a pressure.

    s(h) = stress exp(-(h - floor) / depth) for floor < h < floor + reach,   reach = FAINTEST depth

The total pressure is p = f + s(h). depth = 0: there are none, and solids touch at the floor. Units of `problem`.
"""

import numpy as np

from ..compiled import jit

REACH = 14.0  # depths above the floor at which the asperities end


@jit
def carried_at(h, floor, stress, depth):  # type: ignore[no-untyped-def]
    """Return the pressure that asperities carry at a gap."""
    if depth <= 0.0 or h >= floor + REACH * depth:
        return 0.0
    return stress * np.exp(-max(h - floor, 0.0) / depth)


@jit
def rest_gap(q, floor, stress, depth):  # type: ignore[no-untyped-def]
    """Return the gap at which asperities carry a pressure: the floor from `stress` on."""
    if depth <= 0.0 or q >= stress:
        return floor
    if q <= stress * np.exp(-REACH):
        return floor + REACH * depth
    return floor + depth * np.log(stress / q)
