"""Two hours of rubbing with flow and roughness that do not belong to the grid: errors against the finest grid, and cost.

    python -m benchmarks.film.two_hours

Writes docs/measured/film/two_hours.md in about ten minutes.
"""

import time

import numpy as np

from benchmarks.film.moving import SCENES
from benchmarks.pages import Page
from benchmarks.timing import work_unit
from contact_core import Scene, advance, initial_state

GRIDS = (65, 129)
MINUTES, STEP = 120, 60.0  # s
WINDOWS = ((0, 5), (5, 30), (30, 60), (60, 120))  # minutes over which rows are averaged: single ones scatter
NAMES = {
    "contact_load_ratio": "W_c",
    "contact_area_ratio": "A_c",
    "friction_coefficient": "mu",
    "h_c": "h_c [nm]",
    "tribofilm_1": "tribofilm 1 [nm]",
    "tribofilm_2": "tribofilm 2 [nm]",
    "wear_depth_1": "wear 1 [nm]",
    "wear_depth_2": "wear 2 [nm]",
}


def run(name: str, nodes: int) -> tuple[np.ndarray, float, float, float]:
    """Return the outputs of every minute [minutes, names], the share of instants that missed, and the CPU time [s]."""
    scene = Scene.from_toml(name, {"film.points": str(nodes)})
    state, rows, missed = initial_state(scene), [], []
    start = time.process_time()
    for _ in range(MINUTES):
        state, out = advance(scene, scene.operation.point, state, STEP)
        rows.append([getattr(out, key) * (1e9 if "nm" in text else 1.0) for key, text in NAMES.items()])
        missed.append(out.unconverged)
    unit = work_unit(nodes)
    return np.array(rows), float(np.mean(missed)), time.process_time() - start, unit


def main() -> None:
    page = Page("film/two_hours", "Two hours of rubbing on two grids")
    page.say(
        "The shipped scenes. Means over windows of time. A work unit is the time of one deformation on the same grid."
    )
    page.header("scene", "nodes", "minutes", *NAMES.values())
    costs = []
    for name in SCENES:
        found = {}
        for nodes in GRIDS:
            rows, missed, seconds, unit = run(name, nodes)
            found[nodes] = [rows[a:b].mean(axis=0) for a, b in WINDOWS]
            costs.append((name, nodes, seconds, seconds / unit, 100.0 * missed))
            for (a, b), mean in zip(WINDOWS, found[nodes], strict=True):
                page.row(name, nodes, f"{a}-{b}", *mean)
        off = 100.0 * np.abs(np.array(found[65]) / np.array(found[129]) - 1.0)
        text = ", ".join(
            f"{what.split(' [')[0]} {most:.1f}" for what, most in zip(NAMES.values(), off.max(axis=0), strict=True)
        )
        page.verdict(f"{name}: 65 nodes within 8 % of 129 over two hours", text, bool(off.max() < 8.0))
    page.say("Cost, and the share of the solutions that missed the stopping rule:")
    page.header("scene", "nodes", "CPU time [s]", "work units", "missed [%]")
    for name, nodes, seconds, units, missed in costs:
        page.row(name, nodes, seconds, units, missed)
        page.verdict(f"{name}: at most 1 % of the instants miss on {nodes} nodes", f"{missed:.2f} %", missed <= 1.0)
        most = {65: 8.0, 129: 30.0}[nodes]
        page.verdict(f"{name}: two hours on {nodes} nodes under {most:g} s", f"{seconds:.0f} s", seconds < most)
    page.write()


if __name__ == "__main__":
    main()
