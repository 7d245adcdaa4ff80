"""How rough bodies share the load between solids and oil: curves fitted to deterministic solutions."""

from dataclasses import dataclass
from typing import ClassVar

from ..quantities import parameter
from .elementary import Numbers, exp, expm1, maximum, minimum, sqrt

_FLATTENING = 0.2  # where the constants hold as they are: about that of the shipped scenes,
_RESOLUTION = 2.0  # and theirs on their grids
_THICKEST = 1e30  # L beyond which no solid carries anything: its powers need not overflow


def rms_slope(rq_1: Numbers, length_1: Numbers, rq_2: Numbers, length_2: Numbers) -> Numbers:
    """Rms gradient of the composite roughness of two bodies with rms roughness and correlation length [m].

    A surface with the autocorrelation rq^2 exp(-(r/l)^2) has the rms gradient 2 rq / l.
    """
    return 2.0 * sqrt((rq_1 / length_1) ** 2 + (rq_2 / length_2) ** 2)


def flattening_of(mean_pressure: Numbers, reduced_modulus: float, slope: Numbers) -> Numbers:
    """Mean Hertz pressure over what would press the roughness flat, p_m / (E* slope), E* = reduced_modulus / 2.

    The number that decides the real area of dry contact: Persson, J. Chem. Phys. 115 (2001) 3840,
    doi:10.1063/1.1388626.
    """
    return mean_pressure / (0.5 * reduced_modulus * slope)


@dataclass(frozen=True)
class FittedSharing:
    """W_c, A_c, h_c and the exposure of both bodies as functions of three numbers.

    lambda      film of the smooth bodies by Nijenbanning, Venner & Moes / composite rms roughness sigma,
    flattening  s, see `flattening_of`,
    resolution  r, correlation length of the rougher body / distance of the nodes.

    W_c = exp(-B L^C), L = lambda (s / 0.2)^2 (r / 2); A_c = [1 - exp(-c s)] W_c^D;
    h_c / sigma = W_c g + (1 - W_c) {(E lambda)^n + f^n}^(1/n), g = G (s / 0.2)^-1.5, f = F (s r / 0.4)^-0.75 >= g.

    W_c at a given lambda is a number of the grid: the constants hold for 129 nodes over 0.5 mm. They were fitted over
    the ranges `FITTED`; `HALF_WIDTHS` are those of their 95 % intervals (docs/regression.md).
    """

    name: ClassVar[str] = "fitted"
    source: ClassVar[str] = (
        "form of W_c: Zhou & Hoeprich, J. Tribol. 113 (1991) 590, doi:10.1115/1.2920664; "
        "constants: benchmarks/regression.py"
    )
    FITTED: ClassVar[dict[str, tuple[float, float]]] = {
        "clearance": (0.003, 5.0),
        "flattening": (0.13, 0.73),
        "resolution": (2.0, 5.7),
    }
    HALF_WIDTHS: ClassVar[dict[str, float]] = {
        "load_factor": 0.19,
        "load_exponent": 0.044,
        "area_factor": 0.021,
        "area_exponent": 0.015,
        "film_dry": 0.0085,
        "film_mixed": 0.025,
        "film_factor": 0.035,
        "film_exponent": 0.43,
        "oil_pressure_excess": 0.12,
        "exposure_rougher": 0.19,
        "exposure_exponent": 0.082,
        "exposure_smoother": 14.0,
        "exposure_dry_rougher": 0.046,
        "exposure_dry_smoother": 0.33,
    }

    load_factor: float = parameter("", "B", above=0.0, most=100.0, default=2.26)
    load_exponent: float = parameter("", "C", above=0.0, most=10.0, default=0.651)
    area_factor: float = parameter("", "c, of the dry contact's area", above=0.0, most=100.0, default=2.83)
    area_exponent: float = parameter("", "D", above=0.0, most=10.0, default=0.823)
    film_dry: float = parameter("", "G, mean gap of the dry contact / roughness", least=0.0, most=10.0, default=0.275)
    film_mixed: float = parameter(
        "", "F, mean gap that oil between asperities keeps / roughness", least=0.0, most=10.0, default=0.639
    )
    film_factor: float = parameter("", "E, mean gap / film of smooth bodies", above=0.0, most=10.0, default=0.732)
    film_exponent: float = parameter("", "n", above=0.0, most=20.0, default=2.19)
    oil_pressure_excess: float = parameter(
        "", "K, of the pressure at which oil carries load / Hertz's", least=0.0, most=100.0, default=1.32
    )
    exposure_rougher: float = parameter(
        "", "k in exposed = 1 - exp(-k A_c^m) of the rougher body", above=0.0, most=1e3, default=1.34
    )
    exposure_exponent: float = parameter("", "m, of the rougher body", above=0.0, most=10.0, default=0.641)
    exposure_smoother: float = parameter(
        "", "k in exposed = 1 - exp(-k A_c) of the smoother body", above=0.0, most=1e4, default=53.0
    )
    exposure_dry_rougher: float = parameter(
        "", "k of the rougher body in blocks driven dry, m = 1", above=0.0, most=1e3, default=1.52
    )
    exposure_dry_smoother: float = parameter(
        "", "k of the smoother body in blocks driven dry", above=0.0, most=1e3, default=3.97
    )
    load_scatter: float = parameter(
        "", "standard deviation of W_c about its curve, absolute", least=0.0, most=1.0, default=0.063
    )
    film_scatter: float = parameter(
        "", "standard deviation of h_c about its curve, relative", least=0.0, most=10.0, default=0.114
    )

    def load_ratio(self, clearance: Numbers, flattening: Numbers, resolution: Numbers) -> Numbers:
        """contact_load_ratio at lambda = `clearance`."""
        reduced = clearance * (flattening / _FLATTENING) ** 2 * resolution / _RESOLUTION
        return exp(-self.load_factor * minimum(reduced, _THICKEST) ** self.load_exponent)

    def area_ratio(self, load_ratio: Numbers, flattening: Numbers) -> Numbers:
        """contact_area_ratio where the solids carry `load_ratio` of the load."""
        return -expm1(-self.area_factor * flattening) * load_ratio**self.area_exponent

    def film_ratio(self, clearance: Numbers, load_ratio: Numbers, flattening: Numbers, resolution: Numbers) -> Numbers:
        """h_c / sigma at lambda = `clearance` where the solids carry `load_ratio` of the load."""
        share, flat = load_ratio, flattening / _FLATTENING
        flat = flat**-0.75
        dry = self.film_dry * (flat * flat)
        mixed = maximum(self.film_mixed * flat * (resolution / _RESOLUTION) ** -0.75, dry)
        film = self.film_factor * clearance
        larger = maximum(film, mixed)  # in front, because powers of large numbers overflow
        ratio = minimum(film, mixed) / larger
        return share * dry + (1.0 - share) * larger * (1.0 + ratio**self.film_exponent) ** (1.0 / self.film_exponent)

    def oil_pressure(self, clearance: Numbers, flattening: Numbers) -> Numbers:
        """Pressure at which oil carries load / Hertz's: 1 + K (0.2 / s) exp(-lambda).

        Between rough bodies the oil carries its load in spots, on the part (1 - W_c) / `oil_pressure` of Hertz's area.
        At the pressure of a load spread over all that the solids leave, it would be too thin to shear.
        """
        excess = self.oil_pressure_excess * _FLATTENING / flattening
        return 1.0 + excess * exp(-clearance)

    def covers(self, clearance: float, flattening: float, resolution: float) -> bool:
        """Whether the point lies within those of the fit."""
        (low, high), (flat, flatter), (coarse, fine) = self.FITTED.values()
        return low <= clearance <= high and flat <= flattening <= flatter and coarse <= resolution <= fine

    def nearest(self, flattening: float, resolution: float) -> tuple[float, float]:
        """The nearest flattening and resolution among those of the fit."""
        _, (flat, flatter), (coarse, fine) = self.FITTED.values()
        return min(max(flattening, flat), flatter), min(max(resolution, coarse), fine)

    def exposed(self, area_ratio: Numbers, *, rougher: bool, dry: bool = False) -> Numbers:
        """Share of a body's points within Hertz's width that touch the other body in a pass through the contact.

        `dry`: where the solids carry so much that dry contact drives the blocks (control.dry_above).
        """
        if dry:
            return -expm1(-(self.exposure_dry_rougher if rougher else self.exposure_dry_smoother) * area_ratio)
        if rougher:
            return -expm1(-self.exposure_rougher * area_ratio**self.exposure_exponent)
        return -expm1(-self.exposure_smoother * area_ratio)


LAWS = (FittedSharing,)
