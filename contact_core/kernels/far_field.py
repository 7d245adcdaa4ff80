"""Pressure and load beyond the edge of the grid: the decay of the inlet pressure.

Far in the inlet the film is rigid, h = h0 + (x^2 + k y^2) / 2, and the pressure goes like g = -x / h^2 for x < 0 and is
zero behind: p ~ -x / h^2 is Kapitza's exact solution of the rigid, isoviscous half-flooded ellipsoid. Where bodies come
closer at a speed V beside an entrainment speed u, g = (-u x + c V R) / h^2, c = (3 + 2 k) / (2 + 2 k), or zero, by the
same equation.
Source: Kapitza, Zh. Tekh. Fiz. 25 (1955) 747; Brewe, Hamrock & Taylor, J. Lubr. Technol. 101 (1979) 231,
doi:10.1115/1.3453329. Lengths in the unit of the problem, gaps in its square over the radius.
"""

import numpy as np

from .arrays import Array

_THINNEST = 1e-9  # ratio of films below which the film at the edge counts as infinite


def far_field(
    x: Array, y: Array, film: float, curvature: float = 1.0, wedge: float = 1.0, closing: float = 0.0
) -> tuple[Array, Array]:
    """Return the ratio of each edge pressure to that of its inner neighbour, and each node's weight in the load.

    x [nx], y [ny] equally spaced; film: h0, central film of smooth bodies, below zero where their shapes overlap (but
    not at the edge); curvature: k, that along y over that along x; wedge, closing: u and c V R in the same unit.

    Both results are [ny, nx]; the ratio is zero off the edge and where the flow leaves, the weight is 1 off the edge
    and there holds what lies beyond.
    """
    spacing = x[1] - x[0]
    film = film if abs(film) > _THINNEST else _THINNEST
    xx, yy = np.meshgrid(x, y)
    r2 = xx**2 + yy**2
    rise = xx**2 + curvature * yy**2  # of the gap, twice
    gap = np.maximum(film + 0.5 * rise, _THINNEST * _THINNEST)  # the gap inside is not used, where shapes may overlap
    decay = np.maximum(closing - wedge * xx, 0.0) / gap**2
    ratio, weight = np.zeros_like(decay), np.ones_like(decay)
    inner = (
        (np.s_[:, 0], np.s_[:, 1]),
        (np.s_[:, -1], np.s_[:, -2]),
        (np.s_[0, :], np.s_[1, :]),
        (np.s_[-1, :], np.s_[-2, :]),
    )
    for edge, neighbour in inner:
        ratio[edge] = np.where(decay[neighbour] > 0.0, decay[edge] / np.maximum(decay[neighbour], 1e-300), 0.0)
    # load of the sectors from behind the cells of the edge nodes to infinity, over the pressure at these nodes
    cosine = -wedge * xx / np.sqrt(np.maximum(r2, 1e-300))
    along, across = np.abs(xx), np.abs(yy)
    for edge, distance in ((np.s_[:, 0], along), (np.s_[:, -1], along), (np.s_[0, :], across), (np.s_[-1, :], across)):
        d, r = distance[edge], np.sqrt(r2[edge])
        bent = rise[edge] / r2[edge]  # curvature of the gap along the ray
        s = np.sqrt(bent) * r * (1.0 + 0.5 * spacing / d) / np.sqrt(2.0 * abs(film))
        fall = s * s + np.sign(film)
        tail = 0.5 * np.pi - np.arctan(s) if film > 0.0 else np.arctanh(1.0 / s)
        radial = np.sqrt(2.0 / abs(film)) * (tail + s / fall) / bent**1.5
        beyond = spacing * d / r**2 * cosine[edge] * radial / spacing**2  # over the angle of the cell
        beyond += spacing * d / r**2 * closing / (abs(film) * fall) / bent / spacing**2
        weight[edge] += np.where(ratio[edge] > 0.0, np.maximum(beyond, 0.0) / np.maximum(decay[edge], 1e-300), 0.0)
    return ratio, weight
