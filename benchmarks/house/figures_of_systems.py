"""Figures of docs/how_good.md about FMU, coupling, machines and the thesis."""

import re

from benchmarks.house.tables import Pages, link, number, range_of


def fmu(pages: Pages) -> list[tuple[str, ...]]:
    """Return the cost of the isolated FMU over its model."""
    page, over = "fmu/overhead", "over the direct call [us]"
    lines = []
    for slave, what in (("empty", "an empty model"), ("mtm_zddp", "the regression level of mtm_zddp")):
        rows = [
            row for row in pages.rows(page, over, slave=slave) if row["called by"].startswith("isolated, host in C")
        ]
        rows = [row for row in rows if not row["called by"].endswith("taken back")]
        found = range_of((row[over] for row in rows), "{:.0f} us".format)
        alone = number(pages.row(page, over, slave=slave, **{"called by": "direct call"})["median [us]"])
        ends = (f"{found[0]} on a CPU of its own", f"{found[1]} on any CPU")
        lines.append(
            (f"isolated FMU, a step of {what} ({alone:.0f} us) called from C, over its own time", *ends, link(page))
        )
    many = pages.rows(page, "instances", flavour="isolated")
    ends = (f"{row['instances']}: {row['ready after [s]']} s, {row['memory [MB]']} MB" for row in (many[0], many[-1]))
    lines.append(("instances: ready after, memory", *ends, link(page)))
    return lines


def coupling(pages: Pages) -> list[tuple[str, ...]]:
    """Accuracy and cost of the co-simulation master."""
    text = pages.text("coupling/accuracy")
    shares = [
        tuple(map(float, pair)) for pair in re.findall(r"horizon .* s: ([\d.]+) to ([\d.]+) of the tolerance", text)
    ]
    least, most = min(low for low, _ in shares), max(high for _, high in shares)
    return [("error over the requested tolerance, 1e-2 to 1e-6", f"{least:g}", f"{most:g}", link("coupling/accuracy"))]


def machines(pages: Pages) -> list[tuple[str, ...]]:
    """Return how often the stated error of the coupling covers the change by far shorter steps."""
    rows = pages.rows("machines/tolerance", "not covered")
    ranked = sorted(rows, key=lambda row: number(row["not covered"]) / number(row["outputs"]))
    ends = (f"{row['not covered']} of {row['outputs']} ({row['machine']})" for row in (ranked[0], ranked[-1]))
    return [("`error_coupling` of a machine: outputs not covered", *ends, link("machines/tolerance"))]


def thesis(pages: Pages) -> list[tuple[str, ...]]:
    """Return how many claims of the thesis agree, and how many of the others have a cause shown, as shipped and as read."""
    page, found = "thesis/validation", []
    for column, what in (("ours", "the shipped cases"), ("joint reading", "its cases in the joint reading")):
        (row,) = (row for row in pages.rows(page, "cannot be judged") if row[""] == column)
        total = sum(int(row[name]) for name in ("agree", "disagree", "cannot be judged", "not run"))
        left = int(row["disagree"]) - int(row["disagree, cause shown"])
        found.append(
            (
                f"claims of the thesis about {what}",
                f"{row['agree or cause shown']} of {total} agree ({row['agree']}) or have a cause shown",
                f"{left} without a cause, {row['cannot be judged']} cannot be judged",
                link(page),
            )
        )
    return found
