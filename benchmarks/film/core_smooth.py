"""Smooth films: grid convergence, formula, rigid limit, and the effect of a hardness."""

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from benchmarks.film.cases import MoesCase, domain_of, scaled_of
from benchmarks.pages import Page
from benchmarks.timing import timed
from contact_core.calls.point_contact import point_contact
from contact_core.film.outputs import at_centre
from contact_core.kernels.multigrid.cycle import solve_smooth
from contact_core.reference import moes_film

WIDE, CLOSE = (-4.5, 1.5, -3.0, 3.0), (-2.5, 1.5, -2.0, 2.0)  # half widths
# Moes' M at L = 10, domain, H_central and H_min that the grids tend to
TARGETS = ((20, WIDE, 4.804, 2.961), (100, WIDE, 4.648, 2.217), (200, WIDE, 4.506, 1.884), (1000, CLOSE, 4.082, 1.213))
GRIDS = (129, 257, 513)
RIGID = 35.03  # H_c M^2
CAPS = (None, 0.99, 0.97, 0.95, 0.9)  # of Hertz's pressure


def cut_off(case: MoesCase, width: tuple[float, ...], nodes: int) -> tuple[float, float]:
    """H_central and H_min of a domain at whose edge the pressure is zero."""
    scaled = scaled_of(case.arguments(), domain_of(case, width), nodes, 1e-5)
    problem = scaled.problem()
    problem = replace(problem, edge=np.zeros_like(problem.edge), weight=np.ones_like(problem.weight))
    film = scaled.smooth_film / scaled.h_unit
    found, _ = solve_smooth(problem, scaled.x, scaled.y, "pyfftw", film, 1e-5, 40)
    if not found.converged:
        print(f"M = {case.load:g}, {nodes} nodes: {found.shortfall}")
    unit = case.unit / scaled.h_unit
    return at_centre(scaled.grid, found.gap) / unit, float(found.gap.min()) / unit


def convergence(report: Page) -> None:
    report.say(
        "### Grid convergence\n\nBarus, incompressible, L = 10; Moes' units. Flow upwind, whose second order extrapolates. Domain [-4.5, 1.5] x [-3, 3] a, for M = 1000 "
        "[-2.5, 1.5] x [-2, 2] a, p = 0 at its edge, as for the targets. The last columns are `point_contact` on the same domain, with the fitted flow, which continues the pressure beyond the edge where M < 30."
    )
    names = [f"{what} {nodes}" for what in ("H_c", "H_min") for nodes in (*GRIDS, "Richardson")]
    report.header("M", *names, "order of H_c", "order of H_min", "point_contact 257: H_c", "H_min")
    errors, orders = [], []
    for load, width, central, least in TARGETS:
        case = MoesCase(load, 10.0)
        found = np.array([cut_off(case, width, nodes) for nodes in GRIDS])
        limit = found[2] + (found[2] - found[1]) / 3.0
        order = np.log2((found[1] - found[0]) / (found[2] - found[1]))
        call = point_contact(**case.arguments(), grid=257, domain=domain_of(case, width), tolerance=1e-4)
        columns = [value for k in range(2) for value in (*found[:, k], limit[k])]
        report.row(load, *columns, *order, call.h_central / case.unit, call.h_min / case.unit)
        errors.append(100.0 * (limit / (central, least) - 1.0))
        orders.append(order)
    worst, order = np.abs(errors).max(axis=0), np.min(orders, axis=0)
    for k, (what, bar) in enumerate((("H_central", 0.5), ("H_min", 1.5))):
        each = ", ".join(f"{error[k]:+.2f} %" for error in errors)
        targets = ", ".join(str(row[2 + k]) for row in TARGETS)
        report.verdict(f"{what} tends to {targets} within {bar} % (M 20, 100, 200, 1000)", each, worst[k] <= bar)
    for k, what in enumerate(("H_central", "H_min")):
        each = ", ".join(f"{values[k]:.2f}" for values in orders)
        report.verdict(f"observed order of {what} >= 1.9", each, order[k] >= 1.9)


def formula(report: Page) -> None:
    report.say(
        "### Beside the formula of Nijenbanning, Venner and Moes\n\nBarus, incompressible, 257 nodes, the domain that "
        "`point_contact` chooses. H_c is extrapolated from 129 and 257 nodes. Seconds are of both calls; contacts that multigrid does not solve take much longer."
    )
    report.header("M", "L", "H_c", "formula", "off [%]", "H_c of 257 nodes", "extrapolated by [%]", "algorithm", "s")
    off = []
    for load in (10, 20, 50, 100, 200, 500, 1000):
        for lubricant in (5, 10, 20):
            case = MoesCase(load, lubricant)
            films, seconds = timed(
                lambda case=case: [
                    point_contact(**case.arguments(), grid=nodes, tolerance=1e-4) for nodes in (129, 257)
                ]
            )
            coarse, fine = (film.h_central / case.unit for film in films)
            limit, reference = fine + (fine - coarse) / 3.0, moes_film(load, lubricant)
            off.append((abs(limit / reference - 1.0) * 100.0, load, lubricant))
            by = 100.0 * (limit / fine - 1.0)
            algorithm = films[1].algorithm + ("" if films[1].converged else ", not converged")
            beyond = 100.0 * (limit / reference - 1.0)
            report.row(load, lubricant, limit, reference, beyond, fine, by, algorithm, round(seconds, 2))
    worst = max(off)
    report.verdict(
        "within 5 % of Nijenbanning, Venner and Moes for M >= 10",
        f"{sum(value <= 5.0 for value, *_ in off)} of {len(off)}; worst {worst[0]:.1f} % at M = {worst[1]}, L = {worst[2]}",
        worst[0] <= 5.0,
    )


def rigid(report: Page) -> None:
    report.say("### Rigid bodies, constant viscosity\n\n`point_contact`, its own domain.")
    report.header("M", "nodes", "H_c M^2", "off [%]", "converged")
    off = []
    for load in (0.15, 0.4, 1.0):
        for nodes in (129, 257):
            case = MoesCase(load, 0.0)
            found = point_contact(**case.arguments(), grid=nodes, tolerance=1e-4)
            value = found.h_central / case.unit * load**2
            off.append(abs(value / RIGID - 1.0) * 100.0)
            report.row(load, nodes, value, 100.0 * (value / RIGID - 1.0), found.converged)
    report.verdict(f"rigid limit H_c M^2 = {RIGID} within 1 %", f"within {max(off):.2f} %", max(off) <= 1.0)


def hardness(report: Page) -> None:
    case = MoesCase(200, 10.0, "roelands", "dowson_higginson")
    report.say(
        f"### A hardness below the pressure\n\nM = 200, L = 10, Roelands, Dowson-Higginson, p_H = {case.pressure / 1e9:.3f} "
        "GPa, 129 nodes over [-2.5, 1.5] x [-2, 2] a. Films along y = 0 in Moes' units. Rise: largest less smallest film "
        "over -0.3 a < x < 0.3 a."
    )
    report.header(
        "hardness / p_H", "p_max / p_H", "yielding [% of Hertz]", "H at -0.3 a", "0", "0.3 a", "rise", "at the exit",
        "exit / centre", "algorithm", "converged", "shortfall",
    )  # fmt: skip
    figure = Figure(figsize=(7.2, 4.2), layout="constrained")
    axes = figure.add_subplot()
    values = []
    for cap in CAPS:
        limit = None if cap is None else cap * case.pressure
        found = point_contact(
            **case.arguments(), grid=129, domain=domain_of(case, CLOSE), hardness=limit, tolerance=1e-4, iterations=300
        )
        x, line = found.x / case.a, found.film[64] / case.unit
        exit_film, inside = line[(x > 0.3) & (x < 1.2)].min(), np.abs(x) < 0.3
        yielding = 0.0 if limit is None else (found.pressure >= 0.9999 * limit).sum()
        share = 100.0 * yielding * (found.x[1] - found.x[0]) ** 2 / (np.pi * case.a**2)
        at = [float(np.interp(where, x, line)) for where in (-0.3, 0.0, 0.3)]
        rise = float(np.ptp(line[inside]))
        values.append((at[1], rise, exit_film, exit_film / at[1], found.converged))
        report.row(
            cap or "none", found.pressure_max / case.pressure, float(share), *at, rise, exit_film, exit_film / at[1],
            found.algorithm, found.converged, found.shortfall or "none",
        )  # fmt: skip
        axes.plot(x, line, label="no hardness" if cap is None else f"{cap} p_H", lw=2 if cap is None else 1.4)
    axes.set(xlim=(-1.5, 1.3), ylim=(0, 8), xlabel="x / a", ylabel="film, Moes' units")
    axes.legend(title="hardness", frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    report.picture(figure, "core_smooth.png", "film along the middle for several hardnesses")
    free, capped = values[0], [value for value in values[1:] if value[4]]
    deeper = all(value[2] < free[2] for value in capped)
    report.verdict(
        "with a hardness the exit constriction is deeper",
        f"{free[2]:.2f} without, {', '.join(f'{value[2]:.2f}' for value in capped)} with",
        bool(capped) and deeper,
    )
    report.say(
        "Where the pressure is at the hardness, the film is the gap that elasticity leaves: mass is not balanced there, and the film thins along the contact."
    )
    report.verdict(
        "with a hardness the film is flattened in the middle",
        f"rise over |x| < 0.3 a {free[1]:.2f} without, {', '.join(f'{value[1]:.2f}' for value in capped)} with",
        bool(capped) and all(value[1] <= free[1] for value in capped),
    )


def run() -> None:
    report = Page("film/core", "Smooth films of the core", "smooth")
    for part in (convergence, formula, rigid, hardness):
        part(report)
    report.write()
