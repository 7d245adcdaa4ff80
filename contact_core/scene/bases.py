"""Families of base oils: pressure coefficient and its law, and shear stresses, by two viscosities and a family.

The numbers are those of data/bases.toml.
"""

import math
import tomllib
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib.resources import files
from typing import Any

from ..errors import SceneError, did_you_mean
from ..laws.viscosity import AstmD341

USUAL = "mineral"
# Gold's coefficient over measured secants from 0 to 0.2 GPa: 19 points of FVA 3, FVA 3A, M100 and PAO100, +-0.037
_OF_SECANT, _SECANT_TO = 0.956, 0.2  # [1], [GPa]
# K: of the limiting coefficient; amid the temperatures of use; of the Eyring stress
_COLD, _WARM, _HOT = 313.15, 343.15, 353.15
_ROELANDS = 138.0  # K, of his slope index


@dataclass(frozen=True)
class Steep:
    """What oils of a family have whose viscosity falls fast with temperature, by Roelands' slope index."""

    index: float  # from which on an oil is steep
    rise: float  # of the coefficient over the usual one, with the index
    most: float  # of the coefficient over the usual one
    bend: float  # over the usual one, of the steepest

    def by(self, sheet: AstmD341) -> tuple[float, float]:
        """Return coefficient and bend of an oil over the usual ones."""
        hot = 373.15
        fall = float(sheet.log_viscosity(_COLD) / sheet.log_viscosity(hot))
        index = math.log(fall) / math.log((hot - _ROELANDS) / (_COLD - _ROELANDS))
        more = min(max(1.0 + self.rise * (index - self.index), 1.0), self.most)
        return more, 1.0 - (1.0 - self.bend) * (more - 1.0) / (self.most - 1.0)


@dataclass(frozen=True)
class Base:
    """A family of base oils."""

    source: str
    gold: float  # pressure coefficient of an oil of 1 mm2/s [1/GPa]
    gold_exponent: float
    bend_40: float
    bend_100: float
    interval: float  # relative half width of the pressure coefficient
    limiting_coefficient: float
    limiting_interval: tuple[float, float]
    conductivity: float  # [W/(m K)]
    conductivity_interval: tuple[float, float]
    limiting_fall: float  # of the limiting coefficient with temperature [1/K]
    limiting_fall_interval: tuple[float, float]
    conductivity_rise: float  # with pressure [1/GPa]
    conductivity_bend: float  # [1/GPa]
    steep: Steep | None = None

    def oil(self, sheet: AstmD341) -> AstmD341:
        """Return the oil of a data sheet with this family's pressure coefficient and bends.

        Gold's coefficient is taken for the secant of ln(viscosity) from 0 to 0.2 GPa at 70 degC, from which the
        modulus equation gives the slope at p = 0. Oils that thin faster with heat have more, and less bend.
        """
        warm = float(sheet(0.0, _WARM)) / float(sheet.density_at(_WARM))
        more, bend = self.steep.by(sheet) if self.steep else (1.0, 1.0)
        bent = replace(sheet, bend_40=bend * self.bend_40, bend_100=bend * self.bend_100)
        secant = more * self.gold * (1e6 * warm) ** self.gold_exponent / _OF_SECANT
        slope = 1.0 / (1.0 / secant - 0.5 * (bent.bend_40 + bent.bend_100) * _SECANT_TO)
        reference = sheet.log_viscosity(sheet.reference_temperature) / sheet.log_viscosity(_WARM)
        return replace(bent, pressure_coefficient=1e-9 * slope * float(reference))

    def eyring_stress(self, oil: AstmD341) -> float:
        """Return the Eyring stress [Pa] of an oil: 2 limiting coefficients over its secant to 1 GPa, both at 80 degC.

        Bair & Winer, J. Tribol. 112 (1990) 245, with the coefficient under pressure as Arana, Larranaga & Ulacia 2019,
        doi:10.1177/1350650118778655, equation 13, have it.
        """
        secant = 1e-9 * math.log(float(oil(1e9, _HOT)) / float(oil(0.0, _HOT)))
        return 2.0 * self.limiting_coefficient * math.exp(-self.limiting_fall * (_HOT - _COLD)) / secant


@lru_cache(maxsize=1)
def _bases() -> dict[str, Base]:
    text = (files("contact_core") / "data" / "bases.toml").read_text("utf-8")
    tables: dict[str, dict[str, Any]] = tomllib.loads(text)
    steep = {name: {"steep": Steep(**table["steep"])} for name, table in tables.items() if "steep" in table}
    return {name: Base(**table | steep.get(name, {})) for name, table in tables.items()}


def base_of(name: Any) -> Base:
    """Return a family of base oils by name, in capitals or not. Raises SceneError for an unknown one."""
    known = _bases()
    if str(name).lower() not in known:
        raise SceneError(
            f"lubricant.base = {name!r} is no family of base oils.{did_you_mean(str(name), list(known))} Known are "
            f"{', '.join(known)}."
        )
    return known[str(name).lower()]
