"""Iterations that solve v = G(v) for the coupled values v [size] of one communication step.

The caller evaluates G, decides by the norm of G(v) - v over the allowed errors `scale` [size] when to stop, and asks a
method only for the next v. What a method keeps from accepted steps is restored with the state of a system that goes back.

Sources: Küttler & Wall, Comput. Mech. 43 (2008) 61, doi:10.1007/s00466-008-0255-5 (Aitken's relaxation of vectors);
Degroote, Bathe & Vierendeels, Comput. Struct. 87 (2009) 793, doi:10.1016/j.compstruc.2008.11.013 (IQN-ILS);
Haelterman et al., Comput. Struct. 171 (2016) 9, doi:10.1016/j.compstruc.2016.04.001 (filtering of columns).
"""

import math
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from .control import wrms
from .secant import Secant, probing

Array = NDArray[np.float64]

_RELAXATION = 0.1, 2.0  # least and largest magnitude of Aitken's factor
_FIRST = 0.5  # Aitken's factor before anything is known
_STEPS = 4  # communication steps whose differences are kept
_DEPENDENT = 1e-4  # part of a difference outside of the others below which it tells nothing new
_WORSE = 10.0  # growth of the residual that takes a step back
_BACK = 0.1, 0.5  # least and largest part of such a step that is tried instead


class Method(Protocol):
    """What all methods offer."""

    def start(self, v: Array, scale: Array) -> None:
        """Begin a communication step at v, with the errors that are allowed."""

    def next(self, v: Array, g: Array) -> Array:
        """The next value to try, after g = G(v) has been evaluated."""

    def accept(self, v: Array, g: Array) -> None:
        """The step is done with g = G(v): keep what serves the next one."""

    def clear(self) -> None:
        """Forget the past, as after an event."""

    def copy(self) -> Any:
        """What `restore` needs: all that is kept between steps."""

    def restore(self, memory: Any) -> None:
        """Go back to what `copy` has returned."""


class FixedPoint:
    """v <- G(v): converges where G contracts."""

    def start(self, v: Array, scale: Array) -> None: ...

    def next(self, v: Array, g: Array) -> Array: 
        return g.copy()

    def accept(self, v: Array, g: Array) -> None: ...

    def clear(self) -> None: ...

    def copy(self) -> None: ...

    def restore(self, memory: None) -> None: ...


class Aitken:
    """v <- v + w r with the residual r and one factor w for all entries, from the last two residuals."""

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        self._kept = _FIRST

    def start(self, v: Array, scale: Array) -> None:
        self._scale, self._factor, self._residual = scale, self._kept, None

    def next(self, v: Array, g: Array) -> Array:
        residual = (g - v) / self._scale
        if self._residual is not None:
            change = residual - self._residual
            square = change.dot(change)
            if square > 0.0:
                self._factor = _bounded(-self._factor * self._residual.dot(change) / square)
        self._residual = residual
        return v + self._factor * (g - v)

    def accept(self, v: Array, g: Array) -> None: ...

    def copy(self) -> Any:
        return self._kept

    def restore(self, memory: Any) -> None:
        self._kept = memory


METHODS = {"fixed_point": FixedPoint, "aitken": Aitken}
