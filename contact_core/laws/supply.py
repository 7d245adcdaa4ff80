"""Oil supply before the contact."""

import math
from dataclasses import dataclass
from typing import ClassVar

from ..quantities import parameter
from ..reference.starvation import film_behind_meniscus, supplied_film
from .base import Supply
from .equations import Equations


@dataclass(frozen=True)
class Flooded:
    """All the oil that the contact can take, from the edge of the grid on."""

    name: ClassVar[str] = "flooded"
    source: ClassVar[str] = "assumed: the inlet is full as far as it makes pressure"
    equations: ClassVar[Equations] = Equations(
        ("p_f = 0 at the edge of the grid",),
        "The inlet is as full as the grid is wide.",
        left_out="Starvation: where less oil comes in than the contact can take, the film is thinner than computed.",
    )

    starves: ClassVar[bool] = False
    layer: ClassVar[None] = None
    inlet: ClassVar[None] = None

    def film(self, flooded: float, half_width: float, radius: float, resistance: float) -> float:
        return flooded

    def reach(self, half_width: float, radius: float) -> float:
        """Return how far before the centre the inlet is full: without an end."""
        return math.inf


@dataclass(frozen=True)
class SupplyFilm:
    """A layer of oil on the surfaces: the flow of oil is its thickness times the entrainment speed."""

    name: ClassVar[str] = "film"
    source: ClassVar[str] = "Chevalier et al. 1998, doi:10.1115/1.2834175"
    equations: ClassVar[Equations] = Equations(
        ("ρ h θ = ρ_0 h_{oil} where oil comes in",),
        "h oil is the thickness. Pressure begins where the gap is full.",
        symbols={
            "h_{oil}": "thickness",
        },
    )
    starves: ClassVar[bool] = True

    thickness: float = parameter("m", "oil on both surfaces together before the contact", above=0.0, most=1e-2)

    inlet: ClassVar[None] = None

    @property
    def layer(self) -> float:
        return self.thickness

    def film(self, flooded: float, half_width: float, radius: float, resistance: float) -> float:
        return supplied_film(flooded, self.thickness, resistance=resistance)

    def reach(self, half_width: float, radius: float) -> float:
        """Return how far before the centre [m] the inlet is full: to a gap of twice the layer.

        What is refused piles up before the contact. Fitted to solved films: `python -m benchmarks.machines.rolling`.
        """
        return math.sqrt(half_width**2 + 4.0 * radius * self.thickness)


@dataclass(frozen=True)
class Meniscus:
    """The gap is full from the inlet meniscus on; before it there is no pressure."""

    name: ClassVar[str] = "meniscus"
    source: ClassVar[str] = "Hamrock & Dowson 1977, doi:10.1115/1.3453285"
    equations: ClassVar[Equations] = Equations(
        ("p_f = 0 for x < −d",),
        "d is the distance. The gap is full from there on.",
        symbols={
            "d": "distance",
        },
    )
    starves: ClassVar[bool] = True

    distance: float = parameter("m", "distance of the inlet meniscus before the centre", above=0.0, most=1.0)

    layer: ClassVar[None] = None

    @property
    def inlet(self) -> float:
        return self.distance

    def film(self, flooded: float, half_width: float, radius: float, resistance: float) -> float:
        return film_behind_meniscus(flooded, self.distance, half_width, radius)

    def reach(self, half_width: float, radius: float) -> float:
        """Return how far before the centre [m] the inlet is full."""
        return self.distance


LAWS: tuple[type[Supply], ...] = (Flooded, SupplyFilm, Meniscus)
