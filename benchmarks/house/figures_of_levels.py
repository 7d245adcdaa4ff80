"""Tables of docs/trust.md about the two levels: the regression level, and two hours at the deterministic one."""

import re

from benchmarks.house.figures_of_contacts import ASKED
from benchmarks.house.tables import Pages, Row, link, number, numbers, per_cent, table


def held_back(pages: Pages) -> list[str]:
    """Friction, film and load of the solids on points of every shipped scene that nothing was fitted to."""
    rows = {row["scene"]: row for row in pages.rows("regression/held_back", "mu median", "All")}
    every, lines = rows.pop("all"), []
    for name, short in (("friction", "mu"), ("h_c", "h_c"), ("W_c (of 1)", "W_c")):
        ranked = sorted(rows.values(), key=lambda row: number(row[f"{short} median"]))
        ends = [f"{_shares(row, short, 'median', '90 %')} ({row['scene']})" for row in (ranked[0], ranked[-1])]
        stated, covered = "-", "-"  # of W_c
        if f"{short} covered" in every:
            least = min(rows.values(), key=lambda row: number(row[f"{short} covered"]))
            stated = _shares(every, short, "stated")
            covered = f"{_shares(every, short, 'covered')}, least {_shares(least, short, 'covered')} ({least['scene']})"
        lines.append((name, _shares(every, short, "median", "90 %"), *ends, stated, covered))
    heads = ("deviation: median; 90 %", "best scene", "worst scene", "stated, median", "covered")
    return table((f"{every['points']} points", *heads), lines)


def _shares(row: Row, short: str, *kinds: str) -> str:
    """Return shares of an output, in per cent."""
    return "; ".join(per_cent(number(row[f"{short} {kind}"])) for kind in kinds)


def two_hours(pages: Pages) -> list[str]:
    """Cost and deviations of two hours of rubbing of both scenes, and how often the stated errors cover them."""
    every, lines = pages.rows("speed_error", "wear 1", "Two hours"), []
    names = ("friction", "h_c", "W_c", "tribofilm 1", "tribofilm 2", "wear 1", "wear 2")
    for setting in ("regression", "20 %", "10 %", "257 nodes"):
        for row in (row for row in every if row["setting"] == setting):
            found = [numbers(row[name]) for name in names if setting != "257 nodes"]
            off = [f"{error:.1f} ({covered:.0f} %)" for error, covered in found] or ["-"] * len(names)
            scene = row["case"].partition(",")[0]
            lines.append((ASKED.get(setting, setting), scene, row["nodes"], row["CPU [s]"], *off))
    return table(("asked for", "scene", "nodes", "CPU s", *names), lines)


def grids_in_time(pages: Pages) -> tuple[str, ...]:
    """How often the stated errors of two hours cover what a finer grid changes, where that is least."""
    page, found = "film/two_hours", []
    for row in pages.rows(page, "asked"):
        match = re.match(r"(\w+), 129 nodes against 257: bands cover it at (\d+ %)", row["asked"])
        if match:
            shares = (part.rpartition(" ") for part in row["found"].split(", "))
            found += [(int(share), name, match[1], match[2]) for name, _, share in shares]
    share, name, scene, asked = min(found)
    met = sum(share >= int(asked.partition(" ")[0]) for share, *_ in found)
    said = f"{met} of {len(found)} outputs as often as asked for; least {share} % of the times ({name}, {scene})"
    return ("of two hours on 129 nodes, against 257", said, f"{asked} of the times", link(page))


def fast_step(pages: Pages) -> list[tuple[str, ...]]:
    """The time of a step."""
    page = "regression/cost"
    lines = []
    for name, shipped in (("as shipped", True), ("with other laws", False)):
        rows = [row for row in pages.rows(page, "median [us]") if (row["laws"] == "as shipped") == shipped]
        ranked = sorted(rows, key=lambda row: number(row["median [us]"]))
        ends = (
            f"{number(row['5 % [us]']):.0f}; {number(row['median [us]']):.0f}; {number(row['95 % [us]']):.0f} us "
            f"({row['scene'] if shipped else row['laws']})"
            for row in (ranked[0], ranked[-1])
        )
        lines.append((f"a step of the regression level {name}: 5 %; median; 95 %", *ends, link(page)))
    return lines


# the deterministic level over two hours


def drivers(pages: Pages) -> list[str]:
    """Errors of two hours by driver: azam_case_a against finer blocks, and dry driving against mixed."""
    heads = ("scene", "`control.driver`", "against", "blocks, of them dry", "CPU s; WU")
    names = ("friction", "h_c", "W_c", "A_c", "tribofilm", "wear", "Rq disc", "Rq ball", "covered")
    columns = (("mu",), ("h_c",), ("W_c",), ("A_c",), ("film 1", "film 2"), ("wear 1", "wear 2"), ("Rq 2",), ("Rq 1",))
    page, case = "surfaces/evolution", "azam_case_a"
    by_rule = pages.rows(page, "dry blocks", "At the same surfaces")
    dry = {(row["case"], row["driver"]): row["dry blocks"] for row in by_rule} | {(case, "mixed"): "0"}
    rows = [
        (case, row["driver"], "ten times finer blocks", dry[case, row["driver"]], row)
        for row in pages.rows(page, "blocks", "The shipped control")
        if row["mu"]
    ]
    rows += [(row["case"], row["driver"], "the same driven mixed", row["dry blocks"], row) for row in by_rule]
    lines = []
    for scene, driver, against, dry_blocks, row in rows:
        if driver not in ("mixed", "dry"):  # a section of older code has a third one
            continue
        errors = (f"{max(number(row[column]) for column in columns_):.1f} %" for columns_ in columns)
        named = f"{driver} (as shipped)" if driver == "mixed" else driver
        cost = f"{number(row['s']):.0f}; {number(row['WU']):.1e}".replace("e+0", "e")
        lines.append((scene, named, against, f"{row['blocks']}, {dry_blocks}", cost, *errors, _covered(row)))
    return table((*heads, *names), lines)


def _covered(row: Row) -> str:
    """Return how many outputs the stated half widths cover at 90 % of the times, and the least of them."""
    shares = {name: float(cell[cell.index("(") + 1 : -1]) for name, cell in row.items() if cell.endswith(")")}
    if not shares:
        return "-"
    worst = min(shares, key=shares.__getitem__)
    return f"{sum(share >= 0.9 for share in shares.values())} of {len(shares)}; {worst} {per_cent(shares[worst])}"
