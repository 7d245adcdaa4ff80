"""From damage below the patches to classes of points at the regression level, and back."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..scene import Scene
from ..state import Below, Body, ContactState
from ..state.below import nothing_below
from ..state.classes import EDGES, WEIGHTS, Classes, unharmed_classes
from .patches import bare_heights, solid_of, track_rows

Indices = NDArray[np.int64]

_WHOLE = np.nextafter(1.0, 0.0)  # largest damage of material that has not failed
_BROKEN = 0.5  # share of the points of a class that have failed above which the class has broken out
_PARTS = 4  # of |y| < b, of contacts whose pressure falls off along y


_ROWS = (np.arange(_PARTS) + 0.5) / _PARTS
_ROW = np.full(1, 0.5)


def rows_of(scene: Scene) -> Array:
    """Return the places |y| / b of the classes, b at the scene's load; lines have one."""
    return _ROW if scene.shape().along_face else _ROWS


def classes_of(scene: Scene, state: ContactState) -> Classes:
    """Return the means of the damage below the patches by classes, the points of each row ordered by their damage."""
    if state.below is None and not any(body.pits.any() for body in state.bodies):
        return unharmed_classes(scene.depths.size, rows_of(scene).size)
    found = [_classes_of(scene, state, i) for i in (0, 1)]
    return Classes(found[0][0], found[1][0], found[0][1], found[1][1], np.zeros(2))


def _classes_of(scene: Scene, state: ContactState, i: int) -> tuple[Array, Array]:
    layers, pits = _layers(scene, state, i), state.bodies[i].pits[track_rows(scene, state.rows)]
    damage, depth = [], []
    for nodes, which in _ordered(scene, state, i):
        for k in range(WEIGHTS.size):
            mine = nodes[which == k]
            if not mine.size:  # too few nodes for a class: the nearest one
                mine = nodes[[min(int((EDGES[k] - 0.5 * WEIGHTS[k]) * nodes.size), nodes.size - 1)]]
            damage.append(layers[:, mine].mean(axis=1))
            broken = pits.ravel()[mine]
            depth.append(broken.mean() if (broken > 0.0).mean() >= _BROKEN else 0.0)
    return np.stack(damage, axis=1), np.array(depth)


def _layers(scene: Scene, state: ContactState, i: int) -> Array:
    """Return the damage below the nodes of a track, [layers, nodes]."""
    track, layers = track_rows(scene, state.rows), scene.depths.size
    if state.below is None:
        return np.zeros((layers, int(track.sum()) * (scene.film.points - 1)))
    field = state.below.damage[i].reshape(layers, state.rows, -1)
    return field[:, track].reshape(layers, -1)


def _ordered(scene: Scene, state: ContactState, i: int) -> Iterator[tuple[Indices, Indices]]:
    """Yield the nodes of the track in each row of classes, the least damaged first, and the class of each.

    Those alike are ordered by height: the highest are loaded most.
    """
    track, body = track_rows(scene, state.rows), state.bodies[i]
    worst = _layers(scene, state, i).max(axis=0)
    heights = solid_of(bare_heights(scene, state.rows)[i], body)[track].ravel()
    order = np.lexsort((heights, worst, body.pits[track].ravel()))
    parts = rows_of(scene).size
    y = np.abs(scene.grid(state.rows).y[track]) / max(scene.hertz(scene.operation.load).b, 1e-30)
    part = np.minimum((y * parts).astype(np.int64), parts - 1) if parts > 1 else np.zeros(y.size, np.int64)
    of_node = np.repeat(part, scene.film.points - 1)
    for j in range(parts):
        nodes = order[of_node[order] == j]
        if not nodes.size:  # the grid has no node there
            nodes = order
        shares = (np.arange(nodes.size) + 0.5) / nodes.size
        yield nodes, np.searchsorted(EDGES, shares)


def folded_damage(
    scene: Scene, state: ContactState, bodies: tuple[Body, Body]
) -> tuple[Below | None, tuple[Body, Body]]:
    """Return what lies below, and the bodies with their pits, after the change of the classes; unchanged, nothing is.

    Each point takes the change of its class. `bodies` are those of the state, with tribofilm and wear as they are now.
    What the curves may be wrong by stays with what they have added.
    """
    now = state.classes
    if now is None:
        return state.below, bodies
    then = classes_of(scene, state)
    if now.alike(then):
        return state.below, bodies
    below = state.below or nothing_below(scene.depths.size, state.rows, scene.film.points - 1)
    track, layers = track_rows(scene, state.rows), scene.depths.size
    damages, after, gained = [], [], []
    for i, body in enumerate(bodies):
        damage = below.damage[i].reshape(layers, state.rows, -1).copy()
        inside, pits = damage[:, track].reshape(layers, -1), body.pits.copy()
        before = float(inside.max(axis=0).mean())
        broken = pits[track].ravel()
        for j, (nodes, which) in enumerate(_ordered(scene, state, i)):
            at = j * WEIGHTS.size + which
            inside[:, nodes] += (now.damage[i] - then.damage[i])[:, at]
            broken[nodes] += (now.pits[i] - then.pits[i])[at]
        inside = np.clip(inside, 0.0, _WHOLE)
        gained.append(max(float(inside.max(axis=0).mean()) - before, 0.0))
        damage[:, track] = inside.reshape(layers, -1, damage.shape[2])
        pits[track] = broken.reshape(-1, pits.shape[1])
        damages.append(damage.reshape(below.damage[i].shape))
        after.append(replace(body, pits=pits, opened=pits if scene.stress.opens_pits else body.opened))
    late = below.late + state.outputs.error_damage * np.array(gained)
    return replace(below, damage_1=damages[0], damage_2=damages[1], late=late), (after[0], after[1])
