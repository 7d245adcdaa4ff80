"""Grids that fit a film: wide enough for oil to flow in and out, and no wider, so that the nodes are close."""

from dataclasses import dataclass
from math import ceil

import numpy as np

from ..shapes import Line, Point
from .instant import Grid
from .lengths import film_size, inlet_length

_LEFT, _RIGHT, _SIDES = 4.5, 2.5, 3.5  # half widths of a thick film, in its size
_LEFT_OF_LINE = 16.0  # no side flow, and no far field as of points
_INLETS_BEFORE, _INLETS_AROUND = 10.0, 6.0  # inlet lengths about Hertz's contact that a thin film needs
_NODES = 129  # along the shorter side by default
_COARSEST, _HALVINGS = 6.5, 2  # multigrid: intervals along the shorter side of its coarsest grid level; least halvings


@dataclass(frozen=True)
class Extent:
    """Extent of the grid about the contact [m]; oil flows in along +x."""

    left: float
    right: float
    side: float

    @staticmethod
    def of(shape: Point, load: float, reduced_modulus: float, film: float) -> "Extent":
        """Return the extent that a film [m] of smooth bodies needs. SI."""
        hertz, turned = shape.hertz(load, reduced_modulus), Point(shape.radius_y, shape.radius_x)
        a, b = hertz.a, hertz.b
        size, inlet = film_size(a, shape.radius_x, film), inlet_length(a, shape, film)
        width, around = film_size(b, turned.radius_x, film), inlet_length(b, turned, film)
        return Extent(
            left=min(_LEFT * size, 1.1 * a + _INLETS_BEFORE * inlet),
            right=min(_RIGHT * size, 1.25 * a + inlet),
            side=min(_SIDES * width, 1.15 * b + _INLETS_AROUND * around),
        )

    @property
    def ratio(self) -> float:
        """Width along y over length along x."""
        return 2.0 * self.side / (self.left + self.right)

    def shape(self, nx: int | None = None, *, shorter: int = _NODES) -> tuple[int, int]:
        """Return the nodes (ny, nx) of about square cells that can be halved for multigrid.

        For `nx` nodes along x, or for `shorter` nodes along the shorter side.
        """
        if nx is not None:
            return _partner(nx, self.ratio, mirror=True), nx
        if self.ratio >= 1.0:
            return _partner(shorter, self.ratio, mirror=True), shorter
        return shorter, _partner(shorter, 1.0 / self.ratio, mirror=False)

    def grid(self, ny: int, nx: int) -> Grid:
        """Return a grid of [ny, nx] nodes; the centre of the contact is a node for even nx - 1.

        The wider of the two needs, along x and along y, gives the spacing.
        """
        spacing = max((self.left + self.right) / (nx - 1), 2.0 * self.side / (ny - 1))
        before = round((nx - 1) * self.left / (self.left + self.right))  # a node lies on the centre
        x, y = np.arange(nx, dtype=np.float64) - before, np.arange(ny, dtype=np.float64) - 0.5 * (ny - 1)
        return Grid(x * spacing, y * spacing)


def line_extent(shape: Line, load: float, reduced_modulus: float, film: float) -> tuple[float, float]:
    """Return the extent before and behind the contact [m] that a film [m] of smooth bodies needs. SI."""
    a = shape.hertz(load, reduced_modulus).a
    size, inlet = film_size(a, shape.radius_x, film), inlet_length(a, shape, film)
    return min(_LEFT_OF_LINE * size, 1.1 * a + _INLETS_BEFORE * inlet), min(_RIGHT * size, 1.25 * a + inlet)


def rows_over(depth: float, spacing: float, nx: int) -> int:
    """Return the rows of square cells that reach over a depth [m], beside `nx` nodes along x.

    There are as many more as can be halved as often down to multigrid's coarsest grid level and keep a row in the
    middle.
    """
    step = 2
    while (nx - 1) % step == 0 and (nx - 1) // step >= _COARSEST:
        step *= 2
    return step * ceil(depth / spacing / step) + 1


def _partner(nodes: int, ratio: float, *, mirror: bool) -> int:
    """Return the nodes of a side `ratio` times as long as one of `nodes`, nearest of those that halve as often.

    `mirror`: its middle node stays a node.
    """
    intervals, wanted, halvings = nodes - 1, ratio * (nodes - 1), 0
    shorter = min(intervals, wanted)
    while intervals % 2 ** (halvings + 1) == 0 and (halvings < _HALVINGS or shorter >= _COARSEST * 2 ** (halvings + 1)):
        halvings += 1
    step = 2 ** (halvings + 1) if mirror else 2**halvings
    return max(round(wanted / step) * step, 8 * 2**halvings if halvings else 16) + 1


def fitted_grid(shape: Point, load: float, reduced_modulus: float, film: float, ny: int, nx: int) -> Grid:
    """Return a grid of [ny, nx] nodes for a film [m] of smooth bodies. SI; oil flows in along +x."""
    return Extent.of(shape, load, reduced_modulus, film).grid(ny, nx)
