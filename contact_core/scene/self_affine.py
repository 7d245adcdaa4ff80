"""Surface of a body: self-affine roughness."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from ..kernels.arrays import Array
from ..laws.asperity_layer import AsperityLayer
from ..laws.equations import Equations
from ..quantities import parameter
from .heights import Heights
from .surface import SEEDS, RoughBody

_MOST_WAVES = 2048  # of the cut-off in a domain: some 7 million modes, two seconds


@dataclass(frozen=True, kw_only=True)
class SelfAffine(RoughBody):
    """Gaussian heights of a self-affine spectrum, the same in all directions.

    The power per area of wave numbers q is constant up to that of `roll_off`, falls as q^(-2 - 2 hurst) to that of
    `cut_off`, and is 0 beyond; rq counts the waves of the whole band.
    """

    name: ClassVar[str] = "self_affine"
    source: ClassVar[str] = "Jacobs, Junge & Pastewka 2017, doi:10.1088/2051-672X/aa51f8"
    equations: ClassVar[Equations] = Equations(
        ("C(q) ∝ max(q, 2π/λ_r)^{−2−2H}   for   q ≤ 2π/λ_c,   else 0",),
        "Gaussian heights of a power C per area of wave numbers q, λ_r being the roll-off and λ_c the cut-off; the "
        "same on every grid but for waves that are shorter than two of its nodes.",
        symbols={
            "C": "power per area of wave numbers [m4]",
            "q": "wave number [1/m]",
            "λ_r": "roll_off",
            "λ_c": "cut_off",
            "H": "hurst",
        },
    )
    reach: ClassVar[float] = 1.0  # in units of the cut-off's wave number

    rq: float = parameter("m", "rms roughness", least=0.0, most=1e-4)
    hurst: float = parameter("", "Hurst exponent", above=0.0, most=1.0)
    roll_off: float = parameter(
        "m", "wavelength above which the spectrum is constant", above=0.0, most=1.0, shapes_arrays=True
    )
    cut_off: float = parameter("m", "shortest wavelength of the roughness", above=0.0, most=1.0, shapes_arrays=True)
    seed: int = parameter("", "number of the realisation", least=0, most=SEEDS - 1)
    heights: Heights | None = None
    microroughness: AsperityLayer | None = None

    def steps(self, domain: float, aspect: float) -> tuple[float, float]:
        """Return q over that of the cut-off, of mode number 1 along x and y; see `Surface.steps`."""
        step = self.cut_off / domain
        return step, step * aspect

    def amplitude(self, q_2: Array) -> Array:
        """Return the amplitude of modes by (q over that of the cut-off)^2, up to a factor: the root of the spectrum."""
        return np.maximum(q_2 * (self.roll_off / self.cut_off) ** 2, 1.0) ** (-0.5 * (1.0 + self.hurst))

    @property
    def finest(self) -> str:
        """The field that decides on the shortest waves, and its value."""
        return f"cut_off = {self.cut_off:g} m"

    @property
    def _slope(self) -> float:
        return self.rq * self._moment(2, self.cut_off)

    @property
    def _own_length(self) -> float:
        return self.roll_off

    @property
    def _shortest(self) -> float:
        return self.cut_off

    def _moment(self, order: int, shortest: float) -> float:
        """Return the rms of the derivative of an order (0 or 2: gradient), over rq, of waves down to a length [m].

        The integrals of q^order times the spectrum over the wave numbers, from 0.
        """
        return math.sqrt(self._integral(order, shortest) / self._integral(0, self.cut_off))

    def _integral(self, order: int, shortest: float) -> float:
        roll_off = 2.0 * math.pi / self.roll_off
        ratio, power = self.roll_off / shortest, order - 2.0 * self.hurst
        if ratio < 1.0:
            return roll_off**order * ratio ** (order + 2) / (order + 2)
        tail = math.log(ratio) if power == 0.0 else math.expm1(power * math.log(ratio)) / power
        return roll_off**order * (1.0 / (order + 2) + tail)

    def coarsened(self, spacing: float) -> "SelfAffine":
        """Return the surface without waves below two nodes of a grid of a spacing [m]."""
        shortest = 2.0 * spacing
        return replace(self, cut_off=max(self.cut_off, shortest), roll_off=max(self.roll_off, shortest))

    def _errors(self, spacing: float, size: tuple[float, float]) -> Iterator[str]:
        domain = size[1]
        if not self.cut_off < self.roll_off:
            yield f"cut_off = {self.cut_off:g} m must be below roll_off = {self.roll_off:g} m. Make one of them fit."
        if self.roll_off > domain / 2.0:
            yield (
                f"roll_off = {self.roll_off:g} m is too long for film.domain = {domain:g} m. Use at most "
                f"{domain / 2.0:g} m, a larger domain, or rq = 0 for a smooth surface."
            )
        if self.roll_off < 4.0 * spacing * (1.0 - 1e-9):
            yield (
                f"roll_off = {self.roll_off:g} m is {self.roll_off / spacing:.2f} nodes of the grid; at least 4 are "
                f"needed. Use film.points = {1 + math.ceil(4.0 * domain / self.roll_off)} or more, or a longer one."
            )
        if self.cut_off < domain / _MOST_WAVES * (1.0 - 1e-9):
            yield (
                f"cut_off = {self.cut_off:g} m is too short for film.domain = {domain:g} m. Use at least "
                f"{domain / _MOST_WAVES:.3g} m."
            )

    def _warnings(self, spacing: float) -> Iterator[str]:
        shortest = 2.0 * spacing
        if self.cut_off < shortest * (1.0 - 1e-9):
            rms, slope = (self._moment(order, shortest) / self._moment(order, self.cut_off) for order in (0, 2))
            yield (
                f"has waves down to {self.cut_off:g} m; the grid shows those above {shortest:g} m, "
                f"{100.0 * rms:.3g} % of the rms roughness and {100.0 * slope:.3g} % of the rms slope."
            )
