"""The report of a map: what it says of itself and what held-back knots say of it, as text, page and picture."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from contact_core.mapped.map import COORDINATES, OUTPUTS

from .cosim_report import aligned
from .map_build import Built, fit_knots, held_knots

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_NAMES = {"friction_coefficient": "friction", "h_c": "h_c", "contact_load_ratio": "W_c (absolute)"}
_UNITS = {"load": "N", "entrainment": "m/s", "slide_roll": "1", "temperature": "K"}
_BLUE, _RED, _GREY = "#0072B2", "#D55E00", "#777777"  # Okabe and Ito


def lines(built: Built) -> list[str]:
    """Return sentences on the knots, and the table of half widths and held-back knots."""
    fitted, held = fit_knots(built.knots), held_knots(built.knots)
    refused = sum(bool(knot.refused) for knot in built.knots)
    unsure = len(built.knots) - len(fitted) - len(held) - refused
    chart = built.chart
    beyond = f" ({built.judged.outside} beyond the ranges of the others)" if built.judged is not None else ""
    why = "the accuracy is reached" if built.reached else "the time was over"
    return [
        f"{len(built.knots)} knots: {len(fitted)} fitted, {len(held)} held back{beyond}, {refused} refused, {unsure} "
        f"not converged or at the edge of the grid. No more because {why}.",
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
    _picture(built).savefig(picture, dpi=120)
    return [chart, page, picture]


def _page(built: Built, picture: str) -> str:
    first, second, *_ = lines(built)
    given = [["range", "lowest", "highest", "unit"]]
    given += [[key, f"{low:.4g}", f"{high:.4g}", _UNITS[key]] for key, low, high in built.chart.ranges]
    return "\n".join(
        [
            f"# Map of {built.chart.scene}",
            "",
            f"{first} Surfaces have rubbed for up to {built.order.ranges.duration:g} s at another operating point.",
            "",
            second,
            "",
            *_markdown(given),
            "",
            "Half widths (95 %) of the map are by knots left out, beyond the scatter that a block states for itself. "
            "Held-back knots took no part in the map.",
            "",
            *_markdown(rows(built)),
            *(["", f"![held-back knots]({picture})"] if picture else []),
            "",
        ]
    )


def _markdown(table: list[list[str]]) -> list[str]:
    head, *rest = (f"| {' | '.join(row)} |" for row in table)
    return [head, "|" + "---|" * len(table[0]), *rest]


def _picture(built: Built) -> "Figure":
    """Return the picture: deviations of held-back knots from both levels, against W_c."""
    from matplotlib.figure import Figure

    judged = built.judged
    assert judged is not None
    figure = Figure(figsize=(11.0, 3.6), layout="constrained")
    for k, (axes, name) in enumerate(zip(figure.subplots(1, len(OUTPUTS)), OUTPUTS, strict=True)):
        shares = judged.samples.shares
        axes.axhline(0.0, color=_GREY, linewidth=0.8)
        axes.plot(shares, 100.0 * judged.raw[:, k], "x", color=_RED, label="regression level")
        axes.errorbar(
            shares, 100.0 * judged.off[:, k], 100.0 * judged.stated[:, k],
            fmt="o", markersize=3, linewidth=0.8, color=_BLUE, label="map, with its and the block's half width",
        )  # fmt: skip
        axes.set_xlabel("contact_load_ratio by the regression level")
        axes.set_ylabel(f"deterministic over it, {_NAMES[name]} [%]")
    axes.legend(fontsize=7)
    return figure
