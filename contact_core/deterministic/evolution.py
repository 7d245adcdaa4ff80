"""The evolution over time: between two solved blocks, tribofilm and wear continue in closed form.

A block holds until the geometry has changed by `control.change`, a limit of time is reached or the inputs have changed,
however short or long the caller's steps are.
"""

from dataclasses import replace

import numpy as np

from ..errors import OperatingPointError
from ..scene import Case, Scene
from ..state import Body, ContactState, Outputs
from ..state.bulk_temperature import NO_TIME, cool_time, temperatures_after
from ..state.parts import MOST_PARTS, check_parts, check_tries
from ..surfaces.patches import track_rows
from ..surfaces.track_means import folded
from .block import is_due, solve_block
from .changing_inputs import inputs_change, solve_instant_of_change
from .damage import fatigued
from .growth_and_wear import evolved, wear_volume_rate
from .outputs import outputs_of, with_heat
from .transient import longest_instant

_THIN = 3  # every third node along x and y is enough to tell the change of geometry
_GROOVE = 0.2  # weight of a groove's depth among changes of geometry

# N, m/s, 1/s: less is none. The kernels divide by the pressure of the load; at such speeds a film would be solved that
# is thinner than an atom, with slopes by the speed that are rounding
_LEAST = {"load": 1e-9, "speed_1": 1e-30, "speed_2": 1e-30, "spin": 1e-30}


def advance(case: Case, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
    """Return the state and outputs after `dt` [s] at the deterministic level."""
    case = _without_next_to_nothing(case)
    _check_longest(case.scene, dt)
    state = folded(case.scene, state)
    before = [body.worn for body in state.bodies]
    left, parts = dt, 0
    while True:
        case = case.warmed(state.temperatures)
        changing = inputs_change(case, state)
        if not changing and is_due(case, state):
            state = solve_block(case, state)
        if left <= 0.0:
            break
        check_parts(case, parts)
        parts += 1
        if changing:
            step, change = min(left, longest_instant(case)), 0.0
            state = solve_instant_of_change(case, state, step)
        else:
            step, change = _longest_step(case, state, left)
        left -= step
        state = _after(case, state, step, change)
    if dt > 0.0:
        rates = [(body.worn - worn) / dt for body, worn in zip(state.bodies, before, strict=True)]
    else:
        rates = [wear_volume_rate(case, *pair) for pair in zip(case.sides, state.bodies, strict=True)]
    suggested, _ = _longest_step(case, state, 10.0 * case.scene.operation.duration)
    outputs = replace(outputs_of(case, state, suggested), wear_rate_1=rates[0], wear_rate_2=rates[1])
    return replace(state, outputs=outputs), outputs


def _without_next_to_nothing(case: Case) -> Case:
    """Return the case with loads and speeds that are too small to matter set to zero."""
    none = {name: 0.0 for name, least in _LEAST.items() if 0.0 < abs(getattr(case.op, name)) < least}
    return replace(case, op=replace(case.op, **none)) if none else case


def _check_longest(scene: Scene, dt: float) -> None:
    """Raise OperatingPointError if a step has more blocks than could be solved, before hours go into them."""
    longest = scene.control.longest
    if dt > MOST_PARTS * longest:
        raise OperatingPointError(
            f"A step of {dt:g} s has more than {MOST_PARTS} blocks of control.longest = {longest:g} s. Raise it, or "
            "take shorter steps."
        )


def _after(case: Case, state: ContactState, step: float, change: float) -> ContactState:
    """Return the state after `step` [s] of the present block, in which the geometry changes by `change` [m]."""
    below, bodies = fatigued(case, state, _evolved(case, state, state.bodies, step), step)
    return replace(
        state,
        time=state.time + step,
        bodies=bodies,
        below=below,
        change=state.change + change,
        held=state.held + step,
        trends=state.trends.over(step, state.held),
        temperatures=temperatures_after(case, with_heat(case, state), step),
    )


def _evolved(case: Case, state: ContactState, bodies: tuple[Body, Body], step: float) -> tuple[Body, Body]:
    """Return both bodies after `step` [s]."""
    flash = state.outputs.flash_temperature_rise
    first, second = (evolved(case, *pair, step, flash) for pair in zip(case.sides, bodies, strict=True))
    return first, second


def _longest_step(case: Case, state: ContactState, left: float) -> tuple[float, float]:
    """Return the time [s] in which the block is used up, at most `left`, and the change of geometry [m] in it."""
    budget = case.scene.control.change - state.change
    rest = max(state.hold - state.held, NO_TIME)
    step = min(left, rest, cool_time(case, with_heat(case, state), left))
    samples, tries = _thinned(case.scene, state), 0
    while True:  # the tribofilm's growth slows down: this ends within few rounds
        check_tries(case, tries)
        tries += 1
        after = _evolved(case, state, samples, step)
        pairs = zip(case.sides, samples, after, strict=True)
        change = max(geometry_change(*pair, wears=side.moves) for side, *pair in pairs)
        if change <= 1.01 * budget:
            return step, change if change < 0.9 * budget else budget  # near enough: the block is used up
        step *= min(max(budget / change, 0.05), 0.95)


def _thinned(scene: Scene, state: ContactState) -> tuple[Body, Body]:
    """Return both bodies with every third node of their tracks."""
    rows = np.flatnonzero(track_rows(scene, state.rows))[::_THIN]
    first, second = (
        replace(body, **{name: getattr(body, name)[rows, ::_THIN] for name in Body.ARRAYS}) for body in state.bodies
    )
    return first, second


def geometry_change(before: Body, after: Body, *, wears: bool = True) -> float:
    """Return the rms change [m] of the heights by tribofilm and wear.

    Wear that is the same all along a row deepens the groove; it changes the contact far less than asperities do, and
    has a small weight. Not `wears`: wear does not count; that of bodies at rest has a limit of its own (`resting`).
    """
    film = after.tribofilm - before.tribofilm
    worn = (after.wear - before.wear) * wears
    groove = worn.mean(axis=1, keepdims=True)
    return float(np.sqrt(np.mean((film - worn + (1.0 - _GROOVE) * groove) ** 2)))
