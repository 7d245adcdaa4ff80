"""Shear stress of the film between the surfaces."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..quantities import parameter


@dataclass(frozen=True)
class EyringLimited:
    """tau = min( tau_E asinh(eta |rate| / tau_E), Lambda p ), with the sign of the shear rate."""

    name: ClassVar[str] = "eyring_limited"
    source: ClassVar[str] = (
        "Johnson & Tevaarwerk 1977, doi:10.1098/rspa.1977.0129; Bair & Winer, J. Lubr. Technol. 101 (1979) 258"
    )

    eyring_stress: float = parameter("Pa", "shear stress at which the fluid begins to thin", above=0.0, most=1e9)
    limiting_coefficient: float = parameter("", "limiting shear stress / pressure", above=0.0, most=1.0)

    def __call__(
        self, viscosity: NDArray[np.float64], rate: NDArray[np.float64], pressure: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Shear stress [Pa] for viscosity [Pa s], shear rate [1/s] and pressure [Pa] of one shape."""
        stress = self.eyring_stress * np.arcsinh(viscosity * np.abs(rate) / self.eyring_stress)
        return np.sign(rate) * np.minimum(stress, self.limiting_coefficient * pressure)


LAWS = (EyringLimited,)
