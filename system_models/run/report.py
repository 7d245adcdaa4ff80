"""The report of a contact's run: a short table, closing lines, and one picture."""

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from ..store.results import ASSUMED, half_width
from .half_widths import cell

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# heading, unit people read, variable, factor from SI, digits
COLUMNS = (
    ("friction", "", "friction_coefficient", 1.0, 4),
    ("h_c", "nm", "h_c", 1e9, 2),
    ("lambda", "", "lambda_ratio", 1.0, 3),
    ("tribofilm 1", "nm", "tribofilm_1", 1e9, 2),
    ("tribofilm 2", "nm", "tribofilm_2", 1e9, 2),
    ("wear 1", "nm", "wear_depth_1", 1e9, 2),
    ("wear 2", "nm", "wear_depth_2", 1e9, 2),
    ("A_c", "", "contact_area_ratio", 1.0, 3),
    ("W_c", "", "contact_load_ratio", 1.0, 3),
)
_BELOW = (  # outputs of runs with stresses; those of damage where there is any
    ("von Mises", "GPa", "von_mises_max", 1e-9, 3),
    ("at depth", "um", "von_mises_depth", 1e6, 1),
    ("damage 1", "", "damage_1", 1.0, 4),
    ("damage 2", "", "damage_2", 1.0, 4),
    ("pitted 1", "%", "micropitted_area_1", 100.0, 2),
    ("pitted 2", "%", "micropitted_area_2", 100.0, 2),
)
_OFF = {"tribofilm": ("tribofilm_1", "tribofilm_2"), "wear": ("wear_depth_1", "wear_depth_2")}  # columns of a law
_WITH_ERRORS = {  # in the table; of the others the result has them
    "friction_coefficient", "h_c", "tribofilm_1", "tribofilm_2", "wear_depth_1", "wear_depth_2", "contact_load_ratio"
}  # fmt: skip
_SHARES = (0.0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0)  # of the run: running-in is early
_FEW_ROWS = 12
_DIGITS, _MOST_DIGITS = 2, 6  # of the time [min]
_WARM = 0.05  # K: bodies warmer than the oil by more are worth a line

_BLUE, _RED, _BLACK = "#0072B2", "#D55E00", "#000000"  # of Okabe and Ito: which the colour-blind can tell apart
_Line = tuple[str, str, str]  # variable, legend, colour


def _bodies(name: str) -> tuple[_Line, _Line]:
    return (f"{name}_1", "body 1", _BLUE), (f"{name}_2", "body 2", _RED)


# label, factor from SI, lines
_PANELS: tuple[tuple[str, float, tuple[_Line, ...]], ...] = (
    ("friction coefficient", 1.0, (("friction_coefficient", "", _BLACK),)),
    ("mean tribofilm thickness [nm]", 1e9, _bodies("tribofilm")),
    ("height [nm]", 1e9, (("h_c", "central film thickness $h_c$", _BLUE), ("sigma", "composite roughness", _RED))),
    ("mean wear depth [nm]", 1e9, _bodies("wear_depth")),
    (r"lambda ratio $\lambda$", 1.0, (("lambda_ratio", "", _BLACK),)),
    ("roughness Rq [nm]", 1e9, _bodies("roughness")),
    (
        "share of the solids",
        1.0,
        (
            ("contact_area_ratio", "area $A_c$", _BLUE),
            ("contact_load_ratio", "load $W_c$", _RED),
        ),
    ),
    ("largest pressure [GPa]", 1e-9, (("pressure_max", "", _BLACK),)),
)


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
        [heading, unit, *_stated(dataset, name, rows, factor, digits)]
        for heading, unit, name, factor, digits in (*COLUMNS, *_below(dataset))
        if name not in left_out
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


def _below(dataset: xr.Dataset) -> list[tuple[str, str, str, float, int]]:
    """Return the columns of stress and damage that are not zero throughout."""
    return [column for column in _BELOW if column[2] in dataset and dataset[column[2]].values.any()]


def _stated(dataset: xr.Dataset, name: str, rows: list[int], factor: float, digits: int) -> list[str]:
    """Return values as text, each with the half width of its error where one is stated."""
    values = factor * dataset[name].values[rows]
    half = half_width(dataset, name) if name in _WITH_ERRORS else None
    if half is None:
        return [f"{value:.{digits}f}" for value in values]
    halves = factor * half[rows]
    texts = [cell(name, value, half, digits) for value, half in zip(values, halves, strict=True)]
    worth = dataset.coords.get(f"{name}{ASSUMED}")
    if worth is None:
        return texts
    return [f"{text} ({factor * each:.2g})" for text, each in zip(texts, worth.values[rows], strict=True)]


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
        f"body {i} at {float(last[f'temperature_{i}']) - 273.15:.1f} degC with {float(last[f'heat_flow_{i}']):.3g} W"
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


def write_overview(dataset: xr.Dataset, path: Path) -> Path:
    """Draw the run into a PNG file and return its path."""
    overview(dataset).savefig(path, dpi=150)
    return path


def overview(dataset: xr.Dataset) -> "Figure":
    """Return the picture of the run against time; invalid rows are shaded."""
    from matplotlib.figure import Figure

    ratio = dataset["lambda_ratio"]
    uncapped = ratio.where((ratio > 0.0) & (ratio < 1e3))  # at its caps it says nothing about the roughness
    shown = dataset.assign(sigma=dataset["h_c"] / uncapped)
    figure = Figure(figsize=(9.0, 10.0), layout="constrained")
    axes = figure.subplots(4, 2, sharex=True)
    for axis, (label, factor, lines) in zip(axes.flat, _PANELS, strict=True):
        _draw(axis, shown, label, factor, tuple(line for line in lines if line[0] in shown))
    for axis in axes[-1]:
        axis.set_xlabel("time [min]")
    figure.align_ylabels()
    figure.suptitle(dataset.attrs.get("title", ""), fontsize="medium", parse_math=False)
    return figure


def _draw(axis: "Axes", dataset: xr.Dataset, label: str, factor: float, lines: tuple[_Line, ...]) -> None:
    minutes = dataset["time"].values / 60.0
    for name, legend, colour in lines:
        values = factor * dataset[name].values
        axis.plot(minutes, values, color=colour, linewidth=1.4, label=legend)
        half = half_width(dataset, name)
        if half is not None:
            low, high = values - factor * half, values + factor * half
            axis.fill_between(minutes, low, high, color=colour, alpha=0.2, linewidth=0.0)
    for start, end, valid in zip(minutes[:-1], minutes[1:], dataset["valid"].values[1:], strict=True):
        if not valid:
            axis.axvspan(start, end, color="0.85", linewidth=0.0)
    if len(lines) > 1:
        axis.legend(frameon=False)
    axis.set_ylabel(label)
    axis.set_xlim(minutes[0], minutes[-1])
    axis.set_ylim(bottom=0.0)
    axis.spines[["top", "right"]].set_visible(False)
