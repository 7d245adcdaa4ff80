"""The picture of a run with fields: pads of tribofilm, wear tracks, the contact, and profiles across the tracks."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from contact_core.kernels.arrays import Array

from ..charts.chart import COLOURS, GREY, Chart, Line, Map, Sheet, shades
from ..charts.units import time_unit, unit_for
from .maps import ALONG, TIME
from .panels import TRIBOFILM, Panel, chart

_COLUMNS, _WIDTH, _CURVES = 4, 3.8, 3.1  # width of a panel, height of a row of curves [in]
_FADES = ("Blues", "Oranges")  # early to late, in profiles
_FAINT = 0.35  # of these, where the earliest begins
_PEAKS, _FAR = 99.8, 80.0  # percentiles that end the colours: of single peaks, of the gap far from the contact
_DECADE = 10.0  # least range of logarithmic colours
_SLENDER = 2.5  # a map whose sides differ by more fills its panel
_FEW = 6  # curves that a key names one by one
_COVERAGE = Panel(
    "Coverage of the track", ("coverage_1", "coverage_2"), ("body 1", "body 2"), "coverage", "", share=True
)
KINDS = {"tribofilm": ("Tribofilm", "thickness"), "wear": ("Wear", "depth"), "plastic": ("Plastic depth", "depth")}


def picture(dataset: xr.Dataset, maps: xr.Dataset) -> Sheet:
    """Return maps of the tribofilm at up to four times, maps of the end, profiles across the tracks and courses."""
    charts: list[Chart | None] = list(_maps(maps))
    rows = -(-len(charts) // _COLUMNS)
    charts += [None] * (rows * _COLUMNS - len(charts))
    ratio = float(np.ptp(maps["y"].values) / np.ptp(maps["x"].values))
    high = 0.75 + (_WIDTH - 0.8) * (ratio if 1.0 / _SLENDER < ratio < _SLENDER else 1.0)
    if len(maps["y"]) > 1:
        charts += [profile(maps, kind, body) for kind in ("tribofilm", "wear") for body in (1, 2)]
    charts += [_course(dataset, maps, panel) for panel in (_COVERAGE, TRIBOFILM)]
    charts += [cross_section(maps, body) for body in (1, 2)] if len(maps["y"]) > 1 else []
    heights = [high] * rows + [_CURVES] * (-(-len(charts) // _COLUMNS) - rows)
    return Sheet(charts, dataset.attrs.get("title", ""), _COLUMNS, _WIDTH, heights=heights)


def _maps(maps: xr.Dataset) -> Iterator[Chart | None]:
    """Yield the tribofilm of each body on one scale, and what else there is at the end."""
    shown = _chosen(maps[TIME].values)
    for body in (1, 2):
        films = maps[f"tribofilm_map_{body}"].values[shown]
        for k, film in zip(shown, films, strict=True):
            title = f"tribofilm of body {body}, {_time(maps, k)}"
            yield _map(maps, title, film, "viridis", every=films, keyed=k == shown[-1])
        yield from [None] * (len(shown) == _COLUMNS - 1)
    last, end = maps.isel({TIME: -1}), _time(maps, -1)
    what = "wear and pits" if "pits_map_1" in maps else "wear"
    for body in (1, 2):
        yield _map(maps, f"{what} of body {body}, {end}", _worn(last, body), "magma")
    yield _map(maps, f"pressure, {end}", last["pressure"].values, "inferno", body=False)
    if len(shown) == 1:
        solid = last["solid_pressure"].values
        yield _map(maps, f"pressure of the solids, {end}", solid, "inferno", body=False)
    yield _map(maps, f"gap, {end}", last["gap"].values, "cividis", body=False)
    if len(shown) == 1:
        yield _map(maps, f"plastic depth of body 2, {end}", last["plastic_map_2"].values, "magma")


def _chosen(times: Array) -> list[int]:
    """Return up to four of the times, evenly spread to the last; not the start, where nothing has grown."""
    later = [k for k, time in enumerate(times) if time > 0.0] or [len(times) - 1]
    return [later[round(k)] for k in np.linspace(0, len(later) - 1, min(_COLUMNS, len(later)))]


def _time(maps: xr.Dataset, k: int) -> str:
    clock = time_unit(float(maps[TIME].values[-1]))
    return f"{float(clock.of(maps[TIME].values[k])):.3g} {clock.name}"


def _worn(maps: xr.Dataset, body: int) -> Array:
    """Return the map of what is worn off a body or has broken out of it [m]."""
    kept = [f"{kind}_map_{body}" for kind in ("wear", "pits") if f"{kind}_map_{body}" in maps]
    return np.asarray(sum(np.asarray(maps[name].values, dtype=float) for name in kept))


def _map(
    maps: xr.Dataset,
    title: str,
    values: Array,
    colours: str,
    *,
    every: Any = None,
    keyed: bool = True,
    body: bool = True,
) -> Chart:
    """Return a map of a body or of the contact, or its curve if it has one row; `every`: all that share its colours."""
    x, y = maps[ALONG if body else "x"].values, maps["y"].values
    logarithmic = colours == "cividis"
    told = np.nanmin(values) if logarithmic else values if every is None else every
    unit = unit_for("Pa" if colours == "inferno" else "m", told)
    length = unit_for("m", [np.ptp(x), np.ptp(y)])
    shown, name = unit.of(values), f"x {length.label}"
    if len(y) == 1:
        line = Line("", length.of(x), shown[0], colour="#333333")
        return Chart(title, name, unit.label, [line], logarithmic=logarithmic)
    half = 0.5 * (x[1] - x[0])
    edges = [(float(length.of(each[0] - half)), float(length.of(each[-1] + half))) for each in (x, y)]
    a, b = (float(length.of(maps[f"half_width_{axis}"])) for axis in "xy")
    inside = b < float(length.of(y.max()))
    ends = _ends(shown if every is None else unit.of(every), logarithmic, every is None)
    ring = (a, b) if inside and not body else None
    drawn = Map(shown, edges[0], edges[1], unit.name, colours, *ends, logarithmic, keyed, ring)
    return Chart(title, name, f"y {length.label}", map=drawn, levels=(-b, b) if inside and body else ())


def _ends(values: Array, logarithmic: bool, peaks: bool) -> tuple[float, float]:
    """Return the range of the colours of values: a few peaks may be beyond it."""
    finite = values[np.isfinite(values)]
    if not finite.size:
        return 0.1, 1.0
    if logarithmic:
        least = float(finite.min())
        return least, max(float(np.percentile(finite, _FAR)), _DECADE * least)
    top = float(np.percentile(finite, _PEAKS)) if peaks else 0.0
    return 0.0, top or float(finite.max()) or 1.0


def profile(maps: xr.Dataset, kind: str, body: int) -> Chart:
    """Return the chart of a profile of one body across the track at all times, from faint to dark."""
    title, what = KINDS[kind]
    profiles = np.asarray(maps[f"{kind}_profile_{body}"].values, dtype=float)
    unit, there = unit_for("m", profiles), [k for k, values in enumerate(profiles) if values.any()]
    named = {there[round(k)] for k in np.linspace(0, len(there) - 1, min(len(there), _FEW))}
    y, label, edges = _across(maps)
    lines = [
        Line(_time(maps, k) if k in named else "", y, unit.of(profiles[k]), colour=colour)
        for k, colour in zip(there, shades(len(there), _FADES[body - 1], _FAINT, 1.0), strict=True)
    ]
    down = kind != "tribofilm"
    return Chart(f"{title}, body {body}", label, f"mean {what} {unit.label}", lines, shaded=edges, downward=down)


def cross_section(maps: xr.Dataset, body: int) -> Chart:
    """Return the chart of a body's surface along a line across the track: as new and as it is at the end."""
    last, middle = maps.isel({TIME: -1}), maps.sizes[ALONG] // 2
    new, pressed, film = (
        np.asarray(last[f"{name}_{body}"].values, dtype=float)[:, middle]
        for name in ("new_heights", "plastic_map", "tribofilm_map")
    )
    solid = new - _worn(last, body)[:, middle] - pressed
    y, label, edges = _across(maps)
    unit = unit_for("m", np.concatenate([new, solid + film]))
    lines = [
        Line("tribofilm", y, unit.of(solid + film), place=2, below=unit.of(solid), faint=0.4),
        Line("as new", y, unit.of(new), colour=GREY),
        Line(f"solid, {_time(maps, -1)}", y, unit.of(solid), colour=COLOURS[body - 1]),
    ]
    title = f"Cross-section of body {body}"
    return Chart(title, label, f"height {unit.label}", lines, shaded=edges, from_zero=False)


def _across(maps: xr.Dataset) -> tuple[Array, str, tuple[tuple[float, float], ...]]:
    """Return y in the unit people read, its label, and the track if it ends within the grid."""
    y, half = np.asarray(maps["y"].values, dtype=float), float(maps["half_width_y"])
    unit = unit_for("m", [np.ptp(y)])
    edge = float(unit.of(half))
    return unit.of(y), f"y {unit.label}", ((-edge, edge),) if half < y.max() else ()


def _course(dataset: xr.Dataset, maps: xr.Dataset, panel: Panel) -> Chart:
    """Return an output of both bodies against time; the times of the maps are marked."""
    drawn = chart(dataset, panel, panel.quantities)
    rows = np.searchsorted(dataset["time"].values, maps[TIME].values)
    marks = [replace(line, label="", x=line.x[rows], y=line.y[rows], half=None, style="o") for line in drawn.lines]
    return replace(drawn, lines=[*drawn.lines, *marks])
