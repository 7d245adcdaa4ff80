"""Asperities that are too short for any grid: mean pressure, gap and real area of contact.

Form and constants follow from dry contacts of periodic, self-affine roughness (Hurst exponent 0.8, waves over a factor
of 4 to 16 in length): `surfaces.asperity_layer` of the benchmarks of revision 869ed0dc.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..quantities import parameter
from .elementary import Numbers
from .equations import Equations

# units: q sigma E'/2 for pressures, sigma for heights, q sigma for slopes, with q = 2 pi / longest
ELASTIC_PRESSURE = 1.0  # p0 without yielding
PLASTIC_PRESSURE = 1.1  # p0 where all yields, in hardnesses
ELASTIC_HEIGHT, PLASTIC_HEIGHT = 0.44, 0.52  # h0
SLOPE = 2.3  # rms slope; 1.82 and 2.87 for waves over a factor of 4 and 16
AREA = 2.2  # touching share at light pressures, in pressures over E'/2 and the rms slope
STEEPEST = 0.3  # rms slope of one wave; a steeper one means heights or lengths in a wrong unit


@dataclass(frozen=True)
class AsperityLayer:
    """Roughness below the grid, of both bodies together: s(h) = p0 exp(-h / h0).

    The reduced modulus is E' [Pa]; the hardness [Pa] may differ from node to node. Without roughness (`rms` = 0) the
    layer is a hard floor: it bears nothing above height 0, and touches wholly at it.
    """

    name: ClassVar[str] = "exponential"
    source: ClassVar[str] = (
        "constants: fitted to solved contacts; the exponential: Persson 2007, "
        "doi:10.1103/PhysRevLett.99.125502; the elastic area: Persson 2001, doi:10.1063/1.1388626"
    )
    equations: ClassVar[Equations] = Equations(
        (
            "s = p_0 exp(−h/h_0),   p_e = q σ E′/2,   q = 2π/λ_l",
            "p_0 = [p_e^{−2} + (1.1 H)^{−2}]^{−1/2},   h_0 = σ [0.52 − 0.08 p_0/p_e]",
            "A = min(1, [A_e^4 + (s/H)^4]^{1/4}),   A_e = erf[√π/2 · 2.2 s/(2.3 p_e)]",
        ),
        "σ is the rms height of the waves that no grid carries, λl the longest of them, h the height above the floor.",
        symbols={
            "s": "mean pressure of the asperities [Pa]",
            "h": "height above the floor [m]",
            "σ": "rms",
            "λ_l": "longest",
            "H": "hardness under the local tribofilm [Pa]",
        },
    )

    rms: float = parameter("m", "rms height of the waves that no grid carries", least=0.0, most=1e-5)
    longest: float = parameter("m", "longest wavelength that no grid carries", above=0.0, most=1e-3)

    @property
    def error(self) -> str:
        if self.slope <= STEEPEST:
            return ""
        return (
            f"rms = {self.rms:g} m over longest = {self.longest:g} m is a slope of {self.slope:.2g}; at most "
            f"{STEEPEST:g} is allowed. Give both in metres, or a smaller rms."
        )

    @property
    def slope(self) -> float:
        """Rms slope of one wave of the rms height and the longest wavelength."""
        return 2.0 * np.pi * self.rms / self.longest

    def beside(self, other: "AsperityLayer") -> "AsperityLayer":
        """Return the layer of two bodies that touch: the squares of heights add, and so do those of slopes."""
        rms, slope = float(np.hypot(self.rms, other.rms)), float(np.hypot(self.slope, other.slope))
        return AsperityLayer(rms, 2.0 * np.pi * rms / slope if slope > 0.0 else max(self.longest, other.longest))

    def pressure_scale(self, modulus: float, hardness: Numbers) -> Numbers:
        """Return p0 [Pa], the pressure at the floor, for a reduced modulus and a hardness [Pa]."""
        elastic = ELASTIC_PRESSURE * self.slope * modulus / 2.0
        return elastic / np.sqrt(1.0 + (elastic / (PLASTIC_PRESSURE * hardness)) ** 2)

    def height_scale(self, modulus: float, hardness: Numbers) -> Numbers:
        """Return h0 [m], the height over which the pressure falls to 1/e."""
        elastic = ELASTIC_PRESSURE * self.slope * modulus / 2.0
        share = self.pressure_scale(modulus, hardness) / elastic if elastic > 0.0 else 1.0
        return self.rms * (PLASTIC_HEIGHT - (PLASTIC_HEIGHT - ELASTIC_HEIGHT) * share)

    def pressure(self, height: Numbers, modulus: float, hardness: Numbers) -> Numbers:
        """Return the mean pressure [Pa] at heights above the floor [m]; below the floor it is that at the floor."""
        if self.rms == 0.0:
            return np.zeros_like(height, dtype=float)
        height_0 = self.height_scale(modulus, hardness)
        return self.pressure_scale(modulus, hardness) * np.exp(-np.maximum(height, 0.0) / height_0)

    def gap(self, pressure: Numbers, modulus: float, hardness: Numbers) -> Numbers:
        """Return the height above the floor [m] under mean pressures [Pa]: infinite under none, 0 from p0 on."""
        if self.rms == 0.0:
            return np.where(np.asarray(pressure) > 0.0, 0.0, np.inf)
        with np.errstate(divide="ignore"):
            depth = np.log(self.pressure_scale(modulus, hardness)) - np.log(pressure)
        return self.height_scale(modulus, hardness) * np.maximum(depth, 0.0)

    def area(self, pressure: Numbers, modulus: float, hardness: Numbers) -> Numbers:
        """Return the touching share of the area, 0 to 1, under mean pressures [Pa]."""
        if self.rms == 0.0:
            return np.where(np.asarray(pressure) > 0.0, 1.0, 0.0)
        return touching(pressure, SLOPE * self.slope * modulus / 2.0, hardness)


def touching(pressure: Numbers, firmness: float, hardness: Numbers) -> Numbers:
    """Return the touching share of the area of roughness under mean pressures [Pa].

    firmness [Pa] is E'/2 times the rms slope.
    """
    from scipy.special import erf  # loaded where roughness below the grid is used

    elastic = erf(np.sqrt(np.pi) / 2.0 * AREA * pressure / firmness)
    return np.minimum((elastic**4 + (pressure / hardness) ** 4) ** 0.25, 1.0)
