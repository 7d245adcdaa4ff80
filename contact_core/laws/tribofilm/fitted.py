"""Laws of growth where solids touch, fitted to measured films."""

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ...kernels.arrays import Array
from ...quantities import parameter
from ...reference.constants import BOLTZMANN, PLANCK
from ..elementary import Numbers
from ..equations import Equations
from .doses import DOSES, OF_TESTS
from .relaxation import formed, mean, relaxed, rubbed, taken

Temperature = float | Array

_FIT_WIDTH = 5.0  # K to either side of the fit
_SLOWEST = 1e-100  # 1/s, in place of no growth at all


def fit_temperature() -> Any:
    """Return the field of a law whose constants hold at one temperature."""
    return parameter("K", "temperature at which the constants were fitted", least=200.0, most=600.0)


def beyond_fit() -> Any:
    """Return the field that chooses between refusal and extrapolation at other temperatures."""
    text = "what to do more than 5 K from the fit_temperature"
    return parameter("", text, choices=("refuse", "extrapolate"), default="refuse")


def supply_rate() -> Any:
    """Return the field that limits the growth by the supply of additive.

    A monolayer of additive on the surface is about 0.15 nm of tribofilm (a molecule on 0.8 nm2 with two atoms of
    phosphorus, assumed); the film of oil over it brings less. The default is ten of them a second, 90 nm a minute.
    """
    text = "largest growth per test time that the oil's additive can supply"
    return parameter("m/s", text, above=0.0, most=1.0, default=1.5e-9)


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
        left_out="Tribofilm: friction, hardness and wear are those of bare solids all the time.",
    )
    full_thickness: ClassVar[float] = 1.0  # any positive number: the thickness is always zero
    dose: ClassVar[str] = "residence"
    most_exposure: ClassVar[float] = 0.0

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
    The exposure of a node that is rubbed is k at its own temperature, else 0; over a time it adds up to k t.
    `nodes` says which are rubbed: "contacts", where solids touch; "stressed", also where a film of oil alone shears the
    surface by more than `least_shear` (films grow without solid contact under enough shear stress: Zhang & Spikes
    2016, doi:10.1007/s11249-016-0706-7; the threshold is assumed).

    The constants were fitted to the time of tests, in which a point of the surface is in solid contact for a small
    share of the time only. With the dose "residence" t is the time in solid contact over `contact_share`, that share in
    the tests of the fit: other tests grow films in proportion to their own share. With "clock" a point that is rubbed
    at all ages by the time of the test, whatever load, speeds and roughness: the reading of Azam's thesis.
    """

    name: ClassVar[str] = "ghanbarzadeh"
    source: ClassVar[str] = "Ghanbarzadeh et al. 2016, doi:10.1016/j.triboint.2014.12.018"
    equations: ClassVar[Equations] = Equations(
        ("h_t = h_{max} [1 − exp(−k t)] − C_3 [1 − exp(−C_4 t)],   k = x k_B T/h_P",),
        "t is the time for which the point has been rubbed; kB and hP are Boltzmann's and Planck's constants.",
        options={"dose": OF_TESTS},
        symbols={
            "h_{max}": "full_thickness",
            "C_3": "removal_thickness",
            "C_4": "removal_rate",
            "x": "rate_factor",
            "t": "time for which the point has been rubbed [s]",
        },
    )

    full_thickness: float = parameter("m", "h_max, thickness without removal", above=0.0, most=1e-5)
    rate_factor: float = parameter("", "x, share of k_B T / h that forms film", least=0.0, most=1.0)
    removal_thickness: float = parameter("m", "C3, largest removed thickness", least=0.0, most=1e-5)
    removal_rate: float = parameter("s^-1", "C4, rate of removal", least=0.0, most=1.0)
    fit_temperature: float = fit_temperature()
    dose: str = parameter(
        "", "how long a node counts as rubbed", choices=("residence", "contact_length", "clock"), default="residence"
    )
    contact_share: float = parameter(
        "",
        "share of the time for which a point was in solid contact in the tests of the fit, for dose = residence",
        least=1e-9,
        most=1.0,
        default=7e-4,
    )
    supply_rate: float = supply_rate()
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

    @property
    def most_exposure(self) -> float:
        return self.supply_rate / self.full_thickness

    def rate(self, temperature: Temperature) -> Temperature:
        """Return the rate k of growth [1/s] at `temperature` [K], by the time of the tests."""
        return BOLTZMANN * temperature / PLANCK * self.rate_factor

    def exposure(
        self, solid_pressure: Numbers, shear: Numbers, sliding_speed: float, temperature: Temperature
    ) -> Numbers:
        """Return the rate of growth [1/s] where a node is rubbed, else 0.

        Under solid pressure and total |shear stress| [Pa]; 0 without sliding.
        """
        if sliding_speed == 0.0:
            return np.zeros_like(solid_pressure)
        rubbed = solid_pressure > 0.0
        if self.nodes == "stressed":
            rubbed |= shear > self.least_shear
        share = self.contact_share if self.dose == "residence" else 1.0
        return rubbed * (self.rate(temperature) / share)

    def evolve(
        self, growth: Array, removal: Array, exposed: Array, abraded: Array, temperature: float
    ) -> tuple[Array, Array]:
        """Return both variables [m] after each node has been `exposed`, k t; exact for any of it.

        Removal goes on beside growth, at the rate C4. What is `abraded` leaves room to grow in.
        """
        limits = self.full_thickness, self.removal_thickness
        return rubbed(growth, removal, limits, exposed, self._losing(exposed, temperature), abraded)

    def _losing(self, exposed: Array, temperature: float) -> Array:
        """Return C4 t for an exposure k t."""
        return self.removal_rate * exposed / max(self.rate(temperature), _SLOWEST)

    def formed(
        self, growth: Array, removal: Array, after: Array, exposed: Array, abraded: Array, temperature: float
    ) -> Array:
        """Return the film formed [m] while `growth` went to `after`; the rest as in `evolve`."""
        if not taken(abraded):
            return after - growth
        kept = mean(removal, self.removal_thickness, self._losing(exposed, temperature))
        return formed(growth, after, self.full_thickness, exposed, abraded, kept)

    def covers(self, temperature: float) -> bool:
        """Return True if `temperature` [K] is within 5 K of the fit.

        T changes the rate by +-6 % only from 60 to 100 degC.
        """
        return _covers(self.fit_temperature, temperature)

    def refusal(self, temperature: float) -> str:
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
        symbols={
            "h_{max}": "full_thickness",
            "C_5": "growth_per_energy",
            "C_6": "least_power",
        },
    )
    dose: ClassVar[str] = "residence"

    full_thickness: float = parameter("m", "h_max, largest thickness", above=0.0, most=1e-5)
    growth_per_energy: float = parameter(
        "m3/J", "C5, volume that frictional energy forms on bare solids", least=0.0, most=1e-6
    )
    least_power: float = parameter("W/m2", "C6, frictional power per area that forms nothing", least=0.0, most=1e12)
    fit_temperature: float = fit_temperature()
    beyond_fit: str = beyond_fit()
    supply_rate: float = supply_rate()

    @property
    def most_exposure(self) -> float:
        return self.supply_rate / self.growth_per_energy if self.growth_per_energy > 0.0 else math.inf

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
        if self.beyond_fit == "extrapolate" or self.covers(temperature):
            return ""
        return _refusal(self.fit_temperature, temperature, "leaves the rate as it is: the law has no temperature in it")


def thickness(growth: Array, removal: Array) -> Array:
    """Return the thickness of the tribofilm [m]."""
    return np.maximum(growth - removal, 0.0)
