"""Pictures of outcomes: every number by its distance from the reference, and curves beside measured points."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from .model import Comparison, Curve, Outcome, Row, Verdict

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = {  # of Okabe and Ito
    Verdict.AGREES: "#009E73",
    Verdict.WITHIN_ERROR: "#56B4E9",
    Verdict.EXPLAINED: "#E69F00",
    Verdict.DISAGREES: "#D55E00",
    Verdict.NOT_JUDGED: "#999999",
}
_FARTHEST = 5.0  # of what is allowed: points beyond it stand at the edge
_ACROSS = 3  # panels


def distance(row: Row) -> float:
    """Return the deviation over what is allowed, within the picture; the edge where nothing is allowed."""
    if row.deviation == 0.0:
        return 0.0
    over = row.deviation / row.allowed if row.allowed else np.copysign(np.inf, row.deviation)
    return float(np.clip(np.nan_to_num(over, nan=_FARTHEST), -_FARTHEST, _FARTHEST))


def overview(comparisons: Mapping[str, Comparison], outcomes: Mapping[str, Outcome]) -> "Figure":
    """Draw the distance of every number from its reference, in units of what is allowed."""
    from matplotlib.figure import Figure

    listed = [(name, row) for name, outcome in outcomes.items() for row in outcome.rows]
    figure = Figure(figsize=(11, 1.2 + 0.21 * len(listed) + 0.3 * len(outcomes)), layout="constrained")
    axes = figure.subplots()
    axes.axvspan(-1.0, 1.0, color="#e8f4ee", zorder=0)
    axes.axvline(0.0, color="#777777", lw=0.8)
    labels, places, at, last = [], [], 0.0, ""
    for name, row in listed:
        at += 1.4 if name != last and last else 1.0
        if name != last:
            axes.text(
                _FARTHEST + 0.25, at, f"{name}\n{comparisons[name].kind}", va="top", fontsize=7.5, color="#333333"
            )
        last = name
        far, colour = distance(row), COLOURS[row.verdict]
        marker = "<" if far <= -_FARTHEST else ">" if far >= _FARTHEST else "o"
        axes.plot([0.0, far], [at, at], color=colour, lw=1.2)
        axes.plot(far, at, marker, color=colour, ms=5)
        labels.append(row.quantity)
        places.append(at)
    axes.set_yticks(places, labels, fontsize=7.5)
    axes.set(
        xlim=(-_FARTHEST - 0.15, _FARTHEST + 0.15), ylim=(at + 1.0, 0.0),
        xlabel="off by / allowed (shaded: uncertainty of the reference and stated error together; arrows: farther)",
    )  # fmt: skip
    found = {row.verdict for _, row in listed}
    handles = [
        axes.plot([], [], "o", color=COLOURS[verdict], label=str(verdict))[0] for verdict in Verdict if verdict in found
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles), frameon=False, fontsize=9)
    return figure


def curves(outcome: Outcome) -> "Figure | None":
    """Draw the curves of a comparison, None if it has none."""
    from matplotlib.figure import Figure

    if not outcome.curves:
        return None
    columns = min(_ACROSS, len(outcome.curves))
    lines = -(-len(outcome.curves) // columns)
    figure = Figure(figsize=(3.8 * columns + 0.6, 3.0 * lines + 0.3), layout="constrained")
    panels = np.atleast_1d(figure.subplots(lines, columns)).ravel()
    for axes, curve in zip(panels, outcome.curves, strict=False):
        _draw(axes, curve)
    for axes in panels[len(outcome.curves) :]:
        axes.set_axis_off()
    panels[0].legend(frameon=False, fontsize=8)
    return figure


def _draw(axes: "Axes", curve: Curve) -> None:
    (x, y), (at, found) = curve.reference, curve.computed
    if curve.deviations is not None:
        axes.errorbar(x, y, curve.deviations, fmt="ko", ms=3, lw=0.8, label="reference")
    else:
        axes.plot(x, y, "ko", ms=2.5, label="reference")
    axes.plot(at, found, "o-" if at.size < 10 else "-", ms=4, color="#0072B2", label="computed")
    if curve.logarithmic:
        axes.set(xscale="log", yscale="log")
    axes.set_title(curve.title, fontsize=9)
    axes.set(xlabel=curve.x_label, ylabel=curve.y_label)
