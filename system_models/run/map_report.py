"""The report of a map: what it says of itself and what held-back histories say of it, as text, page and picture."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from contact_core.corrections.map import COORDINATES, OUTPUTS
from contact_core.scene import OperatingPoint

from ..charts import files
from ..charts.chart import Chart, Line, Sheet
from .cosim_report import aligned
from .map_build import Built, Judged
from .map_ranges import OPTIONS

_NAMES = {"friction_coefficient": "friction", "h_c": "h_c", "contact_load_ratio": "W_c (absolute)"}
_UNITS = OPTIONS | {"slide_roll": "1"}
_VALUES: dict[str, Callable[[Built, OperatingPoint], float]] = {
    "load": lambda built, point: point.load,
    "entrainment": lambda built, point: abs(point.entrainment_speed),
    "slide_roll": lambda built, point: abs(point.sliding_speed / point.entrainment_speed),
    "temperature": lambda built, point: point.temperature,
    "radius_x": lambda built, point: built.order.scene.shape(point).radius_x,
}


def lines(built: Built) -> list[str]:
    """Return sentences on the knots, and the table of half widths and held-back knots."""
    histories, chart = built.histories, built.chart
    knots = [knot for history in histories for knot in history.knots]
    unsure = sum(not knot.counts for knot in knots)
    own = sum(history.fine for history in histories)
    judges = sum(history.fine for history in built.held)
    beyond = f" ({built.judged.outside} of their knots beyond the ranges of the others)" if built.judged else ""
    why = "the accuracy is reached" if built.reached else "the time was over"
    return [
        f"{len(histories)} histories, {own} of them on the scene's own grid, of which {judges} are held back{beyond}; "
        f"{sum(bool(history.refused) for history in histories)} ended early. {len(knots)} knots, {unsure} of them not "
        f"converged or at the edge of the grid, {chart.knots} fitted. No more because {why}.",
        f"{1 + len(chart.term)} terms in {', '.join(COORDINATES[k] for k in chart.picked)}; a query costs {chart.cost} "
        f"multiplications and additions; {len(chart.to_text()) / 1024:.0f} kB.",
        *aligned(rows(built), 1),
    ]


def rows(built: Built) -> list[list[str]]:
    """Return the table: a row for each output, half widths and deviations in per cent."""
    head = ["%", "half width of the map, median"]
    if built.judged is not None:
        head += [
            "held back: off before, rms",
            "off, rms",
            "inside the half width",
            "inside that and the block's",
            "largest over both",
        ]
    found = [head]
    for k, name in enumerate(OUTPUTS):
        row = [_NAMES[name], f"{100.0 * built.halves[k]:.1f}"]
        if built.judged is not None:
            raw, off = built.judged.raw[:, k], built.judged.off[:, k]
            alone, stated = built.judged.of_map[:, k], built.judged.stated[:, k]
            row += [
                f"{100.0 * np.sqrt(np.mean(raw**2)):.1f}",
                f"{100.0 * np.sqrt(np.mean(off**2)):.1f}",
                f"{100.0 * np.mean(np.abs(off) <= alone):.0f}",
                f"{100.0 * np.mean(np.abs(off) <= stated):.0f}",
                f"{np.max(np.abs(off) / stated):.2f}",
            ]
        found.append(row)
    return found


def write(built: Built, folder: Path) -> list[Path]:
    """Write map, page and picture; return their paths, the map's first."""
    name = built.chart.scene
    chart, page, picture = folder / f"{name}.json", folder / "report.md", folder / "held_back.png"
    chart.write_text(built.chart.to_text(), "utf-8")
    page.write_text(_page(built, picture.name if built.judged is not None else ""), "utf-8")
    if built.judged is None:
        return [chart, page]
    return [chart, page, files.save(sheet(built.judged), picture)]


def _page(built: Built, picture: str) -> str:
    first, second, *_ = lines(built)
    given = [["range", "asked, lowest", "highest", "of the knots, lowest", "highest", "unit"]]
    for key, low, high in built.chart.ranges:
        values = [_VALUES[key](built, knot.point) for history in built.fitted for knot in history.knots if knot.counts]
        given.append([key, *(f"{x:.4g}" for x in (low, high, min(values), max(values))), _UNITS[key]])
    return "\n".join(
        [
            f"# Map of {built.chart.scene}",
            "",
            f"{first} A history rubs for up to {built.order.ranges.duration:g} s at one operating point, the first one "
            "at that of the scene, and looks at others on its way.",
            "",
            second,
            "",
            *_markdown(given),
            "",
            "Half widths (95 %) of the map are by histories left out, beyond the scatter that a block states for "
            "itself: they are those of what a long run averages to. Held-back histories took no part in the map; their "
            "knots are judged with their own scatter.",
            "",
            *_markdown(rows(built)),
            *(["", f"![held-back knots]({picture})"] if picture else []),
            "",
        ]
    )


def _markdown(table: list[list[str]]) -> list[str]:
    head, *rest = (f"| {' | '.join(row)} |" for row in table)
    return [head, "|" + "---|" * len(table[0]), *rest]


def sheet(judged: Judged) -> Sheet:
    """Return the picture: deviations of held-back knots from both levels, against W_c."""
    charts = []
    for k, name in enumerate(OUTPUTS):
        raw, off, half = (100.0 * each[:, k] for each in (judged.raw, judged.off, judged.stated))
        lines = [
            Line("regression level", judged.samples.shares, raw, place=1, style="x"),
            Line("map, with its and the block's half width", judged.samples.shares, off, half, style="o"),
        ]
        label = f"deterministic over it, {_NAMES[name]} [%]"
        charts.append(Chart("", "contact_load_ratio by the regression level", label, lines, levels=(0.0,)))
    return Sheet(charts, columns=len(OUTPUTS), width=4.2, height=3.8)
