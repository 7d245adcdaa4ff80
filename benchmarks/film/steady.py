"""Steady rough films from boundary to full film on three grids: which of them close their balance of mass.

    python -m benchmarks.film.steady

Writes docs/measured/film/steady.md in about a quarter of an hour.
"""

import time
from dataclasses import replace

from scipy.optimize import brentq

from benchmarks.film.cases import RoughCase, grid_of, instant_of_call
from benchmarks.pages import Page
from contact_core.film.instant import Settings
from contact_core.film.routes import solve_film
from contact_core.laws.asperity_layer import AsperityLayer

GRIDS = (65, 129, 257)
LAMBDAS = (0.005, 0.02, 0.05, 0.1, 0.3, 0.6, 1.0, 2.0, 4.0)  # film of smooth bodies / rms roughness
MICROROUGHNESS = (0.0, 10e-9, 20e-9)  # rms of both bodies together [m]
LONGEST = 4e-6  # m
CHECKED = (0.1, 0.3)  # lambda at which a hard floor has to be the same on the two finer grids
SETTINGS = Settings(floor=1e-9, tolerance=3e-3, iterations=2000, fft="scipy", fitted=True)


def case_of(film_ratio: float) -> RoughCase:
    """Return a ball of mtm_zddp's size on a rough flat, at the speed that makes its film so many rms roughnesses."""
    case = RoughCase(53.70, 9.525e-3, 0.004, 14.94e-9, 131.5e-9, 20e-6, 1.0)
    speed = brentq(lambda u: replace(case, speed=u).film / case.rq - film_ratio, 1e-7, 1e3, rtol=1e-6)
    return replace(case, speed=speed)


def main() -> None:
    page = Page("film/steady", "Steady rough films, from boundary to full film")
    page.say(
        "A ball of 9.5 mm radius under 53.7 N on a rough flat, both at the same speed, so that the roughness stands still in the contact: "
        "rms height 131.5 nm, correlation length 20 um, the same surface on every grid; `film.flux = fitted`, floor 1 nm, tolerance 3e-3. "
        "Lambda is the film of smooth bodies by formula over the rms height. A film that misses its stopping rule is returned with "
        "what it misses; no other number of the row is hidden."
    )
    page.header(
        "nodes",
        "microroughness [nm]",
        "lambda",
        "speed [m/s]",
        "W_c",
        "mean gap over rms height",
        "iterations",
        "CPU time [s]",
        "algorithm",
        "missed",
    )
    missed: dict[int, list[str]] = {}
    hard = {}  # W_c and gap at a hard floor, by nodes and lambda
    for nodes in GRIDS:
        for rms in MICROROUGHNESS:
            for film_ratio in LAMBDAS:
                case = case_of(film_ratio)
                grid, now = (
                    grid_of(case.domain, nodes),
                    instant_of_call(case.arguments(), case.heights(nodes), case.hardness),
                )
                now = replace(now, microroughness=AsperityLayer(rms, LONGEST) if rms else None)
                start = time.process_time()
                found = solve_film(now, grid, SETTINGS)
                seconds = time.process_time() - start
                share = float((found.state.pressure - found.state.fluid).sum() / found.state.pressure.sum())
                gap = float(found.gap[case.hertz.inside(grid.x, grid.y, 2.0 / 3.0)].mean() / case.rq)
                page.row(
                    nodes,
                    f"{rms * 1e9:g}",
                    f"{film_ratio:g}",
                    case.speed,
                    share,
                    gap,
                    found.iterations,
                    seconds,
                    found.algorithm,
                    found.shortfall,
                )
                if not rms:
                    hard[nodes, film_ratio] = share, gap
                if not found.converged:
                    missed.setdefault(nodes, []).append(
                        f"lambda {film_ratio:g}, microroughness {rms * 1e9:g} nm: {found.shortfall}"
                    )
    for nodes in GRIDS:
        text = "; ".join(missed.get(nodes, [])) or "all"
        page.verdict(
            f"{nodes} nodes: all {len(LAMBDAS) * len(MICROROUGHNESS)} films meet the stopping rule; those that miss",
            text,
            nodes not in missed,
        )
    for film_ratio in CHECKED:
        (share, gap), (fine_share, fine_gap) = hard[GRIDS[-2], film_ratio], hard[GRIDS[-1], film_ratio]
        off, apart = 100.0 * (gap / fine_gap - 1.0), share - fine_share
        page.verdict(
            f"hard floor, lambda {film_ratio:g}: {GRIDS[-2]} nodes within 2.5 % (gap) and .002 (W_c) of {GRIDS[-1]}",
            f"{off:+.1f} %, {apart:+.4f}",
            abs(off) < 2.5 and abs(apart) < 0.002,
        )
    page.write()


if __name__ == "__main__":
    main()
