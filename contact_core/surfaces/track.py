"""The rubbing track |y| < b: its rows, and means over it.

b is Hertz's half width at the reference load and the scene's own radii, whatever load and radii are now: a mean over
the track does not jump with them.
"""

import numpy as np
from numpy.typing import NDArray

from ..scene import Scene
from ..state import Body
from .patches import bare_heights, heights_of, roughness_of
from .roughness import rms_roughness

Array = NDArray[np.float64]

MIDDLE = 2.0 / 3.0  # share of the track over which roughness is measured


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


def roughness_now(scene: Scene, body: Body, index: int) -> float:
    """Return the rms roughness [m] of body 1 (`index` 0) or 2 (1) over |y| < 2b/3, free of the groove's shape."""
    rows = body.wear.shape[0]
    bare = bare_heights(scene, rows)[index]
    return rms_roughness(roughness_of(bare, heights_of(bare, body)), track_rows(scene, rows, MIDDLE))


def mean_tribofilm(scene: Scene, body: Body) -> float:
    """Return the mean tribofilm thickness [m] over the track."""
    return float(body.tribofilm[track_rows(scene, body.wear.shape[0])].mean())
