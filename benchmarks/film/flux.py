"""Error of films by the flow through faces: `film.flux` = "fitted" and "upwind", against the grid.

    python -m benchmarks.film.flux

Writes docs/measured/film/flux.md in about two minutes.
"""

from dataclasses import replace

import numpy as np

from benchmarks.film.cases import MoesCase, instant_of_call
from benchmarks.pages import Page
from contact_core import Scene, advance, initial_state
from contact_core.deterministic.instant import instant_of
from contact_core.film.fitted import Extent
from contact_core.film.instant import Grid, Instant, Settings
from contact_core.film.outputs import at_centre
from contact_core.film.routes import solve_film
from contact_core.scene import Case
from contact_core.shapes import Point

SCENES = ("azam_case_a", "mtm_zddp")
GRIDS, FINEST = (65, 129, 257), 513
LOADS, LUBRICANTS = (20.0, 200.0, 1000.0), (2.0, 10.0)  # Moes' M and L
FLUXES = ("fitted", "upwind")
FLOOR = 1e-11  # m: none
Film = tuple[float, float]  # central and smallest film [m]


def film(now: Instant, grid: Grid, flux: str, tolerance: float = 3e-4) -> Film:
    """Return the smooth film of an instant."""
    found = solve_film(now, grid, Settings(FLOOR, tolerance, 2000, "pyfftw", fitted=flux == "fitted"))
    return at_centre(grid, found.gap), float(found.gap.min())


def scene_film(name: str, nodes: int, flux: str) -> Film:
    """Return the film of a scene's smooth bodies on its own domain."""
    scene = Scene.from_toml(name, {"film.points": str(nodes)})
    case = Case.bind(scene, scene.operation.point)
    grid = scene.grid(scene.rows)
    return film(replace(instant_of(case, np.zeros(grid.shape), np.full(grid.shape, 1e11)), hardness=1e11), grid, flux)


def moes_film(load: float, lubricant: float, nodes: int, flux: str) -> Film:
    """Return the film of a circular contact on a grid that fits it, in Moes' unit."""
    case = MoesCase(load, lubricant)
    arguments = case.arguments()
    extent = Extent.of(Point(case.radius, case.radius), case.newtons, case.modulus, case.smooth.film)
    grid = extent.grid(*extent.shape(shorter=nodes))
    central, least = film(instant_of_call(arguments, np.zeros(grid.shape)), grid, flux)
    return central / case.unit, least / case.unit


def scenes(page: Page) -> None:
    """Add both shipped scenes with smooth bodies."""
    page.say(
        f"### Smooth bodies of the shipped scenes, on their own domain\n\nErrors of h_central and h_min in %, of the fitted flow on "
        f"{FINEST} nodes. The last column is another limit: the upwind flow on {GRIDS[-1]} and {FINEST} nodes, extrapolated at second order."
    )
    page.header("scene", "flux", *(f"{what} {n}" for n in GRIDS for what in ("h_central", "h_min")), "limit [nm]", "upwind's")
    for name in SCENES:
        limit = scene_film(name, FINEST, "fitted")
        coarse, fine = (scene_film(name, nodes, "upwind")[0] for nodes in (GRIDS[-1], FINEST))
        other = fine + (fine - coarse) / 3.0
        for flux in FLUXES:
            found = [scene_film(name, nodes, flux) for nodes in GRIDS]
            errors = [100.0 * (value / exact - 1.0) for one in found for value, exact in zip(one, limit, strict=True)]
            page.row(name, flux, *errors, limit[0] * 1e9, other * 1e9)
            if flux == "fitted":
                page.verdict(f"{name}: h_central within 0.5 % on 129 nodes", f"{errors[2]:+.2f} %", abs(errors[2]) <= 0.5)


def circles(page: Page) -> None:
    """Add circular contacts over Moes' plane."""
    page.say(
        "### Circular contacts on grids that fit them\n\nErrors of h_central and h_min in %, of the fitted flow on 129 and 257 nodes, "
        "extrapolated at second order."
    )
    page.header("M", "L", "flux", *(f"{what} {n}" for n in GRIDS[:2] for what in ("h_central", "h_min")))
    worst = {nodes: 0.0 for nodes in GRIDS[:2]}
    for load in LOADS:
        for lubricant in LUBRICANTS:
            coarse, fine = (np.array(moes_film(load, lubricant, n, "fitted")) for n in GRIDS[1:])
            limit = fine + (fine - coarse) / 3.0
            for flux in FLUXES:
                found = [100.0 * (np.array(moes_film(load, lubricant, n, flux)) / limit - 1.0) for n in GRIDS[:2]]
                page.row(load, lubricant, flux, *(float(value) for one in found for value in one))
                if flux == "fitted":
                    for nodes, one in zip(worst, found, strict=True):
                        worst[nodes] = max(worst[nodes], abs(float(one[0])))
    for nodes, most in ((65, 6.0), (129, 1.0)):
        page.verdict(f"h_central within {most:g} % on {nodes} nodes", f"{worst[nodes]:.2f} %", worst[nodes] <= most)


def rough(page: Page) -> None:
    """Add the first block of both scenes on fresh, moving surfaces above a hard floor."""
    page.say(
        "### First block of the shipped scenes: fresh, moving surfaces\n\nThe solids touch at a floor of 1 nm; what no grid carries of "
        "real roughness is left out."
    )
    page.header("scene", "flux", "nodes", "W_c", "A_c", "friction", "h_c [nm]", "unconverged")
    for name in SCENES:
        for flux in FLUXES:
            for nodes in GRIDS[:2]:
                scene = Scene.from_toml(name, {"film.points": str(nodes), "film.flux": flux})
                _, out = advance(scene, scene.operation.point, initial_state(scene), 0.0)
                values = (out.contact_load_ratio, out.contact_area_ratio, out.friction_coefficient, out.h_c * 1e9)
                page.row(name, flux, nodes, *values, out.unconverged)


def main() -> None:
    page = Page("film/flux", "Flow through faces: films against the grid")
    scenes(page)
    circles(page)
    rough(page)
    page.write()


if __name__ == "__main__":
    main()
