"""Norm of errors, and the control of the communication step by them.

Sources: Gustafsson, ACM TOMS 17 (1991) 533, doi:10.1145/210232.210242 (PI control, restart after a rejected step);
Söderlind, ACM TOMS 29 (2003) 1, doi:10.1145/641876.641877 (the controller PI.4.2).
"""

import math

import numpy as np

from .arrays import Array

_TARGET = 0.7  # of the error that is allowed
_NEWEST, _PREVIOUS = 0.6, 0.2  # exponents of PI.4.2, times the order
_SMALLEST, _LARGEST = 0.2, 2.0  # factors of the step: an error may be near zero by chance, hence no larger ones


def scale(tolerance: float, nominal: Array, values: Array) -> Array:
    """Return errors that are allowed in values: `tolerance` relative to them, and absolute in the unit of `nominal`."""
    return tolerance * (nominal + np.abs(values))


def wrms(error: Array, scale: Array) -> float:
    """Return the weighted root mean square of an error: 1 where every entry is as large as its scale, 0 of nothing."""
    weighted = error / scale
    return math.sqrt(weighted.dot(weighted) / weighted.size) if weighted.size else 0.0


class StepControl:
    """PI controller of the step for an error per unit step that behaves like step^order.

    Errors are given as ratios to the allowed error. The caller decides whether a step is accepted.
    """

    def __init__(self, order: int) -> None:
        self._order = order
        self.after_event()

    def after_event(self) -> None:
        """Forget: errors before an event say nothing about those after it."""
        self._previous = 0.0  # ratio of the last step, where it predicts the next; else 0
        self._rejects = 0

    def accept(self, ratio: float) -> float:
        """Return the factor of the next step after one that was accepted."""
        factor = _limited(self._proposed(ratio))
        after_reject, self._rejects = self._rejects > 0, 0
        # The error after a limited change of the step reflects the change, not the problem.
        self._previous = ratio if _SMALLEST < factor < _LARGEST and not after_reject else 0.0
        return min(factor, 1.0) if after_reject else factor

    def reject(self, ratio: float) -> float:
        """Return the factor of the same step, to be repeated; a ratio that is not finite shrinks it most.

        Each reject more in a row shows that the error falls more slowly than with the order: the factor is its power.
        """
        self._rejects += 1
        self._previous = 0.0
        return _limited((_TARGET / ratio) ** (self._rejects / self._order))

    def copy(self) -> dict[str, float]:
        """Return the memory for `restore`, fit for a checkpoint."""
        return {"previous": self._previous, "rejects": self._rejects}

    def restore(self, memory: dict[str, float]) -> None:
        """Go back to a memory that `copy` has returned."""
        self._previous, self._rejects = memory["previous"], int(memory["rejects"])

    def _proposed(self, ratio: float) -> float:
        if ratio == 0.0:
            return _LARGEST
        if self._previous == 0.0:
            return (_TARGET / ratio) ** (1.0 / self._order)
        newest, previous = ratio / _TARGET, self._previous / _TARGET
        return newest ** (-_NEWEST / self._order) * previous ** (_PREVIOUS / self._order)


def _limited(factor: float) -> float:
    return min(max(_SMALLEST, factor), _LARGEST)  # in this order NaN becomes the smallest
