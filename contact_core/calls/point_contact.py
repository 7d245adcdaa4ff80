"""Lubricated circular or elliptical point contact at one instant in one call. SI, arrays in and out."""

from dataclasses import dataclass, replace
from typing import Literal, Unpack

import numpy as np

from ..film.fitted import Extent
from ..film.instant import Grid
from ..quantities import TABLE, parameter
from ..shapes import Point
from .common import FilmCall, FilmContact, Numbers, grid_nodes, heights_of, nodes_of, numbers_of, solved
from .options import ContactOptions, check_choices, options_of, refuse, shows_options
from .refinement import MOST_NODES, grids_within, intervals

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


@shows_options
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
    domain: tuple[float, float, float, float] | None = None,
    criterion: Literal["split", "lumped"] = "split",
    **options: Unpack[ContactOptions],
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
    domain
        (x_min, x_max, y_min, y_max) [m] about the contact instead of the grid that fits the film; cells are square.
    criterion
        "split" for fluid and solid pressure apart, "lumped" for one pressure as in Azam et al. 2019 (with
        floor = 0.47e-9).
    **options
        Heights, grid or accuracy, oil supply, laws and more: see `ContactOptions`.

    Raises
    ------
    OperatingPointError
        For values that cannot be used.
    ConvergenceError
        If no solution is found.

    """
    given = options_of(point_contact, options) | {"criterion": criterion}
    contact = {
        "load": load, "radius_x": radius_x, "radius_y": radius_x if radius_y is None else radius_y,
        "reduced_modulus": reduced_modulus, "speed_1": speed_1, "speed_2": speed_2, "viscosity": viscosity,
        "pressure_viscosity": pressure_viscosity,
    }  # fmt: skip
    numbers = numbers_of(_Numbers, contact | given)
    refuse(_too_slim(numbers))
    check_choices(given)
    heights, shape = heights_of(given), Point(numbers.radius_x, numbers.radius_y)
    return solved(PointContact, _Call(shape, numbers.load, numbers, given, domain, heights))


def _too_slim(numbers: _Numbers) -> list[str]:
    if not 1.0 / _SLIMMEST <= numbers.radius_y / numbers.radius_x <= _SLIMMEST:
        return [
            f"radius_y = {numbers.radius_y:g} m is not within 1/{_SLIMMEST:g} and {_SLIMMEST:g} times radius_x = "
            f"{numbers.radius_x:g} m. Take the nearest ratio that is, or a line contact."
        ]
    return []


class _Call(FilmCall):
    shape: Point

    def nodes(self, grid: int | tuple[int, int] | None) -> Grid:
        """Return the nodes that the arguments ask for."""
        heights, spacing = self.heights, self.options["spacing"]
        ny, nx = grid_nodes(grid)
        if heights is not None:
            if heights.shape[0] < 17 or heights.shape[1] < 17:
                refuse([f"heights of {heights.shape} nodes [ny, nx] are too few: 17 along each axis are the least."])
            ny, nx = nodes_of(heights, ny or nx, nx)
        sides = None if self.domain is None else _sides(self.domain)
        if ny is None or nx is None:
            if sides is not None:
                nx = nx or 129
                ny = round((nx - 1) * (sides[3] - sides[2]) / (sides[1] - sides[0])) + 1
            elif self.shape.circular:
                ny, nx = nx or 129, nx or 129
            else:
                ny, nx = self._extent.shape(nx)
        if min(ny, nx) < 17 or max(ny, nx) > 4097:
            refuse([f"grid = {(ny, nx)} must be one number or (ny, nx), from 17 to 4097 nodes along each axis."])
        if sides is not None:
            return _grid_of_sides(sides, spacing, ny, nx)
        if heights is not None and spacing is None:
            refuse(["spacing = None: heights need the distance between their nodes in metres."])
        if spacing is not None:
            return Grid.centred(ny, nx, spacing)
        return self._upstream(self._extent.grid(ny, nx))

    def grids(self) -> list[Grid]:
        """Return grids for smooth bodies, from coarse to fine."""
        if self.domain is not None:
            sides = _sides(self.domain)
            return grids_within(Grid(np.array(sides[:2]), np.array(sides[2:])))
        extent, circular = self._extent, self.shape.circular
        extent = replace(extent, left=max(extent.left, self.before()))
        nodes = ((n, n) if circular else extent.shape(shorter=n) for n in (count + 1 for count in intervals()))
        return [self._upstream(extent.grid(*shape)) for shape in nodes if shape[0] * shape[1] <= MOST_NODES]

    @property
    def _extent(self) -> Extent:
        return Extent.of(self.shape, self.load, self.numbers.reduced_modulus, self.film)

    def _upstream(self, grid: Grid) -> Grid:
        """Return a grid whose longer side is that of the inlet."""
        return grid if self.numbers.entrainment_speed >= 0.0 else grid.mirrored()


def _sides(domain: tuple[float, ...]) -> tuple[float, float, float, float]:
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
