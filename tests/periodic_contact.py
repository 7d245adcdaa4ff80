"""Dry contact of random roughness on an elastic half space, periodic along both axes, pressures at most a hardness.

Everything is in units of the roughness: lengths in 1/q, q = 2 pi / longest wavelength; heights in their rms sigma;
pressures in q sigma E*, E* = E'/2. A surface then has no other number than the shape of its spectrum, and a solid
none but its hardness. The solver is that of `contact_core/kernels/dry_faces.py` on all of a plane, with the exact
operator of the periodic half space, 2 / (E* |q|) for a wave (Johnson, Contact Mechanics, 1985,
doi:10.1017/CBO9781139171731, section 13.2).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy
from scipy.optimize import brentq

from contact_core.errors import ConvergenceError
from contact_core.kernels.arrays import Array
from contact_core.kernels.dry_faces import Contact
from contact_core.kernels.half_space import Convolution

TOLERANCE = 1e-4  # of a pressure, sum |p - exact p| / load
ITERATIONS = 3000


@dataclass(frozen=True)
class Band:
    """Isotropic Gaussian roughness between two wavelengths, the longer of them `breadth` times the shorter one.

    Power per wave goes like |q|^(-2 (1 + hurst)); hurst = -1 is white.
    """

    breadth: int
    hurst: float = -1.0
    longest: int = 8  # longest waves along a side of the plane

    def moment(self, n: int) -> float:
        """Return the mean of |q|^n over the power of the continuous spectrum."""

        def integral(power: float) -> float:
            return (
                float(np.log(self.breadth)) if power == -1.0 else (self.breadth ** (power + 1.0) - 1.0) / (power + 1.0)
            )

        power = 1.0 - 2.0 * (1.0 + self.hurst)
        return integral(power + n) / integral(power)

    @property
    def slope(self) -> float:
        """Rms slope over q sigma."""
        return float(np.sqrt(self.moment(2)))

    def heights(self, nodes: int, seed: int) -> Array:
        """Return heights [nodes, nodes] of rms 1: waves of random phase, the same on all grids that carry them."""
        most = self.breadth * self.longest
        ky, kx = np.arange(-most, most + 1)[:, None], np.arange(most + 1)[None, :]
        size = np.hypot(kx, ky) / self.longest
        own = (size >= 1.0) & (size <= self.breadth) & ((kx > 0) | (ky > 0))  # of kx = 0 one half mirrors the other
        turn = np.exp(2j * np.pi * np.random.Generator(np.random.Philox(seed)).random(size.shape))
        waves = np.where(own, np.maximum(size, 1.0) ** -(1.0 + self.hurst), 0.0) * turn
        waves /= np.sqrt(2.0 * np.sum(np.abs(waves) ** 2))
        spectrum = np.zeros((nodes, nodes // 2 + 1), dtype=complex)
        spectrum[ky[:, 0], : most + 1] = waves
        spectrum[-ky[most + 1 :, 0], 0] = waves[most + 1 :, 0].conj()
        return np.asarray(scipy.fft.irfft2(spectrum, s=(nodes, nodes), norm="forward"))


class PeriodicPlane:
    """Half space [nodes, nodes] that is periodic along both axes, as `Contact` takes it; E* = 1.

    `longest` waves of length 2 pi lie along a side. A mean pressure does not displace.
    """

    def __init__(self, nodes: int, longest: int) -> None:
        self.size = np.hypot(np.fft.fftfreq(nodes, 1.0 / nodes)[:, None], np.arange(nodes // 2 + 1)[None, :]) / longest
        compliance = np.divide(2.0, self.size, out=np.zeros_like(self.size), where=self.size > 0.0)
        twice = np.full(nodes // 2 + 1, 2.0)
        twice[[0, -1]] = 1.0  # these columns mirror themselves
        self.near = np.array([[float((compliance * twice).sum()) / nodes**2]])  # by a pressure on the node itself
        stiffness = 0.5 * self.size
        stiffness[0, 0] = stiffness[0, 1]  # the mean belongs to the load
        self._deform, self.inverse = Convolution(nodes, compliance, "scipy"), Convolution(nodes, stiffness, "scipy")

    def deform(self, pressure: Array) -> Array:
        """Return the displacement under a pressure."""
        self._deform.field[:] = pressure
        return self._deform.run().copy()


class Point(NamedTuple):
    """A contact under one mean pressure, over all of the plane."""

    pressure: float
    planes: float  # mean gap, nodes at the hardness counted as negative: distance of the mean planes before yielding
    gap: float  # mean gap, these counted as 0: the room that is left
    area: float  # touching share
    plastic: float  # share at the hardness


def area(touching: np.ndarray) -> float:
    """Return the share of the plane that touches, free of the nodes' width to first order.

    The number of edges between touching and open nodes times (pi - 1 + ln 2) / 24 is taken off (Yastrebov, Anciaux &
    Molinari, arXiv:1701.02727).
    """
    edges = sum(int((touching != np.roll(touching, 1, axis)).sum()) for axis in (0, 1))
    return float(touching.mean()) - (np.pi - 1.0 + np.log(2.0)) / 24.0 * edges / touching.size


def press(
    plane: PeriodicPlane, heights: Array, pressures: Sequence[float], hardness: float = np.inf
) -> Iterator[Point]:
    """Yield the contact of heights and a flat under each mean pressure."""
    cap = np.full(heights.shape, hardness)
    plane.inverse.field[:] = heights
    stiffness = float(plane.inverse.run().std() / heights.std())  # of full contact, pressure per height
    for mean in pressures:
        contact = Contact(plane, plane.inverse, -heights, cap, mean * heights.size)  # type: ignore[arg-type]
        for factor in (1.0, 0.5, 2.0):  # a start that stalls is rare, and then another does not
            part = contact.solve(bedded(heights, mean, factor * stiffness, hardness), TOLERANCE, ITERATIONS)
            if part.error < TOLERANCE:
                break
        else:
            raise ConvergenceError(f"No contact found at p = {mean:g}, hardness {hardness:g}: error {part.error:.1e}.")
        p, gap = part.pressure, part.gap
        # nodes at the hardness touch wholly: the touching share is never below pressure over hardness
        share = max(area(p > 0.0), mean / hardness)
        yield Point(mean, float(gap.mean()), float(np.maximum(gap, 0.0).mean()), share, float((p >= hardness).mean()))


def bedded(heights: Array, mean: float, stiffness: float, hardness: float) -> Array:
    """Return the pressures of a bed of springs under a mean pressure: a start."""

    def pressures(depth: float) -> Array:
        return np.clip(stiffness * (heights - heights.max() + depth), 0.0, hardness)

    deepest = float(np.ptp(heights)) + 2.0 * min(mean, hardness) / stiffness
    return pressures(brentq(lambda depth: pressures(depth).mean() - mean, 0.0, deepest, xtol=1e-6))
