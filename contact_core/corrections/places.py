"""Where a contact lies among others, by what the regression level says of it."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

SLIP, THIN, NONE = 0.1, 1e-3, 1e-9  # least numbers: no logarithm of 0


class Place(NamedTuple):
    """The coordinates that all corrections share; numbers or arrays."""

    clearance: Any  # ln of h_c over composite roughness
    slip: Any  # ln of (sliding over entrainment speed + 0.1)
    pressed: Any  # ln of Hertz's largest pressure over the hardness
    share: Any  # contact_load_ratio
    oil: Any  # ln of (the oil's friction over the load that it carries + `Guards.oil`)


class Guards(NamedTuple):
    """What keeps logarithms finite, of numbers or of arrays."""

    oil: float  # as much friction of the oil counts as none: pure rolling is near little sliding
    log: Callable[[Any], Any] = math.log
    largest: Callable[[Any, Any], Any] = max


def place_of(by: Guards, clearance: Any, mean: Any, slide: Any, pressed: Any, share: Any, oil: Any, load: Any) -> Place:
    """Return a place: `mean` and `slide` are entrainment and sliding speed [m/s], `oil` the oil's friction [N]."""
    return Place(
        by.log(by.largest(clearance, THIN)),
        by.log(slide / by.largest(mean, NONE) + SLIP),
        by.log(pressed),
        share,
        by.log(oil / (by.largest(1.0 - share, NONE) * load) + by.oil),
    )
