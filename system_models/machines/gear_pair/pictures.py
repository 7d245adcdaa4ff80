"""Pictures of the run of a gear pair."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from contact_core.kernels.arrays import Array
from contact_core.quantities import CELSIUS

from ...charts.chart import BLACK, BLUE, COLOURS, NOTHING, RED, Chart, Line, Sheet, shades
from ...charts.scale import scale_of
from ...charts.units import time_unit
from ...run.panels import FILM, FRICTION, LAMBDA, ROUGHNESS, TRIBOFILM, WEAR
from ..assembly import Assembly
from .path import named_points
from .record import Record, Stage
from .safety import Safeties

_MOST_CURVES = 7  # that can be told apart
_MOST_MARKS = 30  # of stages in a picture against time
_MM, _NM = 1e3, 1e9
_GEARS = ("pinion", "wheel")
_FACTORS = {value: f"{value:g}" for value in (0.5, 1.0, 2.0, 5.0, 10.0, 20.0)}  # of safety: beyond, nobody asks
_Curve = Callable[[Stage], Array]  # values at the stations at the end of a stage


def sheets(assembly: Assembly, dataset: xr.Dataset) -> dict[str, Sheet]:
    """Return the pictures by name: the run at a glance, all along the path of contact, all against time, safety."""
    record = Record(assembly, dataset)
    along, time = _along(record), _against_time(record)
    overview = [*(along[name] for name in ("pressure", "lambda", "friction", "flash")), *_pair(along, "wear")]
    path = [along[name] for name in ("load", "pressure", "film", "lambda", "friction", "flash")]
    path += [chart for name in ("wear", "tribofilm", "roughness") for chart in _pair(along, name)]
    found = {
        "overview": [*overview, time["temperatures"], time["friction"]],
        "path": path,
        "time": list(time.values()),
        "safety": list(_safety(record)),
    }
    keys = {name: _stages(record) if name != "time" else [] for name in found}
    return {
        name: Sheet(
            charts, dataset.attrs.get("title", ""), height=2.5, key=keys[name],
            key_title="along the path: at the end of each stage",
        )
        for name, charts in found.items()
    }  # fmt: skip


# along the path of contact


def _along(record: Record) -> dict[str, Chart]:
    """Return the charts along the path of contact by name."""

    def of(title: str, label: str, quantity: str, factor: float = 1.0) -> Chart:
        values = factor * record.along(quantity)
        return _path(record, title, label, lambda stage: values[stage.last])

    found = {
        "load": of("Load of the contact", "load [kN]", "load", 1e-3),
        "pressure": _path(
            record, "Hertz's pressure", "pressure [GPa]", lambda stage: 1e-9 * record.pressures(stage.last)
        ),
        "film": of(FILM.title, "h_c [nm]", "h_c", _NM),
        "lambda": of(LAMBDA.title, "λ [–]", "lambda_ratio"),
        "friction": of(FRICTION.title, "µ [–]", "friction_coefficient"),
        "flash": of("Flash temperature rise", "rise [K]", "flash_temperature_rise"),
    }
    for name, panel in (("wear", WEAR), ("tribofilm", TRIBOFILM), ("roughness", ROUGHNESS)):
        for gear, quantity in zip(_GEARS, panel.quantities, strict=True):
            found[f"{name} {gear}"] = of(f"{panel.title}, {gear}", f"{panel.symbol} [nm]", quantity, _NM)
    return found


def _path(record: Record, title: str, label: str, values: _Curve) -> Chart:
    """Return a curve for each stage, with gaps where pairs of teeth come or go."""
    where, lines = _MM * record.positions, []
    for stage, colour in _coloured(record):
        x, y = (_apart(record, each) for each in (where, values(stage)))
        lines.append(Line("", x, y, colour=colour, style=".-"))
    places = {name: _MM * position for name, position in named_points(record.pair).items()}
    return Chart(title, "position from T1 [mm]", label, lines, places=places)


def _apart(record: Record, values: Array) -> Array:
    """Return values at the stations with a gap after each piece of the path."""
    return np.concatenate([each for piece in record.pieces for each in (values[piece], [np.nan])])


def _pair(charts: dict[str, Chart], name: str) -> list[Chart]:
    return _alike([charts[f"{name} {gear}"] for gear in _GEARS])


def _alike(charts: Sequence[Chart]) -> list[Chart]:
    top = max(scale_of(chart).y1 for chart in charts)
    return [replace(chart, y_range=(0.0, top)) for chart in charts]


def _coloured(record: Record) -> Iterator[tuple[Stage, str]]:
    """Yield the stages that are drawn, light to dark."""
    shown = record.shown(_MOST_CURVES)
    yield from zip(shown, shades(len(shown), "viridis_r", 0.12 + 0.88 / max(len(shown), 1), 1.0), strict=True)


def _stages(record: Record) -> list[Line]:
    """Return the key of the curves along the path."""
    clocks = [(stage, colour, time_unit(stage.end)) for stage, colour in _coloured(record)]
    texts = [
        f"{stage.number}: {stage.torque:.3g} N m, {float(clock.of(stage.end)):.3g} {clock.name}"
        for stage, _, clock in clocks
    ]
    return [Line(text, NOTHING, NOTHING, colour=colour) for text, (_, colour, _) in zip(texts, clocks, strict=True)]


# safety factors


def _safety(record: Record) -> Iterator[Chart]:
    """Yield ratios of film to roughness and temperatures along the path, and safety by stages: both ways."""
    found = Safeties(record)

    def films(stage: Stage) -> Array:
        return np.interp(record.positions, found.working(stage.last).places, found.films(stage.last).ratio)

    def hot(stage: Stage) -> Array:
        places = found.working(stage.last).places
        return np.interp(record.positions, places, found.scuffing(stage.last).flash.temperature) - CELSIUS

    yield _path(record, "Film ratio by ISO/TS 6336-22", "λ_GF [–]", films)
    yield _path(record, "Film ratio by the run", "h_c / Ra [–]", lambda stage: found.own_ratio(stage.last))
    title, label = "Contact temperature by", "temperature [°C]"
    yield from _alike(
        [
            _path(record, f"{title} ISO/TS 6336-20", label, hot),
            _path(record, f"{title} the run", label, lambda stage: found.own_temperature(stage.last) - CELSIUS),
        ]
    )
    shown = record.shown(_MOST_MARKS)
    pitting = [found.micropitting(stage.last) for stage in shown]
    scuffing = [found.scuffing(stage.last) for stage in shown]
    numbers = np.array([stage.number for stage in shown], dtype=float)
    yield _by_stage(
        "Safety against micropitting", numbers,
        ("ISO/TS 6336-22", [its.safety for its in pitting], RED), ("run", [its.own_safety for its in pitting], BLACK),
    )  # fmt: skip
    yield _by_stage(
        "Safety against scuffing", numbers,
        ("ISO/TS 6336-20, flash", [its.flash.safety for its in scuffing], RED),
        ("ISO/TS 6336-21, integral", [its.integral.safety if its.integral else np.nan for its in scuffing], BLUE),
        ("run", [its.own_safety for its in scuffing], BLACK),
    )  # fmt: skip


def _by_stage(title: str, numbers: Array, *curves: tuple[str, list[float], str]) -> Chart:
    lines = [Line(name, numbers, np.array(values), colour=colour, style="o-") for name, values, colour in curves]
    names = {number: f"{number:g}" for number in numbers.tolist()} if len(numbers) <= _MOST_CURVES else {}
    return Chart(
        title, "stage", "factor [–]", lines, logarithmic=True, levels=(1.0,), y_range=(0.4, 40.0), y_names=_FACTORS,
        x_names=names,
    )  # fmt: skip


# against time


def _against_time(record: Record) -> dict[str, Chart]:
    of, rpm = record.of, 30.0 / np.pi
    nodes = [node.name for node in record.assembly.parts["gearbox"].nodes]  # type: ignore[attr-defined]
    warm = {node: of(f"gearbox.temperature_{node}") - CELSIUS for node in nodes}
    lost = {
        "into the pinion": of("mesh.heat_flow_1"),
        "into the wheel": of("mesh.heat_flow_2"),
        "rolling, into the oil": of("mesh.power_rolling"),
        "all": of("mesh.power_loss"),
    }
    speed = of("shafts.speed_1")
    torque = np.divide(lost["all"], speed, out=np.full(len(speed), np.nan), where=record.works)
    return {
        "speed": _chart(record, "Speed", "speed [rpm]", pinion=rpm * speed, wheel=rpm * of("shafts.speed_2")),
        "torque": _chart(record, "Torque of the pinion", "torque [N m]", torque=of("shafts.mesh_torque")),
        "temperatures": _chart(record, "Temperatures", "temperature [°C]", **warm),
        "friction": _mean_friction(record),
        "loss": _chart(record, "Loss", "power [W]", **lost),
        "loss torque": _chart(record, "Loss torque on the pinion", "torque [N m]", torque=torque),
        "wear": _chart(record, "Wear depth, the largest", "depth [nm]", **_largest(record, "wear_depth")),
        "films": _chart(record, "Tribofilm, the thickest", "thickness [nm]", **_largest(record, "tribofilm")),
    }


def _chart(record: Record, title: str, label: str, **curves: Array) -> Chart:
    """Return curves against time; thin lines are the ends of stages."""
    clock, places = time_unit(float(record.time[-1])), (0, 1, 2, 4, *range(len(COLOURS)))
    time, lines = clock.of(record.time), []
    for (name, values), place in zip(curves.items(), places, strict=False):
        colour = COLOURS[place] if len(curves) > 1 else BLACK
        lines.append(Line(name, time, values, colour=colour))
    ends = record.stages if len(record.stages) <= _MOST_MARKS else []
    marks = {" " * k: float(clock.of(stage.end)) for k, stage in enumerate(ends)}
    return Chart(title, f"time {clock.label}", label, lines, places=marks, from_zero="°C" not in label)


def _mean_friction(record: Record) -> Chart:
    formulas = np.full((3, len(record.time)), np.nan)
    for row in np.flatnonzero(record.works):
        found = record.textbook(int(row))
        formulas[0, row] = found.schlenk
        formulas[1 if found.covered else 2, row] = found.iso_14179_1
    drawn = _chart(record, "Mean coefficient of friction", "µ_mz [–]", machine=record.friction)
    time = drawn.lines[0].x
    lines = [
        Line("machine, with the error that the contacts state", time, record.friction, record.friction_error, place=4),
        Line("Schlenk", time, formulas[0], colour=BLUE),
        Line("ISO/TR 14179-1", time, formulas[1], colour=RED),
        Line("beyond its range", time, formulas[2], colour=RED, style=":"),
    ]
    known = np.concatenate([record.friction, *formulas[:2]])
    top = 1.6 * float(np.nanmax(known)) if np.isfinite(known).any() else 1.0
    return replace(drawn, lines=lines, y_range=(0.0, top))


def _largest(record: Record, quantity: str) -> dict[str, Array]:
    return {gear: _NM * record.along(f"{quantity}_{k}").max(axis=1) for k, gear in enumerate(_GEARS, 1)}
