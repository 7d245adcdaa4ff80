"""Surfaces of a body: the spectrum of its roughness, in metres and blind to the grid, and heights that are given."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..laws.equations import Equations
from ..quantities import parameter
from .heights import Heights

Array = NDArray[np.float64]

SEEDS = 2**31  # of a surface: what FMI's integers can tell apart

_MOST_WAVES = 2048  # of the cut-off in a domain: some 7 million modes, two seconds


class _Body:
    """What all surfaces have: roughness `rq`, a `seed`, and perhaps `heights`."""

    rq: float
    heights: Heights | None

    @property
    def smooth(self) -> bool:
        """True without roughness and heights."""
        return self.rq == 0.0 and self.heights is None

    @property
    def fitted(self) -> bool:
        """True for what curves are fitted to: Gaussian roughness of one correlation length, or nothing."""
        return self.smooth

    @property
    def rms(self) -> float:
        """Rms height [m] of roughness and of the file of heights together."""
        return self.rq if self.heights is None else math.hypot(self.rq, self.heights.statistics.rms)

    @property
    def slope(self) -> float:
        """Rms gradient of all waves, of roughness and of the file of heights together."""
        return self._slope if self.heights is None else math.hypot(self._slope, self.heights.statistics.slope)

    @property
    def _slope(self) -> float:
        raise NotImplementedError

    @property
    def length(self) -> float:
        """Correlation length [m] of Gaussian heights, the same along and across, with this rms height and slope."""
        return self._own_length if self.smooth else 2.0 * self.rms / self.slope

    @property
    def _own_length(self) -> float:
        raise NotImplementedError

    def with_file(self, name: str, folders: tuple[Path, ...]) -> Any:
        """Return the surface with the file of its heights read; `name` is the surface's in the scene.

        Raises SceneError if the file cannot be used.
        """
        if self.heights is None:
            return self
        heights = self.heights.loaded(f"{name}.heights", folders)
        return replace(self, heights=heights)  # type: ignore[type-var]

    def errors(self, spacing: float, size: tuple[float, float]) -> Iterator[str]:
        """Yield what makes the surface unusable on a grid [m] with a patch of a size along y and x [m].

        Each sentence begins with the name of a field.
        """
        if self.rq > 0.0:
            yield from self._errors(spacing, size)
        if self.heights is not None:
            yield from (f"heights.{sentence}" for sentence in self.heights.errors(size))

    def _errors(self, spacing: float, size: tuple[float, float]) -> Iterator[str]:
        raise NotImplementedError

    def warnings(self, spacing: float) -> Iterator[str]:
        """Yield what a grid of a spacing [m] does not resolve; each sentence continues the surface's name."""
        if self.rq > 0.0:
            yield from self._warnings(spacing)
        if self.heights is not None:
            yield from _unresolved(2.0 * self.heights.statistics.rms / self.heights.statistics.slope, spacing)

    def _warnings(self, spacing: float) -> Iterator[str]:
        raise NotImplementedError


def _unresolved(length: float, spacing: float) -> Iterator[str]:
    nodes = length / spacing
    if nodes < 2.0 - 0.06:  # 8 um on 129 nodes over 0.5 mm is 2.05, over 0.53 mm 1.93
        yield f"has {nodes:.2f} nodes per correlation length; 2 or more resolve it."


@dataclass(frozen=True)
class Surface(_Body):
    """Gaussian heights of a Gaussian autocorrelation.

    The autocorrelation is rq^2 exp(-(x/correlation_length)^2 - (y/correlation_length_across)^2); rq = 0 is smooth.
    """

    name: ClassVar[str] = "gaussian"
    source: ClassVar[str] = "Hu & Tonder 1992, doi:10.1016/0890-6955(92)90064-N"
    equations: ClassVar[Equations] = Equations(
        ("⟨z(0, 0) z(x, y)⟩ = Rq^2 exp[−(x/l_x)^2 − (y/l_y)^2]",),
        "Gaussian heights z, the same on every grid but for waves that are shorter than two of its nodes.",
    )
    # modes are kept up to k l = 9: what lies beyond holds exp(-81/4) = 1.6e-9 of the Gaussian spectrum's power
    reach: ClassVar[float] = 9.0

    rq: float = parameter("m", "rms roughness", least=0.0, most=1e-4)
    correlation_length: float = parameter("m", "correlation length", above=0.0, most=1.0, shapes_arrays=True)
    seed: int = parameter("", "number of the realisation", least=0, most=SEEDS - 1)
    correlation_length_across: float | None = parameter(
        "m",
        "correlation length along y; without it that along x",
        above=0.0,
        most=1.0,
        shapes_arrays=True,
        default=None,
    )
    heights: Heights | None = None

    def steps(self, domain: float, aspect: float) -> tuple[float, float]:
        """Return k l of mode number 1 along x and along y, for a patch domain [m] long and domain / aspect wide."""
        step = 2.0 * np.pi * self.correlation_length / domain
        across = self.correlation_length_across
        return step, step * aspect if across is None else step * aspect * (across / self.correlation_length)

    def amplitude(self, kl_2: Array) -> Array:
        """Return the amplitude of modes by (k l)^2, up to a factor: the root of the spectrum exp(-(k l)^2 / 4)."""
        return np.exp(-kl_2 / 8.0)

    @property
    def finest(self) -> str:
        """The field that decides on the shortest waves, and its value."""
        return f"correlation_length = {self.correlation_length:g} m"

    @property
    def _slope(self) -> float:
        """Rms gradient sqrt(2) rq sqrt(1/l_x^2 + 1/l_y^2)."""
        across = self.correlation_length_across or self.correlation_length
        return math.sqrt(2.0) * self.rq * math.hypot(1.0 / self.correlation_length, 1.0 / across)

    @property
    def fitted(self) -> bool:
        """True without lay and heights."""
        return self.correlation_length_across in (None, self.correlation_length) and self.heights is None

    @property
    def length(self) -> float:
        """Correlation length [m]; with lay or heights that of `_Body.length`."""
        return self.correlation_length if self.fitted else super().length

    @property
    def _own_length(self) -> float:
        return self.correlation_length

    def coarsened(self, spacing: float) -> "Surface":
        """Return the surface without correlation lengths below the spacing [m] of a grid."""
        across = self.correlation_length_across
        return replace(
            self,
            correlation_length=max(self.correlation_length, spacing),
            correlation_length_across=across if across is None else max(across, spacing),
        )

    def _errors(self, spacing: float, size: tuple[float, float]) -> Iterator[str]:
        depth, domain = size
        for key, film, whole, length in (
            ("correlation_length", "film.domain", domain, self.correlation_length),
            ("correlation_length_across", "a patch along y of", depth, self.correlation_length_across),
        ):
            if length is None:
                continue
            if length > whole / 5.0:
                yield (
                    f"{key} = {length:g} m is too long for {film} = {whole:g} m. "
                    f"Use at most {whole / 5.0:g} m, a larger domain, or rq = 0 for a smooth surface."
                )
            nodes = length / spacing
            if nodes < 1.0 - 1e-9:
                yield (
                    f"{key} = {length:g} m is {nodes:.2f} nodes of the grid; "
                    f"at least 1 is needed. Use film.points = {1 + math.ceil(domain / length)} or more, "
                    "or a longer correlation length."
                )

    def _warnings(self, spacing: float) -> Iterator[str]:
        return _unresolved(min(self.correlation_length, self.correlation_length_across or math.inf), spacing)


@dataclass(frozen=True, kw_only=True)
class SelfAffine(_Body):
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


SURFACES: tuple[type[Surface] | type[SelfAffine], ...] = (Surface, SelfAffine)
