"""Heights of a file, laid on the nodes of a patch."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..scene import Heights, HeightStatistics, Scene, statistics_of
from .roughness import generate

_CHUNK = 2**20  # numbers under one spline


def laid(heights: Heights, size: tuple[float, float], nodes: tuple[int, int]) -> Array:
    """Return heights [m] on a periodic patch of a size and a number of nodes along y and x.

    A node has the mean of its cell, of cubic splines through the file's numbers: a grid finer than the file shows
    the splines, a coarser one what is left of each wave over a cell. Nothing is added where a wall falls between
    nodes, and the volume is the same on every grid. Zero is the mean of the patch, with flat surroundings their level.
    """
    z = heights.values
    flat = heights.beyond == "flat"
    z = z - (heights.edge.mean() if flat else z.mean())
    for axis in (1, 0):
        z = _cell_means(z, heights.samples(axis, size[axis]), nodes[axis], axis)
    return z if flat else z - z.mean()


def _cell_means(z: Array, samples: NDArray[np.int64], nodes: int, axis: int) -> Array:
    """Return the means over the cells about each node along an axis, of what the chosen samples make up."""
    lines = np.moveaxis(z, axis, 1)
    chunks = np.array_split(lines, 1 + lines.shape[0] * samples.size // _CHUNK)
    return np.moveaxis(np.concatenate([_means_along(chunk, samples, nodes) for chunk in chunks]), 1, axis)


def _means_along(lines: Array, samples: NDArray[np.int64], nodes: int) -> Array:
    from scipy.interpolate import CubicSpline  # here: it loads slowly, and few scenes have heights

    count = samples.size
    if count == 1:
        return np.repeat(lines, nodes, axis=1)
    padded = np.concatenate([lines, np.zeros((lines.shape[0], 1))], axis=1)  # -1 is the last one: the surroundings
    period = padded[:, np.append(samples, samples[0])]
    total = CubicSpline(np.arange(count + 1), period, axis=1, bc_type="periodic").antiderivative()
    # sample i lies (i + 1/2) / count of a period from the patch's edge, node j lies j / nodes
    edges = (np.arange(nodes + 1) - 0.5) * (count / nodes) - 0.5
    turns = np.floor(edges / count)
    upto = total(np.clip(edges - turns * count, 0.0, count)) + turns * total(count)[:, None]
    means: Array = np.diff(upto, axis=1) * (nodes / count)
    return means


class Shown(NamedTuple):
    """What a grid shows of a body's surface, as new."""

    rms: float  # of all waves on the patch [m]
    slope: float  # rms gradient of all waves on the patch
    on_grid: HeightStatistics
    cut: float  # rms of what the grid does not show [m]


def shown(scene: Scene, body: int) -> Shown:
    """Return what the scene's grid shows of the surface of body 1 or 2, as new."""
    surface = scene.surface_1 if body == 1 else scene.surface_2
    film, size = scene.film, scene.patch_size
    heights = generate(surface, film.points, film.domain, body, scene.period)[:-1]
    variance, slope_2 = surface.rq**2, surface.slope**2
    if surface.heights is not None:
        heights = heights + laid(surface.heights, size, (scene.period, film.points - 1))
        variance += _variance(surface.heights, size)
        slope_2 -= (1.0 - _share(surface.heights, size)) * surface.heights.statistics.slope**2
    found = statistics_of(heights, film.spacing)
    return Shown(math.sqrt(variance), math.sqrt(slope_2), found, math.sqrt(max(variance - found.rms**2, 0.0)))


def _share(heights: Heights, size: tuple[float, float]) -> float:
    """Return the share of a patch that is not flat surroundings."""
    return math.prod(float(np.mean(heights.samples(axis, size[axis]) >= 0)) for axis in (0, 1))


def _variance(heights: Heights, size: tuple[float, float]) -> float:
    """Return the variance [m2] of the file's numbers on a patch."""
    z = np.pad(heights.values - heights.edge.mean(), (0, 1))  # the last row and column: flat surroundings
    shares = []
    for axis in (0, 1):
        samples = heights.samples(axis, size[axis])
        shares.append(np.bincount(samples % z.shape[axis], minlength=z.shape[axis]) / samples.size)
    mean, square = (float(shares[0] @ power @ shares[1]) for power in (z, z * z))
    return square - mean**2
