"""Hard cases: random operating points and listed ones, each checked by an independent implementation of the equations.

    python -m benchmarks.film.hard_cases random [--shape circle|ellipse|line] [--from N] [--to N] [--part K/N] [--nodes N]
    python -m benchmarks.film.hard_cases rows [--nodes N]
    python -m benchmarks.film.hard_cases report

`random` solves 2000 points of `random_points.py` with `point_contact` on 129x129 nodes at a tolerance of 3e-3 and adds
a line for each to random_K_of_N.csv in results/film/hard_cases; what stands there already is not solved again. Of ellipses,
whose radii are in a ratio of 0.1 to 10, the nodes are those along the shorter side. Lines have the same radius and
largest pressure, and rows that repeat themselves; their answers are not checked. `rows` solves the listed cases on
three grids. `report` writes docs/measured/film.md and docs/measured/film/hard_cases.png from those files.
"""

import argparse
import time
from collections.abc import Iterator
from dataclasses import asdict
from itertools import islice
from typing import Any

import numpy as np

from benchmarks.film.hard_cases_kept import GRIDS, NODES, SAID, TOLERANCE, add, folder, read
from benchmarks.film.hard_cases_page import report
from benchmarks.film.independent import FLOOR, answer, film_of, judge
from benchmarks.film.listed_cases import MOVING, STEADY, marched
from benchmarks.film.random_points import Point, draw
from contact_core import ContactError
from contact_core.calls.line_contact import line_contact
from contact_core.calls.point_contact import point_contact

SEED, POINTS = 1, 2000


def solved(given: dict[str, Any]) -> dict[str, Any]:
    """Solve and judge one contact: a row."""
    moes, film = film_of(given)
    row: dict[str, Any] = {"moes_load": moes, "formula_film": film}
    start, found, why = time.process_time(), None, ""
    try:
        found = point_contact(**given, tolerance=TOLERANCE, floor=FLOOR)
    except ContactError as error:
        why = f"{type(error).__name__}: {error}"
    row["ms"] = 1e3 * (time.process_time() - start)
    if found is None:
        return row | {"converged": 0, "shortfall": why, "algorithm": "none"}
    numbers = {name: getattr(found, name) for name in ("shortfall", "algorithm", *SAID)}
    return row | {"converged": int(found.converged)} | numbers | asdict(judge(answer(given, found)))


def solved_line(point: Point, nodes: int) -> dict[str, Any]:
    """Solve a line contact: a row, without a check."""
    line = point.line
    moes, film = (line.circular_load, line.film) if point.speed != 0.0 else (np.inf, 0.0)
    row: dict[str, Any] = {"moes_load": moes, "formula_film": film}
    start = time.process_time()
    try:
        found = line_contact(**point.line_arguments(nodes), tolerance=TOLERANCE, floor=FLOOR)
    except ContactError as error:
        why = f"{type(error).__name__}: {error}"
        return row | {"ms": 1e3 * (time.process_time() - start), "converged": 0, "shortfall": why, "algorithm": "none"}
    row["ms"] = 1e3 * (time.process_time() - start)
    return (
        row
        | {"converged": int(found.converged)}
        | {name: getattr(found, name) for name in ("shortfall", "algorithm", *SAID)}
    )


def random(shape: str, first: int, last: int, part: int, parts: int, nodes: int) -> None:
    """Solve points `first` to `last` of those drawn, every `parts`-th, and add them to a file."""
    path = folder() / f"{'random' if shape == 'circle' else shape}_{part}_of_{parts}.csv"
    done = {int(row["case"]) for row in read(path)}
    for case, point in enumerate(islice(_kept(elliptical=shape == "ellipse"), last), 1):
        if case < first or case % parts != part % parts or case in done:
            continue
        drawn = {"case": case, "nodes": nodes} | asdict(point)
        add(path, drawn | (solved_line(point, nodes) if shape == "line" else solved(point.arguments(nodes))))


def _kept(*, elliptical: bool) -> Iterator[Point]:
    return (point for point in draw(SEED, elliptical=elliptical) if point is not None)


def rows(grids: tuple[int, ...]) -> None:
    """Solve the list on grids, each from its beginning."""
    for nodes in grids:
        path = folder() / f"rows_{nodes}.csv"
        path.unlink(missing_ok=True)
        for row in STEADY:
            add(path, {"name": row.name, "nodes": nodes} | solved(row.arguments(nodes)))
        for moving in MOVING:
            for line in marched(moving, nodes):
                add(path, {"nodes": nodes} | line)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("random", "rows", "report"))
    parser.add_argument("--from", dest="first", type=int, default=1)
    parser.add_argument("--to", dest="last", type=int, default=POINTS)
    parser.add_argument("--part", default="1/1", help="k/n: every n-th point, from the k-th")
    parser.add_argument("--nodes", type=int, choices=GRIDS, help="of the random points; only this grid of the rows")
    parser.add_argument("--shape", choices=("circle", "ellipse", "line"), default="circle", help="of the random points")
    args = parser.parse_args()
    if args.what == "random":
        part, parts = map(int, args.part.split("/"))
        random(args.shape, args.first, args.last, part, parts, args.nodes or NODES)
    elif args.what == "rows":
        rows((args.nodes,) if args.nodes else GRIDS)
    else:
        report()


if __name__ == "__main__":
    main()
