"""Write the README's section "How good, how fast" from the tables of docs/measured: the best figure beside the worst.

    python -m benchmarks.house.readme_figures

Each figure is looked up in a table that a benchmark wrote. Run this again when a page has changed; a test compares.
"""

from collections.abc import Callable

from benchmarks.folders import MEASURED, ROOT
from benchmarks.house.figures_of_contacts import (
    bars,
    dry_contact,
    estimates,
    finest,
    grids,
    rough_contact,
    smooth_contact,
)
from benchmarks.house.figures_of_levels import drivers, error_outputs, fast_step, half_widths, held_back, two_hours
from benchmarks.house.figures_of_systems import coupling, fmu, machines, thesis
from benchmarks.house.tables import Pages, line_of

HEAD = "## How good, how fast\n"
INTRODUCTION = """
`python -m benchmarks.house.readme_figures` writes this section from the linked pages, and the benchmarks named there write the
pages. One thread; CPU seconds on a shared machine; a work unit (WU) is one deformation convolution on the same grid.
`python -m benchmarks.house.pages` lists those whose sources have changed since they were written.
"""


SECTIONS: tuple[tuple[str, tuple[Callable[[Pages], list[tuple[str, ...]]], ...]], ...] = (
    ("The regression level against the deterministic level", (held_back, two_hours, error_outputs, fast_step)),
    ("Two hours at the deterministic level", (half_widths, grids, thesis)),
    ("One contact at one instant", (bars, finest, smooth_contact, rough_contact, estimates, dry_contact)),
    ("FMU and coupling", (fmu, coupling, machines)),
)
DRIVERS = """
Rms over time on 129 x 129 nodes, the larger of both bodies unless named. Errors of time and iteration only; the grid follows below.
Sampling affects mainly the groove-free roughness of the smooth ball (4 to 6 nm, [surfaces/evolution](docs/measured/surfaces/evolution.md)).
"""


def section(pages: Pages) -> str:
    """Return the section, from its heading to the end of its last table."""
    lines = [HEAD.rstrip(), *INTRODUCTION.rstrip().splitlines(), ""]
    for title, parts in SECTIONS:
        lines += [f"**{title}**", ""]
        if half_widths in parts:
            lines += [*DRIVERS.strip().splitlines(), "", *drivers(pages), ""]
        lines += [line_of(("what", "best", "worst", "page")), "|---|---|---|---|"]
        lines += [line_of(row) for part in parts for row in part(pages)]
        lines.append("")
    return "\n".join(lines)


def section_of(text: str) -> str:
    """Return the section of a README's text."""
    start = text.index(HEAD)
    return text[start : text.index("\n## ", start) + 1]


def main() -> None:
    path = ROOT / "README.md"
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace(section_of(text), section(Pages(MEASURED)) + "\n"), encoding="utf-8")


if __name__ == "__main__":
    main()
