"""From patches to the means that the fast level knows of them, and back."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..deterministic.growth_and_wear import track_rows
from ..scene import Scene
from ..state import Body, ContactState, Mean
from .patches import bare_heights, roughness_of
from .roughness import rms_roughness

Array = NDArray[np.float64]
Means = tuple[Mean, Mean]

_HALVINGS = 40  # of an interval of heights


def means_of(scene: Scene, state: ContactState) -> Means:
    """Means of the patches over the track."""
    first, second = (_mean_of(scene, state, i) for i in (0, 1))
    return first, second


def _mean_of(scene: Scene, state: ContactState, i: int) -> Mean:
    body, rows = state.bodies[i], state.rows
    track = track_rows(scene, rows)
    bare = bare_heights(scene, rows)[i]
    solid = roughness_of(bare, bare - body.wear - body.plastic)
    return Mean(
        growth=float(body.growth[track].mean()),
        removal=float(body.removal[track].mean()),
        coverage=float((body.growth[track] > 0.0).mean()),
        wear=float(body.wear[track].mean()),
        roughness=rms_roughness(solid, track_rows(scene, rows, 2.0 / 3.0)),
        worn=body.worn,
        cycles=body.cycles,
    )


def folded(scene: Scene, state: ContactState) -> ContactState:
    """The state with its patches brought up to date: the change of the means added to them.

    Tribofilm goes on where there is some and on the highest points that had none. Wear cuts off what is highest, as far
    as the roughness has to fall, and takes the rest in proportion to the pressure that the points felt last. Means that
    have not changed change nothing.
    """
    if state.means is None:
        return state
    old = means_of(scene, state)
    first, second = (
        body if now == then else _folded(scene, state.rows, i, body, then, now)
        for i, (body, then, now) in enumerate(zip(state.bodies, old, state.means, strict=True))
    )
    return replace(state, bodies=(first, second), means=None, solved_for=None)


def _folded(scene: Scene, rows: int, i: int, body: Body, then: Mean, now: Mean) -> Body:
    """A body whose track has gone from one mean to another."""
    track = track_rows(scene, rows)
    bare = bare_heights(scene, rows)[i]
    heights = (bare - body.wear - body.plastic)[track]
    felt = body.pressure[track]
    felt = felt / felt.mean() if felt.any() else np.ones_like(felt)
    covered = _covered(heights, body.growth[track] > 0.0, now.coverage)
    full = scene.tribofilm.full_thickness
    changed: dict[str, Any] = {
        "growth": _raised(body.growth[track], covered, then.growth, now.growth, full),
        "removal": _raised(body.removal[track], covered, then.removal, now.removal, full),
        "wear": body.wear[track] + _lost(scene, rows, bare, heights, felt, now.wear - then.wear, now.roughness),
    }
    arrays = {name: getattr(body, name).copy() for name in changed}
    for name, array in arrays.items():
        array[track] = changed[name]
    return replace(body, **arrays, worn=now.worn, cycles=now.cycles)


def _lost(scene: Scene, rows: int, bare: Array, heights: Array, felt: Array, wear: float, roughness: float) -> Array:
    """Wear [m] of the track's heights of the solid, of a given mean, after which its roughness [m] is that or, if no
    cut through the highest points takes away enough, as little as can be.
    """
    track, middle = track_rows(scene, rows), track_rows(scene, rows, 2.0 / 3.0)
    if wear <= 0.0:
        return wear * felt

    def lost(cut: float) -> Array:
        peaks = np.maximum(heights - cut, 0.0)
        return peaks + (wear - peaks.mean()) * felt

    def too_rough(cut: float) -> bool:
        solid = bare.copy()
        solid[track] = heights - lost(cut)
        return rms_roughness(roughness_of(bare, solid), middle) > roughness

    high = float(heights.max())
    if not too_rough(high):
        return lost(high)
    low = _level(heights, wear)
    for _ in range(_HALVINGS):
        cut = 0.5 * (low + high)
        low, high = (low, cut) if too_rough(cut) else (cut, high)
    return lost(high)


def _level(heights: Array, mean: float) -> float:
    """The height [m] above which there is `mean` of the solid, averaged over all."""
    high, low = float(heights.max()), float(heights.min()) - mean
    for _ in range(_HALVINGS):
        cut = 0.5 * (low + high)
        low, high = (cut, high) if np.maximum(heights - cut, 0.0).mean() > mean else (low, cut)
    return high


def _covered(heights: Array, before: NDArray[np.bool_], coverage: float) -> NDArray[np.bool_]:
    """Nodes that are to carry a tribofilm: those that did, and as many of the highest as make up the coverage."""
    more = round(coverage * heights.size) - int(before.sum())
    if more <= 0:
        return before
    order = np.argsort(np.where(before, -np.inf, heights), axis=None, kind="stable")
    after = before.copy()
    after.flat[order[-more:]] = True
    return after


def _raised(field: Array, covered: NDArray[np.bool_], then: float, now: float, most: float) -> Array:
    """A field [m] whose mean goes from `then` to `now`: up, by the same part of what is missing to `most` everywhere
    that is covered; down, by the same part of what is there.
    """
    if now <= then or not covered.any():
        return field * (now / then) if then > 0.0 else field
    room = np.where(covered, np.maximum(most - field, 0.0), 0.0)
    return field + room * ((now - then) / float(room.mean()))
