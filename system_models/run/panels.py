"""Which quantities of a contact are drawn, in which words; both bodies in one chart."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from contact_core.kernels.arrays import Array
from contact_core.quantities import TABLE

from ..charts.chart import Chart, Line, Spans
from ..charts.units import Unit, negligible, time_unit, unit_for
from ..store.results import ERROR, half_width

_ALL = slice(None)
_CAPPED = 999.0  # lambda ratios from here on are at their cap, which says nothing


class Panel(NamedTuple):
    """A chart of a contact: quantities of one unit."""

    title: str
    quantities: tuple[str, ...]
    labels: tuple[str, ...]
    symbol: str  # on the axis
    caption: str
    downward: bool = False
    share: bool = False  # from 0 to 1: an error relative to it says little


def _bodies(title: str, name: str, symbol: str, caption: str, downward: bool = False) -> Panel:
    return Panel(title, (f"{name}_1", f"{name}_2"), ("body 1", "body 2"), symbol, caption, downward)


FRICTION = Panel("Friction coefficient", ("friction_coefficient",), ("µ",), "µ", "Friction force over load.")
LAMBDA = Panel(
    "Lambda ratio", ("lambda_ratio",), ("λ",), "λ",
    "Film thickness over composite roughness of the rough, deformed contact. Limits of handbooks hold for the "
    "lambda of smooth surfaces, not for this one.",
)  # fmt: skip
FILM = Panel(
    "Central film thickness", ("h_c",), ("h_c",), "h_c",
    "Mean gap over the inner two thirds of the Hertz contact, solids included where they touch.",
)  # fmt: skip
TRIBOFILM = _bodies("Tribofilm", "tribofilm", "thickness", "Mean thickness over the wear track of each body.")
WEAR = _bodies("Wear depth", "wear_depth", "depth", "Mean depth over the wear track; the axis runs down.", True)
ROUGHNESS = _bodies("Roughness", "roughness", "Rq", "Root mean square roughness across the middle of the track.")
PRESSURE = Panel("Largest pressure", ("pressure_max",), ("p_max",), "p_max", "At a single node of the grid.")
MAIN = (
    FRICTION,
    FILM,
    LAMBDA,
    Panel(
        "Load carried by solids", ("contact_load_ratio",), ("W_c",), "W_c",
        "Share of the load that touching asperities carry: 0 is a full film, 1 is dry.", share=True,
    ),
    TRIBOFILM,
    WEAR,
)  # fmt: skip
MORE = (
    Panel("Real contact area", ("contact_area_ratio",), ("A_c",), "A_c", "Touching area over the Hertz area."),
    ROUGHNESS,
    PRESSURE,
    _bodies("Bulk temperature", "temperature", "temperature", "Of the bodies away from the contact."),
    Panel(
        "Flash temperature rise", ("flash_temperature_rise",), ("rise",), "rise",
        "Mean rise in the real contact above the bodies.",
    ),
    Panel("Power loss", ("power_loss",), ("P",), "P", "Heat that friction makes."),
    Panel(
        "Scuffing ratio", ("scuffing_ratio",), ("S",), "S",
        "Rise of the hottest spots over the rise at which scuffing is expected; above 1 there is a risk.",
    ),
    _bodies("Fatigue damage", "damage", "damage", "The material fails at 1."),
    _bodies("Micropitted share of the track", "micropitted_area", "share", "Area that fatigue has broken out."),
    Panel("Largest von Mises stress", ("von_mises_max",), ("stress",), "stress", "Below the surfaces."),
    _bodies("Oxide", "oxide", "thickness", "Where no tribofilm covers the steel."),
)  # fmt: skip
DUTY = (
    Panel("Load", ("load",), ("load",), "load", "As prescribed."),
    Panel("Surface speeds", ("speed_1", "speed_2"), ("body 1", "body 2"), "speed", "Relative to the contact."),
    Panel("Oil temperature", ("temperature",), ("temperature",), "temperature", "As prescribed."),
)


def charts(dataset: xr.Dataset, panels: Sequence[Panel], contact: str, invalid: Spans) -> Iterator[Chart]:
    """Yield the charts of a contact that have anything to show; what is zero throughout is left out."""
    for panel in panels:
        names = [f"{contact}.{name}" if contact else name for name in panel.quantities]
        there = [name for name in names if name in dataset]
        some = any(np.nanmax(np.abs(values(dataset, name)), initial=0.0) > 0.0 for name in there)
        if some and _changes(dataset, there):
            yield chart(dataset, panel, there, invalid)


def constants(dataset: xr.Dataset, panels: tuple[Panel, ...]) -> Iterator[str]:
    """Yield the quantities of a contact that do not change and are not zero, with their values, in words."""
    for panel in panels:
        for name, label in zip(panel.quantities, panel.labels, strict=True):
            if name not in dataset or _changes(dataset, [name]) or not values(dataset, name)[-1]:
                continue
            unit = unit_of([(dataset, name)], name)
            if negligible(float(unit.of(values(dataset, name)[-1]))):
                continue
            who = f" of {label}" if len(panel.quantities) > 1 else ""
            yield f"{panel.title.lower()}{who} = {float(unit.of(values(dataset, name)[-1])):.4g} {unit.name}".rstrip()


def _changes(dataset: xr.Dataset, names: list[str]) -> bool:
    """Return True if a variable changes, or has an error band, along a result of some rows."""
    return any(
        dataset.sizes["time"] < 2
        or np.ptp(dataset.variables[name].values) > 0.0
        or f"{name}{ERROR}" in dataset.variables
        for name in names
    )


def chart(dataset: xr.Dataset, panel: Panel, names: Sequence[str], invalid: Spans = ()) -> Chart:
    """Return one chart against time, with the bands that the result has; `invalid` are spans of time [s]."""
    columns = [(label, dataset, name, k) for k, (name, label) in enumerate(zip(names, panel.labels, strict=False))]
    return overlaid(panel, panel.title, panel.quantities[0], columns, invalid)


def overlaid(
    panel: Panel, title: str, quantity: str, columns: Sequence[tuple[str, xr.Dataset, str, int]], invalid: Spans = ()
) -> Chart:
    """Return a chart of variables of any results: label, result, variable and place in the palette of each."""
    clock = time_unit(max(float(dataset.variables["time"].values[-1]) for _, dataset, _, _ in columns))
    unit = unit_of([(dataset, name) for _, dataset, name, _ in columns], quantity)
    lines = [
        Line(
            label, clock.of(dataset.variables["time"].values), unit.of(values(dataset, name)),
            band(dataset, name, unit), place,
        )
        for label, dataset, name, place in columns
    ]  # fmt: skip
    return Chart(
        title, f"time {clock.label}", f"{panel.symbol} {unit.label}", lines, panel.caption,
        from_zero=unit.offset == 0.0, downward=panel.downward, most=1.0 if panel.share else None,
        dark=[(float(clock.of(begin)), float(clock.of(end))) for begin, end in invalid],
    )  # fmt: skip


def apart(panel: Panel) -> Iterator[tuple[str, str]]:
    """Yield the quantities of a panel, each for a chart of its own, with its title."""
    for name, label in zip(panel.quantities, panel.labels, strict=True):
        yield name, f"{panel.title}, {label}" if len(panel.quantities) > 1 else panel.title


def unit_of(columns: Sequence[tuple[xr.Dataset, str]], quantity: str, rows: slice = _ALL) -> Unit:
    """Return the unit in which variables of the same quantity are read, by some of their rows."""
    largest = np.concatenate([values(dataset, name)[rows] for dataset, name in columns])
    dataset, name = columns[0]
    difference = TABLE[quantity].relative if quantity in TABLE else "rise" in quantity
    return unit_for(dataset.variables[name].attrs.get("units", "1"), largest, difference)


def values(dataset: xr.Dataset, name: str) -> Array:
    """Return a variable against time in SI; lambda ratios at their cap are not known."""
    found = np.asarray(dataset.variables[name].values, dtype=float)
    return np.where(found > _CAPPED, np.nan, found) if name.endswith("lambda_ratio") else found


def band(dataset: xr.Dataset, name: str, unit: Unit) -> Array | None:
    """Return the half width of a variable's band in a unit, if the result has it."""
    half = half_width(dataset, name)
    return None if half is None else unit.factor * half
