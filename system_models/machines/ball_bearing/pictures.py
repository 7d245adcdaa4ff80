"""Pictures of a run of a ball bearing: the whole at a glance, the load zone, the surfaces of all classes."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .geometry import RACES, RaceName
from .record import CAPPED, Array, BearingRun

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_RPM, _DEGREES, _CELSIUS = 30.0 / math.pi, 180.0 / math.pi, 273.15
_NM, _NMM = 1e9, 1e3  # per m, per N m
# colours of Okabe and Ito: which the colour-blind can tell apart
_RACE_COLOURS: dict[RaceName, str] = {"inner": "#0072B2", "outer": "#D55E00"}
_GREEN, _PURPLE, _ORANGE, _SKY = "#009E73", "#CC79A7", "#E69F00", "#56B4E9"
_PART_COLOURS = {"rolling": _SKY, "sliding": _ORANGE, "spin": _PURPLE}
_NODE_COLOURS = {"balls": "black", "inner": _RACE_COLOURS["inner"], "outer": _RACE_COLOURS["outer"], "oil": _ORANGE}
_SKF, _PALMGREN = _GREEN, "0.3"
_KEY: dict[str, Any] = {"framealpha": 0.8, "edgecolor": "none", "fontsize": "small"}
_ABOVE: dict[str, Any] = {"ncols": 4, "columnspacing": 1.0, "handlelength": 1.6}
_BODIES = ((1, "ball", "-"), (2, "ring", "--"))
_DECADES = 1e-4  # of the largest value are shown on log axes
_LEAST = 1e-4  # nm: films and wear that are always less are none


def write(run: BearingRun, folder: Path) -> list[Path]:
    """Draw all pictures into PNG files of a folder and return their paths."""
    figures = {"overview": overview(run), "load_zone": load_zone(run), "surfaces": surfaces(run)}
    paths = []
    for name, figure in figures.items():
        paths.append(folder / f"{name}.png")
        figure.savefig(paths[-1], dpi=150)
    return paths


def overview(run: BearingRun) -> "Figure":
    """Draw loads and films around the race, torque, power, temperatures, starts, tribofilms, wear, lambda ratio."""
    figure = _figure(run, (13.0, 11.0))
    grid = figure.add_gridspec(3, 3)
    _loads_around(figure.add_subplot(grid[0, 0], projection="polar"), run)
    _films_around(figure.add_subplot(grid[0, 1]), run)
    _torque(figure.add_subplot(grid[0, 2]), run)
    _power(figure.add_subplot(grid[1, 0]), run)
    _temperatures(figure.add_subplot(grid[1, 1]), run)
    _over_speed(figure.add_subplot(grid[1, 2]), run)
    _of_bodies(figure.add_subplot(grid[2, 0]), run, "tribofilm", "mean tribofilm [nm]")
    _of_bodies(figure.add_subplot(grid[2, 1]), run, "wear_depth", "mean wear depth [nm]")
    _of_contacts(figure.add_subplot(grid[2, 2]), run, "lambda_ratio", r"lambda ratio $\lambda$")
    return figure


def load_zone(run: BearingRun) -> "Figure":
    """Draw load, pressure, film and lambda ratio of the balls around the races."""
    figure = _figure(run, (11.0, 10.0))
    places = [figure.add_subplot(2, 2, k, projection="polar") for k in range(1, 5)]
    _loads_around(places[0], run)
    _passages(places[1], run, "pressure", 1e-9, "Hertz's largest pressure [GPa]")
    _balls_around(places[2], run, "h_c", _NM, "central film\nthickness $h_c$ [nm]")
    _balls_around(places[3], run, "lambda_ratio", 1.0, r"lambda ratio $\lambda$")
    return figure


def surfaces(run: BearingRun) -> "Figure":
    """Draw for each load class against time: tribofilm, wear, roughness, friction, load on solids, lambda ratio."""
    figure = _figure(run, (13.0, 7.5))
    axes = figure.subplots(2, 3)
    _of_bodies(axes[0, 0], run, "tribofilm", "mean tribofilm [nm]")
    _of_bodies(axes[0, 1], run, "wear_depth", "mean wear depth [nm]")
    _of_bodies(axes[0, 2], run, "roughness", "roughness Rq [nm]", log=False)
    _of_contacts(axes[1, 0], run, "friction_coefficient", "friction coefficient")
    _of_contacts(axes[1, 1], run, "contact_load_ratio", "load on solids")
    _of_contacts(axes[1, 2], run, "lambda_ratio", r"lambda ratio $\lambda$")
    return figure


def _figure(run: BearingRun, size: tuple[float, float]) -> "Figure":
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, layout="constrained")
    figure.suptitle(run.dataset.attrs.get("title", run.assembly.description), fontsize="medium", parse_math=False)
    return figure


# around the race, at the last moment in which the shaft turns


def _polar(axes: Any, title: str) -> None:
    """Prepare polar axes with the load pointing down."""
    axes.set_theta_zero_location("S")
    axes.set_title(title, fontsize="medium")
    axes.tick_params(labelsize="small")
    axes.set_rlabel_position(157.5)
    axes.set_ylim(bottom=0.0)


def _loads_around(axes: Any, run: BearingRun) -> None:
    _passages(axes, run, "load", 1.0, "")
    for race, marker in zip(RACES, ("o", "x"), strict=True):
        azimuth, load = run.balls(race, run.last)
        axes.plot(azimuth, load, marker, color=_RACE_COLOURS[race], fillstyle="none", markersize=7, clip_on=False)
    _polar(axes, f"load of the balls [N] at {run.speed[run.last] * _RPM:.0f} rpm")


def _passages(axes: Any, run: BearingRun, name: str, factor: float, title: str) -> None:
    """Draw a quantity of a ball along its orbit."""
    for race, style in zip(RACES, ("-", "--"), strict=True):
        way = run.passage(race, run.last)
        azimuth, values = np.append(way.azimuth, way.azimuth[0] + 2.0 * math.pi), factor * getattr(way, name)
        axes.plot(azimuth, np.append(values, values[0]), style, color=_RACE_COLOURS[race], label=f"{race} race")
    _polar(axes, title)
    axes.legend(**_KEY, loc="lower left", bbox_to_anchor=(-0.12, -0.1))


def _balls_around(axes: Any, run: BearingRun, name: str, factor: float, title: str) -> None:
    """Draw an output of the contacts along a ball's orbit; nothing where the ball has no load."""
    for race, style in zip(RACES, ("-", "--"), strict=True):
        way = run.passage(race, run.last)
        values = factor * run.at_load(race, name, run.last, way.load)
        axes.plot(way.azimuth, values, style, color=_RACE_COLOURS[race], label=f"{race} race")
    _polar(axes, title)


def _films_around(axes: "Axes", run: BearingRun) -> None:
    """Draw the central film thickness of a ball along its orbit; the lambda ratio is in proportion to it."""
    for race in RACES:
        way = run.passage(race, run.last)
        gap = _NM * run.at_load(race, "h_c", run.last, way.load)
        axes.plot(way.azimuth * _DEGREES, gap, color=_RACE_COLOURS[race], label=f"{race} race")
    axes.set(xlabel="azimuth from the load [deg]", xticks=range(-180, 181, 90))
    axes.set_ylabel("central film\nthickness $h_c$ [nm]")
    axes.set_ylim(bottom=0.0)
    _plain(axes)


# against time


def _clock(run: BearingRun) -> tuple[Array, str]:
    """Return times in the unit that people would take, and that unit."""
    for unit, seconds in (("h", 3600.0), ("min", 60.0)):
        if run.time[-1] >= 3.0 * seconds:
            return run.time / seconds, unit
    return run.time, "s"


def _timed(axes: "Axes", run: BearingRun, label: str) -> None:
    time, unit = _clock(run)
    axes.set(xlabel=f"time [{unit}]", ylabel=label, xlim=(time[0], time[-1]))
    _plain(axes)


def _plain(axes: "Axes") -> None:
    axes.spines[["top", "right"]].set_visible(False)
    if axes.get_legend_handles_labels()[1]:
        _legend(axes)


def _legend(axes: "Axes", **more: Any) -> None:
    """Draw the legend above the axes, where it covers no line."""
    axes.legend(**_KEY, loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.2, **_ABOVE | more)


def _total(parts: Mapping[str, Array]) -> Array:
    return np.asarray(sum(parts.values()))


def _torque(axes: "Axes", run: BearingRun) -> None:
    """Draw the causes of the torque as areas, the textbooks as lines."""
    time, _ = _clock(run)
    below = np.zeros(time.size)
    for name, part in run.torque.items():
        if np.nanmax(part, initial=0.0) > 0.0:
            axes.fill_between(time, _NMM * below, _NMM * (below + part), color=_PART_COLOURS[name], label=name, lw=0.0)
        below = below + part
    axes.plot(time, _NMM * below, color="black", linewidth=1.0)
    axes.plot(time, _NMM * _total(run.skf), "--", color=_SKF, linewidth=1.2, label="SKF")
    axes.plot(time, _NMM * _total(run.palmgren), ":", color=_PALMGREN, linewidth=1.4, label="Palmgren")
    axes.set_ylim(bottom=0.0)
    _timed(axes, run, "friction torque [N mm]")


def _power(axes: "Axes", run: BearingRun) -> None:
    time, _ = _clock(run)
    axes.plot(time, run.of("bearing.power_loss"), color="black", linewidth=1.2, label="power loss")
    axes.plot(time, run.of("housing.heat_to_ambient"), "--", color=_GREEN, linewidth=1.2, label="to the surroundings")
    axes.set_ylim(bottom=0.0)
    _timed(axes, run, "power [W]")


def _temperatures(axes: "Axes", run: BearingRun) -> None:
    time, _ = _clock(run)
    for node, colour in _NODE_COLOURS.items():
        axes.plot(time, run.of(f"housing.temperature_{node}") - _CELSIUS, color=colour, linewidth=1.2, label=node)
    _timed(axes, run, "temperature [degC]")


def _over_speed(axes: "Axes", run: BearingRun) -> None:
    """Draw the torque over speed in each start but the first, unless it is the only one; textbooks for the last."""
    from matplotlib import colormaps
    from matplotlib.ticker import LogLocator, NullFormatter

    starts = run.starts
    if not starts:
        axes.set_axis_off()
        return
    torque, speed = _NMM * np.abs(run.of("bearing.friction_torque")), np.abs(run.speed) * _RPM
    first, last = min(1, len(starts) - 1), len(starts) - 1  # the motor may be at its speed from the beginning
    for k, rows in enumerate(starts[first:], first):
        turning = rows[run.runs[rows]]
        shade = colormaps["viridis_r"](0.15 + 0.85 * k / max(last, 1))
        label = f"start {k + 1}" if k in (first, last) else None
        axes.plot(speed[turning], torque[turning], color=shade, linewidth=1.2, label=label, marker=".", markersize=3)
    turning = starts[-1][run.runs[starts[-1]]]
    for name, parts, style, colour in (
        ("SKF", run.skf, "--", _SKF),
        ("Palmgren", run.palmgren, ":", _PALMGREN),
    ):
        axes.plot(speed[turning], _NMM * _total(parts)[turning], style, color=colour, linewidth=1.2, label=name)
    axes.set(xscale="log", yscale="log", xlabel="speed [rpm]", ylabel="friction torque [N mm]")
    for axis in (axes.xaxis, axes.yaxis):
        low, high = axis.get_view_interval()
        axis.set_major_locator(LogLocator(subs=(1.0,) if high > 100.0 * low else (1.0, 2.0, 5.0)))
        axis.set_major_formatter(lambda value, _: f"{value:g}")
        axis.set_minor_formatter(NullFormatter())
    _plain(axes)


def _shade(level: int, levels: int) -> float:
    """Return the opacity of a class: the heaviest is the darkest."""
    return 0.3 + 0.7 * level / levels


def _of_bodies(axes: "Axes", run: BearingRun, name: str, label: str, log: bool = True) -> None:
    """Draw a length of balls and rings in all load classes."""
    time, _ = _clock(run)
    largest = 0.0
    for which in run.carrying:
        for body, _, style in _BODIES:
            values = _NM * run.solved(which, f"{name}_{body}")
            largest = max(largest, float(values.max()))
            shade = _shade(which.level, run.bearing.levels)
            axes.plot(time, values, style, color=_RACE_COLOURS[which.race], alpha=shade, linewidth=1.2)
    if log and largest < _LEAST:
        axes.text(0.5, 0.5, f"none above {_LEAST:g} nm", transform=axes.transAxes, ha="center", color="0.4")
        axes.set_ylim(0.0, 1.0)
        axes.set_yticks([])
    elif log:
        axes.set_yscale("log")
        axes.set_ylim(_DECADES * largest, 2.0 * largest)
    else:
        axes.set_ylim(bottom=0.0)
    _timed(axes, run, label)
    _key(axes, run, bodies=True)


def _of_contacts(axes: "Axes", run: BearingRun, name: str, label: str) -> None:
    """Draw an output of the contacts of all load classes, where the shaft turns and they are loaded."""
    time, _ = _clock(run)
    least, largest = math.inf, 0.0
    for which in run.carrying:
        values = np.where(run.runs & run.loaded(which), run.solved(which, name), np.nan)
        values[values >= CAPPED] = np.nan
        least = min(least, float(np.nanmin(values, initial=math.inf)))
        largest = max(largest, float(np.nanmax(values, initial=0.0)))
        shade = _shade(which.level, run.bearing.levels)
        axes.plot(time, values, color=_RACE_COLOURS[which.race], alpha=shade, linewidth=1.2)
    if largest > 0.0:
        axes.set_yscale("log")
        axes.set_ylim(max(0.7 * least, _DECADES * largest), 1.4 * largest)
    _timed(axes, run, label)
    _key(axes, run, bodies=False)


def _key(axes: "Axes", run: BearingRun, bodies: bool) -> None:
    """Draw the key: colours are races, dashes rings; darker is heavier."""
    from matplotlib.lines import Line2D

    entries: list[tuple[str, Any]] = [(race, {"color": _RACE_COLOURS[race]}) for race in RACES]
    if bodies:
        entries += [(name, {"color": "0.3", "linestyle": style}) for _, name, style in _BODIES]
    handles = [Line2D([], [], label=name, **style) for name, style in entries]
    title = "darker: more load" if run.bearing.levels > 1 else None
    _legend(axes, handles=handles, title=title, title_fontsize="small", alignment="left")
