"""documentation/index.html of a scene's FMU: the laws in use, the variables with their ranges, the flags."""

import inspect
import math
from collections.abc import Iterable, Iterator
from dataclasses import fields, is_dataclass
from html import escape
from typing import Any

import contact_core
from contact_core.scene import Scene
from contact_core.state import RangeFlag

from .resources import MODEL
from .variables import Variable, variables

_PAGE = """<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><title>{title}</title></head>
<body>
<h1>{title}</h1>
<p>{description}</p>
<p>One rough, lubricated contact, computed by contact_core {version}, which must be installed in the Python
that runs the FMU. All values are SI. Inputs are held over a step; outputs are those at its end. What cannot
be used leaves state and outputs as they were and sets valid to false; the log says why.</p>
{body}
</body>
</html>
"""


def documentation(scene: Scene) -> bytes:
    """A short page, UTF-8."""
    table = variables(scene)
    parts = [
        *_list("Notes on this scene", scene.warnings()),
        "<h2>Laws</h2>",
        *_laws(scene),
    ]
    for title, causality in (("Inputs", "input"), ("Outputs", "output"), ("Parameters", "parameter")):
        parts += [f"<h2>{title}</h2>", *_rows(v for v in table if v.causality == causality)]
    parts += _list("range_flags is the sum of", (f"{flag.value}: {flag.text}" for flag in RangeFlag))
    page = _PAGE.format(
        title=escape(f"{MODEL}: {scene.name}"),
        description=escape(scene.description),
        version=contact_core.__version__,
        body="\n".join(parts),
    )
    return page.encode()


def _laws(record: Any, path: str = "") -> Iterator[str]:
    """One paragraph for every law of the scene: what it says, and where it comes from."""
    for f in fields(record):
        part: Any = getattr(record, f.name)
        if hasattr(part, "source"):
            text = f"{inspect.getdoc(type(part))}\n\n{part.source}".strip()
            yield f"<h3>{path}{f.name}: {part.name}</h3><pre>{escape(text)}</pre>"
        if is_dataclass(part):
            yield from _laws(part, f"{path}{f.name}.")


def _rows(listed: Iterable[Variable]) -> Iterator[str]:
    heads = ("name", "unit", "least", "most", "start", "meaning")
    yield "<table><tr>" + "".join(f"<th>{head}</th>" for head in heads) + "</tr>"
    for v in listed:
        start = "" if v.causality == "output" else v.start
        cells = (v.name, v.unit, _bound(v.minimum), _bound(v.maximum), start, v.text)
        yield "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in cells) + "</tr>"
    yield "</table>"


def _bound(value: float) -> str:
    return f"{value:g}" if math.isfinite(value) else ""


def _list(title: str, items: Iterable[str]) -> Iterator[str]:
    rows = [f"<li>{escape(item)}</li>" for item in items]
    if rows:
        yield from (f"<h2>{title}</h2><ul>", *rows, "</ul>")
