"""Outcomes as a page of one file, with its pictures inside, that needs no network."""

import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np

import contact_core
from fmu_src.html.markup import Raw, linked, paragraph, picture, section, table, text
from fmu_src.html.page import whole

from ..charts import files, svg
from ..charts.chart import BLACK, GREEN, GREY, NOTHING, ORANGE, RED, SKY, Chart, Line, Sheet
from .model import Comparison, Outcome, Row, Verdict
from .terminal import HEADINGS, cells, remarks, summary

_ABOUT = (
    "A number agrees within the uncertainty of its reference, stated beside it; within stated error if the error that "
    "the computation states of itself is needed too. Where the cause of a disagreement is known, so are the answers "
    "that it explains. Measurements, numbers published by others, closed forms and a thesis's simulation are different "
    "evidence: see each heading."
)
COLOURS = {
    Verdict.AGREES: GREEN,
    Verdict.WITHIN_ERROR: SKY,
    Verdict.EXPLAINED: ORANGE,
    Verdict.DISAGREES: RED,
    Verdict.NOT_JUDGED: GREY,
}
_FARTHEST = 5.0  # of what is allowed: points beyond it stand at the edge


def write(comparisons: Mapping[str, Comparison], outcomes: Mapping[str, Outcome], folder: Path) -> tuple[Path, Path]:
    """Write validation.html and validation.png into a folder and return their paths."""
    page, drawn = folder / "validation.html", folder / "validation.png"
    drawn.write_bytes(files.png(overview(comparisons, outcomes)))
    first = paragraph(f"{summary(outcomes)}.") + paragraph(_ABOUT, "quiet")
    every = picture(drawn.read_bytes(), "every number by its distance from the reference")
    body = "".join(_section(name, comparisons[name], outcome) for name, outcome in outcomes.items())
    title = f"What tribofmu {contact_core.__version__} agrees with, and what not"
    short = {name: name for name in outcomes}
    page.write_text(whole(title, "tribofmu validate", first + every + body, svg.script(), short), "utf-8")
    return page, drawn


def _section(name: str, comparison: Comparison, outcome: Outcome) -> str:
    about = re.sub(r"`([^`]+)`", r"<code>\1</code>", text(comparison.about))
    licence = f" Numbers shipped under: {text(comparison.licence)}." if comparison.licence else ""
    rows = table((*HEADINGS, "allowed because of"), map(_row, outcome.rows)) if outcome.rows else ""
    return section(
        name,
        f"{comparison.title}: {outcome.verdict}",
        f'<p class="quiet"><b>{comparison.kind}</b>, <code>tribofmu validate {name}</code>. {about}<br>'
        f"Source: {linked(comparison.source)}.{licence}</p>",
        paragraph(f"cannot be computed: {outcome.failure}") if outcome.failure else "",
        rows,
        svg.figures(outcome.curves, name),
    )


def _row(row: Row) -> list[str]:
    quantity, *texts, verdict = cells(row)
    causes = "".join(f'<div class="quiet">{text(sentence)}</div>' for sentence in remarks(row))
    judged = f'<b style="color:{COLOURS[row.verdict]}; white-space:nowrap">{text(verdict)}</b>'
    return [Raw(text(quantity) + causes), *texts, Raw(judged), row.reason]


def distance(row: Row) -> float:
    """Return the deviation over what is allowed, within the picture; the edge where nothing is allowed."""
    if row.deviation == 0.0:
        return 0.0
    over = row.deviation / row.allowed if row.allowed else np.copysign(np.inf, row.deviation)
    return float(np.clip(np.nan_to_num(over, nan=_FARTHEST), -_FARTHEST, _FARTHEST))


def overview(comparisons: Mapping[str, Comparison], outcomes: Mapping[str, Outcome]) -> Sheet:
    """Return the distance of every number from its reference, in units of what is allowed."""
    listed = [(name, row) for name, outcome in outcomes.items() for row in outcome.rows]
    lines, names, notes, at, last = [], {}, [], 0.0, ""
    for name, row in listed:
        at += 1.4 if name != last and last else 1.0
        if name != last:
            notes.append((_FARTHEST + 0.25, at, f"{name}\n{comparisons[name].kind}"))
        last, far, colour = name, distance(row), COLOURS[row.verdict]
        mark = "<" if far <= -_FARTHEST else ">" if far >= _FARTHEST else "o"
        lines.append(Line("", np.array([0.0, far]), np.array([at, at]), colour=colour))
        lines.append(Line("", np.array([far]), np.array([at]), colour=colour, style=mark))
        names[at] = row.quantity
    words = "off by / allowed (shaded: uncertainty of the reference and stated error together; arrows: farther)"
    zero = Line("", np.zeros(2), np.array([0.0, at + 1.0]), colour=BLACK, faint=0.4)
    drawn = Chart(
        "", words, "", [zero, *lines], shaded=[(-1.0, 1.0)], downward=True, y_names=names, notes=notes,
        x_range=(-_FARTHEST - 0.15, _FARTHEST + 0.15), y_range=(0.0, at + 1.0),
    )  # fmt: skip
    found = {row.verdict for _, row in listed}
    key = [Line(each, NOTHING, NOTHING, colour=COLOURS[each], style="o") for each in Verdict if each in found]
    return Sheet([drawn], columns=1, width=11.0, height=1.0 + 0.21 * len(listed) + 0.3 * len(outcomes), key=key)
