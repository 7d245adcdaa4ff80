"""Smooth films of elliptical contacts: comparison with formulas, and grid convergence.

    OMP_NUM_THREADS=1 NUMBA_NUM_THREADS=1 python -m benchmarks.film.elliptical

Writes docs/measured/film/elliptical.md and docs/measured/film/elliptical.png, two minutes on one thread.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from scipy.special import elliprd

from benchmarks.film.cases import MoesCase
from benchmarks.folders import MEASURED
from benchmarks.pages import cells, save
from benchmarks.timing import timed
from contact_core.calls.point_contact import point_contact
from contact_core.film.fitted import Extent
from contact_core.reference import chittenden, hamrock_dowson, nijenbanning_venner_moes
from contact_core.shapes import Point

DOCS = MEASURED / "film"
ELLIPTICITIES = (0.2, 0.5, 1.0, 2.0, 5.0)  # Hertz's half width across the entrainment over that along it
LOADS, LUBRICANT = (20, 50, 100, 200, 500), 10.0
COARSE, FINE = 129, 257  # nodes along the shorter side
ORDERS = ((0.2, 100), (0.5, 100), (2.0, 100), (5.0, 100))  # ellipticity and M
BAR = 5.0  # percent
STATEMENT = """\
Across the long axis (b/a >= 1) the formula of Nijenbanning, Venner and Moes is as accurate as for circles; where M = 20 is
a light load (b/a = 5: equivalent to a circle of M = 5) it is 30 % too high, as for circles. Along the
long axis (b/a < 1) it is too low, by a sixth at b/a = 0.5 and by a third and more at 0.2: it takes the smaller of the
films of rigid and of elastic bodies in piezoviscous oil, and for slim contacts that of rigid bodies is the smaller one
up to M = 10^6, far into elastic contacts. The computed films lie between both. Their ratio to that of the circle should tend to (p_H / sqrt(a))^(-1/2), in units of the circle, at heavy loads: there the inlet is short, oil no longer flows around the tip, and the gap before it opens like p_H / sqrt(a) d^(3/2)."""


def radius_ratio(ellipticity: float) -> float:
    """Radius along y over that along x of the bodies that touch on an ellipse of this b / a."""
    k2 = min(ellipticity, 1.0 / ellipticity) ** 2
    ratio = float(elliprd(0.0, 1.0, k2) / elliprd(0.0, k2, 1.0))
    return ratio if ellipticity >= 1.0 else 1.0 / ratio


def shape_of(case: MoesCase, nodes: int) -> tuple[int, int]:
    """Nodes (ny, nx) of the grid that `point_contact` takes, refined to `nodes` along the shorter side."""
    bodies, film = Point(case.radius, case.ratio * case.radius), nijenbanning_venner_moes(case.smooth)
    ny, nx = Extent.of(bodies, case.newtons, case.modulus, film).shape()
    factor = (nodes - 1) / (COARSE - 1)
    return round((ny - 1) * factor) + 1, round((nx - 1) * factor) + 1


def films(case: MoesCase, grids: Sequence[int]) -> tuple[np.ndarray, list[str]]:
    """Central and smallest film in Moes' units on each grid [grids, 2], and the algorithms."""
    found = [point_contact(**case.arguments(), grid=shape_of(case, n), tolerance=1e-3) for n in grids]
    names = [film.algorithm + ("" if film.converged else ", not converged") for film in found]
    return np.array([(film.h_central, film.h_min) for film in found]) / case.unit, names


def beside_formulas() -> tuple[list[str], list[str], dict[float, list[float]], Figure]:
    lines = [
        cells(
            (
                *("b/a", "R_y/R_x", "M", "H_c", "H_min", "extrapolated by [%]", "NVM [%]", "Chittenden et al. [%]"),
                *("Hamrock & Dowson [%]", "algorithm", "s"),
            )
        ),
        "|" + "---|" * 11,
    ]
    off: dict[float, list[float]] = {}
    figure = Figure(figsize=(7.2, 4.4), layout="constrained")
    axes = figure.add_subplot()
    centrals: dict[float, list[float]] = {ellipticity: [] for ellipticity in ELLIPTICITIES}
    for ellipticity in ELLIPTICITIES:
        for load in LOADS:
            case = MoesCase(load, LUBRICANT, ratio=radius_ratio(ellipticity))
            (found, names), seconds = timed(lambda case=case: films(case, (COARSE, FINE)))
            central, least = found[1] + (found[1] - found[0]) / 3.0
            smooth = case.smooth
            formulas = (nijenbanning_venner_moes(smooth), chittenden(smooth)[0], hamrock_dowson(smooth)[0])
            errors = [100.0 * (formula / case.unit / central - 1.0) for formula in formulas]
            off.setdefault(ellipticity, []).append(errors[0])
            centrals[ellipticity].append(float(central))
            by = 100.0 * (central / found[1, 0] - 1.0)
            row = (ellipticity, case.ratio, load, central, least, by, *errors, names[1], round(seconds, 1))
            lines.append(cells(row))
            print(lines[-1], flush=True)
    steps = np.geomspace(ELLIPTICITIES[0], ELLIPTICITIES[-1], 50)
    for k, load in enumerate(LOADS[::2]):
        solved = [each[LOADS.index(load)] for each in centrals.values()]
        cases = [MoesCase(load, LUBRICANT, ratio=radius_ratio(float(b))) for b in steps]
        axes.semilogx(ELLIPTICITIES, solved, "o", color=f"C{k}", label=f"M = {load}, solved")
        for style, formula in (("-", nijenbanning_venner_moes), (":", lambda smooth: chittenden(smooth)[0])):
            axes.semilogx(steps, [formula(case.smooth) / case.unit for case in cases], style, color=f"C{k}")
    axes.set(xlabel="b / a", ylabel="H_c at L = 10", title="lines: Nijenbanning et al.; dotted: Chittenden et al.")
    axes.set_xticks(ELLIPTICITIES, [f"{ratio:g}" for ratio in ELLIPTICITIES], minor=False)
    axes.xaxis.set_minor_formatter("")
    axes.legend(frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    asked = []
    for ellipticity, each in off.items():
        text = ", ".join(f"{error:+.1f}" for error in each)
        asked.append(
            cells(
                (
                    f"formula within {BAR:g} % of the film, b/a = {ellipticity:g}, M = {', '.join(map(str, LOADS))}",
                    f"{text} %",
                    max(map(abs, each)) <= BAR,
                )
            )
        )
    return lines, asked, centrals, figure


def tips(centrals: dict[float, list[float]]) -> list[str]:
    """Films of slim contacts over those of the circle, and the limit of that under heavy loads."""
    lines = [cells(("b/a", *(f"M = {load}" for load in LOADS), "limit")), "|" + "---|" * (len(LOADS) + 2)]
    for ellipticity in (value for value in ELLIPTICITIES if value < 1.0):
        slim, circle = (MoesCase(1.0, 1.0, ratio=radius_ratio(value)).hertz for value in (ellipticity, 1.0))
        limit = (slim.pressure_max / circle.pressure_max) ** -0.5 * (slim.a / circle.a) ** 0.25
        ratios = (film / round_film for film, round_film in zip(centrals[ellipticity], centrals[1.0], strict=True))
        lines.append(cells((ellipticity, *ratios, limit)))
    return lines


def orders() -> tuple[list[str], list[str]]:
    grids = (65, 129, 257, 513)
    names = [f"{what} {nodes}" for what in ("H_c", "H_min") for nodes in grids]
    lines = [cells(("b/a", "M", *names, "orders of H_c", "of H_min")), "|" + "---|" * (4 + len(names))]
    asked = []
    for ellipticity, load in ORDERS:
        found, _ = films(MoesCase(load, LUBRICANT, ratio=radius_ratio(ellipticity)), grids)
        steps = np.diff(found, axis=0)
        order = np.log2(steps[:-1] / steps[1:])
        texts = (", ".join(f"{value:.2f}" for value in order[:, k]) for k in range(2))
        lines.append(cells((ellipticity, load, *found[:, 0], *found[:, 1], *texts)))
        print(lines[-1], flush=True)
        last = order[-1, 0]
        asked.append(cells((f"order of H_c >= 1.9, b/a = {ellipticity:g}, M = {load}", f"{last:.2f}", last >= 1.9)))
    return lines, asked


def main() -> None:
    table, asked, centrals, figure = beside_formulas()
    convergence, more = orders()
    figure.savefig(DOCS / "elliptical.png", dpi=150)
    page = [
        "# Elliptical contacts: smooth films",
        "",
        "Written by `python -m benchmarks.film.elliptical`. One process, one thread.",
        "",
        "Barus, incompressible, L = 10. Oil comes in along x; b/a is Hertz's half width across over that along x. M, L and H "
        "(film over R_x U^(1/2), U = eta0 (u1 + u2) / (E' R_x)) refer to R_x; the formula of Nijenbanning, Venner and "
        "Moes takes R_x / R_y as its ratio, the others the speed (u1 + u2) / 2.",
        "",
        "## Asked",
        "",
        "| asked | found | met? |",
        "|---|---|---|",
        *asked,
        *more,
        "",
        "## Beside formulas",
        "",
        f"H_c and H_min are extrapolated (Richardson) from grids of {COARSE} and {FINE} nodes along the shorter side that fit the film; formulas are compared with these values.",
        "",
        *table,
        "",
        "![central film over the ratio of Hertz's half widths](elliptical.png)",
        "",
        STATEMENT,
        "",
        *tips(centrals),
        "",
        "## Grid convergence",
        "",
        "The same domain on nested grids, nodes along the shorter side; orders from each three grids in turn.",
        "",
        *convergence,
    ]
    save("film/elliptical", "\n".join(page))


if __name__ == "__main__":
    main()
