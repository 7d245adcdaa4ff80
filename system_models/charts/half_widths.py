"""Values with the half widths of their errors as text, and which of them say nothing."""

import math
from collections.abc import Iterable
from typing import NamedTuple

from contact_core.quantities import ABSOLUTE, STATED

SHARES = frozenset(output for output, error in STATED.items() if error in ABSOLUTE)  # from 0 to 1: errors are absolute
UNKNOWN = "unknown"  # in place of a value whose half width says nothing


def digits_of(half: float) -> int:
    """Return the digits after the point to which a half width is read: its first one, of one that begins with 1 two.

    Negative where it is 10 or more.
    """
    first = math.floor(math.log10(half))
    return -first + (1 if half < 2.0 * 10.0**first else 0)


def with_error(value: float, half: float, digits: int) -> str:
    """Return a value and the half width of its error as text, "0.106 +- 0.004", to the first digits of the error.

    There are at most so many digits after the point.
    """
    if not 0.0 < half < math.inf:
        return f"{value:.{digits}f}" + (" +- ?" if half else "")
    if half < 0.5 * 10.0**-digits:
        return f"{value:.{digits}f} +- <{10.0**-digits:.{digits}f}"
    places = min(max(digits_of(half), 0), digits)
    return f"{value:.{places}f} +- {half:.{places}f}"


def says_nothing(output: str, value: float, half: float) -> bool:
    """Return True if a half width leaves all open: it has no end, or it covers all that a share can be."""
    return not half < math.inf or (output in SHARES and value - half <= 0.0 and value + half >= 1.0)


def cell(output: str, value: float, half: float, digits: int) -> str:
    """Return an output in a table, with its half width: UNKNOWN if that says nothing; value and half in one unit."""
    return UNKNOWN if says_nothing(output, value, half) else with_error(value, half, digits)


class Column(NamedTuple):
    """A column of a printed table: an output in the unit that people read."""

    heading: str
    unit: str
    name: str  # of the output, behind that of a part
    factor: float  # from SI
    digits: int

    @property
    def title(self) -> str:
        """The heading with its unit."""
        return f"{self.heading} [{self.unit}]" if self.unit else self.heading

    def cells(self, values: Iterable[float], halves: Iterable[float] | None = None) -> list[str]:
        """Return values in SI as text, with half widths where there are some."""
        if halves is None:
            return [f"{self.factor * value:.{self.digits}f}" for value in values]
        output, pairs = self.name.rpartition(".")[2], zip(values, halves, strict=True)
        return [cell(output, self.factor * value, self.factor * half, self.digits) for value, half in pairs]
