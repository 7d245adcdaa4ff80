"""The first block of a scene, on fresh surfaces, against the grid: which outputs depend on the grid.

    python -m benchmarks.film.grid [SCENE]

Writes docs/measured/film/grid.md and docs/measured/film/grid.png. The surfaces are the same on every grid, up to what a grid cannot carry.
"""

import argparse
import time

from matplotlib.figure import Figure

from benchmarks.folders import MEASURED
from contact_core import Scene, advance, initial_state

DOCS = MEASURED / "film"
OBSERVED = ("friction_coefficient", "contact_load_ratio", "contact_area_ratio", "h_c", "wear_rate_1", "unconverged")
GRIDS = (65, 97, 129, 193)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="?", default="mtm_zddp")
    args = parser.parse_args()
    lines = [
        f"# {args.scene}: the first block on fresh surfaces, against the grid",
        "",
        f"Written by `python -m benchmarks.film.grid {args.scene}`. SI units.",
        "",
        "| nodes | s | " + " | ".join(OBSERVED) + " |",
        "|" + "---|" * (2 + len(OBSERVED)),
    ]
    rows = []
    for points in GRIDS:
        scene = Scene.from_toml(args.scene, {"film.points": str(points)})
        start = time.perf_counter()
        _, out = advance(scene, scene.operation.point, initial_state(scene), 0.0)
        rows.append([getattr(out, name) for name in OBSERVED])
        cells = " | ".join(f"{value:.3g}" for value in rows[-1])
        lines.append(f"| {points} | {time.perf_counter() - start:.1f} | {cells} |")
        print(lines[-1], flush=True)
    (DOCS / "grid.md").write_text("\n".join(lines) + "\n")
    figure = Figure(figsize=(5.2, 3.6), layout="constrained")
    axes = figure.add_subplot()
    for k, name in enumerate(OBSERVED[:4]):
        axes.plot(GRIDS, [row[k] / rows[-1][k] for row in rows], "o-", label=name)
    axes.set_xlabel("nodes along x and y")
    axes.set_ylabel(f"relative to {GRIDS[-1]} nodes")
    axes.legend(fontsize="small")
    figure.savefig(DOCS / "grid.png", dpi=130)


if __name__ == "__main__":
    main()
