"""Line contacts with ends."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..kernels.arrays import Array
from ..laws.base import Profile
from ..laws.equations import Equations
from ..laws.load_sharing import FittedSharing, LineSharing
from ..quantities import parameter
from ..reference import Hertz
from .base import Bodies, GridRecord, Shape
from .equations import HALF_SPACE, LOAD_BALANCE, PARABOLAS
from .line import ROLLING_LINE, SMOOTH_LINE, Line, no_radius_y

_DEEPEST = 0.1  # drop of an end, in radii: no deformation reaches that far
_BESIDE = 1.02  # depth of the grid over the length of a roller, at least


@dataclass(frozen=True)
class Roller(Line):
    """A cylinder with ends. Formulas and Hertz's contact are those of a line of the same length."""

    periodic: ClassVar[bool] = False
    ends: ClassVar[bool] = True
    side_resistance: ClassVar[float] = 15.0  # as of a wide ellipse

    profile: Profile

    def gap(self, x: Array, y: Array, unit: float) -> Array:
        drop = np.minimum(self.profile.drop(y * unit, self.length), _DEEPEST * self.radius_x)
        return 0.5 * x[None, :] ** 2 + drop[:, None] * (self.radius_x / unit**2)

    def carried(self, hertz: Hertz, size: float, depth: float) -> float:
        return 0.5 * np.pi * self.length / size


@dataclass(frozen=True, kw_only=True)
class RollerGeometry(Bodies):
    """A line contact with ends. Methods as in `Geometry`."""

    name: ClassVar[str] = "roller"
    source: ClassVar[str] = PARABOLAS
    equations: ClassVar[Equations] = Equations(
        ("g = x^2/(2 R_x) + P(y)",),
        "A line with ends, relieved by the profile P; load and outputs refer to the whole face_width b.",
        symbols={
            "P": "drop of the profile [m]",
        },
    )
    deformation: ClassVar[Equations] = HALF_SPACE
    load_balance: ClassVar[Equations] = LOAD_BALANCE
    smooth_film: ClassVar[Equations] = SMOOTH_LINE
    rolling: ClassVar[Equations] = ROLLING_LINE
    film_formula: ClassVar[str] = "Moes for lines"
    not_modelled: ClassVar[tuple[str, ...]] = ("misalignment",)
    lacks: ClassVar[frozenset[str]] = frozenset({"radius_y"})
    sharing: ClassVar[type[FittedSharing]] = LineSharing
    bounded_across: ClassVar[bool] = False
    lumped: ClassVar[bool] = True

    face_width: float = parameter("m", "length of the roller, ends included", above=0.0, most=10.0, shapes_arrays=True)
    profile: Profile

    def shape(self, radius_x: float | None = None, radius_y: float | None = None) -> Shape:
        """Return the shape with this radius [m], or with the geometry's own."""
        return Roller(radius_x or self.radius_x, self.face_width, self.profile)

    def rows(self, film: GridRecord, smooth: bool) -> int:
        """Return the rows of nodes: those of film.width, else as many as reach beyond both ends.

        They halve about as often as the nodes along x.
        """
        if film.width > 0.0:
            return round(film.width / film.spacing) + 1
        step = max(16, (film.points - 1) // 4)
        return step * math.ceil(_BESIDE * self.face_width / film.spacing / step) + 1

    def repeats(self, depth: float) -> float:
        """Return 1: the whole contact lies on the grid."""
        return 1.0

    def refusal(self, radius_y: float | None, spin: float) -> str:
        """Return why the roller cannot have these inputs, or an empty text."""
        return no_radius_y(self.name, radius_y)

    def depth_error(self, depth: float, width: float) -> str:
        """Return why a grid `depth` [m] deep (film.width = `width`) does not hold both ends, or an empty text."""
        if depth >= self.face_width:
            return ""
        return (
            f"film.width = {width:g} m is too small: the ends of geometry.face_width = "
            f"{self.face_width:g} m must lie on the grid. Use at least {_BESIDE:g} times that, or 0."
        )
