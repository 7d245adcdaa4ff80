"""Smooth films of all shapes on a given number of nodes, by the flow through faces."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import RectBivariateSpline

from benchmarks.film.cases import MoesCase, instant_of_call
from contact_core import Logarithmic, Scene
from contact_core.deterministic.instant import instant_of
from contact_core.film.fitted import Extent, line_extent, rows_over
from contact_core.film.instant import Grid, Instant, Settings
from contact_core.film.outputs import at_centre
from contact_core.film.routes import solve_film
from contact_core.scene import Case
from contact_core.shapes import Line, Point, Roller

FLOOR = 1e-11  # m: none
LENGTH, PROFILE = 2e-3, Logarithmic(3e-6)  # of the roller
TOLERANCE, _TOLERANCE_OF_LINES = 3e-4, 1e-5
_AROUND = 6  # nodes to either side that the splines go through
Place = tuple[Instant, Grid]


@dataclass(frozen=True)
class Film:
    """Central and smallest film [m] of a solution."""

    central: float
    least: float  # of the nodes
    converged: bool


def film(now: Instant, grid: Grid, flux: str, tolerance: float = TOLERANCE) -> Film:
    """Return the smooth film of an instant."""
    found = solve_film(now, grid, Settings(FLOOR, tolerance, 2000, "pyfftw", fitted=flux == "fitted"))
    return Film(at_centre(grid, found.gap), float(found.gap.min()), found.converged)


def least_between(gap: np.ndarray) -> float:
    """Return the smallest value of cubic splines through the nodes around the smallest one."""
    j, i = (
        int(np.clip(k, _AROUND, n - 1 - _AROUND))
        for k, n in zip(np.unravel_index(gap.argmin(), gap.shape), gap.shape, strict=True)
    )
    nodes, fine = np.arange(-_AROUND, _AROUND + 1), np.linspace(-1.5, 1.5, 121)
    near = gap[j - _AROUND : j + _AROUND + 1, i - _AROUND : i + _AROUND + 1]
    return float(RectBivariateSpline(nodes, nodes, near)(fine, fine).min())


def scene_at(name: str, nodes: int) -> Place:
    """Return a scene's smooth bodies on its own domain."""
    scene = Scene.from_toml(name, {"film.points": str(nodes)})
    case = Case.bind(scene, scene.operation.point)
    grid = scene.grid(scene.rows)
    bare = instant_of(case, np.zeros(grid.shape), np.full(grid.shape, 1e11))
    return replace(bare, hardness=1e11, microroughness=None), grid


def scene_film(name: str, nodes: int, flux: str) -> Film:
    """Return the film of a scene's smooth bodies on its own domain."""
    return film(*scene_at(name, nodes), flux)


def point_at(load: float, lubricant: float, ratio: float, nodes: int) -> Place:
    """Return an elliptical contact on a grid that fits it, for Moes' numbers on R_x.

    ratio: R_y / R_x; nodes: along the shorter side.
    """
    case = MoesCase(load, lubricant, ratio=ratio)
    extent = Extent.of(Point(case.radius, ratio * case.radius), case.newtons, case.modulus, case.smooth.film)
    grid = extent.grid(*extent.shape(shorter=nodes))
    return instant_of_call(case.arguments(), np.zeros(grid.shape)), grid


def point_film(load: float, lubricant: float, ratio: float, nodes: int, flux: str) -> Film:
    """Return the film of that contact."""
    return film(*point_at(load, lubricant, ratio, nodes), flux)


def line_film(load: float, lubricant: float, nodes: int, flux: str) -> Film:
    """Return the film of a line without ends on one row of nodes, for Moes' numbers of lines."""
    given = MoesCase(1.0, lubricant)
    line = Line(given.radius, 1.0)
    newtons = load * given.modulus * given.radius * given.speed_number**0.5 * line.length
    left, spacing = _extent(given, line, newtons, nodes)
    grid = Grid((np.arange(nodes) - round(left / spacing)) * spacing, np.zeros(1), True, line.length / spacing)
    now = replace(instant_of_call(given.arguments(), np.zeros(grid.shape)), shape=line, load=newtons)
    return film(now, grid, flux, _TOLERANCE_OF_LINES)


def roller_film(load: float, lubricant: float, nodes: int, flux: str) -> Film:
    """Return the film of a line with ends; nodes along x."""
    given = MoesCase(1.0, lubricant)
    roller = Roller(given.radius, LENGTH, PROFILE)
    newtons = load * given.modulus * given.radius * given.speed_number**0.5 * roller.length
    left, spacing = _extent(given, roller, newtons, nodes)
    rows = rows_over(1.02 * LENGTH, spacing, nodes)
    x, y = np.arange(nodes) - round(left / spacing), np.arange(rows) - 0.5 * (rows - 1)
    grid = Grid(x * spacing, y * spacing)
    now = replace(instant_of_call(given.arguments(), np.zeros(grid.shape)), shape=roller, load=newtons)
    return film(now, grid, flux)


def _extent(given: MoesCase, line: Line, newtons: float, nodes: int) -> tuple[float, float]:
    """Return the extent before the contact and the spacing of nodes [m]."""
    arguments = given.arguments()
    oil = given.viscosity, arguments["pressure_viscosity"]
    smooth = line.film(newtons, arguments["speed_1"], *oil, given.modulus)
    left, right = line_extent(line, newtons, given.modulus, smooth)
    return left, (left + right) / (nodes - 1)
