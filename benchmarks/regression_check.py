"""The fast level against the deterministic one on random points of the shipped scenes."""

from collections.abc import Callable

import numpy as np
from regression_fit import Table, by_range, errors_of
from regression_points import SCENES, Columns, joined, observe, random_points, run

from contact_core.laws.load_sharing import FittedSharing

COUNT = 100  # random points of each scene
COMPARED = {"mu": "friction_coefficient", "h_c": "h_c", "W_c": "contact_load_ratio"}


def deterministic() -> Columns:
    """The points by the deterministic level."""
    return joined(run(f"check_{name}", random_points(name, COUNT), {}) for name in SCENES)


def fast() -> Columns:
    """The same points by the fast level, solved anew each time."""
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
        f"{COUNT} points of each scene that the fit has not seen: load 0.3 to 1.3 of the reference, speed log-uniform over the same lambda, "
        "temperature within 5 K, slide-roll ratio 0.5 to 100 % of either sign, log-uniform; roughness as shipped and fresh. "
        f"{refused} were refused by the deterministic solver.",
        *each_scene(solved, rows),
    ]


def level_page(solved: Columns) -> list[str]:
    """The fast level's outputs on the same points."""
    quick = fast()
    errors = {
        name: (quick[key] - solved[key]) / (1.0 if name == "W_c" else solved[key]) for name, key in COMPARED.items()
    }
    named = {f"{name} [{'1' if name == 'W_c' else 'rel.'}]": error for name, error in errors.items()}

    def rows(kept: np.ndarray) -> list[str]:
        return by_range(solved["lambda"][kept], {name: error[kept] for name, error in named.items()})

    return [
        "## The fast level against the deterministic one",
        "",
        'The same points by `film.model = "regression"`.',
        *each_scene(solved, rows),
    ]
