"""Figures of docs/how_good.md about the two levels: the regression level, and two hours at the deterministic one."""

from benchmarks.house.tables import Pages, Row, line_of, link, number, per_cent


def held_back(pages: Pages) -> list[tuple[str, ...]]:
    """Friction, film and load of the solids on points of every shipped scene that nothing was fitted to."""
    page, lines = "regression/held_back", []
    rows = {row["scene"]: row for row in pages.rows(page, "mu median", "All")}
    every = rows.pop("all")
    for name, short in (("friction", "mu"), ("h_c", "h_c"), ("W_c (of 1)", "W_c")):

        def ends(row: Row, short: str = short) -> str:
            return "; ".join(per_cent(number(row[f"{short} {kind}"])) for kind in ("median", "90 %"))

        ranked = sorted(rows.values(), key=lambda row, short=short: number(row[f"{short} median"]))
        what = f"deviation of {name} at {every['points']} points that nothing was fitted to: median; 90 %; all: {ends(every)}"
        lines.append((what, *(f"{ends(row)} ({row['scene']})" for row in (ranked[0], ranked[-1])), link(page)))
    shares = sorted(rows.values(), key=lambda row: -number(row["mu covered"]))
    what = f"share of them that `error_friction` covers, and its median; all: {per_cent(number(every['mu covered']))}; {per_cent(number(every['mu stated']))}"
    best, worst = (
        f"{per_cent(number(row['mu covered']))}; {per_cent(number(row['mu stated']))} ({row['scene']})"
        for row in (shares[0], shares[-1])
    )
    lines.append((what, best, worst, link(page)))
    return lines


def two_hours(pages: Pages) -> list[tuple[str, ...]]:
    """Deviations over two hours of rubbing, which the curves were not fitted to, and the time of both levels."""
    page, lines = "speed_error", []
    rows = {row["case"].partition(",")[0]: row for row in pages.rows(page, "wear 1", "Two hours", setting="regression")}
    for name in ("friction", "h_c", "W_c", "tribofilm 1", "tribofilm 2", "wear 1", "wear 2"):
        ranked = sorted(rows, key=lambda scene, name=name: number(rows[scene][name]))
        ends = (f"{number(rows[scene][name]):.1f} % ({scene})" for scene in (ranked[0], ranked[-1]))
        lines.append((f"{name} over two hours of rubbing, median of the deviation", *ends, link(page)))
    finest = {row["case"].partition(",")[0]: row for row in pages.rows(page, "wear 1", "Two hours", setting="10 %")}
    ratios = {scene: number(finest[scene]["CPU [s]"]) / number(rows[scene]["CPU [s]"]) for scene in rows}
    best, worst = (f"{pick(ratios.values()):.0f}" for pick in (max, min))
    lines.append(("CPU time over that of the regression level, 129 nodes", best, worst, link(page)))
    return lines


def fast_step(pages: Pages) -> list[tuple[str, ...]]:
    """Return the time of a step."""
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
        lines.append((f"time of a step {name}: 5 %; median; 95 %", *ends, link(page)))
    return lines


# the deterministic level over two hours


def drivers(pages: Pages) -> list[str]:
    """Errors of two hours by driver: azam_case_a against finer blocks, mtm_zddp against mixed driving."""
    heads = ("scene", "`control.driver`", "against", "blocks", "of them dry", "CPU s", "WU")
    names = ("friction", "h_c", "W_c", "A_c", "tribofilm", "wear", "Rq disc", "Rq ball")
    columns = (("mu",), ("h_c",), ("W_c",), ("A_c",), ("film 1", "film 2"), ("wear 1", "wear 2"), ("Rq 2",), ("Rq 1",))
    page, case = "surfaces/evolution", "azam_case_a"
    by_rule = pages.rows(page, "dry blocks", "At the same surfaces")
    dry = {(row["case"], row["driver"]): row["dry blocks"] for row in by_rule} | {(case, "mixed"): "0"}
    rows = [
        (case, row["driver"], "ten times finer blocks", dry[case, row["driver"]], row)
        for row in pages.rows(page, "blocks", "The shipped control")
        if row["mu"]
    ]
    shown = {driver for _, driver, *_ in rows}
    main = "auto" if "auto" in shown else "mixed"  # of scenes as they ship
    rows += [
        (row["case"], row["driver"], "the same driven mixed", row["dry blocks"], row)
        for row in by_rule
        if (row["case"], row["driver"]) != (case, "auto")  # that is among the first
    ]
    lines = [line_of((*heads, *names)), "|" + "---|" * (len(heads) + len(names))]
    for scene, driver, against, dry, row in rows:
        errors = (f"{max(number(row[column]) for column in columns_):.1f} %" for columns_ in columns)
        shipped = f"{driver} (shipped)" if driver == main else driver
        share = f"{dry} ({100.0 * int(dry) / int(row['blocks']):.0f} %)"
        cost = (f"{number(row['s']):.0f}", f"{number(row['WU']):.1e}".replace("e+0", "e"))
        lines.append(line_of((scene, shipped, against, row["blocks"], share, *cost, *errors)))
    return lines


def half_widths(pages: Pages) -> list[tuple[str, ...]]:
    """Return the share of the times at which the error is within the stated half widths."""
    lines = []
    for row in pages.rows("surfaces/evolution", "blocks", "The shipped control"):
        shares = {name: float(cell[cell.index("(") + 1 : -1]) for name, cell in row.items() if cell.endswith(")")}
        if not shares:
            continue
        worst = min(shares, key=shares.__getitem__)
        held = sum(share >= 0.9 for share in shares.values())
        lines.append(
            (
                f"azam_case_a driven {row['driver']}: share of the times at which `uncertainty(state)` covers the error; "
                f"at least 90 % in {held} of {len(shares)} outputs",
                per_cent(max(shares.values())),
                f"{per_cent(shares[worst])} ({worst})",
                link("surfaces/evolution"),
            )
        )
    return lines
