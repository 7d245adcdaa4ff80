"""One transient step of moving roughness against the tolerance: iterations, cost and error.

    python -m benchmarks.film.tolerance [SCENE]

Writes docs/measured/film.md. Each row marches the same surfaces as a block
does, the faster body by a node a step, 40 nodes after a common start; the error is that of the pressure,
sum |p - p_ref| / sum p_ref, averaged over the steps, against the tightest tolerance.
"""

import argparse
import time
from dataclasses import replace

import numpy as np

from benchmarks.pages import save
from benchmarks.timing import work_unit
from contact_core import Scene, Transient, initial_state, solve
from contact_core.deterministic.transient import next_instant
from contact_core.scene import Case

TOLERANCES = ("2e-4", "1e-3", "3e-3", "1e-2", "3e-2")
STEPS = 40


def march(name: str, tolerance: str) -> tuple[list[np.ndarray], float, float, float, int]:
    """Pressures of the steps, mean iterations, seconds a step, mean W_c, and how many missed the tolerance."""
    scene = Scene.from_toml(name, {"film.tolerance": tolerance, "film.iterations": "500"})
    op, state = scene.operation.point, initial_state(scene)
    case = Case.bind(scene, op, state.temperatures)
    dt = scene.film.spacing / case.fastest
    steps = [speed * dt for speed in case.speeds]
    state = replace(state, film=solve(scene, op, state, dry=True).film)
    pressures, iterations, shares, missed, start = [], 0, [], 0, 0.0
    for k in range(2 * STEPS):
        if k == STEPS:
            start = time.process_time()
        state, fields = next_instant(case, state, steps, Transient(dt, 0, 500))
        if k >= STEPS:
            pressures.append(fields.pressure)
            iterations += fields.iterations
            shares.append(fields.solid_pressure.sum() / fields.pressure.sum())
            missed += not fields.converged
    return pressures, iterations / STEPS, (time.process_time() - start) / STEPS, float(np.mean(shares)), missed


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="?", default="mtm_zddp")
    args = parser.parse_args()
    march(args.scene, "3e-2")  # compile
    unit = work_unit(Scene.from_toml(args.scene).film.points)
    lines = [
        f"# {args.scene}: one transient step of moving roughness against the tolerance",
        "",
        f"Written by `python -m benchmarks.film.tolerance {args.scene}`. One work unit was {1e3 * unit:.3f} ms.",
        "",
        "| film.tolerance | iterations | ms | work units | pressure error | W_c | missed |",
        "|---|---|---|---|---|---|---|",
    ]
    reference: list[np.ndarray] = []
    for tolerance in TOLERANCES:
        pressures, iterations, seconds, share, missed = march(args.scene, tolerance)
        reference = reference or pressures
        error = np.mean([np.abs(p - q).sum() / q.sum() for p, q in zip(pressures, reference, strict=True)])
        lines.append(
            f"| {tolerance} | {iterations:.1f} | {1e3 * seconds:.1f} | {seconds / unit:.0f} | {100 * error:.2f} % "
            f"| {share:.3f} | {missed} of {STEPS} |"
        )
    save("film/tolerance", "\n".join(lines))
    print("\n".join(lines))


if __name__ == "__main__":
    main()
