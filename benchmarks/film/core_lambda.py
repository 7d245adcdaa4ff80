"""Contact over the ratio of film to roughness, on several grids, floors and by both criteria."""

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import brentq

from benchmarks.film.cases import Level, RoughCase, cascade
from benchmarks.pages import Page
from contact_core.film.instant import Settings
from contact_core.film.outputs import disc

BASE = RoughCase(53.70, 9.525e-3, 0.004, 14.94e-9, 131.5e-9, 20e-6, 0.1)  # case B
LAMBDAS = (0.005, 0.02, 0.05, 0.1, 0.3, 0.6, 1.2, 2.5, 4.0)
GRIDS = (65, 129, 257)
FINEST = 513  # at a floor of 1 nm only
ITERATIONS = 200
THICK = 2.0  # lambda from which on films go to 257 nodes: Newton's method takes long on more
# name: floor [m], lumped, grids
SERIES = {
    "split, 0.3 nm": (0.3e-9, False, GRIDS),
    "split, 1 nm": (1e-9, False, (*GRIDS, FINEST)),
    "split, 3 nm": (3e-9, False, GRIDS),
    "lumped, 0.47 nm": (0.47e-9, True, GRIDS),
}
LOOKS = {65: ("0.75", "o"), 129: ("#7fb3d5", "s"), 257: ("#2471a3", "D"), 513: ("#0b2e4f", "^")}
SHOWN = (("contact_load_ratio", "W_c"), ("contact_area_ratio", "A_c"), ("gap", "mean gap / rms roughness"))


def at(ratio: float) -> RoughCase:
    """The case whose formula film is `ratio` times its roughness: speed decides."""
    speed = brentq(lambda log: replace(BASE, speed=np.exp(log)).film - ratio * BASE.rq, np.log(1e-6), np.log(500.0))
    return replace(BASE, speed=float(np.exp(speed)))


def mean_gap(level: Level, case: RoughCase) -> float:
    """Over the disc r < 2a/3, in rms roughness."""
    return float(level.film.gap[disc(level.grid, case.hertz)].mean() / case.rq)


def run() -> None:
    report = Page("film/core", "Contact over lambda, grid, floor and criterion", "lambda")
    report.say(
        f"Load, ball and oil of case B, one Gaussian surface of Rq {BASE.rq * 1e9:.1f} nm and correlation length "
        f"{BASE.correlation * 1e6:.0f} um, the same on every grid; the speed sets the lambda ratio, the formula film of smooth bodies over "
        "Rq. The domain fits the film, so nodes are closer for thin films. The coarsest grid is solved by "
        f"`contact_core/film/routes.py`, finer ones by at most {ITERATIONS} hybrid iterations from the one before, to a pressure "
        "change of 1e-3; from lambda 2.5 on (split) by Newton's method, to 257 nodes. W_c: load share of the solids; A_c: their area over Hertz's; gap: mean over r < 2a/3, in Rq."
    )
    report.header("criterion, floor", "lambda", "u [m/s]", "nodes", "W_c", "A_c", "gap", "imbalance", "converged")
    table: dict[tuple[str, int, float], dict[str, float]] = {}
    for name, (floor, lumped, grids) in SERIES.items():
        for ratio in LAMBDAS:
            case = at(ratio)
            settings = Settings(floor, 1e-3, ITERATIONS, "pyfftw", lumped, fitted=True)
            thick = ratio >= THICK and not lumped
            for level in cascade(case, GRIDS if thick else grids, settings):
                found = level.outputs | {"gap": mean_gap(level, case)}
                table[name, level.nodes, ratio] = found
                shown = (found[key] for key, _ in SHOWN)
                film = level.film
                report.row(name, ratio, round(case.speed, 5), level.nodes, *shown, film.imbalance, film.converged)
    draw(report, table)
    judge(report, table)
    report.write()


def draw(report: Page, table: dict[tuple[str, int, float], dict[str, float]]) -> None:
    figure = Figure(figsize=(11.0, 8.4), layout="constrained")
    axes = figure.subplots(len(SHOWN), len(SERIES), sharex=True, sharey="row")
    for column, name in enumerate(SERIES):
        for row, (key, label) in enumerate(SHOWN):
            panel = axes[row, column]
            for nodes, (colour, marker) in LOOKS.items():
                points = [(ratio, table[name, nodes, ratio][key]) for ratio in LAMBDAS if (name, nodes, ratio) in table]
                if points:
                    panel.plot(
                        *zip(*points, strict=True), color=colour, marker=marker, ms=4, lw=1.5, label=f"{nodes} nodes"
                    )
            if key == "contact_load_ratio":
                panel.fill_between([0.05, 0.1], 0.8, 0.9, color="#e59866", alpha=0.7, label="Zhu & Wang 2012")
                panel.set_title(name, fontsize="medium")
            if key == "gap":
                panel.set(xlabel="lambda", yscale="log")
            panel.set_xscale("log")
            panel.spines[["top", "right"]].set_visible(False)
            panel.grid(color="0.93")
            if column == 0:
                panel.set_ylabel(label)
    axes[0, 1].legend(frameon=False, fontsize="small")
    report.picture(figure, "core_lambda.png", "contact over lambda, one column a criterion and floor")


def judge(report: Page, table: dict[tuple[str, int, float], dict[str, float]]) -> None:
    full = [(key, found) for key, found in table.items() if key[0].startswith("split") and found["h_c"] / BASE.rq > 1.2]
    worst = max(full, key=lambda item: item[1]["contact_load_ratio"])
    report.verdict(
        "W_c < 2 % where the computed h_c / sigma > 1.2 (split)",
        f"at most {100 * worst[1]['contact_load_ratio']:.2f} % of {len(full)} films ({worst[0][1]} nodes, lambda {worst[0][2]:g})",
        worst[1]["contact_load_ratio"] < 0.02,
    )
    for name in ("lumped, 0.47 nm", "split, 1 nm"):
        each = {
            nodes: [table[name, nodes, ratio]["contact_load_ratio"] for ratio in (0.05, 0.1)]
            for nodes in SERIES[name][2]
        }
        text = "; ".join(f"{nodes} nodes {shares[0]:.2f}, {shares[1]:.2f}" for nodes, shares in each.items())
        inside = all(0.8 < share < 0.9 for shares in each.values() for share in shares)
        report.verdict(f"Zhu & Wang's 0.8 < W_c < 0.9 at lambda 0.05 and 0.1, beside {name}", text, inside)
    report.say("### Dependence on the grid\n\nChange from the second finest to the finest grid, floor 1 nm, split:")
    report.header("lambda", "nodes", "W_c", "A_c", "gap [%]")
    for ratio in LAMBDAS:
        last = (GRIDS[-1], FINEST) if ratio < THICK else GRIDS[-2:]
        coarse, fine = (table["split, 1 nm", nodes, ratio] for nodes in last)
        changes = [f"{coarse[key]:.3f} to {fine[key]:.3f}" for key, _ in SHOWN[:2]]
        report.row(ratio, f"{last[0]} to {last[1]}", *changes, 100.0 * (fine["gap"] / coarse["gap"] - 1.0))
    report.say(STATEMENT)


STATEMENT = """**Independent of the grid:** the mean gap, to about 15 % from 129 nodes on; and all of W_c, A_c and gap where the
floor is thicker than the film without it (lambda 0.005 with a floor of 1 nm or more): there the solution is the dry one.

**Not independent of it:** W_c and A_c by the split criterion from lambda 0.02 to 0.6. They fall with every refinement
and finally vanish. Likely reason: an asperity enters on oil that it compresses ahead of itself, and a grid that does not resolve this
inlet lets it touch. The floor also changes them where it is not far below the film on the asperities. In this range W_c depends on grid
and floor, which must be stated with it. Below lambda 0.3 many of these films have not converged: the table has the error of their
mass balance.

**The lumped criterion** puts the pressure of the solids into the oil's flow. Solids then seal off the oil and remain in
contact: W_c stays about 0.94 up to lambda 0.1 on every grid, and up to lambda 0.3 to 1.2 by the grid, and its mass balance does
not close. That is on the side of the published band (0.8 to 0.9 at lambda 0.05 to 0.1; Zhu & Wang 2012,
doi:10.1177/1350650112461867); the split criterion is far below it, the more so the finer the grid. By these figures the band is
a result of criterion and grid rather than of the contact."""
