"""The report of a simulated system: two tables, closing lines, and one picture."""

import json
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from contact_core.arrays import Array

from ..charts.chart import Chart, Line, Sheet
from ..fmu.printable import printable

_MOST_ROWS, _MOST_PANELS = 20, 20
_WIDEST = 60  # letters of a title: a longer one leaves no room for its panel
_SAME = 0.99  # steps that differ by less need no picture


def recorded(dataset: xr.Dataset) -> list[str]:
    """Return the variables that the FMUs have given, and the power residuals; the others describe the master."""
    return [str(name) for name in dataset.data_vars if not str(name).startswith("master.")]


def table(dataset: xr.Dataset) -> str:
    """Return the range of each recorded variable."""
    names = recorded(dataset)
    rows = [["output", "unit", "start", "smallest", "largest", "end"]]
    for name in names[:_MOST_ROWS]:
        values = dataset[name].values
        rows.append([name, dataset[name].attrs["units"], *map(_short, _range(values))])
    more = [f"... and {len(names) - _MOST_ROWS} more, in the files."] if len(names) > _MOST_ROWS else []
    return "\n".join([*aligned(rows, 2), *more])


def _range(values: NDArray[Any]) -> tuple[Any, ...]:
    text = values.dtype.kind in "UO"
    return values[0], "" if text else values.min(), "" if text else values.max(), values[-1]


def _short(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, (float, int)) and not isinstance(value, bool) else str(value)


def costs(dataset: xr.Dataset) -> str:
    """Return steps and time of each FMU."""
    cost = json.loads(dataset.attrs["cost"])
    total = sum(entry["seconds"] for entry in cost.values())
    rows = [["FMU", "steps", "us per step", "s", "share"]]
    for name, entry in cost.items():
        steps, seconds = entry["steps"], entry["seconds"]
        share = 100.0 * seconds / total if total else 0.0
        rows.append([name, str(steps), f"{1e6 * seconds / max(steps, 1):.1f}", f"{seconds:.3g}", f"{share:.0f} %"])
    return "\n".join(aligned(rows, 1))


def aligned(rows: list[list[str]], left: int) -> list[str]:
    """Return rows of a table; the first `left` columns are words."""
    columns = list(zip(*([printable(cell) for cell in row] for row in rows), strict=True))
    widths = [max(map(len, column)) for column in columns]
    padded = [
        [cell.ljust(width) if n < left else cell.rjust(width) for cell in column]
        for n, (column, width) in enumerate(zip(columns, widths, strict=True))
    ]
    return ["  ".join(line).rstrip() for line in zip(*padded, strict=True)]


def unreliable_steps(dataset: xr.Dataset) -> int:
    """Return the number of steps whose iteration has not converged or whose error was larger than allowed."""
    return int(dataset.attrs["unconverged"]) + int(dataset.attrs["below_min_step"])


def validity(dataset: xr.Dataset) -> list[str]:
    """Return a warning if FMUs could not use their inputs in some rows."""
    counts = dataset.attrs
    if not counts["invalid"]:
        return []
    line = (
        f"WARNING: {counts['invalid']} of {dataset.sizes['time']} rows are INVALID: {counts['invalid_by']} could not "
        "use the inputs and kept the outputs from before. Column `valid` says in which rows. "
        f"{counts.get('invalid_why', '')}".strip()
    )
    return [printable(line)]


def closing_lines(dataset: xr.Dataset) -> list[str]:
    """Return steps, iterations, events, power residuals and warnings, in sentences."""
    lines = [_steps(dataset), *_iterations(dataset), *_events(dataset), *_bonds(dataset), *_warnings(dataset)]
    return [printable(line) for line in lines]


def _steps(dataset: xr.Dataset) -> str:
    counts = dataset.attrs
    sizes = dataset["master.step_size"].values[1:]
    line = f"Steps: {counts['steps']} to {float(dataset['time'].values[-1]):g} s"
    if len(sizes):
        line += f", of {sizes.min():.3g} s" + (f" to {sizes.max():.3g} s" if _varies(sizes) else "")
    return f"{line}; {counts['rejected']} rejected, {counts['stopped_early']} stopped early by an FMU."


def _varies(sizes: Array) -> bool:
    return bool(sizes.min() < _SAME * sizes.max())


def _iterations(dataset: xr.Dataset) -> list[str]:
    passes = dataset["master.iterations"].values[1:]
    if not len(passes) or passes.max() <= 1:
        return []
    return [f"Iterations: {passes.mean():.1f} in a step on average, {passes.max():.0f} at most."]


def _events(dataset: xr.Dataset) -> list[str]:
    count = dataset.attrs["events"]
    return [f"Events: {count}."] if count else []


def _bonds(dataset: xr.Dataset) -> list[str]:
    bonds = [name for name in recorded(dataset) if name.startswith("bond.")]
    return [
        f"Power residual at {name.removeprefix('bond.')}: "
        f"{float(np.abs(dataset[name]).max()):.3g} W at most, {float(np.abs(dataset[name]).mean()):.3g} W on average."
        for name in bonds
    ]


def _warnings(dataset: xr.Dataset) -> list[str]:
    counts, lines = dataset.attrs, []
    if counts["unconverged"]:
        lines.append(
            f"WARNING: in {counts['unconverged']} steps the iteration did NOT CONVERGE, the first to "
            f"{_first(dataset, 'master.residual')}. Take smaller steps, or another iteration."
        )
    if counts["below_min_step"]:
        lines.append(
            f"WARNING: {counts['below_min_step']} steps of min_step have a LARGER ERROR than the tolerance allows, "
            f"the first to {_first(dataset, 'master.error')}. Allow smaller steps, or iterate."
        )
    if counts["receives_means"]:
        lines.append(
            "These FMUs cannot extrapolate their inputs; they receive the mean over each step: "
            f"{counts['receives_means']}."
        )
    if counts["ended_by"]:
        lines.append(f"The FMU '{counts['ended_by']}' ended the simulation.")
    return lines


def _first(dataset: xr.Dataset, name: str) -> str:
    above = dataset["time"].values[dataset[name].values > 1.0]
    return f"{above[0]:g} s" if len(above) else "the end"


def overview(dataset: xr.Dataset) -> Sheet:
    """Return the recorded variables against time, each in a panel of its own, and the step if it changes."""
    shown = [name for name in recorded(dataset) if dataset[name].dtype.kind in "fiub"]
    names = shown[:_MOST_PANELS]
    sizes = dataset["master.step_size"].values[1:]
    names = [*names, "master.step_size"] if len(sizes) and _varies(sizes) else names
    more = f", {len(shown) - _MOST_PANELS} more in the files" if len(shown) > _MOST_PANELS else ""
    columns = 1 if len(names) <= 3 else 2
    title = f"{_title(dataset.attrs.get('title', ''))}{more}"
    return Sheet([_chart(dataset[name]) for name in names], title, columns, 9.0 / columns, 1.9)


def _title(text: str) -> str:
    """Return a text that fits above a panel: both ends of a long one, by which names and units differ."""
    text, half = printable(text), _WIDEST // 2 - 1
    return text if len(text) <= _WIDEST else f"{text[:half]}...{text[-half:]}"


def _chart(variable: xr.DataArray) -> Chart:
    """Return a Real as a line, any other type and the step in stairs."""
    name, unit, kind = str(variable.name), variable.attrs["units"], variable.dtype.kind
    time, values = variable["time"].values, variable.values.astype(float)
    title = _title(name.removeprefix("master.") + ("" if unit == "1" else f" [{unit}]"))
    if name == "master.step_size":
        line = Line("", time[1:], values[1:], place=4, style="|-")
        return Chart(title, "time [s]", "", [line], logarithmic=True)
    line = Line("", time, values, style="-" if kind == "f" else "-|")
    if kind == "b":
        return Chart(title, "time [s]", "", [line], y_range=(-0.1, 1.1), y_names={0.0: "false", 1.0: "true"})
    return Chart(title, "time [s]", "", [line], from_zero=False)
