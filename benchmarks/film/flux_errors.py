"""Errors of smooth films against the limit of fine grids, by the flow through faces."""

from collections.abc import Callable
from statistics import median

import numpy as np

from benchmarks.film.flux_films import Film
from benchmarks.pages import Page

FLUXES = ("fitted", "upwind")
BARS = {65: 6.0, 129: 1.0}  # nodes, %
Solve = Callable[[int, str], Film]


def limit_of(solve: Solve, coarse: int, fine: int, flux: str = "fitted") -> np.ndarray:
    """Return central and smallest film [m] of two grids, extrapolated at second order."""
    first, second = (np.array((found.central, found.least)) for found in (solve(coarse, flux), solve(fine, flux)))
    return second + (second - first) / 3.0


def errors(solve: Solve, flux: str, limit: np.ndarray) -> list[tuple[float, float]]:
    """Return the errors [%] of central and smallest film on the coarse grids."""
    found = [solve(nodes, flux) for nodes in BARS]
    return [tuple(100.0 * (np.array((one.central, one.least)) / limit - 1.0)) for one in found]


class Errors:
    """A table of errors; keeps the largest ones of the fitted flow, up to Moes' M = moderate and of all, and the orders."""

    def __init__(self, page: Page, moderate: float, *names: str) -> None:
        self.page, self.moderate = page, moderate
        self.worst: dict[tuple[int, bool], tuple[float, str]] = {}  # by nodes and whether M is moderate
        self.orders: dict[str, list[float]] = {flux: [] for flux in FLUXES}
        columns = (f"{flux}: {what} {n}" for flux in FLUXES for what in ("h_central", "h_min") for n in BARS)
        page.header(*names, *columns)

    def add(self, place: dict[str, float], solve: Solve, limit: np.ndarray) -> None:
        """Add a row."""
        cells: list[float] = []
        for flux in FLUXES:
            found = errors(solve, flux, limit)
            cells += [one[what] for what in (0, 1) for one in found]
            self.orders[flux].append(float(np.log2(abs(found[0][0] / found[1][0]))))
            if flux == "fitted":
                at = ", ".join(f"{name} = {value:g}" for name, value in place.items())
                for nodes, one in zip(BARS, found, strict=True):
                    key = nodes, place["M"] <= self.moderate
                    self.worst[key] = max(self.worst.get(key, (0.0, "")), (abs(one[0]), at))
        self.page.row(*place.values(), *map(float, cells))

    def close(self, of: str) -> None:
        """Add the verdicts and the order."""
        for moderate in (True, False):
            for nodes, most in BARS.items():
                if (nodes, moderate) in self.worst:
                    error, at = self.worst[nodes, moderate]
                    loads = f"M {'to' if moderate else 'above'} {self.moderate:g}"
                    asked = f"{of}, {loads}: h_central within {most:g} % on {nodes} nodes"
                    self.page.verdict(asked, f"{error:.2f} % at {at}", error <= most)
        orders = ", ".join(f"{median(self.orders[flux]):.1f} {flux}" for flux in FLUXES)
        self.page.say(f"Order of h_central from 65 to 129 nodes, median: {orders}.")
