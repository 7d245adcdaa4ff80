"""The picture of a run with fields: pads of tribofilm, wear tracks, the contact, and profiles across the tracks."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from .maps import ALONG, TIME

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure
    from matplotlib.image import AxesImage

_COLUMNS = 4
_WIDTH, _CURVES = 14.0, 3.1  # of the picture, height of a row of curves [in]
_COLOURS = ("#0072B2", "#D55E00")  # of body 1 and 2, of Okabe and Ito: which the colour-blind can tell apart
_FADES = ("Blues", "Oranges")  # early to late, in profiles
_FAINT = 0.35  # of these, where the earliest begins
_PEAKS, _FAR = 99.8, 80.0  # percentiles that end the colours: of single peaks, of the gap far from the contact
_DECADE = 10.0  # least range of logarithmic colours
_MARKS = (1.0, 3.0)  # of each decade
_ROOM = 1.3  # above curves, for the legend
_SLENDER = 2.5  # a map whose sides differ by more fills its panel
_UNITS = ((300.0, 1.0, "s"), (5.0 * 3600.0, 60.0, "min"), (np.inf, 3600.0, "h"))  # of time: up to, in s, name
_LEGEND: dict[str, Any] = {
    "ncols": 3, "fontsize": "small", "handlelength": 1.0, "columnspacing": 1.0, "edgecolor": "none", "framealpha": 0.9
}  # fmt: skip
_FEW = 6  # curves that a legend names one by one


class _Map(NamedTuple):
    """A panel: what it shows, in which unit and colours."""

    title: str
    values: NDArray[Any]  # [y, x]
    along: NDArray[Any]  # [m]
    unit: str
    factor: float  # from SI
    colours: str
    scale: str = ""  # neighbours of the same name share their colours up to `top`; "": they do not
    top: float = 0.0  # in `unit`
    logarithmic: bool = False
    body: bool = True  # whether the edges of the track are drawn, else those of Hertz's contact


def write(dataset: xr.Dataset, maps: xr.Dataset, path: Path) -> Path:
    """Draw fields of a run, and its time series, into a PNG file and return its path."""
    picture(dataset, maps).savefig(path, dpi=140)
    return path


def picture(dataset: xr.Dataset, maps: xr.Dataset) -> "Figure":
    """Return maps of the tribofilm at up to four times, maps of the end, profiles across the tracks and courses."""
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    panels = _rows_of_maps(maps)
    across = len(maps["y"]) > 1
    heights = [*(_height(maps, row) for row in panels), *[_CURVES] * (2 if across else 1)]
    figure = Figure(figsize=(_WIDTH, sum(heights) + 0.4), layout=ConstrainedLayoutEngine(h_pad=0.1))
    parts = np.atleast_1d(np.asarray(figure.subfigures(len(heights), 1, height_ratios=heights)))
    places = [part.subplots(1, _COLUMNS) for part in parts]
    for axes, row in zip(places, panels, strict=False):
        _draw_row(axes, row, maps)
    courses = places[-1]
    for body in (1, 2) if across else ():
        _draw_profiles(places[-2][body - 1], maps, "tribofilm", body)
        _draw_profiles(places[-2][body + 1], maps, "wear", body)
        _draw_surface(courses[body + 1], maps, body)
    for axis in () if across else courses[2:]:
        axis.set_visible(False)
    marked = dataset.sel(time=maps[TIME].values)
    _draw_course(courses[0], dataset, marked, "coverage", 100.0, "coverage of the track [%]")
    _draw_course(courses[1], dataset, marked, "tribofilm", 1e9, "mean tribofilm [nm]")
    figure.suptitle(dataset.attrs.get("title", ""), fontsize="large", parse_math=False)
    return figure


def _height(maps: xr.Dataset, row: list["_Map"]) -> float:
    """Return the height [in] of a row of maps that are as wide as their columns, scales of colours beside them."""
    width = _WIDTH / _COLUMNS - (0.35 + 0.27 * sum(_ends(row)))
    ratio = np.ptp(maps["y"].values) / np.ptp(maps["x"].values)
    slender = not 1.0 / _SLENDER < ratio < _SLENDER
    return 0.7 + width * (1.0 if slender else float(ratio))


def _rows_of_maps(maps: xr.Dataset) -> list[list[_Map]]:
    """Return up to four maps a row: the tribofilm of each body on one scale, and what else there is at the end."""
    shown, patch, x = _chosen(maps[TIME].values), maps[ALONG].values, maps["x"].values
    pads = []
    for body in (1, 2):
        films = maps[f"tribofilm_map_{body}"].values[shown]
        look = "nm", 1e9, "viridis", f"tribofilm {body}", 1e9 * float(films.max())
        titles = [f"tribofilm of body {body}, {_told(maps, k)}" for k in shown]
        pads.append([_Map(title, film, patch, *look) for title, film in zip(titles, films, strict=True)])
    last, end = maps.isel({TIME: -1}), _told(maps, -1)
    what = "wear and pits" if "pits_map_1" in maps else "wear"
    worn = [_Map(f"{what} of body {body}, {end}", _lost(last, body), patch, "nm", 1e9, "magma") for body in (1, 2)]
    pressure, solid = (
        _Map(f"{text}, {end}", last[name].values, x, "GPa", 1e-9, "inferno", body=False)
        for name, text in (("pressure", "pressure"), ("solid_pressure", "pressure of the solids"))
    )
    gap = _Map(f"gap, {end}", last["gap"].values, x, "nm", 1e9, "cividis", logarithmic=True, body=False)
    if len(shown) == 1:
        pressed = _Map(f"plastic depth of body 2, {end}", last["plastic_map_2"].values, patch, "nm", 1e9, "magma")
        return [[*pads[0], *pads[1], *worn], [pressure, solid, gap, pressed]]
    if len(shown) == 2:
        return [[*pads[0], *pads[1]], [*worn, pressure, gap]]
    return [*pads, [*worn, pressure, gap]]


def _lost(maps: xr.Dataset, body: int) -> NDArray[np.float64]:
    """Return the map of what is worn off a body or has broken out of it."""
    lost: NDArray[np.float64] = maps[f"wear_map_{body}"].values
    return lost + maps[f"pits_map_{body}"].values if f"pits_map_{body}" in maps else lost


def _chosen(times: NDArray[np.float64]) -> list[int]:
    """Return up to four of the times, evenly spread to the last; not the start, where nothing has grown."""
    later = [k for k, time in enumerate(times) if time > 0.0] or [len(times) - 1]
    wanted = np.linspace(0, len(later) - 1, min(_COLUMNS, len(later)))
    return [later[round(k)] for k in wanted]


def _told(maps: xr.Dataset, k: int) -> str:
    factor, unit = _clock(float(maps[TIME].values[-1]))
    return f"{float(maps[TIME].values[k]) / factor:.3g} {unit}"


def _clock(end: float) -> tuple[float, str]:
    """Return the unit of time [s] in which people read a run up to `end` [s], and its name."""
    return next((factor, unit) for most, factor, unit in _UNITS if end <= most)


def _length(span: float) -> tuple[float, str]:
    return (1e6, "µm") if span < 2e-3 else (1e3, "mm")


def _draw_row(axes: "NDArray[Any]", row: list[_Map], maps: xr.Dataset) -> None:
    """Draw maps beside each other, and their scales of colours."""
    from matplotlib.ticker import LogLocator, StrMethodFormatter

    marks: dict[str, Any] = {"ticks": LogLocator(subs=_MARKS), "format": StrMethodFormatter("{x:g}")}
    for axis, panel, ends in zip(axes, row, _ends(row), strict=False):
        axis.set_title(panel.title, fontsize="medium")
        if len(maps["y"]) == 1:
            _draw_line(axis, panel)
            continue
        image = _draw_map(axis, panel, maps)
        if ends:
            beside = axis.inset_axes((1.03, 0.0, 0.05, 1.0))
            more = marks if panel.logarithmic else {}
            bar = axis.figure.colorbar(image, cax=beside, extend=_beyond(panel, image.norm), **more)
            bar.set_label(panel.unit, labelpad=2.0)
            bar.minorticks_off()
    for axis, before in zip(axes[1:], _ends(row)[:-1], strict=False):
        if not before and len(maps["y"]) > 1:
            axis.set_ylabel("")
            axis.tick_params(labelleft=False)
    for axis in axes[len(row) :]:
        axis.set_visible(False)


def _ends(row: list["_Map"]) -> list[bool]:
    """Return for each map of a row whether the next one has other colours."""
    after = [*(panel.scale for panel in row[1:]), ""]
    return [not panel.scale or panel.scale != other for panel, other in zip(row, after, strict=True)]


def _draw_line(axis: "Axes", panel: _Map) -> None:
    """Draw a map of a single row as a curve."""
    factor, unit = _length(np.ptp(panel.along))
    axis.plot(factor * panel.along, panel.factor * panel.values[0], color="0.2", linewidth=1.2)
    axis.set_yscale("log" if panel.logarithmic else "linear")
    axis.set_xlabel(f"x [{unit}]", labelpad=1.0)
    axis.set_ylabel(panel.unit)
    _without_frame(axis)


def _draw_map(axis: "Axes", panel: _Map, maps: xr.Dataset) -> "AxesImage":
    """Draw a map in its colours."""
    x, y = panel.along, maps["y"].values
    factor, unit = _length(max(np.ptp(x), np.ptp(y)))
    shown = panel.factor * panel.values
    finite = shown[np.isfinite(shown)]
    half = 0.5 * (x[1] - x[0])
    left, right, low, high = factor * np.array([x[0] - half, x[-1] + half, y[0] - half, y[-1] + half])
    slender = not 1.0 / _SLENDER < (right - left) / (high - low) < _SLENDER
    image = axis.imshow(
        shown,
        origin="lower",
        extent=(left, right, low, high),
        aspect="auto" if slender else "equal",
        cmap=panel.colours,
        norm=_norm(panel, finite),
        interpolation="nearest",
    )
    axis.set_xlabel(f"x [{unit}]", labelpad=1.0)
    axis.set_ylabel(f"y [{unit}]", labelpad=1.0)
    if not finite.any():
        _say(axis, "none" if finite.size else "no solution")
    _draw_edges(axis, panel, maps, factor)
    return image


def _norm(panel: _Map, finite: "NDArray[Any]") -> "Normalize":
    """Return the range of the colours of a map, whose values are `finite`: a few peaks may be beyond it."""
    from matplotlib.colors import LogNorm, Normalize

    if panel.logarithmic and finite.size:
        least = float(finite.min())
        return LogNorm(least, max(float(np.percentile(finite, _FAR)), _DECADE * least))
    top = panel.top
    if not panel.scale and finite.size:
        top = float(np.percentile(finite, _PEAKS)) or float(finite.max())
    return Normalize(0.0, top or 1.0)


def _beyond(panel: _Map, norm: Any) -> str:
    """Return at which end a map has values beyond its colours."""
    beyond = panel.factor * panel.values > (1.0 + 1e-6) * float(norm.vmax or 0.0)
    return "max" if beyond.any() else "neither"


def _say(axis: "Axes", text: str) -> None:
    axis.text(0.5, 0.5, text, transform=axis.transAxes, ha="center", va="center", color="0.5", fontsize="large")


def _draw_edges(axis: "Axes", panel: _Map, maps: xr.Dataset, factor: float) -> None:
    """Draw the edges of the track of a body, or Hertz's contact, where they lie within the map."""
    from matplotlib.patches import Ellipse

    a, b = (factor * float(maps[f"half_width_{axis_}"]) for axis_ in "xy")
    style: dict[str, Any] = {"color": "white", "linewidth": 0.9, "alpha": 0.8}
    if b >= factor * float(maps["y"].max()):
        return
    if panel.body:
        for edge in (-b, b):
            axis.axhline(edge, linestyle=(0, (4, 3)), **style)
    else:
        axis.add_patch(Ellipse((0.0, 0.0), 2.0 * a, 2.0 * b, fill=False, **style))


def _draw_profiles(axis: "Axes", maps: xr.Dataset, name: str, body: int) -> None:
    """Draw the profiles of one body across the track at all times, from faint to dark."""
    from matplotlib import colormaps

    what = {"tribofilm": "tribofilm", "wear": "wear"}[name]
    axis.set_title(f"{what} of body {body} across the track", fontsize="medium")
    profiles, y = 1e9 * maps[f"{name}_profile_{body}"].values, maps["y"].values
    factor, unit = _length(np.ptp(y))
    shades = np.linspace(_FAINT, 1.0, len(profiles)) if len(profiles) > 1 else [1.0]
    named = _named(len(profiles))
    for k, (profile, shade) in enumerate(zip(profiles, shades, strict=True)):
        label = _told(maps, k) if k in named else None
        axis.plot(factor * y, profile, color=colormaps[_FADES[body - 1]](shade), linewidth=1.3, label=label)
    axis.set_xlabel(f"y [{unit}]", labelpad=1.0)
    axis.set_ylabel(f"mean {'thickness' if name == 'tribofilm' else 'depth'} [nm]")
    if not profiles.any():
        _say(axis, "none")
    top = _ROOM * (float(profiles.max()) or 1.0)
    axis.set_ylim((0.0, top) if name == "tribofilm" else (top, 0.0))
    axis.legend(loc="upper center" if name == "tribofilm" else "lower center", **_LEGEND)
    _mark_track(axis, maps, factor)


def _named(count: int) -> Sequence[int]:
    return sorted({round(k) for k in np.linspace(0, count - 1, min(count, _FEW))})


def _draw_surface(axis: "Axes", maps: xr.Dataset, body: int) -> None:
    """Draw the cross-section in the middle of a body's patch as new and as it is at the end."""
    last = maps.isel({TIME: -1, ALONG: maps.sizes[ALONG] // 2})
    new, y = last[f"new_heights_{body}"].values, maps["y"].values
    worn = new - _lost(last, body) - last[f"plastic_map_{body}"].values
    factor, unit = _length(np.ptp(y))
    axis.set_title(f"surface of body {body}: a cross-section", fontsize="medium")
    covered, colour = worn + last[f"tribofilm_map_{body}"], _COLOURS[body - 1]
    axis.fill_between(factor * y, 1e9 * worn, 1e9 * covered, color=colour, alpha=0.3, linewidth=0.0, label="tribofilm")
    axis.plot(factor * y, 1e9 * new, color="0.5", linewidth=0.9, label="as new")
    axis.plot(factor * y, 1e9 * worn, color=colour, linewidth=1.2, label=f"solid, {_told(maps, -1)}")
    low, high = axis.get_ylim()
    axis.set_ylim(low, low + _ROOM * (high - low))
    axis.set_xlabel(f"y [{unit}]", labelpad=1.0)
    axis.set_ylabel("height [nm]")
    axis.legend(loc="upper center", **_LEGEND)
    _mark_track(axis, maps, factor)


def _mark_track(axis: "Axes", maps: xr.Dataset, factor: float) -> None:
    b = factor * float(maps["half_width_y"])
    if b < factor * float(maps["y"].max()):
        for edge in (-b, b):
            axis.axvline(edge, color="0.5", linewidth=0.8, linestyle=(0, (4, 3)))
    _without_frame(axis)


def _draw_course(axis: "Axes", dataset: xr.Dataset, marked: xr.Dataset, name: str, factor: float, label: str) -> None:
    """Draw an output of both bodies against time; the times of the maps are marked."""
    end = float(dataset["time"].values[-1])
    clock, unit = _clock(end)
    axis.set_title(label.partition(" [")[0], fontsize="medium")
    for body, colour in enumerate(_COLOURS, 1):
        series = dataset[f"{name}_{body}"]
        axis.plot(series["time"] / clock, factor * series, color=colour, linewidth=1.4, label=f"body {body}")
        axis.plot(marked["time"] / clock, factor * marked[f"{name}_{body}"], "o", color=colour, markersize=4.0)
    axis.set_xlim(0.0, end / clock)
    axis.set_ylim(bottom=0.0)
    axis.set_xlabel(f"time [{unit}]", labelpad=1.0)
    axis.set_ylabel(label)
    axis.legend(frameon=False, fontsize="small")
    _without_frame(axis)


def _without_frame(axis: "Axes") -> None:
    axis.spines[["top", "right"]].set_visible(False)
