"""README's section "How good, how fast", written from the tables of docs/: the best figure beside the worst.

    python -m benchmarks.house.readme_figures

No figure of that section is typed by hand: each is looked up in a table that a benchmark wrote. To be run again when a
page has changed; a test compares.
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
from benchmarks.house.figures_of_levels import drivers, error_outputs, fast_step, half_widths, random_points, two_hours
from benchmarks.house.figures_of_systems import coupling, fmu, machines, thesis
from benchmarks.house.tables import Pages, line_of

HEAD = "## How good, how fast\n"
INTRODUCTION = """
`python -m benchmarks.house.readme_figures` writes this section from the pages named, and the benchmarks named there write
the pages. One thread; CPU seconds on a shared machine; a work unit (WU) is one deformation convolution on the same grid.
"""


SECTIONS: tuple[tuple[str, tuple[Callable[[Pages], list[tuple[str, ...]]], ...]], ...] = (
    ("The fast level against the deterministic one", (random_points, two_hours, error_outputs, fast_step)),
    ("Two hours at the deterministic level", (half_widths, grids, thesis)),
    ("One contact at one instant", (bars, finest, smooth_contact, rough_contact, estimates, dry_contact)),
    ("FMU and coupling", (fmu, coupling, machines)),
)
DRIVERS = """
Rms over time on 129 x 129 nodes, of both bodies the larger, unless named. Time and iteration alone: the grid comes below.
The groove-free roughness of the smooth ball (4 to 6 nm) is where sampling shows ([surfaces/evolution](docs/measured/surfaces/evolution.md)).
"""


def section(pages: Pages) -> str:
    """README's section, from its heading to the end of its last table."""
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
    """The section as a README has it."""
    start = text.index(HEAD)
    return text[start : text.index("\n## ", start) + 1]


def main() -> None:
    path = ROOT / "README.md"
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace(section_of(text), section(Pages(MEASURED)) + "\n"), encoding="utf-8")


if __name__ == "__main__":
    main()
