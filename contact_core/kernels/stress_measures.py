"""Measures of stress tensors [6, ...]: components xx, yy, zz, yz, xz, xy, tension positive. Results in their unit."""

import numpy as np

from .arrays import Array


def hydrostatic(stress: Array) -> Array:
    """Return the mean of the three normal stresses, positive in tension."""
    return np.asarray((stress[0] + stress[1] + stress[2]) / 3.0)


def second_invariant(stress: Array) -> Array:
    """Return J2 of the deviator, [unit]^2."""
    xx, yy, zz, yz, xz, xy = stress
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.asarray(normal / 6.0 + yz * yz + xz * xz + xy * xy)


def von_mises(stress: Array) -> Array:
    """Return von Mises' equivalent stress, sqrt(3 J2): that of the same distortion in pure tension."""
    return np.sqrt(3.0 * second_invariant(stress))


def principal(stress: Array) -> Array:
    """Return the principal stresses [3, ...], the largest first.

    sigma_h + 2 sqrt(J2 / 3) cos(theta + 2 pi k / 3), cos(3 theta) = det s / [2 (J2 / 3)^1.5], with the mean sigma_h and
    the deviator s.

    By the trigonometric roots of the characteristic cubic of the deviator; where two of them all but agree, to 1e-8 of
    the third one.
    """
    mean = hydrostatic(stress)
    xx, yy, zz = stress[:3] - mean
    yz, xz, xy = stress[3:]
    size = np.sqrt(second_invariant(stress) / 3.0)
    half_third = 0.5 * (xx * (yy * zz - yz * yz) + xy * (yz * xz - xy * zz) + xz * (xy * yz - yy * xz))
    cosine = half_third / np.maximum(size, np.finfo(np.float64).tiny ** (1 / 3)) ** 3
    angle = np.arccos(np.clip(cosine, -1.0, 1.0)) / 3.0
    first, last = 2.0 * np.cos(angle), 2.0 * np.cos(angle + 2.0 * np.pi / 3.0)
    return np.stack([mean + size * first, mean - size * (first + last), mean + size * last])


def largest_shear(stress: Array) -> Array:
    """Return the largest shear stress on any plane, half the difference of the outer principal stresses."""
    largest, _, least = principal(stress)
    return 0.5 * (largest - least)
