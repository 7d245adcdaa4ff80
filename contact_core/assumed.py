"""What the assumptions of a scene are worth: half widths of its answers by the intervals of what it assumes.

Each end goes through the regression level, on new surfaces; half widths add as if independent. `uncertainty` has none.
"""

import math
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

from . import regression
from .errors import ContactError
from .film import Regression
from .scene import Case, OperatingPoint, Scene
from .scene.intervals import Interval, applicable, replaced
from .state import ContactState, initial_state

WEAR = "wear_depth"  # of both bodies together: their wear rate now
TRIBOFILM = "tribofilm"  # of both bodies together: their growth now
RATES = (WEAR, TRIBOFILM)  # outputs whose half widths are relative to their rates
OUTPUTS = ("friction_coefficient", "h_c", "contact_load_ratio", *RATES)
HEADS = ("assumed", "between", "friction", "h_c", "W_c", "wear rate", "tribofilm")
Answers = Mapping[str, float]  # outputs by name; of those called as one of RATES, changes count relative
_FILM = "h_c"
# half widths that are told: of friction and shares, of films [m], of rates relative
LEAST = {"friction_coefficient": 1e-4, _FILM: 1e-10, "contact_load_ratio": 1e-3, WEAR: 1e-3, TRIBOFILM: 1e-3}
_UNKNOWN = 1e3  # relative half width of an output that is zero now but need not be
_MOMENT = 1e-3  # s: in which a tribofilm is seen to grow


class Assumption(NamedTuple):
    """Half width of an answer by what a scene assumes: in the unit of the answer, of wear and tribofilm relative."""

    parts: Mapping[str, float]  # by the dotted key of what is assumed, the largest first

    @property
    def together(self) -> float:
        """Half width by all assumptions."""
        return math.hypot(*self.parts.values())


@lru_cache(maxsize=64)
def assumed(scene: Scene, op: OperatingPoint) -> Mapping[str, Assumption]:
    """Return what the intervals of a scene are worth in each of `OUTPUTS` at an operating point.

    Raises ContactError if the regression level has no answer there. An end of an interval at which it has none counts
    for nothing.
    """
    case = Case.bind(scene.at_level(Regression.name), op)
    ends = {each.key: [[_answers_at(case, end) for end in each.ends(scene)]] for each in applicable(scene)}
    return half_widths(_answers(case), ends)


def half_widths(here: Answers, ends: Mapping[str, Sequence[Sequence[Answers | None]]]) -> dict[str, Assumption]:
    """Return what assumptions are worth in each answer, by the answers as it is and at both ends of what each assumes.

    Of an assumption of several numbers there are such pairs for each. None: there is no answer, and it counts nothing.
    """
    found: dict[str, Assumption] = {}
    for name, value in here.items():
        halves = {key: math.hypot(*(_half(name, value, pair) for pair in pairs)) for key, pairs in ends.items()}
        ranked = sorted(halves.items(), key=lambda each: -each[1])
        found[name] = Assumption({key: half for key, half in ranked if half > 0.0})
    return found


def _half(name: str, here: float, ends: Sequence[Answers | None]) -> float:
    """Return the larger change of an answer to either end."""
    return max((_change(name, here, end[name]) for end in ends if end), default=0.0)


def told(intervals: Sequence[Interval], worth: Mapping[str, Assumption]) -> list[tuple[str, ...]]:
    """Return rows for tables, headed by `HEADS`: each interval and its worth, the largest in friction first."""
    ranked = sorted(intervals, key=lambda each: -worth[OUTPUTS[0]].parts.get(each.key, 0.0))
    rows = [
        (
            each.key,
            f"{each.least} to {each.most}",
            *(text(name, worth[name].parts.get(each.key, 0.0)) for name in OUTPUTS),
        )
        for each in ranked
    ]
    return [*rows, ("together", "", *(text(name, worth[name].together) for name in OUTPUTS))] if rows else []


def text(output: str, half: float) -> str:
    """Return a half width as text, in words if it is a factor."""
    if half < LEAST[output]:
        return "-"
    if output == _FILM:
        return f"{1e9 * half:.2g} nm"
    if output not in RATES:
        return f"{half:.2g}"
    return f"{100.0 * half:.2g} %" if half < 1.0 else f"a factor of {1.0 + half:.2g}"


def _answers_at(case: Case, values: Mapping[str, float]) -> dict[str, float] | None:
    scene = case.scene
    for key, value in values.items():
        scene = replaced(scene, key, value)
    try:
        return _answers(Case.bind(scene, case.op))
    except ContactError:
        return None


def _answers(case: Case) -> dict[str, float]:
    state = initial_state(case.scene)
    outputs = regression.advance(case, state, 0.0)[1]
    rates = {WEAR: outputs.wear_rate_1 + outputs.wear_rate_2, TRIBOFILM: _growth(case, state)}
    return {name: rates[name] if name in RATES else float(getattr(outputs, name)) for name in OUTPUTS}


def _growth(case: Case, state: ContactState) -> float:
    """Return how fast the tribofilms of both bodies grow together [m/s]."""
    if case.scene.tribofilm.most_exposure == 0.0:  # nothing grows
        return 0.0
    soon = regression.advance(case, state, _MOMENT)[1]
    return float(soon.tribofilm_grown_1 + soon.tribofilm_grown_2) / _MOMENT


def _change(name: str, here: float, there: float) -> float:
    change = abs(there - here)
    if name.rpartition(".")[2] not in RATES or change == 0.0:
        return change
    return min(change / here, _UNKNOWN) if here > 0.0 else _UNKNOWN
