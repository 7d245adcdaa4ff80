"""Interface quasi-Newton iteration for v = G(v), v [size], where G is expensive and its derivatives are unknown.

The residual r = G(v) - v is modelled as linear along the differences between the points of a communication step, and
along those of accepted steps where these say something new; outside of them the step is relaxed. One value alone is
left to the secant method, and so is the line between two points with opposite residuals.

Sources: Degroote, Bathe & Vierendeels, Comput. Struct. 87 (2009) 793, doi:10.1016/j.compstruc.2008.11.013 (IQN-ILS).
"""

import math
from typing import NamedTuple

import numpy as np

from .arrays import Array
from .secant import Secant, probing

Differences = tuple[Array, Array]  # of v and of r [count, size] each

_KEPT = 20  # differences at most, of accepted steps
_DEPENDENT = 1e-4  # a difference is left out if a smaller part of it is independent of those before
_CERTAIN = 0.1  # part of the residual outside of all differences, below which the model counts as complete
_OPPOSITE = -0.7  # cosine between residuals of two points that enclose a solution
_GAIN = 0.5  # decrease of the residual that makes it needless to search between them
_FOUND = 0.1  # decrease of the residual at which the search on a line ends
_ALONG = 0.5  # part of the residual that must be along the first one for the search to continue


class _Point(NamedTuple):
    x: Array  # v over the allowed errors
    residual: Array  # over them, too
    norm: float  # of the residual, Euclidean


class _Line:
    """Search between two points with opposite residuals, by the part of the residual along that at the first."""

    def __init__(self, first: _Point, second: _Point) -> None:
        self._first, self._run = first, second.x - first.x
        self._root = Secant()
        self._root.start(1.0 / first.norm)
        self._root.next(0.0, 1.0)

    def goes_on(self, point: _Point) -> bool:
        along = abs(self._along(point)) * self._first.norm
        return point.norm > _FOUND * self._first.norm and along > _ALONG * point.norm

    def next(self, point: _Point) -> Array:
        part = self._run.dot(point.x - self._first.x) / self._run.dot(self._run)
        return self._first.x + self._root.next(float(part), self._along(point)) * self._run

    def _along(self, point: _Point) -> float:
        return float(point.residual.dot(self._first.residual)) / self._first.norm**2


class QuasiNewton:
    """The iteration; the differences of accepted steps are kept, and in one dimension the slope of the residual."""

    def __init__(self) -> None:
        self._secant = Secant()
        self._past: Differences | None = None  # newest step first

    def start(self, scale: Array) -> None:
        """Begin a communication step with the errors that are allowed."""
        self._scale = scale
        self._points: list[_Point] = []
        self._line: _Line | None = None
        self._certain = False
        if scale.size == 1:
            self._secant.start(float(scale[0]))
        none = np.empty((0, scale.size))
        self._known = (self._past[0] / scale, self._past[1] / scale) if self._past else (none, none)

    def next(self, v: Array, g: Array) -> Array:
        """Return the next values to try, after g = G(v) has been evaluated."""
        if v.size == 1:
            return np.array([self._secant.next(float(v[0]), float(g[0] - v[0]))])
        x, residual = v / self._scale, (g - v) / self._scale
        point = _Point(x, residual, math.sqrt(residual.dot(residual)))
        if point.norm == 0.0:
            return v.copy()
        if not math.isfinite(point.norm):
            return 0.5 * (v + self._points[-1].x * self._scale) if self._points else v.copy()
        line = self._enclosing(point)
        x = x + self._step(point) if line is None else line.next(point)
        self._points.append(point)
        return x * self._scale

    def accept(self, v: Array, g: Array) -> None:
        """Keep the differences of this step, to the solution."""
        if v.size == 1:
            self._secant.accept(float(v[0]), float(g[0] - v[0]))
        elif self._points:
            solution = _Point(v / self._scale, (g - v) / self._scale, 0.0)
            runs, rises = self._differences(solution)
            self._past = runs[:_KEPT] * self._scale, rises[:_KEPT] * self._scale

    def clear(self) -> None:
        """Forget all steps, as after an event."""
        self.restore((None, None))

    def copy(self) -> tuple[float | None, Differences | None]:
        """Return the memory for `restore`."""
        return self._secant.slope, self._past

    def restore(self, memory: tuple[float | None, Differences | None]) -> None:
        """Go back to a memory that `copy` has returned."""
        self._secant.slope, self._past = memory

    def _enclosing(self, point: _Point) -> _Line | None:
        """Return the line between two points on which the solution is sought, if it is."""
        if self._line is not None:
            self._line = self._line if self._line.goes_on(point) else None
        elif self._certain:
            last = self._points[-1]
            cosine = point.residual.dot(last.residual) / (point.norm * last.norm)
            moved = (point.x != last.x).any()
            if moved and cosine < _OPPOSITE and point.norm > _GAIN * last.norm:
                self._line = _Line(last, point)
        return self._line

    def _differences(self, point: _Point) -> Differences:
        """Return differences from a point to those of this step, the nearest first, then the kept ones."""
        if not self._points:
            return self._known
        runs = np.array([other.x for other in self._points]) - point.x
        rises = np.array([other.residual for other in self._points]) - point.residual
        order = np.argsort((runs * runs).sum(axis=1), kind="stable")
        return np.concatenate((runs[order], self._known[0])), np.concatenate((rises[order], self._known[1]))

    def _step(self, point: _Point) -> Array:
        runs, rises = self._differences(point)
        if not len(runs):
            size = point.norm / math.sqrt(point.x.size)
            return point.residual * (probing(size) / size)
        step, outside = multi_secant(runs, rises, point.residual)
        self._certain = outside.dot(outside) < (_CERTAIN * point.norm) ** 2
        run, rise = runs[0].dot(runs[0]), rises[0].dot(rises[0])
        return step + (math.sqrt(run / rise) if run < rise else 1.0) * outside


def multi_secant(runs: Array, rises: Array, residual: Array) -> Differences:
    """Return the step that cancels as much of a residual [size] as differences can, and the residual that is left.

    `rises` [count, size] are the changes of the residual along `runs` [count, size]. Gram-Schmidt takes them in their
    order and leaves out dependent ones. Every entry counts by its largest change, so that the choice of
    units does not matter.
    """
    unit = np.abs(rises).max(axis=0)
    unit[unit == 0.0] = 1.0
    left, total, count = residual / unit, np.zeros(residual.size), 0
    basis = np.empty((min(rises.shape), residual.size))
    steps = np.empty_like(basis)
    for run, rise in zip(runs, rises / unit, strict=True):
        along = basis[:count].dot(rise)
        new = rise - along.dot(basis[:count])
        size = math.sqrt(new.dot(new))
        if size <= _DEPENDENT * math.sqrt(rise.dot(rise)):
            continue
        basis[count] = new / size
        steps[count] = (run - along.dot(steps[:count])) / size
        part = basis[count].dot(left)
        left -= part * basis[count]
        total -= part * steps[count]
        count += 1
        if count == len(basis):
            break
    return total, left * unit
