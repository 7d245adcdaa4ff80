"""Wear of steel in case A by the thesis's K(h) and with the tribofilm worn first, with and without oxide.

    python -m benchmarks.surfaces.film_wear [--points 65]

Writes docs/measured/surfaces/film_wear.md.
"""

import argparse
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from benchmarks.pages import Page
from benchmarks.timing import timed
from contact_core import Outputs, Scene, advance, initial_state

MINUTES = (1.0, 5.0, 20.0, 60.0, 120.0)
FIRST = {"wear.model": "film_first"}
OXIDE = {"oxide.model": "logarithmic"}
CASES = {
    "K(h)": {},
    "film first": FIRST,
    "film first, film worn 100 times as fast": FIRST | {"wear.film": "1e-4"},
    "film first, steel open under 30 nm": FIRST | {"wear.thin": "30 nm"},
    "K(h) with oxide": OXIDE,
    "film first with oxide": FIRST | OXIDE,
    "no tribofilm": {"tribofilm.model": "none"},
    "no tribofilm, oxide": {"tribofilm.model": "none"} | OXIDE,
}
ROUNDING = 1e-12  # relative, asked of the ledger


class Run(NamedTuple):
    """Outputs at the times, and the CPU time [s]."""

    rows: list[Outputs]
    cost: float


def run(points: int, changes: dict[str, str], level: str) -> Run:
    """Return case A run for two hours, dry contacts driving it."""
    grid = {"film.points": str(points), "control.driver": "dry", "control.dry_instants": "2"}
    scene = Scene.from_toml("azam_case_a", grid | changes).at_level(level)

    def marched() -> list[Outputs]:
        state, rows = initial_state(scene), []
        for early, late in pairwise((0.0, *MINUTES)):
            state, outputs = advance(scene, scene.operation.point, state, 60.0 * (late - early))
            rows.append(outputs)
        return rows

    return Run(*timed(marched))


def closure(rows: list[Outputs]) -> float:
    """Return the largest difference of film grown, removed and present, over what has grown."""
    found = [0.0]
    for out in rows:
        for body in (1, 2):
            grown, removed, film = (
                getattr(out, f"{name}_{body}") for name in ("tribofilm_grown", "tribofilm_removed", "tribofilm")
            )
            found.append(abs(grown - removed - film) / grown if grown > 0.0 else abs(removed) + abs(film))
    return max(found)


def falls(rows: list[Outputs], body: int = 2) -> float:
    """Return the rate of wear in the last interval over that in the first."""
    depths = np.array([0.0, *(getattr(out, f"wear_depth_{body}") for out in rows)])
    rates = np.diff(depths) / np.diff((0.0, *MINUTES))
    return float(rates[-1] / rates[0])


def main() -> None:
    """Run, print and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", type=int, default=65)
    points = parser.parse_args().points
    page = Page("surfaces/film_wear", "Steel worn by K(h), and with the tribofilm worn first")
    page.say(
        f"azam_case_a on {points} nodes, driven by dry contacts, two hours. Wear is of the disc (body 2), a mean over its "
        "track. *Slows to*: the rate of wear in the last hour over that in the first minute. Constants of film wear, of "
        "the share of steel left open and of the oxide are assumed."
    )
    for level in ("deterministic", "regression"):
        page.say(f"### Level {level}")
        times = [f"wear at {minutes:g} min, nm" for minutes in MINUTES]
        last = ("slows to", "film, nm", "grown, nm", "removed, nm", "oxide, nm", "friction", "CPU, s")
        page.header("law", *times, *last)
        ran = {name: run(points, changes, level) for name, changes in CASES.items()}
        for name, (rows, cost) in ran.items():
            out = rows[-1]
            nm = [
                1e9 * value for value in (out.tribofilm_2, out.tribofilm_grown_2, out.tribofilm_removed_2, out.oxide_2)
            ]
            depths = [1e9 * row.wear_depth_2 for row in rows]
            page.row(name, *depths, falls(rows), *nm, out.friction_coefficient, cost)
        slows = {name: falls(found.rows) for name, found in ran.items()}
        page.verdict(
            f"wear of steel falls more with the film worn first ({level})",
            f"to {slows['film first']:.3g} of its first rate; K(h) to {slows['K(h)']:.3g}",
            slows["film first"] < slows["K(h)"],
        )
        less, more = ran["film first"].rows[-1], ran["film first, film worn 100 times as fast"].rows[-1]
        page.verdict(
            f"a film that wears faster is thinner, and more steel is lost ({level})",
            f"{1e9 * less.tribofilm_2:.3g} to {1e9 * more.tribofilm_2:.3g} nm; "
            f"{1e9 * less.wear_depth_2:.3g} to {1e9 * more.wear_depth_2:.3g} nm",
            more.tribofilm_2 < less.tribofilm_2 and more.wear_depth_2 > less.wear_depth_2,
        )
        worst = max(closure(found.rows) for found in ran.values())
        page.verdict(f"grown less removed is the film, to {ROUNDING:g} ({level})", f"{worst:.1e}", worst < ROUNDING)
        dear = ran["film first with oxide"].cost / ran["K(h)"].cost
        page.say(f"Film wear and oxide together cost {dear:.2f} of the run with K(h).")
    page.write()


if __name__ == "__main__":
    main()
