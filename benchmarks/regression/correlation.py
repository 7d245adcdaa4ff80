"""How the regression level's deviations from deterministic solutions go together: constants of contact_core/corrections/kriging.py.

    python -m benchmarks.regression.correlation  # a minute: docs/measured/regression/correlation.md

Takes the contacts that regression.curves, regression.shapes and regression.held_back have solved and kept in results/;
solves none. Prints the constants as contact_core/corrections/kriging.py has them.
"""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import minimize

from benchmarks.pages import Page
from benchmarks.regression import held_back_points, shapes_points
from benchmarks.regression.points import SCENES, STORE, end_points, random_points, sweep_points
from contact_core import OperatingPoint, RangeFlag, Scene, advance, initial_state
from contact_core.corrections.kriging import (
    CORRECTED,
    CORRELATIONS,
    Correlation,
    Knots,
    Place,
    conditioned,
    covariance,
    knots,
    pair_of,
    place,
)
from contact_core.scene import Case
from contact_core.state import ContactState, Mean

UNSURE = RangeFlag.NOT_CONVERGED | RangeFlag.FALLBACK | RangeFlag.DOMAIN_EDGE
STARTS = (0.15, 0.5, 0.2, 0.15)
SHORTEST, LONGEST = 0.2, 20.0  # lengths
WIDE = 1.96  # standard deviations in a half width
LEAST_NUGGET = 0.03  # curves that were fitted to the same contacts leave less than new ones would
OUTLIER = 2.0  # half widths: deviations beyond count as that
NAMES = {"friction_coefficient": "friction", "h_c": "h_c", "contact_load_ratio": "W_c"}


class Sample(NamedTuple):
    """A contact at both levels."""

    source: str
    pair: str  # of surfaces
    place: Place
    fast: dict[str, Any]
    deep: dict[str, Any]


def sampled(source: str, scene: Scene, op: OperatingPoint, state: ContactState, deep: dict[str, Any]) -> Sample | None:
    """Return a contact at both levels, or None if the deterministic level has no answer that judges."""
    if not np.isfinite(deep.get("friction_coefficient", np.nan)) or int(deep["range_flags"]) & UNSURE:
        return None
    case = Case.bind(scene.at_level("regression"), op)
    fast = vars(advance(case.scene, op, state, 0.0)[1])
    return Sample(source, pair_of(scene), place_of(case, fast), fast, dict.fromkeys(CORRECTED.values(), 0.0) | deep)


def place_of(case: Case, fast: dict[str, Any]) -> Place:
    """Return the place of a contact."""
    return place(fast, case.op.load, case.speeds, case.pressed)


def samples() -> Iterator[Sample | None]:
    """Yield the contacts that are kept."""
    for name in SCENES:
        for kind, points in (("sweep", sweep_points), ("ends", end_points), ("check", lambda n: random_points(n, 24))):
            for point, deep in _rows(STORE / f"{kind}_{name}.npz", points(name), ("load", "speed")):
                scene = point.build({})
                yield sampled(f"circles, {kind}", scene, point.operating_point, initial_state(scene), deep)
    for shape in shapes_points.ORIGIN:
        for seed, count in ((1, shapes_points.COUNTS), (2, shapes_points.OTHERS), (5, shapes_points.OTHERS)):
            asked = shapes_points.points(shape, seed, count[shape])
            for point, deep in _rows(shapes_points.STORE / f"{shape}_{seed}.npz", asked, ("load", "speed", "rq_1")):
                scene = point.build()
                yield sampled(f"shapes, {shape}", scene, point.operating_point, initial_state(scene), deep)
    for name in held_back_points.RANGES:
        for held, row in held_back_points.stored(name):
            if "refused" not in row:
                scene, state = held.build(), initial_state(held.build())
                if row["means"]:
                    first, second = (Mean(**mean) for mean in row["means"])
                    state = replace(state, means=(first, second))
                yield sampled("held back", scene, held.operating_point, state, row)


def _rows(file: Path, points: list[Any], same: tuple[str, ...]) -> Iterator[tuple[Any, dict[str, float]]]:
    """Yield the points that a file has, with what was found there."""
    if not file.exists():
        return
    columns = dict(np.load(file))
    found = [*CORRECTED, "range_flags"]
    for k, point in enumerate(points[: len(columns["load"])]):
        if all(np.isclose(columns[name][k], getattr(point, name)) for name in same):
            yield point, {name: float(columns[name][k]) for name in found}


def together(found: list[Sample]) -> Knots:
    """Return all contacts as knots."""
    return knots([s.pair for s in found], [s.place for s in found], [s.fast for s in found], [s.deep for s in found])


def fitted(given: Knots, output: int) -> Correlation:
    """Return the correlation of an output under which its deviations are likeliest, those far off cut."""
    known = np.isfinite(given.off[:, output]) & np.isfinite(given.places).all(1)
    off = WIDE * np.clip(given.off[known, output], -OUTLIER, OUTLIER)
    places, pairs = given.places[known], given.pairs[known]

    def law(x: np.ndarray) -> Correlation:
        shares = (1.0 - LEAST_NUGGET) * np.exp(x[:4]) / np.exp(x[:4]).sum() + [0.0, 0.0, 0.0, LEAST_NUGGET]
        return Correlation(*map(float, shares), tuple(np.exp(x[4:]).tolist()), 1.0)

    def unlikeliness(x: np.ndarray) -> float:
        here = law(x)
        whole = covariance(here, pairs, places, pairs, places) + here.nugget * np.eye(len(off))
        root = np.linalg.cholesky(whole + 1e-9 * np.eye(len(off)))
        return float(0.5 * np.sum(np.linalg.solve(root, off) ** 2) + np.log(np.diag(root)).sum())

    start = np.concatenate([np.log(STARTS), np.full(places.shape[1], 0.3)])
    bounds = [(-4.0, 1.0)] * 4 + [(np.log(SHORTEST), np.log(LONGEST))] * places.shape[1]
    return law(minimize(unlikeliness, start, method="L-BFGS-B", bounds=bounds, options={"maxiter": 80}).x)


def left_out(given: Knots, kept: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return deviations and half widths, over those of the regression level, each by the other knots that are `kept`."""
    off, left = [], []
    for k in range(given.count):
        others = np.flatnonzero(kept[k] & (np.arange(given.count) != k))
        known = Knots(given.pairs[others], given.places[others], given.off[others], given.own[others])
        found = conditioned(known, given.pairs[k : k + 1], given.places[k : k + 1])
        off.append(given.off[k] - found.mean[0])
        left.append(found.left[0])
    return np.array(off), np.array(left)


def main() -> None:
    """Fit, leave out, and write the page."""
    found = [sample for sample in samples() if sample is not None]
    given = together(found)
    page = Page("regression/correlation", "How deviations of the regression level go together")
    page.say(
        f"{given.count} contacts at both levels: those of [curves](curves.md), [shapes](shapes.md) and "
        "[held_back](held_back.md). A deviation is taken over the half width that the regression level states. Shares of "
        "its variance: common to a pair of surfaces, smooth (with the lengths over which it changes), likewise but of one pair alone, of each contact. "
        "Fitted by maximum likelihood; `contact_core/corrections/kriging.py` has rounded constants."
    )
    page.header("output", "", "common", "smooth", "paired", "nugget", *Place._fields)
    for k, name in enumerate(CORRECTED):
        law = fitted(given, k)
        for text, each in (("fitted", law), ("in use", CORRELATIONS[name])):
            page.row(
                NAMES[name],
                text,
                *(f"{x:.2g}" for x in (each.common, each.smooth, each.paired, each.nugget, *each.lengths)),
            )
        print(
            f'    "{name}": {Correlation(*(round(x, 2) for x in law[:4]), tuple(float(f"{x:.2g}") for x in law.lengths), 1.0)},'
        )
    page.say(
        "Each contact by all others (with the constants in use), and by those of other surfaces alone. Left: half width "
        "over that of the regression level, median; off: rms deviation likewise; covered: by the half width, before and "
        "after."
    )
    page.header("output", "by", "covered before", "off before", "covered", "off", "left", "95 % of off / left")
    other = given.pairs[:, None] != given.pairs[None, :]
    for told, kept in (("all others", np.ones_like(other)), ("other surfaces", other)):
        off, left = left_out(given, kept)
        for k, name in enumerate(CORRECTED):
            known = np.isfinite(given.off[:, k])
            before, after, width = given.off[known, k], off[known, k], left[known, k]
            page.row(
                NAMES[name], told, f"{np.mean(np.abs(before) <= 1.0):.1%}", f"{np.sqrt(np.mean(before**2)):.2f}",
                f"{np.mean(np.abs(after) <= width):.1%}", f"{np.sqrt(np.mean(after**2)):.2f}", f"{np.median(width):.2f}", f"{np.quantile(np.abs(after) / width, 0.95):.2f}",
            )  # fmt: skip
    page.write()


if __name__ == "__main__":
    main()
