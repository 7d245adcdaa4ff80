"""Pictures of the run of a cam and its follower."""

import numpy as np
import xarray as xr

from contact_core.kernels.arrays import Array
from contact_core.quantities import CELSIUS

from ...charts.chart import BLACK, Chart, Line, Sheet
from ...charts.units import time_unit
from ...run.panels import FILM, FRICTION, LAMBDA, TRIBOFILM, WEAR
from ..assembly import Assembly
from .record import Record

_NM, _MM = 1e9, 1e3
_BODIES = ("cam", "follower")


def sheets(assembly: Assembly, dataset: xr.Dataset) -> dict[str, Sheet]:
    record = Record(assembly, dataset)
    title = dataset.attrs.get("title", "")
    return {
        "overview": Sheet(_last_turn(record), title, height=2.4),
        "time": Sheet(_against_time(record), title, height=3.0),
    }


def _last_turn(record: Record) -> list[Chart]:
    """Return the last turn over the angle of the cam."""
    row = record.last

    def of(quantity: str, factor: float = 1.0) -> Array:
        return factor * record.along(quantity)[row]

    def both(quantity: str, factor: float = _NM) -> list[Array]:
        return [of(f"{quantity}_{body}", factor) for body in (1, 2)]

    speeds = both("speed", 1.0)
    return [
        _over_angle(record, "Load", "load [N]", of("load")),
        _over_angle(record, "Combined radius", "radius [mm]", of("radius_x", _MM)),
        _over_angle(record, "Speeds relative to the contact", "speed [m/s]", *speeds, 0.5 * (speeds[0] + speeds[1])),
        _over_angle(record, "Hertz's pressure", "pressure [MPa]", 1e-6 * record.pressures(row)),
        _over_angle(record, FILM.title, "h_c [nm]", of("h_c", _NM)),
        _over_angle(record, LAMBDA.title, "λ [–]", of("lambda_ratio")),
        _over_angle(record, FRICTION.title, "µ [–]", of("friction_coefficient")),
        _over_angle(record, "Loss while there", "loss [W]", of("power_loss")),
        _over_angle(record, "Mean tribofilm", "thickness [nm]", *both("tribofilm")),
        _over_angle(record, "Mean wear depth", "depth [nm]", *both("wear_depth")),
    ]


def _over_angle(record: Record, title: str, label: str, *curves: Array) -> Chart:
    """Return curves over the event, with the value on the base circle on both sides of it."""
    reach = float(np.degrees(record.cam.lobe.half_event))
    beside = 1.2 * reach
    names = (*_BODIES, "entrainment") if len(curves) > 1 else ("",)
    lines = []
    for place, (values, name) in enumerate(zip(curves, names, strict=False)):
        colour = "" if name else BLACK
        lines.append(Line(name, record.angles, values[:-1], place=place, colour=colour, style=".-"))
        base = np.array([-beside, -reach, np.nan, reach, beside])
        lines.append(Line("", base, np.full(5, values[-1]), place=place, colour=colour, style=":"))
    words = "angle of the cam from its nose [deg]; dotted: base circle"
    return Chart(title, words, label, lines, levels=(0.0,), x_range=(-beside, beside))


def _against_time(record: Record) -> list[Chart]:
    """Return speed, temperatures, loss, friction torque, tribofilms and wear against time."""
    clock = time_unit(float(record.time[-1]))

    def chart(title: str, label: str, **curves: Array) -> Chart:
        lines = [Line(name, clock.of(record.time), values, place=k) for k, (name, values) in enumerate(curves.items())]
        return Chart(title, f"time {clock.label}", label, lines, from_zero=label.endswith("[nm]"))

    def largest(quantity: str) -> dict[str, Array]:
        return {name: _NM * record.along(f"{quantity}_{k}").max(axis=1) for k, name in enumerate(_BODIES, 1)}

    warm = {name: record.of(f"head.temperature_{name}") - CELSIUS for name in (*_BODIES, "oil")}
    return [
        chart("Speed of the cam", "speed [rpm]", speed=30.0 / np.pi * record.of("shaft.speed")),
        chart("Temperatures", "temperature [°C]", **warm),
        chart("Mean loss", "loss [W]", loss=record.of("cam.power_loss")),
        chart("Mean friction torque", "torque [N m]", torque=record.of("cam.friction_torque")),
        chart(f"{TRIBOFILM.title}, the largest mean", "thickness [nm]", **largest("tribofilm")),
        chart(f"{WEAR.title}, the largest", "depth [nm]", **largest("wear_depth")),
    ]
