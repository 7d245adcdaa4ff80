"""Lines against a common axis with their error bands, as SVG; the points are in the page too, for the pointer."""

import json
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .markup import text

Array = NDArray[np.float64]

# of Okabe and Ito, which the colour-blind can tell apart; dashes tell lines apart without colours
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#E69F00", "#56B4E9")
DASHES = ("", "7 3", "2 3", "9 3 2 3", "12 4", "4 4", "1 2")

_WIDTH, _HEIGHT = 460.0, 250.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 62.0, 10.0, 10.0, 42.0
_POINTS = 300  # of a line, about: what a screen can show
_TICKS = 5
_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
_ROOM = 0.06  # above and below lines
_FLAT = 1e-3  # of the largest value: a smaller range is drawn as a flat line
_SMALL = 9e-4  # numbers below have an exponent, which is shorter
_SPIKE, _CUT = 4.0, 1.3  # times what lines stay below: where the axis is cut, and at which value
_MOST_OF_X, _FEW = 0.99, 30  # of its length that a line stays below that, points that can tell
_TALL = 12.0  # times the range of the lines: bands that are taller run out of the chart


@dataclass(frozen=True)
class Line:
    """A line, in the unit of its chart."""

    label: str
    x: Array
    y: Array
    half: Array | None = None  # half width of the error band
    place: int = 0  # in COLOURS and DASHES


@dataclass(frozen=True)
class Chart:
    """A chart: its title, axes and lines."""

    title: str
    x_label: str
    y_label: str
    lines: Sequence[Line]
    caption: str = ""
    shaded: Sequence[tuple[float, float]] = ()  # spans of x that are marked
    logarithmic: bool = False
    from_zero: bool = True  # the axis begins at zero if no value is below
    downward: bool = False  # the axis of y runs down, as depths do
    most: float | None = None  # that a value can be: bands are shown up to there, however tall


def figure(chart: Chart, key: str) -> str:
    """Return the chart as a figure; `key` is a name of its own on the page."""
    lines = [_thinned(line) for line in chart.lines]
    scale = _Scale.of(chart, lines)
    parts = [*_grid(scale, chart), *_shades(scale, chart), *_cut(scale, lines)]
    for line in lines:
        parts += _band(scale, line)
    for line in lines:
        parts += _curve(scale, line)
    legend = _legend(lines) if len(lines) > 1 else ""
    caption = f"<figcaption>{text(chart.caption)}</figcaption>" if chart.caption else ""
    label = text(f"{chart.title}: {chart.y_label} against {chart.x_label}")
    return (
        f'<figure class="chart"><h4>{text(chart.title)}</h4>{legend}'
        f'<svg viewBox="0 0 {_WIDTH:g} {_HEIGHT:g}" role="img" aria-label="{label}" data-chart="{text(key)}">'
        f"{''.join(parts)}</svg>{caption}"
        f'<script type="application/json" class="points" id="points-{text(key)}">{_data(chart, lines, scale)}</script>'
        "</figure>"
    )


@dataclass(frozen=True)
class _Scale:
    """The ranges of a chart's axes and where they lie in the drawing."""

    x0: float
    x1: float
    y0: float
    y1: float
    logarithmic: bool
    downward: bool

    @staticmethod
    def of(chart: Chart, lines: Sequence[Line]) -> "_Scale":
        xs = np.concatenate([line.x for line in lines])
        x0, x1 = float(xs.min()), float(xs.max())
        ys = _finite(np.concatenate([line.y for line in lines]), chart.logarithmic)
        low, high = (float(ys.min()), _highest(lines, float(ys.max()))) if ys.size else (0.0, 1.0)
        if not chart.logarithmic:
            low, high = _with_bands(lines, low, high, chart.most)
        if chart.from_zero and low >= 0.0 and not chart.logarithmic:
            low = 0.0
        span = high - low
        if span <= _FLAT * max(abs(low), abs(high)) and not chart.logarithmic:
            span = 0.2 * max(abs(high), abs(low)) or 1.0
            low, high = (low - span if low else 0.0), high + span
        room = 0.0 if chart.logarithmic else _ROOM * span
        y0 = low if chart.from_zero and low == 0.0 else low - room
        y1 = high * 1.2 if chart.logarithmic else high + room
        return _Scale(
            x0, x1 if x1 > x0 else x0 + 1.0, y0, y1 if y1 > y0 else y0 + 1.0, chart.logarithmic, chart.downward
        )

    def across(self, x: Array) -> Array:
        return _LEFT + (x - self.x0) / (self.x1 - self.x0) * (_WIDTH - _LEFT - _RIGHT)

    def up(self, y: Array) -> Array:
        """Return the places of values, kept within the drawing."""
        if self.logarithmic:
            low, high = math.log(self.y0), math.log(self.y1)
            share = (np.log(np.maximum(y, self.y0)) - low) / (high - low)
        else:
            share = (y - self.y0) / (self.y1 - self.y0)
        share = np.clip(share, 0.0, 1.0)
        return np.asarray(_TOP + (share if self.downward else 1.0 - share) * (_HEIGHT - _TOP - _BOTTOM))


def _highest(lines: Sequence[Line], largest: float) -> float:
    """Return the end of the axis: the largest value, or less where for a short stretch of x values are far above."""
    usual = max(_usual(line) for line in lines)
    return _CUT * usual if 0.0 < _SPIKE * usual < largest else largest


def _usual(line: Line) -> float:
    """Return the value that a line stays below for most of its length."""
    known = np.isfinite(line.y)
    if np.count_nonzero(known) < _FEW:
        return math.inf
    y, share = line.y[known], np.gradient(line.x[known])
    order = np.argsort(y)
    reached = np.cumsum(share[order])
    return float(y[order][min(int(np.searchsorted(reached, _MOST_OF_X * reached[-1])), len(y) - 1)])


def _finite(values: Array, positive: bool) -> Array:
    found = values[np.isfinite(values)]
    return found[found > 0.0] if positive else found


def _with_bands(lines: Sequence[Line], low: float, high: float, end: float | None) -> tuple[float, float]:
    """Return the range of lines with their bands, as far as these are not far taller, or up to an end of values."""
    most = _TALL * max(high - low, 0.1 * max(abs(low), abs(high)))
    for line in lines:
        if line.half is not None:
            shown = line.y <= high
            bottom, top = (_finite((line.y + sign * line.half)[shown], False) for sign in (-1.0, 1.0))
            low = min(low, max(float(bottom.min(initial=low)), low - most, 0.0 if low >= 0.0 else -math.inf))
            high = max(high, min(float(top.max(initial=high)), high + most if end is None else end))
    return low, high


def _thinned(line: Line) -> Line:
    """Return the line by about `_POINTS` of its points: the least and the largest of each stretch."""
    if len(line.x) <= _POINTS:
        return line
    keep = {0, len(line.x) - 1}
    for part in np.array_split(np.arange(len(line.x)), _POINTS // 2):
        values = line.y[part]
        if np.isfinite(values).any():
            keep |= {int(part[np.nanargmin(values)]), int(part[np.nanargmax(values)])}
    index = np.array(sorted(keep))
    return Line(line.label, line.x[index], line.y[index], None if line.half is None else line.half[index], line.place)


def ticks(low: float, high: float) -> list[float]:
    """Return about five round numbers from low to high."""
    rough = (high - low) / _TICKS
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(factor * power for factor in _STEPS if factor * power >= rough * (1.0 - 1e-9))
    first = math.ceil(low / step - 1e-9)
    return [step * k for k in range(first, math.floor(high / step + 1e-9) + 1)]


def _decades(low: float, high: float) -> list[float]:
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    many = last - first > 3
    found = [m * 10.0**k for k in range(first, last + 1) for m in ((1.0,) if many else (1.0, 2.0, 5.0))]
    return [value for value in found if low <= value <= high]


def _grid(scale: _Scale, chart: Chart) -> list[str]:
    bottom, right = _HEIGHT - _BOTTOM, _WIDTH - _RIGHT
    parts = []
    marks = _decades(scale.y0, scale.y1) if scale.logarithmic else ticks(scale.y0, scale.y1)
    for value, y in zip(marks, scale.up(np.array(marks)), strict=True):
        parts.append(f'<line class="grid" x1="{_LEFT}" x2="{right}" y1="{y:.1f}" y2="{y:.1f}"/>')
        parts.append(f'<text class="end" x="{_LEFT - 6}" y="{y + 4:.1f}">{_number(value)}</text>')
    across = ticks(scale.x0, scale.x1)
    for value, x in zip(across, scale.across(np.array(across)), strict=True):
        parts.append(f'<line class="grid" x1="{x:.1f}" x2="{x:.1f}" y1="{_TOP}" y2="{bottom}"/>')
        parts.append(f'<text class="middle" x="{x:.1f}" y="{bottom + 16}">{_number(value)}</text>')
    middle = 0.5 * (_TOP + bottom)
    parts.append(f'<line class="axis" x1="{_LEFT}" x2="{right}" y1="{bottom}" y2="{bottom}"/>')
    parts.append(f'<line class="axis" x1="{_LEFT}" x2="{_LEFT}" y1="{_TOP}" y2="{bottom}"/>')
    parts.append(
        f'<text class="middle" x="{0.5 * (_LEFT + right):g}" y="{_HEIGHT - 6:g}">{_index(chart.x_label)}</text>'
    )
    parts.append(
        f'<text class="middle" transform="translate(13 {middle:g}) rotate(-90)">{_index(chart.y_label)}</text>'
    )
    return parts


def _index(words: str) -> str:
    """Return a label with what follows an underscore as an index."""
    return re.sub(r"_(\w+)", r'<tspan dy="4" font-size="9">\1</tspan><tspan dy="-4">&#8203;</tspan>', text(words))


def _cut(scale: _Scale, lines: Sequence[Line]) -> list[str]:
    """Return a word on values above the end of the axis."""
    largest = max(float(_finite(line.y, False).max(initial=-math.inf)) for line in lines)
    if largest <= scale.y1:
        return []
    words = f"values up to {_number(float(f'{largest:.3g}'))} are cut off"
    return [f'<text class="end cut" x="{_WIDTH - _RIGHT - 4:g}" y="{_TOP + 12:g}">{words}</text>']


def _number(value: float) -> str:
    small = 0.0 < abs(value) < _SMALL
    return (f"{value:.2g}" if small else f"{value:.5g}").replace("e-0", "e-").replace("-", "−")


def _shades(scale: _Scale, chart: Chart) -> list[str]:
    parts, bottom = [], _HEIGHT - _BOTTOM
    for begin, end in chart.shaded:
        left, right = scale.across(np.array([begin, end]))
        width = max(right - left, 1.0)
        parts.append(f'<rect class="shade" x="{left:.1f}" y="{_TOP}" width="{width:.1f}" height="{bottom - _TOP}"/>')
    return parts


def _band(scale: _Scale, line: Line) -> list[str]:
    if line.half is None or not np.any(line.half > 0.0):
        return []
    half = np.where(np.isfinite(line.half), line.half, 1e300)
    usable = np.isfinite(line.y)
    x, upper = scale.across(line.x[usable]), scale.up(line.y[usable] + half[usable])
    lower = scale.up(line.y[usable] - half[usable])
    there = zip(x, upper, strict=True)
    back = zip(x[::-1], lower[::-1], strict=True)
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in (*there, *back))
    return [f'<polygon class="band" fill="{_colour(line)}" points="{points}"/>']


def _curve(scale: _Scale, line: Line) -> list[str]:
    x, y = scale.across(line.x), scale.up(line.y)
    usable = np.isfinite(line.y)
    path, pen = [], "M"
    for a, b, drawn in zip(x, y, usable, strict=True):
        if drawn:
            path.append(f"{pen}{a:.1f} {b:.1f}")
        pen = "L" if drawn else "M"
    return [f'<path class="curve" stroke="{_colour(line)}" stroke-dasharray="{_dash(line)}" d="{"".join(path)}"/>']


def _colour(line: Line) -> str:
    return COLOURS[line.place % len(COLOURS)]


def _dash(line: Line) -> str:
    return DASHES[line.place % len(DASHES)]


def _legend(lines: Sequence[Line]) -> str:
    items = "".join(
        f'<li><svg viewBox="0 0 30 8" aria-hidden="true"><path d="M0 4H30" stroke="{_colour(line)}" '
        f'stroke-dasharray="{_dash(line)}"/></svg>{text(line.label)}</li>'
        for line in lines
    )
    return f'<ul class="legend">{items}</ul>'


def _data(chart: Chart, lines: Sequence[Line], scale: _Scale) -> str:
    """Return the points as JSON, with the box in which they are drawn."""
    found = {
        "x": chart.x_label,
        "y": chart.y_label,
        "range": [scale.x0, scale.x1],
        "box": [_LEFT, _TOP, _WIDTH - _RIGHT, _HEIGHT - _BOTTOM],
        "lines": [
            {
                "label": line.label,
                "colour": _colour(line),
                "x": _rounded(line.x),
                "y": _rounded(line.y),
                "half": None if line.half is None else _rounded(line.half),
            }
            for line in lines
        ],
    }
    return safe_json(found)


def safe_json(value: object) -> str:
    """Return JSON that a script element can hold."""
    return json.dumps(value, separators=(",", ":")).replace("<", "\\u003c")


def _rounded(values: Array) -> list[float | None]:
    return [float(f"{value:.5g}") if math.isfinite(value) else None for value in values]
