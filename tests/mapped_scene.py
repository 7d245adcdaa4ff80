"""A scene with a map of made-up solutions: the regression level times factors that are known everywhere."""

import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from contact_core import Scene, advance, initial_state
from contact_core.corrections.fitting import Rule, fitted
from contact_core.corrections.knot import History, Knot, Plan, contact_of, samples_of
from contact_core.corrections.map import Map, digest_of
from contact_core.regression.contact import MeanContact
from contact_core.scene import Case
from system_models.run.map_ranges import Ranges

SMALL = {
    "film.points": "17",
    "surface_1.correlation_length": "32 um",
    "surface_2.correlation_length": "32 um",
}
NOISE = 0.02  # standard deviation of a made-up solution
SHARED = 0.001  # half width of what all of them share


def scene_of(**changes: str) -> Scene:
    """Return a small scene at the regression level."""
    given = SMALL | {name.replace("__", "."): value for name, value in changes.items()}
    return Scene.from_toml("mtm_zddp", given).at_level("regression")


def truth(case: Case, contact: MeanContact) -> tuple[float, float, float]:
    """Return the friction coefficient, h_c [m] and contact_load_ratio of the made-up deterministic level."""
    share, rise = contact.load_ratio, math.log(case.pressed)
    friction = abs(contact.solid + contact.fluid) / case.op.load
    return (
        friction * math.exp(0.10 + 0.15 * (share - 0.8)),
        contact.gap * math.exp(-0.20 - 0.05 * rise),
        share + 0.5 * share * (1.0 - share),
    )


def made_up(scene: Scene, number: int, fine: bool, plan: Plan) -> History:
    """Return a history of the made-up level, with noise; in place of `knot.solve`."""
    fast = scene.at_level("regression")
    state, before, found = initial_state(fast), 0.0, []
    random = np.random.Generator(np.random.Philox(key=[7, number]))
    for k, time in enumerate(plan.times[::4]):
        state, _ = advance(fast, plan.rubbing, state, time - before)
        before = time
        for point in (plan.rubbing, plan.elsewhere[k][1]):
            knot = Knot(point, state.means, shared=(SHARED,) * 3, errors=(0.04,) * 3)
            case, contact = contact_of(fast, knot)
            friction, film, load = truth(case, contact)
            noise = random.normal(0.0, NOISE, 3)
            spread = contact.load_ratio * (1.0 - contact.load_ratio)
            made = friction * math.exp(noise[0]), film * math.exp(noise[1]), load + spread * float(noise[2])
            found.append(replace(knot, found=made))
    return History(number, fine, tuple(found))


@cache
def ranges() -> Ranges:
    """Return the ranges of the histories."""
    return replace(Ranges.of(scene_of(), {}), temperature=(350.0, 356.0))


def drawn(number: int, seed: int = 1) -> Plan:
    """Return a history."""
    return ranges().draw(seed, number)


@cache
def histories(count: int, seed: int = 1) -> tuple[History, ...]:
    """Return histories of the made-up level, of eight knots each."""
    return tuple(made_up(scene_of(), number, True, drawn(number, seed)) for number in range(count))


def knots(count: int, seed: int = 1) -> list[Knot]:
    """Return knots of the made-up level."""
    return [knot for history in histories(-(-count // 8), seed) for knot in history.knots][:count]


@cache
def chart() -> Map:
    """Return the map of 20 histories."""
    scene = scene_of()
    return fitted(samples_of(scene, histories(20)), scene.name, digest_of(scene), ranges().rows, Rule())


def mapped_scene(folder: Path, **changes: str) -> Scene:
    """Return the scene at the level of its map, which is written into a folder."""
    folder.mkdir(exist_ok=True)
    file = folder / "map.json"
    file.write_text(chart().to_text(), "utf-8")
    fast = scene_of(**changes)
    scene = fast.at_level("map")
    return replace(scene, film=replace(scene.film, file=str(file)))
