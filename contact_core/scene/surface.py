"""Surface of a body: Gaussian roughness, and what all surfaces have in common. In metres, blind to the grid."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from ..arrays import Array
from ..laws.asperity_layer import AsperityLayer
from ..laws.equations import Equations
from ..quantities import parameter
from .heights import Heights

SEEDS = 2**31  # number of seeds of a surface: the integers of FMI


class RoughBody:
    """What all surfaces have: roughness `rq`, a `seed`, and perhaps `heights` and `microroughness`."""

    rq: float
    heights: Heights | None
    microroughness: AsperityLayer | None  # waves too short for any grid, beside those of `rq`

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

    @property
    def shortest(self) -> float:
        """Shortest wave [m] of roughness and of the file of heights, infinite of a smooth body."""
        own = self._shortest if self.rq > 0.0 else math.inf
        return own if self.heights is None else min(own, 2.0 * self.heights.spacing)

    @property
    def _shortest(self) -> float:
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
        if self.microroughness is not None and self.microroughness.error:
            yield f"microroughness: {self.microroughness.error}"

    def _errors(self, spacing: float, size: tuple[float, float]) -> Iterator[str]:
        raise NotImplementedError

    def warnings(self, spacing: float) -> Iterator[str]:
        """Yield what a grid of a spacing [m] does not resolve; each sentence continues the surface's name."""
        if self.rq > 0.0:
            yield from self._warnings(spacing)
        if self.heights is not None:
            yield from _unresolved(2.0 * self.heights.statistics.rms / self.heights.statistics.slope, spacing)
        below, shown = self.microroughness, max(self.shortest, 2.0 * spacing)
        if below is not None and below.rms > 0.0 and shown < 0.99 * below.longest:  # told in 3 digits
            yield (
                f"has microroughness.longest = {below.longest:g} m, but the grid shows waves down to {shown:.3g} m: "
                f"those between count twice. Set microroughness.longest to {shown:.3g} m at most, with the rms height "
                "of what is shorter, or use a coarser grid."
            )

    def _warnings(self, spacing: float) -> Iterator[str]:
        raise NotImplementedError


def _unresolved(length: float, spacing: float) -> Iterator[str]:
    nodes = length / spacing
    if nodes < 2.0 - 0.06:  # 8 um on 129 nodes over 0.5 mm is 2.05, over 0.53 mm 1.93
        yield f"has {nodes:.2f} nodes per correlation length; 2 or more resolve it."


@dataclass(frozen=True)
class Surface(RoughBody):
    """Gaussian heights of a Gaussian autocorrelation.

    The autocorrelation is rq^2 exp(-(x/correlation_length)^2 - (y/correlation_length_across)^2); rq = 0 is smooth.
    """

    name: ClassVar[str] = "gaussian"
    source: ClassVar[str] = "Hu & Tonder 1992, doi:10.1016/0890-6955(92)90064-N"
    equations: ClassVar[Equations] = Equations(
        ("⟨z(0, 0) z(x, y)⟩ = Rq^2 exp[−(x/l_x)^2 − (y/l_y)^2]",),
        "Gaussian heights z, the same on every grid but for waves that are shorter than two of its nodes.",
        symbols={
            "z": "height [m]",
            "Rq": "rq",
            "l_x": "correlation_length",
            "l_y": "correlation_length_across",
        },
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
    microroughness: AsperityLayer | None = None

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
        alike = self.correlation_length_across in (None, self.correlation_length)
        return self.smooth or (alike and self.heights is None)

    @property
    def length(self) -> float:
        """Correlation length [m]; with lay or heights that of `RoughBody.length`."""
        return self.correlation_length if self.fitted else super().length

    @property
    def _own_length(self) -> float:
        return self.correlation_length

    @property
    def _shortest(self) -> float:
        return 2.0 * math.pi / self.reach * min(self.correlation_length, self.correlation_length_across or math.inf)

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
