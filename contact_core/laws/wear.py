"""Removal of the solids."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ..kernels.arrays import Array
from ..quantities import parameter
from .base import Wear
from .elementary import Numbers, exp
from .equations import Equations

Speeds = tuple[float | Array, float]
_SYMBOLS = {
    "p_s": "mean solid pressure of a surface point over its track [Pa]",
    "v": "speed that sliding chooses [m/s]",
    "H": "hardness of the bare solids, plasticity.hardness [Pa]",
    "K_{bare}": "bare",
    "K_{film}": "film",
}


@dataclass(frozen=True)
class NoWear:
    """Nothing wears."""

    name: ClassVar[str] = "none"
    source: ClassVar[str] = ""
    equations: ClassVar[Equations] = Equations(
        ("w = 0",),
        left_out=(
            "Wear: rubbing takes nothing from the solids; their roughness stays but for plastic depth and tribofilm."
        ),
    )
    of_sliding: ClassVar[bool] = True
    wears: ClassVar[bool] = False
    wears_film: ClassVar[bool] = False

    def coefficient(self, cover: Array, full_thickness: float) -> Array:
        """Return zeros in the shape of `cover`."""
        return np.zeros_like(cover)

    def film_removal(
        self, pressure: Numbers, speeds: Speeds, body: int, film_hardness: float, full_thickness: float
    ) -> Numbers:
        """Return 0: no tribofilm wears."""
        return 0.0

    def slide(self, speeds: Speeds, body: int) -> float:
        """Return 0: no sliding wears."""
        return 0.0

    def rate(
        self, pressure: Array, cover: Array, speeds: Speeds, body: int, hardness: float, full_thickness: float
    ) -> Array:
        """Return zeros in the shape of `pressure`."""
        return np.zeros_like(pressure)


class _BySliding(ABC):
    """Wear by Archard's law, in proportion to a solid pressure and a speed."""

    wears: ClassVar[bool] = True

    sliding: str

    @property
    def of_sliding(self) -> bool:
        return self.sliding == "difference"

    def slide(self, speeds: Speeds, body: int) -> Any:
        return abs(speeds[body]) if self.sliding == "surface_speed" else abs(speeds[0] - speeds[1])

    @abstractmethod
    def coefficient(self, cover: Array, full_thickness: float) -> Array:
        """Return the dimensionless wear coefficient of the solid under a tribofilm of `cover` (0 to 1)."""

    def rate(
        self, pressure: Array, cover: Array, speeds: Speeds, body: int, hardness: float, full_thickness: float
    ) -> Array:
        """Return the wear depth per second [m/s] of body 1 (`body` = 0) or 2 (1) under a solid pressure [Pa].

        `cover` is 0 to 1 of `full_thickness` [m], `speeds` are (u1, u2) [m/s], `hardness` [Pa] is the solids'.
        """
        return self.coefficient(cover, full_thickness) * pressure * self.slide(speeds, body) / hardness


def _sliding() -> Any:
    text = "speed that wears a body"
    return parameter("", text, choices=("difference", "surface_speed"), default="difference")


def _bare() -> Any:
    return parameter("", "dimensionless wear coefficient of bare solids", least=0.0, most=1.0)


@dataclass(frozen=True)
class Archard(_BySliding):
    """dw/dt = K p v / H with K falling linearly from bare steel's to the full tribofilm's (Azam, eq. 7-3).

    `sliding` says which speed v wears a body: "difference", |u1 - u2|; "surface_speed", the body's own |u|, by which
    every pass slides the contact's length whatever the slide-to-roll ratio. The second is no law of sliding wear (it
    wears in pure rolling too) but the reading under which the ball wears in the order of its speed, as in Figures 7-5
    and 7-6 of Azam's thesis (University of Leeds 2018).
    """

    name: ClassVar[str] = "archard"
    source: ClassVar[str] = "Archard 1953, doi:10.1063/1.1721448"
    wears_film: ClassVar[bool] = False
    equations: ClassVar[Equations] = Equations(
        ("∂w/∂t = K p_s v/H,   K = K_{bare} + (K_{film} − K_{bare}) c",),
        "ps is the mean solid pressure on a point of the surface over its track, c the thickness of its "
        "tribofilm over the full thickness; wear.sliding chooses the speed v.",
        symbols={**_SYMBOLS, "c": "tribofilm of the body over its full thickness, 0 to 1 [1]"},
    )

    bare: float = _bare()
    film: float = parameter("", "dimensionless wear coefficient under a full tribofilm", least=0.0, most=1.0)
    sliding: str = _sliding()

    def coefficient(self, cover: Array, full_thickness: float) -> Array:
        return self.bare + (self.film - self.bare) * cover

    def film_removal(
        self, pressure: Numbers, speeds: Speeds, body: int, film_hardness: float, full_thickness: float
    ) -> Numbers:
        """Return 0: what wears under a tribofilm counts as solid."""
        return 0.0


@dataclass(frozen=True)
class FilmFirst(_BySliding):
    """Rubbing takes tribofilm first, and the solid where the film is thin.

    A film is continually worn and replenished, and sacrificial (Akchurin & Bosman 2017, doi:10.1007/s11249-017-0842-8);
    once it is there, wear of the solid essentially ceases (Sheasby et al. 1991). What the film loses is an Archard
    volume with its own coefficient and hardness, on the share of the load that it bears, its cover: so in proportion
    to its thickness, r h. Any growth in proportion to the room left has a closed form under it; a loss that is the same
    under a thin and a thick film has none beside the two exponentials of `ghanbarzadeh`, and would end at a time that
    has to be searched for. r adds to a removal that the tribofilm's law has by itself.

    The solid wears on the share exp(-h / h_s) that pads of the height h_s, laid at random, leave open (the share that
    Poisson's distribution leaves empty; form and h_s are assumed).
    """

    name: ClassVar[str] = "film_first"
    source: ClassVar[str] = (
        "Archard 1953, doi:10.1063/1.1721448; film worn and replenished: Akchurin & Bosman 2017, "
        "doi:10.1007/s11249-017-0842-8; exponential share: assumed"
    )
    wears_film: ClassVar[bool] = True
    equations: ClassVar[Equations] = Equations(
        (
            "∂w/∂t = K_{bare} p_s v/H exp(−h_t/h_s)",
            "∂h_t/∂t = … − r h_t,   r = K_{film} p_s v/(H_{film} h_{max})",
        ),
        "The tribofilm wears in proportion to its cover, the solid where the film is thin. ps is the mean solid "
        "pressure on a point of the surface over its track; wear.sliding chooses the speed v.",
        symbols={
            **_SYMBOLS,
            "h_s": "thin",
            "H_{film}": "hardness of the full tribofilm, plasticity.film_hardness [Pa]",
            "h_{max}": "full thickness of the tribofilm, tribofilm.full_thickness [m]",
        },
    )

    bare: float = _bare()
    film: float = parameter("", "dimensionless wear coefficient of the full tribofilm itself", least=0.0, most=1.0)
    thin: float = parameter(
        "m", "h_s, tribofilm under which the solid wears e times less than bare", above=0.0, most=1e-6, default=10e-9
    )
    sliding: str = _sliding()

    def coefficient(self, cover: Array, full_thickness: float) -> Array:
        return self.bare * exp(-cover * full_thickness / self.thin)

    def film_removal(
        self, pressure: Numbers, speeds: Speeds, body: int, film_hardness: float, full_thickness: float
    ) -> Numbers:
        """Return r [1/s] of body 1 (`body` = 0) or 2 (1) under a solid pressure [Pa].

        `speeds` are (u1, u2) [m/s], `film_hardness` [Pa] is that of a full tribofilm.
        """
        return self.film * pressure * self.slide(speeds, body) / (film_hardness * full_thickness)


LAWS: tuple[type[Wear], ...] = (NoWear, Archard, FilmFirst)
