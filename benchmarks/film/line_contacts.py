"""Line contacts: films of smooth lines against formulas, cost of rough lines, rollers with ends.

python -m benchmarks.film.line_contacts
"""

import math
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from benchmarks.film.cases import waves
from benchmarks.pages import Page
from benchmarks.timing import timed, work_unit
from contact_core import Logarithmic, Rounded
from contact_core.calls.line_contact import LineContact, line_contact
from contact_core.reference import SmoothLine, dowson_line, hertz_line, lundberg_depth, moes_line_film

RADIUS, MODULUS, VISCOSITY, ALPHA = 10e-3, 2.3e11, 0.05, 2e-8
LOADS, LUBRICANTS, GRIDS = (10.0, 50.0, 200.0, 1000.0), (2.0, 5.0, 10.0, 15.0), (513, 1025, 2049)
LENGTH, SPEED, NODES = 5e-3, 5.0, (65, 129, 257)
ROLLER_LOADS = (5e4, 1e5, 2e5, 4e5)  # N/m
SOURCE = (
    "Alakhramsing, de Rooij, Schipper & van Drogen, Proc. IMechE J (2017), "
    "[doi:10.1177/1350650117705037](https://doi.org/10.1177/1350650117705037)"
)


def arguments(load: float, speed: float) -> dict[str, Any]:
    return {
        "load": load, "radius": RADIUS, "reduced_modulus": MODULUS, "speed_1": speed, "speed_2": speed,
        "viscosity": VISCOSITY, "pressure_viscosity": ALPHA,
    }  # fmt: skip


def of_moes(load: float, lubricant: float) -> tuple[dict[str, Any], float]:
    """Arguments of `line_contact` for Moes' numbers, and the unit of the film [m]."""
    u = (lubricant / (ALPHA * MODULUS)) ** 4
    speed = 0.5 * u * MODULUS * RADIUS / VISCOSITY
    return arguments(load * MODULUS * RADIUS * math.sqrt(u), speed), RADIUS * math.sqrt(u)


def lines(report: Page) -> None:
    report.say(
        "### Smooth lines\n\nBarus, incompressible, the domain that `line_contact` chooses; films in Moes' units, "
        f"extrapolated from the two finest of {', '.join(map(str, GRIDS))} nodes, at M = 1000 from twice as many because of its "
        f"short inlet. Order: of the three. Cost: of {GRIDS[0]} nodes and of half of them, which the error "
        "estimate needs; WU: a convolution of one row."
    )
    report.header(
        "M", "L", "H_c", "Moes", "off [%]", "order", "H_min", "order", "Dowson", "off [%]", "ms", "WU", "converged"
    )
    orders, off, solved = [], [], True
    for load in LOADS:
        for lubricant in LUBRICANTS:
            given, unit = of_moes(load, lubricant)
            plain = given | {"viscosity_law": "barus", "density_law": "none", "tolerance": 1e-5}
            line_contact(**plain, grid=GRIDS[0])
            seconds = timed(lambda plain=plain: line_contact(**plain, grid=GRIDS[0]), 3)[1]
            grids = GRIDS if load < 1000.0 else [2 * nodes - 1 for nodes in GRIDS]
            found = [line_contact(**plain, grid=nodes) for nodes in grids]
            films = np.array([(film.h_central, film.h_min) for film in found]) / unit
            order = np.log2(np.abs((films[1] - films[0]) / (films[2] - films[1])))
            limit = films[2] + (films[2] - films[1]) / 3.0
            formula = moes_line_film(load, lubricant)
            bodies = given["load"], given["speed_1"], VISCOSITY, ALPHA, RADIUS, MODULUS
            dowson = dowson_line(SmoothLine(*bodies))[1] / unit
            every = all(film.converged for film in found)
            solved = solved and every
            if every:
                orders.append(order)
                off.append((abs(limit[0] / formula - 1.0), load, lubricant))
            else:  # what a grid says that has not converged extrapolates to nothing
                limit = order = np.full(2, math.nan)
            report.row(
                load, lubricant, limit[0], formula, 100.0 * (limit[0] / formula - 1.0), order[0], limit[1], order[1],
                dowson, 100.0 * (limit[1] / dowson - 1.0), 1e3 * seconds,
                seconds / work_unit(GRIDS[0], rows=1, periodic=True), every,
            )  # fmt: skip
    worst = max(off)
    report.verdict("every smooth line converges", "all" if solved else "not all", solved)
    report.verdict(
        "order of H_c >= 1.9 where all grids converge",
        f"from {min(o[0] for o in orders):.2f}",
        bool(min(o[0] for o in orders) >= 1.9),
    )
    at = f"{100.0 * worst[0]:.1f} % at M = {worst[1]:g}, L = {worst[2]:g}"
    report.verdict("H_c within 10 % of Moes' formula where all grids converge", at, worst[0] <= 0.1)


def rough_lines(report: Page) -> None:
    given, unit = of_moes(200.0, 10.0)
    film = moes_line_film(200.0, 10.0) * unit
    a = hertz_line(given["load"], RADIUS, 1.0, MODULUS).a
    report.say(
        f"### Rough lines\n\nM = 200, L = 10: a film of {film * 1e9:.0f} nm; 32 rows by 129 nodes of "
        f"[-2, 2] Hertz half widths, correlation length a quarter of one."
    )
    report.header("film / rms", "algorithm", "iterations", "ms", "WU", "solids' share", "converged")
    spacing, unit_cost = 4.0 * a / 128, work_unit(129, rows=32, periodic=True)
    x, y = np.arange(129) * spacing, np.arange(64) * spacing
    pattern = waves(x, y, 1.0, 0.25 * a, 1)
    fade = 0.5 - 0.5 * np.cos(np.pi * (np.arange(32) + 0.5) / 32)  # the rows after these fade into those before
    pattern = (fade[:, None] * pattern[:32] + fade[::-1, None] * pattern[32:]) / np.hypot(fade, fade[::-1])[:, None]
    for clearance in (5.0, 2.0, 1.0, 0.5):
        heights = film / clearance * pattern
        ask = {**given, "heights_1": heights, "spacing": spacing}
        line_contact(**ask)
        found, seconds = timed(lambda ask=ask: line_contact(**ask), 3)
        share = found.contact_load_ratio
        report.row(
            clearance, found.algorithm, found.iterations, 1e3 * seconds, seconds / unit_cost, share, found.converged
        )


def roller(load: float, profile: Any, nodes: int) -> tuple[LineContact, float]:
    """A roller, and the CPU seconds it took."""
    return timed(lambda: line_contact(**arguments(load, SPEED), length=LENGTH, profile=profile, grid=nodes), 3)


def middle(found: LineContact) -> float:
    """Smallest film [m] of the middle row."""
    return float(found.film[np.abs(found.y).argmin()].min())


def rollers(report: Page) -> None:
    design = lundberg_depth(ROLLER_LOADS[2] * LENGTH, LENGTH, MODULUS)
    profiles = {
        "logarithmic, twice Lundberg's depth": Logarithmic(2.0 * design),
        "logarithmic, Lundberg's depth": Logarithmic(design),
        "rounded, radius 10 mm": Rounded(0.8 * LENGTH, 10e-3),
        "rounded, radius 50 mm": Rounded(0.8 * LENGTH, 50e-3),
        "all but sharp": Rounded(0.8 * LENGTH, 1.0),
    }
    report.say(
        f"### Rollers with ends\n\nSteel, radius {RADIUS * 1e3:g} mm, length {LENGTH * 1e3:g} mm, {SPEED:g} m/s, "
        f"{ROLLER_LOADS[2] / 1e3:g} kN/m for which Lundberg's depth is {design * 1e6:.2f} um; a rounded end begins at "
        "0.8 of the length. Cost: of the grid and that of half the nodes."
    )
    report.header(
        "profile", "rows x nodes", "middle [nm]", "least [nm]", "at y / (length / 2)", "solids' share", "algorithm",
        "ms", "WU", "converged",
    )  # fmt: skip
    figure = Figure(figsize=(9.0, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    solved, slowest, kept = True, 0.0, {}
    for name, profile in profiles.items():
        films = []
        for nodes in NODES[:2]:
            roller(ROLLER_LOADS[2], profile, nodes)
            found, seconds = roller(ROLLER_LOADS[2], profile, nodes)
            rows = found.y.size
            at = abs(found.y[np.unravel_index(found.film.argmin(), found.film.shape)[0]]) / (0.5 * LENGTH)
            cost = seconds / work_unit(nodes, 20, rows)
            solved, slowest = solved and found.converged, max(slowest, seconds)
            report.row(
                name, f"{rows} x {nodes}", 1e9 * middle(found), 1e9 * found.h_min, float(at), found.contact_load_ratio,
                found.algorithm, 1e3 * seconds, cost, found.converged,
            )  # fmt: skip
            films.append(found)
        kept[name] = films[-1]
        inside = np.abs(films[-1].y) <= 0.5 * LENGTH
        left.plot(films[-1].y[inside] * 1e3, films[-1].film[inside].min(axis=1) * 1e6, label=name, lw=1.4)
    left.set(xlabel="y [mm]", ylabel="smallest film of the row [um]", ylim=(0, 2), xlim=(-2.5, 2.5))
    left.legend(frameon=False, fontsize=7)
    report.verdict("rollers of 65 and 129 nodes converge", "all" if solved else "not all", solved)
    report.verdict("within seconds", f"{slowest:.1f} s at most", slowest < 10.0)

    profile = profiles["rounded, radius 10 mm"]
    report.say(
        "The smallest film thickness lies where the end is rounded, and depends on the grid for longer than that of the middle. "
        "Rounded with 10 mm:"
    )
    report.header("nodes", "middle [nm]", "least [nm]")
    films = [roller(ROLLER_LOADS[2], profile, nodes)[0] for nodes in NODES]
    values = np.array([(middle(film), film.h_min) for film in films])
    for nodes, (own, least) in zip(NODES, values, strict=True):
        report.row(nodes, 1e9 * own, 1e9 * least)
    order = np.log2((values[1] - values[0]) / (values[2] - values[1]))
    report.row("order", *order)
    report.verdict("both films of a roller converge, order >= 1.2", f"{order[0]:.2f}, {order[1]:.2f}", min(order) > 1.2)

    report.say(
        f"With the load the smallest film thickness falls more steeply than that of the middle, as found with finite elements ({SOURCE}; "
        "its abstract states the trend; its numbers were not available). 129 nodes; power of the load between rows."
    )
    report.header("load [kN/m]", "middle [nm]", "least [nm]", "least / middle", "power of the middle", "of the least")
    films = [roller(load, profile, 129)[0] for load in ROLLER_LOADS]
    values = np.array([(middle(film), film.h_min) for film in films])
    powers = np.diff(np.log(values), axis=0) / np.diff(np.log(ROLLER_LOADS))[:, None]
    for k, (load, (own, least)) in enumerate(zip(ROLLER_LOADS, values, strict=True)):
        power = tuple(map(float, powers[k - 1])) if k else ("", "")
        report.row(load / 1e3, 1e9 * own, 1e9 * least, least / own, *power)
    report.verdict(
        "the end film falls at least twice as steeply with load as that of the middle",
        ", ".join(f"{end:.2f} against {own:.2f}" for own, end in powers),
        bool((powers[:, 1] < 2.0 * powers[:, 0]).all()),
    )
    right.loglog(np.array(ROLLER_LOADS) / 1e3, values * 1e9, "o-")
    right.set(xlabel="load [kN/m]", ylabel="film [nm]")
    right.xaxis.set_minor_formatter("")
    right.legend(["smallest of the middle row", "smallest, at the ends"], frameon=False, fontsize=7)
    for axes in (left, right):
        axes.spines[["top", "right"]].set_visible(False)
    report.picture(figure, "line_contacts.png", "film along the roller; both films over the load")


def main() -> None:
    report = Page("film/line_contacts", "Line contacts")
    for part in (lines, rough_lines, rollers):
        part(report)
    report.write()


if __name__ == "__main__":
    main()
