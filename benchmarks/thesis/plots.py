"""Plots of the thesis's figures: solid lines are ours, dashed ones the thesis numerics, dash-dotted ones the joint reading."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from pathlib import Path

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.thesis.cases import SNAPSHOTS, SRR, Book, Missing, Run, srr_name
from benchmarks.thesis.rows import takeovers
from contact_core import Scene
from contact_core.reference import ghanbarzadeh_thickness

STYLES = {"ours": "-", "thesis": "--", "joint": "-."}
NAMES = {"ours": "ours", "thesis": "thesis numerics", "joint": "joint reading"}
APART = ("ours", "thesis")  # wear by u1 - u2
BALL, DISC, WITH, BARE = "tab:blue", "tab:red", "tab:blue", "0.35"
BODIES = (("ball", BALL), ("disc", DISC))
SHOWN_SRR = (-10.0, -2.0, 2.0, 10.0)


def draw(book: Book, place: Path) -> list[str]:
    """Write what can be drawn; returns the names of the files."""
    pictures: dict[str, Callable[[Book], Figure]] = {
        "validation_films.png": films,
        "validation_pads.png": pads,
        "validation_lubrication.png": lubrication,
        "validation_wear.png": wear,
        "validation_scars.png": scars,
    }
    drawn = []
    for name, picture in pictures.items():
        figure = picture(book)
        if any(axes.has_data() for axes in figure.axes):
            figure.savefig(place / name, dpi=110)
            drawn.append(name)
    return drawn


def _runs(book: Book, name: str, kinds: Iterable[str] = STYLES) -> Iterator[tuple[str, Run]]:
    """A case in the columns it was run in."""
    for numerics in kinds:
        with suppress(Missing):
            yield numerics, book.get(name, numerics)


def _curve(
    book: Book,
    axes: Axes,
    name: str,
    column: str,
    colour: object,
    label: str,
    scale: float = 1.0,
    kinds: Iterable[str] = STYLES,
) -> None:
    """A quantity over time, in the columns asked for."""
    for numerics, run in _runs(book, name, kinds):
        shown = label if not _has_label(axes, label) else None
        axes.plot(run.t, scale * run[column], STYLES[numerics], color=colour, lw=1.1, label=shown)


def _has_label(axes: Axes, label: str) -> bool:
    return label in axes.get_legend_handles_labels()[1]


def _finish(axes: Axes, title: str, y: str, x: str = "time [min]", *, legend: bool = True) -> None:
    axes.set_title(title, fontsize="small", loc="left")
    axes.set_xlabel(x, fontsize="small")
    axes.set_ylabel(y, fontsize="small")
    axes.tick_params(labelsize="x-small")
    axes.grid(alpha=0.25, lw=0.5)
    if legend and axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize="x-small", frameon=False)


def _srr_colour(srr: float) -> tuple[float, ...]:
    place = SRR.index(srr) / (len(SRR) - 1)
    return tuple(colormaps["coolwarm"](place if abs(place - 0.5) > 0.1 else 0.5 + np.sign(srr) * 0.12))


def _closed_form(axes: Axes, scene_name: str) -> None:
    scene, minutes = Scene.from_toml(scene_name), np.linspace(0.0, 120.0, 241)
    law = scene.tribofilm
    curve = ghanbarzadeh_thickness(
        60.0 * minutes,
        scene.operation.temperature,
        law.full_thickness,
        law.rate_factor,
        law.removal_thickness,
        law.removal_rate,
    )
    axes.plot(minutes, 1e9 * curve, ":", color="k", lw=1.0, label="node always rubbed")


def _title(figure: Figure, text: str) -> None:
    figure.suptitle(f"{text}   (solid: ours, dashed: thesis numerics, dash-dotted: joint reading)", fontsize="small")


def films(book: Book) -> Figure:
    """Figures 5-8 to 5-14."""
    figure = Figure(figsize=(11.0, 6.2), layout="constrained")
    axes = figure.subplots(2, 3)
    for (body, colour), i in zip(BODIES, (1, 2), strict=True):
        _curve(book, axes[0, 0], "A", f"tribofilm_covered_{i}", colour, f"{body}, covered nodes", 1e9)
        _curve(book, axes[0, 1], "A", f"tribofilm_{i}", colour, f"{body}, all nodes", 1e9)
        _curve(book, axes[0, 2], "A", f"coverage_{i}", colour, body)
        _curve(book, axes[1, 2], "B", f"tribofilm_covered_{i}", colour, f"{body}, covered nodes", 1e9)
    for k in (0, 1):
        _closed_form(axes[0, k], "azam_case_a")
    _closed_form(axes[1, 2], "mtm_zddp")
    for srr in SRR:
        where = axes[1, 0] if srr < 0.0 else axes[1, 1]
        _curve(book, where, srr_name(srr), "tribofilm_covered_1", _srr_colour(srr), f"{srr:+g} %", 1e9)
    _curve(book, axes[1, 1], "A_no_removal", "tribofilm_covered_1", "0.35", "+2 %, no removal", 1e9)
    _curve(book, axes[1, 1], "A_andersson", "tribofilm_covered_1", "tab:green", "+2 %, Andersson", 1e9)
    for place, text in (
        (axes[0, 0], "5-8, 5-9  set A"),
        (axes[0, 1], "5-11  set A"),
        (axes[1, 0], "5-10 a  set A, ball, covered nodes"),
        (axes[1, 1], "5-10 b, 5-12, 5-13  set A, ball"),
        (axes[1, 2], "5-14  set B"),
    ):
        _finish(place, text, "mean tribofilm [nm]")
    _finish(axes[0, 2], "coverage, set A", "share of the track")
    _title(figure, "Growth of the tribofilm")
    return figure


def _rows(run: Run, field: np.ndarray) -> np.ndarray:
    return (np.arange(field.shape[0]) - 0.5 * (field.shape[0] - 1)) * float(run["spacing"])


def _map(figure: Figure, axes: Axes, run: Run, field: np.ndarray, most: float, label: str | None) -> None:
    """A patch [nm], track borders dashed."""
    y, half = 1e6 * _rows(run, field), 0.5e6 * field.shape[1] * float(run["spacing"])
    extent = (-half, half, float(y[0]), float(y[-1]))
    image = axes.imshow(1e9 * field, extent=extent, origin="lower", vmin=0.0, vmax=most, cmap="viridis", aspect="equal")
    for side in (-1e6, 1e6):
        axes.axhline(side * float(run["a"]), color="w", lw=0.6, ls="--")
    axes.set_ylim(-250.0, 250.0)
    axes.tick_params(labelsize="xx-small")
    if label:
        figure.colorbar(image, ax=axes, label=label).ax.tick_params(labelsize="xx-small")


def pads(book: Book) -> Figure:
    """Figure 5-7."""
    figure = Figure(figsize=(9.6, 13.2), layout="constrained")
    axes = figure.subplots(6, len(SNAPSHOTS), sharex=True, sharey=True)
    for row, (numerics, i) in enumerate((numerics, i) for numerics in STYLES for i in (1, 2)):
        for column, minute in enumerate(SNAPSHOTS):
            place = axes[row, column]
            place.tick_params(labelsize="xx-small")
            with suppress(Missing):
                run = book.get("A", numerics)
                field = run.map(f"film_{i}_{minute}")
                _map(figure, place, run, field, 150.0, "nm" if column == len(SNAPSHOTS) - 1 else None)
                place.set_title(
                    f"{minute} min, mean {run.at(f'tribofilm_{i}', minute) * 1e9:.0f} nm", fontsize="x-small"
                )
        axes[row, 0].set_ylabel(f"{NAMES[numerics]}, {BODIES[i - 1][0]}\ny [µm]", fontsize="x-small")
    for place in axes[-1]:
        place.set_xlabel("x [µm], entrainment →", fontsize="x-small")
    figure.suptitle("5-7  Tribofilm, set A, SRR -2 %; dashed: Hertz's width", fontsize="small")
    return figure


def _smooth_line(book: Book, axes: Axes, name: str) -> None:
    for numerics, run in _runs(book, name):
        label = "smooth contact, same grid" if not _has_label(axes, "smooth contact, same grid") else None
        axes.axhline(
            1e9 * run.end("h_c"), color="k", lw=0.8, ls=":" if numerics == "ours" else (0, (1, 4)), label=label
        )


def lubrication(book: Book) -> Figure:
    """Figures 6-4 to 6-15."""
    figure = Figure(figsize=(13.0, 9.0), layout="constrained")
    axes = figure.subplots(3, 4)
    panels = (
        (0, 0, "6-4", "h_c", 1e9, "h_c [nm]"),
        (0, 1, "6-5", "lambda_ratio", 1.0, "λ"),
        (0, 2, "6-6", "contact_area_ratio_disc", 1.0, "A_c, r < 2a/3"),
        (0, 3, "6-6", "contact_load_ratio_disc", 1.0, "W_c, r < 2a/3"),
        (1, 0, "6-10", "h_c", 1e9, "h_c [nm]"),
        (1, 1, "6-11", "lambda_ratio", 1.0, "λ"),
        (1, 2, "6-15", "contact_area_ratio_disc", 1.0, "A_c, r < 2a/3"),
        (1, 3, "6-15", "contact_load_ratio_disc", 1.0, "W_c, r < 2a/3"),
        (2, 0, "6-7, 6-13", "roughness_1", 1e9, "Rq ball [nm]"),
        (2, 1, "6-13", "roughness_2", 1e9, "Rq disc [nm]"),
        (2, 2, "6-8", "lambda_conventional", 1.0, "conventional λ"),
        (2, 3, "6-14", "pressure_max", 1e-9, "p_max [GPa]"),
    )
    for row, column, figure_name, name, scale, label in panels:
        place = axes[row, column]
        kind = "A" if row == 0 else "B"
        _curve(book, place, kind, name, WITH, "with tribofilm", scale)
        _curve(book, place, f"{kind}_bare", name, BARE, "without", scale)
        for minute in (minute for _, run in _runs(book, kind) for minute in takeovers(run)):
            place.axvline(minute, color=WITH, lw=0.6, alpha=0.4)
        if name == "h_c":
            _smooth_line(book, place, f"{kind}_smooth")
        _finish(place, f"{figure_name}  set {kind}", label, legend=False)
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize="small")
    _title(
        figure, "Film, contact and roughness; vertical: dry pressures take over from mixed lubrication, or the reverse"
    )
    return figure


def _profile(
    book: Book,
    axes: Axes,
    name: str,
    colour: object,
    label: str,
    of: Callable[[Run], np.ndarray],
    kinds: Iterable[str],
) -> None:
    """Something across the track, in the columns asked for."""
    for numerics, run in _runs(book, name, kinds):
        shown = None if _has_label(axes, label) else label
        axes.plot(1e6 * run.y(), 1e9 * of(run), STYLES[numerics], color=colour, lw=1.0, label=shown)


def _worn_shape(run: Run) -> np.ndarray:
    """Height of the worn ball over the plane through its lowest point when new, downwards as in the contact."""
    return run.y() ** 2 / (2.0 * float(run["radius"])) + run.map("wear_1").mean(axis=1)


def wear(book: Book) -> Figure:
    """Figures 7-3 to 7-7, by both speeds in Archard's law."""
    figure = Figure(figsize=(12.0, 9.0), layout="constrained")
    axes = figure.subplots(3, 3)
    ways = ((APART, "wear by u1 - u2"), (("joint",), "wear by own speed"))
    for srr in SRR:
        label, colour, name = f"{srr:+g} %", _srr_colour(srr), srr_name(srr)
        for row, (kinds, _) in enumerate(ways):
            for i in (1, 2):
                _curve(book, axes[row, i - 1], name, f"wear_depth_{i}", colour, label, 1e9, kinds)
            _profile(book, axes[row, 2], name, colour, label, lambda run: -run.map("wear_1").mean(axis=1), kinds)
        if srr in SHOWN_SRR:
            _profile(book, axes[2, 0], name, colour, label, _worn_shape, ("joint",))
    for row, (_, text) in enumerate(ways):
        _finish(axes[row, 0], f"7-3  ball, {text}", "mean wear depth [nm]")
        _finish(axes[row, 1], f"7-4  disc, {text}", "mean wear depth [nm]")
        _finish(axes[row, 2], f"7-5  ball, {text}", "worn surface, mean over x [nm]", "y [µm]")
    with suppress(Missing):
        radius, y = float(book.get("A", "joint")["radius"]), np.linspace(-350e-6, 350e-6, 141)
        axes[2, 0].plot(1e6 * y, 1e9 * y**2 / (2.0 * radius), ":", color="k", lw=1.0, label="new")
    _finish(axes[2, 0], "7-6  shape of the ball, wear by own speed", "height [nm]", "y [µm]")
    for column, (kinds, text) in enumerate(ways, 1):
        _profile(book, axes[2, column], "A", DISC, "one line", lambda run: run.map("heights_2")[:, 0], kinds)
        _profile(book, axes[2, column], "A", "k", "mean over x", lambda run: run.map("heights_2").mean(axis=1), kinds)
        _finish(axes[2, column], f"7-7  disc, SRR -2 %, {text}", "height [nm]", "y [µm]")
    _title(figure, "Wear, set A")
    return figure


def scars(book: Book) -> Figure:
    """Figures 7-8 and 7-9."""
    figure = Figure(figsize=(9.6, 13.2), layout="constrained")
    axes = figure.subplots(6, len(SHOWN_SRR), sharex=True, sharey=True)
    most: dict[tuple[str, int], float] = {}
    for i, srr in ((i, srr) for i in (1, 2) for srr in SHOWN_SRR):
        for numerics, run in _runs(book, srr_name(srr)):
            deep = 1e9 * float(np.quantile(run.map(f"wear_{i}"), 0.995))
            most[numerics, i] = max(most.get((numerics, i), 0.0), deep)
    for row, (numerics, i) in enumerate((numerics, i) for numerics in STYLES for i in (1, 2)):
        for column, srr in enumerate(SHOWN_SRR):
            place = axes[row, column]
            place.tick_params(labelsize="xx-small")
            with suppress(Missing):
                run = book.get(srr_name(srr), numerics)
                bar = "nm" if column == len(SHOWN_SRR) - 1 else None
                _map(figure, place, run, run.map(f"wear_{i}"), most[numerics, i], bar)
                mean = 1e9 * run.end(f"wear_depth_{i}")
                place.set_title(f"SRR {srr:+g} %, mean {mean:.0f} nm", fontsize="x-small")
        axes[row, 0].set_ylabel(f"{NAMES[numerics]}, {BODIES[i - 1][0]}\ny [µm]", fontsize="x-small")
    for place in axes[-1]:
        place.set_xlabel("x [µm], entrainment →", fontsize="x-small")
    figure.suptitle("7-8, 7-9  Wear depth, set A; dashed: Hertz's width", fontsize="small")
    return figure
