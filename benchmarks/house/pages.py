"""List every page of docs/measured: written from today's sources, or what has changed since, and its command.

    python -m benchmarks.house.pages

The digests at the end of a page say what it was written from (`benchmarks/dependencies.py`). A page that does not say is
unmarked. The command of a page writes both anew; where its runs take hours, they are kept in results/ meanwhile.
"""

from collections.abc import Mapping
from pathlib import Path

from benchmarks.dependencies import PAGES, SOURCES, UNMARKED, Tree, changed
from benchmarks.folders import MEASURED


def states(folder: Path, tree: Tree = SOURCES) -> dict[str, list[str]]:
    """What has changed since each page of a folder was written; nothing of fresh ones."""
    files = {path.relative_to(folder).with_suffix("").as_posix(): path for path in sorted(folder.rglob("*.md"))}
    if missing := sorted({*files} ^ {*PAGES}):
        raise LookupError(f"{', '.join(missing)}: in docs/measured or in benchmarks/dependencies.py, but not in both")
    return {page: changed(page, path.read_text(encoding="utf-8"), tree) for page, path in files.items()}


def lines(found: Mapping[str, list[str]]) -> list[str]:
    """A line for each page, with its command if it is not fresh."""

    def said(why: list[str]) -> str:
        return "unmarked" if why == [UNMARKED] else f"stale ({', '.join(why)})" if why else "fresh"

    return [
        f"{page:24}{said(why)}" + (f": python -m benchmarks.{PAGES[page].command}" if why else "")
        for page, why in found.items()
    ]


if __name__ == "__main__":
    print(*lines(states(MEASURED)), sep="\n")
