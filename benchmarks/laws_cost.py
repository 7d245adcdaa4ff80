"""What laws cost per contact solve: `python benchmarks/laws_cost.py heat` prints its rows of a Markdown table.

The contact is case A, cold, but with half the slide of its entrainment, so that there is heat to share. The fluid is
an Eyring one with a limit, so that the film's heat is of the size that real films reach.
"""

import sys
from collections.abc import Callable, Iterator

import numpy as np
from core_common import cells, timed, unit_of

from contact_core import ContactFields, Scene, initial_state, solve
from contact_core.kernels.moving_source import MovingSurface, partition
from contact_core.laws.heat import LAWS

SPEEDS = {"operation.speed_1": "0.3125 m/s", "operation.speed_2": "0.1875 m/s"}
OIL = {
    "lubricant.rheology.model": "eyring",
    "lubricant.rheology.eyring_stress": "5 MPa",
    "lubricant.rheology.limiting_coefficient": "0.05",
}
CORRELATION = {"surface_1.correlation_length": "8 um", "surface_2.correlation_length": "8 um"}
HEADER = ("law", "nodes", "ms", "work units", "convolutions", "ms of the contact solve", "note")
Row = tuple[object, ...]


def contact(points: int) -> tuple[Scene, ContactFields, float]:
    """The scene, one instant of it and the seconds that took, without heat."""
    scene = Scene.from_toml(
        "azam_case_a", {"film.points": str(points), "heat.model": "none"} | SPEEDS | OIL | CORRELATION
    )
    state, point = initial_state(scene), scene.operation.point
    found, seconds = timed(lambda: solve(scene, point, state), 1)
    return scene, found, seconds


def heat(points: int) -> Iterator[Row]:
    """Every law of heat, on both bodies of steel and on steel against glass."""
    scene, found, solving = contact(points)
    point, spacing, unit = scene.operation.point, scene.film.spacing, unit_of(points)
    speeds, bodies = (point.speed_1, point.speed_2), (point.temperature, point.temperature)
    warmth = np.abs(found.fluid_shear + found.solid_shear) * abs(point.sliding_speed)
    inside, oil = found.pressure > 0.0, scene.lubricant.conductivity
    args = (warmth, found.gap, found.film.solid, inside, spacing, speeds, point.sliding_speed, bodies, oil)
    pairs = {"steel, steel": (46.0, 46.0, 1.25e-5, 1.25e-5), "steel, glass": (46.0, 1.1, 1.25e-5, 6e-7)}
    for law in LAWS:
        for name, pair in pairs.items() if law.name != "none" else [("", ())]:
            made = law(*pair)
            _, first = timed(lambda: made.temperatures(*args))  # noqa: B023
            rise, seconds = timed(lambda: made.temperatures(*args), 20)  # noqa: B023
            calls, note = 0, f"{name}: mean flash rise {rise.flash_rise:.3g} K"
            if law.name == "field":
                surfaces = tuple(
                    MovingSurface(warmth.shape, spacing, pair[i], pair[i + 2], speeds[i]) for i in range(2)
                )
                calls = partition(warmth, found.gap / oil, inside, 0.0, surfaces).convolutions
                note += f", solved {rise.solved}; {1e3 * first:.3g} ms with new speeds"
            yield law.name, points, 1e3 * seconds, seconds / unit, calls, 1e3 * solving, note


PARTS: dict[str, Callable[[int], Iterator[Row]]] = {"heat": heat}


if __name__ == "__main__":
    print(cells(HEADER), "|" + "---|" * len(HEADER), sep="\n")
    for part in sys.argv[1:] or PARTS:
        for nodes in (129, 257):
            for row in PARTS[part](nodes):
                print(cells(row), flush=True)
