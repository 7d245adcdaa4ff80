"""Fatigue below both surfaces over time: load cycles add damage, wear brings it up, and where it is 1 pits break out.

Damage per load cycle is that of the last pass (`subsurface`); it holds until the next block.
"""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..kernels.damage import accumulated, pits_of
from ..kernels.load_cycle import Cycle
from ..scene import Case, Scene, Side
from ..state import Below, Body, ContactState
from ..surfaces.patches import track_rows
from .subsurface import Pass, Traction

Array = NDArray[np.float64]

_SCALED = 1.01  # of stresses, to see how steeply damage rises with them
_BATCH = 0.005  # of the track that may break out in one block


def with_cycles(case: Case, state: ContactState, tractions: list[Traction], found: Pass) -> Below:
    """Return what lies below after a pass, with its tractions."""
    scene, before = case.scene, state.below
    fresh = np.zeros((scene.depths.size * state.rows, scene.film.points - 1))
    damage = before.damage if before is not None else (fresh, fresh)
    per_cycle = [fresh, fresh]
    if scene.fatigue.damages:
        per_cycle = [scene.fatigue.per_cycle(cycle).reshape(fresh.shape) for cycle in found.cycles]
    return Below(
        np.concatenate([each.pressure for each in tractions]),
        np.concatenate([each.shear for each in tractions]),
        np.array([each.places for each in tractions], np.float64),
        *damage,
        *per_cycle,
    )


def at_rest(below: Below) -> Below:
    """Return what lies below bodies that nothing presses together."""
    first, second = (np.zeros_like(field) for field in below.per_cycle)
    return replace(below, per_cycle_1=first, per_cycle_2=second)


def cycles_in(side: Side, step: float) -> float:
    """Return how often a point of a body passes the contact in `step` [s]."""
    return abs(side.speed) * step / side.track_length


def rates_of(case: Case, below: Below | None, found: Pass | None) -> dict[str, tuple[float, float]]:
    """Return the speeds at which the damages of both tracks rise and their standard deviations [1/s], by name.

    `found`: the pass that they are of, if it has just been sampled.
    """
    rates = (0.0, 0.0), (0.0, 0.0)
    if below is not None and case.scene.fatigue.damages:
        rates = _rate(case, case.sides[0], below, found), _rate(case, case.sides[1], below, found)
    return {f"damage_{i}_rate": rate for i, rate in enumerate(rates, 1)}


def _rate(case: Case, side: Side, below: Below, found: Pass | None) -> tuple[float, float]:
    per_cycle = below.per_cycle[side.body]

    def of_track(damage: Array) -> float:
        return _largest(case.scene, damage) * cycles_in(side, 1.0)

    mean = of_track(per_cycle)
    if mean == 0.0 or found is None:
        return mean, 0.0
    cycle = Cycle(*(_SCALED * part for part in found.cycles[side.body]))
    steeper = of_track(case.scene.fatigue.per_cycle(cycle).reshape(per_cycle.shape))
    return mean, mean * math.log(steeper / mean) / math.log(_SCALED) * found.scatter


def _largest(scene: Scene, field: Array) -> float:
    """Return the mean over the track of the largest value below each point."""
    layers = _layers(scene, field)
    return float(layers.max(axis=0)[track_rows(scene, layers.shape[1])].mean())


def _layers(scene: Scene, field: Array) -> Array:
    """Return a field [layers * rows, nx - 1] by its layers, [layers, rows, nx - 1]."""
    return field.reshape(scene.depths.size, -1, field.shape[1])


def pit_time(case: Case, state: ContactState) -> float:
    """Return the time [s] in which so much of a track breaks out that the contact has to be solved again."""
    if state.below is None or not case.scene.fatigue.damages:
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
    """Return what lies below, and the bodies with their new pits, `step` [s] after a state; `bodies` have worn since."""
    below = state.below
    if below is None or not case.scene.fatigue.damages:
        return below, bodies
    damages, after = [], []
    for side, then, now in zip(case.sides, state.bodies, bodies, strict=True):
        damage, body = _fatigued(case, side, below, now, now.wear - then.wear, step)
        damages.append(damage)
        after.append(body)
    return replace(below, damage_1=damages[0], damage_2=damages[1]), (after[0], after[1])


def _fatigued(case: Case, side: Side, below: Below, body: Body, worn: Array, step: float) -> tuple[Array, Body]:
    """Return the damage and the body after `step` [s] of load cycles, in which `worn` [m] was rubbed off."""
    scene, count = case.scene, cycles_in(side, step)
    damage, per_cycle = (_layers(scene, field[side.body]) for field in (below.damage, below.per_cycle))
    broken, damage = pits_of(accumulated(damage, scene.depths, count * per_cycle, worn), scene.depths)
    if broken.any():
        bare = broken > 0.0
        films = {name: np.where(bare, 0.0, getattr(body, name)) for name in ("growth", "removal", "oxide")}
        body = replace(body, pits=body.pits + broken, **films)
    return damage.reshape(below.damage[0].shape), body


def damage_of_track(scene: Scene, state: ContactState, body: int) -> float:
    """Return the mean damage of the track of body 1 (`body` = 0) or 2 (1), at the worst depth below each point."""
    return _largest(scene, state.below.damage[body]) if state.below is not None else 0.0


def widened(scene: Scene, below: Below | None, rows: int, more: int) -> Below | None:
    """Return what lies below with `more` fresh rows on either side of `rows`."""
    if below is None:
        return None

    def wider(field: Array) -> Array:
        layers = field.reshape(-1, rows, field.shape[1])
        padded: Array = np.pad(layers, ((0, 0), (more, more), (0, 0)))
        return padded.reshape(-1, field.shape[1])

    return Below(**{name: field if name == "places" else wider(field) for name, field in vars(below).items()})
