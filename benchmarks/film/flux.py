"""Error of films by the flow through faces: `film.flux` = "fitted" and "upwind", against the grid.

    python -m benchmarks.film.flux

Writes docs/measured/film.md in about three minutes.
"""

from benchmarks.film import flux_valleys
from benchmarks.film.flux_errors import FLUXES, Errors, limit_of
from benchmarks.film.flux_films import LENGTH, Film, line_film, point_film, roller_film, scene_film
from benchmarks.pages import Page
from contact_core import Scene, advance, initial_state

SCENES = ("azam_case_a", "mtm_zddp")
GRIDS, FINEST, LAST = (65, 129, 257), 513, 1025
LOADS, LUBRICANTS, RATIOS = (20.0, 200.0, 1000.0, 4000.0), (2.0, 5.0, 10.0, 15.0), (0.2, 0.5, 2.0, 5.0)
HARD = {"surface_1.microroughness.rms": "0 m", "surface_2.microroughness.rms": "0 m"}
LINES, ROLLERS = (20.0, 50.0, 200.0, 1000.0), ((20.0, 5.0), (50.0, 10.0), (100.0, 10.0))


def scenes(page: Page) -> None:
    """Add both shipped scenes with smooth bodies."""
    page.say(
        f"### Smooth bodies of the shipped scenes, on their own domain\n\nErrors of h_central and h_min in %, of the fitted flow on "
        f"{LAST} nodes. The last column is another limit: the upwind flow on {GRIDS[-1]} and {FINEST} nodes, extrapolated at second order."
    )
    page.header(
        "scene", "flux", *(f"{what} {n}" for n in GRIDS for what in ("h_central", "h_min")), "limit [nm]", "upwind's"
    )
    for name in SCENES:

        def solve(nodes: int, flux: str, name: str = name) -> Film:
            return scene_film(name, nodes, flux)

        finest = solve(LAST, "fitted")
        other = limit_of(solve, GRIDS[-1], FINEST, "upwind")[0]
        for flux in FLUXES:
            found = [solve(nodes, flux) for nodes in GRIDS]
            off = [
                100.0 * (v / e - 1.0)
                for one in found
                for v, e in ((one.central, finest.central), (one.least, finest.least))
            ]
            page.row(name, flux, *off, finest.central * 1e9, float(other) * 1e9)
            if flux == "fitted":
                page.verdict(f"{name}: h_central within 0.5 % on 129 nodes", f"{off[2]:+.3f} %", abs(off[2]) <= 0.5)


def circles(page: Page) -> None:
    """Add circular contacts over Moes' plane."""
    page.say(
        f"### Circular contacts on grids that fit them\n\nErrors in %, of the fitted flow on {GRIDS[-1]} and {FINEST} nodes, extrapolated "
        f"at second order; for M = {LOADS[0]:g} on {GRIDS[1]} and {GRIDS[2]} nodes, as M = 20, L = 15 does not converge on {FINEST}."
    )
    table = Errors(page, 1000.0, "M", "L")
    for load in LOADS:
        for lubricant in LUBRICANTS:

            def solve(nodes: int, flux: str, of: tuple[float, float] = (load, lubricant)) -> Film:
                return point_film(*of, 1.0, nodes, flux)

            pair = (GRIDS[1], GRIDS[2]) if load == LOADS[0] else (GRIDS[2], FINEST)
            table.add({"M": load, "L": lubricant}, solve, limit_of(solve, *pair))
    table.close("circles")


def ellipses(page: Page) -> None:
    """Add elliptical contacts."""
    page.say(
        "### Elliptical contacts on grids that fit them\n\nL = 10; nodes along the shorter side. Errors in %, of the fitted flow on "
        f"{GRIDS[1]} and {GRIDS[2]} nodes, extrapolated at second order. At R_y / R_x = 5, M = 20 the spike of the pressure stands at x = 0, "
        "where h_central is read."
    )
    table = Errors(page, 1000.0, "R_y / R_x", "M")
    for ratio in RATIOS:
        for load in LOADS:

            def solve(nodes: int, flux: str, of: tuple[float, float, float] = (load, 10.0, ratio)) -> Film:
                return point_film(*of, nodes, flux)

            table.add({"R_y/R_x": ratio, "M": load}, solve, limit_of(solve, *GRIDS[1:]))
    table.close("ellipses")


def lines(page: Page) -> None:
    """Add lines without ends."""
    page.say(
        f"### Lines without ends on one row of nodes\n\nM and L of lines. Errors in %, of the fitted flow on {FINEST} and {LAST} nodes, "
        "extrapolated at second order. The inlet of heavily loaded lines is a small part of their grid: at M = 1000 it is shorter than the spacing of 129 nodes."
    )
    table = Errors(page, 200.0, "M", "L")
    for load in LINES:
        for lubricant in LUBRICANTS[:3]:

            def solve(nodes: int, flux: str, of: tuple[float, float] = (load, lubricant)) -> Film:
                return line_film(*of, nodes, flux)

            table.add({"M": load, "L": lubricant}, solve, limit_of(solve, FINEST, LAST))
    table.close("lines")


def rollers(page: Page) -> None:
    """Add lines with ends."""
    page.say(
        f"### Rollers\n\nLength {LENGTH * 1e3:g} mm, logarithmic profile; h_central in nm at the middle. The limits are extrapolated from "
        "the two finest grids at second order."
    )
    page.header("M", "L", "flux", *map(str, GRIDS), "limit")
    for load, lubricant in ROLLERS:
        limits = []
        for flux in FLUXES:
            films = [1e9 * roller_film(load, lubricant, nodes, flux).central for nodes in GRIDS]
            limits.append(films[2] + (films[2] - films[1]) / 3.0)
            page.row(load, lubricant, flux, *films, limits[-1])
        apart = 100.0 * (limits[0] / limits[1] - 1.0)
        page.verdict(
            f"roller, M = {load:g}, L = {lubricant:g}: both limits within 1 %", f"{apart:+.2f} %", abs(apart) <= 1.0
        )


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
                scene = Scene.from_toml(name, {"film.points": str(nodes), "film.flux": flux} | HARD)
                _, out = advance(scene, scene.operation.point, initial_state(scene), 0.0)
                values = (out.contact_load_ratio, out.contact_area_ratio, out.friction_coefficient, out.h_c * 1e9)
                page.row(name, flux, nodes, *values, out.unconverged)


def main() -> None:
    page = Page("film/flux", "Flow through faces: films against the grid")
    for part in (scenes, flux_valleys.add, circles, ellipses, lines, rollers, rough):
        part(page)
    page.write()


if __name__ == "__main__":
    main()
