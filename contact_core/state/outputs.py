"""The outputs of the core, and flags for answers that are less sure than usual."""

import math
from collections.abc import Mapping
from dataclasses import make_dataclass
from enum import IntFlag
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

from ..laws.base import Tribofilm
from ..laws.tribofilm import DOSES
from ..quantities import OF_CORE


class Error(NamedTuple):
    """Half widths (95 %) of the error of an output by each of its causes, in its unit."""

    time: float = 0.0  # steps in time: blocks
    sampling: float = 0.0  # the few instants at which a block is solved
    grid: float = 0.0  # distance of the nodes
    iteration: float = 0.0  # solutions that stop early, and time steps in which contacts begin and end
    curves: float = 0.0  # fitted curves of the regression level
    inlet: float = 0.0  # a domain that ends within the inlet

    @property
    def together(self) -> float:
        """Half width by all causes, as if they were independent."""
        return math.hypot(*self)

    def scaled(self, factor: float) -> "Error":
        """Return the error of the output times a factor."""
        return Error(*(abs(factor) * part for part in self))


_TYPES = {"Real": float, "Integer": int}


class RangeFlag(IntFlag):
    """Reasons why an answer is less sure than usual, in words by `text`; `Outputs.range_flags` is their sum."""

    text: str

    def __new__(cls, value: int, text: str = "") -> "RangeFlag":
        """Keep the sentence with the number."""
        flag = int.__new__(cls, value)
        flag._value_, flag.text = value, text
        return flag

    LAMBDA_CAPPED = 1, "no roughness or no load: lambda_ratio is at its cap or zero"
    TRIBOFILM_TEMPERATURE = 2, "outside the temperatures at which the constants of the tribofilm hold"
    INLET_UNRESOLVED = 4, "the grid is too coarse for the film in the inlet: the film depends on this grid"
    NOT_CONVERGED = 8, "over a tenth of the block's film solutions did not converge and were used as they were"
    FALLBACK = 16, "the dry solution replaced a film solution in part of the block"
    DOMAIN_EDGE = 32, "the contact or a wear scar reaches the edge of the grid, or a scar made at rest moves across it"
    FEW_NODES = 64, "fewer than 8 nodes across the Hertz contact at this load"
    SLOW_BODY = 128, "a block samples only part of the slower body's track: its tribofilm and wear are uneven along it"
    STIFF_WEAR = 256, "blocks are longer than the limit of stable wear: fine roughness and A_c are less sure"
    OUTSIDE_FIT = 512, "outside the points to which the curves of the regression level were fitted"
    OTHER_LEVEL = 1024, "outputs of the deterministic level alone keep their last values, or are zero"
    UNSURE = 2048, "friction or film is less sure than control.accuracy asks for, or without it than 50 %"
    BY_THE_CLOCK = (
        4096,
        (
            "tribofilm.dose is 'clock': where solids touch, the tribofilm ages by the time of the test, whatever load, "
            "speeds and film are"
        ),
    )
    SCUFFING = 8192, "risk of scuffing: the contact is, if only at an instant, hotter than the critical temperature"
    PITTED = (
        16384,
        (
            "micropits have broken out: when they begin is surer than how they grow, as elastic stress overstates what "
            "asperities bear"
        ),
    )
    WORN_SHAPE = (
        32768,
        (
            "wear is deeper than a tenth of the half width of the smooth contact: the bodies have another shape by now "
            "than the regression level gives them"
        ),
    )


if TYPE_CHECKING:

    class Outputs:
        """The output quantities of `quantities.OF_CORE`, in SI; zero by default."""

        __dataclass_fields__: ClassVar[dict[str, Any]]

        def __init__(self, **values: float) -> None: ...

        def __getattr__(self, name: str) -> Any: ...

else:
    Outputs = make_dataclass(
        "Outputs",
        [(q.name, _TYPES[q.kind], _TYPES[q.kind](0)) for q in OF_CORE],
        frozen=True,
        namespace={"__doc__": "The output quantities of `quantities.OF_CORE`, in SI; zero by default."},
    )
    Outputs.__module__ = __name__


def flags_of_tribofilm(law: Tribofilm, temperatures: tuple[float, float]) -> RangeFlag:
    """Return what makes a tribofilm less sure: its dose, and temperatures [K] of the bodies beyond its constants."""
    flags = RangeFlag.BY_THE_CLOCK if DOSES[law.dose].whole_pass else RangeFlag(0)
    covered = all(law.covers(temperature) for temperature in temperatures)
    return flags if covered else flags | RangeFlag.TRIBOFILM_TEMPERATURE


def flag_of_scuffing(ratio: float) -> RangeFlag:
    """Return SCUFFING where a scuffing ratio is above 1."""
    return RangeFlag.SCUFFING if ratio > 1.0 else RangeFlag(0)


def flag_of_pits(*broken: float) -> RangeFlag:
    """Return PITTED where anything has broken out of a body, by area or depth."""
    return RangeFlag.PITTED if any(each > 0.0 for each in broken) else RangeFlag(0)


_DEEP = 0.1  # of the half width: the flat on a body of 50 half widths' radius is about three times as wide as it


def flag_of_wear(half_width: float, *depths: float) -> RangeFlag:
    """Return WORN_SHAPE where wear [m] is too deep for a contact of that half width [m], which is 0 without load."""
    return RangeFlag.WORN_SHAPE if 0.0 < _DEEP * half_width < max(depths) else RangeFlag(0)


_ASKED = 0.5  # accuracy of a scene that asks for none


def flag_of_errors(errors: Mapping[str, float], accuracy: float | None) -> RangeFlag:
    """Return UNSURE if friction, film or W_c have errors above the accuracy asked for, by the outputs' names."""
    asked = _ASKED if accuracy is None else accuracy
    names = ("error_friction", "error_film", *(("error_load_ratio",) if accuracy is not None else ()))
    return RangeFlag.UNSURE if any(errors.get(name, 0.0) > asked for name in names) else RangeFlag(0)
