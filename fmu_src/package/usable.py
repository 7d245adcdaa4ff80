"""The ranges of inputs that an FMU describes: narrower than those of all contacts where its scene refuses values."""

import math
from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np

from contact_core import ContactError, OperatingPoint, advance, initial_state
from contact_core.film import Regression
from contact_core.quantities import UNSOLVED
from contact_core.scene import Scene

from ..variables import Variable, first_point

_HALVINGS = 30  # of the interval in which a bound lies: some 1e-9 of it
_DIGITS = range(6, 18)  # of a bound: as few as are within the range


def usable(scene: Scene, table: Iterable[Variable]) -> tuple[Variable, ...]:
    """Return the variables with inputs limited to the values that the scene can use.

    Each input alone is tried, the others at their start values. For levels that solve contacts the regression level
    answers, and the grid of those that have no other answer must hold the contact.
    """
    first, can = first_point(scene), _can(scene)
    if not can(first):
        return tuple(table)
    return tuple(_narrowed(v, first, can) if v.causality == "input" else v for v in table)


def _narrowed(v: Variable, first: OperatingPoint, can: Callable[[OperatingPoint], bool]) -> Variable:
    def fits(value: float) -> bool:
        return can(replace(first, **{v.name: value}))

    low, high = (_bound(float(v.start), end, fits) for end in (v.minimum, v.maximum))
    return replace(v, minimum=low, maximum=high)


def _bound(inside: float, end: float, fits: Callable[[float], bool]) -> float:
    """Return the end of a range, or the last value before it that fits; `inside` does."""
    if fits(end):
        return end
    outside = end
    for _ in range(_HALVINGS):
        middle = 0.5 * (inside + outside)
        inside, outside = (middle, outside) if fits(middle) else (inside, middle)
    return next(value for digits in _DIGITS if fits(value := float(f"{inside:.{digits}g}")))


def _can(scene: Scene) -> Callable[[OperatingPoint], bool]:
    """Return the function that says whether a scene can use an operating point."""
    level = scene if scene.film.fidelity in UNSOLVED else scene.at_level(Regression.name)
    state = initial_state(level)

    def can(point: OperatingPoint) -> bool:
        if scene.film.on_grid and point.load > 0.0 and not scene.has_room(scene.hertz_at(point)):
            return False
        try:
            with np.errstate(all="ignore"):
                _, outputs = advance(level, point, state, 0.0)
        except ContactError:
            return False
        return all(math.isfinite(value) for value in vars(outputs).values())

    return can
