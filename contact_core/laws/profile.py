"""Profiles of rollers: their ends are relieved, so that the pressure does not peak there."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..kernels.arrays import Array
from ..quantities import parameter
from ..reference import logarithmic_drop, rounded_drop
from .base import Profile
from .equations import Equations


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
        return logarithmic_drop(y, length, self.depth)


@dataclass(frozen=True)
class Measured:
    """The crown of bearing rollers as measured: straight over a third, its ends as deep as `ends` says.

    Rollers of the bearings NU206 and 81212 have it within 0.03 of that depth: docs/measured/surfaces.md.
    """

    name: ClassVar[str] = "measured"
    source: ClassVar[str] = (
        "fitted to traces of two rollers, 11.3 and 13.2 um deep at their ends: M. Ploss, github moritzploss/tribology "
        "09bf75d6, MIT licence; form: Fujiwara & Kawase, NTN Tech. Rev. 75 (2007) 140"
    )
    equations: ClassVar[Equations] = Equations(
        ("P = −d_e ln(1 − s^2/2)/ln 2,   s = max(2 |y|/b − 0.32, 0)/0.68,   |y| ≤ b/2",),
        "de is ends.",
        symbols={
            "P": "material taken away at y [m]",
            "d_e": "ends",
            "b": "face width, geometry.face_width [m]",
        },
    )

    ends: float = parameter("m", "depth of both ends, before their chamfers", above=0.0, most=1e-3, default=11.3e-6)

    def drop(self, y: Array, length: float) -> Array:
        return logarithmic_drop(y, length, self.ends / np.log(2.0), crowned=0.68, end_drop=self.ends)


LAWS: tuple[type[Profile], ...] = (Rounded, Logarithmic, Measured)
