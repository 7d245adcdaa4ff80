"""Line contacts without ends: one period is solved and stands for the whole face."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..kernels.arrays import Array
from ..laws.equations import Equations
from ..laws.load_sharing import FittedSharing, LineSharing
from ..quantities import parameter
from ..reference import Hertz, SmoothLine, dowson_line, hertz_line, line_film, rolling_beyond_line, rolling_line
from .base import Bodies, GridRecord, Shape, Viscosity
from .equations import HELD_OPEN, PARABOLAS, REDUCED, ROLLING_NOTE

SMOOTH_LINE = Equations(
    ("h_s = R_x U^{1/2} H(M, L),   Z = h_s/σ",),
    "H is Moes' formula of line contacts over all regimes, " + REDUCED,
    title="Film of the smooth bodies",
    source="Moes, Wear 159 (1992) 57; Venner & Lubrecht, Multilevel Methods in Lubrication, Elsevier 2000",
    symbols={
        "U": "speed parameter 2 η_0 u_e/(E′ R_x) [1]",
        "H": "film thickness in Moes' units [1]",
        "M": "Moes' parameter of load [1]",
        "L": "Moes' parameter of the lubricant [1]",
        "Z": "film of the smooth bodies by formula over composite rms roughness [1]",
    },
)
ROLLING_LINE = Equations(
    (
        "F_r = b E′ R_x 1.42 (U w)^{1/2} [1 + (0.966 M^{1/2})^{10}]^{−1/10} s",
        HELD_OPEN,
        "w = W/(b E′ R_x),   M = w U^{−1/2}",
    ),
    ROLLING_NOTE + " b is the face width.",
    title="Rolling resistance",
    source="Biboulet & Houpert, Proc. IMechE J 224 (2010) 765, doi:10.1243/13506501JET790",
    symbols={
        "s": "part that an inlet leaves which solids hold open [1]",
        "U": "speed parameter 2 η_0 u_e/(E′ R_x) [1]",
        "b": "face width, geometry.face_width [m]",
    },
)


@dataclass(frozen=True)
class Line:
    """A cylinder without ends: a line contact that repeats itself along y. Methods as in `Shape`."""

    periodic: ClassVar[bool] = True
    ends: ClassVar[bool] = False
    along_face: ClassVar[bool] = True
    has_far_field: ClassVar[bool] = False
    power: ClassVar[float] = 1 / 2
    order: ClassVar[int] = 1
    side_resistance: ClassVar[float] = np.inf
    circular: ClassVar[bool] = False
    ellipse_radius: ClassVar[float | None] = None
    curvature_ratio: ClassVar[float] = 0.0
    opening: ClassVar[float] = 2.0 * np.sqrt(2.0) / 3.0

    radius_x: float  # of combined curvature [m]
    length: float  # of the face that carries the load [m]

    @property
    def radii(self) -> tuple[tuple[str, float], ...]:
        """Name and value [m] of the radius."""
        return (("radius_x", self.radius_x),)

    def gap(self, x: Array, y: Array, unit: float) -> Array:
        """Return the gap of the touching bodies, the same in all rows."""
        return np.tile(0.5 * x**2, (y.size, 1))

    def hertz(self, load: float, reduced_modulus: float) -> Hertz:
        """Return Hertz's contact of the dry bodies."""
        return hertz_line(load, self.radius_x, self.length, reduced_modulus)

    def softness(self, hertz: Hertz, reduced_modulus: float) -> float:
        """Return the factor of the half space in Hertz's units."""
        return 0.25 * np.pi

    def depths(self, film: float, a: float, b: float) -> tuple[float, float]:
        """Return the film over the depth along x, and 0: a line is as deep all along y."""
        return film * self.radius_x / (a * a), 0.0

    def carried(self, hertz: Hertz, size: float, depth: float) -> float:
        """Return the load of a grid in these units."""
        return 0.5 * np.pi * depth / size

    def smooth(
        self, load: float, speed: float, viscosity: Viscosity, temperature: float, reduced_modulus: float
    ) -> SmoothLine:
        """Return the smooth contact in the terms of film formulas."""
        return SmoothLine.of(load / self.length, speed, viscosity, temperature, self.radius_x, reduced_modulus)

    def film(
        self, load: float, speed: float, viscosity: float, pressure_coefficient: float, reduced_modulus: float
    ) -> float:
        """Return the central film thickness [m] of the smooth bodies."""
        return line_film(load / self.length, speed, viscosity, pressure_coefficient, self.radius_x, reduced_modulus)

    def conventional_film(
        self, load: float, speed: float, viscosity: Viscosity, temperature: float, reduced_modulus: float
    ) -> float:
        """Return the central film thickness [m] by Dowson & Toyoda."""
        return dowson_line(self.smooth(load, speed, viscosity, temperature, reduced_modulus))[0]

    def rolling(self, load: float, speed: float, viscosity: float, reduced_modulus: float) -> float:
        """Return the rolling resistance [N] of the smooth bodies."""
        return self.length * rolling_line(load / self.length, speed, viscosity, self.radius_x, reduced_modulus)

    def rolling_beyond(self, speed: float, viscosity: float, before: float, beside: float) -> float:
        """Return what of it [N] lies beyond a distance; the oil along the face flows nowhere else."""
        return self.length * rolling_beyond_line(speed, viscosity, self.radius_x, before)


def no_radius_y(geometry: str, radius_y: float | None) -> str:
    """Return why a line contact cannot have the input radius_y, or an empty text if it is not given."""
    if radius_y is None:
        return ""
    return f"radius_y = {radius_y:g} m: geometry.model = '{geometry}' has none. Leave it out."


@dataclass(frozen=True, kw_only=True)
class LineGeometry(Bodies):
    """A line contact whose ends are far away. Methods as in `Geometry`."""

    name: ClassVar[str] = "line"
    source: ClassVar[str] = PARABOLAS
    equations: ClassVar[Equations] = Equations(
        ("g = x^2/(2 R_x)",),
        "A line without ends. One period along y is solved and represents all of face_width, which load and outputs "
        "refer to.",
        symbols={"R_x": "radius_x"},
    )
    deformation: ClassVar[Equations] = Equations(
        (
            "d(x, y) = 2/(π E′) Σ_{k} ∬ p(x′, y′) {[(x − x′)^2 + (y − y′ − k w)^2]^{−1/2} − d_k} dx′ dy′",
            "d̄(x) = −4/(π E′) ∫ p̄(x′) ln(|x − x′|/b) dx′",
        ),
        "p is the pressure of oil and solids together, periodic along y with the period w. The approach of a line "
        "depends on a datum: dk makes the means over a period deform as in the second line, relative to a face width "
        "b away.",
        title="Elastic deformation (half space)",
        source="Johnson, Contact Mechanics, 1985, doi:10.1017/CBO9781139171731, section 2.3",
        symbols={
            "w": "period along y [m]",
            "k": "number of a period [1]",
            "d_k": "datum of a period [1/m]",
            "d̄": "mean deformation of a row of nodes along y [m]",
            "p̄": "mean pressure of a row of nodes along y [Pa]",
            "b": "face width, geometry.face_width [m]",
        },
    )
    load_balance: ClassVar[Equations] = Equations(
        ("W = (b/w) ∬ p dx dy",),
        "Over one period. It determines the rigid gap h0.",
        title="Load balance",
        symbols={
            "w": "period along y [m]",
            "b": "face width, geometry.face_width [m]",
        },
    )
    smooth_film: ClassVar[Equations] = SMOOTH_LINE
    rolling: ClassVar[Equations] = ROLLING_LINE
    film_formula: ClassVar[str] = "Moes for lines"
    not_modelled: ClassVar[tuple[str, ...]] = ("the ends of the face, and misalignment",)
    lacks: ClassVar[frozenset[str]] = frozenset({"radius_y", "spin", "spin_torque"})
    sharing: ClassVar[type[FittedSharing]] = LineSharing
    bounded_across: ClassVar[bool] = False
    lumped: ClassVar[bool] = False

    face_width: float = parameter("m", "length of the line that carries the load", least=1e-9, most=10.0)

    def shape(self, radius_x: float | None = None, radius_y: float | None = None) -> Shape:
        """Return the shape with this radius [m], or with the geometry's own."""
        return Line(radius_x or self.radius_x, self.face_width)

    def rows(self, film: GridRecord, smooth: bool) -> int:
        """Return the rows of one period: one if all rows are alike, else an even number.

        A grid of half as many rows then has the same period.
        """
        if film.width == 0.0 and smooth:
            return 1
        return max(2 * round(0.5 * (film.width or film.domain) / film.spacing), 1)

    def repeats(self, depth: float) -> float:
        """Return how many periods of `depth` [m] make up the face."""
        return self.face_width / depth

    def refusal(self, radius_y: float | None, spin: float) -> str:
        """Return why the line cannot have these inputs, or an empty text."""
        if spin != 0.0 and radius_y is None:
            return (
                f"spin = {spin:g} rad/s must be 0 where geometry.model = 'line': each part of the face would "
                "slide otherwise. Use geometry.model = 'roller'."
            )
        return no_radius_y(self.name, radius_y)

    def depth_error(self, depth: float, width: float) -> str:
        """Return an empty text: one period of any depth stands for the line."""
        return ""
