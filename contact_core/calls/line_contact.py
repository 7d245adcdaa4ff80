"""Lubricated line contact at one instant in one call, with or without ends. SI, arrays in and out."""

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..film.instant import Grid
from ..laws.profile import Logarithmic, Measured, Rounded
from ..quantities import out_of_range, parameter
from ..shapes import Line, Profile, Roller
from .common import (
    FilmContact,
    Numbers,
    check_choices,
    film_of,
    grid_nodes,
    heights_of,
    no_numbers,
    numbers_of,
    refuse,
    smooth_of,
    solve_call,
    solve_to_accuracy,
)
from .inlet import extent_before
from .refinement import MOST_NODES, grids_within, intervals, surface_of, wants_accuracy

Array = NDArray[np.float64]

_NODES = 257  # along x of smooth bodies
_MOST = 8193  # nodes along an axis
_COARSEST, _FINEST, _FINEST_ROUGH = 64, 4096, 1024  # intervals along x to meet an accuracy
_BESIDE = 1.02  # grid over length of a line with ends


class LineContact(FilmContact):
    """Result of `line_contact`, as `PointContact`. Without ends ny rows repeat across, one for smooth bodies."""


@dataclass(frozen=True, kw_only=True)
class _Numbers(Numbers):
    """The scalars of a call, with their ranges."""

    load: float = parameter("N/m", "normal load per length", above=0.0, most=1e9)
    radius: float = parameter("m", "combined radius of curvature along x", above=0.0, most=100.0)
    length: float = parameter("m", "length of the line", above=0.0, most=100.0, default=1.0)


def line_contact(
    *,
    load: float,
    radius: float,
    reduced_modulus: float,
    speed_1: float,
    speed_2: float,
    viscosity: float,
    pressure_viscosity: float,
    length: float | None = None,
    profile: Profile | None = None,
    viscosity_law: str = "roelands",
    density_law: str = "dowson_higginson",
    heights_1: ArrayLike | None = None,
    heights_2: ArrayLike | None = None,
    spacing: float | None = None,
    hardness: float | None = None,
    grid: int | tuple[int, int] | None = None,
    domain: tuple[float, float] | None = None,
    floor: float = 1e-9,
    cavitation: str = "reynolds",
    supply: float | None = None,
    meniscus: float | None = None,
    accuracy: float | None = None,
    tolerance: float | None = None,
    iterations: int = 2000,
    flux: str = "fitted",
    fft: str = "pyfftw",
) -> LineContact:
    """Solve for steady mixed lubrication of a line contact, from full film to dry.

    Loads are per length. Without a `profile` the line has no ends: the rows repeat across, and the length decides the
    approach only, which is that of an even load on such a length. With one it is a roller of that length. Forces are
    not in the result; the integral of a stress per length is its sum over the nodes times spacing / ny.

    Parameters
    ----------
    load
        Normal load per length [N/m].
    radius
        Radius of combined curvature along x [m].
    reduced_modulus
        E' = 2 / [(1 - v1^2)/E1 + (1 - v2^2)/E2] [Pa].
    speed_1, speed_2
        Surface speeds along x relative to the contact [m/s].
    viscosity, pressure_viscosity
        Viscosity [Pa s] and pressure coefficient [1/Pa] at p = 0.
    length
        Length of the line [m]; 1 m if not given.
    profile
        Ends of a roller, such as `Rounded`, `Logarithmic` or `Measured`.
    viscosity_law, density_law, hardness, floor, cavitation, supply, meniscus, tolerance, iterations, flux, fft
        As in `point_contact`.
    accuracy
        As in `point_contact`; smooth bodies without ends have from 65 to 4097 nodes along x, rough ones up to 1025.
        Rows that repeat keep their period: finer grids have more of them.
    heights_1, heights_2
        Heights [ny, nx] of each body [m], positive toward the other one, centred on the contact. Without ends their
        first row follows their last: an even number of rows, or one.
    spacing
        Distance between the nodes of the heights [m].
    grid
        Nodes along x of smooth bodies (257 if not given), for a roller (ny, nx), too.
    domain
        (x_min, x_max) [m] about the contact instead of the one that fits the film; cells are square.

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
            "load": load, "radius": radius, "length": length, "reduced_modulus": reduced_modulus, "speed_1": speed_1,
            "speed_2": speed_2, "viscosity": viscosity, "pressure_viscosity": pressure_viscosity, "hardness": hardness,
            "floor": floor, "tolerance": tolerance, "iterations": iterations, "spacing": spacing, "supply": supply,
            "meniscus": meniscus, "accuracy": accuracy,
        },
    )  # fmt: skip
    options = {
        "viscosity_law": viscosity_law, "density_law": density_law, "criterion": "split", "cavitation": cavitation,
        "flux": flux, "fft": fft,
    }  # fmt: skip
    check_choices(options)
    if profile is not None and length is None:
        refuse(["length = None: a line with ends needs its length in metres."])
    heights = heights_of(heights_1, heights_2)
    shape = Line(numbers.radius, numbers.length)
    if profile is not None:
        refuse(_no_profile(profile, numbers.length))
        shape = Roller(numbers.radius, numbers.length, profile)
    total = numbers.load * numbers.length
    pressure = shape.hertz(total, numbers.reduced_modulus).pressure_max
    if pressure > numbers.hardness:
        refuse(
            [
                f"hardness = {numbers.hardness:g} Pa is below the Hertz pressure of {pressure:.3g} Pa: the bodies "
                "would yield as a whole. Lower the load or raise the hardness."
            ]
        )
    film = film_of(shape, total, numbers, supply)
    starved = (supply, meniscus)
    if wants_accuracy(accuracy, grid=grid, tolerance=tolerance):
        if heights is None:
            grids, surface = _grids(numbers, shape, total, film, domain), None
        else:
            given = _grid(numbers, shape, total, film, heights, spacing, None, domain)
            grids, surface = grids_within(given, _FINEST_ROUGH), surface_of(heights, given)
        return solve_to_accuracy(LineContact, shape, total, numbers, grids, surface, starved, options)
    nodes = _grid(numbers, shape, total, film, heights, spacing, grid, domain)
    return solve_call(LineContact, shape, total, numbers, nodes, heights, starved, options)


def _no_profile(profile: Profile, length: float) -> list[str]:
    """Return sentences on what is wrong with a profile for a roller of a length [m]."""
    if isinstance(profile, type) or not isinstance(profile, (Rounded, Logarithmic, Measured)):
        return [
            f"profile = {profile!r} must be a Rounded(straight, radius), a Logarithmic(depth) or a Measured(ends), in "
            "metres."
        ]
    values = {f"profile.{f.name}": getattr(profile, f.name) for f in fields(profile)}
    sentences = no_numbers(values) or list(out_of_range(profile, "profile"))
    if not sentences and isinstance(profile, Rounded) and profile.straight > length:
        sentences = [f"profile.straight = {profile.straight:g} m must be at most length = {length:g} m."]
    return sentences


def _grid(
    numbers: _Numbers,
    shape: Line,
    load: float,
    film: float,
    heights: Array | None,
    spacing: float | None,
    grid: int | tuple[int, int] | None,
    domain: tuple[float, float] | None,
    before: float = 0.0,
) -> Grid:
    """Return the nodes that the arguments ask for; they reach `before` [m] the centre if the domain is open."""
    from ..film.fitted import line_extent, rows_over

    ny, nx = grid_nodes(grid)
    if ny is not None and shape.periodic:
        refuse([f"grid = {grid} has rows: smooth lines without ends have one, that of rough ones heights decide."])
    if heights is not None:
        if nx is not None and (ny or heights.shape[0], nx) != heights.shape:
            refuse([f"grid = {grid} does not fit heights of {heights.shape} nodes. Leave grid out: heights decide it."])
        if spacing is None:
            refuse(["spacing = None: heights need the distance between their nodes in metres."])
        ny, nx = heights.shape
        if ny < 1 or nx < 17:
            refuse([f"heights of {heights.shape} nodes [ny, nx] are too few: 17 along x are the least, and one row."])
        if shape.periodic and ny > 1 and ny % 2:
            refuse([f"heights of {ny} rows: a line without ends needs an even number of rows, or one."])
        if not shape.periodic and (ny - 1) * numbers.spacing < numbers.length:
            reach = (ny - 1) * numbers.spacing
            refuse([f"heights are {reach:g} m long; they must reach over length = {shape.length:g} m."])
    nx = nx or _NODES
    if not 17 <= nx <= _MOST or (ny is not None and ny > _MOST):
        refuse([f"grid = {(ny, nx)} must have from 17 to {_MOST} nodes along x, and at most as many along y."])
    if domain is None:
        left, right = line_extent(shape, load, numbers.reduced_modulus, film)
        left = max(left, before)
    else:
        left, right = _sides(domain)
    if spacing is None:
        spacing = (left + right) / (nx - 1)
        before = left / spacing if domain is not None else round(left / spacing)  # a node lies on the centre
        x = (np.arange(nx, dtype=np.float64) - before) * spacing
        if numbers.entrainment_speed < 0.0 and domain is None:
            x = -x[::-1]
    else:
        x = (np.arange(nx, dtype=np.float64) - 0.5 * (nx - 1)) * spacing
    if shape.periodic:
        rows = ny or 1
        y = (np.arange(rows, dtype=np.float64) - 0.5 * (rows - 1)) * spacing
        return Grid(x, y, periodic=True, repeats=shape.length / (rows * spacing))
    rows = ny or rows_over(_BESIDE * shape.length, spacing, nx)
    if rows > _MOST:
        refuse(
            [
                f"length = {shape.length:g} m takes {rows} rows of cells {spacing:.3g} m wide, above {_MOST}. Use "
                "fewer nodes along x, or a line without ends."
            ]
        )
    return Grid(x, (np.arange(rows, dtype=np.float64) - 0.5 * (rows - 1)) * spacing)


def _grids(numbers: _Numbers, shape: Line, load: float, film: float, domain: tuple[float, float] | None) -> list[Grid]:
    """Return grids for smooth bodies, from coarse to fine."""
    a, before = shape.hertz(load, numbers.reduced_modulus).a, 0.0
    if film > 0.0:
        before = extent_before(numbers.accuracy, a, shape, smooth_of(shape, load, numbers))
    counts = intervals(_COARSEST, _FINEST) if shape.periodic else intervals()
    grids = (_grid(numbers, shape, load, film, None, None, count + 1, domain, before) for count in counts)
    return [grid for grid in grids if grid.x.size * grid.y.size <= MOST_NODES]


def _sides(domain: tuple[float, float]) -> tuple[float, float]:
    try:
        x_min, x_max = (float(value) for value in domain)
        about = x_min < 0.0 < x_max and bool(np.isfinite(domain).all())
    except (TypeError, ValueError):
        about = False
    if not about:
        refuse([f"domain = {domain!r} must be (x_min, x_max) in metres about the contact at 0."])
    return -x_min, x_max
