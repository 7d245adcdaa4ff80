"""Outcomes as a page of one file, with its pictures inside, that needs no network."""

import base64
import html
import io
import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import contact_core

from . import picture
from .model import Comparison, Outcome, Row
from .terminal import HEADINGS, cells, remarks, summary

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 1120px; margin: 2em auto; padding: 0 1em; color: #222; }
table { border-collapse: collapse; width: 100%; margin: .6em 0 1em; font-size: 14px; }
th, td { text-align: left; padding: .3em .6em; border-bottom: 1px solid #ddd; vertical-align: top; }
th { border-bottom: 2px solid #888; }
td.verdict { white-space: nowrap; font-weight: 600; }
.about, .remark { color: #555; font-size: 13.5px; } .remark { margin-top: .15em; }
img { max-width: 100%; } h2 { margin-top: 2em; border-top: 1px solid #ccc; padding-top: .8em; }
"""


def write(comparisons: Mapping[str, Comparison], outcomes: Mapping[str, Outcome], folder: Path) -> tuple[Path, Path]:
    """Write validation.html and validation.png into a folder and return their paths."""
    overview = picture.overview(comparisons, outcomes)
    page, drawn = folder / "validation.html", folder / "validation.png"
    drawn.write_bytes(_png(overview))
    body = "\n".join(_section(name, comparisons[name], outcome) for name, outcome in outcomes.items())
    page.write_text(
        f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>tribofmu validate</title><style>{_STYLE}</style></head><body>
<h1>What tribofmu {contact_core.__version__} agrees with, and what not</h1>
<p>{html.escape(summary(outcomes))}.</p>
<p class="about">A number agrees within the uncertainty of its reference, stated beside it; within stated error if
the error that the computation states of itself is needed too. Where the cause of a disagreement is known, so are the
answers that it explains. Measurements, numbers published by others, closed forms and a thesis's simulation are
different evidence: see each heading.</p>
{_image(overview, "every number by its distance from the reference")}
{body}
</body></html>
""",
        encoding="utf-8",
    )
    return page, drawn


def _section(name: str, comparison: Comparison, outcome: Outcome) -> str:
    source = re.sub(r"doi:(10\.[^\s,;]+)", r'<a href="https://doi.org/\1">doi:\1</a>', html.escape(comparison.source))
    about = re.sub(r"`([^`]+)`", r"<code>\1</code>", html.escape(comparison.about))
    licence = f" Numbers shipped under: {html.escape(comparison.licence)}." if comparison.licence else ""
    drawn = picture.curves(outcome)
    heads = "".join(f"<th>{heading}</th>" for heading in (*HEADINGS, "allowed because of"))
    table = f"<table><tr>{heads}</tr>{''.join(map(_row, outcome.rows))}</table>" if outcome.rows else ""
    failure = f"<p>cannot be computed: {html.escape(outcome.failure)}</p>" if outcome.failure else ""
    return f"""<h2 id="{name}">{html.escape(comparison.title)}: {outcome.verdict}</h2>
<p class="about"><b>{comparison.kind}</b>, <code>tribofmu validate {name}</code>. {about}<br>
Source: {source}.{licence}</p>
{failure}{table}{_image(drawn, comparison.title) if drawn else ""}"""


def _row(row: Row) -> str:
    *texts, verdict = map(html.escape, cells(row))
    said = "".join(f'<div class="remark">{html.escape(sentence)}</div>' for sentence in remarks(row))
    columns = "".join(f"<td>{text}</td>" for text in (texts[0] + said, *texts[1:]))
    colour = picture.COLOURS[row.verdict]
    return (
        f'<tr>{columns}<td class="verdict" style="color:{colour}">{verdict}</td><td>{html.escape(row.reason)}</td></tr>'
    )


def _png(figure: "Figure") -> bytes:
    kept = io.BytesIO()
    figure.savefig(kept, format="png", dpi=110)
    return kept.getvalue()


def _image(figure: "Figure", text: str) -> str:
    return f'<img alt="{html.escape(text)}" src="data:image/png;base64,{base64.b64encode(_png(figure)).decode()}">'
