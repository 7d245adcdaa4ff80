"""The report of a rig's run: tables, the Stribeck curves of its duty, the bath's energy, one picture."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import xarray as xr

from contact_core.kernels.arrays import Mask
from contact_core.quantities import CELSIUS

from ...charts.chart import BLACK, BLUE, GREEN, GREY, RED, Chart, Line, Sheet, shades, spans_of
from ...charts.half_widths import Column
from ...charts.units import Unit, time_unit
from ...run.cosim_report import aligned
from ...run.panels import FILM, FRICTION, LAMBDA, ROUGHNESS, TRIBOFILM, WEAR, chart
from ...store.results import half_width
from ..assembly import Assembly
from ..report import heat_stored

_SHARES = (0.0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0)  # of the run: running-in is early
_LEAST = 4  # speeds of a curve
_SAME = 1e-9  # relative, of times and slide-to-roll ratios

_COLUMNS = (
    Column("friction", "", "contact.friction_coefficient", 1.0, 4),
    Column("h_c", "nm", "contact.h_c", 1e9, 1),
    Column("lambda", "", "contact.lambda_ratio", 1.0, 3),
    Column("tribofilm 1", "nm", "contact.tribofilm_1", 1e9, 1),
    Column("tribofilm 2", "nm", "contact.tribofilm_2", 1e9, 1),
    Column("wear 1", "nm", "contact.wear_depth_1", 1e9, 1),
    Column("wear 2", "nm", "contact.wear_depth_2", 1e9, 1),
    Column("rough 1", "nm", "contact.roughness_1", 1e9, 1),
    Column("rough 2", "nm", "contact.roughness_2", 1e9, 1),
    Column("loss", "W", "contact.power_loss", 1.0, 3),
)

LEGEND = {
    "h_c": "mean film over the inner 2/3 of the contact",
    "lambda": "h_c / present roughness, not that of handbooks",
    "tribofilm, wear": "means over the track of ball 1 and disc 2",
    "rough": "rms roughness of ball 1 and disc 2",
    "loss": "heat of friction",
    "+-": "error (95 %)",
}
_PANELS = (FRICTION, TRIBOFILM, FILM, WEAR, LAMBDA, ROUGHNESS)


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


def _rubbing(dataset: xr.Dataset, found: list[Sweep]) -> Mask:
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
    columns = [["time", "min", *(f"{time / 60.0:.2f}" for time in times[rows])]]
    for each in _COLUMNS:
        half = half_width(dataset, each.name)
        cells = each.cells(dataset[each.name].values[rows], None if half is None else half[rows])
        columns.append([each.heading, each.unit, *cells])
    oil = dataset["bath.temperature_oil"].values[rows] - CELSIUS
    columns.append(["oil", "degC", *(f"{value:.2f}" for value in oil)])
    return aligned([list(row) for row in zip(*columns, strict=True)], 0)


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


def pictures(assembly: Assembly, dataset: xr.Dataset) -> dict[str, Sheet]:
    return {"overview": overview(assembly, dataset)}


def overview(assembly: Assembly, dataset: xr.Dataset) -> Sheet:
    """Return the run against time with its sweeps shaded, and the Stribeck curves above; invalid rows are darker."""
    found, time = sweeps(assembly, dataset), dataset["time"].values
    clock, invalid = time_unit(float(time[-1])), spans_of(time, ~dataset["contact.valid"].values.astype(bool))
    ends = [(sweep.holds[0].start, sweep.holds[-1].end) for sweep in found]
    shaded = [(float(clock.of(start)), float(clock.of(end))) for start, end in ends]
    charts = []
    for panel in _PANELS:
        named = panel._replace(labels=("ball", "disc")[: len(panel.quantities)])
        charts.append(chart(dataset, named, [f"contact.{name}" for name in panel.quantities], invalid))
    charts += [_temperatures(dataset, clock), _speeds(dataset, clock)]
    charts = [replace(each, shaded=shaded, dark=charts[0].dark) for each in charts]
    above = list(_draw_curves(dataset, found)) if found else []
    heights = [3.8] * (len(above) // 2) + [2.3] * (len(charts) // 2)
    return Sheet([*above, *charts], dataset.attrs.get("title", ""), heights=heights)


def _temperatures(dataset: xr.Dataset, clock: Unit) -> Chart:
    names = [str(name) for name in dataset.data_vars if str(name).startswith("bath.temperature_")]
    lines = [
        Line(
            name.removeprefix("bath.temperature_"), clock.of(dataset["time"].values), dataset[name].values - CELSIUS,
            colour=colour,
        )
        for name, colour in zip(names, (BLACK, BLUE, RED, GREEN), strict=False)
    ]  # fmt: skip
    return Chart("Temperatures", f"time {clock.label}", "temperature [°C]", lines, from_zero=False)


def _speeds(dataset: xr.Dataset, clock: Unit) -> Chart:
    """Return speeds on a logarithmic scale, the load on the right."""
    first, second = dataset["ball.surface_speed"].values, dataset["disc.surface_speed"].values
    time = clock.of(dataset["time"].values)
    lines = [
        Line("entrainment", time, 0.5 * np.abs(first + second)),
        Line("sliding", time, np.abs(first - second), place=1),
        Line("load", time, dataset["arm.load"].values, colour=GREY, right=True),
    ]
    return Chart("Speeds", f"time {clock.label}", "speed [m/s]", lines, logarithmic=True, right_label="load [N]")


def _draw_curves(dataset: xr.Dataset, found: list[Sweep]) -> Iterator[Chart]:
    """Yield friction and lambda ratio over speed, by rubbing time."""
    title = f"Stribeck curves of the duty, slide-to-roll ratio {100.0 * found[0].holds[0].slide_roll_ratio:.3g} %"
    for panel, words in ((FRICTION, title), (LAMBDA, LAMBDA.title)):
        values, lines = dataset[f"contact.{panel.quantities[0]}"].values, []
        for sweep, colour in zip(found, shades(len(found)), strict=True):
            speeds = np.array([hold.entrainment_speed for hold in sweep.holds])
            label = f"{sweep.rubbed / 60:.4g}" if panel is FRICTION else ""
            lines.append(Line(label, speeds, values[list(sweep.rows)], colour=colour, style="o-"))
        key = "rubbed [min]" if panel is FRICTION else ""
        yield Chart(words, "entrainment speed [m/s]", f"{panel.symbol} [–]", lines, logarithmic_x=True, key=key)
