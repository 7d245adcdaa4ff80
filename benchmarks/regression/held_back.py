"""The regression level on contacts that nothing was fitted to, on new and on rubbed surfaces of every shipped scene.

    python -m benchmarks.regression.held_back solve  # the points by the deterministic level: an hour
    python -m benchmarks.regression.held_back page   # both levels: docs/measured/regression.md and .png

Solved points stay in results/regression_held_back: `solve` solves what is missing there, `page` shows what is there.
"""

import argparse
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from benchmarks.pages import Page
from benchmarks.regression.held_back_points import (
    FASTER,
    FRESH,
    MINUTES,
    RANGES,
    RUB,
    RUBBED,
    Held,
    held,
    solved,
    stored,
)
from contact_core import RangeFlag, advance, initial_state
from contact_core.state import Mean, Outputs

POOLED = "all"
ERRORS = {"friction_coefficient": "error_friction", "h_c": "error_film"}
UNSURE = RangeFlag.NOT_CONVERGED | RangeFlag.FALLBACK | RangeFlag.DOMAIN_EDGE
ASKED = {"median": 0.07, "90 %": 0.20, "stated": 0.15, "covered": (0.90, 0.99)}  # of friction
COLOURS = dict(zip(RANGES, ("#2471a3", "#16a085", "#e67e22", "#8e44ad", "#c0392b"), strict=True))


@dataclass(frozen=True)
class Compared:
    """A held-back point at both levels."""

    point: Held
    deep: dict[str, Any]
    fast: Outputs

    @property
    def rubbed(self) -> bool:
        """Whether the surfaces have rubbed."""
        return self.point.minutes > 0.0

    @property
    def outside(self) -> bool:
        """Whether the regression level says that the point lies outside its fit."""
        return bool(self.fast.range_flags & RangeFlag.OUTSIDE_FIT)

    def off(self, name: str) -> float:
        """Deterministic over regression level, less one."""
        return float(self.deep[name] / getattr(self.fast, name) - 1.0)

    def stated(self, name: str) -> float:
        """Half width that the regression level states, relative."""
        return float(getattr(self.fast, ERRORS[name]))

    @property
    def off_load(self) -> float:
        """Difference of the load ratios."""
        return float(self.deep["contact_load_ratio"] - self.fast.contact_load_ratio)


def compared() -> tuple[list[Compared], list[str]]:
    """Return all points that can be judged, and what the deterministic level refused or did not finish."""
    found, left = list[Compared](), list[str]()
    for name in RANGES:
        for point, row in stored(name):
            if "refused" in row:
                left.append(f"{name}: {row['refused']}")
            elif int(row["range_flags"]) & UNSURE:
                left.append(
                    f"{name}: {' and '.join(f.name.lower() for f in RangeFlag(int(row['range_flags'])) & UNSURE)}"
                )
            else:
                found.append(Compared(point, row, fast(point, row)))
    return found, left


def fast(point: Held, row: dict[str, Any]) -> Outputs:
    """Return the outputs of the regression level on the same surfaces."""
    scene = point.build().at_level("regression")
    state = initial_state(scene)
    if row["means"]:
        first, second = (Mean(**mean) for mean in row["means"])
        state = replace(state, means=(first, second))
    return advance(scene, point.operating_point, state, 0.0)[1]


def figures(rows: list[Compared], name: str) -> tuple[float, float, float, float]:
    """Return median and 90 % of the deviation, the median half width that is stated, and the share it covers."""
    off, stated = np.abs([r.off(name) for r in rows]), np.array([r.stated(name) for r in rows])
    return float(np.median(off)), float(np.quantile(off, 0.9)), float(np.median(stated)), float(np.mean(off <= stated))


def summary(page: Page, rows: list[Compared]) -> None:
    """Add a table of each scene and of all."""
    names = ("mu", "h_c")
    heads = [f"{n} {what}" for n in names for what in ("median", "90 %", "stated", "covered")]
    page.header("scene", "points", "outside the fit", *heads, "W_c median", "W_c 90 %")
    for scene in (*RANGES, POOLED):
        kept = [r for r in rows if scene in (r.point.scene, POOLED)]
        if kept:
            load = np.abs([r.off_load for r in kept])
            numbers = [f"{x:.3f}" for name in ERRORS for x in figures(kept, name)]
            loads = [f"{float(x):.3f}" for x in (np.median(load), np.quantile(load, 0.9))]
            page.row(scene, len(kept), sum(r.outside for r in kept), *numbers, *loads)


def verdicts(page: Page, rows: list[Compared]) -> None:
    """Add what was asked of friction."""
    median, ninety, stated, covered = figures(rows, "friction_coefficient")
    low, high = ASKED["covered"]
    page.verdict("friction: median of the deviation at most 7 %", f"{100 * median:.1f} %", median <= ASKED["median"])
    page.verdict("friction: 90 % of the deviations at most 20 %", f"{100 * ninety:.1f} %", ninety <= ASKED["90 %"])
    page.verdict("friction: median half width stated at most 15 %", f"{100 * stated:.1f} %", stated <= ASKED["stated"])
    page.verdict("friction: 90 to 99 % covered", f"{100 * covered:.0f} % of {len(rows)}", low <= covered <= high)


def points_page(page: Page, rows: list[Compared]) -> None:
    """Add every point."""
    page.header(
        "scene", "minutes", "load N", "u_e m/s", "SRR", "degC", "tribofilms nm", "mu deterministic", "mu regression",
        "deviation", "stated", "h_c nm", "W_c", "fit",
    )  # fmt: skip
    for r in rows:
        p, out = r.point, r.fast
        page.row(
            p.scene, p.minutes, f"{p.load:.3g}", f"{p.speed:.3g}", f"{p.srr:+.3g}", f"{p.temperature - 273.15:.0f}",
            f"{1e9 * out.tribofilm_1:.0f}, {1e9 * out.tribofilm_2:.0f}", f"{r.deep['friction_coefficient']:.4f}",
            f"{out.friction_coefficient:.4f}", f"{r.off('friction_coefficient'):+.3f}",
            f"{r.stated('friction_coefficient'):.3f}", f"{1e9 * r.deep['h_c']:.0f} / {1e9 * out.h_c:.0f}",
            f"{r.deep['contact_load_ratio']:.3f} / {out.contact_load_ratio:.3f}", "outside" if r.outside else "within",
        )  # fmt: skip


def draw(rows: list[Compared]) -> Figure:
    """Friction of both levels with the half widths stated; filled: rubbed surfaces."""
    figure = Figure(figsize=(5.6, 5.2), layout="constrained")
    axes = figure.subplots()
    for scene, colour in COLOURS.items():
        for rubbed in (False, True):
            kept = [r for r in rows if r.point.scene == scene and r.rubbed == rubbed]
            mu = np.array([r.fast.friction_coefficient for r in kept])
            axes.errorbar(
                mu, [r.deep["friction_coefficient"] for r in kept],
                xerr=mu * [min(r.stated("friction_coefficient"), 0.9) for r in kept] if kept else None,
                ls="none", marker="o", ms=4, color=colour, mfc=colour if rubbed else "none", lw=0.7,
                label=None if rubbed else scene,
            )  # fmt: skip
    axes.plot([1e-3, 0.15], [1e-3, 0.15], "k-", lw=0.8)
    axes.set(xscale="log", yscale="log", xlabel="friction coefficient, regression", ylabel="deterministic")
    axes.legend(frameon=False, fontsize="small")
    axes.spines[["top", "right"]].set_visible(False)
    return figure


def page() -> None:
    """Compare, and write what came out."""
    rows, left = compared()
    text = Page("regression/held_back", "The regression level on contacts that nothing was fitted to", options="page")
    verdicts(text, rows)
    text.say(
        f"Random points of every shipped scene, {FRESH} on new surfaces and {RUBBED} on surfaces that the deterministic "
        f"level has rubbed at lambda {RUB:g} for {', '.join(f'{m:g}' for m in MINUTES)} min; each on the scene's own grid, "
        "new surfaces with seeds of their own. Deviation: deterministic over regression level, less one; of W_c the "
        "difference. Neither constants nor half widths were fitted to them."
    )
    text.header(
        "scene", "load over the reference", "lambda of the smooth film", "slide-roll ratio", "warmer than shipped [K]"
    )
    for name, ends in RANGES.items():
        text.row(name, *(f"{low:g} to {high:g}" for low, high in ends))
    asked = sum(len(held(name)) for name in RANGES)
    text.say(
        f"Rubbed points have a lambda of {FASTER[0]:g} to {FASTER[1]:g}. {len(left)} points could not be judged"
        f", {asked - len(rows) - len(left)} of {asked} are not solved yet" + (f": {'; '.join(left)}." if left else ".")
    )
    for title, kept in (
        ("### All", rows),
        ("### New surfaces", [r for r in rows if not r.rubbed]),
        ("### Rubbed surfaces", [r for r in rows if r.rubbed]),
        ("### Within the fit", [r for r in rows if not r.outside]),
    ):
        if kept:
            text.say(title)
            summary(text, kept)
    text.say("### Points")
    points_page(text, rows)
    text.picture(draw(rows), "held_back.png", "friction of both levels with the half widths stated")
    text.write()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", choices=("solve", "page"))
    if parser.parse_args().part == "page":
        page()
        return
    for rubbed in (False, True):
        for name in RANGES:
            solved(name, fresh=not rubbed, rubbed=rubbed)


if __name__ == "__main__":
    main()
