"""Grids that fit a film: wide enough for the oil to come in and go out, and no wider, so that the nodes are close."""

import numpy as np

from ..reference import hertz_point
from ..shapes import Point
from .instant import Grid
from .scaled import film_size, inlet_length

_LEFT, _RIGHT, _SIDES = 4.5, 2.5, 3.5  # half widths of a thick film, in its size
_INLETS_BEFORE, _INLETS_AROUND = 10.0, 6.0  # inlet lengths about Hertz's contact that a thin film needs


def fitted_grid(load: float, radius: float, reduced_modulus: float, film: float, ny: int, nx: int) -> Grid:
    """Grid of [ny, nx] nodes for a film [m] of smooth bodies. SI; the centre of the contact is a node for even nx - 1.

    Oil comes in along +x. The wider of the two needs, along x and along y, gives the spacing.
    """
    a = hertz_point(load, radius, radius, reduced_modulus).a
    size, inlet = film_size(a, radius, film), inlet_length(a, Point(radius, radius), film)
    left = min(_LEFT * size, 1.1 * a + _INLETS_BEFORE * inlet)
    right = min(_RIGHT * size, 1.25 * a + inlet)
    side = min(_SIDES * size, 1.15 * a + _INLETS_AROUND * inlet)
    spacing = max((left + right) / (nx - 1), 2.0 * side / (ny - 1))
    before = round((nx - 1) * left / (left + right))  # a node lies on the centre
    x, y = np.arange(nx, dtype=np.float64) - before, np.arange(ny, dtype=np.float64) - 0.5 * (ny - 1)
    return Grid(x * spacing, y * spacing)
