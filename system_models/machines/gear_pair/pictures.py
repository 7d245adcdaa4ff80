"""Pictures of the run of a gear pair."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from .path import Array, named_points
from .record import Record, Stage
from .safety import Safeties

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_BLUE, _RED, _GREEN, _BLACK = "#0072B2", "#D55E00", "#009E73", "#000000"  # of Okabe and Ito
_MOST_CURVES = 7  # that can be told apart
_MOST_MARKS = 30  # of stages in a picture against time
_MM = 1e3
_Curve = Callable[[Stage], Array]  # values at the stations at the end of a stage


def overview(record: Record) -> "Figure":
    """Draw the run at a glance: along the path by stages, and against time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 11.5), layout="constrained")
    axes = figure.subplots(4, 2)
    along = _along(record)
    for axis, name in zip(axes[:3].flat, ("pressure", "lambda", "friction", "flash", "wear 1", "wear 2"), strict=True):
        _path(axis, record, *along[name])
    _share_top(axes[2])
    _stage_legend(figure, record)
    _temperatures(axes[3, 0], record)
    _mean_friction(axes[3, 1], record)
    return figure


def path(record: Record) -> "Figure":
    """Draw along the path of contact: loads, films, friction, and the state of the flanks."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 14.0), layout="constrained")
    axes = figure.subplots(6, 2)
    for axis, panel in zip(axes.flat, _along(record).values(), strict=True):
        _path(axis, record, *panel)
    for pair in axes[3:]:
        _share_top(pair)
    _stage_legend(figure, record)
    return figure


def time(record: Record) -> "Figure":
    """Draw against time: duty, temperatures, losses, and the largest wear and film."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 10.0), layout="constrained")
    axes = figure.subplots(4, 2, sharex=True)
    panels = _speed, _torque, _temperatures, _mean_friction, _loss, _loss_torque, _wear, _films
    for axis, panel in zip(axes.flat, panels, strict=True):
        panel(axis, record)
    for axis in axes[:-1].flat:
        axis.set_xlabel("")
    return figure


def safety(record: Record) -> "Figure":
    """Draw ratios of film to roughness and temperatures along the path, and safety factors by stages: both ways."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 9.5), layout="constrained")
    axes = figure.subplots(3, 2)
    found = Safeties(record)
    for axis, (label, values) in zip(axes[:2].flat, _rated(record, found), strict=True):
        _path(axis, record, label, values)
    _share_top(axes[1])
    _stage_legend(figure, record)
    _micropitting(axes[2, 0], record, found)
    _scuffing(axes[2, 1], record, found)
    return figure


FIGURES: dict[str, Callable[[Record], "Figure"]] = {
    "overview": overview, "path": path, "time": time, "safety": safety,
}  # fmt: skip


# along the path of contact


def _along(record: Record) -> dict[str, tuple[str, _Curve]]:
    """Return the label and values of each panel."""

    def of(quantity: str, factor: float = 1.0) -> _Curve:
        values = factor * record.along(quantity)
        return lambda stage: values[stage.last]

    def bodies(name: str, quantity: str, label: str) -> dict[str, tuple[str, _Curve]]:
        return {
            f"{name} {body}": (f"{label}, {gear} [nm]", of(f"{quantity}_{body}", 1e9))
            for body, gear in ((1, "pinion"), (2, "wheel"))
        }

    return {
        "load": ("load of the contact [kN]", of("load", 1e-3)),
        "pressure": ("Hertz's pressure [GPa]", lambda stage: 1e-9 * record.pressures(stage.last)),
        "film": ("central film\nthickness $h_c$ [nm]", of("h_c", 1e9)),
        "lambda": (r"lambda ratio $\lambda$", of("lambda_ratio")),
        "friction": ("coefficient of friction", of("friction_coefficient")),
        "flash": ("flash temperature rise [K]", of("flash_temperature_rise")),
        **bodies("wear", "wear_depth", "wear depth"),
        **bodies("film", "tribofilm", "tribofilm"),
        **bodies("roughness", "roughness", "roughness Rq"),
    }


def _path(axis: "Axes", record: Record, label: str, values: _Curve) -> None:
    """Draw a curve for each stage, with gaps where pairs of teeth come or go."""
    where = _MM * record.positions
    for stage, colour in _coloured(record):
        found = values(stage)
        for piece in record.pieces:
            axis.plot(where[piece], found[piece], ".-", color=colour, linewidth=1.2, markersize=3.0)
    for name, position in named_points(record.pair).items():
        axis.axvline(_MM * position, color="0.85", linewidth=0.8, zorder=0)
        axis.annotate(name, (_MM * position, 1.0), (0.0, 2.0), xycoords=axis.get_xaxis_transform(),
                      textcoords="offset points", ha="center", fontsize="small", color="0.4")  # fmt: skip
    axis.set(ylabel=label, xlabel="position from T1 [mm]")
    axis.set_ylim(0.0, 1.05 * axis.get_ylim()[1])
    axis.spines[["top", "right"]].set_visible(False)


def _coloured(record: Record) -> Iterator[tuple[Stage, str]]:
    """Yield the stages that are drawn, light to dark."""
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    shown = record.shown(_MOST_CURVES)
    for k, stage in enumerate(shown):
        yield stage, to_hex(colormaps["viridis_r"](0.12 + 0.88 * (k + 1) / len(shown)))


def _stage_legend(figure: "Figure", record: Record) -> None:
    from matplotlib.lines import Line2D

    handles: list[Line2D] = [
        Line2D([], [], color=colour, label=f"{stage.number}: {stage.torque:.3g} N m, {_until(stage.end)}")
        for stage, colour in _coloured(record)
    ]
    if handles:
        figure.legend(
            handles=handles, loc="outside lower center", ncols=4, frameon=False, fontsize="small",
            title="along the path: at the end of each stage", title_fontsize="small",
        )  # fmt: skip


def _until(end: float) -> str:
    factor, unit = _clock(end)
    return f"{factor * end:.3g} {unit}"


def _share_top(axes: "np.ndarray") -> None:
    """Give pinion and wheel one scale."""
    top = max(axis.get_ylim()[1] for axis in axes)
    for axis in axes:
        axis.set_ylim(0.0, top)


# safety factors


def _rated(record: Record, found: Safeties) -> list[tuple[str, _Curve]]:
    """Return labels and values of ratios and contact temperatures, by the standards and by the run."""

    def films(stage: Stage) -> Array:
        return np.interp(record.positions, found.working(stage.last).places, found.films(stage.last).ratio)

    def hot(stage: Stage) -> Array:
        places = found.working(stage.last).places
        return np.interp(record.positions, places, found.scuffing(stage.last).flash.temperature) - 273.15

    return [
        (r"$\lambda_{GF}$ by ISO/TS 6336-22", films),
        (r"$h_c$ / Ra by the run", lambda stage: found.own_ratio(stage.last)),
        ("contact temperature\nby ISO/TS 6336-20 [degC]", hot),
        ("contact temperature\nby the run [degC]", lambda stage: found.own_temperature(stage.last) - 273.15),
    ]


def _micropitting(axis: "Axes", record: Record, found: Safeties) -> None:
    rows = [(stage.number, found.micropitting(stage.last)) for stage in record.shown(_MOST_MARKS)]
    _by_stage(
        axis, "safety against micropitting", [number for number, _ in rows],
        ("ISO/TS 6336-22", [its.safety for _, its in rows], _RED),
        ("run", [its.own_safety for _, its in rows], _BLACK),
    )  # fmt: skip


def _scuffing(axis: "Axes", record: Record, found: Safeties) -> None:
    rows = [(stage.number, found.scuffing(stage.last)) for stage in record.shown(_MOST_MARKS)]
    _by_stage(
        axis, "safety against scuffing", [number for number, _ in rows],
        ("ISO/TS 6336-20, flash", [its.flash.safety for _, its in rows], _RED),
        ("ISO/TS 6336-21, integral", [its.integral.safety if its.integral else np.nan for _, its in rows], _BLUE),
        ("run", [its.own_safety for _, its in rows], _BLACK),
    )  # fmt: skip


def _by_stage(axis: "Axes", label: str, numbers: list[int], *curves: tuple[str, list[float], str]) -> None:
    """Draw safety factors from a half to twenty: beyond, nobody asks."""
    for name, values, colour in curves:
        axis.plot(numbers, values, "o-", color=colour, linewidth=1.3, markersize=3.5, label=name)
    axis.axhline(1.0, color="0.6", linewidth=0.8, zorder=0)
    ticks = [0.5, 1.0, 2.0, 5.0, 10.0, 20.0]
    axis.set(xlabel="stage", ylabel=label, yscale="log", ylim=(0.4, 40.0))
    axis.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    axis.minorticks_off()
    if len(numbers) <= _MOST_CURVES:
        axis.set_xticks(numbers)
    axis.legend(frameon=False, fontsize="small", loc="best")
    axis.spines[["top", "right"]].set_visible(False)


# against time


def _clock(span: float) -> tuple[float, str]:
    """Return the factor and unit in which people read a time [s]."""
    if span > 3.0 * 3600.0:
        return 1.0 / 3600.0, "h"
    return (1.0 / 60.0, "min") if span > 180.0 else (1.0, "s")


def _against_time(axis: "Axes", record: Record, label: str, *curves: tuple[str, Array, str]) -> None:
    factor, unit = _clock(float(record.time[-1]))
    for legend, values, colour in curves:
        axis.plot(factor * record.time, values, color=colour, linewidth=1.3, label=legend)
    if len(record.stages) <= _MOST_MARKS:
        for stage in record.stages:
            axis.axvline(factor * stage.end, color="0.9", linewidth=0.8, zorder=0)
    if len(curves) > 1:
        axis.legend(frameon=False, fontsize="small")
    axis.set(xlabel=f"time [{unit}]", ylabel=label)
    axis.margins(x=0.0)
    axis.spines[["top", "right"]].set_visible(False)


def _speed(axis: "Axes", record: Record) -> None:
    rpm = 30.0 / np.pi
    curves = (
        ("pinion", rpm * record.of("shafts.speed_1"), _BLUE), ("wheel", rpm * record.of("shafts.speed_2"), _RED)
    )  # fmt: skip
    _against_time(axis, record, "speed [rpm]", *curves)
    axis.set_ylim(bottom=0.0)


def _torque(axis: "Axes", record: Record) -> None:
    _against_time(axis, record, "torque of the pinion [N m]", ("", record.of("shafts.mesh_torque"), _BLACK))


def _temperatures(axis: "Axes", record: Record) -> None:
    colours = {"pinion": _BLUE, "wheel": _RED, "oil": _GREEN, "housing": _BLACK}
    nodes = [node.name for node in record.assembly.parts["gearbox"].nodes]  # type: ignore[attr-defined]
    curves = [(n, record.of(f"gearbox.temperature_{n}") - 273.15, colours.get(n, "0.5")) for n in nodes]
    _against_time(axis, record, "temperature [degC]", *curves)


def _mean_friction(axis: "Axes", record: Record) -> None:
    formulas = np.full((3, len(record.time)), np.nan)
    for row in np.flatnonzero(record.works):
        found = record.textbook(int(row))
        formulas[0, row] = found.schlenk
        formulas[1 if found.covered else 2, row] = found.iso_14179_1
    _against_time(
        axis, record, "mean coefficient of friction",
        (r"machine, $\mu_{mz}$", record.friction, _BLACK),
        ("Schlenk", formulas[0], _BLUE),
        ("ISO/TR 14179-1", formulas[1], _RED),
    )  # fmt: skip
    clock = _clock(float(record.time[-1]))[0] * record.time
    axis.plot(clock, formulas[2], ":", color=_RED, linewidth=1.3, label="beyond its range")
    low, high = record.friction - record.friction_error, record.friction + record.friction_error
    axis.fill_between(clock, low, high, color="0.9", linewidth=0.0, zorder=0, label="error that the contacts state")
    drawn = np.concatenate([record.friction, formulas[0], formulas[1]])
    axis.set_ylim(0.0, 1.6 * np.nanmax(drawn) if np.isfinite(drawn).any() else None)
    axis.legend(frameon=False, fontsize="small", ncols=2)


def _loss(axis: "Axes", record: Record) -> None:
    _against_time(
        axis, record, "loss power [W]",
        ("all", record.of("mesh.power_loss"), _BLACK),
        ("into the pinion", record.of("mesh.heat_flow_1"), _BLUE),
        ("into the wheel", record.of("mesh.heat_flow_2"), _RED),
        ("rolling, into the oil", record.of("mesh.power_rolling"), _GREEN),
    )  # fmt: skip
    axis.set_ylim(bottom=0.0)


def _loss_torque(axis: "Axes", record: Record) -> None:
    speed = record.of("shafts.speed_1")
    torque = np.divide(record.of("mesh.power_loss"), speed, out=np.full(len(speed), np.nan), where=record.works)
    _against_time(axis, record, "loss torque on the pinion [N m]", ("", torque, _BLACK))
    axis.set_ylim(bottom=0.0)


def _largest(record: Record, quantity: str) -> list[tuple[str, Array, str]]:
    return [
        (gear, 1e9 * record.along(f"{quantity}_{body}").max(axis=1), colour)
        for body, gear, colour in ((1, "pinion", _BLUE), (2, "wheel", _RED))
    ]


def _wear(axis: "Axes", record: Record) -> None:
    _against_time(axis, record, "largest wear depth [nm]", *_largest(record, "wear_depth"))
    axis.set_ylim(bottom=0.0)


def _films(axis: "Axes", record: Record) -> None:
    _against_time(axis, record, "thickest tribofilm [nm]", *_largest(record, "tribofilm"))
    axis.set_ylim(bottom=0.0)
