"""The argument `accuracy`: errors asked for, stated and true, and the cost, on random points.

    python -m benchmarks.film.accuracy [--points 500] [--seed 12] [--seconds 60] [--solve | --report]

Points of `random_points`, in turn circles, lines and ellipses, a fifth of them smooth, are solved to 10, 3 and 1 %. The
truth is a film two grids of the sequence finer than the finest one used (of half its spacing), at a tolerance of 1e-4.
Fixed settings are the calls with `grid` 33, 65, 129 and 257 (heights on as many nodes) at their default tolerance, up to
the finest grid used. Solved points are kept in results/accuracy, one line each; what stands there is not solved again.
An accuracy is given up, and counted, when its call takes more CPU time than `--seconds`. `--solve` leaves the page
docs/measured/film/accuracy.md as it is, `--report` writes it from the points kept.
"""

import argparse
import json
import signal
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import islice
from typing import Any

import numpy as np

from benchmarks.film.random_points import Point, draw
from benchmarks.folders import RESULTS
from benchmarks.pages import Page
from benchmarks.timing import timed
from contact_core import ContactError, line_contact, point_contact
from contact_core.calls.refinement import intervals, refined_grid, surface_of
from contact_core.film.instant import Grid

KEPT = RESULTS / "accuracy"
SHAPES = ("circle", "line", "ellipse")
ACCURACIES = (0.1, 0.03, 0.01)
RELATIVE, ABSOLUTE = ("h_central", "h_c", "pressure_max"), ("contact_load_ratio", "contact_area_ratio")
OUTPUTS = (*RELATIVE, *ABSOLUTE)
FIXED = (32, 64, 128, 256)  # intervals
MOST_NODES, MOST_SMOOTH = 300_000, 1_100_000  # of a truth
TRUTH_TOLERANCE = 1e-4
BY_CHANCE = 0.01  # of the request: errors below it are left out of coverage and ratio
LATE = "late"
LEAST_FINER = 1.9  # intervals of a truth over those of the answer


class TooLongError(Exception):
    """A call took too long."""


class Case:
    """A random point with its shape, on any grid."""

    def __init__(self, shape: str, point: Point) -> None:
        self.shape, self.point, self.smooth = shape, point, point.rq == 0.0
        self.call: Callable[..., Any] = line_contact if shape == "line" else point_contact
        self.given = point.line_arguments(129) if shape == "line" else point.arguments(129)
        heights, spacing = self.given.pop("heights_2"), self.given.pop("spacing", None)
        domain = self.given.pop("domain", None)
        if self.smooth:
            return
        if domain is None:
            self.grid = Grid.centred(*heights.shape, spacing, periodic=True)
        else:
            x, y = (
                np.linspace(*sides, n) for sides, n in zip((domain[:2], domain[2:]), heights.shape[::-1], strict=True)
            )
            self.grid = Grid(x, y)
        self.surface = surface_of(heights, self.grid)

    def on(self, count: int) -> dict[str, Any]:
        """Arguments for a grid of so many intervals along the shorter side."""
        if not self.smooth:
            return self.given | self._sampled(refined_grid(self.grid, count))
        if self.shape != "ellipse":
            return self.given | {"grid": count + 1}
        return self.given | {"grid": self.point.grid(count + 1).shape}

    def to(self, accuracy: float) -> dict[str, Any]:
        """Arguments for an accuracy."""
        return self.given | {"accuracy": accuracy} | ({} if self.smooth else self._sampled(self.grid))

    def _sampled(self, grid: Grid) -> dict[str, Any]:
        more = {"heights_2": self.surface.on(grid), "spacing": grid.spacing}
        if grid.periodic:
            return more
        return more | {"domain": (grid.x[0], grid.x[-1], grid.y[0], grid.y[-1])}


def cases(seed: int) -> Iterator[Case]:
    """Cases for ever, in turn of each shape."""
    drawn = {
        shape: (p for p in draw(seed + 1000 * k, elliptical=shape == "ellipse") if p is not None)  # points of its own
        for k, shape in enumerate(SHAPES)
    }
    while True:
        for shape in SHAPES:
            yield Case(shape, next(drawn[shape]))


def run(call: Callable[..., Any], given: dict[str, Any], seconds: float) -> tuple[dict[str, Any], Any]:
    """Call once: a record with outputs and CPU time, and the answer if there is one."""

    def task() -> tuple[Any, str]:
        try:
            return call(**given), ""
        except ContactError as error:
            return None, type(error).__name__

    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        (found, why), cpu = timed(task, 2)
    except TooLongError:
        return {"cpu": seconds, "error": LATE}, None
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
    record: dict[str, Any] = {"cpu": cpu, "error": why}
    if found is not None:
        record |= {name: getattr(found, name) for name in (*OUTPUTS, "converged", "algorithm")}
        record |= {"nodes": found.film.shape, "stated": [found.error_estimate[name] for name in OUTPUTS]}
    return record, found


def solved(case: Case, seconds: float) -> dict[str, Any]:
    """Solve one case to all accuracies, on fixed grids and much finer: a record."""
    asked = {}
    for accuracy in ACCURACIES:
        record, found = run(case.call, case.to(accuracy), seconds)
        if found is not None:
            steps = [[*step.nodes, step.iterations] for step in found.steps]
            record |= {"steps": steps, "warned": any(line.startswith("accuracy") for line in found.warnings)}
        asked[str(accuracy)] = record
        if record["error"] == LATE:
            break
    finest = max((named(case.shape, record["nodes"]) for record in asked.values() if "nodes" in record), default=0)
    fixed = {}
    for count in FIXED:
        if count <= finest:
            fixed[str(count)] = run(case.call, case.on(count), seconds)[0]
    truth: dict[str, Any] = {"error": "none"}
    most = MOST_SMOOTH if case.smooth else MOST_NODES
    for count in sorted(intervals(finest + 1, 2 * finest) if finest else (), reverse=True):
        given = case.on(count)
        nodes = given["heights_2"].size if "heights_2" in given else np.prod(np.broadcast_to(given["grid"], 2))
        if nodes > most and case.shape != "line":
            continue
        truth = run(case.call, given | {"tolerance": TRUTH_TOLERANCE}, 3.0 * seconds)[0]
        truth["count"] = count
        break
    return {"asked": asked, "fixed": fixed, "truth": truth, "finest": finest}


def named(shape: str, nodes: tuple[int, int]) -> int:
    """Intervals that name a grid in the sequence: along the shorter side, of lines along x."""
    count = (nodes[1] if shape == "line" else min(nodes)) - 1
    return min(intervals(16, 8192), key=lambda named: abs(named - count))


def solve(seed: int, points: int, seconds: float) -> None:
    """Solve the points that are not kept yet."""

    def late(*_: Any) -> None:
        raise TooLongError

    signal.signal(signal.SIGPROF, late)
    KEPT.mkdir(parents=True, exist_ok=True)
    done = {record["number"] for record in kept(seed)}
    for number, case in enumerate(islice(cases(seed), points)):
        if number in done:
            continue
        record: dict[str, Any] = {"number": number, "shape": case.shape, "rq": case.point.rq, "speed": case.point.speed}
        record |= solved(case, seconds)
        with (KEPT / f"seed_{seed}.jsonl").open("a") as file:
            file.write(json.dumps(record, default=float) + "\n")
        print(number, case.shape, f"{case.point.rq:.1e}", record["finest"], flush=True)


def kept(seed: int) -> list[dict[str, Any]]:
    """Records of a seed, in their order."""
    path = KEPT / f"seed_{seed}.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def errors(record: dict[str, Any], truth: dict[str, Any]) -> np.ndarray:
    """True errors of the outputs, as an accuracy counts them."""
    relative = [abs(record[name] / truth[name] - 1.0) for name in RELATIVE]
    return np.array(relative + [abs(record[name] - truth[name]) for name in ABSOLUTE])


def stated(record: dict[str, Any]) -> np.ndarray:
    """Stated errors of the outputs, as an accuracy counts them."""
    return np.array(record["stated"]) / ([abs(record[name]) for name in RELATIVE] + [1.0] * len(ABSOLUTE))


@dataclass
class Tally:
    """What was found for one accuracy, a value for each point or each error."""

    within: list[bool] = field(default_factory=list)  # of the points without a warning
    within_warned: list[bool] = field(default_factory=list)
    silent: list[str] = field(default_factory=list)  # points above three times the request without a warning
    covered: list[bool] = field(default_factory=list)
    ratio: list[float] = field(default_factory=list)
    cost: list[float] = field(default_factory=list)  # over the cheapest fixed grid
    late: int = 0
    no_truth: int = 0
    no_film: int = 0
    no_fixed: int = 0

    def add(self, record: dict[str, Any], accuracy: float) -> None:
        """Add a point."""
        found, truth = record["asked"].get(str(accuracy), {"error": LATE}), record["truth"]
        if "stated" not in found:
            self.no_film += found["error"] != LATE
            self.late += found["error"] == LATE
            return
        used = named(record["shape"], found["nodes"])
        if "stated" not in truth or not truth["converged"] or truth["count"] < LEAST_FINER * used:
            self.no_truth += 1
            return
        true, said = errors(found, truth), stated(found)
        good = bool((true <= accuracy).all())
        (self.within_warned if found["warned"] else self.within).append(good)
        if (true > 3.0 * accuracy).any() and not found["warned"]:
            self.silent.append(f"{record['number']} ({OUTPUTS[int(true.argmax())]}, {true.max():.2g})")
        counted = true > BY_CHANCE * accuracy
        self.covered += [bool(covers) for covers in (true <= said)[counted]]
        if not found["warned"]:
            self.ratio += [float(ratio) for ratio in (said[counted] / true[counted])]
            self._add_cost(record, found, accuracy)

    def _add_cost(self, record: dict[str, Any], found: dict[str, Any], accuracy: float) -> None:
        fits = [
            "stated" in fixed and fixed["converged"] and bool((errors(fixed, record["truth"]) <= accuracy).all())
            for fixed in record["fixed"].values()
        ]
        first = next((k for k in range(len(fits)) if all(fits[k:])), None)
        if first is None:
            self.no_fixed += 1
            return
        self.cost.append(found["cpu"] / list(record["fixed"].values())[first]["cpu"])


def share(values: list[bool]) -> str:
    """Share of those that are true, and how many there are."""
    return f"{np.mean(values):.1%} of {len(values)}" if values else "none"


def report(seed: int, points: int, seconds: float) -> None:
    """Write the page from the points kept."""
    records = [record for record in kept(seed) if record["number"] < points]
    given_up = [one["cpu"] for record in records for one in record["asked"].values() if one["error"] == LATE]
    limits = sorted(set(given_up)) or [seconds]
    kinds = {"all": records}
    kinds |= {shape: [record for record in records if record["shape"] == shape] for shape in SHAPES}
    kinds |= {"smooth": [record for record in records if record["rq"] == 0.0]}
    kinds |= {"rough": [record for record in records if record["rq"] > 0.0]}
    page = Page(
        "film/accuracy", "An accuracy asked for, stated and true", options=f"--points {points} --seconds {seconds:g}"
    )
    page.say(
        f"{len(records)} random points of seed {seed}, for lines and ellipses 1000 and 2000 more (benchmarks/film/random_points.py), circles, lines and ellipses in turn, "
        f"{sum(record['rq'] == 0.0 for record in records)} of them smooth, solved by `accuracy`; given up where that took over "
        f"{' or '.join(f'{limit:g}' for limit in limits)} s of CPU time. The factors of the error model "
        "were chosen on points of seed 11 (contact_core/film/estimate.py). The truth is a film on a grid of half the spacing of the "
        f"finest one used, two grids of the sequence, at a tolerance of {TRUTH_TOLERANCE:g}; where it did not converge or would "
        f"have over {MOST_NODES} nodes (smooth bodies: {MOST_SMOOTH}), the point is left out for the accuracies that need it. "
        f"Errors are those of {', '.join(RELATIVE)} (relative), {' and '.join(ABSOLUTE)} (absolute). Coverage and ratio count "
        f"errors above {BY_CHANCE:.0%} of the request. Cost: CPU time over that of the coarsest `grid` of "
        f"{', '.join(str(count + 1) for count in FIXED)} nodes from which on all of them, up to the grid used, meet the request, at its "
        "default tolerance: an oracle, as nobody knows that grid before. Points that were given up are hard ones: the shares below are those of the others."
    )
    page.header(
        "points", "accuracy", "within, no warning", "within, with a warning", "above 3x, no warning", "stated covers true",
        "stated / true, median", "cost, median", "cost, 90 %", "given up", "no truth", "no film", "no fixed grid meets it",
    )  # fmt: skip
    whole: dict[float, Tally] = {}
    for kind, chosen in kinds.items():
        for accuracy in ACCURACIES:
            tally = Tally()
            for record in chosen:
                tally.add(record, accuracy)
            if kind == "all":
                whole[accuracy] = tally
            page.row(
                kind, f"{accuracy:.0%}", share(tally.within), share(tally.within_warned), len(tally.silent),
                share(tally.covered), f"{np.median(tally.ratio):.2g}" if tally.ratio else "",
                *(f"{np.quantile(tally.cost, part):.2g}" if tally.cost else "" for part in (0.5, 0.9)),
                tally.late, tally.no_truth, tally.no_film, tally.no_fixed,
            )  # fmt: skip
    for accuracy, tally in whole.items():
        if tally.silent:
            page.say(f"Above three times {accuracy:.0%} without a warning: points {', '.join(tally.silent)}.")
        what = f"at {accuracy:.0%}"
        good, covers = float(np.mean(tally.within)), float(np.mean(tally.covered))
        ratio, cost, most = float(np.median(tally.ratio)), *(float(q) for q in np.quantile(tally.cost, (0.5, 0.9)))
        page.verdict(f"{what}: true errors within the request in 95 %", f"{good:.1%}", good >= 0.95)
        page.verdict(f"{what}: none above 3x without a warning", f"{len(tally.silent)}", not tally.silent)
        page.verdict(f"{what}: stated errors cover true ones in 90 to 99 %", f"{covers:.1%}", 0.9 <= covers <= 0.99)
        page.verdict(f"{what}: stated / true at most 3 in the median", f"{ratio:.2g}", ratio <= 3.0)
        page.verdict(
            f"{what}: cost at most 2x the cheapest fixed grid in the median",
            f"{cost:.2g} (90 %: {most:.2g})",
            cost <= 2.0,
        )
    page.write()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", type=int, default=500)
    parser.add_argument("--seed", type=int, default=12)
    parser.add_argument("--seconds", type=float, default=60.0, help="of CPU time, most for a call")
    only = parser.add_mutually_exclusive_group()
    only.add_argument("--solve", action="store_true", help="write no page")
    only.add_argument("--report", action="store_true", help="solve nothing")
    args = parser.parse_args()
    if not args.report:
        solve(args.seed, args.points, args.seconds)
    if not args.solve:
        report(args.seed, args.points, args.seconds)


if __name__ == "__main__":
    main()
