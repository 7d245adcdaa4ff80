"""Pages of docs/measured in Markdown, written by benchmarks."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from benchmarks.dependencies import PAGES, stamp
from benchmarks.folders import MEASURED


def cells(values: Sequence[Any]) -> str:
    """Return a row of a table: numbers with four digits, truth values as yes or no."""

    def text(value: Any) -> str:
        if isinstance(value, bool | np.bool_):
            return "yes" if value else "**no**"
        return f"{value:.4g}" if isinstance(value, float | np.floating) else str(value)

    return "| " + " | ".join(map(text, values)) + " |"


def save(page: str, text: str) -> None:
    """Write a page, room/name, with what it depends on."""
    (MEASURED / f"{page}.md").write_text(f"{text.rstrip()}\n\n{stamp(page)}\n", encoding="utf-8")


@dataclass
class Page:
    """A page, printed while it grows. It begins with the figures asked for and found."""

    benchmark: str  # room/name
    title: str
    part: str = ""  # of a benchmark that writes several pages
    options: str = ""  # of its command
    body: list[str] = field(default_factory=list)
    verdicts: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        if self.name not in PAGES:  # before hours of work, not after
            raise LookupError(
                f"{self.name} is not among PAGES of benchmarks/dependencies.py: add it, with its command and groups"
            )

    @property
    def name(self) -> str:
        """Room and file of the page."""
        return f"{self.benchmark}{self.part and '_'}{self.part}"

    @property
    def path(self) -> Path:
        """The file of the page."""
        return MEASURED / f"{self.name}.md"

    def _add(self, line: str) -> None:
        self.body.append(line)
        print(line, flush=True)

    def say(self, text: str) -> None:
        """Add a paragraph."""
        self._add(f"\n{text}\n")

    def header(self, *names: str) -> None:
        """Begin a table."""
        self._add(cells(names))
        self._add("|" + "---|" * len(names))

    def row(self, *values: Any) -> None:
        """Add a row to the table."""
        self._add(cells(values))

    def verdict(self, asked: str, found: str, met: bool) -> None:
        """Add a figure that was asked for."""
        self.verdicts.append(cells((asked, found, met)))
        print(self.verdicts[-1], flush=True)

    def picture(self, figure: Figure, name: str, text: str) -> None:
        """Save a figure beside the page and show it."""
        figure.savefig(self.path.with_name(name), dpi=150)
        self._add(f"\n![{text}]({name})\n")

    def write(self) -> None:
        """Write the page."""
        module = f"benchmarks.{self.benchmark.replace('/', '.')}"
        command = " ".join(filter(None, ("python -m", module, self.part, self.options)))
        intro = f"# {self.title}\n\nWritten by `{command}`. One process, one thread.\n"
        asked = ["## Asked", "", cells(("asked", "found", "met?")), "|---|---|---|", *self.verdicts, "", "## Found"]
        save(self.name, "\n".join([intro, *asked, *self.body]))
