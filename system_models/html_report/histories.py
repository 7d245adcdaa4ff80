"""Quantities against time: of one contact, of a machine's parts, and of each of its contacts."""

from collections.abc import Iterator, Sequence

import numpy as np

from fmu_src.html.markup import folded, heading, paragraph, section

from ..charts.chart import COLOURS, Chart
from ..charts.svg import figures
from ..run.panels import DUTY, MAIN, MORE, Panel, chart, charts, constants
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
    shaded = invalid(run)
    if run.of_contact:
        main, more, duty = (
            figures(charts(run.dataset, panels, "", shaded), key)
            for panels, key in ((MAIN, "history-0"), (MORE, "history-1"), (DUTY, "duty"))
        )
        held = ", ".join(constants(run.dataset, (*DUTY, *MORE)))
        rest = heading("More of the contact"), more, heading("The duty"), duty
        still = paragraph(f"Constant throughout: {held}.") if held else ""
        return section("histories", "Histories", paragraph(BANDS), main, *rest, still)
    each = [_of_contact(run, name, k, shaded) for k, name in enumerate(run.contacts)]
    contacts = [heading("Each contact"), *each] if each else []
    return section("histories", "Histories", paragraph(BANDS), figures(_of_parts(run), "part"), *contacts)


def _of_contact(run: Run, name: str, number: int, shaded: tuple[tuple[float, float], ...]) -> str:
    drawn = figures(charts(run.dataset, MAIN, name, shaded), f"contact-{number}")
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
    for (part, _, stem), names in list(groups.items())[:_MOST]:
        yield _together(run, part, stem, names[:_TOGETHER])


def _common(labels: Sequence[str]) -> str:
    """Return the words with which all labels begin."""
    found = []
    for words in zip(*(label.split() for label in labels), strict=False):
        if len({*words}) > 1:
            break
        found.append(words[0])
    return " ".join(found)


def _together(run: Run, part: str, stem: str, names: list[str]) -> Chart:
    labels = tuple(name.rpartition(".")[2].replace("_", " ") for name in names)
    title = labels[0] if len(labels) == 1 else _common(labels) or stem
    return chart(run.dataset, Panel(f"{part}: {title}", tuple(names), labels, title, ""), names)
