"""Outcomes as a page of one file, with its pictures inside, that needs no network."""

import re
from collections.abc import Mapping
from pathlib import Path

import contact_core
from fmu_src.html.markup import Raw, linked, paragraph, section, table, text
from fmu_src.html.markup import picture as shown
from fmu_src.html.page import whole

from ..charts import files, svg
from . import picture
from .model import Comparison, Outcome, Row
from .terminal import HEADINGS, cells, remarks, summary

_ABOUT = (
    "A number agrees within the uncertainty of its reference, stated beside it; within stated error if the error that "
    "the computation states of itself is needed too. Where the cause of a disagreement is known, so are the answers "
    "that it explains. Measurements, numbers published by others, closed forms and a thesis's simulation are different "
    "evidence: see each heading."
)


def write(comparisons: Mapping[str, Comparison], outcomes: Mapping[str, Outcome], folder: Path) -> tuple[Path, Path]:
    """Write validation.html and validation.png into a folder and return their paths."""
    page, drawn = folder / "validation.html", folder / "validation.png"
    drawn.write_bytes(files.png(picture.overview(comparisons, outcomes)))
    first = paragraph(f"{summary(outcomes)}.") + paragraph(_ABOUT, "quiet")
    every = shown(drawn.read_bytes(), "every number by its distance from the reference")
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
    judged = f'<b style="color:{picture.COLOURS[row.verdict]}; white-space:nowrap">{text(verdict)}</b>'
    return [Raw(text(quantity) + causes), *texts, Raw(judged), row.reason]
