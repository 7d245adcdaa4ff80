"""A sheet of charts as a picture by matplotlib: in a file, or as PNG within a page."""

import io
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from .chart import INDEXED, Chart, Line, Map, Sheet
from .scale import cut_off, decades, number, scale_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_KEY: dict[str, Any] = {"fontsize": "small", "framealpha": 0.8, "edgecolor": "none", "handlelength": 1.6}
_MANY = 4  # entries of a key: more stand in two columns
_TITLE = 0.5  # height of the title and of a row of the key below [in]
_ROOM = 0.07  # above the lines, for a row of the key
_QUIET = "0.92"


def save(sheet: Sheet, file: Path, dpi: int = 150) -> Path:
    """Draw a sheet into a PNG file and return its path."""
    figure(sheet).savefig(file, dpi=dpi)
    return file


def write(sheets: Mapping[str, Sheet], folder: Path) -> list[Path]:
    """Draw sheets into PNG files of a folder by their names and return the paths."""
    return [save(sheet, folder / f"{name}.png") for name, sheet in sheets.items()]


def png(sheet: Sheet, dpi: int = 110) -> bytes:
    kept = io.BytesIO()
    figure(sheet).savefig(kept, format="png", dpi=dpi)
    return kept.getvalue()


def figure(sheet: Sheet) -> "Figure":
    from matplotlib.figure import Figure

    columns = max(min(sheet.columns, len(sheet.charts)), 1)
    rows = max(-(-len(sheet.charts) // columns), 1)
    heights = sheet.heights or [sheet.height] * rows
    more = _TITLE * (bool(sheet.title) + bool(sheet.key))
    drawn = Figure(figsize=(columns * sheet.width, sum(heights) + more), layout="constrained")
    grid = drawn.add_gridspec(rows, columns, height_ratios=heights)
    for k, chart in enumerate(sheet.charts):
        if chart is not None:
            place = grid[k // columns, k % columns]
            axes = drawn.add_subplot(place, projection="polar" if chart.polar else None)
            below = sheet.charts[k + columns] if k + columns < len(sheet.charts) else None
            _draw(axes, chart, below is not None and below.x_label == chart.x_label and not chart.map)
    drawn.align_ylabels()
    if sheet.title:
        drawn.suptitle(sheet.title, fontsize="medium", parse_math=False)
    if sheet.key:
        beside: Any = f"outside {'lower' if sheet.title else 'upper'} center"
        drawn.legend(
            handles=[_handle(line) for line in sheet.key], loc=beside, ncols=4, frameon=False, fontsize="small",
            title=sheet.key_title or None, title_fontsize="small",
        )  # fmt: skip
    return drawn


def _draw(axes: "Axes", chart: Chart, continued: bool) -> None:
    """Draw a chart; `continued`: the chart below has the same axis of x."""
    for spans, shade in ((chart.shaded, _QUIET), (chart.dark, "0.75")):
        for begin, end in spans:
            axes.axvspan(begin, end, color=shade, linewidth=0.0, zorder=0)
    if chart.map:
        _draw_map(axes, chart, chart.map)
    other = axes.twinx() if any(line.right for line in chart.lines) else None
    for line in chart.lines:
        _curve(other if line.right and other else axes, line)
    if chart.polar:
        _polar(axes)
    elif not chart.map:
        _scales(axes, chart)
    if other:
        scale = scale_of(chart, right=True)
        other.set_ylim(scale.y0, scale.y1)
        other.set_ylabel(chart.right_label, color="0.4")
        other.tick_params(colors="0.4")
        other.spines["top"].set_visible(False)
    _thin(axes, chart)
    _words(axes, chart, continued)


def _curve(axes: "Axes", line: Line) -> None:
    if line.below is not None:
        axes.fill_between(line.x, line.below, line.y, color=line.ink, alpha=line.faint, linewidth=0.0, label=line.label)
        return
    if line.half is not None and line.dash:
        low, high = line.y - line.half, line.y + line.half
        axes.fill_between(line.x, low, high, color=line.ink, alpha=0.17, linewidth=0.0)
    elif line.half is not None:
        axes.errorbar(line.x, line.y, line.half, fmt="none", ecolor=line.ink, elinewidth=0.8, alpha=0.6)
    axes.add_line(_handle(line))


def _handle(line: Line) -> Any:
    """Return a line of matplotlib, with its points."""
    from matplotlib.lines import Line2D

    stairs: dict[str, Any] = {"|-": "steps-pre", "-|": "steps-post"}
    dash = cast(Any, line.dash or "none")
    return Line2D(
        line.x, line.y, color=line.ink, linestyle=dash, marker=line.mark or None, linewidth=1.4,
        markersize=3.0 if line.mark == "." else 4.0, markerfacecolor="white" if line.hollow else line.ink,
        alpha=line.faint, label=_math(line.label)[0] or "_", drawstyle=stairs.get(line.style, "default"),
    )  # fmt: skip


def _polar(axes: Any) -> None:
    """Turn an axis of angles so that 0 is at the bottom."""
    axes.set_theta_zero_location("S")
    axes.tick_params(labelsize="small")
    axes.set_rlabel_position(157.5)
    axes.autoscale_view()
    axes.set_ylim(bottom=0.0)


def _scales(axes: "Axes", chart: Chart) -> None:
    x0, x1, y0, y1 = scale_of(chart)
    room = 0.0 if chart.y_range or chart.logarithmic else _ROOM * _rows_of_key(chart) * (y1 - y0)
    axes.set_xscale("log" if chart.logarithmic_x else "linear")
    axes.set_yscale("log" if chart.logarithmic else "linear")
    axes.set(xlim=(x0, x1), ylim=(y1 + room, y0) if chart.downward else (y0, y1 + room))
    for axis, log, low, high, names in (
        (axes.xaxis, chart.logarithmic_x, x0, x1, chart.x_names),
        (axes.yaxis, chart.logarithmic, y0, y1, chart.y_names),
    ):
        if log or names:
            shown = names or {value: number(value) for value in decades(low, high)}
            labels = [_math(name)[0] for name in shown.values()]
            axis.set_ticks(list(shown), labels=labels, fontsize="small" if names else None)
            axis.set_tick_params(which="minor", size=0.0, labelsize=0.0)
            axis.minorticks_off()
    words = cut_off(chart, scale_of(chart))
    if words:
        axes.text(0.99, 0.97, words, transform=axes.transAxes, ha="right", va="top", fontsize="small", color="0.4")
    axes.spines[["top", "right"]].set_visible(False)


def _draw_map(axes: "Axes", chart: Chart, shown: Map) -> None:
    """Draw a map in its colours, with their scale beside it."""
    from matplotlib.colors import LogNorm, Normalize
    from matplotlib.patches import Ellipse
    from matplotlib.ticker import LogLocator, StrMethodFormatter

    norm = (LogNorm if shown.logarithmic else Normalize)(shown.low, shown.top)
    slender = not 0.4 < np.ptp(shown.x) / np.ptp(shown.y) < 2.5
    image = axes.imshow(
        shown.values, origin="lower", extent=(*shown.x, *shown.y), aspect="auto" if slender else "equal",
        cmap=shown.colours, norm=norm, interpolation="nearest",
    )  # fmt: skip
    finite = shown.values[np.isfinite(shown.values)]
    if not finite.any():
        words = "none" if finite.size else "no solution"
        axes.text(0.5, 0.5, words, transform=axes.transAxes, ha="center", va="center", color="0.5", fontsize="large")
    if shown.ring:
        across, up = (2.0 * each for each in shown.ring)
        axes.add_patch(Ellipse((0.0, 0.0), across, up, fill=False, color="white", linewidth=0.9, alpha=0.8))
    if shown.keyed:
        marks: dict[str, Any] = {"ticks": LogLocator(subs=(1.0, 3.0)), "format": StrMethodFormatter("{x:g}")}
        beyond = bool((finite > (1.0 + 1e-6) * shown.top).any())
        bar = axes.figure.colorbar(
            image, cax=axes.inset_axes((1.03, 0.0, 0.05, 1.0)), extend="max" if beyond else "neither",
            **(marks if shown.logarithmic else {}),
        )  # fmt: skip
        bar.set_label(shown.unit, labelpad=2.0)
        bar.minorticks_off()


def _thin(axes: "Axes", chart: Chart) -> None:
    """Draw levels and places."""
    for level in chart.levels:
        axes.axhline(level, color="white" if chart.map else "0.6", linewidth=0.9, linestyle=(0, (4, 3)), zorder=1)
    for name, place in chart.places.items():
        axes.axvline(place, color="0.85", linewidth=0.8, zorder=0)
        axes.annotate(
            name, (place, 1.0), (0.0, 2.0), xycoords=axes.get_xaxis_transform(), textcoords="offset points",
            ha="center", fontsize="small", color="0.4",
        )  # fmt: skip
    for x, y, words in chart.notes:
        axes.text(x, y, words, va="top", fontsize="small", color="0.3")


def _words(axes: "Axes", chart: Chart, continued: bool) -> None:
    """Write the title, labels and the key."""
    if chart.title:
        words, formula = _math(chart.title)
        pad = 14.0 if chart.places else None
        axes.set_title(words, loc="center" if chart.polar else "left", fontsize="medium", parse_math=formula, pad=pad)
    if continued:
        axes.tick_params(labelbottom=False)
    elif not chart.polar:
        words, formula = _math(chart.x_label)
        axes.set_xlabel(words, labelpad=2.0, parse_math=formula)
    if not chart.polar:
        words, formula = _math(chart.y_label)
        axes.set_ylabel(words, parse_math=formula)
    if chart.keyed:
        place = {"loc": "lower left", "bbox_to_anchor": (-0.12, -0.1)} if chart.polar else {"loc": "best"}
        columns = -(-len(chart.keyed) // max(_rows_of_key(chart), 1))
        key = axes.legend(title=chart.key or None, title_fontsize="small", ncols=columns, **_KEY, **place)
        for each, line in zip(key.get_texts(), [line for line in chart.lines if line.label], strict=False):
            each.set_parse_math(_math(line.label)[1])


def _rows_of_key(chart: Chart) -> int:
    return -(-len(chart.keyed) // (2 if len(chart.keyed) > _MANY else 1))


def _math(words: str) -> tuple[str, bool]:
    """Return words with the symbols that have an index as formulas, and whether there are any."""
    found = INDEXED.sub(r"$\1_{\\mathrm{\2}}$", words)
    return (found, True) if found != words and "$" not in words else (words, False)
