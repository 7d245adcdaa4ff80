"""Laws of growth where solids touch, fitted to measured films."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ...quantities import parameter
from ...reference.constants import BOLTZMANN, PLANCK
from ..elementary import Numbers
from ..equations import Equations
from .doses import DOSES
from .relaxation import formed, mean, relaxed, rubbed, taken

Array = NDArray[np.float64]
Temperature = float | Array

_FIT_WIDTH = 5.0  # K to either side of the fit


def fit_temperature() -> Any:
    """Return the field of a law whose constants hold at one temperature."""
    return parameter("K", "temperature at which the constants were fitted", least=200.0, most=600.0)


def beyond_fit() -> Any:
    """Return the field that chooses between refusal and extrapolation at other temperatures."""
    text = "what to do more than 5 K from the fit_temperature"
    return parameter("", text, choices=("refuse", "extrapolate"), default="refuse")


def _covers(fit: float, temperature: float) -> bool:
    return abs(temperature - fit) <= _FIT_WIDTH


def _refusal(fit: float, temperature: float, extrapolated: str) -> str:
    return (
        f"temperature = {temperature:g} K is outside {fit - _FIT_WIDTH:g} K to {fit + _FIT_WIDTH:g} K, where the "
        f"tribofilm's constants hold (tribofilm.fit_temperature = {fit:g} K). Use a set fitted at that temperature, or "
        f"tribofilm.beyond_fit = 'extrapolate', which {extrapolated}."
    )


class _Unabraded:
    """Laws without first-order removal of their own."""

    abrades: ClassVar[bool] = False
    takes_abrasion: ClassVar[bool] = True

    def abrasion(self, solid_pressure: Array, sliding_speed: float | Array, position: Array | None) -> Array:
        """Return zeros in the shape of `solid_pressure`."""
        return np.zeros_like(solid_pressure)


@dataclass(frozen=True)
class NoTribofilm(_Unabraded):
    """No additive: nothing grows."""

    name: ClassVar[str] = "none"
    source: ClassVar[str] = ""
    equations: ClassVar[Equations] = Equations(
        ("h_t = 0",),
        "No additive.",
    )
    full_thickness: ClassVar[float] = 1.0  # any positive number: the thickness is always zero
    dose: ClassVar[str] = "clock"

    def exposure(self, solid_pressure: Array, shear: Array, sliding_speed: float, temperature: Temperature) -> Array:
        """Return zeros in the shape of `solid_pressure`."""
        return np.zeros_like(solid_pressure)

    def evolve(
        self, growth: Array, removal: Array, exposed: Array, abraded: Array, temperature: float
    ) -> tuple[Array, Array]:
        """Return both variables as they are."""
        return growth, removal

    def formed(
        self, growth: Array, removal: Array, after: Array, exposed: Array, abraded: Array, temperature: float
    ) -> Array:
        """Return zeros in the shape of `growth`."""
        return np.zeros_like(growth)

    def covers(self, temperature: float) -> bool:
        """Return True: nothing depends on the temperature."""
        return True

    def refusal(self, temperature: float) -> str:
        """Return an empty text at any `temperature` [K]."""
        return ""


@dataclass(frozen=True)
class Ghanbarzadeh(_Unabraded):
    """Growth to h_max at the rate k = (k_B T / h) x, removal up to C3 at the rate C4: thickness = growth - removal.

    In closed form for a node rubbed for a time t: h = h_max [1 - exp(-k t)] - C3 [1 - exp(-C4 t)].
    A node that slides is exposed (1) or not (0), so its exposure over a time is the time it counts as rubbed [s].
    `nodes` says which are: "contacts", where solids touch; "stressed", also where a film of oil alone shears the
    surface by more than `least_shear` (films grow without solid contact under enough shear stress: Zhang & Spikes
    2016, doi:10.1007/s11249-016-0706-7; the threshold is assumed). The published constants were fitted to the clock
    time of nodes in contact: the defaults.
    """

    name: ClassVar[str] = "ghanbarzadeh"
    source: ClassVar[str] = "Ghanbarzadeh et al. 2016, doi:10.1016/j.triboint.2014.12.018"
    equations: ClassVar[Equations] = Equations(
        ("h_t = h_{max} [1 − exp(−k t)] − C_3 [1 − exp(−C_4 t)],   k = x k_B T/h_P",),
        "t is the time for which the point has been rubbed; kB and hP are Boltzmann's and Planck's constants.",
        options={"dose": {name: dose.equations for name, dose in DOSES.items()}},
    )

    full_thickness: float = parameter("m", "h_max, thickness without removal", above=0.0, most=1e-5)
    rate_factor: float = parameter("", "x, share of k_B T / h that forms film", least=0.0, most=1.0)
    removal_thickness: float = parameter("m", "C3, largest removed thickness", least=0.0, most=1e-5)
    removal_rate: float = parameter("s^-1", "C4, rate of removal", least=0.0, most=1.0)
    fit_temperature: float = fit_temperature()
    dose: str = parameter("", "how long a node counts as rubbed", choices=("clock", "contact_length"), default="clock")
    nodes: str = parameter("", "which nodes are rubbed", choices=("contacts", "stressed"), default="contacts")
    least_shear: float = parameter(
        "Pa",
        "shear stress above which oil alone rubs a node, for nodes = stressed",
        least=0.0,
        most=1e10,
        default=1e8,
        quantity="Stress",
    )
    beyond_fit: str = beyond_fit()

    def rate(self, temperature: Temperature) -> Temperature:
        """Return the rate k of growth [1/s] at `temperature` [K]."""
        return BOLTZMANN * temperature / PLANCK * self.rate_factor

    def exposure(
        self, solid_pressure: Numbers, shear: Numbers, sliding_speed: float, temperature: Temperature
    ) -> Numbers:
        """Return 1 where a node is rubbed, else 0, under solid pressure and total |shear stress| [Pa].

        0 without sliding.
        """
        if sliding_speed == 0.0:
            return np.zeros_like(solid_pressure)
        rubbed = solid_pressure > 0.0
        if self.nodes == "stressed":
            rubbed |= shear > self.least_shear
        return rubbed * 1.0

    def evolve(
        self, growth: Array, removal: Array, exposed: Array, abraded: Array, temperature: float
    ) -> tuple[Array, Array]:
        """Return both variables [m] after each node was rubbed for a time `exposed` [s]; exact for any time.

        What is `abraded` leaves room to grow in; the law's own removal goes on beside it.
        """
        forming, losing = self.rate(temperature) * exposed, self.removal_rate * exposed
        limits = self.full_thickness, self.removal_thickness
        return rubbed(growth, removal, limits, forming, losing, abraded)

    def formed(
        self, growth: Array, removal: Array, after: Array, exposed: Array, abraded: Array, temperature: float
    ) -> Array:
        """Return the film formed [m] while `growth` went to `after`; the rest as in `evolve`."""
        if not taken(abraded):
            return after - growth
        kept = mean(removal, self.removal_thickness, self.removal_rate * exposed)
        return formed(growth, after, self.full_thickness, self.rate(temperature) * exposed, abraded, kept)

    def covers(self, temperature: float) -> bool:
        """Return True if `temperature` [K] is within 5 K of the fit.

        T changes the rate by +-6 % only from 60 to 100 degC.
        """
        return _covers(self.fit_temperature, temperature)

    def refusal(self, temperature: float) -> str:
        """Return why the law does not hold at a bulk `temperature` [K], or an empty text."""
        if self.beyond_fit == "extrapolate" or self.covers(temperature):
            return ""
        changed = "changes the rate by +-6 % only between 60 and 100 degC: T enters by k_B T / h alone"
        return _refusal(self.fit_temperature, temperature, changed)


@dataclass(frozen=True)
class Andersson(_Unabraded):
    """Growth by the frictional power per area q = |tau u_s| where solids touch; nothing is removed.

    dh/dt = C5 (1 - h / h_max) max(q - C6, 0), Azam's equations (5-1) and (5-2) (PhD thesis, University of Leeds 2018),
    which write q as mu p u_s. The exposure is max(q - C6, 0) [W/m2]; over a time and the whole track it adds up to an
    energy per area E [J/m2], and h_max - h falls by exp(-C5 E / h_max).
    """

    name: ClassVar[str] = "andersson"
    source: ClassVar[str] = (
        "Andersson, Larsson, Almqvist, Grahn & Minami, Faraday Discuss. 156 (2012) 343, doi:10.1039/c2fd00132b"
    )
    equations: ClassVar[Equations] = Equations(
        ("∂h_t/∂t = C_5 (1 − h_t/h_{max}) max(τ |u_1 − u_2| − C_6, 0)",),
        "Where solids touch; nothing is removed.",
        options={"dose": {name: dose.equations for name, dose in DOSES.items()}},
    )
    dose: ClassVar[str] = "residence"

    full_thickness: float = parameter("m", "h_max, largest thickness", above=0.0, most=1e-5)
    growth_per_energy: float = parameter(
        "m3/J", "C5, volume that frictional energy forms on bare solids", least=0.0, most=1e-6
    )
    least_power: float = parameter("W/m2", "C6, frictional power per area that forms nothing", least=0.0, most=1e12)
    fit_temperature: float = fit_temperature()
    beyond_fit: str = beyond_fit()

    def exposure(self, solid_pressure: Array, shear: Array, sliding_speed: float, temperature: Temperature) -> Array:
        """Return the frictional power per area above the threshold [W/m2] where solids touch.

        The total |shear stress| is in Pa.
        """
        power = np.maximum(shear * abs(sliding_speed) - self.least_power, 0.0)
        return np.where(solid_pressure > 0.0, power, 0.0)

    def evolve(
        self, growth: Array, removal: Array, exposed: Array, abraded: Array, temperature: float
    ) -> tuple[Array, Array]:
        """Return both variables [m] after each node took up `exposed` [J/m2]; exact for any energy."""
        forming = self.growth_per_energy * exposed / self.full_thickness
        return relaxed(growth, self.full_thickness, forming, abraded), removal

    def formed(
        self, growth: Array, removal: Array, after: Array, exposed: Array, abraded: Array, temperature: float
    ) -> Array:
        """Return the film formed [m] while `growth` went to `after`; the rest as in `evolve`."""
        forming = self.growth_per_energy * exposed / self.full_thickness
        return formed(growth, after, self.full_thickness, forming, abraded)

    def covers(self, temperature: float) -> bool:
        """Return True if `temperature` [K] is within 5 K of the fit."""
        return _covers(self.fit_temperature, temperature)

    def refusal(self, temperature: float) -> str:
        """Return why the law does not hold at a bulk `temperature` [K], or an empty text."""
        if self.beyond_fit == "extrapolate" or self.covers(temperature):
            return ""
        return _refusal(self.fit_temperature, temperature, "leaves the rate as it is: the law has no temperature in it")


def thickness(growth: Array, removal: Array) -> Array:
    """Return the thickness of the tribofilm [m]."""
    return np.maximum(growth - removal, 0.0)
