"""Values with the half widths of their errors as text, and which of them say nothing."""

import math

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
