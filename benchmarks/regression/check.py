"""The regression level against the deterministic level on random points of the shipped scenes."""

import time
from collections.abc import Callable

import numpy as np

from benchmarks.regression.fit import Table, by_range, errors_of
from benchmarks.regression.points import SCENES, Columns, joined, observe, random_points, run
from contact_core import Scene, advance, initial_state
from contact_core.laws.load_sharing import FittedSharing
from contact_core.state import Outputs

COUNT = 24  # random points of each scene
MINUTES = (0, 20, 60, 120)
RUN = {
    "mu": ("friction_coefficient", 1.0),
    "W_c": ("contact_load_ratio", 1.0),
    "A_c": ("contact_area_ratio", 1.0),
    "h_c nm": ("h_c", 1e9),
    "ball's film nm": ("tribofilm_1", 1e9),
    "disc's film nm": ("tribofilm_2", 1e9),
    "ball's wear nm": ("wear_depth_1", 1e9),
    "disc's wear nm": ("wear_depth_2", 1e9),
    "disc's roughness nm": ("roughness_2", 1e9),
}
COMPARED = {"mu": "friction_coefficient", "h_c": "h_c", "W_c": "contact_load_ratio"}


def deterministic() -> Columns:
    """The points by the deterministic level."""
    return joined(run(f"check_{name}", random_points(name, COUNT), {}) for name in SCENES)


def fast() -> Columns:
    """Return the same points at the regression level, solved again each time."""
    found = [observe(point, {"film.model": "regression"}) for name in SCENES for point in random_points(name, COUNT)]
    return {name: np.array([row[name] for row in found]) for name in found[0]}


def each_scene(solved: Columns, page: Callable[[np.ndarray], list[str]]) -> list[str]:
    """A table for each scene, of its rows that the deterministic level did not refuse."""
    lines = []
    for name in SCENES:
        kept = (solved["scene"] == name) & np.isfinite(solved["contact_area_ratio"])
        lines += [f"\n{name}:", *page(kept)]
    return lines


def curves_page(law: FittedSharing, solved: Columns) -> list[str]:
    """The curves on points they were not fitted to."""
    table = Table(solved)

    def rows(kept: np.ndarray) -> list[str]:
        return by_range(solved["lambda"][kept], errors_of(law, table.of(kept)))

    refused = int((~np.isfinite(solved["contact_area_ratio"])).sum())
    return [
        "## Curves on random points",
        "",
        f"{COUNT} points of each scene, which the fit has besides the sweep, for their slide-roll ratios: load 0.3 to 1.3 of the reference, speed log-uniform over the same lambda, "
        "temperature within 5 K, slide-roll ratio 0.5 to 100 % of either sign, log-uniform; roughness as shipped and fresh. "
        f"{refused} were refused by the deterministic solver.",
        *each_scene(solved, rows),
    ]


def level_page(solved: Columns) -> list[str]:
    """Return the page's part on the outputs of the regression level on the same points."""
    quick = fast()
    errors = {
        name: (quick[key] - solved[key]) / (1.0 if name == "W_c" else solved[key]) for name, key in COMPARED.items()
    }
    named = {f"{name} [{'1' if name == 'W_c' else 'rel.'}]": error for name, error in errors.items()}

    def rows(kept: np.ndarray) -> list[str]:
        return by_range(solved["lambda"][kept], {name: error[kept] for name, error in named.items()})

    return [
        "## The regression level against the deterministic level",
        "",
        'The same points by `film.model = "regression"`.',
        *each_scene(solved, rows),
    ]


def hours_page() -> list[str]:
    """Two hours of rubbing by both levels; grown and worn surfaces lie outside the fit."""
    lines = [
        "## Two hours of rubbing",
        "",
        "Deterministic / regression level. The curves were fitted to fresh surfaces only, but for the coverage and the smoothing.",
        "",
        f"| scene | min | {' | '.join(RUN)} | CPU s |",
        "|---" * (len(RUN) + 3) + "|",
    ]
    for name in SCENES:
        scene = Scene.from_toml(name)
        runs = [_hours(scene.at_level(level)) for level in ("deterministic", "regression")]
        for k, minute in enumerate(MINUTES):
            cells = [
                " / ".join(f"{factor * getattr(found[k][0], key):.3g}" for found in runs)
                for key, factor in RUN.values()
            ]
            cost = " / ".join(f"{found[k][1]:.2g}" for found in runs)
            lines.append(f"| {name} | {minute} | {' | '.join(cells)} | {cost} |")
            print(lines[-1], flush=True)
    return lines


def _hours(scene: Scene) -> list[tuple[Outputs, float]]:
    """Outputs and CPU seconds so far at each of `MINUTES`, in steps of a minute."""
    start, state, found = time.process_time(), initial_state(scene), []
    state, outputs = advance(scene, scene.operation.point, state, 0.0)
    for minute in range(MINUTES[-1] + 1):
        if minute in MINUTES:
            found.append((outputs, time.process_time() - start))
        state, outputs = advance(scene, scene.operation.point, state, 60.0)
    return found
