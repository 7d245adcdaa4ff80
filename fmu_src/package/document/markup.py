"""Plain text and equations to HTML."""

import re
from collections.abc import Iterable, Iterator, Sequence
from html import escape

_SCRIPT = re.compile(r"([_^])(?:\{([^{}]*)\}|([\w∞]))")
_LETTER = re.compile(r"(?<![^\W\d_])[^\W\d_](?![^\W_])")
_TAGS = {"_": "sub", "^": "sup"}
_DOI = re.compile(r"doi:(10\.\d+/[^\s,;]+)")


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


def _letters(text: str) -> str:
    return _LETTER.sub(lambda letter: f"<i>{letter[0]}</i>", plain(text))


def plain(text: str) -> str:
    """Escape plain text."""
    return escape(text, quote=False)


def paragraph(text: str) -> str:
    """Return a paragraph of plain text."""
    return f"<p>{plain(text)}</p>"


def source(text: str) -> str:
    """Return the source of an equation, with DOIs as links."""
    linked = _DOI.sub(r'<a href="https://doi.org/\1">doi:\1</a>', plain(text))
    return f'<p class="source">Source: {linked}</p>'


def table(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a table of plain text."""
    top = "".join(f"<th>{plain(cell)}</th>" for cell in head)
    lines = ("".join(f"<td>{plain(str(cell))}</td>" for cell in row) for row in rows)
    body = "\n".join(f"<tr>{line}</tr>" for line in lines)
    return f'<div class="wide"><table><tr>{top}</tr>\n{body}</table></div>'


def bullets(items: Iterable[str]) -> Iterator[str]:
    """Yield a list of plain text; nothing for no items."""
    rows = [f"<li>{plain(item)}</li>" for item in items]
    if rows:
        yield "<ul>" + "\n".join(rows) + "</ul>"


def number(value: float, unit: str = "") -> str:
    """Return a value to four digits, with its unit."""
    return f"{value:.4g} {unit}".strip()
