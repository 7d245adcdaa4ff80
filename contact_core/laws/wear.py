"""Removal of the solids."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..quantities import parameter
from .base import Wear
from .equations import Equations

Array = NDArray[np.float64]
Speeds = tuple[float | Array, float]


@dataclass(frozen=True)
class NoWear:
    """Nothing wears."""

    name: ClassVar[str] = "none"
    source: ClassVar[str] = ""
    equations: ClassVar[Equations] = Equations(
        ("w = 0",),
    )
    of_sliding: ClassVar[bool] = True
    wears: ClassVar[bool] = False

    def coefficient(self, cover: Array) -> Array:
        """Return zeros in the shape of `cover`."""
        return np.zeros_like(cover)

    def slide(self, speeds: Speeds, body: int) -> float:
        """Return 0: no sliding wears."""
        return 0.0

    def rate(self, pressure: Array, cover: Array, speeds: Speeds, body: int, hardness: float) -> Array:
        """Return zeros in the shape of `pressure`."""
        return np.zeros_like(pressure)


@dataclass(frozen=True)
class Archard:
    """dw/dt = K p v / H with K falling linearly from bare steel's to the full tribofilm's (Azam, eq. 7-3).

    `sliding` says which speed v wears a body: "difference", |u1 - u2|; "surface_speed", the body's own |u|, by which
    every pass slides the contact's length whatever the slide-to-roll ratio. The second is no law of sliding wear (it
    wears in pure rolling too) but the reading under which the ball wears in the order of its speed, as in Figures 7-5
    and 7-6 of Azam's thesis (University of Leeds 2018).
    """

    name: ClassVar[str] = "archard"
    source: ClassVar[str] = "Archard 1953, doi:10.1063/1.1721448"
    wears: ClassVar[bool] = True
    equations: ClassVar[Equations] = Equations(
        ("∂w/∂t = K p_s v/H,   K = K_{bare} + (K_{film} − K_{bare}) c",),
        "ps is the mean solid pressure on a point of the surface over its track, c the thickness of its "
        "tribofilm over the full thickness; wear.sliding chooses the speed v.",
    )

    bare: float = parameter("", "dimensionless wear coefficient of bare solids", least=0.0, most=1.0)
    film: float = parameter("", "dimensionless wear coefficient under a full tribofilm", least=0.0, most=1.0)
    sliding: str = parameter(
        "", "speed that wears a body", choices=("difference", "surface_speed"), default="difference"
    )

    @property
    def of_sliding(self) -> bool:
        """True if the bodies' relative sliding wears them, and spin with it; else each one's own speed does."""
        return self.sliding == "difference"

    def coefficient(self, cover: Array) -> Array:
        """Return the dimensionless wear coefficient K under a tribofilm of `cover` (0 to 1) of its full thickness."""
        return self.bare + (self.film - self.bare) * cover

    def slide(self, speeds: Speeds, body: int) -> Any:
        """Return the speed [m/s] that wears body 1 (`body` = 0) or 2 (1) at the surface speeds (u1, u2) [m/s]."""
        return abs(speeds[body]) if self.sliding == "surface_speed" else abs(speeds[0] - speeds[1])

    def rate(self, pressure: Array, cover: Array, speeds: Speeds, body: int, hardness: float) -> Array:
        """Return the wear depth per second [m/s] of body 1 (`body` = 0) or 2 (1) under a solid pressure [Pa].

        `cover` is 0 to 1, `speeds` are (u1, u2) [m/s], `hardness` [Pa] is the solids'.
        """
        return self.coefficient(cover) * pressure * self.slide(speeds, body) / hardness


LAWS: tuple[type[Wear], ...] = (NoWear, Archard)
