"""Sections of docs/measured in Markdown, written by benchmarks.

    python -m benchmarks.pages PAGE --measured 2026-11-28

takes a page in Markdown, .../<room>/<name>.md with its pictures beside it, as what that benchmark found on that day, with today's code.
"""

import argparse
import re
import shutil
from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import date
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from benchmarks import claims, sections
from benchmarks.folders import MEASURED


def cells(values: Sequence[Any]) -> str:
    """Return a row of a table: numbers with four digits, truth values as yes or no."""

    def text(value: Any) -> str:
        if isinstance(value, bool | np.bool_):
            return "yes" if value else "**no**"
        return f"{value:.4g}" if isinstance(value, float | np.floating) else str(value)

    return "| " + " | ".join(map(text, values)) + " |"


def save(name: str, text: str) -> None:
    """Keep the section of a benchmark, room/name, with the numbers of its sentinel, and write the page of its room."""
    sections.keep(name, text, date.today().isoformat())
    claims.keep([name])


def take(page: Path, measured: str) -> None:
    """Take a page that was written elsewhere, with its pictures."""
    room, name = page.parent.name, page.stem
    name = name if room == "measured" else f"{room}/{name}"
    if name not in claims.CLAIMS:
        raise LookupError(f"{name} backs no claim of benchmarks/claims.py")
    text = re.sub(r"\n<!-- depends on .* -->\s*\Z", "\n", page.read_text(encoding="utf-8"))
    for picture in re.findall(r"!\[[^\]]*\]\(([\w.]+)\)", text):
        shutil.copyfile(page.with_name(picture), folder(name.partition("/")[0]) / picture)
    sections.keep(name, text, measured)
    claims.keep([name])


def folder(room: str) -> Path:
    """The folder of a room's pictures."""
    found = MEASURED / room
    found.mkdir(parents=True, exist_ok=True)
    return found


@dataclass
class Page:
    """A section, printed while it grows. It begins with the figures asked for and found."""

    benchmark: str  # room/name
    title: str
    options: str = ""  # of its command
    body: list[str] = field(default_factory=list)
    verdicts: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        if self.benchmark not in claims.CLAIMS:  # before hours of work, not after
            raise LookupError(f"{self.benchmark} backs no claim: add one to benchmarks/claims.py, with a sentinel")

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
        """Save a figure in the folder of the room and show it."""
        figure.savefig(folder(self.benchmark.partition("/")[0]) / name, dpi=150)
        self._add(f"\n![{text}]({name})\n")

    def write(self) -> None:
        """Keep the section, and write the page of its room."""
        module = f"benchmarks.{self.benchmark.replace('/', '.')}"
        command = " ".join(filter(None, ("python -m", module, self.options)))
        intro = f"# {self.title}\n\nWritten by `{command}`. One process, one thread.\n"
        asked = ["## Asked", "", cells(("asked", "found", "met?")), "|---|---|---|", *self.verdicts, "", "## Found"]
        save(self.benchmark, "\n".join([intro, *asked, *self.body]))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", type=Path)
    parser.add_argument("--measured", required=True, metavar="DATE")
    given = parser.parse_args()
    take(given.page, given.measured)
