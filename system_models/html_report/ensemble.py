"""An ensemble of surfaces: the mean at the end with its band beside the stated errors, and each member's course."""

import json
import math
from collections.abc import Iterator
from dataclasses import replace

from fmu_src.html.markup import paragraph, section, table

from ..charts.chart import COLOURS, Chart, Line
from ..charts.svg import figures
from ..run.panels import MAIN, Panel, apart, overlaid, unit_of, values
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
        [title, *("–" if math.isnan(number) else f"{number:.{digits}f}" for number in numbers)]
        for title, numbers, digits in ends_of(run.dataset, run.members)
    ]
    head = ["at the end", *(each.replace("+-", "±") for each in HEADINGS), *names]
    drawn = [
        chart for panel in MAIN for name, title in apart(panel) for chart in _chart(run, panel, name, title, names)
    ]
    return section(
        "ensemble",
        "Ensemble of surfaces",
        table(head, rows, "numbers"),
        paragraph(EXPLAINED.replace("+-", "±")),
        figures(drawn, "ensemble"),
        paragraph(_LINES, "quiet"),
    )


def _chart(run: Run, panel: Panel, name: str, title: str, names: list[str]) -> Iterator[Chart]:
    """Yield the chart of one quantity of a panel, none if it is zero throughout."""
    if run.members is None or not values(run.dataset, name).any():
        return
    mean = overlaid(panel, title, name, [("mean", run.dataset, name, 0)])
    unit = unit_of([(run.dataset, name)], name)
    members = values(run.members, name)[:_MOST]
    lines = [Line(names[k], mean.lines[0].x, unit.of(y), None, k + 1) for k, y in enumerate(members)]
    yield replace(mean, lines=[*mean.lines, *lines], caption="")
