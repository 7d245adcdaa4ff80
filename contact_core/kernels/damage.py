"""Damage of material in layers below a surface that wear lowers, and what breaks out of it.

`damage` [nz, rows, columns] are means of the layers: layers lie at fixed `depths` [nz] below the present surface and
meet halfway, the first one reaches up to the surface, below the last one nothing changes. Material moves up through
them as the surface is lowered, and its damage with it: what leaves a layer enters the next one or is worn off, so the
damage of a body under a steady wear is the sum of what the layers take over the wear rate, whatever the steps. Values
between layers are linear and never beyond those of the neighbours (van Leer, J. Comput. Phys. 32 (1979) 101,
doi:10.1016/0021-9991(79)90145-1): no step makes a new extreme, and none moves damage by more than a layer too far.
"""

import numpy as np
from numpy.typing import NDArray

from ..errors import ContactError

Array = NDArray[np.float64]


def accumulated(damage: Array, depths: Array, gained: Array, removed: Array) -> Array:
    """Return the damage after a step in which layers gained damage while the surface was lowered.

    Parameters
    ----------
    damage
        Damage before, [nz, rows, columns].
    depths
        Depths [m] of the layers below the surface, rising from 0 or more, [nz].
    gained
        What a material at rest would gain at these depths: cycles times damage per cycle, in the shape of `damage`.
    removed
        Depth [m] by which the surface was lowered, 0 or more, [rows, columns].

    Returns
    -------
    Array
        Half is gained before and half after the surface is lowered: steps of second order in their length, and exact
        where nothing is removed.

    Raises
    ------
    ContactError
        If a depth removed is negative or not a number.

    """
    if not np.any(removed):
        return damage + gained
    return worn_away(damage + 0.5 * gained, depths, removed) + 0.5 * gained


def worn_away(damage: Array, depths: Array, removed: Array) -> Array:
    """Return the damage [nz, rows, columns] below a surface after it was lowered by `removed` [m] [rows, columns].

    Raises ContactError if that is negative or not a number.
    """
    if not np.all(removed >= 0.0):
        raise ContactError("The depth worn off a damaged surface must be 0 or more at every node.")
    if depths.size == 1:
        return damage.copy()
    faces = faces_of(depths)
    width = np.diff(faces)[:, None, None]
    steep = _slopes(damage, faces)
    above = np.concatenate((np.zeros((1, *removed.shape)), np.cumsum(damage * width, axis=0)))  # down to each face
    below = np.empty_like(above)  # down to each face as it will be
    for i, face in enumerate(faces):
        at = face + removed
        k = np.clip(np.searchsorted(faces, at, side="right") - 1, 0, depths.size - 1)[None]
        into = at[None] - faces[k]
        mean, slope, up_to = (np.take_along_axis(field, k, axis=0) for field in (damage, steep, above))
        inside = np.minimum(into, width[k[0], 0, 0])
        below[i] = (up_to + mean * into - 0.5 * slope * inside * (width[k[0], 0, 0] - inside))[0]
    after = np.diff(below, axis=0) / width
    return np.clip(after, damage.min(axis=0), damage.max(axis=0))  # rounding


def pits_of(damage: Array, depths: Array) -> tuple[Array, Array]:
    """Return the depth [m] [rows, columns] of what breaks out, and the damage after it.

    Material whose damage reaches 1 has failed. The deepest layer that has failed breaks out, down to its lower face,
    and with it all that is above it; what was below comes to the surface. Below the last layer, material is taken as
    new.
    """
    layers = np.arange(depths.size)[:, None, None]
    deepest = np.max(np.where(damage >= 1.0, layers, -1), axis=0)
    if not np.any(deepest >= 0):
        return np.zeros(damage.shape[1:]), damage.copy()
    faces = faces_of(depths)
    depth = faces[deepest + 1]
    under = np.minimum(deepest + 1, depths.size - 1)[None]
    left = np.where(layers <= deepest, np.take_along_axis(damage, under, axis=0), damage)
    after = worn_away(left, depths, depth)
    return depth, np.where(deepest == depths.size - 1, 0.0, after)


def faces_of(depths: Array) -> Array:
    """Return the depths [m] between which the layers lie, [nz + 1]."""
    if depths.size == 1:
        return np.array([0.0, 2.0 * depths[0]])
    halfway = 0.5 * (depths[1:] + depths[:-1])
    return np.concatenate(([0.0], halfway, [2.0 * depths[-1] - halfway[-1]]))


def _slopes(damage: Array, faces: Array) -> Array:
    """Return the slopes of damage over depth [1/m] within the layers, limited by their neighbours."""
    centres = 0.5 * (faces[1:] + faces[:-1])
    steps = np.diff(damage, axis=0)
    rises = steps / np.diff(centres)[:, None, None]
    first, second = rises[:-1], rises[1:]
    alike = first * second > 0.0
    steep = np.zeros_like(damage)
    steep[1:-1] = np.where(alike, 2.0 * first * second / np.where(alike, first + second, 1.0), 0.0)
    least = np.minimum(np.abs(steps[:-1]), np.abs(steps[1:])) * (2.0 / np.diff(faces)[1:-1, None, None])
    steep[1:-1] = np.clip(steep[1:-1], -least, least)
    return steep
