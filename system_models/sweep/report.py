"""The report of a sweep: table of the ends of its runs, which key matters, and one picture."""

import itertools
import textwrap
from collections.abc import Callable, Iterator

import numpy as np
import xarray as xr

from contact_core.scene import Scene
from contact_core.state import RangeFlag

from ..charts.chart import Chart, Line, Sheet
from ..charts.half_widths import SHARES, UNKNOWN, Column, says_nothing, with_error
from ..run.cosim_report import aligned
from ..run.flags import by_how_much
from ..run.report import COLUMNS
from ..store.results import ERROR
from .ensemble import averaged, patches_of
from .plan import Factor, Plan, Point
from .points import ends
from .sensitivity import Indices

OUTPUTS = (  # in tables and pictures
    *("friction_coefficient", "h_c", "contact_load_ratio"),
    *("tribofilm_1", "tribofilm_2", "wear_depth_1", "wear_depth_2"),
)
_MOST_ROWS = 40


def shown(dataset: xr.Dataset) -> list[Column]:
    """Return the columns whose values are not all zero, or not known."""
    last, open_ = ends(dataset), _unknown(dataset)
    return [
        column
        for column in COLUMNS
        if column.name in OUTPUTS and (np.nan_to_num(last[column.name].values).any() or column.heading in open_)
    ]


def table(plan: Plan, dataset: xr.Dataset) -> str:
    """Return the ends of the runs as text: each run, or the spread of each output where there are many."""
    last = ends(dataset)
    flat = last["refused"].values.ravel()
    points = list(plan.points())
    if plan.method == "indices" or len(points) > _MOST_ROWS:
        return _spread(last, dataset)
    columns = [[factor.key, *(point.settings[factor.key] for point in points)] for factor in plan.factors]
    for each in shown(dataset):
        half = last.coords.get(f"{each.name}{ERROR}")
        cells = each.cells(last[each.name].values.ravel(), None if half is None else half.values.ravel())
        columns.append([each.title, *("refused" if why else text for text, why in zip(cells, flat, strict=True))])
    return _aligned(columns)


def _spread(last: xr.Dataset, dataset: xr.Dataset) -> str:
    columns: list[list[str]] = [["output"], ["least"], ["2.5 %"], ["median"], ["97.5 %"], ["largest"]]
    for each in shown(dataset):
        values = last[each.name].values[np.isfinite(last[each.name].values)]
        cells = each.cells(np.quantile(values, (0.0, 0.025, 0.5, 0.975, 1.0)))
        for column, text in zip(columns, [each.title, *cells], strict=True):
            column.append(text)
    return _aligned(columns)


def _aligned(columns: list[list[str]]) -> str:
    return "\n".join(aligned([list(row) for row in zip(*columns, strict=True)], 0))


def lines(plan: Plan, dataset: xr.Dataset, found: list[Indices], scene_of: Callable[[Point], Scene]) -> list[str]:
    """Return sentences on which key matters, on flags, and on points that are refused, invalid or not known.

    `scene_of` returns the scene of a point.
    """
    said = []
    if found:
        said.append("Share of an output's variance that is due to a key (Sobol indices, 95 %): alone; with others.")
        columns = [["output"], ["key"], ["alone"], ["with others"]]
        for each in found:
            texts = [f"{low:.2f} to {high:.2f}" for _, low, high in (each.first, each.total)]
            for column, text in zip(columns, [each.output, each.key, *texts], strict=True):
                column.append(text)
        said.append(_aligned(columns))
    if patches_of(plan):
        said += _means(plan, dataset)
    said += [*_known(dataset), *_flags(plan, dataset, scene_of)]
    reasons = [reason for reason in dataset["refused"].values.ravel() if reason]
    if reasons:
        said.append(f"Refused: {len(reasons)} of {dataset['refused'].size} points. The first: {reasons[0]}")
    return [*said, *_computed(dataset, len(reasons))]


def _flags(plan: Plan, dataset: xr.Dataset, scene_of: Callable[[Point], Scene]) -> Iterator[str]:
    """Yield a sentence for each flag that some run raises, with the quantity and by how much it is beyond in one."""
    points = list(plan.points())
    raised = np.nan_to_num(dataset["range_flags"].values).astype(int).reshape(len(points), -1)
    refused = dataset["refused"].values.ravel() != ""
    for flag in RangeFlag:
        up = (raised & flag) > 0
        if not up.any():
            continue
        worst = int(up.sum(axis=1).argmax())
        number = by_how_much(flag, scene_of(points[worst]), _run(dataset, worst).isel(time=up[worst]))
        where = ", ".join(f"{key}={value}" for key, value in points[worst].settings.items())
        told = f"{number}; {where}" if number else f"such as {where}"
        yield f"Range, {int(up.any(axis=1).sum())} of {int((~refused).sum())} runs: {flag.text} ({told})."


def _run(dataset: xr.Dataset, number: int) -> xr.Dataset:
    """Return a run of a sweep along time; one that is kept at its end has one row."""
    places = [name for name in dataset["refused"].dims]
    flat = dataset.stack(run=places).isel(run=number) if places else dataset
    return flat if "time" in flat.dims else flat.expand_dims("time")


def _computed(dataset: xr.Dataset, refused: int) -> list[str]:
    """Return the verdict: how many runs have invalid rows, or else which outputs have errors that leave all open."""
    rows = dataset["valid"].values.reshape(dataset["refused"].size, -1).all(axis=1)
    runs = rows.size - refused
    bad = int(np.sum(~rows)) - refused
    if bad:
        return [f"Verdict: {bad} of {runs} runs have INVALID rows: their outputs stand there as they were before."]
    open_ = [f" {heading} is {UNKNOWN} in {count} of them." for heading, count in _unknown(dataset).items()]
    return [f"Verdict: all rows of all {runs} runs were computed.{''.join(open_)}"]


def _unknown(dataset: xr.Dataset) -> dict[str, int]:
    """Return by the heading of an output in how many runs its half width at the end says nothing."""
    last, found = ends(dataset), {}
    for heading, _, name, _, _ in COLUMNS:
        if name in OUTPUTS and f"{name}{ERROR}" in last.coords:
            pairs = zip(last[name].values.ravel(), last.coords[f"{name}{ERROR}"].values.ravel(), strict=True)
            found[heading] = sum(says_nothing(name, value, half) for value, half in pairs if np.isfinite(value))
    return {heading: count for heading, count in found.items() if count}


def _means(plan: Plan, dataset: xr.Dataset) -> list[str]:
    """Return a heading and the table of means over patches, a row for each choice of the other keys."""
    keys = patches_of(plan)
    found = averaged(plan, ends(dataset), [column.name for column in shown(dataset)])
    others = [factor for factor in plan.grid if factor.key not in keys]
    counts = found["count"].values.ravel()
    if plan.sampled or counts.size > _MOST_ROWS:
        return []
    rows = list(itertools.product(*(factor.choices for factor in others)))
    columns = [[factor.key, *(row[k] for row in rows)] for k, factor in enumerate(others)]
    for each in shown(dataset):
        mean, band, sd = (each.factor * found[f"{each.name}{end}"].values.ravel() for end in ("", "_band", "_sd"))
        cells = [
            f"{with_error(m, b, each.digits)} (sd {s:.2g})" if n > 1 else "one patch"
            for m, b, s, n in zip(mean, band, sd, counts, strict=True)
        ]
        columns.append([each.title, *cells])
    heading = (
        f"Mean over {int(counts.max())} of {', '.join(keys)}, its band of 95 % (Student's t), and the standard "
        "deviation between them; each run's stated error comes on top."
    )
    return [heading, _aligned(columns)]


def _known(dataset: xr.Dataset) -> list[str]:
    """Return a sentence on how well single runs know their outputs."""
    last, parts = ends(dataset), []
    for heading, _, name, _, _ in shown(dataset):
        if f"{name}{ERROR}" in last.coords:
            values, halves = np.abs(last[name].values).ravel(), last.coords[f"{name}{ERROR}"].values.ravel()
            pairs = zip(values, halves, strict=True)
            told = np.array([not says_nothing(name, value, half) for value, half in pairs])
            known = np.isfinite(values) & told & ((values > 0.0) | (name in SHARES))
            if not known.any():
                continue
            if name in SHARES:
                parts.append(f"{heading} +- {float(np.median(halves[known])):.2g}")
            else:
                parts.append(f"{heading} {100.0 * float(np.median(halves[known] / values[known])):.0f} %")
    return [f"A run alone is known to, at its end (median): {', '.join(parts)}."] if parts else []


def sheet(plan: Plan, dataset: xr.Dataset) -> Sheet:
    """Return the picture: a panel for each output, of samples one for each key that they vary."""
    last, columns = ends(dataset), shown(dataset)
    if plan.sampled:
        charts = [_dots(last, each, column) for column in columns for each in plan.sampled]
    else:
        charts = [_curves(plan, last, column, keyed=k == 0) for k, column in enumerate(columns)]
    across = len(plan.sampled) if plan.sampled else min(3, len(columns))
    bars = "at the end of each run; bands and bars: stated errors (95 %)"
    title = f"{textwrap.fill(dataset.attrs['title'], 40 * across)}\n{bars}"
    return Sheet(charts, title, across, 4.2)


def _dots(last: xr.Dataset, key: Factor, column: Column) -> Chart:
    """Return an output over a sampled key, one dot with its error for each sample."""
    name, factor = column.name, column.factor
    values = factor * last[name].transpose("sample", ...).values.reshape(last.sizes["sample"], -1)
    where, half = np.repeat(last[key.key].values[:, None], values.shape[1], axis=1), last.coords.get(f"{name}{ERROR}")
    bars = None if half is None else factor * half.transpose("sample", ...).values.ravel()
    dots = Line("", where.ravel(), values.ravel(), bars, style="o")
    label = f"{key.key} [{key.unit}]" if key.unit else key.key
    return Chart("", label, column.title, [dots], logarithmic_x=key.logarithmic, from_zero=False)


def _curves(plan: Plan, last: xr.Dataset, column: Column, keyed: bool) -> Chart:
    """Return an output over the longest axis of the grid, a curve for each choice of the others."""
    name, factor = column.name, column.factor
    along = max(plan.grid, key=lambda each: len(each.choices))
    others = [each for each in plan.grid if each is not along]
    numbers = np.issubdtype(last[along.key].dtype, np.number)
    where = last[along.key].values if numbers else np.arange(len(along.choices), dtype=float)
    half, lines = last.coords.get(f"{name}{ERROR}"), []
    for place, choice in enumerate(itertools.product(*(range(len(each.choices)) for each in others))):
        here = {each.key: k for each, k in zip(others, choice, strict=True)}
        label = ", ".join(f"{each.key} = {each.choices[k]}" for each, k in zip(others, choice, strict=True))
        values, width = last[name].isel(here).values, None if half is None else factor * half.isel(here).values
        lines.append(Line(label if keyed else "", where, factor * values, width, place, style="o-"))
    x_label = f"{along.key} [{last[along.key].attrs['units']}]" if numbers else along.key
    names = {} if numbers else dict(zip(where.tolist(), map(str, along.choices), strict=True))
    return Chart("", x_label, column.title, lines, from_zero=False, x_names=names)
