"""The largest shear stress below Hertz's contacts beside a textbook's figures."""

import numpy as np

from contact_core import subsurface_stress
from contact_core.kernels.arrays import Array

from .model import Outcome, Row, compared, exactly

CELLS = 24  # across the half width
DEPTHS = np.arange(0.2, 1.21, 0.02)  # over the half width
CIRCLE, LINE = (0.31, 0.48), (0.30, 0.78)  # shear over the largest pressure, depth over the half width
DIGIT = 0.01  # the last printed digit: figures are cut off there, .786 to .78 below a line


def _below(pressure: Array, poisson_ratio: float) -> tuple[float, float, Array]:
    """Return largest shear over largest pressure, its depth, and the shear over the depth, below the middle."""
    stress = subsurface_stress(pressure, None, None, 1.0 / CELLS, DEPTHS, poisson_ratio=poisson_ratio).largest_shear
    ny, nx = pressure.shape
    below = stress[:, ny // 2, nx // 2]
    curve = np.polynomial.Polynomial.fit(DEPTHS, below, 8)
    fine = np.linspace(DEPTHS[0], DEPTHS[-1], 2001)
    found = curve(fine)
    return float(found.max()), float(fine[found.argmax()]), below


def run() -> Outcome:
    """Compare a circle, and a strip that is long against its width."""
    x = np.arange(-CELLS - 4, CELLS + 5) / CELLS
    ball = np.sqrt(np.maximum(1.0 - x[None, :] ** 2 - x[:, None] ** 2, 0.0))
    y = np.arange(-8 * CELLS, 8 * CELLS + 1) / CELLS
    strip = np.tile(np.sqrt(np.maximum(1.0 - x**2, 0.0)), (y.size, 1))
    rows, curves = [], []
    # the shear below a line is that of any Poisson's ratio; that of 0.5 frees its middle from the ends of the strip
    for name, pressure, ratio, (shear, depth) in (("circle", ball, 0.3, CIRCLE), ("line", strip, 0.5, LINE)):
        found, at, below = _below(pressure, ratio)
        reason = "the last printed digit, at which figures are cut off"
        rows += [
            Row(f"largest shear below a {name} / p_H", "", exactly(shear), found, DIGIT, reason),
            Row(f"its depth below a {name} / a", "", exactly(depth), at, DIGIT, reason),
        ]
        curves.append(
            compared(
                f"below a {name}", "depth / a", "shear / p_H", (np.array([depth]), np.array([shear])), (DEPTHS, below)
            )
        )
    return Outcome(tuple(rows), tuple(curves))
