"""The report of a rig's run: tables, the Stribeck curves of its duty, the bath's energy, one picture."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ...charts.half_widths import cell
from ...run.cosim_report import aligned
from ...store.results import ERROR
from ..assembly import Assembly
from ..report import heat_stored

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SHARES = (0.0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0)  # of the run: running-in is early
_LEAST = 4  # speeds of a curve
_SAME = 1e-9  # relative, of times and slide-to-roll ratios
_ZERO = 273.15  # K, of degC

# heading, unit people read, variable, factor from SI, digits
_COLUMNS = (
    ("friction", "", "contact.friction_coefficient", 1.0, 4),
    ("h_c", "nm", "contact.h_c", 1e9, 1),
    ("lambda", "", "contact.lambda_ratio", 1.0, 3),
    ("tribofilm 1", "nm", "contact.tribofilm_1", 1e9, 1),
    ("tribofilm 2", "nm", "contact.tribofilm_2", 1e9, 1),
    ("wear 1", "nm", "contact.wear_depth_1", 1e9, 1),
    ("wear 2", "nm", "contact.wear_depth_2", 1e9, 1),
    ("rough 1", "nm", "contact.roughness_1", 1e9, 1),
    ("rough 2", "nm", "contact.roughness_2", 1e9, 1),
    ("loss", "W", "contact.power_loss", 1.0, 3),
)

LEGEND = {
    "h_c": "mean film over the inner 2/3 of the contact",
    "lambda": "h_c / present roughness, not that of handbooks",
    "tribofilm, wear": "means over the track of ball 1 and disc 2",
    "rough": "rms roughness of ball 1 and disc 2",
    "loss": "heat of friction",
    "+-": "error (95 %)",
}
_BLUE, _RED, _GREEN, _BLACK = "#0072B2", "#D55E00", "#009E73", "#000000"  # of Okabe and Ito
_Line = tuple[str, str, str]  # variable, legend, colour


def _bodies(name: str) -> tuple[_Line, _Line]:
    return (f"contact.{name}_1", "ball", _BLUE), (f"contact.{name}_2", "disc", _RED)


# label, factor from SI, lines
_PANELS: tuple[tuple[str, float, tuple[_Line, ...]], ...] = (
    ("friction coefficient", 1.0, (("contact.friction_coefficient", "", _BLACK),)),
    ("mean tribofilm [nm]", 1e9, _bodies("tribofilm")),
    ("central film\nthickness $h_c$ [nm]", 1e9, (("contact.h_c", "", _BLACK),)),
    ("mean wear depth [nm]", 1e9, _bodies("wear_depth")),
    (r"lambda ratio $\lambda$", 1.0, (("contact.lambda_ratio", "", _BLACK),)),
    ("roughness Rq [nm]", 1e9, _bodies("roughness")),
)


@dataclass(frozen=True)
class Hold:
    """A stretch of the duty with held speeds: times [s], speed of entrainment [m/s], slide-to-roll ratio."""

    start: float
    end: float
    entrainment_speed: float
    slide_roll_ratio: float


@dataclass(frozen=True)
class Sweep:
    """Speeds that rise or fall from hold to hold at one slide-to-roll ratio: a Stribeck curve.

    rubbed [s]: how long the contact has been run before, other sweeps not counted; rows: of the dataset, where each
    hold ends.
    """

    rubbed: float
    holds: tuple[Hold, ...]
    rows: tuple[int, ...]


def holds(assembly: Assembly, end: float) -> list[Hold]:
    """Return the stretches of the duty up to `end` [s]."""
    ball, disc = (assembly.schedule[f"{name}.surface_speed_setpoint"] for name in ("ball", "disc"))
    starts = [time for time, _ in ball if time < end * (1.0 - _SAME)]
    found = []
    for (start, stop), (_, first), (_, second) in zip(pairwise([*starts, end]), ball, disc, strict=False):
        mean = 0.5 * (float(first) + float(second))
        ratio = (float(first) - float(second)) / mean if mean else math.nan
        found.append(Hold(start, stop, abs(mean), ratio))
    return found


def sweeps(assembly: Assembly, dataset: xr.Dataset) -> list[Sweep]:
    """Return the Stribeck curves of a duty."""
    times = dataset["time"].values
    found, taken = [], 0.0
    for run in _monotone(holds(assembly, float(times[-1]))):
        rows = tuple(int(np.searchsorted(times, hold.end * (1.0 - _SAME))) for hold in run)
        found.append(Sweep(run[0].start - taken, tuple(run), rows))
        taken += run[-1].end - run[0].start
    return found


def _monotone(every: list[Hold]) -> Iterator[list[Hold]]:
    """Yield longest runs of holds whose speed only rises, or only falls, at one slide-to-roll ratio."""
    run: list[Hold] = []
    for hold in every:
        if run and not _goes_on(run, hold):
            if len(run) >= _LEAST:
                yield run
                run = []
            else:
                run = run[-1:] if _goes_on(run[-1:], hold) else []
        run.append(hold)
    if len(run) >= _LEAST:
        yield run


def _goes_on(run: list[Hold], hold: Hold) -> bool:
    last, step = run[-1], hold.entrainment_speed - run[-1].entrainment_speed
    rises = step if len(run) < 2 else step * (last.entrainment_speed - run[-2].entrainment_speed)
    same = math.isclose(hold.slide_roll_ratio, last.slide_roll_ratio, rel_tol=_SAME)
    return same and (step != 0.0 if len(run) < 2 else rises > 0.0) and min(hold.entrainment_speed, 1.0) > 0.0


def lines(assembly: Assembly, dataset: xr.Dataset) -> list[str]:
    """Return tables and sentences."""
    found = sweeps(assembly, dataset)
    return [*_table(dataset, found), "", *(_curves(dataset, found) if found else ()), *_energy(assembly, dataset)]


def _rubbing(dataset: xr.Dataset, found: list[Sweep]) -> NDArray[np.bool_]:
    """Return True for rows that are in no sweep."""
    times = dataset["time"].values
    within = [(sweep.holds[0].start < times) & (times <= sweep.holds[-1].end) for sweep in found]
    rubbing = ~np.logical_or.reduce(within) if within else np.ones(len(times), dtype=bool)
    return rubbing if rubbing.sum() > 1 else np.ones(len(times), dtype=bool)


def _table(dataset: xr.Dataset, found: list[Sweep]) -> list[str]:
    """Return about ten rows outside of sweeps, denser early on."""
    times, usable = dataset["time"].values, np.flatnonzero(_rubbing(dataset, found))
    wanted = times[usable[0]] + np.array(_SHARES) * (times[usable[-1]] - times[usable[0]])
    rows = sorted({int(usable[np.abs(times[usable] - time).argmin()]) for time in wanted})
    heads = [
        ["time", *(heading for heading, *_ in _COLUMNS), "oil"],
        ["min", *(unit for _, unit, *_ in _COLUMNS), "degC"],
    ]
    body = [
        [
            f"{times[row] / 60.0:.2f}",
            *(_told(dataset, name, row, factor, digits) for _, _, name, factor, digits in _COLUMNS),
            f"{dataset['bath.temperature_oil'].values[row] - _ZERO:.2f}",
        ]
        for row in rows
    ]
    return aligned([*heads, *body], 0)


def _told(dataset: xr.Dataset, name: str, row: int, factor: float, digits: int) -> str:
    """Return a value as text, with the half width of its error where one is stated."""
    value, half = factor * float(dataset[name].values[row]), dataset.variables.get(f"{name}{ERROR}")
    if half is None:
        return f"{value:.{digits}f}"
    return cell(name.rpartition(".")[2], value, factor * float(half.values[row]), digits)


def _curves(dataset: xr.Dataset, found: list[Sweep]) -> Iterator[str]:
    """Yield friction by speed and rubbing time."""
    yield "Friction in the sweeps, by speed of entrainment and time of rubbing before:"
    speeds = sorted({hold.entrainment_speed for sweep in found for hold in sweep.holds}, reverse=True)
    friction = dataset["contact.friction_coefficient"].values
    values = [{h.entrainment_speed: friction[row] for h, row in zip(s.holds, s.rows, strict=True)} for s in found]
    rows = [[f"{u:.4g} m/s", *(f"{by[u]:.4f}" if u in by else "-" for by in values)] for u in speeds]
    yield from aligned([["", *(f"{sweep.rubbed / 60.0:.4g} min" for sweep in found)], *rows], 0)
    yield ""


def _energy(assembly: Assembly, dataset: xr.Dataset) -> Iterator[str]:
    """Yield the balance of heat of the bath, and the work of the motors that is not in it."""
    size = dataset["master.step_size"].values
    friction = float(size @ dataset["contact.power_loss"].values)
    heaters = [str(name) for name in dataset.data_vars if str(name).startswith("bath.heater_energy_")]
    heating = sum(float(dataset[name].values[-1]) for name in heaters)
    lost = float(dataset["bath.energy_to_ambient"].values[-1])
    stored = heat_stored(assembly, dataset, "bath")
    missing = friction + heating - lost - stored
    yield (
        f"Energy of the bath: {friction / 1e3:.3f} kJ from friction and {heating / 1e3:.3f} kJ from heaters, "
        f"{lost / 1e3:.3f} kJ to the surroundings, {stored / 1e3:.3f} kJ stored; {missing:+.2g} J are missing, "
        f"{abs(missing) / friction if friction else 0.0:.2g} of the heat of friction."
    )
    speeds = np.abs(dataset["ball.surface_speed"].values + dataset["disc.surface_speed"].values)
    rolling = float(size @ (dataset["contact.rolling_resistance"].values * speeds))
    yield (
        f"Resistance to rolling takes {rolling / 1e3:.3f} kJ more from the motors; it acts in the oil at the inlet and "
        "is left out of the heat of the bath."
    )


def write(assembly: Assembly, dataset: xr.Dataset, folder: Path) -> list[Path]:
    """Draw overview.png into the folder."""
    path = folder / "overview.png"
    overview(assembly, dataset).savefig(path, dpi=150)
    return [path]


def overview(assembly: Assembly, dataset: xr.Dataset) -> "Figure":
    """Return the run against time with its sweeps shaded, and the Stribeck curves above; invalid rows are darker."""
    from matplotlib.figure import Figure

    found = sweeps(assembly, dataset)
    rows, above = len(_PANELS) // 2 + 1, 1 if found else 0
    figure = Figure(figsize=(10.0, 2.2 * rows + 3.6 * above + 0.5), layout="constrained")
    grid = figure.add_gridspec(rows + above, 2, height_ratios=[1.7] * above + [1.0] * rows)
    if found:
        _draw_curves([figure.add_subplot(grid[0, column]) for column in (0, 1)], dataset, found)
    axes: list[Axes] = []
    for n in range(2 * rows):
        axes.append(figure.add_subplot(grid[n // 2 + above, n % 2], sharex=axes[0] if axes else None))
    for axis, (label, factor, drawn) in zip(axes, _PANELS, strict=False):
        for name, legend, colour in drawn:
            values = factor * dataset[name].values
            _line(axis, dataset, values, legend, colour)
            if f"{name}{ERROR}" in dataset.coords:
                half, minutes = factor * dataset[f"{name}{ERROR}"].values, dataset["time"].values / 60.0
                axis.fill_between(minutes, values - half, values + half, color=colour, alpha=0.2, linewidth=0.0)
        axis.set_ylabel(label)
        axis.set_ylim(bottom=0.0)
    _draw_temperatures(axes[-2], dataset)
    _draw_speeds(axes[-1], dataset)
    for axis in axes:
        _finish(axis, dataset, found)
    for axis in axes[:-2]:
        axis.tick_params(labelbottom=False)
    for axis in axes[-2:]:
        axis.set_xlabel("time [min]")
    figure.align_ylabels()
    figure.suptitle(dataset.attrs.get("title", ""), fontsize="medium", parse_math=False)
    return figure


def _line(axis: "Axes", dataset: xr.Dataset, values: NDArray[np.float64], legend: str, colour: str) -> None:
    axis.plot(dataset["time"].values / 60.0, values, color=colour, linewidth=1.2, label=legend)


def _draw_temperatures(axis: "Axes", dataset: xr.Dataset) -> None:
    names = [str(name) for name in dataset.data_vars if str(name).startswith("bath.temperature_")]
    for name, colour in zip(names, (_BLACK, _BLUE, _RED, _GREEN), strict=False):
        _line(axis, dataset, dataset[name].values - _ZERO, name.removeprefix("bath.temperature_"), colour)
    axis.set_ylabel("temperature [°C]")


def _draw_speeds(axis: "Axes", dataset: xr.Dataset) -> None:
    """Draw speeds on a logarithmic scale, the load on the right."""
    first, second = dataset["ball.surface_speed"].values, dataset["disc.surface_speed"].values
    _line(axis, dataset, 0.5 * np.abs(first + second), "entrainment", _BLUE)
    _line(axis, dataset, np.abs(first - second), "sliding", _RED)
    axis.set_yscale("log")
    axis.set_ylabel("speed [m/s]")
    right = axis.twinx()
    _line(right, dataset, dataset["arm.load"].values, "", "0.5")
    right.set_ylim(0.0, 1.25 * max(float(dataset["arm.load"].max()), 1e-3))
    right.set_ylabel("load [N]", color="0.4")
    right.tick_params(colors="0.4")
    right.spines["top"].set_visible(False)


def _finish(axis: "Axes", dataset: xr.Dataset, found: list[Sweep]) -> None:
    """Draw legend, limits, sweeps in light and invalid rows in dark grey."""
    minutes = dataset["time"].values / 60.0
    for sweep in found:
        axis.axvspan(sweep.holds[0].start / 60.0, sweep.holds[-1].end / 60.0, color="0.92", linewidth=0.0, zorder=0)
    for start, end, valid in zip(minutes[:-1], minutes[1:], dataset["contact.valid"].values[1:], strict=True):
        if not valid:
            axis.axvspan(start, end, color="0.7", linewidth=0.0, zorder=0)
    if len(axis.lines) > 1:
        axis.legend(frameon=False, fontsize="small", ncols=2, loc="lower right", bbox_to_anchor=(1.0, 0.97))
    axis.set_xlim(minutes[0], minutes[-1])
    axis.spines["top"].set_visible(False)
    axis.spines["right"].set_visible(False)


def _draw_curves(axes: "list[Axes]", dataset: xr.Dataset, found: list[Sweep]) -> None:
    """Draw friction and lambda ratio over speed, by rubbing time."""
    from matplotlib import colormaps

    colours = colormaps["viridis"](np.linspace(0.0, 0.9, len(found)))
    rows = (
        ("contact.friction_coefficient", "friction coefficient"),
        ("contact.lambda_ratio", r"lambda ratio $\lambda$"),
    )
    for axis, (name, label) in zip(axes, rows, strict=True):
        for sweep, colour in zip(found, colours, strict=True):
            speeds, values = [hold.entrainment_speed for hold in sweep.holds], dataset[name].values[list(sweep.rows)]
            axis.plot(
                speeds, values, "o-", color=colour, markersize=3.5, linewidth=1.4, label=f"{sweep.rubbed / 60:.4g}"
            )
        axis.set_xscale("log")
        axis.set_xlabel("entrainment speed [m/s]")
        axis.set_ylabel(label)
        axis.set_ylim(bottom=0.0)
        axis.spines[["top", "right"]].set_visible(False)
    ratio = 100.0 * found[0].holds[0].slide_roll_ratio
    axes[0].legend(title="rubbed [min]", frameon=False, fontsize="small")
    axes[0].set_title(f"Stribeck curves of the duty, slide-to-roll ratio {ratio:.3g} %", loc="left", fontsize="medium")
