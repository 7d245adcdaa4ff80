"""Tables of docs/trust.md about FMU, coupling, machines and the thesis."""

import re

from benchmarks.house.tables import Pages, link, number, range_of, table


def fmu(pages: Pages) -> list[tuple[str, ...]]:
    """The cost of the isolated FMU over its model."""
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
    lines.append(("instances of an isolated FMU: ready after, memory", *ends, link(page)))
    native = [number(row["median [us]"]) for row in pages.rows("fmu/native", "median [us]", round="five outputs")]
    native_ends = (f"{end(native):.2f} us" for end in (min, max))
    lines.append(
        ("native FMU, a step of the regression level with five outputs: median", *native_ends, link("fmu/native"))
    )
    return lines


def coupling(pages: Pages) -> list[tuple[str, ...]]:
    """Accuracy of the co-simulation master."""
    text = pages.text("coupling/accuracy")
    shares = [
        tuple(map(float, pair)) for pair in re.findall(r"horizon .* s: ([\d.]+) to ([\d.]+) of the tolerance", text)
    ]
    least, most = min(low for low, _ in shares), max(high for _, high in shares)
    return [
        (
            "the master's error over the tolerance that is asked for, 1e-2 to 1e-6",
            f"{least:g}",
            f"{most:g}",
            link("coupling/accuracy"),
        )
    ]


def machines(pages: Pages) -> tuple[str, ...]:
    """How often the stated error of the coupling covers the change by far shorter steps."""
    rows = pages.rows("machines/tolerance", "not covered")
    ranked = sorted(rows, key=lambda row: number(row["not covered"]) / number(row["outputs"]))
    best, worst = (
        f"{int(row['outputs']) - int(row['not covered'])} of {row['outputs']} outputs ({row['machine']})"
        for row in (ranked[0], ranked[-1])
    )
    return (
        "`error_coupling` of a machine, against far shorter steps",
        f"{worst}; {best}",
        "all",
        link("machines/tolerance"),
    )


def thesis(pages: Pages) -> list[str]:
    """How many claims of the thesis agree, and how many of the others have a cause shown, as shipped and as read."""
    names, lines = ("agree", "disagree, cause shown", "cannot be judged"), []
    for column, what in (("ours", "as shipped"), ("joint reading", "in the joint reading")):
        (row,) = (row for row in pages.rows("thesis/validation", "not run") if row[""] == column)
        total = sum(int(row[name]) for name in ("agree", "disagree", "cannot be judged", "not run"))
        left = int(row["disagree"]) - int(row["disagree, cause shown"])
        lines.append((what, str(total), *(row[name] for name in names), str(left), link("thesis/validation")))
    heads = ("the thesis's cases", "claims", "agree", "disagree, cause shown", "cannot be judged", "disagree, no cause")
    return table((*heads, "measured in"), lines)
