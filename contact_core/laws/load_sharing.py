"""How rough bodies share the load between solids and oil: curves fitted to deterministic solutions."""

from dataclasses import dataclass
from typing import ClassVar

from ..quantities import parameter


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

    def load_ratio(self, clearance: float) -> float:
        """contact_load_ratio at lambda = `clearance`."""
        raise NotImplementedError


LAWS = (FittedSharing,)
