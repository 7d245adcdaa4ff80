"""Fatigue below both tracks at the regression level: damage of classes of points, pits, and what they are on the track.

A class is a share of the points of a row that the roughness loads alike; it keeps its place among them at every depth
(assumed), so a point's worst depth is that of its class. Load cycles add damage, wear brings it up, at 1 it breaks out,
and what then lies in a pit carries nothing any more.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..kernels.damage import accumulated, pits_of, worn_away
from ..kernels.load_cycle import Cycle
from ..scene import Case, Scene
from ..state import Outputs
from ..state.classes import WEIGHTS, Classes
from .contact import MeanContact
from .outputs import run_in
from .stress import stressed
from .surfaces import Means

_LAG = 0.01  # of the first layer's depth: wear below that waits
_FEWEST = 1.0 / 64.0  # part of a step within which classes that fail count as failing together
_ALL = 1.0 - 1e-9  # of a class
UNKNOWN = 1e3  # relative, of damage next to nothing of which is known


class Harm(NamedTuple):
    """What a contact does below both tracks."""

    outputs: dict[str, float]  # stresses, see `Stressed`
    per_cycle: Array  # damage per load cycle, [2, layers, rows, classes]
    more: Array  # likewise, under stresses larger by their half width


def harm_by(case: Case, contact: MeanContact) -> Harm:
    """Return what a contact does."""
    found = stressed(case, contact)
    both = np.array([1.0, 1.0 + found.half_width * run_in(case, contact)])[:, None, None, None, None]
    per_cycle, more = case.scene.fatigue.per_cycle(Cycle(*(both * part for part in found.cycles)))
    return Harm(found.outputs, per_cycle, more)


def fatigued(scene: Scene, classes: Classes, harm: Harm, then: Means, now: Means) -> Classes:
    """Return the classes after load cycles and wear that took the track means from `then` to `now`."""
    first, second = (
        _fatigued(
            scene.depths,
            classes,
            i,
            harm.per_cycle[i],
            now[i].cycles - then[i].cycles,
            max(now[i].wear - then[i].wear, 0.0),
        )
        for i in (0, 1)
    )
    return Classes(first[0], second[0], first[1], second[1], np.array([first[2], second[2]]))


def _fatigued(
    depths: Array, classes: Classes, i: int, per_cycle: Array, cycles: float, worn: float
) -> tuple[Array, Array, float]:
    """Return damage, pits and lag of a body; where classes fail one after the other, by steps from one to the next."""
    flat = classes.damage[i].shape
    damage, pits = classes.damage[i].reshape(per_cycle.shape), classes.pits[i].reshape(per_cycle.shape[1:])
    lag, left = float(classes.lag[i]) + worn, 1.0  # share of the step
    gaining = per_cycle * (pits == 0.0)  # what lies in a pit carries nothing
    if lag > _LAG * depths[0]:
        gained, removed = cycles * gaining, np.full(pits.shape, lag)
        if float((damage + gained).max()) < 1.0:
            return accumulated(damage, depths, gained, removed).reshape(flat), classes.pits[i], 0.0
        damage, lag = worn_away(damage, depths, removed), 0.0
    while left > 0.0:
        after = damage + (left * cycles) * gaining
        if float(after.max()) < 1.0:
            return after.reshape(flat), pits.ravel(), lag
        share = left if left <= _FEWEST else min(max(_first(damage, cycles * gaining), _FEWEST), left)
        broken, damage = pits_of(damage + (share * cycles) * gaining, depths)
        pits, left = pits + broken, left - share
        gaining = per_cycle * (pits == 0.0)
    return damage.reshape(flat), pits.ravel(), lag


def _first(damage: Array, gained: Array) -> float:
    """Return the share of a step after which the first class fails, a little later than that."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # next to no damage: never
        left = np.where(gained > 0.0, (1.0 - damage) / gained, math.inf)
    return float(left.min()) * (1.0 + 1e-12)


def outputs_below(case: Case, before: Outputs, harm: Harm, classes: Classes | None, means: Means) -> dict[str, float]:
    """Return the outputs of what lies below both tracks, with the error of the damage that is done now.

    Damage rises with a power of the stress, so its error is a factor: it may be 1 + the half width times as large, or
    that part of what is stated. What has broken out stays so, whatever rates tell of a class now.
    """
    found = harm.outputs | {"error_damage": 0.0}
    worst, broken, areas = (0.0, 0.0), (0.0, 0.0), (0.0, 0.0)
    if classes is not None and case.scene.fatigue.damages:
        rate, more = harm.per_cycle.max(axis=1), harm.more.max(axis=1)  # [2, rows, classes]
        damage = np.array(classes.damage).max(axis=1).reshape(rate.shape)
        pits = np.array(classes.pits).reshape(rate.shape)
        whole = pits == 0.0
        worst, broken, now, higher = (
            (np.array([damage, pits, rate * whole, more * whole]) @ WEIGHTS).mean(axis=2).tolist()
        )
        found["error_damage"] = max(_relative(*pair) for pair in zip(now, higher, strict=True))
        flat = (-1, WEIGHTS.size)
        areas = _pitted(damage.reshape(flat), pits.reshape(flat), rate.reshape(flat)).reshape(2, -1).mean(axis=1)
    was = before.micropitted_area_1, before.micropitted_area_2
    for i, mean in enumerate(means):
        found[f"damage_{i + 1}"] = worst[i]
        found[f"micropitted_area_{i + 1}"] = max(float(areas[i]), was[i])
        found[f"profile_loss_{i + 1}"] = mean.wear + broken[i]
    return found


def _relative(now: float, more: float) -> float:
    if now > 0.0:
        return min(more / now - 1.0, UNKNOWN)
    return UNKNOWN if more > 0.0 else 0.0


def _pitted(worst: Array, broken: Array, rate: Array) -> Array:
    """Return the share of each row that has broken out.

    Within the worst class that has not, the failed part is taken to grow from its upper end in proportion to its
    damage, from what that was when the class above failed.
    """
    failed: NDArray[np.bool_] = broken > 0.0
    share = np.asarray(failed @ WEIGHTS, np.float64)
    k = WEIGHTS.size - 1 - np.argmin(failed[:, ::-1], axis=1)
    j, above = np.arange(k.size), np.minimum(k + 1, WEIGHTS.size - 1)
    here = rate[j, np.minimum(k, above - 1)]
    first = np.minimum(np.divide(here, rate[j, above], out=np.ones_like(here), where=rate[j, above] > 0.0), _ALL)
    part = np.minimum(np.maximum((worst[j, k] - first) / (1.0 - first), 0.0), 1.0)
    return share + WEIGHTS[k] * np.where(failed[j, k], 0.0, part)
