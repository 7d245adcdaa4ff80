"""Growth and removal of the tribofilm.

A law carries two internal variables per node and body: `growth` (what tribochemistry has formed) and `removal` (what
rubbing has taken). They are autonomous, so a state needs no age and may be cut and continued anywhere.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.constants import Boltzmann, Planck

from ..quantities import parameter

Array = NDArray[np.float64]


@dataclass(frozen=True)
class NoTribofilm:
    """No additive: nothing grows."""

    name: ClassVar[str] = "none"
    source: ClassVar[str] = ""
    full_thickness: ClassVar[float] = 1.0  # any positive number: the thickness is always zero

    def evolve(self, growth: Array, removal: Array, rubbing_time: Array, temperature: float) -> tuple[Array, Array]:
        """Return both variables as they are."""
        return growth, removal

    def covers(self, temperature: float) -> bool:
        """Whether the constants hold at `temperature` [K]."""
        return True


@dataclass(frozen=True)
class Ghanbarzadeh:
    """Growth to h_max at the rate k = (k_B T / h) x, removal up to C3 at the rate C4: thickness = growth - removal.

    In closed form for a node rubbed for a time t: h = h_max [1 - exp(-k t)] - C3 [1 - exp(-C4 t)].
    `dose` says how long a node is rubbed in a block of test time: "clock", the whole block if it touched the other body
    in any pass (the constants were fitted that way); "contact_length", in proportion to the length of solid contact
    in a pass.
    """

    name: ClassVar[str] = "ghanbarzadeh"
    source: ClassVar[str] = "Ghanbarzadeh et al. 2016, doi:10.1016/j.triboint.2014.12.018"

    full_thickness: float = parameter("m", "h_max, thickness without removal", above=0.0, most=1e-5)
    rate_factor: float = parameter("", "x, share of k_B T / h that forms film", least=0.0, most=1.0)
    removal_thickness: float = parameter("m", "C3, largest removed thickness", least=0.0, most=1e-5)
    removal_rate: float = parameter("s^-1", "C4, rate of removal", least=0.0, most=1.0)
    fit_temperature: float = parameter("K", "temperature at which the constants were fitted", least=200.0, most=600.0)
    dose: str = parameter("", "how long a node counts as rubbed", choices=("clock", "contact_length"), default="clock")

    def rate(self, temperature: float) -> float:
        """Rate k of growth [1/s] at `temperature` [K]."""
        return Boltzmann * temperature / Planck * self.rate_factor

    def evolve(self, growth: Array, removal: Array, rubbing_time: Array, temperature: float) -> tuple[Array, Array]:
        """Both variables [m] after each node was rubbed for `rubbing_time` [s]; exact for any time."""
        formed = -np.expm1(-self.rate(temperature) * rubbing_time)
        taken = -np.expm1(-self.removal_rate * rubbing_time)
        return growth + (self.full_thickness - growth) * formed, removal + (self.removal_thickness - removal) * taken

    def covers(self, temperature: float) -> bool:
        """Whether `temperature` [K] is within 5 K of the fit: T enters the rate only by +-6 % from 60 to 100 degC."""
        return abs(temperature - self.fit_temperature) <= 5.0


def thickness(growth: Array, removal: Array) -> Array:
    """Film thickness [m]."""
    return np.maximum(growth - removal, 0.0)


LAWS = (NoTribofilm, Ghanbarzadeh)
