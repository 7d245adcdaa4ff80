"""The half space that repeats along y as a sum over images, for tests."""

import numpy as np
from independent import love


def _image_sum(j, i, rows, periods):
    """Cells at (j + m rows, i) for m = -periods .. periods, less as much of a line up to the distance 1."""
    y = j + rows * np.arange(-periods, periods + 1.0)
    r = np.hypot(y, i)
    near = r < 50.0
    out = np.where(near, 0.0, 1.0 / np.maximum(r, 1.0) + 1.0 / (24.0 * np.maximum(r, 1.0) ** 3))
    out[near] = love(np.full(near.sum(), float(i)), y[near])
    return out.sum() - 2.0 / rows * np.log((2 * periods + 1) * rows)


def _coefficient(j, i, rows):
    """That sum without end: what is left out falls with the square of the length that is summed."""
    few, many = (_image_sum(j, i, rows, n) for n in (500, 1000))
    return many + (many - few) / ((2001 / 1001) ** 2 - 1.0)


def image_matrix(rows, nx, reference):
    """Dense matrix between all pairs of nodes, row by row; a line load displaces by nothing at `reference` nodes."""
    table = np.array([[_coefficient(j, i, rows) for i in range(nx)] for j in range(rows)])
    table += 2.0 / rows * np.log(reference)
    y, x = (index.ravel() for index in np.indices((rows, nx)))
    return table[np.abs(y[:, None] - y[None, :]), np.abs(x[:, None] - x[None, :])]
