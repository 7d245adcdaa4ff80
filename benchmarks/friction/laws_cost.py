"""Cost of each law per contact solution, in milliseconds and work units.

    python -m benchmarks.friction.laws_cost [friction] [flow] [heat] [tribofilm]

Writes docs/measured/friction/laws_cost.md (all parts). The contact is case A, cold and to a loose tolerance, with half the slide of its
entrainment: there is heat to share.
"""

import sys
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from benchmarks.pages import cells, save
from benchmarks.timing import timed, unit_of
from contact_core import ContactFields, Scene, Transient, initial_state, solve
from contact_core.deterministic.friction import derivatives, shear
from contact_core.kernels.moving_source import MovingSurface, partition
from contact_core.laws.heat import LAWS
from contact_core.laws.rheology import Carreau, Eyring, Newtonian
from contact_core.laws.temperatures import Rubbing
from contact_core.scene import Case

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
    rubbing = Rubbing(warmth, found.gap, found.film.solid, inside, spacing, speeds, bodies, oil)
    for law in LAWS:
        for name, pair in PAIRS.items() if law.name != "none" else [("all", ())]:
            made = law(*pair)
            _, first = timed(lambda: made.temperatures(rubbing))  # noqa: B023
            rise, seconds = timed(lambda: made.temperatures(rubbing), 20)  # noqa: B023
            calls, note = 0, f"{name}: mean flash rise {rise.flash_rise:.3g} K"
            if law.name == "field":
                surfaces = [MovingSurface(warmth.shape, spacing, pair[i], pair[i + 2], speeds[i]) for i in range(2)]
                calls = partition(warmth, found.gap / oil, inside, 0.0, tuple(surfaces)).convolutions
                note += f"; {1e3 * first:.3g} ms at speeds that are new; solved: {rise.solved}"
            yield f"heat: {law.name}", points, 1e3 * seconds, seconds / unit, calls, note


RHEOLOGIES = (Newtonian(0.047), Eyring(5e6, 0.047), Carreau(5e6, 0.5, 0.047))
OILS = ("azam_oil", "fva3", "m100")


def friction(points: int) -> Iterator[Row]:
    """Shear of oil and solids with every rheology and kind of viscosity; the derivatives."""
    scene, found = contact(points)
    point, unit = scene.operation.point, unit_of(points)
    for name in OILS:
        oil = Scene.from_toml("azam_case_a", {"lubricant.set": name}).lubricant
        _, seconds = timed(lambda: oil.viscosity(found.fluid_pressure, point.temperature), 20)  # noqa: B023
        yield f"viscosity: {oil.viscosity.name}", points, 1e3 * seconds, seconds / unit, 0, name
    for law in RHEOLOGIES:
        newtonian = 1e6 * np.exp(1e-8 * found.fluid_pressure)
        _, seconds = timed(lambda: law(newtonian, found.fluid_pressure), 20)  # noqa: B023
        yield f"rheology: {law.name}", points, 1e3 * seconds, seconds / unit, 0, ""
    _, seconds = timed(lambda: shear(Case(scene, point), found.sheared), 20)
    yield "all shear of an instant", points, 1e3 * seconds, seconds / unit, 0, "as shipped"
    spun = replace(point, spin=100.0)
    _, seconds = timed(lambda: shear(Case(scene, spun), found.sheared), 20)
    yield "all shear of an instant", points, 1e3 * seconds, seconds / unit, 0, "with spin"
    _, seconds = timed(lambda: derivatives(Case(scene, point), found.sheared), 20)
    yield "derivatives", points, 1e3 * seconds, seconds / unit, 0, "once a block"


def flow(points: int) -> Iterator[Row]:
    """Yield the additional cost of flow = "local" in an instant of a march, and the cost of the march."""
    local = {"lubricant.flow": "local"}
    for name, more in (
        ("newtonian", {}),
        ("local, eyring", local),
        ("local, heat field", local | {"heat.model": "field"}),
    ):
        scene = Scene.from_toml("azam_case_a", CASE | {"film.points": str(points), "film.tolerance": "3e-3"} | more)
        point, state = scene.operation.point, initial_state(scene)
        fields = solve(scene, point, state, dry=True)
        step = Transient(scene.film.spacing / 0.3125, 0, 40)
        for _ in range(4):
            fields = solve(scene, point, replace(state, film=fields.film), step)
        warm = replace(state, film=fields.film)
        found, seconds = timed(lambda: solve(scene, point, warm, step), 5)  # noqa: B023
        unit = unit_of(points)
        yield (
            f"an instant of a march, flow: {name}",
            points,
            1e3 * seconds,
            seconds / unit,
            0,
            f"{found.iterations} iterations",
        )


def tribofilm(points: int) -> Iterator[Row]:
    """Exposure of an instant and an hour's growth of one body."""
    scene, found = contact(points)
    unit, temperature = unit_of(points), scene.operation.temperature
    for name in ("none", "zddp_80c", "andersson_90c", "zhang_spikes_80c_ethylhexyl", "gosvami", "combined_80c"):
        changes = (
            {"tribofilm.model": "none"}
            if name == "none"
            else {"tribofilm.set": name, "operation.temperature": "80 degC"}
        )
        changes |= {"operation.temperature": "90 degC"} if name == "andersson_90c" else {}
        law = Scene.from_toml("azam_case_a", changes if name != "none" else {"tribofilm.model": "none"}).tribofilm
        args = (found.solid_pressure, found.shear, 0.1, temperature)
        exposure, first = timed(lambda: law.exposure(*args), 20)  # noqa: B023
        zeros = np.zeros_like(exposure)
        _, second = timed(lambda: law.evolve(zeros, zeros, exposure, zeros, temperature), 20)  # noqa: B023
        yield f"tribofilm: {law.name}, exposure", points, 1e3 * first, first / unit, 0, name
        yield f"tribofilm: {law.name}, evolution", points, 1e3 * second, second / unit, 0, "a body, a step of time"


PARTS: dict[str, Callable[[int], Iterator[Row]]] = {
    "friction": friction,
    "flow": flow,
    "heat": heat,
    "tribofilm": tribofilm,
}


def main() -> None:
    lines = [
        "# Cost of the laws",
        "",
        "Written by `python -m benchmarks.friction.laws_cost`: case A on fresh surfaces, slide-to-roll ratio 50 %. A work unit is one",
        'deformation convolution on the same grid. A law "none" is called only for its zeros.',
        "",
        cells(HEADER),
        "|" + "---|" * len(HEADER),
    ]
    print(*lines[-2:], sep="\n")
    for part in sys.argv[1:] or PARTS:
        for nodes in (129, 257):
            for row in PARTS[part](nodes):
                lines.append(cells(row))
                print(lines[-1], flush=True)
    if not sys.argv[1:]:
        save("friction/laws_cost", "\n".join(lines))


if __name__ == "__main__":
    main()
