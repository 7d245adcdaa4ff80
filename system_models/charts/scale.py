"""The ranges of a chart's axes, and the numbers along them."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from contact_core.kernels.arrays import Array

from .chart import Chart, Line

_TICKS = 5
_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
_ROOM = 0.06  # above and below lines
_MARGIN = 0.02  # beside marks
_FLAT = 1e-3  # of the largest value: a smaller range is drawn as a flat line
_SMALL = 9e-4  # numbers below have an exponent, which is shorter
_SPIKE, _CUT = 4.0, 1.3  # times what lines stay below: where the axis is cut, and at which value
_MOST_OF_X, _FEW = 0.99, 30  # of its length that a line stays below that, points that can tell
_TALL = 12.0  # times the range of the lines: bands that are taller run out of the chart


class Scale(NamedTuple):
    """The ranges of the axes."""

    x0: float
    x1: float
    y0: float
    y1: float


def scale_of(chart: Chart, right: bool = False) -> Scale:
    """Return the ranges of a chart's axes, with those of the values that are read on its right."""
    lines = [line for line in chart.lines if line.right == right and len(line.x)]
    y0, y1 = _upward(replace(chart, logarithmic=False), lines) if right else chart.y_range or _upward(chart, lines)
    x0, x1 = chart.x_range or _across(chart, [line for line in chart.lines if len(line.x)])
    return Scale(x0, x1 if x1 > x0 else x0 + 1.0, y0, y1 if y1 > y0 else y0 + 1.0)


def _across(chart: Chart, lines: Sequence[Line]) -> tuple[float, float]:
    xs = np.concatenate([np.array([*chart.places.values()]), *(line.x for line in lines)])
    xs = finite(xs, chart.logarithmic_x)
    x0, x1 = (float(xs.min()), float(xs.max())) if xs.size else (1.0, 10.0)
    if x0 == x1:
        return x0 - 0.5 * abs(x0), x1 + 0.5 * abs(x1)
    margin = _MARGIN if any(line.mark for line in lines) else 0.0
    if chart.logarithmic_x:
        beside = (x1 / x0) ** margin
        return x0 / beside, x1 * beside
    return x0 - margin * (x1 - x0), x1 + margin * (x1 - x0)


def _upward(chart: Chart, lines: Sequence[Line]) -> tuple[float, float]:
    log = chart.logarithmic
    ys = finite(np.concatenate([each for line in lines for each in _edges(line)] or [np.empty(0)]), log)
    low, high = (float(ys.min()), _highest(lines, float(ys.max()))) if ys.size else (0.1 * log, 1.0)
    if not log:
        low, high = _with_bands(lines, low, high, chart.most)
    if chart.from_zero and low >= 0.0 and not log:
        low = 0.0
    span = high - low
    if span <= _FLAT * max(abs(low), abs(high)) and not log:
        span = 0.2 * max(abs(high), abs(low)) or 1.0
        low, high = (low - span if low else 0.0), high + span
    room = 0.0 if log else _ROOM * span
    y0 = low if chart.from_zero and low == 0.0 else low - room
    return (low / 1.2 if log and any(line.mark for line in lines) else y0), high * 1.2 if log else high + room


def _edges(line: Line) -> list[Array]:
    return [line.y] if line.below is None else [line.y, line.below]


def _highest(lines: Sequence[Line], largest: float) -> float:
    """Return the end of the axis: the largest value, or less where for a short stretch of x values are far above."""
    usual = max(_usual(line) for line in lines)
    return _CUT * usual if 0.0 < _SPIKE * usual < largest else largest


def _usual(line: Line) -> float:
    """Return the value that a line stays below for most of its length."""
    known = np.isfinite(line.y) & np.isfinite(line.x)
    if np.count_nonzero(known) < _FEW or not line.dash:
        return math.inf
    y, share = line.y[known], np.gradient(line.x[known])
    order = np.argsort(y)
    reached = np.cumsum(share[order])
    return float(y[order][min(int(np.searchsorted(reached, _MOST_OF_X * reached[-1])), len(y) - 1)])


def finite(values: Array, positive: bool = False) -> Array:
    """Return the values that are numbers, or those above zero."""
    found = values[np.isfinite(values)]
    return found[found > 0.0] if positive else found


def _with_bands(lines: Sequence[Line], low: float, high: float, end: float | None) -> tuple[float, float]:
    """Return the range of lines with their bands, as far as these are not far taller, or up to an end of values."""
    most = _TALL * max(high - low, 0.1 * max(abs(low), abs(high)))
    for line in lines:
        if line.half is not None:
            shown = line.y <= high
            bottom, top = (finite((line.y + sign * line.half)[shown]) for sign in (-1.0, 1.0))
            low = min(low, max(float(bottom.min(initial=low)), low - most, 0.0 if low >= 0.0 else -math.inf))
            high = max(high, min(float(top.max(initial=high)), high + most if end is None else end))
    return low, high


def cut_off(chart: Chart, scale: Scale) -> str:
    """Return a word on values above the end of the axis; nothing if there are none, or the chart has its own range."""
    largest = max((float(finite(line.y).max(initial=-math.inf)) for line in chart.lines if not line.right), default=0.0)
    if chart.y_range or largest <= scale.y1:
        return ""
    return f"values up to {number(float(f'{largest:.3g}'))} are cut off"


def ticks(low: float, high: float) -> list[float]:
    """Return about five round numbers from low to high."""
    rough = (high - low) / _TICKS
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(factor * power for factor in _STEPS if factor * power >= rough * (1.0 - 1e-9))
    first = math.ceil(low / step - 1e-9)
    return [step * k for k in range(first, math.floor(high / step + 1e-9) + 1)]


def decades(low: float, high: float) -> list[float]:
    """Return the powers of ten from low to high; over few of them with their double and fivefold."""
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    many = last - first > 3
    found = [m * 10.0**k for k in range(first, last + 1) for m in ((1.0,) if many else (1.0, 2.0, 5.0))]
    return [value for value in found if low <= value <= high]


def number(value: float) -> str:
    """Return a number along an axis."""
    small = 0.0 < abs(value) < _SMALL
    return (f"{value:.2g}" if small else f"{value:.5g}").replace("e-0", "e-").replace("-", "−")
