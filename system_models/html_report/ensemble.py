"""An ensemble of surfaces: the mean at the end with its band beside the stated errors, and each member's course."""

import json
import math
from dataclasses import replace

from fmu_src.html.markup import paragraph, section, table

from ..charts.chart import COLOURS, Chart, Line
from ..charts.svg import figure
from ..charts.units import time_unit
from ..run.panels import MAIN, band, unit_of, values
from ..sweep.members import ATTRIBUTE, EXPLAINED, HEADINGS, ends_of
from .opened import Run

_MOST = len(COLOURS) - 1  # members whose lines are told apart
_LINES = (
    "The lines are the members and their mean; the band around the mean is the root of the squares of both half widths "
    "below, that by the scatter of the surfaces and that of the stated errors."
)


def sections(run: Run) -> str:
    """Return the section of an ensemble; nothing for a single run."""
    if run.members is None:
        return ""
    names = json.loads(run.dataset.attrs[ATTRIBUTE])["members"]
    rows = [
        [f"{heading} [{unit}]" if unit else heading]
        + ["–" if math.isnan(number) else f"{number:.{digits}f}" for number in numbers]
        for heading, unit, numbers, digits in ends_of(run.dataset, run.members)
    ]
    head = ["at the end", *(each.replace("+-", "±") for each in HEADINGS), *names]
    drawn = [
        figure(chart, f"ensemble-{panel}-{place}")
        for panel, each in enumerate(MAIN)
        for place in range(len(each.quantities))
        for chart in _chart(run, panel, place, names)
    ]
    return section(
        "ensemble",
        "Ensemble of surfaces",
        table(head, rows, "numbers"),
        paragraph(EXPLAINED.replace("+-", "±")),
        f'<div class="charts">{"".join(drawn)}</div>',
        paragraph(_LINES, "quiet"),
    )


def _chart(run: Run, number: int, place: int, names: list[str]) -> list[Chart]:
    """Return the chart of one quantity of a panel, none if it is zero throughout."""
    assert run.members is not None
    panel = MAIN[number]
    name, label = panel.quantities[place], panel.labels[place]
    mean = values(run.dataset, name)
    if not mean.any():
        return []
    clock, unit = time_unit(run.reached), unit_of(run.dataset, [name], name)
    time = clock.of(run.dataset.variables["time"].values)
    each = values(run.members, name)[:_MOST]
    lines = [Line("mean", time, unit.of(mean), band(run.dataset, name, unit), 0)]
    lines += [Line(names[k], time, unit.of(line), None, k + 1) for k, line in enumerate(each)]
    title = f"{panel.title}, {label}" if len(panel.quantities) > 1 else panel.title
    chart = Chart(title, f"time {clock.label}", f"{panel.symbol} {unit.label}", lines)
    return [replace(chart, from_zero=unit.offset == 0.0, downward=panel.downward)]
