"""Pictures of a run of a ball bearing: the whole at a glance, the load zone, the surfaces of all classes."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from contact_core.kernels.arrays import Array
from contact_core.quantities import CELSIUS

from ...charts.chart import BLACK, BLUE, GREEN, GREY, NOTHING, ORANGE, PURPLE, RED, SKY, Chart, Line, Sheet, shades
from ...charts.units import time_unit
from ...run.panels import FILM, FRICTION, LAMBDA, ROUGHNESS, TRIBOFILM, WEAR
from ..assembly import Assembly
from .geometry import RACES, RaceName
from .record import CAPPED, BearingRun, ContactClass

_RPM, _DEGREES = 30.0 / math.pi, 180.0 / math.pi
_NM, _NMM = 1e9, 1e3  # per m, per N m
_RACE_COLOURS: dict[RaceName, str] = {"inner": BLUE, "outer": RED}
_PART_COLOURS = {"rolling": SKY, "sliding": ORANGE, "spin": PURPLE}
_NODE_COLOURS = {"balls": BLACK, "inner": BLUE, "outer": RED, "oil": ORANGE}
_BODIES = (("ball", "-"), ("ring", "--"))
_DECADES = 1e-4  # of the largest value are shown on log axes
_LEAST = 1e-4  # nm: films and wear that are always less are none
_Along = Callable[[RaceName], tuple[Array, Array]]  # azimuth [rad] and values of a race


def sheets(assembly: Assembly, dataset: xr.Dataset) -> dict[str, Sheet]:
    """Return the pictures by name: the run at a glance, the load zone, the surfaces of all load classes."""
    run = BearingRun(assembly, dataset)
    title = dataset.attrs.get("title", assembly.description)
    layers = [_of_bodies(run, "tribofilm", TRIBOFILM.title), _of_bodies(run, "wear_depth", WEAR.title)]
    ratio = _of_contacts(run, "lambda_ratio", LAMBDA.title)
    overview = [
        _loads_around(run), _films_around(run), _torque(run), _power(run), _temperatures(run), _over_speed(run),
        *layers, ratio,
    ]  # fmt: skip
    zone = [
        _loads_around(run),
        _around("Hertz's largest pressure [GPa]", _passages(run, "pressure", 1e-9)),
        _around(f"{FILM.title} h_c [nm]", _balls(run, "h_c", _NM)),
        _around(LAMBDA.title, _balls(run, "lambda_ratio", 1.0)),
    ]
    surfaces = [
        *layers, _of_bodies(run, "roughness", ROUGHNESS.title, log=False),
        _of_contacts(run, "friction_coefficient", FRICTION.title),
        _of_contacts(run, "contact_load_ratio", "Load on solids"), ratio,
    ]  # fmt: skip
    return {
        "overview": Sheet(overview, title, 3, 4.5, 3.5),
        "load_zone": Sheet(zone, title, 2, 5.5, 4.8),
        "surfaces": Sheet(surfaces, title, 3, 4.5, 3.5),
    }


# around the race, at the last moment in which the shaft turns


def _around(title: str, along: _Along) -> Chart:
    """Return values along the orbit of a ball on both races, the load pointing down."""
    lines = [
        Line(f"{race} race", *along(race), colour=_RACE_COLOURS[race], style=style)
        for race, style in zip(RACES, ("-", "--"), strict=True)
    ]
    return Chart(title, "", "", lines, polar=True)


def _passages(run: BearingRun, name: str, factor: float) -> _Along:
    """Return a quantity of a ball along its orbit, which is closed."""

    def along(race: RaceName) -> tuple[Array, Array]:
        way = run.passage(race, run.last)
        values = factor * getattr(way, name)
        return np.append(way.azimuth, way.azimuth[0] + 2.0 * math.pi), np.append(values, values[0])

    return along


def _balls(run: BearingRun, name: str, factor: float) -> _Along:
    """Return an output of the contacts along a ball's orbit; nothing where the ball has no load."""

    def along(race: RaceName) -> tuple[Array, Array]:
        way = run.passage(race, run.last)
        return way.azimuth, factor * run.at_load(race, name, run.last, way.load)

    return along


def _loads_around(run: BearingRun) -> Chart:
    title = f"load of the balls [N] at {run.speed[run.last] * _RPM:.0f} rpm"
    drawn = _around(title, _passages(run, "load", 1.0))
    balls = [
        Line("", *run.balls(race, run.last), colour=_RACE_COLOURS[race], style=mark)
        for race, mark in zip(RACES, ("oh", "x"), strict=True)
    ]
    return replace(drawn, lines=[*drawn.lines, *balls])


def _films_around(run: BearingRun) -> Chart:
    """Return the central film thickness of a ball along its orbit; the lambda ratio is in proportion to it."""
    drawn = _around(FILM.title, _balls(run, "h_c", _NM))
    lines = [replace(line, x=line.x * _DEGREES, style="-") for line in drawn.lines]
    names = {float(angle): f"{angle}" for angle in range(-180, 181, 90)}
    label = "azimuth from the load [deg]"
    return Chart(FILM.title, label, "h_c [nm]", lines, x_range=(-180.0, 180.0), x_names=names)


# against time


def _timed(run: BearingRun, title: str, label: str, lines: list[Line], **more: object) -> Chart:
    """Return lines whose x is a time [s] against time as people read it."""
    clock = time_unit(float(run.time[-1]))
    read = [replace(line, x=clock.of(line.x)) for line in lines]
    return replace(Chart(title, f"time {clock.label}", label, read), **more)  # type: ignore[arg-type]


def _total(parts: Mapping[str, Array]) -> Array:
    return np.asarray(sum(parts.values()))


def _torque(run: BearingRun) -> Chart:
    """Return the causes of the torque as areas, the textbooks as lines."""
    lines, below = [], np.zeros(run.time.size)
    for name, part in run.torque.items():
        upper = below + _NMM * part
        if np.nanmax(part, initial=0.0) > 0.0:
            lines.append(Line(name, run.time, upper, below=below, colour=_PART_COLOURS[name]))
        below = upper
    lines.append(Line("", run.time, below, colour=BLACK))
    lines += _textbooks(run, run.time, slice(None))
    return _timed(run, "Friction torque", "torque [N mm]", lines)


def _textbooks(run: BearingRun, x: Array, rows: Any) -> list[Line]:
    return [
        Line(name, x, _NMM * _total(parts)[rows], colour=colour, style=style)
        for name, parts, colour, style in (("SKF", run.skf, GREEN, "--"), ("Palmgren", run.palmgren, "#4d4d4d", ":"))
    ]


def _power(run: BearingRun) -> Chart:
    lines = [
        Line("power loss", run.time, run.of("bearing.power_loss"), colour=BLACK),
        Line("to the surroundings", run.time, run.of("housing.heat_to_ambient"), colour=GREEN, style="--"),
    ]
    return _timed(run, "Heat", "power [W]", lines)


def _temperatures(run: BearingRun) -> Chart:
    lines = [
        Line(node, run.time, run.of(f"housing.temperature_{node}") - CELSIUS, colour=colour)
        for node, colour in _NODE_COLOURS.items()
    ]
    return _timed(run, "Temperatures", "temperature [°C]", lines, from_zero=False)


def _over_speed(run: BearingRun) -> Chart | None:
    """Return the torque over speed in each start but the first, unless it is the only one; textbooks for the last."""
    starts = run.starts
    if not starts:
        return None
    torque, speed = _NMM * np.abs(run.of("bearing.friction_torque")), np.abs(run.speed) * _RPM
    first, last = min(1, len(starts) - 1), len(starts) - 1  # the motor may be at its speed from the beginning
    lines, colours = [], shades(len(starts), "viridis_r", 0.15, 1.0)
    for k, rows in enumerate(starts[first:], first):
        turning = rows[run.runs[rows]]
        label = f"start {k + 1}" if k in (first, last) else ""
        lines.append(Line(label, speed[turning], torque[turning], colour=colours[k], style=".-"))
    turning = starts[-1][run.runs[starts[-1]]]
    lines += _textbooks(run, speed[turning], turning)
    title = "Friction torque in starts"
    return Chart(title, "speed [rpm]", "torque [N mm]", lines, logarithmic=True, logarithmic_x=True)


def _classes(run: BearingRun) -> Iterator[tuple[ContactClass, float]]:
    """Yield the load classes with the opacity of each: the heaviest is the darkest."""
    for which in run.carrying:
        yield which, 0.3 + 0.7 * which.level / run.bearing.levels


def _of_bodies(run: BearingRun, name: str, title: str, log: bool = True) -> Chart:
    """Return a length of balls and rings in all load classes."""
    lines = [
        Line(
            "", run.time, _NM * run.solved(which, f"{name}_{body}"), colour=_RACE_COLOURS[which.race], style=style,
            faint=faint,
        )
        for which, faint in _classes(run)
        for body, (_, style) in enumerate(_BODIES, 1)
    ]  # fmt: skip
    largest = max((float(line.y.max()) for line in lines), default=0.0)
    lines += _key(bodies=True)
    more: dict[str, object] = {"key": _meaning(run)}
    if log and largest < _LEAST:
        middle = 0.5 * float(time_unit(float(run.time[-1])).of(run.time[-1]))
        lines = [replace(line, y=np.full(len(line.x), np.nan)) for line in lines]
        more |= {"y_range": (0.0, 1.0), "notes": [(0.3 * middle, 0.5, f"none above {_LEAST:g} nm")]}
    elif log:
        more |= {"logarithmic": True, "y_range": (_DECADES * largest, 2.0 * largest)}
    return _timed(run, title, "mean [nm]" if log else "Rq [nm]", lines, **more)


def _of_contacts(run: BearingRun, name: str, title: str) -> Chart:
    """Return an output of the contacts of all load classes, where the shaft turns and they are loaded."""
    lines = []
    for which, faint in _classes(run):
        values = np.where(run.runs & run.loaded(which), run.solved(which, name), np.nan)
        values[values >= CAPPED] = np.nan
        lines.append(Line("", run.time, values, colour=_RACE_COLOURS[which.race], faint=faint))
    known = np.concatenate([line.y for line in lines] or [NOTHING])
    least, largest = float(np.nanmin(known, initial=math.inf)), float(np.nanmax(known, initial=0.0))
    more: dict[str, object] = {"key": _meaning(run)}
    if largest > 0.0:
        more |= {"logarithmic": True, "y_range": (max(0.7 * least, _DECADES * largest), 1.4 * largest)}
    return _timed(run, title, "[–]", [*lines, *_key(bodies=False)], **more)


def _key(bodies: bool) -> Iterator[Line]:
    """Yield the entries of the key: colours are races, dashes rings."""
    for race in RACES:
        yield Line(race, NOTHING, NOTHING, colour=_RACE_COLOURS[race])
    for name, style in _BODIES if bodies else ():
        yield Line(name, NOTHING, NOTHING, colour=GREY, style=style)


def _meaning(run: BearingRun) -> str:
    return "darker: more load" if run.bearing.levels > 1 else ""
