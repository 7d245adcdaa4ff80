"""The evolution over time: between two solved blocks, tribofilm and wear run on in closed form.

A block holds until the geometry has changed by `control.change` or the inputs have moved, however short or long the
caller's steps are.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .block import is_due, solve_block, track_length
from .contact import bare_heights, heights_of, roughness_of
from .errors import OperatingPointError
from .laws.tribofilm import thickness
from .scene import OperatingPoint, Scene
from .state import Body, ContactState, Outputs, RangeFlag
from .surfaces import rms_roughness

Array = NDArray[np.float64]

_COVERED = 1e-9  # a thinner tribofilm does not count as coverage [m]


def advance(scene: Scene, op: OperatingPoint, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
    """Return the state and outputs after `dt` [s] under a held operating point; `state` stays as it is.

    dt = 0 evaluates the contact without moving time. Outputs hold at the end of the step; a wear rate is the step's
    volume divided by it. Raises OperatingPointError for inputs that cannot be used and ConvergenceError if the
    contact has no solution.
    """
    op.check()
    if not (math.isfinite(dt) and dt >= 0.0):
        raise OperatingPointError(f"The step dt = {dt!r} s must be finite and not negative.")
    before = [body.worn for body in state.bodies]
    left = dt
    while True:
        if is_due(scene, op, state):
            state = solve_block(scene, op, state)
        if left <= 0.0:
            break
        step, bodies, change = _longest_step(scene, op, state, left)
        left -= step
        state = replace(state, time=state.time + step, bodies=bodies, change=state.change + change)
    if dt > 0.0:
        rates = [(body.worn - worn) / dt for body, worn in zip(state.bodies, before, strict=True)]
    else:
        rates = [_wear_rate_now(scene, op, state, i) for i in (0, 1)]
    outputs = replace(_with_surfaces(scene, op, state), wear_rate_1=rates[0], wear_rate_2=rates[1])
    return replace(state, outputs=outputs), outputs


def _longest_step(
    scene: Scene, op: OperatingPoint, state: ContactState, left: float
) -> tuple[float, tuple[Body, Body], float]:
    """Time [s] in which the change of geometry is used up, at most `left`; the bodies after it and the change [m]
    it made.
    """
    budget = scene.control.change - state.change
    step = left
    while True:
        bodies = (_evolved(scene, op, state, 0, step), _evolved(scene, op, state, 1, step))
        change = max(_distance(scene, op, *pair) for pair in zip(state.bodies, bodies, strict=True))
        if change <= 1.01 * budget:
            return step, bodies, change if change < 0.9 * budget else budget  # near enough: the block is used up
        step *= min(max(budget / change, 0.05), 0.95)  # the film's growth slows down: this ends within few rounds


def _distance(scene: Scene, op: OperatingPoint, before: Body, after: Body) -> float:
    """Rms change [m] of the heights of a track by tribofilm and wear."""
    film = thickness(after.growth, after.removal) - thickness(before.growth, before.removal)
    return float(np.sqrt(np.mean((film - after.wear + before.wear)[_track(scene, op)] ** 2)))


def _evolved(scene: Scene, op: OperatingPoint, state: ContactState, i: int, step: float) -> Body:
    """One body after `step` [s] of what its last solution makes it feel."""
    body, law = state.bodies[i], scene.tribofilm
    warm = op.temperature + state.outputs.flash_temperature_rise
    growth, removal = law.evolve(body.growth, body.removal, body.rubbing * step, warm)
    film = 0.5 * (thickness(growth, removal) + thickness(body.growth, body.removal))
    worn = step * _wear_speed(scene, op, body, film)
    return replace(
        body,
        growth=growth,
        removal=removal,
        wear=body.wear + worn,
        worn=body.worn + float(worn.sum()) * _area_of_node(scene, op, i),
        cycles=body.cycles + abs((op.speed_1, op.speed_2)[i]) * step / track_length(scene, i),
    )


def _wear_speed(scene: Scene, op: OperatingPoint, body: Body, film: Array) -> Array:
    """Wear depth per second [m/s] of a patch under a tribofilm [m]."""
    cover = film / scene.tribofilm.full_thickness
    return scene.wear.rate(body.pressure, cover, op.sliding_speed, scene.plasticity.hardness)


def _wear_rate_now(scene: Scene, op: OperatingPoint, state: ContactState, i: int) -> float:
    body = state.bodies[i]
    speed = _wear_speed(scene, op, body, thickness(body.growth, body.removal))
    return float(speed.sum()) * _area_of_node(scene, op, i)


def _area_of_node(scene: Scene, op: OperatingPoint, i: int) -> float:
    """Area [m2] for which one node of the patch stands: the patch repeats along the track of a moving body."""
    moving = (op.speed_1, op.speed_2)[i] != 0.0
    return scene.film.spacing**2 * (track_length(scene, i) / scene.film.domain if moving else 1.0)


def _track(scene: Scene, op: OperatingPoint, share: float = 1.0) -> NDArray[np.bool_]:
    """Rows of the patches with |y| < share * b, at least the middle one."""
    b = scene.hertz(op.load if op.load > 0.0 else scene.operation.load).b
    rows: NDArray[np.bool_] = np.abs(scene.film.axis) < max(share * b, 0.51 * scene.film.spacing)
    return rows


def _with_surfaces(scene: Scene, op: OperatingPoint, state: ContactState) -> Outputs:
    """The last block's contact outputs with what the surfaces are now."""
    track, middle = _track(scene, op), _track(scene, op, 2.0 / 3.0)
    values: dict[str, Any] = {}
    for i, (bare, body) in enumerate(zip(bare_heights(scene), state.bodies, strict=True)):
        film, heights = thickness(body.growth, body.removal), heights_of(bare, body)
        found = {
            "wear_volume": body.worn,
            "wear_depth": float(body.wear[track].mean()),
            "tribofilm": float(film[track].mean()),
            "tribofilm_roughness": rms_roughness(film, middle),
            "roughness": rms_roughness(roughness_of(bare, heights), middle),
            "roughness_raw": rms_roughness(heights, middle),
            "coverage": float((film[track] > _COVERED).mean()),
            "load_cycles": body.cycles,
            "temperature": op.temperature,
        }
        values |= {f"{name}_{i + 1}": value for name, value in found.items()}
    flags = RangeFlag(state.outputs.range_flags) & ~RangeFlag.TRIBOFILM_TEMPERATURE
    if not scene.tribofilm.covers(op.temperature):
        flags |= RangeFlag.TRIBOFILM_TEMPERATURE
    power = max(0.0, -state.outputs.friction_force * op.sliding_speed)
    step, _, _ = _longest_step(scene, op, state, 10.0 * scene.operation.duration)
    return replace(state.outputs, **values, range_flags=int(flags), power_loss=power, suggested_step=step)
