"""Body-fixed patches: heights of the bodies as they are now, their place under the contact, their rubbing track.

A patch [rows, nx - 1] repeats along x and shares its rows with the grid of the contact [rows, nx]. A scar that reaches
the edge adds rows, except on a line, which has no edge. The track is |y| < b; b is Hertz's half width at the reference
load and the scene's own radii, whatever load and radii are now: a mean over the track does not jump with them.
"""

from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..scene import Scene, SelfAffine, Surface
from ..state import Body, ContactState
from .laid import laid
from .roughness import generate, groove_free

_ON_NODE = 1e-9  # part of a node that is none
_MIDDLE = 2.0 / 3.0  # share of the track over which roughness is measured


class SurfaceNow(NamedTuple):
    """One body's patch as it is now. Arrays [rows, nx - 1]; rows of the track are masks [rows]."""

    heights: Array  # [m]
    roughness: Array  # heights free of the groove's shape [m]
    track: NDArray[np.bool_]  # rows with |y| < b
    middle: NDArray[np.bool_]  # rows with |y| < 2b/3, over which roughness is measured


class FacingSurfaces(NamedTuple):
    """Both surfaces as they face each other in the contact. Arrays [ny, nx]."""

    heights: Array  # of both bodies together, positive into the gap [m]
    roughness: Array  # the same, free of the grooves' shape [m]
    tribofilms: tuple[Array, Array]  # thickness on each body [m]
    plastic: Array  # permanent depth of both bodies that `plasticity.remembers` [m], else 0


def facing_surfaces(scene: Scene, state: ContactState, *, moving: bool = False) -> FacingSurfaces:
    """Return the surfaces of a state where the bodies lie now.

    moving: at their very places, as a film that follows their motion needs it; else at the nearest nodes.
    """
    nodes = [patch_nodes(scene, body, state.window) for body in state.bodies]
    parts = [part_of_node(scene, body, state.window) * moving for body in state.bodies]
    bare = bare_heights(scene, state.rows)
    patches = [heights_of(z, body) for z, body in zip(bare, state.bodies, strict=True)]
    heights, roughness = (
        on_grid(between(first, parts[0]), nodes[0]) + on_grid(between(second, parts[1]), nodes[1])
        for first, second in (patches, [roughness_of(z, patch) for z, patch in zip(bare, patches, strict=True)])
    )
    return FacingSurfaces(heights, roughness, *facing_films(scene, state))


def facing_films(scene: Scene, state: ContactState) -> tuple[tuple[Array, Array], Array]:
    """Return `tribofilms` and `plastic` of the facing surfaces."""
    nodes = [patch_nodes(scene, body, state.window) for body in state.bodies]
    first, second = (on_grid(body.tribofilm, n) for body, n in zip(state.bodies, nodes, strict=True))
    plastic = np.zeros((state.rows, scene.film.points))
    if scene.plasticity.remembers:
        plastic += sum(on_grid(body.plastic, n) for body, n in zip(state.bodies, nodes, strict=True))
    return (first, second), plastic


def added_friction(scene: Scene, state: ContactState, cover: Array) -> Array | None:
    """Return what oxides add to the coefficient of boundary friction, [ny, nx]; None without a law of oxide.

    `cover` is the mean cover of both bodies by tribofilm.
    """
    law = scene.oxide
    if not law.grows:
        return None
    first, second = (law.cover(on_grid(body.oxide, patch_nodes(scene, body, state.window))) for body in state.bodies)
    added: Array = law.added_friction(scene.boundary_friction.bare, 0.5 * (first + second), cover)
    return added


def surface_now(scene: Scene, body: Body, index: int) -> SurfaceNow:
    """Return the patch of body 1 (`index` 0) or 2 (1) as it is now."""
    rows = body.wear.shape[0]
    bare = bare_heights(scene, rows)[index]
    heights = heights_of(bare, body)
    return SurfaceNow(heights, roughness_of(bare, heights), track_rows(scene, rows), middle_rows(scene, rows))


def across_track(scene: Scene, rows: int) -> Array | None:
    """Return |y| / b of each row of the patches, [rows, 1]; None where nothing changes along the face."""
    if scene.shape().along_face:
        return None
    across: Array = np.abs(scene.grid(rows).y)[:, None] / scene.hertz(scene.operation.load).b
    return across


def track_rows(scene: Scene, rows: int, share: float = 1.0) -> NDArray[np.bool_]:
    """Return the rows of the patches with |y| < share * b, at least the middle one."""
    b = scene.hertz(scene.operation.load).b
    y = scene.grid(rows).y
    inside: NDArray[np.bool_] = np.abs(y) < max(share * b, 0.51 * scene.film.spacing)
    return inside


def middle_rows(scene: Scene, rows: int) -> NDArray[np.bool_]:
    """Return the rows of the patches over which roughness is measured, |y| < 2b/3."""
    return track_rows(scene, rows, _MIDDLE)


def patch_nodes(scene: Scene, body: Body, window: float = 0.0) -> int:
    """Return the whole nodes by which a body's patch is shifted along +x on the grid, which lies `window` [m] ahead."""
    return round((body.offset - window) / scene.film.spacing) % (scene.film.points - 1)


def part_of_node(scene: Scene, body: Body, window: float = 0.0) -> float:
    """Return the part of a node, -1/2 to 1/2, by which a body lies further along +x than `patch_nodes`."""
    where = (body.offset - window) / scene.film.spacing
    return where - round(where)


def between(patch: Array, part: float) -> Array:
    """Return a patch shifted along +x by a part of a node: the sum of its waves, shifted.

    All waves keep their heights, up to the shortest: roughness of a node's length does not flatten between nodes.
    """
    if abs(part) < _ON_NODE:
        return patch
    columns = patch.shape[1]
    waves = np.exp(-2j * np.pi * part * np.fft.rfftfreq(columns))
    moved: Array = np.fft.irfft(np.fft.rfft(patch, axis=1) * waves, columns, axis=1)
    return moved


def on_grid(patch: Array, nodes: int) -> Array:
    """Return a patch shifted along +x, on the grid: the last column repeats the first."""
    moved = np.roll(patch, nodes, axis=1)
    return np.concatenate([moved, moved[:, :1]], axis=1)


def on_patch(grid: NDArray[Any], nodes: int) -> NDArray[Any]:
    """Return a field of the grid on a patch shifted by `nodes`. The grid's last column carries no pressure."""
    return np.roll(grid[:, :-1], -nodes, axis=1)


def on_patches(scene: Scene, state: ContactState, fields: tuple[NDArray[Any], NDArray[Any]]) -> list[NDArray[Any]]:
    """Return a field of the grid per body on the patches of both bodies."""
    pairs = zip(fields, state.bodies, strict=True)
    return [on_patch(field, patch_nodes(scene, body, state.window)) for field, body in pairs]


def bare_heights(scene: Scene, rows: int) -> tuple[Array, Array]:
    """Return the heights of both bodies' patches, as new. Rows beyond the scene's own repeat them."""
    grid = (scene.film.points, scene.patch_size, scene.period, scene.rows, rows)
    return _bare(scene.surface_1, 1, *grid), _bare(scene.surface_2, 2, *grid)


@lru_cache(maxsize=32)  # sixteen contacts in one process
def _bare(
    surface: Surface | SelfAffine, body: int, points: int, size: tuple[float, float], period: int, own: int, rows: int
) -> Array:
    at = np.arange(rows) - (rows - own) // 2
    heights = generate(surface, points, size[1], body, period)[at % period]
    if surface.heights is not None:
        heights = heights + laid(surface.heights, size, (period, points - 1))[at % period]
    heights.setflags(write=False)
    return heights


def heights_of(bare: Array, body: Body) -> Array:
    """Return the heights of a body's patch as it is now: its solid and the tribofilm on it."""
    return solid_of(bare, body) + body.tribofilm


def solid_of(bare: Array, body: Body) -> Array:
    """Return the heights of a body's solid as it is now: new surface - wear - plastic depth - open pits."""
    return bare - body.wear - body.plastic - body.opened


def roughness_of(bare: Array, heights: Array) -> Array:
    """Return the heights of a patch without its groove: the mean loss or gain of each row is left out."""
    return bare + groove_free(heights - bare)


def widened(body: Body, more: int) -> Body:
    """Return a body with `more` fresh rows on either side."""

    def fresh(name: str) -> Array:
        return np.pad(getattr(body, name), ((more, more), (0, 0)), constant_values=np.inf if name == "since" else 0.0)

    arrays: dict[str, Any] = {name: fresh(name) for name in Body.ARRAYS}
    return replace(body, **arrays)
