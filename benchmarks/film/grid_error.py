"""Moving rough contacts on three grids each: errors by the distance of the nodes, beside those that the contact states.

    python -m benchmarks.film.grid_error           # an hour
    python -m benchmarks.film.grid_error report    # from what is known so far

First blocks of shipped scenes on fresh surfaces over speed and load, each with surfaces of its own. The truth is the
grid with the most nodes. Writes docs/measured/film.md; what results/film/grid_error.json holds is kept.
"""

import argparse
import json
from collections.abc import Iterator
from dataclasses import asdict, fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.claims import kept
from benchmarks.pages import Page
from contact_core import Error, OperatingPoint, Outputs, Scene, advance, initial_state, uncertainty
from contact_core.deterministic.solution_error import with_errors_of_the_solution
from contact_core.scene import Case

NAMES = {
    "friction_coefficient": "friction",
    "contact_load_ratio": "W_c",
    "contact_area_ratio": "A_c",
    "h_c": "h_c",
    "lambda_ratio": "lambda",
    "pressure_max": "largest pressure",
}
ABSOLUTE = {"contact_load_ratio"}
# nodes along x of the coarsest grid, and speeds over that of the scene
SCENES: dict[str, tuple[int, tuple[float, ...]]] = {
    "azam_case_a": (65, (1.0, 0.1, 10.0, 0.3, 3.0, 30.0)),
    "mtm_zddp": (65, (1.0, 0.1, 10.0, 0.3, 3.0, 30.0)),
    "fzg_flank": (65, (1.0, 0.3, 0.1)),
}
GRIDS = 3
Rows = dict[str, dict[str, Any]]


def cases() -> Iterator[tuple[str, int, Scene, OperatingPoint]]:
    """Yield name, grid (0: the coarsest), scene and operating point; coarse grids first, as they cost least."""
    for level in range(GRIDS):
        for name, (coarsest, speeds) in SCENES.items():
            for k, speed in enumerate(speeds):
                points = (coarsest - 1) * 2**level + 1
                scene = Scene.from_toml(name, {"film.points": str(points)}).realisation(k)
                op, lighter = scene.operation.point, 1.0 if k % 2 == 0 else 0.5
                op = replace(op, speed_1=speed * op.speed_1, speed_2=speed * op.speed_2, load=lighter * op.load)
                yield f"{name} x {speed:g}", level, scene, op


def solve() -> None:
    """Solve what is not known yet."""
    rows = read()
    for name, level, scene, op in cases():
        key = f"{name}, {scene.film.points} nodes"
        if key not in rows:
            state, out = advance(scene, op, initial_state(scene), 0.0)
            parts = {name: [error.time, error.sampling] for name, error in uncertainty(scene, state).items()}
            rows[key] = asdict(out) | {"parts": parts, "case": name, "level": level, "nodes": scene.film.points}
            _file().write_text(json.dumps(rows))
            print(key, f"W_c {out.contact_load_ratio:.4f}", flush=True)


def read() -> Rows:
    """Return the solutions that are known."""
    found: Rows = json.loads(_file().read_text()) if _file().exists() else {}
    return found


def with_errors(rows: Rows) -> Rows:
    """Return the solutions with half widths of their errors by today's model, so that it can change without them."""
    for name, _, scene, op in cases():
        row = rows.get(f"{name}, {scene.film.points} nodes")
        if row is None:
            continue
        out = Outputs(**{f.name: row[f.name] for f in fields(Outputs) if f.name in row})
        parts = {name: Error(time=time, sampling=sampling) for name, (time, sampling) in row["parts"].items()}
        scale = row["friction_coefficient"] / abs(row["friction_force"])
        found = with_errors_of_the_solution(Case.bind(scene, op), out, without(parts))
        found["friction_coefficient"] = found["friction_force"].scaled(scale)
        row["errors"] = {name: error.together for name, error in found.items()}
    return rows


def without(parts: dict[str, Error]) -> dict[str, Error]:
    """Return the errors of outputs of a solution: friction_coefficient follows from the force."""
    return {name: error for name, error in parts.items() if name != "friction_coefficient"}


def report(rows: Rows) -> None:
    """Write the page."""
    page = Page("film/grid_error", "Errors by the grid")
    finest = {row["case"]: row for row in rows.values() if row["level"] == GRIDS - 1}
    coarser = [row for row in rows.values() if row["level"] < GRIDS - 1 and row["case"] in finest]
    found = {name: [compared(row, finest[row["case"]], name) for row in coarser] for name in NAMES}
    whole = np.array([pair for name in ("friction_coefficient", "h_c", "contact_load_ratio") for pair in found[name]])
    covered = float((whole[:, 0] <= whole[:, 1]).mean())
    tenth = float((whole[:, 0] <= 0.1 * whole[:, 1]).mean())
    page.verdict("stated errors of friction, h_c and W_c cover 90 to 99 %", f"{covered:.1%}", 0.9 <= covered <= 0.99)
    page.verdict("a tenth of them would not: below 50 %", f"{tenth:.1%}", tenth < 0.5)
    ratio = float(np.median(whole[:, 1] / np.maximum(whole[:, 0], 1e-12)))
    page.verdict("stated over true at most 3 in the median", f"{ratio:.2f}", ratio <= 3.0)
    page.say(
        "First blocks on fresh surfaces; `x` is the speed over that of the scene, and every second one has half the "
        f"load. {len(coarser)} blocks on coarser grids against the finest of {GRIDS} grids, each of which has twice "
        "the nodes along x of the one before. Errors are relative, of W_c absolute. Stated: by time steps, sampling, "
        "grid and iteration together, as `uncertainty` has them. The finest grid has an error of its own."
    )
    page.header("output", "grid", "blocks", "true, median", "true, 90 %", "stated, median", "covered", "by a tenth")
    for name, label in NAMES.items():
        for level in range(GRIDS - 1):
            pairs = np.array([pair for row, pair in zip(coarser, found[name], strict=True) if row["level"] == level])
            true, stated = pairs[:, 0], pairs[:, 1]
            inside = f"{(true <= stated).mean():.0%}", f"{(true <= 0.1 * stated).mean():.0%}"
            typical = float(np.median(true)), float(np.quantile(true, 0.9)), float(np.median(stated))
            page.row(label, ("coarsest", "middle")[level], len(pairs), *typical, *inside)
    page.say("Values, and in brackets the stated half widths:")
    page.header("case", "nodes", *NAMES.values())
    for row in sorted(rows.values(), key=lambda row: (row["case"], row["level"])):
        values = [f"{row[name]:.4g} ({together(row, name):.2g})" for name in NAMES]
        page.row(row["case"], row["nodes"], *values)
    page.write()


def together(row: dict[str, Any], name: str) -> float:
    """Return the stated half width of an output, in its unit."""
    return float(row["errors"][name])


def compared(row: dict[str, Any], truth: dict[str, Any], name: str) -> tuple[float, float]:
    """Return the true error of an output and the stated one; relative to its value but for those in `ABSOLUTE`."""
    unit = 1.0 if name in ABSOLUTE else max(abs(row[name]), 1e-300)
    return abs(row[name] - truth[name]) / unit, together(row, name) / unit


def _file() -> Path:
    return kept("film/grid_error") / "found.json"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", nargs="?", default="all", choices=("all", "report"))
    if parser.parse_args().part == "all":
        solve()
    report(with_errors(read()))


if __name__ == "__main__":
    main()
