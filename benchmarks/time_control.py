"""Two hours of a scene against the size of its blocks and its grid: what a run costs and how far its answers move.

    python benchmarks/time_control.py [SCENE] [--hours H]

Writes docs/time_control.md and docs/time_control.png. The reference is the finest blocks on the scene's own grid;
the grids are compared with that too, so their rows hold both the grid's error and the blocks'.
"""

import argparse
import time
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from work_unit import work_unit

from contact_core import OperatingPoint, Scene, advance, initial_state

DOCS = Path(__file__).parent.parent / "docs"
OBSERVED = (
    "friction_coefficient",
    "h_c",
    "contact_load_ratio",
    "contact_area_ratio",
    "tribofilm_1",
    "tribofilm_2",
    "wear_depth_1",
    "wear_depth_2",
    "roughness_2",
)
RUNS = (("4 nm", 129), ("8 nm", 129), ("16 nm", 129), ("8 nm", 97), ("8 nm", 65))


def run(name: str, change: str, points: int, hours: float) -> tuple[float, float, np.ndarray]:
    """Seconds, solved blocks, and the observables [times, names] at every twelfth of the run."""
    scene = Scene.from_toml(name, {"control.change": change, "film.points": str(points)})
    op: OperatingPoint = scene.operation.point
    start, rows = time.perf_counter(), []
    state, out = advance(scene, op, initial_state(scene), 0.0)
    for _ in range(12):
        for _ in range(10):
            state, out = advance(scene, op, state, hours * 30.0)
        rows.append([getattr(out, key) for key in OBSERVED])
    return time.perf_counter() - start, out.blocks_mixed + out.blocks_dry + out.blocks_fallback, np.array(rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="?", default="mtm_zddp")
    parser.add_argument("--hours", type=float, default=2.0)
    args = parser.parse_args()
    run(args.scene, "8 nm", 65, 0.01)  # compile
    results = []
    for change, points in RUNS:
        seconds, blocks, rows = run(args.scene, change, points, args.hours)
        results.append((change, points, blocks, seconds, seconds / work_unit(points), rows))
        print(f"{change} {points}: {blocks:.0f} blocks, {seconds:.1f} s", flush=True)
    reference = results[0][-1]
    lines = [
        f"# {args.scene}, {args.hours:g} h: cost and error against the size of the blocks and the grid",
        "",
        f"Written by `python benchmarks/time_control.py {args.scene}`.",
        "Error: rms over twelve times, relative to the first row.",
        "",
        "| control.change | film.points | blocks | s | work units | " + " | ".join(OBSERVED) + " |",
        "|" + "---|" * (5 + len(OBSERVED)),
    ]
    errors = []
    for change, points, blocks, seconds, units, rows in results:
        error = np.sqrt(np.mean((rows / reference - 1.0) ** 2, axis=0))
        errors.append(error)
        cells = " | ".join(f"{100 * e:.1f} %" for e in error)
        lines.append(f"| {change} | {points} | {blocks:.0f} | {seconds:.1f} | {units:.2g} | {cells} |")
    (DOCS / "time_control.md").write_text("\n".join(lines) + "\n")
    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    axes = figure.add_subplot()
    seconds = [r[3] for r in results]
    blocks_only = slice(1, 3)
    for k, key in enumerate(OBSERVED):
        axes.loglog(seconds[blocks_only], [100 * e[k] for e in errors[blocks_only]], "o-", label=key)
    axes.set_xlabel("time of the run [s]")
    axes.set_ylabel("rms error against the finest blocks [%]")
    axes.legend(fontsize="x-small")
    figure.savefig(DOCS / "time_control.png", dpi=130)
    print("\n".join(lines))


if __name__ == "__main__":
    main()
