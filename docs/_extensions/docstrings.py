"""Docstrings as reStructuredText: they are written to be read as plain text.

Bars of absolute values are no substitutions, and indented tables of names keep their lines.
"""

import re
from typing import Any

from sphinx.application import Sphinx

_BAR = re.compile(r"(``[^`]*``|`[^`]*`)|\|")


def as_restructured(app: Sphinx, what: str, name: str, obj: object, options: Any, lines: list[str]) -> None:
    """Change the lines of a docstring in place."""
    found: list[str] = []
    for line in lines:
        begins = line.startswith("    ") and what == "module" and found and not found[-1].strip()
        before = next((text for text in reversed(found) if text.strip()), "")
        if begins and not before.startswith(" ") and not before.endswith("::"):
            found += ["::", ""]
        found.append(line if line.startswith("    ") else _BAR.sub(lambda match: match[1] or r"\|", line))
    lines[:] = found


def setup(app: Sphinx) -> dict[str, bool]:
    """Add it to Sphinx."""
    app.connect("autodoc-process-docstring", as_restructured, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
