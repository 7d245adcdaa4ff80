"""Removal of the solids."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..quantities import parameter

Array = NDArray[np.float64]


@dataclass(frozen=True)
class NoWear:
    """Nothing wears."""

    name: ClassVar[str] = "none"
    source: ClassVar[str] = ""

    def rate(self, pressure: Array, cover: Array, sliding_speed: float, hardness: float) -> Array:
        """Zeros in the shape of `pressure`."""
        return np.zeros_like(pressure)


@dataclass(frozen=True)
class Archard:
    """dw/dt = K p |u_s| / H with K falling linearly from bare steel's to the full tribofilm's (Azam, eq. 7-3)."""

    name: ClassVar[str] = "archard"
    source: ClassVar[str] = "Archard 1953, doi:10.1063/1.1721448"

    bare: float = parameter("", "dimensionless wear coefficient of bare solids", least=0.0, most=1.0)
    film: float = parameter("", "dimensionless wear coefficient under a full tribofilm", least=0.0, most=1.0)

    def rate(self, pressure: Array, cover: Array, sliding_speed: float, hardness: float) -> Array:
        """Wear depth per second [m/s] under a solid pressure [Pa]; cover 0 to 1, hardness [Pa] of the solids."""
        coefficient = self.bare + (self.film - self.bare) * cover
        return coefficient * pressure * abs(sliding_speed) / hardness


LAWS = (NoWear, Archard)
