"""One equation v = G(v): the secant method, safeguarded for residuals with kinks and plateaus.

A one-sided contact has a steep residual r(v) = G(v) - v on one side of its root and a flat one on the other, and a
secant across the kink belongs to neither. So the slope at a point comes from the nearest point on its own side of the
root, from a short probing step where there is none, and once a change of sign encloses the root, no step leaves the
interval: a step that would, or one that gains too little, is a bisection.
"""

import math
from dataclasses import dataclass, replace

_WORSE = 2.0  # growth of the residual, without change of sign, that takes a step back
_BACK = 0.25  # part of such a step that is tried instead
_FARTHER = 8.0  # longest step over the step before, near the solution of the last communication step
_GAIN = 0.5  # decrease of the residual on one side of the root below which a step gains too little
_FLATTEST = 1e-3  # least slope of the residual: an unbounded step is at most the residual over it
_PROBE = 1e3  # longest probing step, in allowed errors


@dataclass(frozen=True)
class Point:
    """A value, its residual, and the slope of the residual, where it is known."""

    value: float
    residual: float
    slope: float | None = None

    def beside(self, other: "Point") -> "Point":
        """Return the same point, with the slope towards another."""
        run = self.value - other.value
        return replace(self, slope=(self.residual - other.residual) / run) if run else self

    def root(self) -> float:
        """Return the zero of the residual by its slope; NaN without slope."""
        return self.value - self.residual / self.slope if self.slope else math.nan


def probing(size: float) -> float:
    """Return the length of a step that only measures slopes at a residual of a size, both in allowed errors.

    Long enough to stand out of the errors of G, short enough to stay on this side of a kink.
    """
    return min(math.sqrt(size), size, _PROBE)


class Secant:
    """The iteration on one value; `slope` of the residual at the last solution serves the next step."""

    def __init__(self) -> None:
        self.slope: float | None = None

    def start(self, scale: float) -> None:
        """Begin a communication step with the error that is allowed."""
        self._scale = scale
        self._point: Point | None = None  # best so far, or one end of the interval
        self._other: Point | None = None  # the other end
        self._slow = 0  # steps in a row that gained too little

    def accept(self, value: float, residual: float) -> None:
        """Keep the slope at the solution."""
        end, other = self._point, self._other
        if end is not None and other is not None and abs(other.value - value) < abs(end.value - value):
            end = other
        if end is not None:
            self.slope = Point(value, residual, self.slope).beside(end).slope

    def next(self, value: float, residual: float) -> float:
        if residual == 0.0:
            return value
        if not math.isfinite(residual):
            return value if self._point is None else 0.5 * (value + self._point.value)
        if self._point is None:
            self._point = Point(value, residual, self.slope)
            return self._unbounded(self._point)
        new, old = Point(value, residual, self.slope), self._point
        if self._other is not None:
            return self._enclosed(new, old, self._other)
        if old.residual * residual < 0.0:
            self._other = new
            return self._between(new, old)
        new = new.beside(old)
        if abs(residual) > _WORSE * abs(old.residual):
            return old.value + _BACK * (value - old.value)
        self._point = new
        proposed = self._unbounded(new)
        if self.slope is None:
            return proposed
        longest = _FARTHER * abs(new.value - old.value)  # on a plateau the secant knows nothing of the kink
        return min(max(proposed, new.value - longest), new.value + longest)

    def _unbounded(self, point: Point) -> float:
        if point.slope is None:
            return point.value + math.copysign(self._probe(point), point.residual)
        slope = point.slope or -_FLATTEST
        slope = math.copysign(max(abs(slope), _FLATTEST), slope)
        return point.value - point.residual / slope

    def _enclosed(self, new: Point, end: Point, other: Point) -> float:
        if new.residual * end.residual < 0.0:
            end, other = other, end
        self._slow += abs(new.residual) > _GAIN * abs(end.residual)
        self._point, self._other = new.beside(end), other
        if self._slow > 1:
            self._slow = 0
            return 0.5 * (new.value + other.value)
        return self._between(self._point, other)

    def _between(self, end: Point, other: Point) -> float:
        """Return a value between the ends: by the slope at one of them or of the secant, or a probe, or the middle."""
        best, worst = sorted((end, other), key=lambda point: abs(point.residual))
        low, high = sorted((end.value, other.value))
        for root in (best.root(), worst.root()):
            if low < root < high:
                return root
        if best.slope is None:
            return self._within(best.beside(worst).root(), low, high)
        if worst.slope is None:
            self._slow = -1  # a probe is not meant to gain
            inwards = math.copysign(self._probe(worst), best.value - worst.value)
            return self._within(worst.value + inwards, low, high)
        return 0.5 * (low + high)

    def _probe(self, point: Point) -> float:
        return probing(abs(point.residual) / self._scale) * self._scale

    @staticmethod
    def _within(value: float, low: float, high: float) -> float:
        """Return the value, or the middle if it is not between the ends."""
        return value if low < value < high else 0.5 * (low + high)
