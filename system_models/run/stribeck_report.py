"""The report of Stribeck curves: a table of friction, the shift of the curves, and one picture."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from contact_core.state import RangeFlag

from ..store.results import ERROR

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SOURCE = "Dawczyk et al. 2019, doi:10.1007/s11249-019-1148-9"
_ROUGH = ("tribofilm_roughness_1", "tribofilm_roughness_2", "composite_roughness")
_PANELS = (
    ("friction_coefficient", "friction coefficient", None),
    ("lambda_ratio", r"lambda ratio $\lambda$", None),
    ("contact_load_ratio", "share of the solids in the load, $W_c$", 0.5),
    ("contact_area_ratio", "real contact area / Hertz area, $A_c$", None),
)


def minutes(dataset: xr.Dataset) -> list[str]:
    """Return the rubbing times [min] as text."""
    return [f"{time / 60.0:g}" for time in dataset["rubbing_time"].values]


def table(dataset: xr.Dataset) -> str:
    """Return friction coefficients, a row for each speed and a column for each rubbing time."""
    head = [["speed", *("friction" for _ in minutes(dataset))], ["m/s", *(f"{time} min" for time in minutes(dataset))]]
    rows = [
        [f"{speed:.4g}", *(f"{mu:.4f}" for mu in row)]
        for speed, row in zip(
            dataset["entrainment_speed"].values, dataset["friction_coefficient"].values.T.tolist(), strict=True
        )
    ]
    columns = list(zip(*head, *rows, strict=True))
    widths = [max(map(len, column)) for column in columns]
    return "\n".join(
        "  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)) for row in (*head, *rows)
    )


def shift_lines(dataset: xr.Dataset) -> list[str]:
    """Return the transition of each curve and the roughness then; the shift in all."""
    level = dataset.attrs["friction_midway"]
    lines = []
    for text, row in zip(minutes(dataset), _rows(dataset), strict=True):
        first, second, both = (1e9 * float(row[name]) for name in _ROUGH)
        lines.append(
            f"After {text} min: W_c = 0.5 at {_speed(row['transition_speed'])}, friction {level:.3f} at "
            f"{_speed(row['transition_speed_friction'])}; roughness of the tribofilm {first:.1f} nm (body 1), "
            f"{second:.1f} nm (body 2), of both surfaces together {both:.1f} nm."
        )
    return [*lines, *_verdict(dataset)]


def _rows(dataset: xr.Dataset) -> list[xr.Dataset]:
    return [dataset.isel(rubbing_time=i) for i in range(dataset.sizes["rubbing_time"])]


def _speed(value: xr.DataArray) -> str:
    return f"{float(value):.3g} m/s" if np.isfinite(value) else "no speed of the sweep"


def _verdict(dataset: xr.Dataset) -> list[str]:
    """Return the shift of the transition from that of the first curve, beside the effect of roughness."""
    speeds, rough = (dataset[name].values for name in ("transition_speed", "composite_roughness"))
    moved = [
        f"{text} min by {speed / speeds[0]:.2f}, roughness by {both / rough[0]:.2f}"
        for text, speed, both in zip(minutes(dataset)[1:], speeds[1:], rough[1:], strict=True)
        if np.isfinite(speed / speeds[0])
    ]
    if not moved:
        return []
    fastest, roughest = (minutes(dataset)[int(np.nanargmax(values))] for values in (speeds, rough))
    return [
        f"Shift of W_c = 0.5 from the first curve, as a factor: after {'; '.join(moved)}. The transition is at the "
        f"highest speed after {fastest} min, the surfaces are roughest after {roughest} min. "
        f"Measured curves shift to higher speed as the tribofilm roughens ({_SOURCE})."
    ]


def closing_lines(dataset: xr.Dataset) -> list[str]:
    """Return validity and range, in sentences."""
    invalid, total = invalid_points(dataset), dataset["valid"].size
    lines = [f"All {total} points were computed.{_known(dataset)}"]
    if invalid:
        lines = [f"Validity: {invalid} of {total} points are INVALID.", *dataset.attrs["failures"].splitlines()]
    flags = dataset["range_flags"].values
    counts = {flag: int(((flags & flag) > 0).sum()) for flag in RangeFlag}
    return lines + [f"Range, at {n} of {total} points: {flag.text}." for flag, n in counts.items() if n]


def _known(dataset: xr.Dataset) -> str:
    """Return how well friction is known, from the surest of the points to the least sure one."""
    friction, half = dataset["friction_coefficient"], dataset.coords.get(f"friction_coefficient{ERROR}")
    if half is None or not (friction > 0.0).any():
        return ""
    relative = 100.0 * (half / friction).where(friction > 0.0)
    return f" Friction is known to {float(relative.min()):.2g} % at best, to {float(relative.max()):.2g} % at worst."


def invalid_points(dataset: xr.Dataset) -> int:
    """Return the number of points without an answer."""
    return int((~dataset["valid"].values).sum())


def write_figure(dataset: xr.Dataset, path: Path) -> Path:
    """Draw the curves into a PNG file and return its path."""
    figure(dataset).savefig(path, dpi=150)
    return path


def figure(dataset: xr.Dataset, title: str = "") -> "Figure":
    """Return friction, lambda ratio, load and area of the solids against speed, a line for each rubbing time.

    A hollow point stands for film solutions that have not converged, or a dry one in their place.
    """
    from matplotlib import colormaps
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    shown = dataset.where(dataset["lambda_ratio"] < 1e3)  # at its cap it says nothing
    speeds = dataset["entrainment_speed"].values
    unsure = (dataset["range_flags"].values & (RangeFlag.NOT_CONVERGED | RangeFlag.FALLBACK)) > 0
    figure = Figure(figsize=(9.0, 7.0), layout="constrained")
    axes = figure.subplots(2, 2, sharex=True)
    colours = colormaps["viridis"](np.linspace(0.0, 0.9, dataset.sizes["rubbing_time"]))
    for axis, (name, label, level) in zip(axes.flat, _PANELS, strict=True):
        values = shown[name] if name == "lambda_ratio" else dataset[name]
        for text, colour, row in zip(minutes(dataset), colours, values.values, strict=True):
            axis.plot(speeds, row, "o-", color=colour, markersize=3.5, linewidth=1.4, label=text)
        if f"{name}{ERROR}" in dataset.coords:
            for colour, row, half in zip(colours, values.values, dataset[f"{name}{ERROR}"].values, strict=True):
                axis.fill_between(speeds, row - half, row + half, color=colour, alpha=0.15, linewidth=0.0)
        for colour, row, doubtful in zip(colours, values.values, unsure, strict=True):
            axis.plot(speeds[doubtful], row[doubtful], "o", color=colour, markersize=3.5, markerfacecolor="white")
        if level is not None:
            axis.axhline(level, color="0.7", linewidth=0.8, linestyle="--", zorder=0)
        axis.set_xscale("log")
        axis.set_ylabel(label)
        axis.set_ylim(bottom=0.0)
        axis.spines[["top", "right"]].set_visible(False)
    for axis in axes[-1]:
        axis.set_xlabel("entrainment speed [m/s]")
    legend = [Line2D([], [], color=colour, label=text) for text, colour in zip(minutes(dataset), colours, strict=True)]
    if unsure.any():
        legend.append(
            Line2D([], [], color="0.4", marker="o", markersize=3.5, markerfacecolor="white", linestyle="none")
        )
        legend[-1].set_label("not converged")
    axes[0, 0].legend(handles=legend, title="rubbed [min]", frameon=False)
    figure.align_ylabels()
    figure.suptitle(title or _title(dataset), fontsize="medium")
    return figure


def _title(dataset: xr.Dataset) -> str:
    return (
        f"{dataset.attrs['scene']}: {float(dataset['load']):.4g} N, {float(dataset['temperature']) - 273.15:.4g} °C, "
        f"slide-to-roll ratio {100.0 * float(dataset['slide_roll_ratio']):.3g} %, "
        f"level {dataset.attrs['film']}"
    )
