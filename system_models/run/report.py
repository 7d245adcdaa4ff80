"""The report of a contact's run: a short table, closing lines, and one picture."""

import json
import math

import numpy as np
import xarray as xr

from contact_core.quantities import CELSIUS

from ..charts.chart import Sheet, spans_of
from ..charts.half_widths import Column
from ..store.results import ASSUMED, half_width
from .panels import FRICTION, LAMBDA, PRESSURE, ROUGHNESS, TRIBOFILM, WEAR, Panel, chart

COLUMNS = (
    Column("friction", "", "friction_coefficient", 1.0, 4),
    Column("h_c", "nm", "h_c", 1e9, 2),
    Column("lambda", "", "lambda_ratio", 1.0, 3),
    Column("tribofilm 1", "nm", "tribofilm_1", 1e9, 2),
    Column("tribofilm 2", "nm", "tribofilm_2", 1e9, 2),
    Column("wear 1", "nm", "wear_depth_1", 1e9, 2),
    Column("wear 2", "nm", "wear_depth_2", 1e9, 2),
    Column("A_c", "", "contact_area_ratio", 1.0, 3),
    Column("W_c", "", "contact_load_ratio", 1.0, 3),
)
_BELOW = (  # outputs of runs with stresses; those of damage where there is any
    Column("von Mises", "GPa", "von_mises_max", 1e-9, 3),
    Column("at depth", "um", "von_mises_depth", 1e6, 1),
    Column("damage 1", "", "damage_1", 1.0, 4),
    Column("damage 2", "", "damage_2", 1.0, 4),
    Column("pitted 1", "%", "micropitted_area_1", 100.0, 2),
    Column("pitted 2", "%", "micropitted_area_2", 100.0, 2),
)
_OFF = {"tribofilm": ("tribofilm_1", "tribofilm_2"), "wear": ("wear_depth_1", "wear_depth_2")}  # columns of a law
_WITH_ERRORS = {  # in the table; of the others the result has them
    "friction_coefficient", "h_c", "tribofilm_1", "tribofilm_2", "wear_depth_1", "wear_depth_2", "contact_load_ratio"
}  # fmt: skip
_SHARES = (0.0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0)  # of the run: running-in is early
_FEW_ROWS = 12
_DIGITS, _MOST_DIGITS = 2, 6  # of the time [min]
_WARM = 0.05  # K: bodies warmer than the oil by more are worth a line

_FILM = Panel("Height", ("h_c", "sigma"), ("central film thickness h_c", "composite roughness"), "height", "")
_SOLIDS = Panel(
    "Share of the solids",
    ("contact_area_ratio", "contact_load_ratio"),
    ("area A_c", "load W_c"),
    "share",
    "",
    share=True,
)
_PANELS = (FRICTION, TRIBOFILM, _FILM, WEAR, LAMBDA, ROUGHNESS, _SOLIDS, PRESSURE)


def table(dataset: xr.Dataset, width: float = math.inf) -> str:
    """Return about ten rows of the run as text, denser early on; all rows if they are few.

    Columns that do not fit into a line of `width` characters follow below, each time with the time.
    """
    time = dataset["time"].values
    rows = list(range(len(time)))
    if len(time) > _FEW_ROWS:
        rows = sorted({int(np.abs(time - share * time[-1]).argmin()) for share in _SHARES})
    left_out = {name for law in _off(dataset) for name in _OFF[law]}
    columns = [["time", "min", *_apart(time[rows] / 60.0)]]
    columns += [
        [each.heading, each.unit, *_stated(dataset, each, rows)]
        for each in (*COLUMNS, *_below(dataset))
        if each.name not in left_out
    ]
    padded = [[cell.rjust(max(map(len, column))) for cell in column] for column in columns]
    parts = [padded[:1]]
    for column in padded[1:]:
        if len(parts[-1]) > 1 and sum(len(each[0]) + 2 for each in (*parts[-1], column)) > width + 2:
            parts.append(padded[:1])
        parts[-1] = [*parts[-1], column]
    return "\n\n".join("\n".join("  ".join(line) for line in zip(*part, strict=True)) for part in parts)


def _off(dataset: xr.Dataset) -> list[str]:
    """Return the laws with columns in the table that are off in the scene of a run; none if it has no scene."""
    scene = json.loads(dataset.attrs.get("scene_json", "{}"))
    return [law for law in _OFF if scene.get(law, {}).get("model") == "none"]


def _below(dataset: xr.Dataset) -> list[Column]:
    """Return the columns of stress and damage that are not zero throughout."""
    return [each for each in _BELOW if each.name in dataset and dataset[each.name].values.any()]


def _stated(dataset: xr.Dataset, column: Column, rows: list[int]) -> list[str]:
    """Return values as text, each with the half width of its error where one is stated."""
    half = half_width(dataset, column.name) if column.name in _WITH_ERRORS else None
    texts = column.cells(dataset[column.name].values[rows], None if half is None else half[rows])
    worth = dataset.coords.get(f"{column.name}{ASSUMED}") if half is not None else None
    if worth is None:
        return texts
    return [f"{text} ({column.factor * each:.2g})" for text, each in zip(texts, worth.values[rows], strict=True)]


def _apart(minutes: np.ndarray) -> list[str]:
    """Return times as text with two digits, or as many up to six as show different times as different."""
    for digits in range(_DIGITS, _MOST_DIGITS):
        texts = [f"{value:.{digits}f}" for value in minutes]
        if len({*texts}) == len({*minutes}):
            return texts
    return [f"{value:.{_MOST_DIGITS}f}" for value in minutes]


def closing_lines(dataset: xr.Dataset) -> list[str]:
    """Return sentences on load cycles, the pressures that drove the blocks, laws that are off, and warm bodies."""
    last = dataset.isel(time=-1)
    first, second = (f"{int(last[f'load_cycles_{body}']):,}".replace(",", " ") for body in (1, 2))
    cycles = f"Load cycles: {first} of body 1, {second} of body 2."
    off = _off(dataset)
    blocks = _blocks(last) if len(off) < len(_OFF) else []
    return [cycles, *blocks, *([f"Off, and not computed: {', '.join(off)}."] if off else []), *_warmth(dataset)]


def _warmth(dataset: xr.Dataset) -> list[str]:
    """Return temperatures and heat of the bodies at the end, if they are not those of the oil."""
    last, oil = dataset.isel(time=-1), dataset["temperature"]
    if all(float(np.abs(dataset[f"temperature_{body}"] - oil).max()) < _WARM for body in (1, 2)):
        return []
    warm = ", ".join(
        f"body {i} at {float(last[f'temperature_{i}']) - CELSIUS:.1f} degC with {float(last[f'heat_flow_{i}']):.3g} W"
        for i in (1, 2)
    )
    return [f"At the end the bodies take up the heat of friction: {warm}."]


def _blocks(last: xr.Dataset) -> list[str]:
    """Return the shares of the pressures that drove the blocks; the regression level has none."""
    if "blocks_dry" not in last:
        return []
    blocks = {name: int(last[f"blocks_{name}"]) for name in ("dry", "mixed", "fallback")}
    total = sum(blocks.values())
    share = {name: f"{100.0 * count / max(total, 1):.1f} %" for name, count in blocks.items()}
    return [
        "Pressures that drive tribofilm and wear: dry contact in "
        f"{share['dry']} of {total} blocks, mixed lubrication in {share['mixed']}, dry contact in place of a mixed "
        f"solution that failed in {share['fallback']}."
    ]


def invalid_rows(dataset: xr.Dataset) -> int:
    """Return the number of rows that the FMU called invalid."""
    return int((~dataset["valid"].values).sum())


def overview(dataset: xr.Dataset) -> Sheet:
    """Return the picture of the run against time; invalid rows are shaded."""
    ratio = dataset["lambda_ratio"]
    uncapped = ratio.where((ratio > 0.0) & (ratio < 1e3))  # at its caps it says nothing about the roughness
    shown = dataset.assign(sigma=(dataset["h_c"] / uncapped).assign_attrs(units="m"))
    invalid = spans_of(dataset["time"].values, ~dataset["valid"].values)
    there = [(each, [name for name in each.quantities if name in shown]) for each in _PANELS]
    drawn = [chart(shown, each, names, invalid) for each, names in there if names]
    return Sheet(drawn, dataset.attrs.get("title", ""))
