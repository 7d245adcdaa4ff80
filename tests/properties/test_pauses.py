"""Pauses, zero and tiny loads, reversals and restarts leave nothing behind in components and contacts."""

import json
import math
import random
from collections.abc import Iterator
from dataclasses import replace
from functools import cache

import pytest
from comparison import approx
from component_examples import EXAMPLES
from test_parts_random import WIDEST

from contact_core import ContactState, OperatingPoint, Scene, advance, initial_state, shipped_scenes
from system_models.machines import reading
from system_models.machines.ball_bearing.part import BallBearing
from system_models.parts.part import Input, Part, State, Values, start_values

COUNTS = [1, pytest.param(1000, marks=pytest.mark.long)]
MACHINES = ("bearing_209", "bearing_218", "gear_fzg_c", "cam_follower", "mtm_rig")
LONG = 1e7  # s, after which components have come to rest
SUMS = ("revolutions", "energy", "heater_energy")  # outputs over all the past
UNTOUCHED = {"tribofilm.model": "none", "wear.model": "none"}
SMOOTH = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm"}
ROUGH = {"surface_1.correlation_length": "16 um", "surface_2.correlation_length": "16 um"}
COMPARED = ("h_c", "friction_coefficient", "contact_load_ratio", "pressure_max", "rolling_resistance")


@cache
def parts() -> dict[str, Part]:
    """Those of shipped machines, each once, and examples."""
    machines = {name: reading.assemble(reading.read(name)).parts for name in MACHINES}
    found = {part: f"{machine}.{name}" for machine, parts in machines.items() for name, part in parts.items()}
    return {name: part for part, name in found.items()} | {name: part for name, (part, _) in EXAMPLES.items()}


def usual(part: Part) -> dict[str, float]:
    """Inputs that a component has at work: those of its start, a thousandth of what is usual where they are 0."""
    values = start_values(part)
    return {q.name: values[q.name] or min(max(q.nominal, q.minimum), q.maximum) for q in part.inputs}


def drawn(rng: random.Random, q: Input, at_work: float) -> float:
    """Nothing, next to nothing, a reversal, an end of the range, or anything."""
    low, high = (min(max(end, q.minimum), q.maximum) for end in WIDEST.get(q.unit, (-1e3, 1e3)))
    tiny = rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-320.0, -3.0)
    value = rng.choice([0.0, 0.0, tiny, tiny * at_work, -at_work, at_work, low, high, rng.uniform(low, high)])
    return min(max(value, q.minimum), q.maximum)


def duties(part: Part, rng: random.Random) -> Iterator[tuple[Values, float]]:
    """Inputs and lengths of steps [s]: pauses among anything."""
    at_work = usual(part)
    for _ in range(rng.randint(2, 6)):
        pause = {q.name: min(max(0.0, q.minimum), q.maximum) for q in part.inputs}
        anything = {q.name: drawn(rng, q, at_work[q.name]) for q in part.inputs}
        for _ in range(rng.randint(1, 3)):
            yield rng.choice([pause, anything]), 10.0 ** rng.uniform(-6.0, 4.0)


def settled(part: Part, state: State) -> dict[str, float]:
    """Outputs after a long time at work."""
    at_work = usual(part)
    for _ in range(2):
        state = part.advance(state, at_work, LONG)
    return {name: value for name, value in part.outputs(state, at_work).items() if not name.startswith(SUMS)}


def different(part: Part, found: dict[str, float], undisturbed: dict[str, float]) -> list[str]:
    """Outputs that are not what they are without a past."""
    allowed = {q.name: 1e-6 * max(abs(undisturbed.get(q.name, 0.0)), q.nominal) for q in part.responses}
    allowed["residual"] = math.inf  # rounding
    return [key for key, value in found.items() if abs(value - undisturbed[key]) > allowed[key]]


@pytest.mark.parametrize("count", COUNTS)
def test_components_return_from_any_duty_to_what_they_are_without_it(count: int) -> None:
    for name, part in parts().items():
        undisturbed = settled(part, part.initial(usual(part)))
        for seed in range(count):
            state = part.initial(usual(part))
            for inputs, step in duties(part, random.Random(f"{name} {seed}")):
                state = tuple(json.loads(json.dumps(part.advance(state, inputs, step))))  # as a restart does
                found = part.outputs(state, inputs)
                assert all(map(math.isfinite, (*state, *found.values()))), (name, seed, inputs)
            assert different(part, settled(part, state), undisturbed) == [], (name, seed)


@pytest.mark.parametrize("count", [10, *COUNTS[1:]])
def test_balls_without_load_in_a_bearing_at_rest_do_not_know_the_past(count: int) -> None:
    for name, part in parts().items():
        if not isinstance(part, BallBearing):
            continue
        for seed in range(count):
            rng = random.Random(f"{name} {seed}")
            state = part.initial(usual(part))
            for inputs, step in duties(part, rng):
                state = part.advance(state, inputs, step)
            loads = {q.name: rng.choice([0.0, 1.0, 1e-3, rng.uniform(-1.0, 1.0)]) * 1e3 for q in part.inputs[:5]}
            resting = usual(part) | loads | {"speed": rng.choice([0.0, 10.0 ** rng.uniform(-320.0, -3.0)])}
            undisturbed = part.outputs(part.initial(resting), resting)
            assert different(part, part.outputs(state, resting), undisturbed) == [], (name, seed, resting)


@pytest.mark.parametrize("count", COUNTS)
def test_contacts_return_from_any_duty_to_what_they_are_without_it(count: int) -> None:
    for name in shipped_scenes():
        scene = Scene.from_toml(name, UNTOUCHED).at_level("regression")
        worked, free = Scene.from_toml(name).at_level("regression"), initial_state(scene)
        point = scene.operation.point
        _, undisturbed = advance(scene, point, free, 1.0)
        for seed in range(count):
            rng = random.Random(f"{name} {seed}")
            state, rubbed = free, initial_state(worked)
            for _ in range(rng.randint(2, 5)):
                now, step = paused(rng, point), 10.0 ** rng.uniform(-3.0, 4.0)
                state, out = advance(scene, now, state, step)
                rubbed, other = advance(worked, now, rubbed, step)
                for found in (out, other):
                    numbers = [value for value in vars(found).values() if isinstance(value, float)]
                    assert all(map(math.isfinite, numbers)), (name, seed, now)
            _, out = advance(scene, point, state, 1.0)
            for key in COMPARED:
                assert getattr(out, key) == approx(getattr(undisturbed, key), rel=1e-9), (name, seed, key)


def paused(rng: random.Random, point: OperatingPoint) -> OperatingPoint:
    """An operating point at rest, without load, hardly moving, reversed, or another."""

    def other(value: float) -> float:
        tiny = 10.0 ** rng.uniform(-300.0, -1.0)
        return rng.choice([0.0, value, -value, tiny * value, rng.uniform(0.0, 2.0) * value])

    moved = replace(point, load=abs(other(point.load)), speed_1=other(point.speed_1), speed_2=other(point.speed_2))
    return rng.choice([moved, replace(point, load=0.0, speed_1=0.0, speed_2=0.0)])


def solved_contacts() -> Iterator[tuple[Scene, OperatingPoint]]:
    """A full film between smooth bodies and rough bodies that touch, both on a coarse grid."""
    for changes, faster in ((SMOOTH, 30.0), (ROUGH, 1.0)):
        scene = Scene.from_toml("mtm_zddp", changes | UNTOUCHED | {"film.points": "33"})
        point = scene.operation.point
        yield scene, replace(point, speed_1=faster * point.speed_1, speed_2=faster * point.speed_2)


def certain(point: OperatingPoint) -> list[list[OperatingPoint]]:
    """Duties of every kind: a pause, no load at speed, a stop under load, a reversal, more load, and some in a row."""
    resting = replace(point, load=0.0, speed_1=0.0, speed_2=0.0)
    stopped, back = (replace(point, speed_1=k * point.speed_1, speed_2=k * point.speed_2) for k in (0.0, -1.0))
    free, pressed = (replace(point, load=k * point.load) for k in (0.0, 2.0))
    return [[resting], [free], [stopped], [back], [pressed], [resting, back, stopped, pressed]]


def check_that_it_returns(scene: Scene, point: OperatingPoint, duty: list[OperatingPoint], step: float) -> None:
    """After a duty, each of its points followed by a restart, a contact is what it is without it.

    Rough bodies lie elsewhere after it: the contact without a past begins there. Bit for bit where no film is left,
    else within the errors that are given, because a march begins with the film before it.
    """
    state, _ = advance(scene, point, initial_state(scene), step)
    for now in duty:
        state, out = advance(scene, now, ContactState.from_bytes(state.to_bytes(), scene), step)
        assert all(map(math.isfinite, (value for value in vars(out).values() if isinstance(value, float)))), now
    new = initial_state(scene)
    places = [replace(body, offset=own.offset) for body, own in zip(new.bodies, state.bodies, strict=True)]
    _, undisturbed = advance(scene, point, replace(new, bodies=(places[0], places[1])), step)
    _, found = advance(scene, point, state, step)
    allowed = {
        "h_c": undisturbed.error_film * undisturbed.h_c,
        "friction_coefficient": undisturbed.error_friction * undisturbed.friction_coefficient,
        "contact_load_ratio": max(undisturbed.error_load_ratio, scene.film.tolerance),
    }
    if state.film is None:
        allowed = dict.fromkeys(COMPARED, 0.0)
    for key, error in allowed.items():
        assert abs(getattr(found, key) - getattr(undisturbed, key)) <= error, (scene.description, duty, key)


@pytest.mark.parametrize("kind", [*(pytest.param(k, marks=pytest.mark.long) for k in range(5)), 5])
def test_solved_contacts_return_from_pauses_and_reversals_to_what_they_are_without_them(kind: int) -> None:
    for scene, point in solved_contacts():
        check_that_it_returns(scene, point, certain(point)[kind], 1.0)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(10))
def test_solved_contacts_return_from_any_duty_to_what_they_are_without_it(seed: int) -> None:
    for scene, point in solved_contacts():
        rng = random.Random(f"{point} {seed}")
        duty = [paused(rng, point) for _ in range(rng.randint(2, 4))]
        check_that_it_returns(scene, point, duty, 10.0 ** rng.uniform(-3.0, 2.0))


def test_a_solved_contact_takes_next_to_no_load_and_speed_for_none() -> None:
    scene = Scene.from_toml("mtm_zddp", ROUGH | {"film.points": "33"})
    point = scene.operation.point
    resting, hardly = (
        replace(point, load=load, speed_1=speed, speed_2=speed) for load, speed in ((0.0, 0.0), (1e-200, 1e-200))
    )
    still, moving = (replace(point, speed_1=speed, speed_2=speed) for speed in (0.0, 1e-250))
    for none, next_to_none in ((resting, hardly), (still, moving)):
        state = initial_state(scene)
        assert advance(scene, next_to_none, state, 0.0)[1] == advance(scene, none, state, 0.0)[1]
