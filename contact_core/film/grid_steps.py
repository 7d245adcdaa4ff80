"""Grids that are solved one after the other to meet an accuracy: a record of each, and what chance adds to an area."""

from dataclasses import dataclass

import numpy as np

from ..kernels.arrays import Mask


@dataclass(frozen=True)
class GridStep:
    """One of the grids that were solved to meet an accuracy."""

    nodes: tuple[int, int]  # along y and along x
    iterations: int
    converged: bool
    output: str  # with the largest stated error for what is asked of it; empty on a first grid, which has no estimate
    error: float  # stated one of that output, by the grid: relative, of ratios absolute


def area_by_chance(touching: Mask, cell: float, area: float) -> float:
    """Return how much of contact_area_ratio is chance: nodes at the edges of contacts touch or not.

    Two standard deviations if each of them is on either side; `cell` of a node and `area` of Hertz's contact in m2.
    """
    inside = np.pad(touching, 1)
    inside = inside[:-2, 1:-1] & inside[2:, 1:-1] & inside[1:-1, :-2] & inside[1:-1, 2:]
    if touching.shape[0] == 1:  # rows beside it are alike
        row = np.pad(touching[0], 1)
        inside = (row[:-2] & row[2:])[None]
    return 2.0 * float(np.sqrt(np.count_nonzero(touching & ~inside))) * cell / area
