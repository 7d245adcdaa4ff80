"""Figures of docs/how_good.md about one contact at one instant."""

import re

from benchmarks.house.tables import Pages, link, number, range_of


def steps(pages: Pages) -> list[tuple[str, ...]]:
    """A step of a march against the tolerance."""
    rows = {row["film.tolerance"]: row for row in pages.rows("film/tolerance", "film.tolerance")}
    said = {
        key: f"{number(row['pressure error']):.1f} % in {number(row['iterations']):.0f} iterations"
        for key, row in rows.items()
    }
    what = f"a step of a march: pressure; at the shipped tolerance {said['3e-3']}"
    return [(what, *(f"{said[key]} ({key})" for key in ("1e-3", "3e-2")), link("film/tolerance"))]


def accuracies(pages: Pages) -> list[tuple[str, ...]]:
    """Cost and true error of single contacts, by level and by the accuracy asked for."""
    lines, every = [], pages.rows("speed_error", "CPU [s]", "Single contacts")
    for setting in ("regression", "20 %", "10 %"):
        rows = sorted(
            (row for row in every if row["setting"] == setting and row["friction"] != "-"),
            key=lambda row: number(row["friction"]),
        )
        ends = (f"{number(row['friction']):.1f} % ({row['case']})" for row in (rows[0], rows[-1]))
        seconds = sorted(number(row["CPU [s]"]) for row in rows)
        level = "regression level" if setting == "regression" else f"accuracy of {setting} asked for"
        what = f"a contact, {level}, {seconds[0]:.2g} to {seconds[-1]:.2g} s: friction off"
        lines.append((what, *ends, link("speed_error")))
    return lines


def dry_contact(pages: Pages) -> list[tuple[str, ...]]:
    """Time beside other solvers, and whether all find the same."""
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
    lines.append(("p_max off a solution to 1e-12; contact nodes that differ", *ends, link("film/peers")))
    return lines


def estimates(pages: Pages) -> list[tuple[str, ...]]:
    """Return how often the error estimates of single calls cover the true error."""
    page = "film/error_estimate"
    text = pages.text(page)
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
        ("ratio of estimate and true error, median", small, large, link(page)),
    ]


def grids(pages: Pages) -> list[tuple[str, ...]]:
    """Return how the first block changes from the shipped grid to a finer one, by scene, mean over realisations."""
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
