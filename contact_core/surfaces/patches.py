"""Body-fixed patches: heights of the bodies as they are now, and their place under the contact.

A patch [rows, nx - 1] repeats along x and shares its rows with the grid of the contact [rows, nx]. A scar that reaches
the edge adds rows, except on a line, which has no edge.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..scene import Scene, Surface
from ..state import Body, ContactState
from .roughness import generate, groove_free

Array = NDArray[np.float64]


class FacingSurfaces(NamedTuple):
    """Both surfaces as they face each other in the contact. Arrays [ny, nx]."""

    heights: Array  # of both bodies together, positive into the gap [m]
    roughness: Array  # the same, free of the grooves' shape [m]
    tribofilms: tuple[Array, Array]  # thickness on each body [m]
    plastic: Array  # permanent depth of both bodies that plasticity.indentation = "total" counts [m], else 0


def facing_surfaces(scene: Scene, state: ContactState) -> FacingSurfaces:
    """Return the surfaces of a state where the bodies lie now."""
    nodes = [patch_nodes(scene, body) for body in state.bodies]
    bare = bare_heights(scene, state.rows)
    patches = [heights_of(z, body) for z, body in zip(bare, state.bodies, strict=True)]
    films = [on_grid(body.tribofilm, n) for body, n in zip(state.bodies, nodes, strict=True)]
    plastic = np.zeros((state.rows, scene.film.points))
    if scene.plasticity.indentation == "total":
        plastic += sum(on_grid(body.plastic, n) for body, n in zip(state.bodies, nodes, strict=True))
    return FacingSurfaces(
        heights=on_grid(patches[0], nodes[0]) + on_grid(patches[1], nodes[1]),
        roughness=on_grid(roughness_of(bare[0], patches[0]), nodes[0])
        + on_grid(roughness_of(bare[1], patches[1]), nodes[1]),
        tribofilms=(films[0], films[1]),
        plastic=plastic,
    )


def patch_nodes(scene: Scene, body: Body) -> int:
    """Return the whole nodes by which a body's patch is shifted along +x."""
    return round(body.offset / scene.film.spacing) % (scene.film.points - 1)


def on_grid(patch: Array, nodes: int) -> Array:
    """Return a patch shifted along +x, on the grid: the last column repeats the first."""
    moved = np.roll(patch, nodes, axis=1)
    return np.concatenate([moved, moved[:, :1]], axis=1)


def on_patch(grid: NDArray[Any], nodes: int) -> NDArray[Any]:
    """Return a field of the grid on a patch shifted by `nodes`. The grid's last column carries no pressure."""
    return np.roll(grid[:, :-1], -nodes, axis=1)


def on_patches(scene: Scene, state: ContactState, fields: tuple[NDArray[Any], NDArray[Any]]) -> list[NDArray[Any]]:
    """Return a field of the grid per body on the patches of both bodies."""
    return [on_patch(field, patch_nodes(scene, body)) for field, body in zip(fields, state.bodies, strict=True)]


def bare_heights(scene: Scene, rows: int) -> tuple[Array, Array]:
    """Return the generated heights of both bodies' patches, as new. Rows beyond the scene's own repeat them."""
    film, own = scene.film, scene.rows
    period = own if scene.shape().periodic else own - 1
    grid = (film.points, film.domain, period, own, rows)
    return _bare(scene.surface_1, 1, *grid), _bare(scene.surface_2, 2, *grid)


@lru_cache(maxsize=32)  # sixteen contacts in one process
def _bare(surface: Surface, body: int, points: int, domain: float, period: int, own: int, rows: int) -> Array:
    at = np.arange(rows) - (rows - own) // 2
    heights = generate(surface, points, domain, body, period)[at % period]
    heights.setflags(write=False)
    return heights


def heights_of(bare: Array, body: Body) -> Array:
    """Return the heights of a body's patch as it is now: new surface - wear - plastic depth + tribofilm."""
    return bare - body.wear - body.plastic + body.tribofilm


def roughness_of(bare: Array, heights: Array) -> Array:
    """Return the heights of a patch without its groove: the mean loss or gain of each row is left out."""
    return bare + groove_free(heights - bare)


def widened(body: Body, more: int) -> Body:
    """Return a body with `more` fresh rows on either side."""

    def fresh(name: str) -> Array:
        return np.pad(getattr(body, name), ((more, more), (0, 0)), constant_values=np.inf if name == "since" else 0.0)

    arrays: dict[str, Any] = {name: fresh(name) for name in Body.ARRAYS}
    return replace(body, **arrays)


def rolled(scene: Scene, state: ContactState, steps: Sequence[float]) -> ContactState:
    """Return the state after both bodies have moved along +x, each by its step [m]."""
    first, second = (
        replace(body, offset=(body.offset + step) % scene.film.domain)
        for body, step in zip(state.bodies, steps, strict=True)
    )
    return replace(state, bodies=(first, second))


def yielded(scene: Scene, state: ContactState, overlap: Array) -> ContactState:
    """Return the state after half of the overlap has been pressed into each body permanently."""
    if not overlap.any():
        return state
    first, second = (
        replace(body, plastic=body.plastic + 0.5 * pressed)
        for body, pressed in zip(state.bodies, on_patches(scene, state, (overlap, overlap)), strict=True)
    )
    return replace(state, bodies=(first, second))


def moved_nodes(scene: Scene, before: ContactState, after: ContactState) -> int:
    """Return the whole nodes by which the rougher body has moved along +x, by half a patch at most."""
    rougher, columns = scene.rougher, scene.film.points - 1
    early, late = (patch_nodes(scene, state.bodies[rougher]) for state in (before, after))
    return (late - early + columns // 2) % columns - columns // 2
