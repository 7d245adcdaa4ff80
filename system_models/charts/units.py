"""The units in which people read a quantity: nm, GPa, degC, minutes."""

import math
import re
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from contact_core.kernels.arrays import Array
from contact_core.quantities import CELSIUS

from .half_widths import digits_of

_DEGREES = "°C"
_PREFIXES = ((1e-9, "n"), (1e-6, "µ"), (1e-3, "m"), (1.0, ""), (1e3, "k"), (1e6, "M"), (1e9, "G"))
_PREFIXED = ("m", "Pa", "W", "N", "J", "N m")  # units that take a prefix
_SLOW = 1e-3  # m/s: smaller speeds take one, too
_VOLUME = 1e-18  # m3: a cubic micrometre
_TIMES = ((300.0, 1.0, "s"), (5.0 * 3600.0, 60.0, "min"), (math.inf, 3600.0, "h"))  # up to [s], in s, name
_MOST_DIGITS = 5  # after the point: longer numbers have an exponent
_NOTHING = 1e-9  # in the unit that people read
_OVERFLOW = 2.0  # a prefix serves from this many of its unit on
_EXPONENTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_RPM = 30.0 / math.pi


class Unit(NamedTuple):
    """A unit that people read: value = factor * SI + offset."""

    name: str  # empty for a number
    factor: float = 1.0
    offset: float = 0.0

    def of(self, values: ArrayLike) -> Array:
        return self.factor * np.asarray(values, dtype=float) + self.offset

    @property
    def label(self) -> str:
        """The unit in brackets, for an axis."""
        return f"[{self.name or '–'}]"


def unit_for(si: str, values: ArrayLike, difference: bool = False) -> Unit:
    """Return the unit that suits values in an SI unit; `difference`: of temperatures, which stay in K."""
    finite = np.abs(np.asarray(values, dtype=float))
    largest = float(finite[np.isfinite(finite)].max(initial=0.0))
    if si in ("1", ""):
        return Unit("")
    if si == "K":
        return Unit("K") if difference else Unit(_DEGREES, 1.0, -CELSIUS)
    if si in ("m3", "m3/s"):
        return Unit(si.replace("m3", "µm³"), 1.0 / _VOLUME)
    if si == "rad/s" and largest > _OVERFLOW:
        return Unit("rpm", _RPM)
    if si == "s":
        return time_unit(largest)
    if si == "Pa^-1":
        return Unit("GPa⁻¹", 1e9)
    if (si in _PREFIXED and largest > 0.0) or (si == "m/s" and 0.0 < largest < _SLOW):
        factor, prefix = _prefix(largest)
        return Unit(f"{prefix}{si}", 1.0 / factor)
    return Unit(printed(si))


def printed(si: str) -> str:
    """Return a unit with its exponents as people write them: "m2/s" is "m²/s"."""
    return re.sub(r"(?<=[A-Za-z])\^?(-?\d)", lambda found: found[1].translate(_EXPONENTS), si)


def _prefix(largest: float) -> tuple[float, str]:
    """Return the largest prefix of which there are some in a value, else the smallest."""
    fitting = [each for each in _PREFIXES if largest >= _OVERFLOW * each[0]]
    return fitting[-1] if fitting else _PREFIXES[0]


def time_unit(end: float) -> Unit:
    """Return the unit of time in which people read a run up to `end` [s]."""
    return next(Unit(name, 1.0 / factor) for most, factor, name in _TIMES if end <= most)


def negligible(value: float) -> bool:
    """Return True for a number in the unit people read that is as good as none."""
    return abs(value) < _NOTHING


def stated(value: float, half: float | None = None) -> str:
    """Return a number as text, with the half width of its error where there is one, to its first digits."""
    if not math.isfinite(value):
        return "not known"
    if negligible(value) and (half is None or negligible(half)):
        return "0"
    if half is None or half == 0.0:
        return f"{value:.4g}"
    if not math.isfinite(half):
        return f"{value:.3g} ± ?"
    if digits_of(half) > _MOST_DIGITS:
        return f"{value:.2g} ± {half:.1g}"
    digits = max(digits_of(half), 0)
    return f"{value:.{digits}f} ± {half:.{digits}f}"
