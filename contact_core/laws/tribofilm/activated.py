"""Laws of reactions that stress accelerates, with first-order removal.

Bell's model: a stress lowers the barrier of a reaction by its work on the activation volume, so the rate is
A exp[-(E0 - stress dV) / (k_B T)] (Azam's equations (5-5) and (5-6), PhD thesis, University of Leeds 2018), with the
stress and the temperature of the node; it is A once no barrier is left. With first-order removal at the rate r

    dh/dt = A exp[-(E0 - stress dV) / (k_B T)] (1 - h / h_max) - r h,

which settles at h_max g / (g + r), g being the first term's rate over h_max. Removal in proportion to thickness is that
of Akchurin & Bosman 2017, doi:10.1007/s11249-017-0842-8; here r = k_r p v, with the solid pressure p.

With the dose "residence", A is a rate while the stress acts. Rigs report growth per test time: as it stands, such a
rate is for the dose "contact_length"; divided by the contact's share of the track, 2a / track length, for "residence",
which then distinguishes long tracks from short ones.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ...kernels.arrays import Array
from ...quantities import parameter
from ...reference.constants import BOLTZMANN
from ..equations import Equations
from .doses import DOSES
from .fitted import Ghanbarzadeh, beyond_fit, fit_temperature, supply_rate, thickness
from .relaxation import formed

Temperature = float | Array

_COLDEST, _HOTTEST = 333.15, 393.15  # K, bulk: about the range of tests on rigs; assumed
_SYMBOLS = {
    "h_{max}": "full_thickness",
    "A": "prefactor",
    "E_0": "activation_energy",
    "ΔV": "activation_volume",
    "k_r": "removal_coefficient",
}
_POISSON = 0.3  # of the solids, for the shape of the surface tension


def _full_thickness() -> Any:
    return parameter("m", "h_max, thickness without removal", above=0.0, most=1e-5)


def _prefactor() -> Any:
    return parameter("m/s", "A, rate of growth on bare solids without a barrier", least=0.0, most=1e15)


def _activation_energy() -> Any:
    return parameter("J", "E0, barrier without stress, per molecule", least=0.0, most=1e-18)


def _activation_volume(stress: str) -> Any:
    return parameter("m3", f"dV, by which {stress} lowers the barrier, per molecule", least=0.0, most=1e-26)


def _removal_coefficient() -> Any:
    return parameter("1/(Pa m)", "k_r, share removed per solid pressure and sliding distance", least=0.0, most=1.0)


def _edge_weight() -> Any:
    text = "how much faster removal is at the edges of the track than in its middle, less one; 0: even"
    return parameter("", text, least=0.0, most=1e3, default=0.0)


def _least_shear() -> Any:
    text = "shear stress below which a node is not rubbed: no growth by temperature alone"
    return parameter("Pa", text, above=0.0, most=1e10, default=1e7, quantity="Stress")


def edge_tension(position: Array) -> Array:
    """Return the share (0 to 1) of the rise of the tension across the track from its middle to its edge.

    `position` is |y| / b; beyond 1 the share stays 1. The radial surface stress of Hertz's frictionless circle, from
    -(1 + 2v) p0 / 2 in the middle to (1 - 2v) p0 / 3 at the edge (Johnson, Contact Mechanics, 1985, section 3.4,
    doi:10.1017/CBO9781139171731), for v = 0.3. Films crack in tension: that removal follows it is assumed.
    """
    x2 = np.minimum(position, 1.0) ** 2
    ring = np.where(x2 > 1e-8, (1.0 - (1.0 - x2) ** 1.5) / np.maximum(x2, 1e-8), 1.5)
    shortfall = (1.0 - 2.0 * _POISSON) / 3.0
    middle = 1.5 * shortfall - 1.0
    share: Array = (shortfall * ring - np.sqrt(1.0 - x2) - middle) / (shortfall - middle)
    return share


class _Activated:
    """Growth by Bell's rate. The thickness is in `growth`, `removal` stays zero."""

    abrades: ClassVar[bool] = True
    takes_abrasion: ClassVar[bool] = True
    beyond_fit: str = "extrapolate"

    full_thickness: float
    prefactor: float
    activation_energy: float
    activation_volume: float
    removal_coefficient: float
    edge_weight: float
    supply_rate: float

    @property
    def most_exposure(self) -> float:
        return self.supply_rate / self.full_thickness

    def rate(self, stress: Array, temperature: Temperature) -> Array:
        """Return the rate of growth over h_max [1/s] under a stress [Pa] at a surface temperature [K]."""
        barrier = np.maximum(self.activation_energy - stress * self.activation_volume, 0.0)
        found: Array = self.prefactor / self.full_thickness * np.exp(-barrier / (BOLTZMANN * temperature))
        return found

    def abrasion(self, solid_pressure: Array, sliding_speed: float | Array, position: Array | None) -> Array:
        """Return the rate of removal [1/s] under a solid pressure [Pa].

        `position` is |y| / b; None: far from the edges.

        Linear in the pressure: the mean pressure over a track gives the mean rate.
        """
        rate: Array = self.removal_coefficient * np.abs(sliding_speed) * solid_pressure
        if position is None or self.edge_weight == 0.0:
            return rate
        return rate * (1.0 + self.edge_weight * edge_tension(position))

    def evolve(
        self, growth: Array, removal: Array, exposed: Array, abraded: Array, temperature: float
    ) -> tuple[Array, Array]:
        """Return both variables [m] after growth and removal rates that add up to `exposed` and `abraded`.

        Exact for any of them.

        The temperature has been counted in `exposed`.
        """
        now, both = thickness(growth, removal), exposed + abraded
        settled = self.full_thickness * np.divide(exposed, both, out=np.zeros_like(both), where=both > 0.0)
        return now - (settled - now) * np.expm1(-both), np.zeros_like(removal)

    def formed(
        self, growth: Array, removal: Array, after: Array, exposed: Array, abraded: Array, temperature: float
    ) -> Array:
        """Return the film formed [m] while `growth` went to `after`; the rest as in `evolve`."""
        return formed(growth, after, self.full_thickness, exposed, abraded)

    def covers(self, temperature: float) -> bool:
        """Return True if a bulk `temperature` [K] is within 60 to 120 degC."""
        return _COLDEST <= temperature <= _HOTTEST

    def refusal(self, temperature: float) -> str:
        """Return an empty text: the rate includes the temperature."""
        return ""


@dataclass(frozen=True)
class _ByOneStress(_Activated):
    """Growth by one stress."""

    full_thickness: float = _full_thickness()
    prefactor: float = _prefactor()
    activation_energy: float = _activation_energy()
    activation_volume: float = _activation_volume("the stress")
    removal_coefficient: float = _removal_coefficient()
    edge_weight: float = _edge_weight()
    supply_rate: float = supply_rate()
    dose: str = parameter(
        "", "the time that the rates are for", choices=("residence", "contact_length"), default="residence"
    )


@dataclass(frozen=True)
class ZhangSpikes(_ByOneStress):
    """Growth by shear stress, of oil or of solids: a full film grows a tribofilm without any contact.

    Activation volumes of 0.09 nm3 (n-octyl), 0.13 nm3 (2-ethylhexyl) and 0.20 nm3 (2-cyclohexylethyl ZDDP) were
    fitted at 80 degC to mean shear stresses of full films, of the order of 0.1 GPa. Under asperities the stress is
    several times that: the law is extrapolated there, and the film is full almost at once.
    """

    name: ClassVar[str] = "zhang_spikes"
    source: ClassVar[str] = (
        "Zhang & Spikes 2016, doi:10.1007/s11249-016-0706-7; Zhang, Ewen & Spikes 2022, doi:10.1039/d2me00049k; "
        "removal: after Akchurin & Bosman 2017, doi:10.1007/s11249-017-0842-8"
    )
    equations: ClassVar[Equations] = Equations(
        (
            "∂h_t/∂t = A exp[−(E_0 − τ ΔV)/(k_B T)] (1 − h_t/h_{max}) − r h_t",
            "r = k_r p_s |v|",
        ),
        "τ is the shear stress of oil and solids: a full film grows a tribofilm, too. Stress lowers the barrier to "
        "zero at most.",
        options={"dose": {name: dose.equations for name, dose in DOSES.items()}},
        symbols=_SYMBOLS,
    )

    least_shear: float = _least_shear()

    def exposure(self, solid_pressure: Array, shear: Array, sliding_speed: float, temperature: Temperature) -> Array:
        """Return the rate of growth over h_max [1/s] under the total |shear stress| [Pa] of oil and solids.

        0 without sliding.
        """
        if sliding_speed == 0.0:
            return np.zeros_like(shear)
        return np.where(shear > self.least_shear, self.rate(shear, temperature), 0.0)


@dataclass(frozen=True)
class Gosvami(_ByOneStress):
    """Growth by the normal stress where solids touch.

    E0 = 0.8 +- 0.2 eV and dV = 3.8 +- 1.2 A^3 from single asperities under normal stresses of some GPa: a volume of
    another stress than that of `zhang_spikes`.
    """

    name: ClassVar[str] = "gosvami"
    source: ClassVar[str] = (
        "Gosvami et al. 2015, doi:10.1126/science.1258788; removal: after Akchurin & Bosman 2017, "
        "doi:10.1007/s11249-017-0842-8"
    )
    equations: ClassVar[Equations] = Equations(
        (
            "∂h_t/∂t = A exp[−(E_0 − p_s ΔV)/(k_B T)] (1 − h_t/h_{max}) − r h_t",
            "r = k_r p_s |v|",
        ),
        "The normal stress drives the growth where solids touch. It lowers the barrier to zero at most.",
        options={"dose": {name: dose.equations for name, dose in DOSES.items()}},
        symbols=_SYMBOLS,
    )

    def exposure(self, solid_pressure: Array, shear: Array, sliding_speed: float, temperature: Temperature) -> Array:
        """Return the rate of growth over h_max [1/s] under the solid pressure [Pa] where solids touch.

        0 without sliding.
        """
        if sliding_speed == 0.0:
            return np.zeros_like(solid_pressure)
        return np.where(solid_pressure > 0.0, self.rate(solid_pressure, temperature), 0.0)


@dataclass(frozen=True)
class Combined(_Activated):
    """Growth in contacts (`ghanbarzadeh`) and by shear (`zhang_spikes`) side by side, with first-order removal.

    dh/dt = (w1 k c + w2 g) (h_max - h) - r h: k is Ghanbarzadeh's rate, c is 1 where solids rub, g and r are those of
    Zhang & Spikes, each at the node's temperature. With w1 = 0, w2 = 1 it is the one law; with w1 = 1, w2 = 0 it is the
    other without his removal (removal_thickness = 0), in whose place the first-order one stands: with
    k_r p v = k C3 / (h_max - C3) a film in contact settles where his does.
    """

    name: ClassVar[str] = "combined"
    source: ClassVar[str] = "sum of ghanbarzadeh and zhang_spikes, for Azam's thesis 2018, section 8.3; weights assumed"
    equations: ClassVar[Equations] = Equations(
        (
            "∂h_t/∂t = (w_1 k c + w_2 g) (h_{max} − h_t) − r h_t",
            "k = x k_B T/h_P,   g = (A/h_{max}) exp[−(E_0 − τ ΔV)/(k_B T)],   r = k_r p_s |v|",
        ),
        "c is 1 where solids rub, else 0. Stress lowers the barrier to zero at most.",
        options={"dose": {name: dose.equations for name, dose in DOSES.items()}},
        symbols={
            **_SYMBOLS,
            "w_1": "contact_weight",
            "w_2": "stress_weight",
            "x": "rate_factor",
            "c": "1 where solids rub, else 0 [1]",
        },
    )

    full_thickness: float = _full_thickness()
    contact_weight: float = parameter("", "w1, weight of growth in contacts", least=0.0, most=1e3)
    stress_weight: float = parameter("", "w2, weight of growth by shear stress", least=0.0, most=1e3)
    rate_factor: float = parameter("", "x, share of k_B T / h that forms film in contacts", least=0.0, most=1.0)
    fit_temperature: float = fit_temperature()
    prefactor: float = _prefactor()
    activation_energy: float = _activation_energy()
    activation_volume: float = _activation_volume("shear stress")
    removal_coefficient: float = _removal_coefficient()
    edge_weight: float = _edge_weight()
    least_shear: float = _least_shear()
    supply_rate: float = supply_rate()
    beyond_fit: str = beyond_fit()
    dose: str = parameter(
        "", "the time that the rates are for", choices=("contact_length", "residence"), default="contact_length"
    )

    @property
    def in_contacts(self) -> Ghanbarzadeh:
        """Law of the growth in contacts, without its removal."""
        fit, beyond = self.fit_temperature, self.beyond_fit
        dose = "contact_length"  # of constants by the time of tests
        return Ghanbarzadeh(self.full_thickness, self.rate_factor, 0.0, 0.0, fit, dose=dose, beyond_fit=beyond)

    @property
    def by_shear(self) -> ZhangSpikes:
        """Law of the growth by shear."""
        barrier = (self.prefactor, self.activation_energy, self.activation_volume)
        removal = (self.removal_coefficient, self.edge_weight)
        return ZhangSpikes(self.full_thickness, *barrier, *removal, least_shear=self.least_shear)

    def exposure(self, solid_pressure: Array, shear: Array, sliding_speed: float, temperature: Temperature) -> Array:
        """Return the weighted rate of growth over h_max [1/s] under solid pressure and total |shear stress| [Pa]."""
        node = (solid_pressure, shear, sliding_speed, temperature)
        in_contacts, by_shear = self.in_contacts.exposure(*node), self.by_shear.exposure(*node)
        return self.contact_weight * in_contacts + self.stress_weight * by_shear

    def covers(self, temperature: float) -> bool:
        in_contacts = self.contact_weight == 0.0 or self.in_contacts.covers(temperature)
        return in_contacts and (self.stress_weight == 0.0 or super().covers(temperature))

    def refusal(self, temperature: float) -> str:
        said = self.in_contacts.refusal(temperature) if self.contact_weight > 0.0 else ""
        if said or self.beyond_fit == "extrapolate" or self.covers(temperature):
            return said
        return (
            f"temperature = {temperature:g} K is outside {_COLDEST:g} K to {_HOTTEST:g} K, where the constants of "
            "growth by shear hold. Set tribofilm.stress_weight = 0, or tribofilm.beyond_fit = 'extrapolate', which "
            "takes that growth by its barrier."
        )
