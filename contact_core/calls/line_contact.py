"""Lubricated line contact at one instant in one call, with or without ends. SI, arrays in and out."""

from dataclasses import dataclass, fields
from typing import Unpack

import numpy as np

from ..film.fitted import line_extent, rows_over
from ..film.instant import Grid
from ..kernels.arrays import Array
from ..laws.profile import Logarithmic, Measured, Rounded
from ..quantities import out_of_range, parameter
from ..shapes import Line, Profile, Roller
from .common import FilmCall, FilmContact, Numbers, grid_nodes, heights_of, no_numbers, nodes_of, numbers_of, solved
from .options import ContactOptions, check_choices, options_of, refuse, shows_options
from .refinement import MOST_NODES, intervals

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


@shows_options
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
    domain: tuple[float, float] | None = None,
    **options: Unpack[ContactOptions],
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
    domain
        (x_min, x_max) [m] about the contact instead of the one that fits the film; cells are square.
    **options
        Heights, grid or accuracy, oil supply, laws and more: see `ContactOptions`.

    Raises
    ------
    OperatingPointError
        For values that cannot be used.
    ConvergenceError
        If no solution is found.

    """
    given = options_of(line_contact, options) | {"criterion": "split"}
    contact = {
        "load": load, "radius": radius, "length": length, "reduced_modulus": reduced_modulus, "speed_1": speed_1,
        "speed_2": speed_2, "viscosity": viscosity, "pressure_viscosity": pressure_viscosity,
    }  # fmt: skip
    numbers = numbers_of(_Numbers, contact | given)
    check_choices(given)
    if profile is not None and length is None:
        refuse(["length = None: a line with ends needs its length in metres."])
    heights = heights_of(given)
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
    return solved(LineContact, _Call(shape, total, numbers, given, domain, heights), _FINEST_ROUGH)


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


class _Call(FilmCall):
    shape: Line

    def nodes(self, grid: int | tuple[int, int] | None) -> Grid:
        """Return the nodes that the arguments ask for."""
        return self._nodes(grid, self.options["spacing"])

    def grids(self) -> list[Grid]:
        """Return grids for smooth bodies, from coarse to fine."""
        before = self.before()
        counts = intervals(_COARSEST, _FINEST) if self.shape.periodic else intervals()
        grids = (self._nodes(count + 1, None, before) for count in counts)
        return [grid for grid in grids if grid.x.size * grid.y.size <= MOST_NODES]

    def _nodes(self, grid: int | tuple[int, int] | None, spacing: float | None, before: float = 0.0) -> Grid:
        """Return nodes; they reach `before` [m] the centre if the domain is open."""
        shape, heights = self.shape, self.heights
        ny, nx = grid_nodes(grid)
        if ny is not None and shape.periodic:
            refuse([f"grid = {grid} has rows: smooth lines without ends have one, that of rough ones heights decide."])
        if heights is not None:
            ny, nx = nodes_of(heights, ny, nx)
            self._check_rows(ny, nx, spacing)
        nx = nx or _NODES
        if not 17 <= nx <= _MOST or (ny is not None and ny > _MOST):
            refuse([f"grid = {(ny, nx)} must have from 17 to {_MOST} nodes along x, and at most as many along y."])
        x, spacing = self._along(nx, spacing, before)
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

    def _along(self, nx: int, spacing: float | None, before: float) -> tuple[Array, float]:
        """Return the nodes along x, and their spacing."""
        if spacing is not None:
            return (np.arange(nx, dtype=np.float64) - 0.5 * (nx - 1)) * spacing, spacing
        if self.domain is None:
            left, right = line_extent(self.shape, self.load, self.numbers.reduced_modulus, self.film)
            left = max(left, before)
        else:
            left, right = _sides(self.domain)
        spacing = (left + right) / (nx - 1)
        before = left / spacing if self.domain is not None else round(left / spacing)  # a node lies on the centre
        x = (np.arange(nx, dtype=np.float64) - before) * spacing
        return -x[::-1] if self.numbers.entrainment_speed < 0.0 and self.domain is None else x, spacing

    def _check_rows(self, ny: int, nx: int, spacing: float | None) -> None:
        if spacing is None:
            refuse(["spacing = None: heights need the distance between their nodes in metres."])
        elif ny < 1 or nx < 17:
            refuse([f"heights of {ny, nx} nodes [ny, nx] are too few: 17 along x are the least, and one row."])
        elif self.shape.periodic and ny > 1 and ny % 2:
            refuse([f"heights of {ny} rows: a line without ends needs an even number of rows, or one."])
        elif not self.shape.periodic and (ny - 1) * spacing < self.shape.length:
            reach = (ny - 1) * spacing
            refuse([f"heights are {reach:g} m long; they must reach over length = {self.shape.length:g} m."])


def _sides(domain: tuple[float, ...]) -> tuple[float, float]:
    try:
        x_min, x_max = (float(value) for value in domain)
        about = x_min < 0.0 < x_max and bool(np.isfinite(domain).all())
    except (TypeError, ValueError):
        about = False
    if not about:
        refuse([f"domain = {domain!r} must be (x_min, x_max) in metres about the contact at 0."])
    return -x_min, x_max
