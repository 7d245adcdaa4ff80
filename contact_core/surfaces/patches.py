"""Body-fixed patches: what a surface is now, and where it lies under the contact.

A patch [rows, nx - 1] repeats along x and shares its rows with the grid of the contact [rows, nx]. A scar that reaches
the edge makes rows more, but not on a line, which has no edge.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..film.instant import Grid
from ..laws.tribofilm import thickness
from ..scene import Scene, Surface
from ..state import Body, ContactState
from .roughness import generate, groove_free

Array = NDArray[np.float64]


def contact_grid(scene: Scene, rows: int) -> Grid:
    """The nodes of the contact with `rows` of them along y."""
    film, periodic = scene.film, scene.shape().periodic
    return Grid.centred(rows, film.points, film.spacing, periodic=periodic, repeats=scene.repeats)


def patch_nodes(scene: Scene, body: Body) -> int:
    """Whole nodes by which a body's patch is shifted along +x."""
    return round(body.offset / scene.film.spacing) % (scene.film.points - 1)


def on_grid(patch: Array, nodes: int) -> Array:
    """A patch shifted along +x, on the grid: the last column repeats the first."""
    moved = np.roll(patch, nodes, axis=1)
    return np.concatenate([moved, moved[:, :1]], axis=1)


def on_patch(grid: NDArray[Any], nodes: int) -> NDArray[Any]:
    """A field of the grid on a patch shifted by `nodes`. The grid's last column carries no pressure."""
    return np.roll(grid[:, :-1], -nodes, axis=1)


def bare_heights(scene: Scene, rows: int) -> tuple[Array, Array]:
    """Generated heights of both bodies' patches, as new. Rows beyond the scene's own repeat them."""
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
    """Heights of a body's patch as it is now: new surface - wear - plastic depth + tribofilm."""
    return bare - body.wear - body.plastic + thickness(body.growth, body.removal)


def roughness_of(bare: Array, heights: Array) -> Array:
    """Heights of a patch without the groove it has got: what the rows have lost or gained on average is left out."""
    return bare + groove_free(heights - bare)


def widened(body: Body, more: int) -> Body:
    """A body with `more` fresh rows on either side."""

    def fresh(name: str) -> Array:
        return np.pad(getattr(body, name), ((more, more), (0, 0)), constant_values=np.inf if name == "since" else 0.0)

    arrays: dict[str, Any] = {name: fresh(name) for name in Body.ARRAYS}
    return replace(body, **arrays)


def rolled(scene: Scene, state: ContactState, steps: Sequence[float]) -> ContactState:
    """The state after both bodies have moved along +x, each by its step [m]."""
    first, second = (
        replace(body, offset=(body.offset + step) % scene.film.domain)
        for body, step in zip(state.bodies, steps, strict=True)
    )
    return replace(state, bodies=(first, second))


def yielded(scene: Scene, state: ContactState, overlap: Array) -> ContactState:
    """The state after half of the overlap has been pressed into each body, for good."""
    if not overlap.any():
        return state
    first, second = (
        replace(body, plastic=body.plastic + 0.5 * on_patch(overlap, patch_nodes(scene, body))) for body in state.bodies
    )
    return replace(state, bodies=(first, second))


def moved_nodes(scene: Scene, before: ContactState, after: ContactState) -> int:
    """Whole nodes by which the rougher body has moved along +x, by half a patch at most."""
    rougher, columns = 0 if scene.surface_1.rq > scene.surface_2.rq else 1, scene.film.points - 1
    early, late = (patch_nodes(scene, state.bodies[rougher]) for state in (before, after))
    return (late - early + columns // 2) % columns - columns // 2
