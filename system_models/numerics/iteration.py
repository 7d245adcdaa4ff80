"""Iterations that solve v = G(v) for the coupled values v [size] of one communication step.

The caller evaluates G and decides when to stop; a method gives the next v. The memory of accepted steps is restored
with the states. Source: Küttler & Wall, Comput. Mech. 43 (2008) 61, doi:10.1007/s00466-008-0255-5 (Aitken).
"""

import math
from typing import Any, Protocol

from .arrays import Array
from .quasi_newton import QuasiNewton

_FIRST = 0.1  # Aitken's factor before anything is known
_LEAST, _MOST = 1e-6, 2.0  # its magnitude


class Method(Protocol):
    """Contract of an iteration method."""

    def start(self, scale: Array) -> None:
        """Begin a communication step with the errors that are allowed."""

    def next(self, v: Array, g: Array) -> Array:
        """Return the next values to try, after g = G(v) has been evaluated; always finite if the first g is."""

    def accept(self, v: Array, g: Array) -> None:
        """Accept g = G(v) as the result of the step; keep the memory for the next step."""

    def clear(self) -> None:
        """Forget the past, as after an event."""

    def copy(self) -> Any:
        """Return the memory for `restore`: all that is kept between steps; nothing in it ever changes."""

    def restore(self, memory: Any) -> None:
        """Go back to a memory that `copy` has returned."""


class FixedPoint:
    """v <- G(v): converges where G contracts."""

    def start(self, scale: Array) -> None:
        """Begin a communication step."""

    def next(self, v: Array, g: Array) -> Array:
        """Return G(v) itself."""
        return g.copy()

    def accept(self, v: Array, g: Array) -> None:
        """Keep nothing."""

    def clear(self) -> None:
        """Do nothing: there is no memory."""

    def copy(self) -> None:
        """Return nothing."""

    def restore(self, memory: None) -> None:
        """Do nothing: there is no memory."""


class Aitken:
    """v <- v + w r with the residual r = G(v) - v, and one factor w from the last two residuals.

    A communication step begins with the factor at the end of the last one.
    """

    def __init__(self) -> None:
        self._kept = _FIRST

    def start(self, scale: Array) -> None:
        """Begin a communication step with the errors that are allowed."""
        self._scale = scale
        self._factor = self._kept
        self._residual: Array | None = None

    def next(self, v: Array, g: Array) -> Array:
        """Return a relaxed step along the residual."""
        residual = (g - v) / self._scale
        if self._residual is not None:
            change = residual - self._residual
            square = change.dot(change)
            if square > 0.0:
                factor = -self._factor * self._residual.dot(change) / square
                self._factor = math.copysign(min(max(_LEAST, abs(factor)), _MOST), factor)  # NaN: _LEAST
        self._residual = residual
        return v + self._factor * (g - v)

    def accept(self, v: Array, g: Array) -> None:
        """Keep the factor."""
        self._kept = self._factor

    def clear(self) -> None:
        """Forget the factor, as after an event."""
        self._kept = _FIRST

    def copy(self) -> float:
        """Return the factor."""
        return self._kept

    def restore(self, memory: float) -> None:
        """Go back to a factor."""
        self._kept = memory


METHODS: dict[str, type[Method]] = {"fixed_point": FixedPoint, "aitken": Aitken, "quasi_newton": QuasiNewton}
