"""The rubbed surfaces for profiles and pictures: a track is its patch, laid end to end."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..errors import StateError
from ..scene import Scene
from ..state import ContactState
from .patches import bare_heights, heights_of
from .track_means import folded


@dataclass(frozen=True)
class Track:
    """A piece of a body's rubbing track. Arrays [y, x] in metres; x along the track, y across, 0 in its middle.

    A profile across the track is one column, or the mean over them; one along the track's middle is the middle row.
    """

    x: Array
    y: Array
    new: Array  # heights before the first pass
    heights: Array  # as they are: new - wear - plastic - open pits + tribofilm
    wear: Array
    plastic: Array
    pits: Array
    tribofilm: Array


def track_of(scene: Scene, state: ContactState, body: int, length: float | None = None) -> Track:
    """Return `length` [m] of the track of body 1 or 2 in a state: by default one patch, at most all of it.

    Raises StateError if there is no such body or the length is not above zero and within the track.
    """
    if body not in (1, 2):
        raise StateError(f"body = {body!r} must be 1 or 2.")
    whole, patch = scene.track_lengths[body - 1], scene.film.domain
    length = patch if length is None else length
    if not 0.0 < length <= max(whole, patch):
        raise StateError(f"length = {length!r} m must be above 0 and at most the track of body {body}, {whole:g} m.")
    nodes = max(1, round(length / scene.film.spacing))
    state = folded(scene, state)
    part = state.bodies[body - 1]
    bare = bare_heights(scene, state.rows)[body - 1]

    def laid(field: Array) -> Array:
        return field[:, np.arange(nodes) % field.shape[1]]

    return Track(
        x=np.arange(nodes, dtype=np.float64) * scene.film.spacing,
        y=scene.grid(state.rows).y,
        new=laid(bare),
        heights=laid(heights_of(bare, part)),
        wear=laid(part.wear),
        plastic=laid(part.plastic),
        pits=laid(part.pits),
        tribofilm=laid(part.tribofilm),
    )
