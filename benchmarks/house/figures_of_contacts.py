"""Figures of docs/how_good.md about one contact at one instant."""

import re

from benchmarks.house.tables import Pages, link, number, range_of

CORE = tuple(f"film/core_{part}.md" for part in ("smooth", "cost", "accuracy", "lambda", "starts"))


def bars(pages: Pages) -> list[tuple[str, ...]]:
    """Return how many requirements of the core are met."""
    rows = [row for page in CORE for row in pages.rows(page, "met?", "Asked")]
    met = sum(row["met?"] == "yes" for row in rows if "no bar given" not in row["asked"])
    asked = sum("no bar given" not in row["asked"] for row in rows)
    return [
        (
            "requirements on accuracy and cost of the core",
            f"{met} of {asked} met",
            f"{asked - met} not met",
            link(*CORE),
        )
    ]


def finest(pages: Pages) -> list[tuple[str, ...]]:
    """The finest grid on which a steady rough film converges, by lubrication."""
    found = next(
        row["found"]
        for row in pages.rows("film/core_accuracy.md", "met?")
        if row["asked"].startswith("error against cost")
    )
    nodes = {name: int(count) for name, count in re.findall(r"(full film|mixed|near boundary) (\d+)", found)}
    ends = (
        f"{nodes[name]} nodes ({name})"
        for name in (max(nodes, key=nodes.__getitem__), min(nodes, key=nodes.__getitem__))
    )
    return [
        ("finest grid on which `point_contact` converges on a steady rough film", *ends, link("film/core_accuracy.md"))
    ]


def smooth_contact(pages: Pages) -> list[tuple[str, ...]]:
    """Errors of smooth films, and what they cost."""
    page, lines = "film/core_cost.md", []
    row = pages.rows(page, "algebraic H_c", nodes="129")[-1]  # of as many cycles as are enough
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
    lines.append(
        (f"a step of a march: pressure; at the shipped tolerance {said['3e-3']}", *ends, link("film/tolerance.md"))
    )
    return lines


def dry_contact(pages: Pages) -> list[tuple[str, ...]]:
    """Time beside other solvers, and whether all find the same."""
    rows = pages.rows("film/peers.md", "nodes off")
    lines = []
    for name, what in (("tribofmu", "a first call"), ("tribofmu, again", "a second call on the same grid")):
        found = range_of((row["ratio"] for row in rows if row["solver"] == name), "{:.2f}".format)
        lines.append(
            (f"dry rough contact to 1e-8, {what}: time over the fastest other solver's", *found, link("film/peers.md"))
        )
    ours = [row for row in rows if row["solver"] == "tribofmu"]
    found = range_of((row["p_max off"] for row in ours), "{:.0e}".format)
    nodes = range_of((row["nodes off"] for row in ours), "{:.0f}".format)
    ends = (f"{off}; {count}" for off, count in zip(found, nodes, strict=True))
    lines.append(("p_max off a solution to 1e-12; contact nodes that differ", *ends, link("film/peers.md")))
    return lines


def estimates(pages: Pages) -> list[tuple[str, ...]]:
    """Return how often the error estimates of single calls cover the true error."""
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
        ("ratio of estimate and true error, median", small, large, link(page)),
    ]


def grids(pages: Pages) -> list[tuple[str, ...]]:
    """Return how the first block changes from the shipped grid to a finer one, by scene, mean over realisations."""
    page, names = "film/moving.md", {"h_c [nm]": "h_c", "friction": "friction", "W_c": "W_c", "A_c": "A_c"}
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
