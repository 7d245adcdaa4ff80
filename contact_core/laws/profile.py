"""Profiles of rollers: their ends are relieved, so that the pressure does not peak there."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..quantities import parameter
from ..reference import logarithmic_drop, rounded_drop
from .base import Profile
from .equations import Equations

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Rounded:
    """Straight in the middle, a circle of a radius along the axis on either side."""

    name: ClassVar[str] = "rounded"
    source: ClassVar[str] = "a circle's arc along the axis"
    equations: ClassVar[Equations] = Equations(
        ("P = R_e − [R_e^2 − max(|y| − s/2, 0)^2]^{1/2},   |y| ≤ b/2",),
        "s is the straight length, Re the radius along the axis beyond it.",
        symbols={
            "P": "material taken away at y [m]",
            "R_e": "radius",
            "s": "straight",
            "b": "face width, geometry.face_width [m]",
        },
    )

    straight: float = parameter("m", "length of the straight part", least=0.0, most=10.0)
    radius: float = parameter("m", "radius along the axis beyond the straight part", above=0.0, most=1e4)

    def drop(self, y: Array, length: float) -> Array:
        """Return the material taken away [m] at y [m] from the middle of a face [m]; inf beyond its ends."""
        return rounded_drop(y, length, self.straight, self.radius)


@dataclass(frozen=True)
class Logarithmic:
    """Lundberg's profile: at its design load the pressure hardly rises toward the ends."""

    name: ClassVar[str] = "logarithmic"
    source: ClassVar[str] = "Lundberg, Forschung im Ingenieurwesen 10 (1939) 201, doi:10.1007/BF02584950"
    equations: ClassVar[Equations] = Equations(
        ("P = d ln{1/[1 − (2 y/b)^2]},   |y| < b/2",),
        "d is depth.",
        symbols={
            "P": "material taken away at y [m]",
            "d": "depth",
            "b": "face width, geometry.face_width [m]",
        },
    )

    depth: float = parameter("m", "factor on ln[1 / (1 - (2 y / length)^2)]", above=0.0, most=1e-3)

    def drop(self, y: Array, length: float) -> Array:
        """Return the material taken away [m] at y [m] from the middle of a face [m]; inf beyond its ends."""
        return logarithmic_drop(y, length, self.depth)


LAWS: tuple[type[Profile], ...] = (Rounded, Logarithmic)
