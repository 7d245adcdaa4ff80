"""A chart as SVG within a page, with its points for the pointer. Maps and polar charts are drawn by `files` alone."""

import json
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from importlib.resources import files

import numpy as np

from contact_core.kernels.arrays import Array
from fmu_src.html.markup import text

from .chart import DASHES, INDEXED, Chart, Line, Spans
from .scale import Scale, cut_off, decades, number, scale_of, ticks

_WIDTH, _HEIGHT = 460.0, 250.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 62.0, 10.0, 10.0, 42.0
_POINTS = 300  # of a line, about: what a screen can show


def figure(chart: Chart, key: str) -> str:
    """Return the chart as a figure; `key` is a name of its own on the page."""
    lines = [_thinned(line) for line in chart.lines]
    box = _Box(chart, scale_of(chart))
    parts = [*_grid(box), *_shades(box, chart.shaded), *_shades(box, chart.dark), *_thin(box), *_cut(box)]
    parts += [part for line in lines for part in _band(box, line)]
    parts += [part for line in lines for part in (*_curve(box, line), *_marks(box, line))]
    caption = f"<figcaption>{text(chart.caption)}</figcaption>" if chart.caption else ""
    label = text(f"{chart.title}: {chart.y_label} against {chart.x_label}")
    return (
        f'<figure class="chart"><h4>{text(chart.title)}</h4>{_legend(chart)}'
        f'<svg viewBox="0 0 {_WIDTH:g} {_HEIGHT:g}" role="img" aria-label="{label}" data-chart="{text(key)}">'
        f"{''.join(parts)}</svg>{caption}"
        f'<script type="application/json" class="points" id="points-{text(key)}">{_data(chart, lines, box.scale)}'
        "</script></figure>"
    )


def figures(charts: Iterable[Chart], key: str) -> str:
    """Return charts beside each other; nothing for none."""
    drawn = "".join(figure(chart, f"{key}-{k}") for k, chart in enumerate(charts))
    return f'<div class="charts">{drawn}</div>' if drawn else ""


@dataclass(frozen=True)
class _Box:
    """Where values lie in the drawing of a chart."""

    chart: Chart
    scale: Scale

    def across(self, x: Array) -> Array:
        share = _share(x, self.scale.x0, self.scale.x1, self.chart.logarithmic_x)
        return np.asarray(_LEFT + share * (_WIDTH - _LEFT - _RIGHT))

    def up(self, y: Array) -> Array:
        """Return the places of values, kept within the drawing."""
        share = np.clip(_share(y, self.scale.y0, self.scale.y1, self.chart.logarithmic), 0.0, 1.0)
        return np.asarray(_TOP + (share if self.chart.downward else 1.0 - share) * (_HEIGHT - _TOP - _BOTTOM))


def _share(values: Array, low: float, high: float, logarithmic: bool) -> Array:
    if logarithmic:
        return np.asarray(np.log(np.maximum(values, low) / low) / math.log(high / low))
    return np.asarray((values - low) / (high - low))


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
    half, below = (None if each is None else each[index] for each in (line.half, line.below))
    return replace(line, x=line.x[index], y=line.y[index], half=half, below=below)


def _grid(box: _Box) -> Iterator[str]:
    chart, (x0, x1, y0, y1) = box.chart, box.scale
    bottom, right = _HEIGHT - _BOTTOM, _WIDTH - _RIGHT
    marks = decades(y0, y1) if chart.logarithmic else ticks(y0, y1)
    for value, y in zip(marks, box.up(np.array(marks)), strict=True):
        yield f'<line class="grid" x1="{_LEFT}" x2="{right}" y1="{y:.1f}" y2="{y:.1f}"/>'
        yield f'<text class="end" x="{_LEFT - 6}" y="{y + 4:.1f}">{number(value)}</text>'
    across = decades(x0, x1) if chart.logarithmic_x else ticks(x0, x1)
    for value, x in zip(across, box.across(np.array(across)), strict=True):
        yield f'<line class="grid" x1="{x:.1f}" x2="{x:.1f}" y1="{_TOP}" y2="{bottom}"/>'
        yield f'<text class="middle" x="{x:.1f}" y="{bottom + 16}">{number(value)}</text>'
    middle = 0.5 * (_TOP + bottom)
    yield f'<line class="axis" x1="{_LEFT}" x2="{right}" y1="{bottom}" y2="{bottom}"/>'
    yield f'<line class="axis" x1="{_LEFT}" x2="{_LEFT}" y1="{_TOP}" y2="{bottom}"/>'
    yield f'<text class="middle" x="{0.5 * (_LEFT + right):g}" y="{_HEIGHT - 6:g}">{_index(chart.x_label)}</text>'
    yield f'<text class="middle" transform="translate(13 {middle:g}) rotate(-90)">{_index(chart.y_label)}</text>'


def _index(words: str) -> str:
    """Return a label with what follows the underscore of a symbol as an index."""
    return INDEXED.sub(r'\1<tspan dy="4" font-size="9">\2</tspan><tspan dy="-4">&#8203;</tspan>', text(words))


def _cut(box: _Box) -> list[str]:
    words = cut_off(box.chart, box.scale)
    return [f'<text class="end cut" x="{_WIDTH - _RIGHT - 4:g}" y="{_TOP + 12:g}">{words}</text>'] if words else []


def _shades(box: _Box, spans: Spans) -> Iterator[str]:
    for begin, end in spans:
        left, right = box.across(np.array([begin, end]))
        width, high = max(right - left, 1.0), _HEIGHT - _BOTTOM - _TOP
        yield f'<rect class="shade" x="{left:.1f}" y="{_TOP}" width="{width:.1f}" height="{high}"/>'


def _thin(box: _Box) -> Iterator[str]:
    for y in box.up(np.array(box.chart.levels)):
        yield f'<path class="axis" stroke-dasharray="4 3" d="M{_LEFT} {y:.1f}H{_WIDTH - _RIGHT}"/>'


def _band(box: _Box, line: Line) -> Iterator[str]:
    if line.below is None and (line.half is None or not line.dash or not np.any(line.half > 0.0)):
        return
    half = np.zeros(0) if line.half is None else np.where(np.isfinite(line.half), line.half, 1e300)
    edges = (line.y, line.below) if line.below is not None else (line.y + half, line.y - half)
    usable = np.isfinite(line.y)
    x, upper, lower = box.across(line.x[usable]), box.up(edges[0][usable]), box.up(edges[1][usable])
    there, back = zip(x, upper, strict=True), zip(x[::-1], lower[::-1], strict=True)
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in (*there, *back))
    yield f'<polygon class="band" fill="{line.ink}" points="{points}"/>'


def _curve(box: _Box, line: Line) -> Iterator[str]:
    if not line.dash or line.below is not None:
        return
    path, pen = [], "M"
    for a, b, drawn in zip(box.across(line.x), box.up(line.y), np.isfinite(line.y + line.x), strict=True):
        if drawn:
            path.append(f"{pen}{a:.1f} {b:.1f}")
        pen = "L" if drawn else "M"
    yield f'<path class="curve" stroke="{line.ink}" stroke-dasharray="{_dash(line)}" d="{"".join(path)}"/>'


def _marks(box: _Box, line: Line) -> Iterator[str]:
    """Yield the marks of a line, and the bars of their errors where there is no line."""
    if not line.mark:
        return
    known = np.isfinite(line.y)
    half = np.zeros(len(line.y)) if line.half is None or line.dash else line.half
    places = zip(*(each[known] for each in (line.x, line.y, half)), strict=True)
    for x, y, beside in places:
        at, (low, middle, high) = box.across(np.array([x]))[0], box.up(np.array([y - beside, y, y + beside]))
        if beside:
            yield f'<path stroke="{line.ink}" d="M{at:.1f} {low:.1f}V{high:.1f}"/>'
        fill = "#fff" if line.hollow else line.ink
        yield f'<circle cx="{at:.1f}" cy="{middle:.1f}" r="2.4" fill="{fill}" stroke="{line.ink}"/>'


def _dash(line: Line) -> str:
    return {"--": "7 3", ":": "2 3"}.get(line.dash, "" if line.colour else DASHES[line.place % len(DASHES)])


def _legend(chart: Chart) -> str:
    items = "".join(
        f'<li><svg viewBox="0 0 30 8" aria-hidden="true">{_sample(line)}</svg>{text(line.label)}</li>'
        for line in chart.keyed
    )
    return f'<ul class="legend">{items}</ul>' if items else ""


def _sample(line: Line) -> str:
    if not line.dash:
        return f'<circle cx="15" cy="4" r="3" fill="{line.ink}"/>'
    return f'<path d="M0 4H30" stroke="{line.ink}" stroke-dasharray="{_dash(line)}"/>'


def _data(chart: Chart, lines: Sequence[Line], scale: Scale) -> str:
    """Return the points as JSON, with the box in which they are drawn."""
    found = {
        "x": chart.x_label,
        "y": chart.y_label,
        "range": [scale.x0, scale.x1],
        "log": chart.logarithmic_x,
        "box": [_LEFT, _TOP, _WIDTH - _RIGHT, _HEIGHT - _BOTTOM],
        "lines": [
            {
                "label": line.label,
                "colour": line.ink,
                "x": _rounded(line.x),
                "y": _rounded(line.y),
                "half": None if line.half is None else _rounded(line.half),
            }
            for line in lines
        ],
    }
    return safe_json(found)


def script() -> str:
    """Return the script of a page that shows values under the pointer, and draws maps."""
    return files(__package__).joinpath("viewer.js").read_text("utf-8")


def safe_json(value: object) -> str:
    """Return JSON that a script element can hold."""
    return json.dumps(value, separators=(",", ":")).replace("<", "\\u003c")


def _rounded(values: Array) -> list[float | None]:
    return [float(f"{value:.5g}") if math.isfinite(value) else None for value in values]
