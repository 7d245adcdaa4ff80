"""What the assumptions of a scene are worth: half widths of its answers by the intervals of what it assumes.

Each interval's ends go through the regression level, on new surfaces at an operating point, one by one; the larger
change of an answer is the half width by that assumption, and they add as if they were independent. They are not in the
errors of `uncertainty`, which are those of solving the scene as it is.
"""

import math
from collections.abc import Mapping
from functools import lru_cache
from typing import NamedTuple

from . import regression
from .errors import ContactError
from .film import Regression
from .scene import Case, OperatingPoint, Scene
from .scene.intervals import replaced
from .state import initial_state

WEAR = "wear_depth"  # of both bodies together: their wear rate now
OUTPUTS = ("friction_coefficient", "h_c", "contact_load_ratio", WEAR)
HEADS = ("assumed", "between", "friction", "h_c", "W_c (absolute)", "wear rate")
_SHARE = "contact_load_ratio"
_LEAST = 1e-3  # half width that is told
_UNKNOWN = 1e3  # relative, of wear where nothing touches but may


class Assumption(NamedTuple):
    """Half width of an answer by what a scene assumes: relative, of contact_load_ratio absolute."""

    parts: Mapping[str, float]  # by the dotted key of what is assumed, the largest first

    @property
    def together(self) -> float:
        """Half width by all assumptions."""
        return math.hypot(*self.parts.values())


def assumed(scene: Scene, op: OperatingPoint) -> dict[str, Assumption]:
    """Return what the intervals of a scene are worth in each of `OUTPUTS` at an operating point.

    Raises ContactError if the regression level has no answer there. An end of an interval at which it has none counts
    for nothing.
    """
    return _assumed(scene.at_level(Regression.name), op)


def told(scene: Scene, op: OperatingPoint) -> list[tuple[str, ...]]:
    """Return rows for tables, headed by `HEADS`: each interval and its worth, the largest in friction first."""
    worth = assumed(scene, op)
    ranked = sorted(scene.intervals, key=lambda each: -worth[OUTPUTS[0]].parts.get(each.key, 0.0))
    rows = [
        (i.key, f"{i.least} to {i.most}", *(_text(o, worth[o].parts.get(i.key, 0.0)) for o in OUTPUTS)) for i in ranked
    ]
    return [*rows, ("together", "", *(_text(o, worth[o].together) for o in OUTPUTS))] if rows else []


def _text(output: str, half: float) -> str:
    if output == _SHARE:
        return f"{half:.2g}" if half >= _LEAST else "-"
    percent = f"{100.0 * half:.2g} %" if half < 1.0 else f"factor {1.0 + half:.2g}"
    return percent if half >= _LEAST else "-"


@lru_cache(maxsize=64)
def _assumed(scene: Scene, op: OperatingPoint) -> dict[str, Assumption]:
    here = _answers(scene, op)
    parts: dict[str, dict[str, float]] = {name: {} for name in OUTPUTS}
    for interval in scene.intervals:
        ends = [_answers_at(scene, op, interval.key, end) for end in interval.ends(scene)]
        for name in OUTPUTS:
            half = max((_change(name, here[name], end[name]) for end in ends if end), default=0.0)
            if half > 0.0:
                parts[name][interval.key] = half
    return {name: Assumption(dict(sorted(each.items(), key=lambda x: -x[1]))) for name, each in parts.items()}


def _answers_at(scene: Scene, op: OperatingPoint, key: str, value: float) -> dict[str, float] | None:
    try:
        return _answers(replaced(scene, key, value), op)
    except ContactError:
        return None


def _answers(scene: Scene, op: OperatingPoint) -> dict[str, float]:
    outputs = regression.advance(Case.bind(scene, op), initial_state(scene), 0.0)[1]
    wear = outputs.wear_rate_1 + outputs.wear_rate_2
    return {name: wear if name == WEAR else float(getattr(outputs, name)) for name in OUTPUTS}


def _change(name: str, here: float, there: float) -> float:
    change = abs(there - here)
    if name == _SHARE or change == 0.0:
        return change
    return min(change / here, _UNKNOWN) if here > 0.0 else _UNKNOWN
