"""Write the tables of docs/trust.md from those of docs/measured.

    python -m benchmarks.house.trust

A table stands between `<!-- table: NAME -->` and `<!-- end -->`. Each of its figures is looked up in a section that a benchmark wrote.
"""

import re
from collections.abc import Callable, Iterable

from benchmarks.folders import ROOT
from benchmarks.house import figures_of_levels as levels
from benchmarks.house.figures_of_contacts import bounds, contacts, dry_contact, estimates, grids, steps
from benchmarks.house.figures_of_systems import coupling, fmu, machines, thesis
from benchmarks.house.tables import Pages, table

PATH = ROOT / "docs" / "trust.md"
MARKED = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)


def _ends(*parts: Callable[[Pages], Iterable[tuple[str, ...]]]) -> Callable[[Pages], list[str]]:
    """A table of the best beside the worst."""
    return lambda pages: table(("what", "best", "worst", "measured in"), [row for part in parts for row in part(pages)])


def _stated(pages: Pages) -> list[str]:
    rows = [estimates(pages), *bounds(pages), levels.grids_in_time(pages), machines(pages)]
    return table(("stated error", "covers", "asked for", "measured in"), rows)


TABLES: dict[str, Callable[[Pages], list[str]]] = {
    "contacts": contacts,
    "hours": levels.two_hours,
    "held_back": levels.held_back,
    "drivers": levels.drivers,
    "grids": _ends(grids, steps),
    "cost": _ends(levels.fast_step, dry_contact, fmu, coupling),
    "stated": _stated,
    "thesis": thesis,
}


def written(text: str, pages: Pages) -> str:
    """Return the page with its tables as the sections give them."""
    return MARKED.sub(lambda found: "\n".join([found[1], *TABLES[found[2]](pages), "", found[3]]), text)


def write() -> None:
    """Write the page."""
    PATH.write_text(written(PATH.read_text(encoding="utf-8"), Pages()), encoding="utf-8")


if __name__ == "__main__":
    write()
