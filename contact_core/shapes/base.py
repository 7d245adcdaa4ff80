"""The questions that every shape answers: `Shape`, the undeformed, smooth bodies; `Geometry`, the record of a scene.

A new shape is one file with both classes and one entry in `GEOMETRIES`. Nothing else asks which class a shape is.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, Protocol

from ..kernels.arrays import Array
from ..laws.base import Law
from ..laws.equations import Equations
from ..laws.load_sharing import FittedSharing
from ..quantities import input_parameter, parameter
from ..reference import Hertz, SmoothContact, SmoothLine

Viscosity = Callable[[Array, float], Array]  # [Pa s] at pressures [Pa] and a temperature [K]


class Shape(Protocol):
    """Undeformed, smooth bodies. Loads are those of the whole contact [N]; x runs along entrainment."""

    periodic: ClassVar[bool]  # the contact repeats along y
    ends: ClassVar[bool]  # the face ends within the grid
    along_face: ClassVar[bool]  # nothing changes along y on average: the track is as wide as the face
    has_far_field: ClassVar[bool]  # `kernels.far_field` knows the film beyond the grid
    power: ClassVar[float]  # of load and radii in Hertz's half widths
    order: ClassVar[int]  # of the size in the area that carries the load

    @property
    def radius_x(self) -> float:
        """Radius of combined curvature along x [m]."""

    @property
    def radii(self) -> tuple[tuple[str, float], ...]:
        """Names and values [m] of all radii of combined curvature."""

    @property
    def curvature_ratio(self) -> float:
        """Curvature along y over that along x."""

    @property
    def circular(self) -> bool:
        """True for a ball."""

    @property
    def ellipse_radius(self) -> float | None:
        """Radius along y [m] of an elliptical contact; None of all others."""

    @property
    def opening(self) -> float:
        """Gap at a distance d before Hertz's contact, over (d / a)^1.5 a^2 / radius_x."""

    @property
    def side_resistance(self) -> float:
        """Resistance of starved films to side flow, see `reference.supplied_film`."""

    def __hash__(self) -> int: ...

    def gap(self, x: Array, y: Array, unit: float) -> Array:
        """Return the gap [ny, nx] of the touching bodies in unit^2 / radius_x at x [nx], y [ny] in `unit` [m]."""

    def hertz(self, load: float, reduced_modulus: float) -> Hertz:
        """Return Hertz's contact of the dry bodies."""

    def softness(self, hertz: Hertz, reduced_modulus: float) -> float:
        """Return pi radius_x p_H / (E' a), the factor of the half space in Hertz's units; 1 for a circle."""

    def depths(self, film: float, a: float, b: float) -> tuple[float, float]:
        """Return a film [m] over the depth of Hertz's contact of half widths a and b [m], along x and along y."""

    def carried(self, hertz: Hertz, size: float, depth: float) -> float:
        """Return the load over p_H a^n l^(2 - n), n = `order` and l = `size` [m], of a grid `depth` [m] deep."""

    def smooth(
        self, load: float, speed: float, viscosity: Viscosity, temperature: float, reduced_modulus: float
    ) -> SmoothContact | SmoothLine:
        """Return the smooth contact in the terms of film formulas, at an entrainment speed [m/s]."""

    def film(
        self, load: float, speed: float, viscosity: float, pressure_coefficient: float, reduced_modulus: float
    ) -> float:
        """Return the central film thickness [m] of the smooth bodies by a formula of all regimes."""

    def conventional_film(
        self, load: float, speed: float, viscosity: Viscosity, temperature: float, reduced_modulus: float
    ) -> float:
        """Return the central film thickness [m] of the smooth bodies by the conventional formula of the shape."""

    def rolling(self, load: float, speed: float, viscosity: float, reduced_modulus: float) -> float:
        """Return the rolling resistance [N] of the smooth bodies for an entrainment speed [m/s], load above zero."""

    def rolling_beyond(self, speed: float, viscosity: float, before: float, beside: float) -> float:
        """Return what of it lies outside |x| < before [m], |y| < beside [m], there under the viscosity [Pa s] of p = 0.

        Nearer than a Hertz contact, where bodies are no parabolas, nobody asks.
        """


class GridRecord(Protocol):
    """The grid in a film record."""

    @property
    def points(self) -> int:
        """Nodes along x."""

    @property
    def domain(self) -> float:
        """Length along x [m]."""

    @property
    def width(self) -> float:
        """Length along y [m]; 0: chosen by the shape."""

    @property
    def spacing(self) -> float:
        """Distance between nodes [m]."""


def combined(axis: str) -> str:
    """Return what a radius of a geometry is."""
    return f"combined radius of curvature along {axis}, 1 / (1/R_1 + 1/R_2): of a ball on a flat that of the ball"


@dataclass(frozen=True, kw_only=True)
class Bodies:
    """Curvature along x, and the path of a surface point between two passes through the contact."""

    # where an operating point gives none
    radius_x: float = input_parameter("radius_x", text=combined("x"))
    track_length_1: float = parameter("m", "travel of a point of body 1 between two passes", above=0.0, most=1e3)
    track_length_2: float = parameter("m", "travel of a point of body 2 between two passes", above=0.0, most=1e3)


class Geometry(Law, Protocol):
    """The record of a shape in a scene."""

    lacks: ClassVar[frozenset[str]]  # quantities that have no meaning for it
    sharing: ClassVar[type[FittedSharing]]  # curves of load sharing fitted to its like
    equations: ClassVar[Equations]  # gap; these and the next four for documentation
    deformation: ClassVar[Equations]
    load_balance: ClassVar[Equations]
    smooth_film: ClassVar[Equations]
    rolling: ClassVar[Equations]
    film_formula: ClassVar[str]  # names of its authors
    not_modelled: ClassVar[tuple[str, ...]]
    bounded_across: ClassVar[bool]  # the grid must hold the half width along y, too
    lumped: ClassVar[bool]  # film.criterion = "lumped" finds a film

    @property
    def radius_x(self) -> float:
        """Radius of combined curvature along x [m]."""

    @property
    def face_width(self) -> float | None:
        """Length [m] of the face that carries the load; None if the size across follows from the load."""

    @property
    def track_length_1(self) -> float:
        """Travel [m] of a point of body 1 between two passes."""

    @property
    def track_length_2(self) -> float:
        """Travel [m] of a point of body 2 between two passes."""

    def shape(self, radius_x: float | None = None, radius_y: float | None = None) -> Shape:
        """Return the shape with these radii [m], or with the geometry's own."""

    def rows(self, film: GridRecord, smooth: bool) -> int:
        """Return the rows of nodes along y for a film record; `smooth`: both surfaces have no roughness."""

    def repeats(self, depth: float) -> float:
        """Return how many times a grid `depth` [m] deep lies in the contact, side by side along y."""

    def refusal(self, radius_y: float | None, spin: float) -> str:
        """Return why the shape cannot have these inputs, or an empty text."""

    def depth_error(self, depth: float, width: float) -> str:
        """Return why a grid `depth` [m] deep (film.width = `width`) cannot hold the shape, or an empty text."""
