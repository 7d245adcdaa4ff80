"""Records of a comparison: what was found by others, what is computed here, and the verdict on each number."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

from contact_core.kernels.arrays import Array

from ..charts.chart import BLACK, Chart, Line

_FEW = 10  # points that are marked


class Kind(StrEnum):
    """What the answers are compared with, the strongest evidence first."""

    MEASURED = "measured"
    NUMERICAL = "published numerical"
    CLOSED_FORM = "closed form"
    THESIS = "thesis (simulation)"


class Verdict(StrEnum):
    """Verdict on a number."""

    AGREES = "agrees"  # within the uncertainty of the reference
    WITHIN_ERROR = "within stated error"  # of reference and answer together
    EXPLAINED = "disagrees, cause known"
    DISAGREES = "disagrees"
    NOT_JUDGED = "not judged"


@dataclass(frozen=True)
class Cause:
    """Why a number differs, and the answers [in the row's unit] that this explains."""

    text: str
    least: float
    largest: float

    def explains(self, value: float) -> bool:
        """Return whether an answer is as this cause would have it."""
        return self.least <= value <= self.largest


@dataclass(frozen=True)
class Row:
    """A number found by others beside the one computed here, both in `unit`.

    `reference` is a value twice, or the least and the largest of a range. `uncertainty` is the half width that the
    reference may be wrong by, for the `reason` given; `stated_error` is the one that the computation states of itself.
    """

    quantity: str
    unit: str
    reference: tuple[float, float]
    computed: float
    uncertainty: float
    reason: str
    stated_error: float = 0.0
    cause: Cause | None = None
    not_judged: str = ""  # why no verdict can be given

    @property
    def deviation(self) -> float:
        """What the answer lies above (+) or below (-) the reference, 0 within its range."""
        low, high = self.reference
        return self.computed - min(max(self.computed, low), high)

    @property
    def allowed(self) -> float:
        """Uncertainty and stated error together."""
        return self.uncertainty + self.stated_error

    @property
    def verdict(self) -> Verdict:
        """Verdict; an answer that is no number disagrees."""
        if self.not_judged:
            return Verdict.NOT_JUDGED
        off = abs(self.deviation)
        if off <= self.uncertainty:
            return Verdict.AGREES
        if off <= self.allowed:
            return Verdict.WITHIN_ERROR
        if self.cause is not None and self.cause.explains(self.computed):
            return Verdict.EXPLAINED
        return Verdict.DISAGREES


def exactly(value: float) -> tuple[float, float]:
    return value, value


def compared(
    title: str,
    x_label: str,
    y_label: str,
    reference: tuple[Array, Array],
    computed: tuple[Array, Array],
    deviations: Array | None = None,
    logarithmic: bool = False,
) -> Chart:
    """Return a reference and an answer over the same axis; `deviations`: standard deviations of the reference."""
    lines = [
        Line("reference", *reference, deviations, colour=BLACK, style="o"),
        Line("computed", *computed, style="o-" if computed[0].size < _FEW else "-"),
    ]
    return Chart(title, x_label, y_label, lines, logarithmic=logarithmic, logarithmic_x=logarithmic, from_zero=False)


@dataclass(frozen=True)
class Outcome:
    """Rows and curves of a comparison that has been run, or why it could not be."""

    rows: tuple[Row, ...]
    curves: tuple[Chart, ...] = ()
    failure: str = ""

    @property
    def unexplained(self) -> bool:
        """Whether something disagrees without a known cause."""
        return bool(self.failure) or any(row.verdict is Verdict.DISAGREES for row in self.rows)

    @property
    def verdict(self) -> Verdict:
        """The worst verdict of all rows that are judged."""
        if self.unexplained:
            return Verdict.DISAGREES
        found = {row.verdict for row in self.rows}
        ranked = (Verdict.EXPLAINED, Verdict.WITHIN_ERROR, Verdict.AGREES)
        return next((verdict for verdict in ranked if verdict in found), Verdict.NOT_JUDGED)


@dataclass(frozen=True)
class Comparison:
    """What is compared with whose numbers."""

    title: str
    kind: Kind
    about: str
    source: str  # with "doi:..." where there is one
    run: Callable[[], Outcome]
    licence: str = ""  # of numbers that are shipped


def relative(value: float, share: float) -> float:
    """Return a share of a value, as a half width."""
    return abs(value) * share


def rounding(*parts: tuple[float, float, float]) -> float:
    """Return the relative half width of a product of powers of printed numbers: (value, last digit, exponent) each.

    A printed number is right to half a unit of its last digit; the parts are independent of each other.
    """
    return math.sqrt(sum((exponent * 0.5 * digit / value) ** 2 for value, digit, exponent in parts))
