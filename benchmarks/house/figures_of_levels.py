"""Figures of docs/how_good.md about the two levels: the regression level, and two hours at the deterministic one."""

from benchmarks.house.tables import Pages, Row, line_of, link, number, pair, per_cent

HOURS = {
    "wear": ("ball's wear nm", "disc's wear nm"),
    "friction": ("mu",),
    "h_c": ("h_c nm",),
    "W_c": ("W_c",),
    "A_c": ("A_c",),
    "roughness of the disc": ("disc's roughness nm",),
}


def held_back(pages: Pages) -> list[tuple[str, ...]]:
    """Friction, film and load of the solids on points of every shipped scene that nothing was fitted to."""
    page, lines = "regression/held_back.md", []
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
    lines.append(grown(pages))
    times = [slow / fast for slow, fast in (pair(row["CPU s"]) for row in rows if row["min"] == "120")]
    lines.append(("ratio of their CPU times", f"{max(times):.0f}", f"{min(times):.0f}", link("regression/curves.md")))
    return lines


def grown(pages: Pages) -> tuple[str, ...]:
    """Deviation of the ball's tribofilm after 20 minutes of rubbing."""
    page, mine = "surfaces/tribofilm.md", "regression level: ball nm"
    rows = [row for row in pages.rows(page, mine) if number(row["ball nm"]) > 1.0]
    off = [number(row[mine]) / number(row["ball nm"]) - 1.0 for row in rows]
    shown = [
        (f"{100.0 * x:+.2g} %", next(iter(row.items())))
        for x, row in sorted(zip(off, rows, strict=True), key=lambda one: abs(one[0]))
    ]
    (best, _), (worst, (name, value)) = shown[0], shown[-1]
    return (
        f"tribofilm of the ball after 20 min at {len(rows)} ratios, speeds, loads and temperatures",
        best,
        f"{worst} ({name} {value})",
        link(page),
    )


def covered(rows: list[Row], column: str) -> tuple[int, int]:
    """Return covered points and all points, from cells such as "97 % of 34"."""
    counts = [(round(number(row[column]) / 100.0 * int(row[column].split(" of ")[1])), row[column]) for row in rows]
    return sum(count for count, _ in counts), sum(int(cell.split(" of ")[1]) for _, cell in counts)


def error_outputs(pages: Pages) -> list[tuple[str, ...]]:
    """Return how often the error outputs cover the deviation where nothing was fitted."""
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
                    f"`error_{name}` covers {hit} of {count} {which} of gears, bearings and an MTM, not used in any fit",
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
    lines.append((f"both cover {sum(every)} of {len(every)} rubbed surfaces", *ends, link(page)))
    return lines


def fast_step(pages: Pages) -> list[tuple[str, ...]]:
    """Return the time of a step."""
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
        lines.append((f"time of a step {name}: 5 %; median; 95 %", *ends, link(page)))
    return lines


# the deterministic level over two hours


def drivers(pages: Pages) -> list[str]:
    """Errors of two hours by driver: azam_case_a against finer blocks, mtm_zddp against mixed driving."""
    heads = ("scene", "`control.driver`", "against", "blocks", "of them dry", "CPU s", "WU")
    names = ("friction", "h_c", "W_c", "A_c", "tribofilm", "wear", "Rq disc", "Rq ball")
    columns = (("mu",), ("h_c",), ("W_c",), ("A_c",), ("film 1", "film 2"), ("wear 1", "wear 2"), ("Rq 2",), ("Rq 1",))
    control = {
        row["driver"]: row for row in pages.rows("surfaces/evolution.md", "blocks", "The shipped control") if row["mu"]
    }
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
    """Return the share of the times at which the error is within the stated half widths."""
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
                f"at least 90 % in {held} of {len(shares)} outputs",
                per_cent(max(shares.values())),
                f"{per_cent(shares[worst])} ({worst})",
                link("surfaces/evolution.md"),
            )
        )
    return lines
