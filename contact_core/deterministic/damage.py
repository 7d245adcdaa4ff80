"""Fatigue below both surfaces over time: load cycles add damage, wear brings it up, and where it is 1 pits break out.

Damage per load cycle is that of the last pass (`subsurface`); it holds until the next block.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..kernels.arrays import Array
from ..kernels.damage import accumulated, pits_of
from ..kernels.load_cycle import Cycle
from ..scene import Case, Scene, Side
from ..state import Below, Body, ContactState
from ..surfaces.patches import track_rows
from .subsurface import Pass, Traction

_OF_ROWS = ("pressure", "shear", "damage_1", "damage_2", "per_cycle_1", "per_cycle_2")
_SCALED = 1.01  # of stresses, to see how steeply damage rises with them
_LEARN = 0.25  # share of the last two passes in the scatter from pass to pass
_BATCH = 0.005  # share of the track that may break out in one block


def with_tractions(below: Below, tractions: Sequence[Traction]) -> Below:
    """Return the state below the surfaces with the tractions of the pass in progress."""
    return replace(
        below,
        pressure=np.concatenate([each.pressure for each in tractions]),
        shear=np.concatenate([each.shear for each in tractions]),
        places=np.array([each.places for each in tractions], np.float64),
    )


def with_cycles(case: Case, below: Below, found: Pass) -> Below:
    """Return the state below the surfaces after a pass."""
    law = case.scene.fatigue
    if not law.damages:
        return below
    harm = [law.per_cycle(cycle) for cycle in found.cycles]
    rate, halved = (
        np.array([_rate(case, side, each[side.body]) for side in case.sides])
        for each in (harm, [law.per_cycle(cycle) for cycle in found.halved])
    )
    first, second = (each.reshape(below.damage_1.shape) for each in harm)
    after = _at_rate(replace(below, per_cycle_1=first, per_cycle_2=second, short=rate - halved), rate)
    if below.rate.all():  # two passes differ by the scatter of both
        return replace(after, spread=np.sqrt((1.0 - _LEARN) * below.spread**2 + 0.5 * _LEARN * after.step**2))
    return replace(after, spread=np.array([_spread(case, side, found, rate[side.body]) for side in case.sides]))


def at_rest(below: Below) -> Below:
    """Return what lies below bodies that nothing presses together."""
    none = np.zeros_like(below.damage_1)
    after = _at_rate(replace(below, per_cycle_1=none, per_cycle_2=none), np.zeros(2))
    return replace(after, spread=np.zeros(2), step=np.zeros(2), short=np.zeros(2))


def _at_rate(below: Below, rate: Array) -> Below:
    """Return the state below the surfaces with new damage rates; half of their change is an error of the last step."""
    step = np.where(below.rate > 0.0, rate - below.rate, 0.0)
    return replace(below, rate=rate, step=step, late=below.late + 0.5 * step * below.held, held=0.0)


def cycles_in(side: Side, step: float) -> float:
    """Return how often a point of a body passes the contact in `step` [s]."""
    return abs(side.speed) * step / side.track_length


def _rate(case: Case, side: Side, per_cycle: Array) -> float:
    """Return the speed [1/s] at which the mean damage of a track rises; the field is [layers, rows, nx - 1]."""
    return _largest(case.scene, per_cycle) * cycles_in(side, 1.0)


def _spread(case: Case, side: Side, found: Pass, rate: float) -> float:
    """Return the standard deviation of that speed, by the scatter of the largest stress among the instants."""
    if rate == 0.0:
        return 0.0
    larger = Cycle(*(_SCALED * part for part in found.cycles[side.body]))
    steeper = _rate(case, side, case.scene.fatigue.per_cycle(larger))
    return rate * math.log(steeper / rate) / math.log(_SCALED) * found.scatter


def _largest(scene: Scene, field: Array) -> float:
    """Return the mean over the track of the largest value below each point, of a field [layers, rows, nx - 1]."""
    return float(field.max(axis=0)[track_rows(scene, field.shape[1])].mean())


def _layers(scene: Scene, field: Array) -> Array:
    """Return a field [layers * rows, nx - 1] by its layers, [layers, rows, nx - 1]."""
    return field.reshape(scene.depths.size, -1, field.shape[1])


def pit_time(case: Case, state: ContactState) -> float:
    """Return the time [s] in which so much of a track breaks out that the contact has to be solved again."""
    if state.below is None or not (case.scene.fatigue.damages and case.scene.stress.opens_pits):
        return math.inf
    return min(_pit_time(case, side, state.below) for side in case.sides)


def _pit_time(case: Case, side: Side, below: Below) -> float:
    scene = case.scene
    damage, rate = (_layers(scene, field[side.body]) for field in (below.damage, below.per_cycle))
    track = track_rows(scene, damage.shape[1])
    rate = rate[:, track] * cycles_in(side, 1.0)
    left = np.divide(1.0 - damage[:, track], rate, out=np.full_like(rate, np.inf), where=rate > 0.0).min(axis=0).ravel()
    batch = max(1, round(_BATCH * left.size))
    return float(np.partition(left, batch - 1)[batch - 1])


def fatigued(
    case: Case, state: ContactState, bodies: tuple[Body, Body], step: float
) -> tuple[Below | None, tuple[Body, Body]]:
    """Return what lies below, and the bodies with their new pits, `step` [s] after a state; `bodies` have worn."""
    below = state.below
    if below is None or not case.scene.fatigue.damages:
        return below, bodies
    damages, harm, after = [], [], []
    for side, then, now in zip(case.sides, state.bodies, bodies, strict=True):
        damage, per_cycle, body = _fatigued(case, side, below, now, now.wear - then.wear, step)
        damages.append(damage)
        harm.append(per_cycle)
        after.append(body)
    held = below.held + step
    below = replace(
        below,
        damage_1=damages[0],
        damage_2=damages[1],
        per_cycle_1=harm[0],
        per_cycle_2=harm[1],
        held=held,
        few=below.few + below.short * step,
        variance=below.variance + below.spread**2 * (held**2 - below.held**2),
    )
    return below, (after[0], after[1])


def _fatigued(case: Case, side: Side, below: Below, body: Body, worn: Array, step: float) -> tuple[Array, Array, Body]:
    """Return damage, damage per load cycle and body after `step` [s] of them, in which `worn` [m] was rubbed off.

    Nothing presses on the ground of a new, open pit; what does is up to the next solution. A pit that is only counted
    is as deep as what has failed under a point.
    """
    scene, count = case.scene, cycles_in(side, step)
    damage, per_cycle = (_layers(scene, field[side.body]) for field in (below.damage, below.per_cycle))
    damage = accumulated(damage, scene.depths, count * per_cycle, worn)
    broken, after = pits_of(damage, scene.depths)
    if not scene.stress.opens_pits:
        damage, body = np.minimum(damage, 1.0), replace(body, pits=np.maximum(body.pits, broken))
    elif broken.any():
        bare = broken > 0.0
        films: dict[str, Any] = {
            name: np.where(bare, 0.0, getattr(body, name)) for name in ("growth", "removal", "oxide")
        }
        body = replace(body, pits=body.pits + broken, opened=body.opened + broken, **films)
        damage, per_cycle = after, np.where(bare, 0.0, per_cycle)
    shape = below.damage[0].shape
    return damage.reshape(shape), per_cycle.reshape(shape), body


def damage_of_track(scene: Scene, state: ContactState, body: int) -> float:
    """Return the mean damage of the track of body 1 (`body` = 0) or 2 (1), at the worst depth below each point."""
    return _largest(scene, _layers(scene, state.below.damage[body])) if state.below is not None else 0.0


def widened(below: Below | None, rows: int, more: int) -> Below | None:
    """Return what lies below with `more` fresh rows on either side of `rows`."""
    if below is None:
        return None

    def wider(field: Array) -> Array:
        layers = field.reshape(-1, rows, field.shape[1])
        padded: Array = np.pad(layers, ((0, 0), (more, more), (0, 0)))
        return padded.reshape(-1, field.shape[1])

    fields: dict[str, Any] = {name: wider(getattr(below, name)) for name in _OF_ROWS}
    return replace(below, **fields)
