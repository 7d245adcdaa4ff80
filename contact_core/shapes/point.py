"""Circular and elliptical point contacts."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..kernels.arrays import Array
from ..laws.equations import Equations
from ..laws.load_sharing import FittedSharing
from ..quantities import input_parameter
from ..reference import Hertz, SmoothContact, hamrock_dowson, hertz_point, nvm_film, rolling_beyond_point, rolling_point
from .base import Bodies, GridRecord, Shape, Viscosity, combined
from .equations import HALF_SPACE, HELD_OPEN, LOAD_BALANCE, PARABOLAS, REDUCED, ROLLING_NOTE


@dataclass(frozen=True)
class Point:
    """Bodies that are parabolic along both axes. Methods as in `Shape`."""

    periodic: ClassVar[bool] = False
    ends: ClassVar[bool] = False
    along_face: ClassVar[bool] = False
    has_far_field: ClassVar[bool] = True
    power: ClassVar[float] = 1 / 3
    order: ClassVar[int] = 2

    radius_x: float  # of combined curvature [m]
    radius_y: float

    @property
    def radii(self) -> tuple[tuple[str, float], ...]:
        """Names and values [m] of the radii."""
        return ("radius_x", self.radius_x), ("radius_y", self.radius_y)

    @property
    def curvature_ratio(self) -> float:
        """Curvature along y over that along x."""
        return self.radius_x / self.radius_y

    @property
    def circular(self) -> bool:
        """True for a ball."""
        return self.radius_x == self.radius_y

    @property
    def ellipse_radius(self) -> float | None:
        """Radius along y [m] of an elliptical contact; None of a circular one."""
        return None if self.circular else self.radius_y

    @property
    def side_resistance(self) -> float:
        """Resistance of starved films to side flow, see `reference.supplied_film`: 3 for circles.

        For ellipses fitted to solved films: within 3 % for radius_y / radius_x up to 20, within 11 % down to 0.2.
        """
        ratio = self.radius_y / self.radius_x
        return float(min(3.0 * ratio ** (0.35 if ratio > 1.0 else 0.2), 15.0))

    @property
    def opening(self) -> float:
        """Gap at a distance d before Hertz's contact, over (d / a)^1.5 a^2 / radius_x: in proportion to p_H a."""
        return 0.6 * self.softness(self.hertz(1.0, 1.0), 1.0)

    def gap(self, x: Array, y: Array, unit: float) -> Array:
        """Return the gap of the touching bodies."""
        radius_2: Array = x[None, :] ** 2 + self.radius_x / self.radius_y * y[:, None] ** 2
        return 0.5 * radius_2

    def hertz(self, load: float, reduced_modulus: float) -> Hertz:
        """Return Hertz's contact of the dry bodies."""
        return hertz_point(load, self.radius_x, self.radius_y, reduced_modulus)

    def softness(self, hertz: Hertz, reduced_modulus: float) -> float:
        """Return pi radius_x p_H / (E' a), the factor of the half space in Hertz's units; 1 for a circle."""
        if self.circular:
            return 1.0
        return np.pi * self.radius_x * hertz.pressure_max / (reduced_modulus * hertz.a)

    def depths(self, film: float, a: float, b: float) -> tuple[float, float]:
        """Return a film [m] over the depth of Hertz's contact, along x and along y."""
        return film * self.radius_x / (a * a), film * self.radius_y / (b * b)

    def carried(self, hertz: Hertz, size: float, depth: float) -> float:
        """Return the load of a grid in these units."""
        return 2.0 * np.pi / 3.0 * (hertz.b / hertz.a)

    def smooth(
        self, load: float, speed: float, viscosity: Viscosity, temperature: float, reduced_modulus: float
    ) -> SmoothContact:
        """Return the smooth contact in the terms of film formulas."""
        return SmoothContact.of(load, speed, viscosity, temperature, self.radius_x, self.radius_y, reduced_modulus)

    def film(
        self, load: float, speed: float, viscosity: float, pressure_coefficient: float, reduced_modulus: float
    ) -> float:
        """Return the central film thickness [m] of the smooth bodies (Nijenbanning, Venner & Moes)."""
        x, y = self.radius_x, self.radius_y
        return nvm_film(load, speed, viscosity, pressure_coefficient, x, y, reduced_modulus)

    def conventional_film(
        self, load: float, speed: float, viscosity: Viscosity, temperature: float, reduced_modulus: float
    ) -> float:
        """Return the central film thickness [m] by Hamrock & Dowson."""
        return hamrock_dowson(self.smooth(load, speed, viscosity, temperature, reduced_modulus))[0]

    def rolling(self, load: float, speed: float, viscosity: float, reduced_modulus: float) -> float:
        """Return the rolling resistance [N] of the smooth bodies."""
        return rolling_point(load, speed, viscosity, self.radius_x, self.radius_y, reduced_modulus)

    def rolling_beyond(self, speed: float, viscosity: float, before: float, beside: float) -> float:
        """Return what of it [N] lies outside |x| < before, |y| < beside."""
        return rolling_beyond_point(speed, viscosity, self.radius_x, self.radius_y, before, beside)


@dataclass(frozen=True, kw_only=True)
class PointGeometry(Bodies):
    """A circular or elliptical contact. Methods as in `Geometry`."""

    name: ClassVar[str] = "point"
    source: ClassVar[str] = PARABOLAS
    equations: ClassVar[Equations] = Equations(
        ("g = x^2/(2 R_x) + y^2/(2 R_y)",),
        "Parabolas along both axes.",
        symbols={"R_x": "radius_x", "R_y": "radius_y"},
    )
    deformation: ClassVar[Equations] = HALF_SPACE
    load_balance: ClassVar[Equations] = LOAD_BALANCE
    smooth_film: ClassVar[Equations] = Equations(
        ("h_s = R_x U^{1/2} H(M, L, R_x/R_y),   Z = h_s/σ",),
        "H is the formula of Nijenbanning, Venner and Moes over all regimes, " + REDUCED,
        title="Film of the smooth bodies",
        source="Nijenbanning, Venner & Moes 1994, doi:10.1016/0043-1648(94)90150-3",
        symbols={
            "U": "speed parameter 2 η_0 u_e/(E′ R_x) [1]",
            "H": "film thickness in Moes' units [1]",
            "M": "Moes' parameter of load [1]",
            "L": "Moes' parameter of the lubricant [1]",
            "Z": "film of the smooth bodies by formula over composite rms roughness [1]",
        },
    )
    rolling: ClassVar[Equations] = Equations(
        (
            "F_r = 2 b E′ R_x U^{3/4} [(r − e)/(1 + M/6.6) + e] s",
            HELD_OPEN,
            "r = 0.77 β^{−1/3} k^{0.12} U^{−1/12},   e = 1.8 β^{−1/4}",
            "M = β^{1/4} k W/(E′ R_x^2) U^{−3/4},   β = E′ a/(π p_H R_x),   k = a/b",
        ),
        ROLLING_NOTE + " a and b are Hertz's half widths.",
        title="Rolling resistance",
        source="Biboulet & Houpert, Proc. IMechE J 224 (2010) 777, doi:10.1243/13506501JET791",
        symbols={
            "s": "part that an inlet leaves which solids hold open [1]",
            "U": "speed parameter 2 η_0 u_e/(E′ R_x) [1]",
        },
    )
    film_formula: ClassVar[str] = "Nijenbanning, Venner and Moes"
    not_modelled: ClassVar[tuple[str, ...]] = ()
    face_width: ClassVar[None] = None  # its size across follows from the load
    lacks: ClassVar[frozenset[str]] = frozenset()
    sharing: ClassVar[type[FittedSharing]] = FittedSharing
    bounded_across: ClassVar[bool] = True
    lumped: ClassVar[bool] = True

    radius_y: float = input_parameter("radius_y", text=combined("y"))

    def shape(self, radius_x: float | None = None, radius_y: float | None = None) -> Shape:
        """Return the shape with these radii [m], or with the geometry's own."""
        return Point(radius_x or self.radius_x, radius_y or self.radius_y)

    def rows(self, film: GridRecord, smooth: bool) -> int:
        """Return the rows of nodes: those of film.width, else as many as along x."""
        return round(film.width / film.spacing) + 1 if film.width > 0.0 else film.points

    def repeats(self, depth: float) -> float:
        """Return 1: the whole contact lies on the grid."""
        return 1.0

    def refusal(self, radius_y: float | None, spin: float) -> str:
        """Return an empty text: a point contact has every input."""
        return ""

    def depth_error(self, depth: float, width: float) -> str:
        """Return an empty text: a point contact has no ends."""
        return ""
