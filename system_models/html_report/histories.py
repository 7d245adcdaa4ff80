"""Quantities against time: of one contact, of a machine's parts, and of each of its contacts."""

from collections.abc import Iterator

import numpy as np

from fmu_src.html.markup import folded, heading, paragraph, section

from ..charts.chart import COLOURS, Chart, Line
from ..charts.svg import figures
from ..charts.units import time_unit, unit_for
from ..run.panels import DUTY, MAIN, MORE, charts, constants, values
from .opened import Run
from .trust import invalid

BANDS = (
    "The shaded band around a line is its stated error, the half width of a 95 % interval to either side: the wider "
    "the band, the less the line says; of an ensemble the scatter of its surfaces is in it. A line without a band is a "
    "quantity for which no error is stated. Grey stretches are rows that are not valid. Move the pointer over a chart "
    "to read values."
)
_TOGETHER = len(COLOURS)  # lines in a chart
_MOST = 16  # charts of a machine's parts
_LEFT_OUT = ("valid", "time", "step_size", "iterations", "residual", "error")


def sections(run: Run) -> str:
    """Return the section of histories."""
    shaded = invalid(run)
    if run.of_contact:
        main, more = (
            figures([*charts(run.dataset, panels, "", shaded)], f"history-{k}") for k, panels in enumerate((MAIN, MORE))
        )
        duty = figures([*charts(run.dataset, DUTY, "", shaded)], "duty")
        held = ", ".join(constants(run.dataset, (*DUTY, *MORE)))
        still = paragraph(f"Constant throughout: {held}.") if held else ""
        return section(
            "histories",
            "Histories",
            paragraph(BANDS),
            main,
            heading("More of the contact"),
            more,
            heading("The duty"),
            duty,
            still,
        )
    parts = figures([*_of_parts(run)], "part")
    each = [_of_contact(run, name, k, shaded) for k, name in enumerate(run.contacts)]
    contacts = [heading("Each contact"), *each] if each else []
    return section("histories", "Histories", paragraph(BANDS), parts, *contacts)


def _of_contact(run: Run, name: str, number: int, shaded: tuple[tuple[float, float], ...]) -> str:
    drawn = figures([*charts(run.dataset, MAIN, name, shaded)], f"contact-{number}")
    return folded(f"Contact {name}", drawn, unfolded=number == 0)


def _of_parts(run: Run) -> Iterator[Chart]:
    """Yield charts of the outputs of a machine's parts: those of one part and one unit together."""
    groups: dict[tuple[str, str, str], list[str]] = {}
    for name in map(str, run.dataset.data_vars):
        part, _, variable = name.rpartition(".")
        if part in run.contacts or part in ("master", "") or variable in _LEFT_OUT or "[" in variable:
            continue
        if run.dataset.variables[name].dtype.kind == "f" and np.ptp(run.dataset.variables[name].values) > 0.0:
            stem = variable.split("_")[0]
            groups.setdefault((part, run.dataset.variables[name].attrs.get("units", "1"), stem), []).append(name)
    for (part, si, stem), names in list(groups.items())[:_MOST]:
        yield _together(run, part, si, stem, names[:_TOGETHER])


def _common(labels: list[str]) -> str:
    """Return the words with which all labels begin."""
    found = []
    for words in zip(*(label.split() for label in labels), strict=False):
        if len({*words}) > 1:
            break
        found.append(words[0])
    return " ".join(found)


def _together(run: Run, part: str, si: str, stem: str, names: list[str]) -> Chart:
    clock, found = time_unit(run.reached), {name: values(run.dataset, name) for name in names}
    unit = unit_for(si, np.concatenate([*found.values()]), "rise" in names[0])
    lines = [
        Line(
            name.rpartition(".")[2].replace("_", " "),
            clock.of(run.dataset.variables["time"].values),
            unit.of(y),
            None,
            place,
        )
        for place, (name, y) in enumerate(found.items())
    ]
    title = lines[0].label if len(lines) == 1 else _common([line.label for line in lines]) or stem
    return Chart(f"{part}: {title}", f"time {clock.label}", f"{title} {unit.label}", lines, from_zero=si != "K")
