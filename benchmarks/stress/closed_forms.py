"""Stress below Hertz's contacts: circle, line at rest or sliding, axis of an ellipse.

Components xx, yy, zz, yz, xz, xy [6, ...], tension positive, z into the body, in the unit of the pressure.
"""

import numpy as np
import scipy  # its parts are loaded at their first use
from numpy.typing import ArrayLike

from contact_core.kernels.arrays import Array

_TINY = 1e-300


def circle_stress(
    x: ArrayLike, y: ArrayLike, z: ArrayLike, a: float, pressure_max: float, poisson_ratio: float
) -> Array:
    """Return the stress [6, ...] [Pa] at x, y, z [m] under the pressure p_max (1 - r^2 / a^2)^0.5 on a circle.

    Source: Huber, Ann. Phys. 319 (1904) 153, in the form of textbooks, from memory; the tests integrate point forces.
    """
    x, y, z = np.broadcast_arrays(*(np.asarray(value, dtype=np.float64) / a for value in (x, y, z)))
    r2 = x * x + y * y
    r = np.sqrt(r2)
    # r^2 / (1 + u) + z^2 / u = 1; q^2 = z^2 / u, of the two forms the one that keeps its digits
    excess = r2 + z * z - 1.0
    root = np.hypot(excess, 2.0 * z)
    u = np.where(excess > 0.0, 0.5 * (root + excess), 2.0 * z * z / np.maximum(root - excess, _TINY))
    inside = np.sqrt(np.maximum(1.0 - r2 / (1.0 + u), 0.0))
    q = np.where((inside > 0.5) | (u == 0.0), inside, z / np.sqrt(np.maximum(u, _TINY)))
    s = np.sqrt(u)
    soft = (1.0 - 2.0 * poisson_ratio) / 3.0 * (1.0 + q + q * q) / ((1.0 + q) * (1.0 + u))
    side = u * (1.0 - poisson_ratio) / (1.0 + u)
    turn = (1.0 + poisson_ratio) * s * np.arctan2(1.0, s)
    shape = np.maximum(u + q * q, _TINY)
    zz = -(q**3) / shape
    radial = soft - zz + q * (side + turn - 2.0)
    hoop = -soft - q * (2.0 * poisson_ratio + side - turn)
    shear = -r * q * q * s / (shape * (1.0 + u))
    cosine, sine = (np.where(r > 0.0, along / np.maximum(r, _TINY), here) for along, here in ((x, 1.0), (y, 0.0)))
    xx = radial * cosine**2 + hoop * sine**2
    yy = radial * sine**2 + hoop * cosine**2
    return pressure_max * np.stack([xx, yy, zz, shear * sine, shear * cosine, (radial - hoop) * cosine * sine])


def line_stress(
    x: ArrayLike, z: ArrayLike, a: float, pressure_max: float, poisson_ratio: float, friction: float = 0.0
) -> Array:
    """Return the stress [6, ...] [Pa] at x, z [m] in plane strain under the pressure p_max (1 - x^2 / a^2)^0.5.

    `friction` times the pressure pulls the surface along +x. Sources: McEwen, Philos. Mag. 40 (1949) 454; Smith & Liu,
    J. Appl. Mech. 20 (1953) 157; Johnson, Contact Mechanics, 1985, doi:10.1017/CBO9781139171731, equations 4.49 and
    7.8, from memory; the tests integrate line forces.
    """
    x, z = np.broadcast_arrays(*(np.asarray(value, dtype=np.float64) / a for value in (x, z)))
    inner = 1.0 - x * x + z * z
    root = np.hypot(inner, 2.0 * x * z)
    large = np.sqrt(0.5 * (root + np.abs(inner)))
    small = np.abs(x) * z / np.maximum(large, _TINY)
    m, n = np.where(inner > 0.0, large, small), np.sign(x) * np.where(inner > 0.0, small, large)
    root = np.maximum(root, _TINY)
    near, turn = (z * z + n * n) / root, (m * m - z * z) / root
    along, down, shear = 2.0 * z - m * (1.0 + near), -m * (1.0 - near), -n * turn
    xx = along + friction * (n * (2.0 + turn) - 2.0 * x)
    zz = down + friction * shear
    none = np.zeros_like(xx)
    return pressure_max * np.stack([xx, poisson_ratio * (xx + zz), zz, none, shear + friction * along, none])


def ellipse_axis_stress(z: ArrayLike, a: float, b: float, pressure_max: float, poisson_ratio: float) -> Array:
    """Return the normal stresses xx, yy, zz [3, ...] [Pa] at depths z [m] below the centre of an elliptical contact.

    sigma_zz / p_H = -B_a - B_b - z (A_a + A_b), sigma_xx / p_H = z A_a - (1 - 2 nu) B_a - 2 nu (B_a + B_b), sigma_yy
    with b, where for i = a, b, A_i = a b times the integral of ds / [(i^2 + s^2) D] and B_i = a b times that of (s - z)
    ds / [(i^2 + s^2) D], from z to infinity, D = sqrt[(a^2 + s^2) (b^2 + s^2)].

    Half widths a along x, b along y [m]; they are the principal stresses there. By Boussinesq's potentials of Hertz's
    pressure and Carlson's integral R_D; compare Thomas & Hoersch, University of Illinois Bulletin 212, 1930.
    """
    z = np.asarray(z, dtype=np.float64)
    z2, long, wide = z * z, np.sqrt(a * a + z * z), np.sqrt(b * b + z * z)
    # integrals over s from z on, D = sqrt((a^2 + s^2) (b^2 + s^2)): of a b / [(a^2 + s^2) D], and s - z times that
    part_x = a * b / 3.0 * scipy.special.elliprd(z2, wide**2, long**2)
    part_y = a * b / 3.0 * scipy.special.elliprd(z2, long**2, wide**2)
    lever_x = a * b / (long * (long + wide)) - z * part_x
    lever_y = a * b / (wide * (long + wide)) - z * part_y
    both, soft = lever_x + lever_y, 1.0 - 2.0 * poisson_ratio
    return pressure_max * np.stack(
        [
            z * part_x - soft * lever_x - 2.0 * poisson_ratio * both,
            z * part_y - soft * lever_y - 2.0 * poisson_ratio * both,
            -both - z * (part_x + part_y),
        ]
    )
