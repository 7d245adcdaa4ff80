"""Friction where solids touch."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..quantities import parameter


@dataclass(frozen=True)
class FilmBlend:
    """tau = mu p_solid, mu between bare steel's and the full tribofilm's in proportion to the mean cover.

    `slip_speed` is the sliding speed over which the friction changes sign: mu is multiplied by tanh(u_s / slip_speed).
    """

    name: ClassVar[str] = "film_blend"
    source: ClassVar[str] = "assumed: linear in the cover between the coefficients given"

    bare: float = parameter("", "friction coefficient of bare solids", least=0.0, most=2.0)
    film: float = parameter("", "friction coefficient under a full tribofilm", least=0.0, most=2.0)
    slip_speed: float = parameter("m/s", "sliding speed over which friction changes sign", above=0.0, most=1.0)

    def __call__(
        self, solid_pressure: NDArray[np.float64], cover: NDArray[np.float64], sliding_speed: float
    ) -> NDArray[np.float64]:
        """Shear stress [Pa], with the sign of the sliding speed, for cover 0 to 1 and solid pressure [Pa]."""
        coefficient = self.bare + (self.film - self.bare) * cover
        return coefficient * solid_pressure * np.tanh(sliding_speed / self.slip_speed)


LAWS = (FilmBlend,)
