"""Pictures of the run of a cam and its follower."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from .record import Array, Record

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_BLUE, _RED, _GREEN, _BLACK = "#0072B2", "#D55E00", "#009E73", "#000000"  # of Okabe and Ito
_ZERO = 273.15  # K, of degC
_NM, _MM = 1e9, 1e3
_BODIES = ((1, "cam", _BLUE), (2, "follower", _RED))


def overview(record: Record) -> "Figure":
    """Draw the last turn over the angle of the cam."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 12.0), layout="constrained")
    axes = figure.subplots(5, 2, sharex=True)
    row = record.last

    def of(quantity: str, factor: float = 1.0) -> Array:
        return factor * record.along(quantity)[row]

    def both(quantity: str, factor: float = _NM) -> list[tuple[Array, str, str]]:
        return [(of(f"{quantity}_{body}", factor), name, colour) for body, name, colour in _BODIES]

    speeds = both("speed", 1.0)
    mean = 0.5 * (speeds[0][0] + speeds[1][0])
    panels: list[tuple[str, list[tuple[Array, str, str]]]] = [
        ("load [N]", [(of("load"), "", _BLACK)]),
        ("radius of the cam [mm]", [(of("radius_x", _MM), "", _BLACK)]),
        ("speed relative to the contact [m/s]", [*speeds, (mean, "entrainment", _GREEN)]),
        ("Hertz's pressure [MPa]", [(1e-6 * record.pressures(row), "", _BLACK)]),
        ("central film\nthickness $h_c$ [nm]", [(of("h_c", _NM), "", _BLACK)]),
        (r"lambda ratio $\lambda$", [(of("lambda_ratio"), "", _BLACK)]),
        ("coefficient of friction", [(of("friction_coefficient"), "", _BLACK)]),
        ("loss while there [W]", [(of("power_loss"), "", _BLACK)]),
        ("mean tribofilm [nm]", both("tribofilm")),
        ("mean wear depth [nm]", both("wear_depth")),
    ]
    for axis, (label, curves) in zip(axes.flat, panels, strict=True):
        _over_angle(axis, record, label, curves)
    for axis in axes[-1]:
        axis.set_xlabel("angle of the cam from its nose [deg]; dotted: base circle")
    return figure


def _over_angle(axis: "Axes", record: Record, label: str, curves: list[tuple[Array, str, str]]) -> None:
    """Draw curves over the event, with the value on the base circle on both sides of it."""
    reach = float(np.degrees(record.cam.lobe.half_event))
    beside = 1.2 * reach
    for values, name, colour in curves:
        axis.plot(record.angles, values[:-1], ".-", color=colour, label=name or None, linewidth=1.2, markersize=4.0)
        for low, high in ((-beside, -reach), (reach, beside)):
            axis.plot([low, high], [values[-1]] * 2, ":", color=colour, linewidth=1.5)
    axis.axhline(0.0, color="0.85", linewidth=0.8, zorder=0)
    axis.set(ylabel=label, xlim=(-beside, beside))
    if any(name for _, name, _ in curves):
        axis.legend(frameon=False, fontsize="small")


def time(record: Record) -> "Figure":
    """Draw the run against time: speed, temperatures, loss, friction torque, tribofilms and wear."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 9.0), layout="constrained")
    axes = figure.subplots(3, 2, sharex=True)
    hours = record.time / 3600.0
    axes[0, 0].plot(hours, 30.0 / np.pi * record.of("shaft.speed"), color=_BLACK)
    axes[0, 0].set_ylabel("speed of the cam [rpm]")
    for node, colour in (("oil", _GREEN), ("cam", _BLUE), ("follower", _RED)):
        axes[0, 1].plot(hours, record.of(f"head.temperature_{node}") - _ZERO, color=colour, label=node)
    axes[0, 1].set_ylabel("temperature [degC]")
    axes[1, 0].plot(hours, record.of("cam.power_loss"), color=_BLACK)
    axes[1, 0].set_ylabel("mean loss [W]")
    axes[1, 1].plot(hours, record.of("cam.friction_torque"), color=_BLACK)
    axes[1, 1].set_ylabel("mean friction torque [N m]")
    for axis, quantity, label in (
        (axes[2, 0], "tribofilm", "largest mean tribofilm [nm]"),
        (axes[2, 1], "wear_depth", "largest wear depth [nm]"),
    ):
        for body, name, colour in _BODIES:
            axis.plot(hours, _NM * record.along(f"{quantity}_{body}").max(axis=1), color=colour, label=name)
        axis.set(ylabel=label, xlabel="time [h]")
    for axis in (axes[0, 1], *axes[2]):
        axis.legend(frameon=False, fontsize="small")
    return figure


FIGURES: dict[str, Callable[[Record], "Figure"]] = {"overview": overview, "time": time}
