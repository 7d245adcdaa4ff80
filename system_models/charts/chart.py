"""A chart as a record: lines with their errors, marks or a map on two axes; and a sheet of charts, one picture."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from contact_core.kernels.arrays import Array, Mask

Spans = Sequence[tuple[float, float]]

# of Okabe and Ito, which the colour-blind can tell apart; dashes tell lines apart without colours
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#E69F00", "#56B4E9")
BLUE, RED, GREEN, PURPLE, BLACK, ORANGE, SKY = COLOURS
GREY = "#7b858f"
DASHES = ("", "7 3", "2 3", "9 3 2 3", "12 4", "4 4", "1 2")
NOTHING = np.empty(0)
INDEXED = re.compile(r"(?<![\w.])([^\W\d_])_(\w+)")  # symbols: h_c, W_c


@dataclass(frozen=True)
class Line:
    """A line, marks or an area, in the units of its chart; without a label it is not in the key."""

    label: str
    x: Array
    y: Array
    half: Array | None = None  # half width of the error: a band around a line, bars at marks alone
    place: int = 0  # in COLOURS and DASHES
    colour: str = ""  # in place of that one, without dashes
    style: str = "-"  # "-", "--" or ":", "o", "s", "x" or "." for marks, or both; "h" for hollow marks
    # "|-" has stairs that end at points, "-|" some that begin there
    faint: float = 1.0  # opacity
    below: Array | None = None  # the other edge of an area in place of the line
    right: bool = False  # whether its values are read on the right

    @property
    def ink(self) -> str:
        """The colour that it is drawn in."""
        return self.colour or COLOURS[self.place % len(COLOURS)]

    @property
    def dash(self) -> str:
        """The dash of its line; empty for marks alone."""
        return self.style.strip("osx.<>|h")

    @property
    def mark(self) -> str:
        """The mark at its points; empty for a line alone."""
        return self.style.strip("-:|h")

    @property
    def hollow(self) -> bool:
        return "h" in self.style


@dataclass(frozen=True)
class Map:
    """Values in colours over an area."""

    values: Array  # [y, x]
    x: tuple[float, float]  # edges
    y: tuple[float, float]
    unit: str
    colours: str  # name of matplotlib
    low: float
    top: float  # peaks may be beyond it
    logarithmic: bool = False
    keyed: bool = True  # whether its colours are explained beside it
    ring: tuple[float, float] | None = None  # half widths of an ellipse around the middle


@dataclass(frozen=True)
class Chart:
    """A chart: its title, axes with their units, what is drawn, and what marks it; `h_c` in a label has an index."""

    title: str
    x_label: str
    y_label: str
    lines: Sequence[Line] = ()
    caption: str = ""
    shaded: Spans = ()  # spans of x that are marked
    logarithmic: bool = False
    from_zero: bool = True  # the axis begins at zero if no value is below
    downward: bool = False  # the axis of y runs down, as depths do
    most: float | None = None  # that a value can be: bands are shown up to there, however tall
    logarithmic_x: bool = False
    dark: Spans = ()  # spans of x that are not valid
    levels: Sequence[float] = ()  # values of y with a thin line
    places: Mapping[str, float] = field(default_factory=dict)  # of x with a thin line and their names
    x_range: tuple[float, float] | None = None  # in place of that of the lines
    y_range: tuple[float, float] | None = None
    x_names: Mapping[float, str] = field(default_factory=dict)  # in place of numbers along x
    y_names: Mapping[float, str] = field(default_factory=dict)
    notes: Sequence[tuple[float, float, str]] = ()  # words at places
    right_label: str = ""
    key: str = ""  # heading of the key
    map: Map | None = None
    polar: bool = False  # x is an angle [rad] from the bottom

    @property
    def keyed(self) -> list[Line]:
        """The lines in the key: there is none for one line alone, unless it has a heading."""
        named = [line for line in self.lines if line.label]
        return named if len(named) > 1 or self.key else []


@dataclass(frozen=True)
class Sheet:
    """Charts in one picture, row by row; None leaves a place empty."""

    charts: Sequence[Chart | None]
    title: str = ""
    columns: int = 2
    width: float = 4.8  # of a chart [in]
    height: float = 2.6
    heights: Sequence[float] = ()  # of the rows, in place of that
    key: Sequence[Line] = ()  # for all charts
    key_title: str = ""


def shades(count: int, colours: str = "viridis", first: float = 0.0, last: float = 0.9) -> list[str]:
    """Return so many colours from one end of a map of colours to the other, as "#rrggbb"."""
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    return [to_hex(colormaps[colours](share)) for share in np.linspace(first if count > 1 else last, last, count)]


def spans_of(x: Array, marked: Mask) -> list[tuple[float, float]]:
    """Return the stretches of x of marked rows, one a row, each from the row before."""
    return [(float(x[k - 1]), float(x[k])) for k in np.flatnonzero(marked[1:]) + 1]
