"""Temperature rise below a uniform source of heat that moves, beside Jaeger's integral."""

import numpy as np

from contact_core.kernels.arrays import Array
from contact_core.kernels.moving_source import MovingSurface
from contact_core.reference import jaeger_circle, tian_kennedy_circle

from .model import Outcome, Row, compared, exactly

CONDUCTIVITY, DIFFUSIVITY, RADIUS = 46.0, 1.25e-5, 1e-5  # W/(m K), m2/s, m
PECLETS = (0.1, 1.0, 10.0, 100.0)  # of the radius: u r / (2 kappa)
GRIDS = (20, 40)  # cells across the radius


def _circle(cells: int) -> Array:
    """Return the share of each cell inside the circle, of 32 x 32 points each."""
    n, fine = 2 * cells + 3, 32
    at = (np.arange(n * fine) + 0.5) / fine - 0.5 * n
    inside = (at[:, None] ** 2 + at[None, :] ** 2 < cells**2).reshape(n, fine, n, fine)
    return np.asarray(inside.mean(axis=(1, 3)))


def _rises(peclet: float, cells: int) -> tuple[float, float]:
    """Return largest and mean rise, in q r / K."""
    share, speed = _circle(cells), peclet * 2.0 * DIFFUSIVITY / RADIUS
    surface = MovingSurface(share.shape, RADIUS / cells, CONDUCTIVITY, DIFFUSIVITY, speed)
    rise = surface.rise(share) * CONDUCTIVITY / RADIUS
    return float(rise.max()), float((rise * share).sum() / share.sum())


def run() -> Outcome:
    """Compare largest and mean rise, in q r / K, on two grids of which the difference is the stated error."""
    rows, means = [], []
    for peclet in PECLETS:
        coarse, found = (_rises(peclet, cells) for cells in GRIDS)
        for name, value, less, exact in zip(("largest", "mean"), found, coarse, jaeger_circle(peclet), strict=True):
            quantity = f"{name} rise K / (q r), Peclet number {peclet:g}"
            rows.append(Row(quantity, "", exactly(exact), value, 0.0, "exact", abs(value - less)))
        means.append(found[1])
    at = np.geomspace(PECLETS[0], PECLETS[-1], 40)
    formula = np.array([tian_kennedy_circle(peclet)[1] for peclet in at])
    curve = compared(
        "mean rise; line of the reference: Tian and Kennedy", "Peclet number", "rise K / (q r)", (at, formula),
        (np.array(PECLETS), np.array(means)), logarithmic=True,
    )  # fmt: skip
    return Outcome(tuple(rows), (curve,))
