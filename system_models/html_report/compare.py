"""Several runs in the same charts with their bands, and their end values beside each other."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from contact_core.errors import ContactError
from fmu_src.html.markup import heading, paragraph, section, table

from ..charts.chart import Chart
from ..charts.svg import figure
from ..charts.units import Unit, stated, time_unit
from ..run.cosim_report import aligned
from ..run.panels import MAIN, MORE, Panel, apart, band, overlaid, unit_of, values
from .histories import BANDS
from .opened import Run, open_run
from .page import dressed
from .scene import readable

_MOST = 7  # runs, as many as there are colours
_LEFT_OUT = ("name", "description")
_SAME, _APART, _UNKNOWN = "overlap", "apart", "–"


@dataclass(frozen=True)
class EndValue:
    """The end values of one quantity in all runs, in one unit."""

    title: str
    unit: Unit
    found: tuple[float, ...]  # NaN: a run does not have it
    halves: tuple[float, ...]  # NaN: without a band

    @property
    def verdict(self) -> str:
        """Whether the bands of all runs that have the quantity overlap each other."""
        pairs = [(v, h) for v, h in zip(self.found, self.halves, strict=True) if math.isfinite(v)]
        if len(pairs) < 2 or not all(math.isfinite(half) for _, half in pairs):
            return _UNKNOWN
        lowest, highest = max(v - h for v, h in pairs), min(v + h for v, h in pairs)
        return _SAME if lowest <= highest else _APART

    @property
    def cells(self) -> list[str]:
        """The values with their errors as text."""
        pairs = zip(self.found, self.halves, strict=True)
        return [stated(v, h if math.isfinite(h) else None) if math.isfinite(v) else "–" for v, h in pairs]


def open_runs(folders: Sequence[Path]) -> list[Run]:
    """Return the runs in folders. Raises ContactError if they are too few, too many, or have nothing in common."""
    if not 2 <= len(folders) <= _MOST:
        raise ContactError(f"{len(folders)} folders cannot be compared: give at least 2 and at most {_MOST}.")
    runs = [open_run(folder) for folder in folders]
    if not _shared(runs):
        raise ContactError(
            "These runs have no contact in common: contacts of machines are compared by their names. Give runs of "
            "single contacts, or of the same kind of machine."
        )
    return runs


def _shared(runs: Sequence[Run]) -> list[str]:
    """Return the names of the contacts that all runs have."""
    return [name for name in runs[0].contacts if all(name in run.contacts for run in runs)]


def names(runs: Sequence[Run]) -> list[str]:
    """Return a name for each run: the last part of its folder, or more of it where that is the same."""
    short = [run.folder.absolute().name for run in runs]
    return short if len({*short}) == len(short) else [str(run.folder) for run in runs]


def compared_at(runs: Sequence[Run]) -> float:
    """Return the last time that all runs have reached [s]: later values are no comparison."""
    return min(run.reached for run in runs)


def _row(run: Run, time: float) -> int:
    """Return the last row of a run that is not after a time [s]."""
    return int(np.searchsorted(run.dataset.variables["time"].values, time * (1.0 + 1e-9), "right")) - 1


def end_values(runs: Sequence[Run], contact: str) -> Iterator[EndValue]:
    """Yield the values of the main quantities of a contact at the last time that all runs have reached."""
    rows = [_row(run, compared_at(runs)) for run in runs]
    for panel in (*MAIN, *MORE):
        for name, title in apart(panel):
            full = [run.of(contact, name) for run in runs]
            there = [k for k, run in enumerate(runs) if full[k] in run.dataset]
            if not any(np.any(values(runs[k].dataset, full[k])) for k in there):
                continue
            unit = unit_of([(runs[k].dataset, full[k]) for k in there], name)
            found, halves = [math.nan] * len(runs), [math.nan] * len(runs)
            for k in there:
                found[k] = float(unit.of(values(runs[k].dataset, full[k])[rows[k]]))
                half = band(runs[k].dataset, full[k], unit)
                halves[k] = math.nan if half is None else float(half[rows[k]])
            yield EndValue(title, unit, tuple(found), tuple(halves))


def lines(runs: Sequence[Run]) -> list[str]:
    """Return the table for the terminal: end values with their errors, and whether their bands overlap."""
    rows = [[f"at {_told(runs)}", "unit", *names(runs), "bands"]]
    for contact in _shared(runs):
        before = f"{contact}: " if contact else ""
        for each in end_values(runs, contact):
            cells = [cell.replace("±", "+-") for cell in each.cells]
            rows.append(
                [
                    f"{before}{each.title.lower()}",
                    each.unit.name.replace("µ", "u").replace("°", "deg"),
                    *cells,
                    each.verdict.replace("–", "none"),
                ]
            )
    return [*aligned(rows, 2), *_warnings(runs)]


def _warnings(runs: Sequence[Run]) -> Iterator[str]:
    """Yield sentences on runs that cannot be compared at their ends as they are."""
    named = list(zip(names(runs), runs, strict=True))
    yield from (
        f"'{name}' is unfinished, at {run.reached:g} of {run.planned:g} s." for name, run in named if not run.finished
    )
    if len({run.reached for run in runs}) > 1:
        ends = ", ".join(f"{name} {run.reached:g} s" for name, run in named)
        yield f"The runs end at different times ({ends}); they are compared at {_told(runs)}."


def _told(runs: Sequence[Run]) -> str:
    """Return the time of the comparison as text."""
    clock = time_unit(compared_at(runs))
    return f"{float(clock.of(compared_at(runs))):.4g} {clock.name}"


def page(runs: Sequence[Run]) -> str:
    shared = _shared(runs)
    body = _ends(runs, shared) + _differences(runs) + _charts(runs, shared)
    return dressed(f"Compared: {', '.join(names(runs))}", "Comparison of runs", body)


def _ends(runs: Sequence[Run], shared: Sequence[str]) -> str:
    parts = [paragraph(sentence, "bad") for sentence in _warnings(runs)]
    for contact in shared:
        rows = [[each.title, each.unit.name or "–", *each.cells, each.verdict] for each in end_values(runs, contact)]
        parts += [heading(f"Contact {contact}")] if contact else []
        parts.append(table([f"at {_told(runs)}", "unit", *names(runs), "bands"], rows, "numbers"))
    words = paragraph(
        "“Overlap” means that one value could be that of all runs, within the errors that they state: the "
        "difference says nothing yet. “Apart” means that the difference is larger than the errors. Runs that share "
        "curves or a grid share errors too, so their difference is often surer than their values."
    )
    return section("ends", "Values beside each other", *parts, words)


def _differences(runs: Sequence[Run]) -> str:
    """Return what differs between the scenes."""
    tables = [dict(_leaves(run.scene_table)) for run in runs]
    keys = list(dict.fromkeys(key for each in tables for key in each))
    differing = [key for key in keys if len({str(each.get(key)) for each in tables}) > 1 and _tells(key, tables)]
    rows = [[key, *(readable(each[key]) if key in each else "–" for each in tables)] for key in differing]
    titles = table(["run", "what it is"], [[name, run.title] for name, run in zip(names(runs), runs, strict=True)])
    if not any(tables):
        return section("differences", "What differs", titles)
    same = (
        paragraph("Nothing: the scenes are the same.") if not rows else table(["scene", *names(runs)], rows, "numbers")
    )
    return section("differences", "What differs", titles, same)


def _tells(key: str, tables: Sequence[Mapping[str, object]]) -> bool:
    """Return False for a number of a law that some run does not have: that they have other laws is said already."""
    law = key.rpartition(".")[0]
    return key.endswith("model") or all(any(each.startswith(f"{law}.") for each in table_) for table_ in tables)


def _leaves(part: object, path: str = "") -> Iterator[tuple[str, object]]:
    """Yield the values of nested tables by their dotted keys."""
    if isinstance(part, dict):
        for key, value in part.items():
            if path or key not in _LEFT_OUT:
                yield from _leaves(value, f"{path}.{key}" if path else key)
    else:
        yield path, part


def _charts(runs: Sequence[Run], shared: Sequence[str]) -> str:
    parts = []
    for number, contact in enumerate(shared):
        drawn = {
            name: _overlaid(runs, contact, name, title, panel)
            for panel in (*MAIN, *MORE)
            for name, title in apart(panel)
            if any(_has(run, contact, name) for run in runs)
        }
        parts += [heading(f"Contact {contact}")] if contact else []
        shown = "".join(figure(chart, f"compare-{number}-{name}") for name, chart in drawn.items())
        parts.append(f'<div class="charts">{shown}</div>')
    return section("histories", "Histories", paragraph(BANDS), *parts)


def _has(run: Run, contact: str, name: str) -> bool:
    full = run.of(contact, name)
    return full in run.dataset and bool(np.any(values(run.dataset, full)))


def _overlaid(runs: Sequence[Run], contact: str, name: str, title: str, panel: Panel) -> Chart:
    """Return the chart of one quantity of all runs that have it; a run keeps its colour in all charts."""
    columns = [
        (names(runs)[place], run.dataset, run.of(contact, name), place)
        for place, run in enumerate(runs)
        if _has(run, contact, name)
    ]
    return overlaid(panel, title, name, columns)
