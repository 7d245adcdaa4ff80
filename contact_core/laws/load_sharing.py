"""How rough bodies share the load between solids and oil: curves fitted to deterministic solutions."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..quantities import parameter

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FittedSharing:
    """contact_load_ratio, contact_area_ratio and mean gap as functions of lambda = smooth film / composite roughness.

    W_c = exp(-B lambda^C); A_c = A_dry W_c^D; h_c / sigma = [(E lambda)^n + G^n]^(1/n).
    """

    name: ClassVar[str] = "fitted"
    source: ClassVar[str] = (
        "form of W_c: Zhou & Hoeprich, J. Tribol. 113 (1991) 590, doi:10.1115/1.2920664; "
        "constants: benchmarks/regression.py"
    )

    load_factor: float = parameter("", "B", above=0.0, most=100.0, default=2.0)
    load_exponent: float = parameter("", "C", above=0.0, most=10.0, default=0.6)
    area_dry: float = parameter("", "A_dry, contact_area_ratio of the dry contact", above=0.0, most=1.0, default=0.3)
    area_exponent: float = parameter("", "D", above=0.0, most=10.0, default=1.0)
    film_factor: float = parameter("", "E", above=0.0, most=10.0, default=1.0)
    film_dry: float = parameter(
        "", "G, mean gap of the dry contact / composite roughness", above=0.0, most=10.0, default=0.5
    )
    film_exponent: float = parameter("", "n", above=0.0, most=20.0, default=2.0)
    least_clearance: float = parameter("", "smallest lambda of the fit", least=0.0, most=1e3, default=0.01)
    most_clearance: float = parameter("", "largest lambda of the fit", above=0.0, most=1e6, default=5.0)
    error_load: float = parameter(
        "", "half width of contact_load_ratio's error of the fit, absolute", least=0.0, most=1.0, default=0.1
    )
    error_area: float = parameter(
        "", "half width of contact_area_ratio's error of the fit, relative", least=0.0, most=10.0, default=0.2
    )
    error_film: float = parameter(
        "", "half width of the mean gap's error of the fit, relative", least=0.0, most=10.0, default=0.2
    )

    def load_ratio(self, clearance: Array) -> Array:
        """contact_load_ratio at values of lambda (any shape)."""
        return np.exp(-self.load_factor * clearance**self.load_exponent)

    def area_ratio(self, load_ratio: Array) -> Array:
        """contact_area_ratio at values of contact_load_ratio."""
        return self.area_dry * load_ratio**self.area_exponent

    def gap(self, clearance: Array) -> Array:
        """Mean gap over composite roughness at values of lambda."""
        film = self.film_factor * clearance
        wide = np.maximum(film, self.film_dry)  # taken out of the powers, which would overflow
        ratio = np.minimum(film, self.film_dry) / wide
        return wide * (1.0 + ratio**self.film_exponent) ** (1.0 / self.film_exponent)

    def covers(self, clearance: float) -> bool:
        """Whether lambda is within the points of the fit."""
        return self.least_clearance <= clearance <= self.most_clearance


LAWS = (FittedSharing,)
