"""Where the oil of a rough contact bears its load: the one constant of the fast level's fluid friction, `film.crowding`.

    python benchmarks/regression_oil.py

Prints the error of the friction coefficient, mean and rms by ranges of lambda, for some values of the constant, with
contact_load_ratio, contact_area_ratio and h_c as the deterministic level found them, so that the curves of load sharing
have no part in it. Points: those of benchmarks/regression_check.py that mixed lubrication drove.
"""

from itertools import pairwise
from typing import Any

import numpy as np
from regression_check import deterministic

from contact_core import Scene
from contact_core.means import oil_shear

VALUES = (0.0, 2.0, 3.0, 3.5, 4.0, 5.0)
EDGES = (0.0, 0.03, 0.1, 0.3, 1.0, 10.0)  # lambda


def friction(scene: Scene, point: dict[str, Any], crowding: float) -> float:
    """Friction coefficient by the fast level's friction for what the deterministic level found."""
    sliding, load = point["speed"] * point["srr"], point["load"]
    share, hertz = point["contact_load_ratio"], scene.hertz(load)
    area = (1.0 - point["contact_area_ratio"]) / (1.0 + crowding * share)
    pressure, rate = np.array([(1.0 - share) / area * hertz.pressure_max]), np.array([abs(sliding) / point["h_c"]])
    shear = oil_shear(scene, pressure, rate, np.array([point["temperature"]]))[0]
    return scene.boundary_friction.bare * share + float(shear) * area * hertz.area / load


def main() -> None:
    columns = deterministic()
    kept = np.isfinite(columns["contact_load_ratio"]) & (columns["blocks_dry"] == 0)
    points: list[dict[str, Any]] = [{name: column[i] for name, column in columns.items()} for i in np.flatnonzero(kept)]
    scenes = {name: Scene.from_toml(name) for name in {str(point["scene"]) for point in points}}
    heads = [f"lambda {low:g} to {high:g}" for low, high in pairwise(EDGES)]
    print(f"| crowding | {' | '.join(heads)} |\n|{'---|' * (1 + len(heads))}")
    of_range = np.digitize([point["lambda"] for point in points], EDGES) - 1
    for crowding in VALUES:
        found = [friction(scenes[str(point["scene"])], point, crowding) for point in points]
        error = 100.0 * (np.array(found) / [point["friction_coefficient"] for point in points] - 1.0)
        cells = []
        for k in range(len(heads)):
            inside = error[of_range == k]
            cells.append(f"{inside.mean():+.1f} %, {np.sqrt((inside**2).mean()):.1f} % ({inside.size})")
        print(f"| {crowding:g} | {' | '.join(cells)} |")


if __name__ == "__main__":
    main()
