"""Events: outputs of a system whose change of sign or of value must not be stepped over."""

import math
from collections.abc import Callable
from typing import Any

from .coupled import Coupled

Values = tuple[list[float], list[Any]]


class Indicators:
    """The outputs that indicate events: a continuous Real one by being above zero or not, any other by its value."""

    def __init__(self, coupled: Coupled) -> None:
        self._coupled = coupled
        self._reals = [coupled.wiring.output_place[port.name] for port in coupled.system.events if port.continuous]
        self._others = [port for port in coupled.system.events if not port.continuous]

    def values(self) -> Values:
        """Return their values now."""
        return [float(self._coupled.outputs[n]) for n in self._reals], [self._coupled.get(p) for p in self._others]

    def at_start(self) -> Values:
        """Return their values before the first step: a zero there has no sign yet."""
        reals, others = self.values()
        return [value or math.nan for value in reals], others

    def locate(self, to: Callable[[float], Values], low: float, before: Values, high: float, width: float) -> float:
        """Return a time at most `width` after an event between `low` and `high` [s]; now are the values at `high`.

        `to` goes to a time between them and returns the values there.
        """
        after = self.values()
        round_ = 0
        while high - low > width:
            round_ += 1
            guess = 0.5 * (low + high) if round_ % 3 == 0 else _secant(low, before, high, after)
            guess = min(max(guess, low + 0.5 * width), high - 0.5 * width)
            values = to(guess)
            if changed(before, values):
                high, after = guess, values
            else:
                low, before = guess, values
        return high


def changed(before: Values, after: Values) -> bool:
    """Return True if there is an event between two sets of values; after a NaN there is none."""
    signs = any(one == one and (one > 0.0) != (other > 0.0) for one, other in zip(before[0], after[0], strict=True))
    return signs or before[1] != after[1]


def _secant(low: float, before: Values, high: float, after: Values) -> float:
    """Return the zero, on a straight line, of the first Real that changes its sign; the middle if none does."""
    zeros = [
        low + (high - low) * one / (one - other)
        for one, other in zip(before[0], after[0], strict=True)
        if one == one and (one > 0.0) != (other > 0.0)
    ]
    return min(zeros, default=0.5 * (low + high))
