"""Error estimate of `point_contact` against true errors, from grids of twice and four times the nodes.

    python -m benchmarks.film.error_estimate [--points 200] [--seconds 1800] [--shape ellipse]

Writes docs/measured/film.md. The points are those of `random_points`, seed 3, on 65 nodes; the true error is the
difference to 257 nodes, or a tolerance of the value if that is more: no film is solved better. A point that is not
converged on one of the three grids is counted and left out.
"""

import argparse
import time

import numpy as np

from benchmarks.film.random_points import draw
from benchmarks.pages import save
from contact_core import ConvergenceError, point_contact

OUTPUTS = ("h_central", "h_c", "h_min", "contact_area_ratio", "contact_load_ratio", "pressure_max", "approach")
NODES = (65, 129, 257)
TOLERANCE = 3e-3


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", type=int, default=200)
    parser.add_argument("--seconds", type=float, default=1800.0, help="stop after this time")
    parser.add_argument("--seed", type=int, default=3)
    parser.add_argument("--shape", choices=("circle", "ellipse"), default="circle")
    args = parser.parse_args()
    reported: dict[str, list[float]] = {name: [] for name in OUTPUTS}
    true: dict[str, list[float]] = {name: [] for name in OUTPUTS}
    left_out, tried, begin = 0, 0, time.perf_counter()
    for point in draw(args.seed, elliptical=args.shape == "ellipse"):
        if point is None:
            continue
        if tried == args.points or time.perf_counter() - begin > args.seconds:
            break
        tried += 1
        try:
            found = [point_contact(**point.arguments(n), tolerance=TOLERANCE) for n in NODES]
        except ConvergenceError:
            left_out += 1
            continue
        if not all(answer.converged for answer in found):
            left_out += 1
            continue
        for name in OUTPUTS:
            value, best = getattr(found[0], name), getattr(found[-1], name)
            reported[name].append(found[0].error_estimate[name])
            true[name].append(max(abs(value - best), TOLERANCE * abs(value)))
    lines = [
        "# Error estimate against true error",
        "",
        f"Written by `python -m benchmarks.film.error_estimate --points {args.points} --shape {args.shape}`: {tried} random "
        f"points on 65 nodes{' along the shorter side' if args.shape == 'ellipse' else ''}, "
        f"{left_out} of them left out because one of the grids did not converge; the truth is the answer on 257 nodes.",
        "",
        "| output | true <= reported | reported <= 10 true | median reported / true |",
        "|---|---|---|---|",
    ]
    for name in OUTPUTS:
        r, t = np.array(reported[name]), np.array(true[name])
        ratio = np.median(r[t > 0.0] / t[t > 0.0]) if (t > 0.0).any() else np.nan
        lines.append(f"| {name} | {(t <= r).mean():.0%} | {(r <= 10.0 * t).mean():.0%} | {ratio:.2g} |")
    if args.shape == "circle":
        save("film/error_estimate", "\n".join(lines))
    print("\n".join(lines))


if __name__ == "__main__":
    main()
