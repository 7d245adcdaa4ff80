"""Grids from coarse to fine over one contact, and the one surface that all of them sample."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ..errors import OperatingPointError
from ..film.instant import Grid
from ..kernels.arrays import Array

COARSEST, FINEST = 32, 512  # intervals along the shorter side
MOST_NODES = 600_000
_FINER = 0.9  # spacing over that of the grid before, at most
_MOST_DRY_NODES = 1_100_000  # of a dry contact, which costs less
_PARTS, _MOST_PARTS, _LEAST_CELLS = 16, 8, 16
_REACH = 8  # rows over which a spline forgets its ends


def wants_accuracy(accuracy: float | None, **expert: object) -> bool:
    """Return True if a call is asked for an accuracy, which leaves the `expert` arguments to the program.

    Raises OperatingPointError if both are given.
    """
    given = [f"{name} = {value!r}" for name, value in expert.items() if value is not None]
    if accuracy is not None and given:
        raise OperatingPointError(
            f"accuracy = {accuracy!r} chooses {' and '.join(expert)} itself: leave out {' and '.join(given)}, or give "
            f"{' and '.join(expert)} without accuracy."
        )
    return accuracy is not None


def intervals(least: int = COARSEST, most: int = FINEST) -> Iterator[int]:
    """Return 2^k and 3 2^k from `least` to `most`: grids that can be halved, each 4/3 or 3/2 as fine as the last."""
    for power in range(1, 14):
        for count in (2**power, 3 * 2 ** (power - 1)):
            if least <= count <= most:
                yield count


def grids_within(given: Grid, finest: int = FINEST) -> list[Grid]:
    """Return grids over the extent of a given one, from coarse to fine."""
    grids: list[Grid] = []
    for count in intervals(COARSEST, finest):
        grid = refined_grid(given, count)
        if grid.x.size * grid.y.size > MOST_NODES:
            break
        if not grids or grid.spacing < _FINER * grids[-1].spacing:
            grids.append(grid)
    return grids


def refined_grid(given: Grid, count: int) -> Grid:
    """Return a grid of square cells over the same extent, `count` of them along the shorter side.

    The longer side may be a part of a cell shorter. A grid that repeats along y keeps its period exactly: its rows are
    even in number, or one, and the cells along x follow from them.
    """
    (ny, nx), long, wide = given.shape, float(np.ptp(given.x)), float(np.ptp(given.y))
    if given.periodic:
        period = ny * given.spacing
        rows = 1 if ny == 1 else max(2 * round(0.5 * ny * count / (nx - 1)), 2)
        step = long / count if rows == 1 else period / rows
        repeats = given.repeats * period / (rows * step)
    else:
        step, repeats = min(long, wide) / count, given.repeats
        rows = _cells(wide, step) + 1
    return Grid(_about(given.x, _cells(long, step) + 1, step), _about(given.y, rows, step), given.periodic, repeats)


def refined_cells(ny: int, nx: int, spacing: float) -> list[Grid]:
    """Return grids whose cells cover the same area as ny by nx cells of a spacing, from coarse to fine."""
    grids = []
    for count in intervals(1, _PARTS * _MOST_PARTS):  # cells on each `_PARTS` of the given ones
        rows, columns = (n * count / _PARTS for n in (ny, nx))
        whole = rows == int(rows) and columns == int(columns)
        if whole and min(rows, columns) >= _LEAST_CELLS and (count <= _PARTS or rows * columns <= _MOST_DRY_NODES):
            grids.append(Grid.centred(int(rows), int(columns), spacing * _PARTS / count))
    return grids


@dataclass(frozen=True)
class Surface:
    """Heights between nodes."""

    on: Callable[[Grid], Array]  # heights [m] on the nodes of a grid
    spacing: float  # [m] of the nodes that define it, infinite if it is flat: coarser grids do not show it


def surface_of(heights: Array, given: Grid) -> Surface:
    """Return the surface through heights on the nodes of `given`: a cubic spline."""
    from scipy.interpolate import CubicSpline, RectBivariateSpline  # loaded where it is needed

    x, y, z = given.x, given.y, heights
    shown = given.spacing if heights.any() else np.inf
    if y.size == 1:
        line = CubicSpline(x, z[0])
        return Surface(lambda grid: np.ascontiguousarray(line(grid.x)[None]), shown)
    if given.periodic:  # its rows go on, as far as the spline reaches
        more = _REACH
        rows = np.arange(-more, y.size + more)
        y, z = y[0] + rows * given.spacing, z[rows % y.size]
    spline = RectBivariateSpline(y, x, z, kx=min(3, y.size - 1), ky=min(3, x.size - 1))
    return Surface(lambda grid: np.ascontiguousarray(spline(grid.y, grid.x)), shown)


def _cells(length: float, step: float) -> int:
    """Return the cells of a step that fit into a length."""
    return int(length / step * (1.0 + 1e-9))


def _about(axis: Array, nodes: int, step: float) -> Array:
    """Return nodes about the middle of an axis."""
    middle = 0.5 * (float(axis[0]) + float(axis[-1]))
    nodes_about: Array = middle + (np.arange(nodes, dtype=np.float64) - 0.5 * (nodes - 1)) * step
    return nodes_about
