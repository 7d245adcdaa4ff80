"""Heights in text that no reader of SurfaceTopography takes: a matrix of numbers, or points with gaps among them.

A matrix has x along its rows; points have x, y and z in each line, on a lattice. Cells are apart by tabs, semicolons,
commas or spaces; a cell without a number is a point without a height.
"""

import math
import re
from typing import NamedTuple

import numpy as np

from contact_core.kernels.arrays import Array, Indices

SUFFIXES = (".csv", ".txt", ".asc", ".dat", ".xyz")
_NUMBER = re.compile(r"[+-]?(\d+[.,]?\d*|[.,]\d+)([eE][+-]?\d+)?$")
_REGULAR = 0.05  # of a spacing that a point may be off its place
_APART = 0.3  # of the largest step between neighbours: two whole lines of points may be missing
_FULL = 0.5  # share of a lattice's points that are there, at least: points all over are no lattice


class TextHeights(NamedTuple):
    """Heights [ny, nx] in the file's unit, nan where there is none, and spacing along y and x; None: not given."""

    heights: Array
    spacing: tuple[float, float] | None


def read(content: bytes) -> TextHeights | None:
    """Return the heights in text; None if it is not clear which numbers are heights."""
    rows = _rows(content.decode("utf-8-sig", errors="replace"))
    if len(rows) < 2 or len({len(row) for row in rows}) != 1:
        return None
    table = np.array(rows)
    return _points(table) if table.shape[1] == 3 else TextHeights(table, None)


def _rows(text: str) -> list[list[float]]:
    """Return the numbers of each line but of those without any, nan where a cell has none."""
    lines = [line.strip(" \r") for line in text.splitlines() if line.strip() and line.lstrip()[0] not in "#%"]
    mark = next((mark for mark in "\t;" if any(mark in line for line in lines)), None)
    if mark is None and any("," in line and not re.search(r"\s", line.strip()) for line in lines):
        mark = ","
    if mark is None and any(re.search(r",\s", line) for line in lines):
        mark = ","
    rows = [[_number(cell.strip(), mark) for cell in (line.split(mark) if mark else line.split())] for line in lines]
    return [row for row in rows if any(map(math.isfinite, row))]


def _number(cell: str, mark: str | None) -> float:
    return float(cell if mark == "," else cell.replace(",", ".")) if _NUMBER.match(cell) else math.nan


def _points(table: Array) -> TextHeights | None:
    """Return points x, y, z on the lattice that they lie on; None if they lie on none."""
    places = [_places(table[:, axis]) for axis in (0, 1)]
    if any(found is None for found in places):
        return None
    (i, dx), (j, dy) = (found for found in places if found is not None)
    heights = np.full((j.max() + 1, i.max() + 1), np.nan)
    heights[j, i] = table[:, 2]
    if len(table) < _FULL * heights.size:
        return None
    return TextHeights(heights, (dy, dx))


def _places(values: Array) -> tuple[Indices, float] | None:
    """Return the place of each value on an even scale from the least one, and its spacing; None if there is none."""
    if not np.isfinite(values).all():
        return None
    different = np.unique(values)
    steps = np.diff(different)
    apart = steps > _APART * steps.max(initial=0.0)  # smaller ones are scatter about one place
    if not apart.any():
        return None
    centres = [float(part.mean()) for part in np.split(different, np.flatnonzero(apart) + 1)]
    turns = max(round(float((centres[-1] - centres[0]) / np.median(np.diff(centres)))), 1)
    spacing = (centres[-1] - centres[0]) / turns
    exact = (values - centres[0]) / spacing
    places = np.rint(exact).astype(np.int64)
    return (places, spacing) if float(np.abs(exact - places).max()) <= _REGULAR else None
