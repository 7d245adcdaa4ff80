"""Pieces of HTML: every text is escaped here, so that no name or description can become markup."""

import base64
from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path
from textwrap import wrap

from fmu_src.package.document.markup import equation as equation
from fmu_src.package.document.markup import source as source

_GAP = "  "  # between the columns of a printed table
_COLUMNS = 120


def text(words: object) -> str:
    """Return escaped text."""
    return escape(str(words))


def paragraph(words: str, kind: str = "") -> str:
    """Return a paragraph of plain text; kind: its class."""
    return f'<p class="{kind}">{text(words)}</p>' if kind else f"<p>{text(words)}</p>"


def table(head: Sequence[str], rows: Iterable[Sequence[object]], kind: str = "", caption: str = "") -> str:
    """Return a table of plain text; a cell that begins with '<' is HTML already, as `raw` has it."""
    top = "".join(f'<th scope="col">{text(cell)}</th>' for cell in head)
    body = "".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in rows)
    said = f"<caption>{text(caption)}</caption>" if caption else ""
    rows_ = f"<thead><tr>{top}</tr></thead><tbody>{body}</tbody>"
    return f'<div class="wide"><table class="{kind}">{said}{rows_}</table></div>'


class Raw(str):
    """HTML in a cell of a table, which is not escaped."""


def _cell(cell: object) -> str:
    if isinstance(cell, Raw):
        return f"<td>{cell}</td>"
    return f"<td>{text(cell)}</td>"


def section(name: str, title: str, *parts: str) -> str:
    """Return a section of the page."""
    return f'<section id="{name}"><h2>{text(title)}</h2>\n{"".join(parts)}</section>\n'


def heading(words: str) -> str:
    """Return a heading within a section."""
    return f"<h3>{text(words)}</h3>"


def printed(lines: Iterable[str]) -> str:
    """Return lines of a printed report: tables as they are, long sentences in several lines."""
    wrapped = [part for line in lines for part in _wrapped(line)]
    return f'<pre tabindex="0">{text(chr(10).join(wrapped)).rstrip()}</pre>'


def _wrapped(line: str) -> list[str]:
    return [line] if _GAP in line.strip() or not line else wrap(line, _COLUMNS)


def folded(title: str, *parts: str, unfolded: bool = False) -> str:
    """Return parts that a click shows; on paper they are shown."""
    return f"<details{' open' if unfolded else ''}><summary>{text(title)}</summary>{''.join(parts)}</details>"


def bullets(items: Iterable[str]) -> str:
    """Return a list of plain text; nothing for no items."""
    rows = "".join(f"<li>{text(item)}</li>" for item in items)
    return f"<ul>{rows}</ul>" if rows else ""


def picture(file: Path, words: str) -> str:
    """Return a PNG file as a figure within the page, with a caption."""
    data = base64.b64encode(file.read_bytes()).decode()
    return (
        f'<figure class="picture"><img alt="{text(words)}" src="data:image/png;base64,{data}">'
        f"<figcaption>{text(words)}</figcaption></figure>"
    )
