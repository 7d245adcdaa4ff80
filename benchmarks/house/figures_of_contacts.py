"""Tables of docs/trust.md about one contact at one instant, and about stated errors."""

import re
from collections.abc import Iterator
from statistics import median

from benchmarks.house.tables import Pages, Row, link, number, numbers, per_cent, range_of, table

ASKED = {"regression": "the regression level", "20 %": "20 %", "10 %": "10 %", "5 %": "5 %"}  # by the section's names


def contacts(pages: Pages) -> list[str]:
    """Cost and true errors of single contacts, by what is asked for, and how many of them the stated errors cover."""
    every, lines = pages.rows("speed_error", "CPU [s]", "Single contacts"), []
    names = ("friction", "h_c", "W_c", "wear rate")
    for setting, asked in ASKED.items():
        rows = [row for row in every if row["setting"] == setting]
        seconds = range_of((row["CPU [s]"] for row in rows), "{:.2g}".format)
        off = (
            f"{median(found):.1f}; {max(found):.1f}"
            for found in ([number(row[name]) for row in rows] for name in names)
        )
        covered = "; ".join(per_cent(_covered(rows, name)) for name in names[:3])
        lines.append((asked, str(len(rows)), " to ".join(seconds), *off, covered))
    heads = ("asked for", "contacts", "CPU s", *(f"{name} off: median; most" for name in names))
    return table((*heads, "covered: friction; h_c; W_c"), lines)


def _covered(rows: list[Row], name: str) -> float:
    """Return the share of contacts whose stated error, in brackets, covers the true one."""
    found = [numbers(row[name]) for row in rows]
    return sum(true <= stated for true, stated in found) / len(found)


def estimates(pages: Pages) -> tuple[str, ...]:
    """How often the error estimates of single calls cover the true error."""
    page = "film/error_estimate"
    points, left = map(int, re.findall(r"(\d+) random points on .*?, (\d+) of them left out", pages.text(page))[0])
    rows = pages.rows(page, "true <= reported")
    low, high = range_of((row["true <= reported"] for row in rows), "{:.0f}".format)
    ratios = " to ".join(range_of((row["median reported / true"] for row in rows), "{:.1f}".format))
    found = f"{low} to {high} % of {points - left} points, by output; {ratios} times the true error in the median"
    return ("`error_estimate` of one call", found, "90 %", link(page))


def bounds(pages: Pages) -> Iterator[tuple[str, ...]]:
    """How often other stated errors of contacts cover the true ones."""
    for page, start, what in (
        ("film/grid_error", "stated errors", "of a block: friction, h_c and W_c against finer grids"),
        ("film/inlet", "stated losses", "of a film whose inlet the domain cuts off"),
    ):
        (row,) = (row for row in pages.rows(page, "asked") if row["asked"].startswith(start))
        (asked,) = re.findall(r"\d+ to \d+ %", row["asked"])
        yield what, row["found"], asked, link(page)


def steps(pages: Pages) -> list[tuple[str, ...]]:
    """A step of a march against the tolerance."""
    rows = {row["film.tolerance"]: row for row in pages.rows("film/tolerance", "film.tolerance")}
    said = {
        key: f"{number(row['pressure error']):.1f} % in {number(row['iterations']):.0f} iterations"
        for key, row in rows.items()
    }
    what = f"pressure of a step of a march off, by `film.tolerance`; as shipped {said['3e-3']}"
    return [(what, *(f"{said[key]} ({key})" for key in ("1e-3", "3e-2")), link("film/tolerance"))]


def dry_contact(pages: Pages) -> list[tuple[str, ...]]:
    """Time over that of other solvers, and whether all find the same."""
    rows = pages.rows("film/peers", "nodes off")
    lines = []
    for name, what in (("tribofmu", "a first call"), ("tribofmu, again", "a second call on the same grid")):
        found = range_of((row["ratio"] for row in rows if row["solver"] == name), "{:.2f}".format)
        lines.append(
            (f"dry rough contact to 1e-8, {what}: time over the fastest other solver's", *found, link("film/peers"))
        )
    ours = [row for row in rows if row["solver"] == "tribofmu"]
    found = range_of((row["p_max off"] for row in ours), "{:.0e}".format)
    nodes = range_of((row["nodes off"] for row in ours), "{:.0f}".format)
    ends = (f"{off}; {count}" for off, count in zip(found, nodes, strict=True))
    lines.append(("its p_max off a solution to 1e-12; contact nodes that differ", *ends, link("film/peers")))
    return lines


def grids(pages: Pages) -> list[tuple[str, ...]]:
    """How the first block changes from the shipped grid to a finer one, by scene, mean over realisations."""
    page, names = "film/moving", {"h_c [nm]": "h_c", "friction": "friction", "W_c": "W_c", "A_c": "A_c"}
    lines = []
    for scene in ("azam_case_a", "mtm_zddp"):
        found = {nodes: pages.rows(page, "realisation", scene=scene, nodes=nodes) for nodes in ("65", "129", "257")}
        for coarse in ("65", "129"):
            pairs = list(zip(found[coarse], found["257"], strict=True))
            change = {
                name: sum(number(fine[key]) / number(row[key]) - 1.0 for row, fine in pairs) / len(pairs)
                for key, name in names.items()
            }
            ends = (
                f"{100.0 * change[name]:+.0f} % ({name})"
                for name in (pick(change, key=lambda name: abs(change[name])) for pick in (min, max))
            )
            lines.append(
                (f"first block of {scene}, from {coarse} to 257 nodes, mean of three realisations", *ends, link(page))
            )
    return lines
