"""Pieces of HTML: every text is escaped here, so that no name or description can become markup."""

import base64
import re
from collections.abc import Iterable, Sequence
from html import escape
from textwrap import wrap

_SCRIPT = re.compile(r"([_^])(?:\{([^{}]*)\}|([\w∞]))")
_LETTER = re.compile(r"(?<![^\W\d_])[^\W\d_](?![^\W_])")
_TAGS = {"_": "sub", "^": "sup"}
_DOI = re.compile(r"doi:(10\.\d+/[^\s,;]+)")
_GAP = "  "  # between the columns of a printed table
_COLUMNS = 120


class Raw(str):
    """HTML in a cell of a table, which is not escaped."""


def text(words: object) -> str:
    return escape(str(words))


def paragraph(words: str, kind: str = "") -> str:
    """Return a paragraph of plain text; kind: its class."""
    return f'<p class="{kind}">{text(words)}</p>' if kind else f"<p>{text(words)}</p>"


def table(head: Sequence[str], rows: Iterable[Sequence[object]], kind: str = "", caption: str = "") -> str:
    """Return a table of plain text, but for cells that are `Raw`."""
    top = "".join(f'<th scope="col">{text(cell)}</th>' for cell in head)
    body = "\n".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in rows)
    above = f"<caption>{text(caption)}</caption>" if caption else ""
    inside = f"<thead><tr>{top}</tr></thead>\n<tbody>{body}</tbody>"
    return f'<div class="wide"><table class="{kind}">{above}{inside}</table></div>'


def _cell(cell: object) -> str:
    return f"<td>{cell if isinstance(cell, Raw) else text(cell)}</td>"


def section(name: str, title: str, *parts: str) -> str:
    return f'<section id="{name}"><h2>{text(title)}</h2>\n{"".join(parts)}</section>\n'


def heading(words: str) -> str:
    """Return a heading within a section."""
    return f"<h3>{text(words)}</h3>"


def bullets(items: Iterable[str]) -> str:
    """Return a list of plain text; nothing for no items."""
    rows = "\n".join(f"<li>{text(item)}</li>" for item in items)
    return f"<ul>{rows}</ul>" if rows else ""


def printed(lines: Iterable[str]) -> str:
    """Return lines of a printed report: tables as they are, long sentences in several lines."""
    wrapped = [part for line in lines for part in _wrapped(line)]
    return f'<pre tabindex="0">{text(chr(10).join(wrapped)).rstrip()}</pre>'


def _wrapped(line: str) -> list[str]:
    return [line] if _GAP in line.strip() or not line else wrap(line, _COLUMNS)


def folded(title: str, *parts: str, unfolded: bool = False) -> str:
    """Return parts that a click shows; on paper they are shown."""
    return f"<details{' open' if unfolded else ''}><summary>{text(title)}</summary>{''.join(parts)}</details>"


def picture(data: bytes, words: str) -> str:
    """Return a PNG as a figure within the page, with a caption."""
    inside = base64.b64encode(data).decode()
    return (
        f'<figure class="picture"><img alt="{text(words)}" src="data:image/png;base64,{inside}">'
        f"<figcaption>{text(words)}</figcaption></figure>"
    )


def linked(words: str) -> str:
    """Return plain text with its DOIs as links."""
    return _DOI.sub(r'<a href="https://doi.org/\1">doi:\1</a>', text(words))


def source(words: str) -> str:
    return f'<p class="source">Source: {linked(words)}</p>'


def equation(line: str) -> str:
    """Return one line of an equation as a paragraph of HTML, see `inline`."""
    return f'<p class="equation">{inline(line)}</p>'


def inline(line: str) -> str:
    """Return one line of an equation, written like `h_c / σ = W_c g^{1/2}`, as HTML.

    `_` and `^` take one letter or braces; letters that stand alone are italic.
    """
    parts, end = [], 0
    for found in _SCRIPT.finditer(line):
        tag, script = _TAGS[found[1]], found[2] or found[3]
        parts += [_letters(line[end : found.start()]), f"<{tag}>{_letters(script)}</{tag}>"]
        end = found.end()
    return "".join([*parts, _letters(line[end:])])


def _letters(words: str) -> str:
    return _LETTER.sub(lambda letter: f"<i>{letter[0]}</i>", escape(words, quote=False))


def number(value: float, unit: str = "") -> str:
    """Return a value to four digits, with its unit."""
    return f"{value:.4g} {unit}".strip()
