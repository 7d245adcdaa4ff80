"""What laws cost per contact solve: `python benchmarks/laws_cost.py heat` prints its rows of a Markdown table.

The contact is case A, cold and to a loose tolerance, with half the slide of its entrainment: there is heat to share.
"""

import sys
from collections.abc import Callable, Iterator

import numpy as np
from core_common import cells, timed, unit_of

from contact_core import ContactFields, Scene, initial_state, solve
from contact_core.kernels.moving_source import MovingSurface, partition
from contact_core.laws.heat import LAWS

CASE = {
    "operation.speed_1": "0.3125 m/s",
    "operation.speed_2": "0.1875 m/s",
    "film.tolerance": "0.03",
    "film.iterations": "60",
    "heat.model": "none",
}
PAIRS = {"steel, steel": (46.0, 46.0, 1.25e-5, 1.25e-5), "steel, glass": (46.0, 1.1, 1.25e-5, 6e-7)}
HEADER = ("law", "nodes", "ms", "work units", "convolutions", "note")
Row = tuple[object, ...]


def contact(points: int) -> tuple[Scene, ContactFields]:
    """The scene and one instant of it."""
    scene = Scene.from_toml("azam_case_a", CASE | {"film.points": str(points)})
    return scene, solve(scene, scene.operation.point, initial_state(scene))


def heat(points: int) -> Iterator[Row]:
    """Every law of heat, between bodies of steel and between steel and glass."""
    scene, found = contact(points)
    point, spacing, unit = scene.operation.point, scene.film.spacing, unit_of(points)
    speeds, bodies = (point.speed_1, point.speed_2), (point.temperature, point.temperature)
    warmth = np.abs(found.fluid_shear + found.solid_shear) * abs(point.sliding_speed)
    inside, oil = found.pressure > 0.0, scene.lubricant.conductivity
    args = (warmth, found.gap, found.film.solid, inside, spacing, speeds, point.sliding_speed, bodies, oil)
    for law in LAWS:
        for name, pair in PAIRS.items() if law.name != "none" else [("all", ())]:
            made = law(*pair)
            _, first = timed(lambda: made.temperatures(*args))  # noqa: B023
            rise, seconds = timed(lambda: made.temperatures(*args), 20)  # noqa: B023
            calls, note = 0, f"{name}: mean flash rise {rise.flash_rise:.3g} K"
            if law.name == "field":
                surfaces = [MovingSurface(warmth.shape, spacing, pair[i], pair[i + 2], speeds[i]) for i in range(2)]
                calls = partition(warmth, found.gap / oil, inside, 0.0, tuple(surfaces)).convolutions
                note += f"; {1e3 * first:.3g} ms at speeds that are new; solved: {rise.solved}"
            yield f"heat: {law.name}", points, 1e3 * seconds, seconds / unit, calls, note


PARTS: dict[str, Callable[[int], Iterator[Row]]] = {"heat": heat}


if __name__ == "__main__":
    print(cells(HEADER), "|" + "---|" * len(HEADER), sep="\n")
    for part in sys.argv[1:] or PARTS:
        for nodes in (129, 257):
            for row in PARTS[part](nodes):
                print(cells(row), flush=True)
