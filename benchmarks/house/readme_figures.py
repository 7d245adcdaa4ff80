"""README's section "How good, how fast", written from the tables of docs/: the best figure beside the worst.

    python -m benchmarks.house.readme_figures

No figure of that section is typed by hand: each is looked up in a table that a benchmark wrote. To be run again when a
page has changed; a test compares.
"""

import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import NamedTuple

from benchmarks.folders import MEASURED, ROOT

HEAD = "## How good, how fast\n"
INTRODUCTION = """
`python -m benchmarks.house.readme_figures` writes this section from the pages named, and the benchmarks named there write
the pages. One thread; CPU seconds on a shared machine; a work unit (WU) is one deformation convolution on the same grid.
"""
Row = dict[str, str]


class Table(NamedTuple):
    """A table of a page: the heading it stands under, and its rows by column."""

    heading: str
    columns: tuple[str, ...]
    rows: list[Row]


def tables(text: str) -> list[Table]:
    """All tables of a page."""
    found: list[Table] = []
    heading, before = "", ""
    for line in text.splitlines():
        if line.startswith("#"):
            heading = line.lstrip("# ")
        elif re.match(r"\|(---\|)+$", line):
            found.append(Table(heading, unlike(cell.strip() for cell in before.strip()[1:-1].split("|")), []))
        elif line.startswith("|") and before.startswith("|"):
            # prose may hold |x|: such rows have cells to spare, which no figure here is taken from
            cells = [cell.strip() for cell in line.strip()[1:-1].split("|")]
            found[-1].rows.append(dict(zip(found[-1].columns, cells, strict=False)))
        before = line
    return found


def unlike(names: Iterable[str]) -> tuple[str, ...]:
    """Names of columns, the second of the same name with a number."""
    found: list[str] = []
    for name in names:
        found.append(f"{name} ({found.count(name) + 1})" if name in found else name)
    return tuple(found)


class Pages:
    """The pages of a folder, each read once."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.read = folder, {}  # type: Path, dict[str, list[Table]]

    def rows(self, page: str, column: str, heading: str = "", **given: str) -> list[Row]:
        """Rows of the tables with a column under a heading that begins so, whose cells have these values."""
        if page not in self.read:
            self.read[page] = tables((self.folder / page).read_text(encoding="utf-8"))
        found = [
            row
            for table in self.read[page]
            if column in table.columns and table.heading.startswith(heading)
            for row in table.rows
            if all(row.get(name) == value for name, value in given.items())
        ]
        if not found:
            raise LookupError(f"docs/measured/{page} has no row with {column!r}, {given} under {heading!r}")
        return found

    def row(self, page: str, column: str, heading: str = "", **given: str) -> Row:
        """Return the only such row."""
        (found,) = self.rows(page, column, heading, **given)
        return found


def number(cell: str) -> float:
    """Return the first number of a cell."""
    found = re.search(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?", cell)
    if found is None:
        raise ValueError(f"no number in {cell!r}")
    return float(found[0])


def per_cent(share: float) -> str:
    """A share in per cent."""
    return f"{100.0 * share:.0f} %"


def link(*pages: str) -> str:
    """Links to pages."""
    return ", ".join(f"[{page.removesuffix('.md')}](docs/measured/{page})" for page in pages)


def range_of(cells: Iterable[str], say: Callable[[float], str]) -> tuple[str, str]:
    """The least and the largest number."""
    numbers = [number(cell) for cell in cells]
    return say(min(numbers)), say(max(numbers))


def pair(cell: str) -> tuple[float, float]:
    """Both numbers of a cell "a / b"."""
    one, other = cell.split(" / ")
    return float(one), float(other)


# the fast level

HOURS = {
    "tribofilm": ("ball's film nm", "disc's film nm"),
    "wear": ("ball's wear nm", "disc's wear nm"),
    "friction": ("mu",),
    "h_c": ("h_c nm",),
    "W_c": ("W_c",),
    "A_c": ("A_c",),
    "roughness of the disc": ("disc's roughness nm",),
}


def random_points(pages: Pages) -> list[tuple[str, ...]]:
    """Friction, film and load of the solids on points that the fit has not seen."""
    lines = []
    for name, column in (("friction", "mu [rel.]"), ("h_c", "h_c [rel.]"), ("W_c (of 1)", "W_c [1]")):
        found = []
        for kind in ("median", "90 %"):
            rows = pages.rows("regression/curves.md", f"{column}, {kind}", "The fast level")
            found.append(range_of((row[f"{column}, {kind}"] for row in rows), per_cent))
        ends = (f"{half}; {most}" for half, most in zip(*found, strict=True))
        lines.append(
            (f"{name} on random points of the shipped circles, half; nine of ten within", *ends, link("regression/curves.md"))
        )
    return lines


def two_hours(pages: Pages) -> list[tuple[str, ...]]:
    """Deviations over two hours of rubbing, which the curves were not fitted to."""
    rows, lines = pages.rows("regression/curves.md", "CPU s", "Two hours"), []
    for name, columns in HOURS.items():
        found = []
        for row in rows:
            for column in columns:
                slow, fast = pair(row[column])
                if slow > 0.0:
                    found.append((abs(fast / slow - 1.0), f"{100.0 * (fast / slow - 1.0):+.2g} %", row))
        (_, best, _), (_, worst, at) = min(found, key=lambda one: one[0]), max(found, key=lambda one: one[0])
        when = f"{worst} ({at['scene']}, {at['min']} min)"
        lines.append((f"{name} at 0, 20, 60 and 120 min of rubbing", best, when, link("regression/curves.md")))
    times = [slow / fast for slow, fast in (pair(row["CPU s"]) for row in rows if row["min"] == "120")]
    lines.append(
        ("their CPU time, times less", f"{max(times):.0f}", f"{min(times):.0f}", link("regression/curves.md"))
    )
    return lines


def covered(rows: list[Row], column: str) -> tuple[int, int]:
    """How many points of how many, of cells such as "97 % of 34"."""
    counts = [(round(number(row[column]) / 100.0 * int(row[column].split(" of ")[1])), row[column]) for row in rows]
    return sum(count for count, _ in counts), sum(int(cell.split(" of ")[1]) for _, cell in counts)


def error_outputs(pages: Pages) -> list[tuple[str, ...]]:
    """How often the error outputs cover the deviation where nothing was fitted."""
    page, lines = "regression/shapes.md", []
    rows = pages.rows(page, "solved well", points="check")
    for name in ("friction", "film"):
        for sure in (True, False):
            kept = [row for row in rows if not sure or row["solved well"] == "yes"]
            shapes = dict.fromkeys(row["shape"] for row in kept)
            by_shape = {shape: covered([row for row in kept if row["shape"] == shape], name) for shape in shapes}
            shares = {shape: hit / count for shape, (hit, count) in by_shape.items()}
            best, worst = max(shares, key=shares.__getitem__), min(shares, key=shares.__getitem__)
            hit, count = covered(kept, name)
            which = "points solved well" if sure else "points, solved well or not,"
            lines.append(
                (
                    f"`error_{name}` covers {hit} of {count} {which} of gears, bearings and an MTM that nothing was fitted to",
                    *("{1} of {2} ({0}s)".format(shape, *by_shape[shape]) for shape in (best, worst)),
                    link(page),
                )
            )
    within: dict[str, list[bool]] = {}
    for row in pages.rows(page, "tribofilm 2 nm", "Surfaces that have rubbed"):
        pairs = [row[name].split(" within ") for name in ("friction", "film")]
        within.setdefault(row["shape"], []).append(all(abs(float(off)) <= float(error) for off, error in pairs))
    ranked = sorted(within, key=lambda shape: sum(within[shape]) / len(within[shape]), reverse=True)
    every = [held for shape in ranked for held in within[shape]]
    ends = (f"{sum(within[shape])} of {len(within[shape])} ({shape}s)" for shape in (ranked[0], ranked[-1]))
    lines.append((f"both cover {sum(every)} of {len(every)} surfaces that have rubbed", *ends, link(page)))
    return lines


def fast_step(pages: Pages) -> list[tuple[str, ...]]:
    """What a step costs."""
    page = "regression/cost.md"
    lines = []
    for name, shipped in (("as shipped", True), ("with other laws", False)):
        rows = [row for row in pages.rows(page, "median [us]") if (row["laws"] == "as shipped") == shipped]
        ranked = sorted(rows, key=lambda row: number(row["median [us]"]))
        ends = (
            f"{number(row['5 % [us]']):.0f}; {number(row['median [us]']):.0f}; {number(row['95 % [us]']):.0f} us "
            f"({row['scene'] if shipped else row['laws']})"
            for row in (ranked[0], ranked[-1])
        )
        lines.append((f"a step {name}: 5 % are faster; median; 5 % are slower", *ends, link(page)))
    return lines


# the deterministic level over two hours


def drivers(pages: Pages) -> list[str]:
    """Errors of two hours by driver: azam_case_a against finer blocks, mtm_zddp against mixed driving."""
    heads = ("scene", "`control.driver`", "against", "blocks", "of them dry", "CPU s", "WU")
    names = ("friction", "h_c", "W_c", "A_c", "tribofilm", "wear", "Rq disc", "Rq ball")
    columns = (("mu",), ("h_c",), ("W_c",), ("A_c",), ("film 1", "film 2"), ("wear 1", "wear 2"), ("Rq 2",), ("Rq 1",))
    control = {row["driver"]: row for row in pages.rows("surfaces/evolution.md", "blocks", "The shipped control") if row["mu"]}
    by_rule = pages.rows("surfaces/evolution.md", "dry blocks", "At the same surfaces")
    rows = []
    for driver in ("auto", "mixed", "dry"):
        found = [row for row in by_rule if row["case"] == "azam_case_a" and row["driver"] == driver]
        dry = found[0]["dry blocks"] if found else "0"
        rows.append(("azam_case_a", driver, "ten times finer blocks", dry, control[driver]))
    rows += [
        (row["case"], row["driver"], "the same driven mixed", row["dry blocks"], row)
        for row in by_rule
        if (row["case"], row["driver"]) != ("azam_case_a", "auto")  # that is in `control`
    ]
    lines = [line_of((*heads, *names)), "|" + "---|" * (len(heads) + len(names))]
    for scene, driver, against, dry, row in rows:
        errors = (f"{max(number(row[column]) for column in columns_):.1f} %" for columns_ in columns)
        shipped = f"{driver} (shipped)" if driver == "auto" else driver
        share = f"{dry} ({100.0 * int(dry) / int(row['blocks']):.0f} %)"
        cost = (f"{number(row['s']):.0f}", f"{number(row['WU']):.1e}".replace("e+0", "e"))
        lines.append(line_of((scene, shipped, against, row["blocks"], share, *cost, *errors)))
    return lines


def half_widths(pages: Pages) -> list[tuple[str, ...]]:
    """At which share of the times the error is within the reported half widths."""
    lines = []
    for row in pages.rows("surfaces/evolution.md", "blocks", "The shipped control"):
        shares = {name: float(cell[cell.index("(") + 1 : -1]) for name, cell in row.items() if cell.endswith(")")}
        if not shares:
            continue
        worst = min(shares, key=shares.__getitem__)
        held = sum(share >= 0.9 for share in shares.values())
        lines.append(
            (
                f"azam_case_a driven {row['driver']}: share of the times at which `uncertainty(state)` covers the error; "
                f"nine of ten in {held} of {len(shares)} outputs",
                per_cent(max(shares.values())),
                f"{per_cent(shares[worst])} ({worst})",
                link("surfaces/evolution.md"),
            )
        )
    return lines


# one contact


def bars(pages: Pages) -> list[tuple[str, ...]]:
    """How many of the bars of the core are met."""
    rows = pages.rows("film/core.md", "met?")
    met = sum(row["met?"] == "yes" for row in rows if "no bar given" not in row["asked"])
    asked = sum("no bar given" not in row["asked"] for row in rows)
    return [("accuracy and cost that were asked of the core", f"{met} of {asked} met", f"{asked - met} not", link("film/core.md"))]


def finest(pages: Pages) -> list[tuple[str, ...]]:
    """The finest grid on which a steady rough film converges, by lubrication."""
    found = next(row["found"] for row in pages.rows("film/core.md", "met?") if row["asked"].startswith("error against cost"))
    nodes = {name: int(count) for name, count in re.findall(r"(full film|mixed|near boundary) (\d+)", found)}
    ends = (f"{nodes[name]} nodes ({name})" for name in (max(nodes, key=nodes.__getitem__), min(nodes, key=nodes.__getitem__)))
    return [("finest grid on which `point_contact` converges on a steady rough film", *ends, link("film/core_accuracy.md"))]


def smooth_contact(pages: Pages) -> list[tuple[str, ...]]:
    """Errors of smooth films, and what they cost."""
    page, lines = "film/core_cost.md", []
    row = pages.row(page, "algebraic H_c", nodes="129")
    for what, kind in (("iteration", "algebraic"), ("grid", "grid")):
        found = range_of((row[f"{kind} H_c"], row[f"{kind} H_min"]), "{:.1f} %".format)
        cost = f"{number(row['WU']):.0f} WU, {number(row['ms']):.0f} ms"
        lines.append((f"smooth film M = 200, L = 10, 129 nodes, {cost}: error of the {what}", *found, link(page)))
    rows = sorted(pages.rows(page, "off [%]"), key=lambda row: abs(number(row["off [%]"])))
    short = [row for row in rows if row["nodes"] == "257"]
    best, worst = (
        f"{abs(number(row['off [%]'])):.1f} % on {row['nodes']} nodes in {number(row['first [s]']):.2f} s, {row['by']}"
        for row in (short[0], rows[-1])
    )
    lines.append(("smooth case A (14.4 nm), h_central", best, worst, link(page)))
    return lines


def rough_contact(pages: Pages) -> list[tuple[str, ...]]:
    """Cost of moving roughness to 2 % of the pressure; the shipped circles have the short correlation length."""
    asked = {row["asked"]: row["found"] for row in pages.rows("film/core_cost.md", "met?", "Asked")}
    lines = []
    for what, name in (
        ("one warm step of moving roughness", "one node, warm, to 2 %"),
        ("the same step from the dry contact", "cold, from nothing (same step from dry), to 2 %"),
        ("a steady film from nothing", "cold, from nothing (steady film), to 2 %"),
    ):
        cells = []
        for length, which in (("15.6 um", "15.6 um"), ("8 um", "8 um, the shipped circles'")):
            (cell,) = (cell for key, cell in asked.items() if key.startswith(f"{name}, correlation {length}"))
            cells.append(f"{cell} WU ({which})")
        lines.append((f"{what}, to 2 % of the pressure, by correlation length", *cells, link("film/core_cost.md")))
    rows = {row["film.tolerance"]: row for row in pages.rows("film/tolerance.md", "film.tolerance")}
    said = {
        key: f"{number(row['pressure error']):.1f} % in {number(row['iterations']):.0f} iterations"
        for key, row in rows.items()
    }
    ends = (f"{said[key]} ({key})" for key in ("1e-3", "3e-2"))
    lines.append((f"a step of a march: pressure; at the shipped tolerance {said['3e-3']}", *ends, link("film/tolerance.md")))
    return lines


def dry_contact(pages: Pages) -> list[tuple[str, ...]]:
    """Time beside other solvers, and whether all find the same."""
    rows = pages.rows("film/peers.md", "nodes off")
    lines = []
    for name, what in (("tribofmu", "a first call"), ("tribofmu, again", "a second call on the same grid")):
        found = range_of((row["ratio"] for row in rows if row["solver"] == name), "{:.2f}".format)
        lines.append((f"dry rough contact to 1e-8, {what}: time over the fastest other solver's", *found, link("film/peers.md")))
    ours = [row for row in rows if row["solver"] == "tribofmu"]
    found = range_of((row["p_max off"] for row in ours), "{:.0e}".format)
    nodes = range_of((row["nodes off"] for row in ours), "{:.0f}".format)
    ends = (f"{off}; {count}" for off, count in zip(found, nodes, strict=True))
    lines.append(("p_max off a solution to 1e-12; contact nodes that differ", *ends, link("film/peers.md")))
    return lines


def estimates(pages: Pages) -> list[tuple[str, ...]]:
    """Whether the error estimates of single calls are true."""
    page = "film/error_estimate.md"
    text = (pages.folder / page).read_text(encoding="utf-8")
    points, left = map(int, re.findall(r"(\d+) random points on .*?, (\d+) of them left out", text)[0])
    rows = pages.rows(page, "true <= reported")
    low, high = range_of((row["true <= reported"] for row in rows), "{:.0f} % of the points".format)
    small, large = range_of((row["median reported / true"] for row in rows), "{:.1f}".format)
    return [
        (
            f"`error_estimate` of a call covers the true error of {points - left} points, by output",
            *(high, low),
            link(page),
        ),
        ("and is so many times as large, median", small, large, link(page)),
    ]


def grids(pages: Pages) -> list[tuple[str, ...]]:
    """What a finer grid than the shipped one changes."""
    shipped, finest = (pages.row("film/grid.md", "nodes", nodes=nodes) for nodes in ("129", "193"))
    names = {"h_c": "h_c", "friction_coefficient": "friction", "contact_load_ratio": "W_c", "contact_area_ratio": "A_c"}
    change = {name: number(finest[key]) / number(shipped[key]) - 1.0 for key, name in names.items()}
    ends = (
        f"{100.0 * change[name]:+.0f} % ({name})"
        for name in (pick(change, key=lambda name: abs(change[name])) for pick in (min, max))
    )
    shares = range_of((row["contact_load_ratio"] for row in pages.rows("film/grid.md", "nodes")), "{:.2f}".format)
    return [
        ("mtm_zddp on fresh surfaces, from 129 to 193 nodes", *ends, link("film/grid.md")),
        ("its W_c on 65 to 193 nodes", f"{shares[1]} to {shares[0]}", "it belongs to a grid", link("film/grid.md")),
    ]


# FMU, coupling, thesis


def fmu(pages: Pages) -> list[tuple[str, ...]]:
    """What the isolated FMU costs over its model."""
    page, over = "fmu/overhead.md", "over the direct call [us]"
    lines = []
    for slave, what in (("empty", "an empty model"), ("mtm_zddp", "the fast level of mtm_zddp")):
        rows = [row for row in pages.rows(page, over, slave=slave) if row["called by"].startswith("isolated, host in C")]
        rows = [row for row in rows if not row["called by"].endswith("taken back")]
        found = range_of((row[over] for row in rows), "{:.0f} us".format)
        alone = number(pages.row(page, over, slave=slave, **{"called by": "direct call"})["median [us]"])
        ends = (f"{found[0]} on a CPU of its own", f"{found[1]} on any CPU")
        lines.append((f"isolated FMU, a step of {what} ({alone:.0f} us) called from C, over its own time", *ends, link(page)))
    many = pages.rows(page, "instances", flavour="isolated")
    ends = (
        f"{row['instances']}: {row['ready after [s]']} s, {row['memory [MB]']} MB" for row in (many[0], many[-1])
    )
    lines.append(("instances: ready after, memory", *ends, link(page)))
    page = "fmu/endurance.md"
    lost = pages.rows(page, "lost process")
    restored = sorted(lost, key=lambda row: number(row["restored after, median [ms]"]))
    ends = (
        f"{row['restored after, median [ms]']} ms ({row['lost process']}, {row['model']})"
        for row in (restored[0], restored[-1])
    )
    lines.append(("a lost process replaced and its state restored", *ends, link(page)))
    return lines


def coupling(pages: Pages) -> list[tuple[str, ...]]:
    """Accuracy and cost of the co-simulation master."""
    text = (pages.folder / "coupling/accuracy.md").read_text(encoding="utf-8")
    shares = [tuple(map(float, pair)) for pair in re.findall(r"horizon .* s: ([\d.]+) to ([\d.]+) of the tolerance", text)]
    least, most = min(low for low, _ in shares), max(high for _, high in shares)
    lines = [("error over the tolerance asked for, 1e-2 to 1e-6", f"{least:g}", f"{most:g}", link("coupling/accuracy.md"))]
    rows = pages.rows("coupling/masters.md", "ratio")
    low, high = range_of((row["ratio"] for row in rows), "{:.1f}".format)
    lines.append(("steps of the best of three other masters over the best of ours", high, low, link("coupling/masters.md")))
    rows = pages.rows("coupling/cost.md", "beyond")
    for name, newton in (("explicit schemes and fixed-point iteration", False), ("quasi-Newton", True)):
        kept = [row["beyond"] for row in rows if ("quasi-Newton" in row["scheme"]) == newton]
        found = range_of(kept, "{:.0f} us".format)
        lines.append((f"a step per FMU beyond the calls, {name}", *found, link("coupling/cost.md")))
    return lines


def machines(pages: Pages) -> list[tuple[str, ...]]:
    """How often the error of the coupling that a machine states covers what far shorter steps change."""
    rows = pages.rows("machines/tolerance.md", "not covered")
    ranked = sorted(rows, key=lambda row: number(row["not covered"]) / number(row["outputs"]))
    ends = (f"{row['not covered']} of {row['outputs']} ({row['machine']})" for row in (ranked[0], ranked[-1]))
    return [("`error_coupling` of a machine: outputs that it does not cover", *ends, link("machines/tolerance.md"))]


def thesis(pages: Pages) -> list[tuple[str, ...]]:
    """How many claims of the thesis come out, and how many of the others are explained."""
    page = "thesis/validation.md"
    (row,) = (row for row in pages.rows(page, "cannot be judged") if row[""] == "ours")
    total = sum(int(row[name]) for name in ("agree", "disagree", "cannot be judged", "not run"))
    text = (pages.folder / page).read_text(encoding="utf-8")
    said = re.search(
        r"Of the (\d+) that disagree in ours, an experiment makes (\d+) agree and none of those tried (\d+); "
        r"(\d+) have no experiment that was run .*?, (\d+) lack some",
        text,
    )
    if said is None:
        raise LookupError(f"docs/measured/{page} does not say what experiments explain")
    wrong, mended, unknown, none, short = said.groups()
    return [
        (
            "claims of the thesis about the shipped cases",
            f"{row['agree']} of {total} come out",
            f"{row['disagree']} do not, {row['cannot be judged']} cannot be judged",
            link(page),
        ),
        (
            f"of the {wrong} that do not",
            f"an experiment beside {mended} makes them agree",
            f"none tried does for {unknown}; {none} have none, {short} lack some",
            link(page),
        ),
    ]


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


def line_of(cells: Iterable[str]) -> str:
    """A row of a table."""
    return f"| {' | '.join(cells)} |"


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
