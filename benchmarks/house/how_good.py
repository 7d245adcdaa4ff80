"""Write docs/how_good.md from the tables of docs/measured: the best figure beside the worst.

    python -m benchmarks.house.how_good

Each figure is looked up in a table that a benchmark wrote. Run this again when a page has changed; a test compares.
"""

from collections.abc import Callable

from benchmarks.folders import ROOT
from benchmarks.house.figures_of_contacts import accuracies, dry_contact, estimates, grids, steps
from benchmarks.house.figures_of_levels import drivers, fast_step, half_widths, held_back, two_hours
from benchmarks.house.figures_of_systems import coupling, fmu, machines, thesis
from benchmarks.house.tables import Pages, line_of, link

PATH = ROOT / "docs" / "how_good.md"
INTRODUCTION = """# How good, how fast

`python -m benchmarks.house.how_good` writes this page from the linked sections, and the benchmarks named there write those. One thread; CPU
seconds on a shared machine; a work unit (WU) is one deformation convolution on the same grid. "Of older code" stands beside figures whose
section was not measured since the code changed; `python -m benchmarks.claims` lists what is claimed, and checks it.
"""


SECTIONS: tuple[tuple[str, tuple[Callable[[Pages], list[tuple[str, ...]]], ...]], ...] = (
    ("The regression level against the deterministic level", (held_back, two_hours, fast_step)),
    ("Two hours at the deterministic level", (half_widths, grids, thesis)),
    ("One contact at one instant", (accuracies, steps, estimates, dry_contact)),
    ("FMU and coupling", (fmu, coupling, machines)),
)
DRIVERS = """
Rms over time on 129 x 129 nodes, the larger of both bodies unless named. Errors of time and iteration only; the grid follows below.
Sampling affects mainly the groove-free roughness of the smooth ball (4 to 6 nm, EVOLUTION).
"""


def written(pages: Pages) -> str:
    """Return the page."""
    lines = [*INTRODUCTION.rstrip().splitlines(), ""]
    for title, parts in SECTIONS:
        lines += [f"## {title}", ""]
        if half_widths in parts:
            lines += [
                *DRIVERS.strip().replace("EVOLUTION", link("surfaces/evolution")).splitlines(),
                "",
                *drivers(pages),
                "",
            ]
        lines += [line_of(("what", "best", "worst", "page")), "|---|---|---|---|"]
        lines += [line_of(row) for part in parts for row in part(pages)]
        lines.append("")
    return "\n".join(lines)


def write() -> None:
    """Write the page."""
    PATH.write_text(written(Pages()), encoding="utf-8")


if __name__ == "__main__":
    write()
