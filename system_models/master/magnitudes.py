"""Magnitudes of the outputs that are exchanged, by which tolerances are relative."""

from collections.abc import Sequence

import numpy as np

from contact_core.arrays import Array


class Magnitudes:
    """The nominal or largest value of each output; an expected one where it has neither."""

    def __init__(self, nominal: Sequence[float]) -> None:
        self.known = np.array(nominal, dtype=float)
        self.expected = np.zeros(len(self.known))

    def accept(self, outputs: Array) -> None:
        """Take the outputs at the end of a step that is accepted."""
        np.maximum(self.known, np.abs(outputs), out=self.known)

    def expect(self, outputs: Array) -> None:
        """Take the present values as magnitudes of outputs that start at zero and have no nominal."""
        np.copyto(self.expected, np.abs(outputs), where=(self.known == 0.0) & (self.expected == 0.0))

    def scales(self, outputs: Array) -> Array:
        """Return a positive magnitude of each output."""
        return positive(np.maximum(np.maximum(self.known, self.expected), np.abs(outputs)))


def positive(values: Array) -> Array:
    """Return magnitudes; where there is none yet, 1, FMI's default of nominal."""
    return np.where(values > 0.0, values, 1.0)
