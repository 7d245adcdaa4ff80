"""Lubricated circular or elliptical point contact at one instant in one call. SI, arrays in and out."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..film.instant import Grid
from ..quantities import TABLE, parameter
from ..shapes import Point
from .common import (
    FilmContact,
    Numbers,
    check_choices,
    film_of,
    grid_nodes,
    heights_of,
    numbers_of,
    refuse,
    smooth_of,
    solve_call,
    solve_to_accuracy,
)
from .inlet import extent_before
from .refinement import MOST_NODES, grids_within, intervals, surface_of, wants_accuracy

Array = NDArray[np.float64]

_SLIMMEST = 30.0  # ratio of the radii, either way


class PointContact(FilmContact):
    """Result of `point_contact`, in SI. Arrays [ny, nx], x along entrainment of positive speed.

    Attributes
    ----------
    x, y
        Places of the columns and of the rows [m].
    pressure, fluid_pressure, solid_pressure
        Total pressure, and its parts in the oil and on the solids [Pa].
    film, oil
        Gap, at least the floor, and density ratio times thickness of the oil in it, less than the gap in cavities [m].
    h_c
        Central film thickness: mean gap over the inner 2/3 of Hertz's contact, r < 2a/3, or such an ellipse or strip
        [m].
    h_central
        Gap at the centre of the contact: one node, of a rough contact no film thickness [m].
    h_min
        Smallest gap [m].
    contact_area_ratio, contact_load_ratio
        Area of solid contact over Hertz's, and the solids' share of the load, 0 to 1.
    pressure_max
        Largest pressure [Pa].
    approach
        Approach of the bodies [m].
    error_estimate
        Half width of each of these numbers, in its unit, by coarser grids and a cut inlet.
    warnings
        Reasons why the answer is less reliable.
    steps
        Grids that were solved to meet `accuracy`, in their order.
    converged, shortfall
        Whether the solution is one, and what is missing.
    route, algorithm
        "mixed" or "dry" (no entrainment), and what found the film.
    load_beyond
        Share of the load that a film wider than the grid carries beyond its edge.
    inlet_nodes, resolved
        Nodes across the inlet zone, and whether these are enough for a film that does not depend on the grid.

    """


@dataclass(frozen=True, kw_only=True)
class _Numbers(Numbers):
    """The scalars of a call, with their ranges."""

    load: float = parameter("N", TABLE["load"].text, above=0.0, most=1e6)
    radius_x: float = parameter("m", "combined radius of curvature along x", above=0.0, most=100.0)
    radius_y: float = parameter("m", "combined radius of curvature along y", above=0.0, most=100.0)


def point_contact(
    *,
    load: float,
    radius_x: float,
    radius_y: float | None = None,
    reduced_modulus: float,
    speed_1: float,
    speed_2: float,
    viscosity: float,
    pressure_viscosity: float,
    viscosity_law: str = "roelands",
    density_law: str = "dowson_higginson",
    heights_1: ArrayLike | None = None,
    heights_2: ArrayLike | None = None,
    spacing: float | None = None,
    hardness: float | None = None,
    grid: int | tuple[int, int] | None = None,
    domain: tuple[float, float, float, float] | None = None,
    floor: float = 1e-9,
    criterion: str = "split",
    cavitation: str = "reynolds",
    supply: float | None = None,
    meniscus: float | None = None,
    accuracy: float | None = None,
    tolerance: float | None = None,
    iterations: int = 2000,
    flux: str = "fitted",
    fft: str = "pyfftw",
) -> PointContact:
    """Solve for steady mixed lubrication of a point contact, from full film to dry.

    A solution that has not converged says so (`converged`, `shortfall`). At rest the dry contact is the answer; the gap
    of solids is the floor then, too, so that `approach` is a floor less than that of `dry_contact`.

    Parameters
    ----------
    load
        Normal load [N].
    radius_x, radius_y
        Combined radii of curvature [m]; radius_y = radius_x if not given.
    reduced_modulus
        E' = 2 / [(1 - v1^2)/E1 + (1 - v2^2)/E2] [Pa].
    speed_1, speed_2
        Surface speeds along x relative to the contact [m/s].
    viscosity, pressure_viscosity
        Viscosity [Pa s] and pressure coefficient [1/Pa] at p = 0.
    viscosity_law
        "roelands" or "barus".
    density_law
        "dowson_higginson" or "none".
    heights_1, heights_2
        Heights [ny, nx] of each body [m], positive toward the other one, centred on the contact.
    spacing
        Distance between the nodes of the heights [m].
    hardness
        Largest pressure [Pa]; None: no limit.
    grid
        Nodes along x of smooth bodies, with as many along y as the film needs (the same for a circle), or (ny, nx);
        129 along the shorter side if not given.
    domain
        (x_min, x_max, y_min, y_max) [m] about the contact instead of the grid that fits the film; cells are square.
    floor
        Gap at which solids touch [m].
    criterion
        "split" for fluid and solid pressure apart, "lumped" for one pressure as in Azam et al. 2019 (with
        floor = 0.47e-9).
    cavitation
        "reynolds": a gap without pressure counts as full; "mass_conserving": it holds what flows in.
    supply
        Oil on both surfaces together before the contact [m]; None: flooded.
    meniscus
        Distance [m] before the centre at which the inlet begins to fill; None: at the edge of the grid.
    accuracy
        Largest error of h_central, h_c and pressure_max, relative, and of contact_load_ratio and contact_area_ratio,
        absolute, instead of `grid` and `tolerance`: grids are refined until the stated errors (`error_estimate`) are
        within it; `steps` tells which. They have from 33 to 513 nodes along the shorter side. Heights then define a
        surface, by a cubic spline between their nodes, and all grids, coarser and finer ones, sample it over the same
        extent. The fields of the result lie on the last grid (`x`, `y`), at least as fine as the heights. `warnings`
        tells where the accuracy is not reached.
    tolerance
        Relative pressure change of a converged solution; 1e-3 if not given.
    iterations
        Largest number of iterations.
    flux
        Flow between nodes: "fitted", exact for a constant flow in each cell, or "upwind", of second order.
    fft
        "pyfftw" or "scipy"; FFTW is under the GPL.

    Raises
    ------
    OperatingPointError
        For values that cannot be used.
    ConvergenceError
        If no solution is found.

    """
    numbers = numbers_of(
        _Numbers,
        {
            "load": load, "radius_x": radius_x, "radius_y": radius_x if radius_y is None else radius_y,
            "reduced_modulus": reduced_modulus, "speed_1": speed_1, "speed_2": speed_2, "viscosity": viscosity,
            "pressure_viscosity": pressure_viscosity, "hardness": hardness, "floor": floor, "tolerance": tolerance,
            "iterations": iterations, "spacing": spacing, "supply": supply, "meniscus": meniscus, "accuracy": accuracy,
        },
    )  # fmt: skip
    refuse(_too_slim(numbers))
    options = {
        "viscosity_law": viscosity_law, "density_law": density_law, "criterion": criterion, "cavitation": cavitation,
        "flux": flux, "fft": fft,
    }  # fmt: skip
    check_choices(options)
    heights, shape = heights_of(heights_1, heights_2), Point(numbers.radius_x, numbers.radius_y)
    film = film_of(shape, numbers.load, numbers, supply)
    starved = (supply, meniscus)
    if wants_accuracy(accuracy, grid=grid, tolerance=tolerance):
        if heights is None:
            grids, surface = _grids(numbers, shape, film, domain), None
        else:
            given = _grid(numbers, shape, film, heights, spacing, None, domain)
            grids, surface = grids_within(given), surface_of(heights, given)
        return solve_to_accuracy(PointContact, shape, numbers.load, numbers, grids, surface, starved, options)
    nodes = _grid(numbers, shape, film, heights, spacing, grid, domain)
    return solve_call(PointContact, shape, numbers.load, numbers, nodes, heights, starved, options)


def _too_slim(numbers: _Numbers) -> list[str]:
    if not 1.0 / _SLIMMEST <= numbers.radius_y / numbers.radius_x <= _SLIMMEST:
        return [
            f"radius_y = {numbers.radius_y:g} m is not within 1/{_SLIMMEST:g} and {_SLIMMEST:g} times radius_x = "
            f"{numbers.radius_x:g} m. Take the nearest ratio that is, or a line contact."
        ]
    return []


def _grid(
    numbers: _Numbers,
    shape: Point,
    film: float,
    heights: Array | None,
    spacing: float | None,
    grid: int | tuple[int, int] | None,
    domain: tuple[float, float, float, float] | None,
) -> Grid:
    """Return the nodes that the arguments ask for."""
    ny, nx = grid_nodes(grid)
    if heights is not None:
        if heights.shape[0] < 17 or heights.shape[1] < 17:
            refuse([f"heights of {heights.shape} nodes [ny, nx] are too few: 17 along each axis are the least."])
        if nx is not None and (ny or nx, nx) != heights.shape:
            refuse([f"grid = {grid} does not fit heights of {heights.shape} nodes. Leave grid out: heights decide it."])
        ny, nx = heights.shape
    from ..film.fitted import Extent

    extent = Extent.of(shape, numbers.load, numbers.reduced_modulus, film)
    sides = None if domain is None else _sides(domain)
    if ny is None or nx is None:
        if sides is not None:
            nx = nx or 129
            ny = round((nx - 1) * (sides[3] - sides[2]) / (sides[1] - sides[0])) + 1
        elif shape.circular:
            ny, nx = nx or 129, nx or 129
        else:
            ny, nx = extent.shape(nx)
    if min(ny, nx) < 17 or max(ny, nx) > 4097:
        refuse([f"grid = {(ny, nx)} must be one number or (ny, nx), from 17 to 4097 nodes along each axis."])
    if sides is not None:
        return _grid_of_sides(sides, spacing, ny, nx)
    if heights is not None and spacing is None:
        refuse(["spacing = None: heights need the distance between their nodes in metres."])
    if spacing is not None:
        if not (np.isfinite(spacing) and spacing > 0.0):
            refuse([f"spacing = {spacing:g} m must be finite and above 0."])
        return Grid.centred(ny, nx, spacing)
    found = extent.grid(ny, nx)
    return found if numbers.speed_1 + numbers.speed_2 >= 0.0 else found.mirrored()


def _grids(
    numbers: _Numbers, shape: Point, film: float, domain: tuple[float, float, float, float] | None
) -> list[Grid]:
    """Return grids for smooth bodies, from coarse to fine."""
    from ..film.fitted import Extent

    if domain is not None:
        sides = _sides(domain)
        return grids_within(Grid(np.array(sides[:2]), np.array(sides[2:])))
    extent = Extent.of(shape, numbers.load, numbers.reduced_modulus, film)
    a, smooth = shape.hertz(numbers.load, numbers.reduced_modulus).a, smooth_of(shape, numbers.load, numbers)
    if film > 0.0:
        extent = replace(extent, left=max(extent.left, extent_before(numbers.accuracy, a, shape, smooth)))
    nodes = ((n, n) if shape.circular else extent.shape(shorter=n) for n in (count + 1 for count in intervals()))
    grids = [extent.grid(*shape) for shape in nodes if shape[0] * shape[1] <= MOST_NODES]
    return grids if numbers.entrainment_speed >= 0.0 else [grid.mirrored() for grid in grids]


def _sides(domain: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
    try:
        x_min, x_max, y_min, y_max = (float(value) for value in domain)
        about = x_min < 0.0 < x_max and y_min < 0.0 < y_max and bool(np.isfinite(domain).all())
    except (TypeError, ValueError):
        about = False
    if not about:
        refuse([f"domain = {domain!r} must be (x_min, x_max, y_min, y_max) in metres about the contact at (0, 0)."])
    return x_min, x_max, y_min, y_max


def _grid_of_sides(sides: tuple[float, float, float, float], spacing: float | None, ny: int, nx: int) -> Grid:
    x, y = np.linspace(sides[0], sides[1], nx), np.linspace(sides[2], sides[3], ny)
    dx, dy = x[1] - x[0], y[1] - y[0]
    if abs(dx - dy) > 1e-6 * dx or (spacing is not None and abs(spacing - dx) > 1e-6 * dx):
        refuse(
            [
                f"domain = {sides} on {ny} by {nx} nodes gives distances of {dx:.6g} m along x and {dy:.6g} m along y"
                f"{'' if spacing is None else f', spacing says {spacing:.6g} m'}; they must be the same. "
                "Change grid or domain."
            ]
        )
    return Grid(x, y)
