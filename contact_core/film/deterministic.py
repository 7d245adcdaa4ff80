"""Deterministic mixed lubrication."""

from dataclasses import dataclass
from typing import ClassVar

from ..quantities import parameter


@dataclass(frozen=True)
class Deterministic:
    """Fluid and solid pressure node by node."""

    name: ClassVar[str] = "deterministic"
    source: ClassVar[str] = "Azam et al. 2019, doi:10.1016/j.triboint.2018.11.011"

    points: int = parameter("", "grid nodes along x and along y", least=17, most=4097, shapes_arrays=True)
    domain: float = parameter("m", "side of the square grid, centred on the contact", above=0.0, most=1.0, shapes_arrays=True)
    floor: float = parameter("m", "gap at which solids touch: thickness of the adsorbed boundary layer", above=1e-11, most=1e-7)
    tolerance: float = parameter("", "pressure change at which a solution counts as converged, relative", above=0.0, most=0.1)
    iterations: int = parameter("", "most iterations of one solution", least=1, most=100_000)
    fft: str = parameter("", "library of the Fourier transforms", choices=("pyfftw", "scipy"), default="pyfftw")

    @property
    def spacing(self) -> float:
        """Distance between nodes [m]."""
        return self.domain / (self.points - 1)
