"""Error against cost, from full film to boundary lubrication, over grids and tolerances."""

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter

from benchmarks.film.cases import Level, RoughCase, cascade, grid_of
from benchmarks.pages import Page
from benchmarks.timing import timed, unit_of
from contact_core.calls.point_contact import point_contact
from contact_core.film.instant import Grid, Settings
from contact_core.film.outputs import disc
from contact_core.laws.viscosity import Roelands

BASE = {"radius": 10e-3, "viscosity": 0.04, "alpha": 15e-9, "rq": 100e-9, "correlation": 20e-6}
TIGHT, LOOSE = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6), (1e-2, 3e-3, 1e-3)
# name: load [N], speed [m/s], tolerances. With contact 20 N: at 40 N the film of 513 nodes, the reference, stays unbalanced
CASES = {"full film": (40.0, 3.0, TIGHT), "mixed": (20.0, 0.1, LOOSE), "near boundary": (20.0, 0.005, LOOSE)}
GRIDS = (33, 65, 129, 257, 513)
REFERENCE = (65, 129, 257, 513)
DEFAULT = 1e-3
LONG = 6.0  # s: what takes longer ends the row of grids
SLIP, LIMIT, SOLID = 0.05, 0.05, 0.1  # slip, limiting shear over pressure, friction of solids
# symbol, colour; all relative, W_c absolute
OUTPUTS = {
    "h_central": ("h central", "#1b4f72", "o"),
    "h_min": ("h min", "#2e86c1", "s"),
    "inverse gap": ("mean 1/h", "#ca6f1e", "D"),
    "shear": ("friction", "#b03a2e", "^"),
    "W_c": ("W_c, absolute", "#7d8a97", "v"),
}


@dataclass(frozen=True)
class Row:
    """A film and what it cost."""

    nodes: int
    tolerance: float
    seconds: float
    errors: dict[str, float]
    algorithm: str
    converged: bool


def outputs(
    case: RoughCase, grid: Grid, gap: np.ndarray, fluid: np.ndarray, solid: np.ndarray, numbers: dict[str, float]
) -> dict[str, float]:
    """The quantities whose errors are compared. Friction: Newtonian up to a limit, and solids, over the load."""
    viscosity = Roelands(case.viscosity, 300.0, case.alpha, 0.0)(fluid, 300.0)
    shear = np.minimum(viscosity * SLIP * case.speed / gap, LIMIT * fluid) + SOLID * solid
    return {
        "h_central": numbers["h_central"],
        "h_min": numbers["h_min"],
        "inverse gap": float((1.0 / gap[disc(grid, case.hertz)]).mean()),
        "shear": float(shear.sum() * grid.spacing**2 / case.load),
        "W_c": numbers["contact_load_ratio"],
    }


def of_level(case: RoughCase, level: Level) -> dict[str, float]:
    state = level.film.state
    solid = np.where(state.solid, state.pressure - state.fluid, 0.0)
    return outputs(case, level.grid, level.film.gap, state.fluid, solid, level.outputs)


def errors(found: dict[str, float], reference: dict[str, float]) -> dict[str, float]:
    """Relative, of W_c absolute."""
    return {
        key: abs(value - reference[key]) / (1.0 if key == "W_c" else reference[key]) for key, value in found.items()
    }


def study(report: Page, name: str, units: dict[int, float]) -> tuple[list[Row], list[Row]]:
    load, speed, tolerances = CASES[name]
    case = RoughCase(load=load, speed=speed, **BASE)
    levels = cascade(
        case, REFERENCE, Settings(1e-9, 1e-5 if case.film > 2.0 * case.rq else 1e-4, 400, "pyfftw", fitted=True)
    )
    reference, film = of_level(case, levels[-1]), levels[-1].film
    report.say(
        f"### {name.capitalize()}\n\n{load:g} N, u = {speed:g} m/s, M = {case.smooth.moes_parameters[0]:.0f}, film by formula "
        f"{case.film * 1e9:.0f} nm, lambda {case.film / case.rq:.2f}. Reference: {levels[-1].nodes} nodes, {film.algorithm}, "
        f"pressure change {film.pressure_change:.1g}, imbalance {film.imbalance:.1g}, {levels[-1].seconds:.1f} s, not met: {film.shortfall or 'nothing'}. Its "
        + ", ".join(f"{key} {value:.3g}" for key, value in reference.items())
        + "."
    )
    report.header("nodes", "tolerance", "s", "WU", *(f"{key} [%]" for key in OUTPUTS), "algorithm", "converged")
    rows: list[Row] = []
    for nodes in GRIDS:
        for tolerance in sorted(tolerances, key=lambda value: abs(np.log(value / DEFAULT))):
            row = solved(case, nodes, tolerance, reference)
            rows.append(row)
            wu = row.seconds / units[nodes]
            shown = (f"{100.0 * row.errors[key]:.2g}" for key in OUTPUTS)
            report.row(nodes, f"{tolerance:g}", row.seconds, wu, *shown, row.algorithm, row.converged)
            if row.seconds > LONG:
                break
        if rows[-1].seconds > LONG:
            finer = ", ".join(str(n) for n in GRIDS if n > nodes)
            if finer:
                report.row(finer, *("-" for _ in range(len(OUTPUTS) + 3)), f"left out: {nodes} took > {LONG:g} s", "")
            break
    steps: list[Row] = []
    for level in levels[:-1]:
        found = errors(of_level(case, level), reference)
        shown = (f"{100.0 * found[key]:.2g}" for key in OUTPUTS)
        total = sum(other.seconds for other in levels if other.nodes <= level.nodes)
        steps.append(Row(level.nodes, DEFAULT, total, found, level.film.algorithm, level.film.converged))
        cells = (
            level.nodes,
            "cascade",
            total,
            total / units[level.nodes],
            *shown,
            level.film.algorithm,
            level.film.converged,
        )
        report.row(*cells)
    return rows, steps


def solved(case: RoughCase, nodes: int, tolerance: float, reference: dict[str, float]) -> Row:
    arguments = case.arguments() | {
        "heights_2": case.heights(nodes),
        "domain": case.domain,
        "hardness": case.hardness,
        "tolerance": tolerance,
    }
    found, seconds = timed(lambda: point_contact(**arguments), 2)
    numbers = {key: getattr(found, key) for key in ("h_central", "h_min", "contact_load_ratio")}
    grid = grid_of(case.domain, nodes)
    values = outputs(case, grid, found.film, found.fluid_pressure, found.solid_pressure, numbers)
    return Row(nodes, tolerance, seconds, errors(values, reference), found.algorithm, found.converged)


def run() -> None:
    report = Page("film/core", "Accuracy against cost", "accuracy")
    units = {nodes: unit_of(nodes) for nodes in GRIDS}
    report.say(
        "Ball of 10 mm, E' 230 GPa, 0.04 Pa s, 15 1/GPa, Rq 100 nm, correlation length 20 um, the same surface and domain "
        "on every grid. `point_contact` with its defaults, including its error estimate (a second film on half the nodes): CPU seconds, "
        "least of two where short; the error of 513 nodes is that of the iteration alone. Errors against the finest grid, relative, for W_c absolute. 1/h: mean over r < 2a/3. Friction: "
        f"slip {100 * SLIP:g} %, Newtonian up to {LIMIT:g} p, {SOLID:g} for solids. Rows `cascade`: every grid started from the coarser one, to the tolerance of the reference, 400 iterations at most, including the time of the coarser ones. One work unit: "
        + ", ".join(f"{1e3 * unit:.3g} ms on {nodes}" for nodes, unit in units.items())
        + "."
    )
    rows = {name: study(report, name, units) for name in CASES}
    draw(report, rows, units[129])
    finest = {name: max(row.nodes for row in found if row.converged) for name, (found, _) in rows.items()}
    report.verdict(
        "error against cost, grids 33-513, tolerances 1e-2 to 1e-6 (1e-3 with contact), full film to boundary",
        "finest grid that `point_contact` reached converged, short of the reference of 513: "
        + ", ".join(f"{name} {nodes}" for name, nodes in finest.items()),
        min(finest.values()) >= 257,
    )
    for name, (found, _) in rows.items():
        best = min(found, key=lambda row: (not row.converged, -row.nodes, abs(np.log(row.tolerance / DEFAULT))))
        text = ", ".join(f"{OUTPUTS[key][0]} {100 * best.errors[key]:.2g} %" for key in OUTPUTS)
        report.verdict(
            f"the same, {name} (no bar given)", f"{text} for {best.seconds:.2f} s on {best.nodes} nodes", best.converged
        )
    report.write()


def line(panel: Axes, rows: list[Row], key: str, fine: bool) -> None:
    """Errors of one output over cost; hollow where a film is short of its tolerance, nothing below 0.01 %."""
    _, colour, marker = OUTPUTS[key]
    points = [(1e3 * row.seconds, 100.0 * row.errors[key], row.converged) for row in rows if row.errors[key] > 1e-4]
    if not points:
        return
    ms, values, done = (np.array(part) for part in zip(*points, strict=True))
    panel.plot(
        ms, values, "-" if fine else ":", color=colour, lw=1.9 if fine else 1.2, zorder=2, alpha=1.0 if fine else 0.7
    )
    for mask, face in ((done, colour), (~done, "white")):
        panel.plot(ms[mask], values[mask], marker, color=colour, mfc=face, ms=7 if fine else 4, zorder=3)


def draw(report: Page, rows: dict[str, tuple[list[Row], list[Row]]], unit: float) -> None:
    figure = Figure(figsize=(12.0, 5.4), layout="constrained")
    panels = figure.subplots(1, len(rows), sharey=True)
    for panel, (name, (found, steps)) in zip(panels, rows.items(), strict=True):
        main = [row for row in found if row.tolerance == DEFAULT and row.nodes < REFERENCE[-1]]
        for key, (_, colour, marker) in OUTPUTS.items():
            line(panel, main, key, True)
            line(panel, steps, key, False)
            rest = [
                (1e3 * row.seconds, 100.0 * row.errors[key])
                for row in found
                if row.tolerance != DEFAULT and row.nodes < REFERENCE[-1]
            ]
            panel.scatter(*zip(*rest, strict=True), color=colour, marker=marker, s=12, alpha=0.3, lw=0, zorder=1)
        for row in main:
            panel.axvline(1e3 * row.seconds, color="0.88", lw=0.8, zorder=0)
            panel.annotate(
                f"{row.nodes}",
                (1e3 * row.seconds, 1500),
                fontsize=9,
                color="0.35",
                rotation=90,
                ha="right",
                va="top",
            )
        panel.set(xscale="log", yscale="log", xlabel="CPU time [ms]", ylim=(0.01, 2000))
        panel.set_title(f"{name}, u = {CASES[name][1]:g} m/s", fontsize="large", pad=10)
        panel.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        panel.spines[["top", "right"]].set_visible(False)
        panel.grid(color="0.94", which="major", axis="y")
        above = panel.secondary_xaxis("top", functions=(lambda ms: ms / (1e3 * unit), lambda wu: wu * 1e3 * unit))
        above.tick_params(labelsize="small", colors="0.45")
        above.set_xlabel("work units of 129 nodes", fontsize="small", color="0.45")
    panels[0].set_ylabel("error against 513 nodes [%]")
    marks = [Line2D([], [], color=colour, marker=marker, label=label) for label, colour, marker in OUTPUTS.values()]
    marks.append(Line2D([], [], color="0.4", ls=":", marker="o", ms=4, label="grid after grid"))
    marks.append(Line2D([], [], color="0.4", ls="", marker="o", mfc="white", label="short of its tolerance"))
    figure.legend(handles=marks, loc="outside lower center", ncols=len(marks), frameon=False, fontsize="small")
    report.picture(
        figure,
        "core_accuracy.png",
        "error against cost: large marks are grids (their nodes stand below) at a tolerance of 1e-3, faint ones other "
        "tolerances, dotted lines the rows `cascade`",
    )
