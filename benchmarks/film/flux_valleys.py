"""The smallest smooth film against the grid: its valley, what nodes miss of it, and the stated error."""

from collections.abc import Callable

import numpy as np

from benchmarks.film.flux_films import FLOOR, TOLERANCE, Place, least_between, point_at, scene_at
from benchmarks.pages import Page
from contact_core.film.estimate import solve_with_estimate
from contact_core.film.instant import Settings
from contact_core.film.routes import solve_film
from contact_core.film.scaled import Scaled

SETTINGS = Settings(FLOOR, TOLERANCE, 2000, "pyfftw", fitted=True)
CIRCLES = tuple((load, lubricant) for load in (200.0, 1000.0, 4000.0) for lubricant in (2.0, 10.0))
SCENES = "azam_case_a", "mtm_zddp"
GRIDS, FINE = (65, 129), (513, 1025)
EDGE = 1.5  # film at which a valley ends, over the smallest

At = Callable[[int], Place]


def width(gap: np.ndarray) -> float:
    """Return the nodes along y over which the film is less than EDGE times the smallest, by straight lines between them."""
    j, i = np.unravel_index(gap.argmin(), gap.shape)
    line = gap[:, i] - EDGE * gap[j, i]
    left, right = j - int(np.argmax(line[j::-1] > 0.0)), j + int(np.argmax(line[j:] > 0.0))
    return float(
        right - left + line[right] / (line[right - 1] - line[right]) + line[left] / (line[left + 1] - line[left])
    )


def add(page: Page) -> None:
    """Add the smallest film of smooth contacts at and between the nodes."""
    page.say(
        f"### Smallest film at the nodes and between them\n\nFitted flow; errors in % against the smallest value of splines through the nodes, "
        f"of {FINE[0]} and {FINE[1]} nodes extrapolated at second order. The smallest film stands in both side lobes, in valleys along x. Valley: "
        f"nodes across it, along y, where the film is below {EDGE} times the smallest. Error: of the smallest node, which is `h_min`. Missed: that "
        f"of the film of {FINE[1]} nodes at the nodes of the coarser grid, which is what nodes miss of a film that is right. Between: of splines "
        "through the coarse grid's nodes. Stated: by `point_contact` and a grid of half the nodes."
    )
    names = ("inlet", "valley", "error", "missed", "between", "stated")
    page.header("contact", "M", *(f"{name} {nodes}" for nodes in GRIDS for name in names))
    contacts: dict[str, At] = {name: lambda nodes, name=name: scene_at(name, nodes) for name in SCENES}
    contacts |= {
        f"circle, M = {load:g}, L = {lubricant:g}": lambda nodes, of=(load, lubricant): point_at(*of, 1.0, nodes)
        for load, lubricant in CIRCLES
    }
    covered, nearer = 0, 0
    for name, at in contacts.items():
        coarse, fine = (solve_film(*at(nodes), SETTINGS).gap for nodes in FINE)
        limit = (4.0 * least_between(fine) - least_between(coarse)) / 3.0
        cells: list[float] = []
        for nodes in GRIDS:
            found, values, stated = solve_with_estimate(*at(nodes), SETTINGS)
            step = (FINE[1] - 1) // (nodes - 1)
            films = np.array((values["h_min"], fine[::step, ::step].min(), least_between(found.gap)))
            off = 100.0 * (films / limit - 1.0)
            cells += [found.inlet_nodes, width(fine) / step, *map(float, off), 100.0 * stated["h_min"] / limit]
            covered += stated["h_min"] >= abs(values["h_min"] - limit)
            nearer += abs(off[2]) < abs(off[0])
        page.row(name, Scaled(*at(FINE[0]), SETTINGS).moes_load, *cells)
    of = len(contacts) * len(GRIDS)
    page.say(
        f"The splines are nearer than the smallest node in {nearer} of {of}; the stated error covers {covered} of {of}."
    )
