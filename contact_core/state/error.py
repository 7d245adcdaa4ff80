"""Error of one output, by its causes."""

import math
from typing import NamedTuple


class Error(NamedTuple):
    """Half widths (95 %) of the error of an output by each of its causes, in its unit."""

    time: float = 0.0  # steps in time: blocks
    sampling: float = 0.0  # the few instants at which a block is solved
    grid: float = 0.0  # distance of the nodes
    iteration: float = 0.0  # solutions that stop early, and time steps in which contacts begin and end
    curves: float = 0.0  # fitted curves of the regression level
    inlet: float = 0.0  # a domain that ends within the inlet

    @property
    def together(self) -> float:
        """Half width by all causes, as if they were independent."""
        return math.hypot(*self)

    def scaled(self, factor: float) -> "Error":
        """Return the error of the output times a factor."""
        return Error(*(abs(factor) * part for part in self))
