"""From patches to the track means of the regression level, and back."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..laws.tribofilm import thickness
from ..scene import Scene
from ..state import Body, ContactState, Mean
from .damage_classes import folded_damage
from .patches import bare_heights, middle_rows, roughness_of, track_rows
from .roughness import rms_roughness

Means = tuple[Mean, Mean]

_HALVINGS = 40  # of an interval of heights


def means_of(scene: Scene, state: ContactState) -> Means:
    """Return the means of the patches over the track."""
    first, second = (_mean_of(scene, state, i) for i in (0, 1))
    return first, second


def _mean_of(scene: Scene, state: ContactState, i: int) -> Mean:
    body, rows = state.bodies[i], state.rows
    track = track_rows(scene, rows)
    bare = bare_heights(scene, rows)[i]
    solid = roughness_of(bare, _between_pits(bare, body))
    roughness = rms_roughness(solid, middle_rows(scene, rows))
    return Mean(
        growth=float(body.growth[track].mean()),
        removal=float(body.removal[track].mean()),
        coverage=_coverage(body.growth[track]),
        wear=float(body.wear[track].mean()),
        roughness=roughness / _sampled(scene, bare, i),
        worn=body.worn,
        cycles=body.cycles,
        formed=float(body.formed[track].mean()),
        oxide=float(body.oxide[track].mean()),
    )


def _between_pits(bare: Array, body: Body) -> Array:
    """Return the heights [m] of a body's solid without its pits: the roughness of what carries the load."""
    return bare - body.wear - body.plastic


def _sampled(scene: Scene, bare: Array, i: int) -> float:
    """Return the rms roughness of a body's new patch over that of its surface.

    A patch is a sample that changes with film.points and film.domain; the means are those of the surface.
    """
    nominal = (scene.surface_1, scene.surface_2)[i].rms
    sampled = rms_roughness(bare, middle_rows(scene, bare.shape[0]))
    return sampled / nominal if sampled > 0.0 and nominal > 0.0 else 1.0


def _coverage(growth: Array) -> float:
    """Return the share of a track that would carry its growth [m] with the same mean and rms if it were even there.

    Most of the track has touched at some time; much of that carries next to no tribofilm.
    """
    scale = float(growth.max())  # in front, because squares of small numbers vanish
    if scale == 0.0:
        return 0.0
    share = growth / scale
    return float(share.mean()) ** 2 / float((share * share).mean())


def folded(scene: Scene, state: ContactState) -> ContactState:
    """Return the state with its patches brought up to date: the change of the track means is added to them.

    Tribofilm is added where there is most and on the highest points without any. Wear cuts off the highest points as
    far as the roughness has to fall, and takes the rest in proportion to the last pressure on each point. So are damage
    and pits, by their classes. Unchanged means change nothing.
    """
    if state.means is None:
        return state
    old = means_of(scene, state)
    first, second = (
        body if now == then else _folded(scene, state.rows, i, body, then, now)
        for i, (body, then, now) in enumerate(zip(state.bodies, old, state.means, strict=True))
    )
    below, bodies = folded_damage(scene, state, (first, second))
    return replace(state, bodies=bodies, below=below, means=None, classes=None, solved_for=None)


def _folded(scene: Scene, rows: int, i: int, body: Body, then: Mean, now: Mean) -> Body:
    """Return a body whose track has changed from one mean to another."""
    track = track_rows(scene, rows)
    bare = bare_heights(scene, rows)[i]
    heights = _between_pits(bare, body)[track]
    pressure = body.pressure[track]
    share = pressure / pressure.mean() if pressure.any() else np.ones_like(pressure)
    covered = _covered(heights, body.growth[track], now.coverage)
    roughness = now.roughness * _sampled(scene, bare, i)
    full = scene.tribofilm.full_thickness
    changed: dict[str, Any] = {
        "growth": _raised(body.growth[track], covered, then.growth, now.growth, full),
        "removal": _raised(body.removal[track], covered, then.removal, now.removal, full),
        "wear": body.wear[track] + _lost(scene, rows, bare, heights, share, now.wear - then.wear, roughness),
        "oxide": np.maximum(body.oxide[track] + (now.oxide - then.oxide), 0.0),
    }
    changed["formed"] = body.formed[track] + _formed(body, changed, track, covered, now.formed - then.formed)
    arrays = {name: getattr(body, name).copy() for name in changed}
    for name, array in arrays.items():
        array[track] = changed[name]
    return replace(body, **arrays, worn=now.worn, cycles=now.cycles)


def _formed(
    body: Body, changed: dict[str, Array], track: NDArray[np.bool_], covered: NDArray[np.bool_], mean: float
) -> Array:
    """Return the tribofilm formed on each node [m], of a given mean: what it has gained, and even removal beside."""
    gained = thickness(changed["growth"], changed["removal"]) - body.tribofilm[track]
    share = float(covered.mean())
    removed = (mean - float(gained.mean())) * (covered / share if share > 0.0 else 1.0)
    formed: Array = gained + removed
    return formed


def _lost(scene: Scene, rows: int, bare: Array, heights: Array, share: Array, wear: float, roughness: float) -> Array:
    """Return the wear [m] of the track's solid heights, of a given mean, that leaves a given roughness [m].

    If no cut through the highest points takes away enough, the roughness becomes as small as it can. `share` is the
    pressure over its mean.
    """
    track, middle = track_rows(scene, rows), middle_rows(scene, rows)
    if wear <= 0.0:
        return wear * share

    def lost(cut: float) -> Array:
        peaks = np.maximum(heights - cut, 0.0)
        return peaks + (wear - peaks.mean()) * share

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
    """Return the height [m] above which there is `mean` [m] of the solid, averaged over all nodes."""
    high, low = float(heights.max()), float(heights.min()) - mean
    for _ in range(_HALVINGS):
        cut = 0.5 * (low + high)
        low, high = (cut, high) if np.maximum(heights - cut, 0.0).mean() > mean else (low, cut)
    return high


def _covered(heights: Array, growth: Array, coverage: float) -> NDArray[np.bool_]:
    """Return the nodes that make up the coverage: those that have grown most, and the highest of those without any."""
    order = np.lexsort((-heights.ravel(), -growth.ravel()))
    covered = np.zeros(heights.shape, bool)
    covered.flat[order[: math.ceil(coverage * heights.size)]] = True
    return covered


def _raised(field: Array, covered: NDArray[np.bool_], then: float, now: float, most: float) -> Array:
    """Return a field [m] whose mean changes from `then` to `now`.

    An increase takes the same part of the room up to `most` on every covered node, a decrease the same part of the
    field everywhere.
    """
    if now <= then or not covered.any():
        return field * (now / then) if then > 0.0 else field
    room = np.where(covered, np.maximum(most - field, 0.0), 0.0)
    return field + room * ((now - then) / float(room.mean()))
