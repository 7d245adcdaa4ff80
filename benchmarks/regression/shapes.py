"""The regression level on the shapes of machines: flanks of gears, balls of a bearing, the ball of a rig.

    python -m benchmarks.regression.shapes solve   # the points by the deterministic level: 20 min
    python -m benchmarks.regression.shapes rub     # a few contacts that have rubbed for ten minutes: 15 min
    python -m benchmarks.regression.shapes page    # fit the constants of lines, compare: docs/measured/regression/shapes.md and .png

Solved points stay in results/regression_shapes; what is missing there is solved when it is asked for.
"""

import argparse
import math

import numpy as np
from matplotlib.figure import Figure

from benchmarks.folders import MEASURED
from benchmarks.pages import save
from benchmarks.regression.fit import Fit, constants, ends, shared, table, told, widths_page
from benchmarks.regression.points import Columns
from benchmarks.regression.points import solved as answered
from benchmarks.regression.shapes_points import (
    CHECK,
    FIT,
    ORIGIN,
    WIDTH,
    ShapePoint,
    count_of,
    fitted_to,
    points,
    rubbed,
    solved,
)
from contact_core import RangeFlag, advance, initial_state, line_contact, point_contact
from contact_core.laws.load_sharing import LineSharing
from contact_core.reference import rolling_line, rolling_point
from contact_core.state import Outputs

DOCS = MEASURED / "regression"
BANDS = ((0.0, 0.2), (0.2, 1.0), (1.0, 3.0), (3.0, math.inf))  # of lambda
ERRORS = {"mu": "error_friction", "h_c": "error_film", "wear": "error_wear"}
UNKNOWN = 1e3  # error_wear that says nothing
RUBBING = ("line", "ellipse", "circle")
NAMES = {FIT: "fit", WIDTH: "widths", CHECK: "check"}
LOOKS = {
    "line": "#2471a3",
    "ellipse": "#e67e22",
    "circle": "#27ae60",
    "soft line": "#8e44ad",
    "rolling line": "#17a2b8",
    "sliding line": "#c0392b",
    "thin line": "#7f8c8d",
    "cam line": "#b7950b",
    "light circle": "#1e8449",
}
MODULUS = 2.27e11  # Pa
TOLD = {
    "line": "flank of an FZG gear: R 3.9 to 8.8 mm, 5 to 540 N/mm, u_e 0.3 to 5 m/s, SRR -1.3 to 1.3, Rq of each body 0.1 to 0.4 um over 25 um, FVA3 at 40 to 120 degC",
    "ellipse": "balls of a bearing 209, inner and outer ring: 20 to 4500 N, u_e 0.05 to 15 m/s, SRR 0.1 to 2 %, half of them with spin of up to 0.3 of the ball's rolling, Rq 10 to 50 nm over 20 um, FVA3 at 30 to 120 degC; only those whose inlet 129 nodes along x resolve",
    "circle": "MTM: ball of 9.525 mm, 5 to 75 N, u_e 5 mm/s to 4 m/s, SRR 0.5 to 200 %, Rq 10 to 40 and 10 to 200 nm over 8 um, 40 to 120 degC, grid of the scene",
    "soft line": "flank as above of 50 to 540 N/mm, but of 2 to 4 GPa hardness, as under a tribofilm (line: 6 GPa)",
    "rolling line": "flank as above, SRR 0.3 to 30 %",
    "thin line": "flank of 8.7 mm, 21 to 640 N/mm at a lambda of 0.03 to 2.5, SRR 2 to 150 %, Rq of each body 0.1 to 0.4 um, microroughness 8 to 20 nm, 50 to 110 degC",
    "cam line": "cam of 23.8 mm, 7 to 107 N/mm at a lambda of 0.04 to 2.5, SRR 10 to 450 %, Rq of each body 0.08 to 0.3 um, microroughness 8 to 20 nm, 50 to 110 degC",
    "light circle": "circle as above, 3 to 30 N, Rq 20 to 60 and 80 to 250 nm",
    "sliding line": "cam: R 10 to 30 mm, 5 to 120 N/mm, u_e 0.1 to 2 m/s, SRR 0.5 to 5, Rq of each body 0.05 to 0.3 um",
}


class Compared:
    """Points of a shape and a seed by both levels; those the deterministic level refused are left out."""

    def __init__(self, shape: str, seed: int) -> None:
        count = count_of(shape, seed)
        columns = solved(shape, seed, count)
        kept = np.isfinite(columns["h_c"])
        self.refused = int((~kept).sum())
        self.solved: Columns = {name: values[kept] for name, values in columns.items()}
        self.fast = [fast(point) for point, keep in zip(points(shape, seed, count), kept, strict=True) if keep]
        told_so = told(self.solved | {"row": np.arange(int(kept.sum()))})["row"]
        self.sure = np.isin(np.arange(int(kept.sum())), told_so)

    def column(self, name: str) -> np.ndarray:
        """An output of the regression level."""
        return np.array([getattr(out, name) for out in self.fast], dtype=np.float64)

    def deviations(self) -> Columns:
        """Deterministic over fast, less one; of W_c the difference."""
        s = self.solved
        share = self.column("contact_load_ratio")
        with np.errstate(divide="ignore", invalid="ignore"):
            wear = np.where(share > 0.0, s["contact_load_ratio"] / share - 1.0, 0.0)
        return {
            "mu": s["friction_coefficient"] / self.column("friction_coefficient") - 1.0,
            "h_c": s["h_c"] / self.column("h_c") - 1.0,
            "wear": wear,
            "W_c": s["contact_load_ratio"] - share,
        }

    @property
    def outside(self) -> np.ndarray:
        """Points that the regression level flags as outside its fit."""
        return (self.column("range_flags").astype(int) & RangeFlag.OUTSIDE_FIT) > 0


def fast(point: ShapePoint) -> Outputs:
    """The point at the regression level."""
    scene = point.build().at_level("regression")
    return advance(scene, point.operating_point, initial_state(scene), 0.0)[1]


def covered(compared: Compared, kept: np.ndarray) -> list[str]:
    """Shares of points whose deviation is within the error outputs: friction, film, wear where it is told at all."""
    found, off = [], compared.deviations()
    for name, error in ERRORS.items():
        width = compared.column(error)
        asked = kept & (width < UNKNOWN)
        share = np.mean(np.abs(off[name][asked]) <= width[asked]) if asked.any() else math.nan
        found.append(f"{100 * share:.0f} % of {asked.sum()}")
    return found


def deviation_page(all_compared: dict[tuple[str, int], Compared]) -> list[str]:
    """Deviations by shape and lambda, of all seeds."""
    rows = []
    for shape in ORIGIN:
        parts = [part for (of_shape, _), part in all_compared.items() if of_shape == shape]
        off = [part.deviations() for part in parts]
        sure = np.concatenate([part.sure for part in parts])
        clearance = np.concatenate([part.solved["lambda"] for part in parts])
        for low, high in BANDS:
            inside = sure & (clearance >= low) & (clearance < high)
            if not inside.any():
                continue
            found = []
            for name in ("mu", "h_c", "W_c"):
                values = np.abs(np.concatenate([part[name] for part in off]))[inside]
                found += [f"{np.median(values):.3f}", f"{np.quantile(values, 0.95):.3f}"]
            rows.append((shape, f"{low:g} to {high:g}", int(inside.sum()), *found))
    heads = [f"{name}, {what}" for name in ("mu [rel.]", "h_c [rel.]", "W_c [1]") for what in ("median", "95 %")]
    return table(("shape", "lambda", "points", *heads), rows)


def coverage_page(all_compared: dict[tuple[str, int], Compared]) -> list[str]:
    """Return how often the error outputs cover the deviation."""
    rows = []
    for (shape, seed), part in all_compared.items():
        for sure in (True, False):
            kept = part.sure == sure
            if not kept.any():
                continue
            widths = [f"{np.median(part.column(error)[kept]):.2f}" for error in ("error_friction", "error_film")]
            outside = int((part.outside & kept).sum())
            rows.append(
                (shape, NAMES[seed], "yes" if sure else "no", int(kept.sum()), outside, *covered(part, kept), *widths)
            )
    heads = (
        "shape",
        "points",
        "solved well",
        "count",
        "outside the fit",
        "friction",
        "film",
        "wear",
        "error_friction, median",
        "error_film, median",
    )
    return table(heads, rows)


def rubbed_page() -> list[str]:
    """Contacts that have rubbed: the same surfaces by both levels."""
    rows = []
    for shape in RUBBING:
        for now, quick in rubbed(shape):
            off = now.friction_coefficient / quick.friction_coefficient - 1.0
            film = now.h_c / quick.h_c - 1.0
            rows.append(
                (
                    shape, f"{now.friction_coefficient:.4f} / {quick.friction_coefficient:.4f}",
                    f"{now.contact_load_ratio:.3f} / {quick.contact_load_ratio:.3f}", f"{1e9 * now.h_c:.0f} / {1e9 * quick.h_c:.0f}",
                    f"{1e9 * now.tribofilm_2:.1f}", f"{off:+.2f} within {quick.error_friction:.2f}", f"{film:+.2f} within {quick.error_film:.2f}",
                )
            )  # fmt: skip
    heads = ("shape", "mu", "W_c", "h_c nm", "tribofilm 2 nm", "friction", "film")
    return table(heads, rows)


def rolling_page() -> list[str]:
    """Rolling resistance of solved smooth films over the closed form, on grids that fit the film and wider ones."""
    rows = []
    oil = {"pressure_viscosity": 18e-9, "reduced_modulus": MODULUS}
    for load, speed, viscosity in ((3e3, 5.0, 0.1), (3e4, 1.0, 0.03), (3e5, 1.0, 0.03), (3e5, 0.5, 0.01)):
        case = {"load": load, "radius": 8e-3, "speed_1": speed, "speed_2": speed, "viscosity": viscosity} | oil
        formula, found = rolling_line(load, speed, viscosity, 8e-3, MODULUS), []
        first = line_contact(**case, grid=257)
        for wider in (1, 2, 4):
            contact = line_contact(**case, grid=1025, domain=(wider * first.x[0], first.x[-1]))
            found.append(_rolled(contact) / (contact.x[1] - contact.x[0]) / contact.y.size)
        beyond = 12.0 * viscosity * speed * 8e-3 / -contact.x[0]
        name = f"line, {load / 1e3:g} N/mm"
        rows.append(
            (name, speed, viscosity, *(f"{f / formula:.2f}" for f in found), f"{(found[-1] + beyond) / formula:.2f}")
        )
    for wide, half in ((1.0, 16), (10.0, 48)):
        for load, speed, viscosity in ((5.0, 1.0, 0.03), (20.0, 1.0, 0.03), (100.0, 1.0, 0.03)):
            case = {
                "load": load,
                "radius_x": 8e-3,
                "radius_y": 8e-3 * wide,
                "speed_1": speed,
                "speed_2": speed,
                "viscosity": viscosity,
            } | oil
            formula, found = rolling_point(load, speed, viscosity, 8e-3, 8e-3 * wide, MODULUS), []
            step = 1.2e-5 * (load / 20.0) ** (1 / 3)
            for wider in (1, 2, 4):
                grid = (2 * half * wider + 1, 40 * wider + 25)
                domain = (-40 * wider * step, 24 * step, -half * wider * step, half * wider * step)
                found.append(_rolled(point_contact(**case, grid=grid, domain=domain)))
            name = f"{'circle' if wide == 1.0 else 'ellipse 1:10 in radii'}, {load:g} N"
            rows.append((name, speed, viscosity, *(f"{f / formula:.2f}" for f in found), "-"))
    heads = (
        "contact",
        "u_e m/s",
        "eta0 Pa s",
        "grid of the film",
        "inlet twice as wide",
        "four times",
        "with what lies beyond",
    )
    return table(heads, rows)


def _rolled(contact: object) -> float:
    """Integral of (h/2) dp/dx over the nodes [N]."""
    spacing = contact.x[1] - contact.x[0]
    return 0.5 * float((contact.film * np.gradient(contact.fluid_pressure, spacing, axis=1)).sum()) * spacing**2


def scenes_page(all_compared: dict[tuple[str, int], Compared]) -> list[str]:
    """Rolling resistance of the rough points: both levels."""
    rows = []
    for shape in ORIGIN:
        if (shape, CHECK) not in all_compared:
            continue
        part = all_compared[shape, CHECK]
        ratio = part.solved["rolling_resistance"] / part.column("rolling_resistance")
        thick = part.sure & (part.solved["lambda"] > 1.0)
        if thick.any():
            rows.append((shape, int(thick.sum()), *(f"{np.quantile(ratio[thick], q):.2f}" for q in (0.05, 0.5, 0.95))))
    return table(("shape", "points above lambda 1", "5 %", "median", "95 %"), rows)


def draw(all_compared: dict[tuple[str, int], Compared]) -> Figure:
    """Deviation over error output, and friction by both levels."""
    figure = Figure(figsize=(10.5, 4.6), layout="constrained")
    left, middle, right = figure.subplots(1, 3)
    for shape, colour in LOOKS.items():
        for (of_shape, seed), part in all_compared.items():
            if of_shape != shape:
                continue
            style = {
                "color": colour,
                "ls": "none",
                "ms": 3.5,
                "marker": "o",
                "mfc": colour if seed == CHECK else "none",
                "mew": 0.8,
            }
            label = shape if seed == CHECK else None
            off, sure = part.deviations(), part.sure
            left.plot(
                part.column("friction_coefficient")[sure],
                part.solved["friction_coefficient"][sure],
                **style,
                label=label,
            )
            for panel, name in ((middle, "mu"), (right, "h_c")):
                panel.plot(part.solved["lambda"][sure], (off[name] / part.column(ERRORS[name]))[sure], **style)
    left.plot([1e-5, 0.13], [1e-5, 0.13], "k-", lw=0.8)
    left.set(
        xscale="log",
        yscale="log",
        xlabel="friction coefficient, fast",
        ylabel="friction coefficient, deterministic",
        xlim=(1e-5, 0.2),
        ylim=(1e-5, 0.2),
    )
    left.legend(frameon=False, fontsize="small", title="filled: check", title_fontsize="small")
    for panel, name in ((middle, "friction"), (right, "film")):
        panel.axhspan(-1.0, 1.0, color="0.94", zorder=0)
        panel.set(
            xscale="log",
            xlabel="lambda of the smooth film",
            ylabel=f"deviation of {name} over its error output",
            ylim=(-3.0, 3.0),
        )
    for panel in (left, middle, right):
        panel.spines[["top", "right"]].set_visible(False)
        panel.grid(color="0.93")
    return figure


def _softly(all_compared: dict[tuple[str, int], Compared]) -> str:
    """Return the additional load on the solids of soft lines."""
    parts = [part for (shape, _), part in all_compared.items() if shape == "soft line"]
    off = np.concatenate([part.deviations()["W_c"][part.sure & (part.solved["lambda"] < 1.0)] for part in parts])
    return f"Soft lines below lambda 1: mean deviation of W_c {off.mean():+.3f}, from {off.min():+.2f} to {off.max():+.2f}."


def _lines() -> Columns:
    """Return the points that the constants of lines are fitted to."""
    return shared(fitted_to(shape for shape in ORIGIN if shape.endswith("line")))


def page() -> None:
    """Compare, fit the constants of lines, and write what came out."""
    found = {(shape, seed): Compared(shape, seed) for shape in ORIGIN for seed in NAMES if count_of(shape, seed)}
    draw(found).savefig(DOCS / "shapes.png", dpi=130)
    lines = Fit(LineSharing(), told(answered(_lines())))
    span = ", ".join(f"{name} {low:.3g} to {high:.3g}" for name, (low, high) in ends(lines.all).items())
    refused = ", ".join(
        f"{shape} {sum(part.refused for (of_shape, _), part in found.items() if of_shape == shape)}" for shape in ORIGIN
    )
    text = [
        "# The regression level on lines, ellipses and circles of machines",
        "",
        "Written by `python -m benchmarks.regression.shapes page`.",
        "",
        "Random contacts on fresh surfaces, at the deterministic level and at the regression level:",
        "",
        *(f"* {shape}: {said}." for shape, said in TOLD.items()),
        "",
        "Three seeds: `fit` and `widths` determine the constants of the curves and their half widths, `check` only tests them. "
        f"Refused by the deterministic solver: {refused}.",
        "",
        "## Deviation by shape and film",
        "",
        "Deterministic over regression level minus one, for W_c the difference. Points of all seeds that were solved well: "
        "the film iterations reached the tolerance and, of ellipses, the grid resolves the inlet (RangeFlag NOT_CONVERGED, INLET_UNRESOLVED). "
        "Circles keep the grid of the scene, which does not resolve the inlet of films below 0.1 um: the curves are of that grid.",
        *deviation_page(found),
        "## How often the error outputs cover it",
        "",
        f"Share of points with |deviation| <= error output, both relative to the value of the regression level. Wear: deviation of W_c, to which wear is proportional; points with error_wear = {UNKNOWN:g} "
        "have no stated error and are left out.",
        *coverage_page(found),
        "Where the deterministic film depends on its grid or has not converged (solved well: no), both values are uncertain, and the deviation does not characterise the regression level alone.",
        "",
        f"{_softly(found)} Asperities that yield before the oil has pressed them flat have more contact than those of steel: the curves take the pressure over the hardness. Error outputs are up to twice as wide where a tribofilm has grown; these points have none.",
        "",
        "## Surfaces that have rubbed for ten minutes",
        "",
        "Deterministic / regression level on the same surfaces; deviation within error output.",
        *rubbed_page(),
        "## Constants of lines",
        "",
        f"Those of points are in curves.md. Covered: {span}. Chosen, not fitted: {', '.join(sorted(LineSharing.CHOSEN))}; the exposures are those of points.",
        *table(("constant", "fitted", "half width", "shipped"), constants(lines)),
        "Standard deviations about the curves: "
        + ", ".join(f"{name} {value:.3f}" for name, value in lines.scatter.items())
        + ".",
        "",
        *widths_page(lines),
        "## Rolling resistance",
        "",
        "Integral of (h/2) dp/dx of solved smooth films in pure rolling, over the closed form of Biboulet & Houpert. The formula assumes an inlet that is full as far as the bodies are parabolas. The grid ends earlier: for lines 12 eta0 u_e R / X lie beyond a distance X, which the last column adds; of points the rest falls as slowly as a logarithm.",
        *rolling_page(),
        "The rough points of `check`, deterministic over regression level, on their grids:",
        *scenes_page(found),
        "![friction by both levels; deviation of friction and of film over their error outputs](shapes.png)",
    ]
    joined = "\n".join(text).replace("\n\n\n", "\n\n") + "\n"
    save("regression/shapes", joined)
    print(joined)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", choices=("solve", "rub", "page"))
    part = parser.parse_args().part
    if part == "page":
        page()
        return
    for shape in ORIGIN:
        if part == "rub":
            list(rubbed(shape) if shape in RUBBING else ())
            continue
        for seed in NAMES:
            solved(shape, seed, count_of(shape, seed))


if __name__ == "__main__":
    main()
