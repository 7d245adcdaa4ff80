"""Risk of scuffing: the hottest spot of a contact against a critical temperature."""

from dataclasses import dataclass
from typing import ClassVar

from ..quantities import parameter
from .base import Scuffing
from .equations import Equations

_MOST = 1e3  # ratio where the oil itself is as hot as critical


@dataclass(frozen=True)
class NoScuffing:
    """The risk of scuffing is not computed."""

    name: ClassVar[str] = "none"
    source: ClassVar[str] = ""
    equations: ClassVar[Equations] = Equations(
        ("S = 0",),
        symbols={
            "S": "scuffing_ratio [1]",
        },
        left_out="Risk of scuffing: scuffing_ratio is zero, however hot the contact is.",
    )
    judges: ClassVar[bool] = False

    def ratio(self, contact: float, oil: float) -> float:
        """Return 0: no temperature is critical."""
        return 0.0


@dataclass(frozen=True)
class CriticalTemperature:
    """Blok's postulate: a contact scuffs where it is hotter than a constant of oil and steel.

    The ratio is the inverse of the safety of ISO/TR 13989-1:2000, equation (100), by the contact temperature of the
    scene's law of heat. Where the oil itself is as hot as critical, it is 1000 for a hotter contact and 0 for a cooler
    one. Oils with additives that react keep to no constant: by the standard theirs is higher where the contact lasts a
    few microseconds.
    """

    name: ClassVar[str] = "critical_temperature"
    source: ClassVar[str] = (
        "Blok 1937, General Discussion on Lubrication, Inst. Mech. Engrs 2, 222 (from memory); Blok, Wear 6 (1963) "
        "483; ratio: inverse of the safety of ISO/TR 13989-1:2000, equation (100)"
    )
    equations: ClassVar[Equations] = Equations(
        ("S = (T_{max} − T_{oil})/(T_{crit} − T_{oil}),   0 ≤ S ≤ 1000",),
        "S > 1: the largest temperature of the surfaces is above the critical one.",
        symbols={
            "S": "scuffing_ratio [1]",
            "T_{max}": "contact_temperature_max [K]",
            "T_{crit}": "temperature",
        },
    )
    judges: ClassVar[bool] = True

    temperature: float = parameter(
        "K", "critical temperature of the contact, of oil and solids together", least=250.0, most=1500.0
    )

    def ratio(self, contact: float, oil: float) -> float:
        """Return the rise of a contact temperature [K] over the oil's, over the critical rise: above 1 it scuffs."""
        if contact == self.temperature:
            return 1.0
        if oil >= self.temperature:
            return _MOST if contact > self.temperature else 0.0
        return min(max((contact - oil) / (self.temperature - oil), 0.0), _MOST)


LAWS: tuple[type[Scuffing], ...] = (NoScuffing, CriticalTemperature)
