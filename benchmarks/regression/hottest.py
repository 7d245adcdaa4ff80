"""The largest temperature of a contact: which measure of it settles with the grid, and both levels beside each other.

    python -m benchmarks.regression.hottest   # five minutes

Writes docs/measured/regression/hottest.md.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.pages import Page
from contact_core import OperatingPoint, Scene, advance, initial_state, solve
from contact_core.deterministic.observed import observed
from contact_core.scene import Case

GRIDS = (65, 97, 129)
ON_GRIDS = (("mtm_zddp", 1.5, 0.3), ("azam_case_a", 3.0, 1.0), ("fzg_flank", 4.0, 2.0))
FEW = 0.003  # of Hertz's area: a smaller share than the output's
SMOOTH = {f"surface_{i}.{name}": "0 m" for i in (1, 2) for name in ("rq", "microroughness.rms")}
POINTS = 65  # nodes of the contacts of both levels
SPREAD = 1.6  # factor that the docs state


def rough(first: str, second: str) -> dict[str, str]:
    """Return changes of a scene to roughnesses."""
    return {"surface_1.rq": first, "surface_2.rq": second}


CONTACTS: tuple[tuple[str, float, float, dict[str, str]], ...] = (  # scene, speeds [m/s], changes
    *(("mtm_zddp", *speeds, {}) for speeds in ((1.5, 0.3), (0.4, 0.1), (3.0, 1.0), (0.5, 0.45), (1.5, 0.0), (1.0, -0.3), (6.0, 2.0))),
    *(("mtm_zddp", 1.5, 0.3, {"operation.load": load}) for load in ("20 N", "70 N")),
    ("mtm_zddp", 3.0, 1.0, rough("5 nm", "20 nm")),
    ("mtm_zddp", 1.0, 0.3, rough("5 nm", "60 nm")),
    *(("azam_case_a", *speeds, {}) for speeds in ((1.0, 0.6), (3.0, 1.0), (0.3, 0.1))),
    *(("fzg_flank", *speeds, {}) for speeds in ((4.0, 2.0), (1.0, 0.5), (10.0, 6.0), (2.0, 1.9), (0.3, 0.1))),
    ("fzg_flank", 4.0, 2.0, rough("0.1 um", "0.1 um")),
    ("fzg_flank", 4.0, 2.0, rough("0.02 um", "0.02 um")),
    *(("ball_209_inner", *speeds, {}) for speeds in ((2.0, 1.0), (5.0, 4.8), (0.3, 0.2), (0.1, 0.05))),
)  # fmt: skip
CONTACTS_SMOOTH = (
    ("mtm_zddp", 1.5, 0.3, SMOOTH), ("mtm_zddp", 3.0, 1.0, SMOOTH), ("fzg_flank", 4.0, 2.0, SMOOTH), ("fzg_flank", 1.0, 0.5, SMOOTH),
)  # fmt: skip


@dataclass
class Hot:
    """One contact at the deterministic level; rises over the oil [K]."""

    scene: Scene
    op: OperatingPoint
    rise: float  # of the output
    node: float  # hottest
    few: float  # mean of the hottest share FEW
    load_ratio: float
    friction: float


def hot(name: str, first: float, second: float, points: int, changes: dict[str, str]) -> Hot:
    """Return a contact of a new scene that slides."""
    given = {"film.model": "deterministic", "film.points": str(points), "heat.model": "field"} | changes
    scene = Scene.from_toml(name, given)
    op = replace(scene.operation.point, speed_1=first, speed_2=second)
    case, fields = Case.bind(scene, op), solve(scene, op, initial_state(scene))
    seen, warm, cell = observed(case, fields), fields.temperatures, case.grid(fields.y.size).cell
    few = max(round(FEW * case.hertz.area / cell), 1)
    return Hot(
        scene,
        op,
        seen["contact_temperature_max"] - op.temperature,
        warm.hottest(1) - op.temperature,
        warm.hottest(few) - op.temperature,
        seen["contact_load_ratio"],
        abs(seen["friction_force"]) / op.load,
    )


def grids(page: Page) -> None:
    """Add rises over friction on several grids."""
    page.say(
        "Rises over the oil [K] on grids of n by n nodes, in brackets over friction and by those of the finest grid: friction itself "
        "depends on the grid. Single instants of new, rough bodies."
    )
    page.header("contact", "n", "μ", "hottest node", f"hottest {FEW:.1%} of Hertz's area", "hottest 1 % (the output)")
    worst = {"node": 0.0, "rise": 0.0}
    for name, first, second in ON_GRIDS:
        found = [hot(name, first, second, n, {}) for n in GRIDS]
        last = found[-1]

        def over(contact: Hot, measure: str, last: Hot = last) -> float:
            return getattr(contact, measure) / contact.friction / (getattr(last, measure) / last.friction)

        for n, contact in zip(GRIDS, found, strict=True):
            shown = [f"{getattr(contact, m):.1f} ({over(contact, m):.3f})" for m in ("node", "few", "rise")]
            page.row(f"`{name}`, {first:g} and {second:g} m/s", n, f"{contact.friction:.4f}", *shown)
            if n > GRIDS[0]:
                worst = {m: max(value, abs(over(contact, m) - 1.0)) for m, value in worst.items()}
    page.verdict(
        "hottest 1 % settles within 3 % from 97 nodes on",
        f"{worst['rise']:.1%}; the hottest node {worst['node']:.1%}",
        worst["rise"] <= 0.03,
    )


def beside(name: str, first: float, second: float, changes: dict[str, str]) -> tuple[Hot, float, float]:
    """Return a contact, its rise by the regression level and the rise at the friction of the deterministic one [K]."""
    found = hot(name, first, second, POINTS, changes)
    quick = found.scene.at_level("regression")
    out = advance(quick, found.op, initial_state(quick), 0.0)[1]
    rise = out.contact_temperature_max - found.op.temperature
    return found, rise, rise * found.friction / out.friction_coefficient


def rows(page: Page, contacts: tuple[tuple[str, float, float, dict[str, str]], ...]) -> Iterator[tuple[float, float]]:
    """Add a row of each contact; yield the rise over that of the regression level, as it is and at the same friction."""
    for name, first, second, changes in contacts:
        found, rise, alike = beside(name, first, second, changes)
        what = (
            "smooth"
            if changes is SMOOTH
            else ", ".join(f"{key.removeprefix('operation.')} {value}" for key, value in changes.items())
        )
        page.row(
            f"`{name}`{what and ', '}{what}",
            f"{first:g}, {second:g}",
            f"{found.load_ratio:.3f}",
            f"{found.friction:.4f}",
            f"{found.rise:.2f}",
            f"{rise:.2f}",
            f"{found.rise / rise:.2f}",
            f"{found.rise / alike:.2f}",
        )
        yield found.rise / rise, found.rise / alike


def levels(page: Page) -> None:
    """Add both levels beside each other."""
    page.say(
        f"Both levels, {POINTS} nodes, new bodies: rises over the oil [K], and the deterministic one over that of the regression level, as "
        "it is and at the same friction."
    )
    page.header("contact", "speeds [m/s]", "W_c", "μ", "deterministic", "regression", "ratio", "at the same friction")
    ratios = np.log([*rows(page, CONTACTS)])
    smooth = np.array([*rows(page, CONTACTS_SMOOTH)])
    mean, spread = np.exp(ratios.mean(axis=0)), np.exp(2.0 * ratios.std(axis=0, ddof=1))
    inside = float((np.abs(ratios[:, 0]) <= math.log(SPREAD)).mean())
    page.say(
        f"Rough contacts ({len(ratios)}): geometric mean {mean[0]:.3f}, half width (95 %) a factor of {spread[0]:.2f}; at the same friction {mean[1]:.3f} "
        f"and {spread[1]:.2f}. The constant 1.28 of `MeanHeat.hottest` is such that the first is 1. Smooth ones: {smooth[:, 0].min():.2f} to {smooth[:, 0].max():.2f}."
    )
    page.verdict(
        f"regression level within a factor of {SPREAD} in 90 % of the contacts", f"{inside:.0%}", inside >= 0.9
    )
    page.verdict("geometric mean within 3 % of 1", f"{mean[0]:.3f}", abs(mean[0] - 1.0) <= 0.03)


def main() -> None:
    """Write the page."""
    page = Page("regression/hottest", "Largest temperature of a contact")
    grids(page)
    levels(page)
    page.write()


if __name__ == "__main__":
    main()
