"""Growth where solids touch, at any temperature between those of the fits."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from ...kernels.arrays import Array
from ...quantities import parameter
from ...reference.constants import BOLTZMANN
from ..elementary import Numbers, exp
from ..equations import Equations
from .doses import DOSES, OF_TESTS
from .fitted import Ghanbarzadeh, fit_temperature, supply_rate
from .relaxation import formed, mean, rubbed, taken

_BEYOND = 5.0  # K to either side of the fits


class Through(NamedTuple):
    """A law through constants fitted one temperature at a time, and by how much it misses them at most."""

    law: "Arrhenius"
    growth_rate: float  # |relative error|
    removal_rate: float  # |relative error|
    full_thickness: float  # |error| [m]
    removal_thickness: float  # |error| [m]


@dataclass(frozen=True)
class Arrhenius:
    """Growth to h_max at the rate k, removal up to C3 at the rate C4, with constants that depend on temperature.

    The form is that of `Ghanbarzadeh`. Both rates follow Arrhenius; h_max and C3 are linear in 1/T between the fits
    and stay as they are beyond. The exposure of a node in contact is k at its own temperature; over a time it adds up
    to k t. Removal has the ratio C4 / k of the mean temperature of the surface. What has grown or gone at one
    temperature stays so at another: a smaller h_max or C3 stops the one or the other and takes nothing back.
    """

    name: ClassVar[str] = "arrhenius"
    source: ClassVar[str] = (
        "form: Ghanbarzadeh et al. 2016, doi:10.1016/j.triboint.2014.12.018; dependence on temperature: assumed"
    )
    equations: ClassVar[Equations] = Equations(
        (
            "h_t = h_{max} [1 − exp(−k t)] − C_3 [1 − exp(−C_4 t)]",
            "k = k_0 exp[(E_k/k_B) (1/T_0 − 1/T)],   C_4 = C_{4,0} exp[(E_C/k_B) (1/T_0 − 1/T)]",
        ),
        "t is the time for which the point has been rubbed; h_max and C_3 are linear in 1/T between the fits.",
        options={"dose": OF_TESTS},
        symbols={
            "h_{max}": "full thickness, between full_thickness_from and full_thickness_to [m]",
            "C_3": "largest removed thickness, between removal_thickness_from and removal_thickness_to [m]",
            "C_4": "rate of removal [1/s]",
            "C_{4,0}": "removal_rate",
            "k_0": "growth_rate",
            "E_k": "activation_energy",
            "E_C": "removal_energy",
            "T_0": "fit_temperature",
            "t": "time for which the point has been rubbed [s]",
        },
    )
    abrades: ClassVar[bool] = False
    takes_abrasion: ClassVar[bool] = True

    fitted_from: float = parameter("K", "temperature of the fits at one end of their range", least=200.0, most=600.0)
    fitted_to: float = parameter("K", "temperature of the fits at its other end", least=200.0, most=600.0)
    fit_temperature: float = fit_temperature()
    growth_rate: float = parameter("s^-1", "k0, rate of growth at fit_temperature", least=1e-9, most=1.0)
    activation_energy: float = parameter("J", "E_k, barrier of the growth, per molecule", least=0.0, most=5e-19)
    removal_rate: float = parameter("s^-1", "C4 at fit_temperature, rate of removal", least=0.0, most=1.0)
    removal_energy: float = parameter("J", "E_C, barrier of the removal, per molecule", least=0.0, most=5e-19)
    full_thickness_from: float = parameter("m", "h_max at fitted_from", above=0.0, most=1e-5)
    full_thickness_to: float = parameter("m", "h_max at fitted_to", above=0.0, most=1e-5)
    removal_thickness_from: float = parameter("m", "C3 at fitted_from", least=0.0, most=1e-5)
    removal_thickness_to: float = parameter("m", "C3 at fitted_to", least=0.0, most=1e-5)
    dose: str = parameter("", "how long a node counts as rubbed", choices=tuple(DOSES), default="residence")
    contact_share: float = parameter(
        "",
        "share of the time for which a point was in solid contact in the tests of the fits, for dose = residence",
        above=0.0,
        most=1.0,
        default=7e-4,
    )
    supply_rate: float = supply_rate()
    beyond_fit: str = parameter(
        "", "what to do more than 5 K from all fits", choices=("refuse", "extrapolate"), default="refuse"
    )

    @classmethod
    def through(cls, fits: Sequence[Ghanbarzadeh], contact_share: float = 7e-4) -> Through:
        """Return the law through constants of one additive at two or more temperatures, by least squares in 1/T.

        It meets constants at two temperatures, and misses those at more by what is returned with it. Rates that fall
        with temperature get no barrier. ValueError at fewer than two temperatures, or for a rate of 0.
        """
        temperatures = np.array([fit.fit_temperature for fit in fits])
        if np.unique(temperatures).size < 2:
            raise ValueError("A dependence on temperature needs constants at two temperatures or more.")
        growing = np.array([float(fit.rate(fit.fit_temperature)) for fit in fits])
        taking = np.array([fit.removal_rate for fit in fits])
        if not (np.all(growing > 0.0) and np.all(taking > 0.0)):
            raise ValueError("rate_factor and removal_rate must be above 0: a rate of 0 has no barrier.")
        full = np.array([fit.full_thickness for fit in fits])
        taken = np.array([fit.removal_thickness for fit in fits])
        ends, middle = np.array([temperatures.min(), temperatures.max()]), float(np.median(temperatures))
        growth_rate, activation_energy = _barrier(temperatures, growing, middle)
        removal_rate, removal_energy = _barrier(temperatures, taking, middle)
        h_max, c_3 = (np.maximum(_line(temperatures, values, ends), 0.0) for values in (full, taken))
        law = cls(
            fitted_from=float(ends[0]),
            fitted_to=float(ends[1]),
            fit_temperature=middle,
            growth_rate=growth_rate,
            activation_energy=activation_energy,
            removal_rate=removal_rate,
            removal_energy=removal_energy,
            full_thickness_from=float(h_max[0]),
            full_thickness_to=float(h_max[1]),
            removal_thickness_from=float(c_3[0]),
            removal_thickness_to=float(c_3[1]),
            contact_share=contact_share,
        )
        found = [(law.rate(t), law.taking(t), law.largest(t), law.largest_removal(t)) for t in temperatures.tolist()]
        k, c_4, h, r = np.array(found).T
        return Through(
            law,
            _most(k / growing - 1.0),
            _most(c_4 / taking - 1.0),
            _most(h - full),
            _most(r - taken),
        )

    @property
    def full_thickness(self) -> float:
        """Largest thickness without removal at any temperature [m]."""
        return max(self.full_thickness_from, self.full_thickness_to)

    @property
    def most_exposure(self) -> float:
        return self.supply_rate / self.full_thickness

    def rate(self, temperature: Numbers) -> Numbers:
        """Return the rate k of growth [1/s] at a surface temperature [K], by the time of the tests."""
        return self.growth_rate * exp(self.activation_energy * self._warmth(temperature))

    def taking(self, temperature: Numbers) -> Numbers:
        """Return the rate C4 of removal [1/s] at a surface temperature [K]."""
        return self.removal_rate * exp(self.removal_energy * self._warmth(temperature))

    def largest(self, temperature: float) -> float:
        """Return h_max [m] at a surface temperature [K]."""
        return min(self._between(self.full_thickness_from, self.full_thickness_to, temperature), self.full_thickness)

    def largest_removal(self, temperature: float) -> float:
        """Return C3 [m] at a surface temperature [K]."""
        return self._between(self.removal_thickness_from, self.removal_thickness_to, temperature)

    def _warmth(self, temperature: Numbers) -> Numbers:
        return (1.0 / self.fit_temperature - 1.0 / temperature) / BOLTZMANN

    def _between(self, start: float, end: float, temperature: float) -> float:
        within = 1.0 / min(max(temperature, self._ends[0]), self._ends[1])
        whole = 1.0 / self.fitted_to - 1.0 / self.fitted_from
        return start if whole == 0.0 else start + (within - 1.0 / self.fitted_from) / whole * (end - start)

    @property
    def _ends(self) -> tuple[float, float]:
        return min(self.fitted_from, self.fitted_to), max(self.fitted_from, self.fitted_to)

    def exposure(self, solid_pressure: Numbers, shear: Numbers, sliding_speed: float, temperature: Numbers) -> Numbers:
        """Return the rate of growth [1/s] where solids touch, else 0; 0 without sliding.

        With the dose "residence" it is the rate while solids touch, else that of the tests' time.
        """
        if sliding_speed == 0.0:
            return np.zeros_like(solid_pressure)
        share = self.contact_share if self.dose == "residence" else 1.0
        return (solid_pressure > 0.0) * (self.rate(temperature) / share)

    def abrasion(self, solid_pressure: Array, sliding_speed: float | Array, position: Array | None) -> Array:
        """Return zeros in the shape of `solid_pressure`."""
        return np.zeros_like(solid_pressure)

    def evolve(
        self, growth: Array, removal: Array, exposed: Array, abraded: Array, temperature: float
    ) -> tuple[Array, Array]:
        """Return both variables [m] after each node has been `exposed`, k t; exact for any of it at one temperature.

        What is `abraded` leaves room to grow in.
        """
        limits, forming, losing = self._towards(growth, removal, exposed, temperature)
        return rubbed(growth, removal, limits, forming, losing, abraded)

    def formed(
        self, growth: Array, removal: Array, after: Array, exposed: Array, abraded: Array, temperature: float
    ) -> Array:
        """Return the film formed [m] while `growth` went to `after`; the rest as in `evolve`."""
        if not taken(abraded):
            return after - growth
        limits, forming, losing = self._towards(growth, removal, exposed, temperature)
        return formed(growth, after, limits[0], forming, abraded, mean(removal, limits[1], losing))

    def _towards(
        self, growth: Array, removal: Array, exposed: Array, temperature: float
    ) -> tuple[tuple[float, float], Array, Array]:
        """Return h_max and C3 [m], and both rates times the time; what is beyond its limit does not change."""
        limits = self.largest(temperature), self.largest_removal(temperature)
        ratio = self.taking(temperature) / self.rate(temperature)
        return limits, exposed * (growth < limits[0]), ratio * exposed * (removal < limits[1])

    def covers(self, temperature: float) -> bool:
        """Return True if `temperature` [K] is between the fits or within 5 K of them."""
        low, high = self._ends
        return low - temperature <= _BEYOND and temperature - high <= _BEYOND

    def refusal(self, temperature: float) -> str:
        if self.beyond_fit == "extrapolate" or self.covers(temperature):
            return ""
        low, high = self._ends
        return (
            f"temperature = {temperature:g} K is outside {low - _BEYOND:g} K to {high + _BEYOND:g} K, where the "
            f"tribofilm's constants hold (tribofilm.fitted_from = {self.fitted_from:g} K, tribofilm.fitted_to = "
            f"{self.fitted_to:g} K). Use a set fitted there, or tribofilm.beyond_fit = 'extrapolate', which takes the "
            "rates by their barriers and the thicknesses of the nearest fit."
        )


def _line(temperatures: Array, values: Array, at: Array) -> Array:
    """Return the straight line through values in 1/T, by least squares, at other temperatures [K]."""
    slope, level = np.polyfit(1.0 / temperatures - 1.0 / temperatures[0], values, 1)
    line: Array = level + slope * (1.0 / at - 1.0 / temperatures[0])
    return line


def _barrier(temperatures: Array, rates: Array, middle: float) -> tuple[float, float]:
    """Return the rate [1/s] at `middle` [K] and the barrier [J] of Arrhenius's line through rates."""
    cold, hot = 0.99 * middle, 1.01 * middle
    ends = _line(temperatures, np.log(rates), np.array([cold, middle, hot]))
    barrier = float(ends[2] - ends[0]) / (1.0 / cold - 1.0 / hot) * BOLTZMANN
    if barrier <= 0.0:
        return float(np.exp(np.log(rates).mean())), 0.0
    return float(np.exp(ends[1])), barrier


def _most(errors: Array) -> float:
    return float(np.max(np.abs(errors)))
