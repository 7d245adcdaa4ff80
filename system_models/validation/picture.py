"""The picture of outcomes: every number by its distance from the reference."""

from collections.abc import Mapping

import numpy as np

from ..charts.chart import BLACK, GREEN, GREY, NOTHING, ORANGE, RED, SKY, Chart, Line, Sheet
from .model import Comparison, Outcome, Row, Verdict

COLOURS = {
    Verdict.AGREES: GREEN,
    Verdict.WITHIN_ERROR: SKY,
    Verdict.EXPLAINED: ORANGE,
    Verdict.DISAGREES: RED,
    Verdict.NOT_JUDGED: GREY,
}
_FARTHEST = 5.0  # of what is allowed: points beyond it stand at the edge


def distance(row: Row) -> float:
    """Return the deviation over what is allowed, within the picture; the edge where nothing is allowed."""
    if row.deviation == 0.0:
        return 0.0
    over = row.deviation / row.allowed if row.allowed else np.copysign(np.inf, row.deviation)
    return float(np.clip(np.nan_to_num(over, nan=_FARTHEST), -_FARTHEST, _FARTHEST))


def overview(comparisons: Mapping[str, Comparison], outcomes: Mapping[str, Outcome]) -> Sheet:
    """Return the distance of every number from its reference, in units of what is allowed."""
    listed = [(name, row) for name, outcome in outcomes.items() for row in outcome.rows]
    lines, names, notes, at, last = [], {}, [], 0.0, ""
    for name, row in listed:
        at += 1.4 if name != last and last else 1.0
        if name != last:
            notes.append((_FARTHEST + 0.25, at, f"{name}\n{comparisons[name].kind}"))
        last, far, colour = name, distance(row), COLOURS[row.verdict]
        mark = "<" if far <= -_FARTHEST else ">" if far >= _FARTHEST else "o"
        lines.append(Line("", np.array([0.0, far]), np.array([at, at]), colour=colour))
        lines.append(Line("", np.array([far]), np.array([at]), colour=colour, style=mark))
        names[at] = row.quantity
    words = "off by / allowed (shaded: uncertainty of the reference and stated error together; arrows: farther)"
    zero = Line("", np.zeros(2), np.array([0.0, at + 1.0]), colour=BLACK, faint=0.4)
    drawn = Chart(
        "", words, "", [zero, *lines], shaded=[(-1.0, 1.0)], downward=True, y_names=names, notes=notes,
        x_range=(-_FARTHEST - 0.15, _FARTHEST + 0.15), y_range=(0.0, at + 1.0),
    )  # fmt: skip
    found = {row.verdict for _, row in listed}
    key = [Line(each, NOTHING, NOTHING, colour=COLOURS[each], style="o") for each in Verdict if each in found]
    return Sheet([drawn], columns=1, width=11.0, height=1.0 + 0.21 * len(listed) + 0.3 * len(outcomes), key=key)
