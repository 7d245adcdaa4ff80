"""What the bodies look like in a scene: one record for each kind of contact. `shape` is what the film sees of it."""

from dataclasses import dataclass
from typing import ClassVar

from .laws.load_sharing import FittedSharing, LineSharing
from .laws.profile import Logarithmic, Rounded
from .quantities import input_parameter, parameter
from .shapes import Line, Point, Roller, Shape


@dataclass(frozen=True, kw_only=True)
class _Bodies:
    """Curvature along x, and the way a surface point travels between two passes through the contact."""

    radius_x: float = input_parameter("radius_x")  # where an operating point says nothing else
    track_length_1: float = parameter("m", "travel of a point of body 1 between two passes", above=0.0, most=1e3)
    track_length_2: float = parameter("m", "travel of a point of body 2 between two passes", above=0.0, most=1e3)


@dataclass(frozen=True, kw_only=True)
class PointGeometry(_Bodies):
    """A circular or elliptical contact."""

    name: ClassVar[str] = "point"
    source: ClassVar[str] = ""
    lacks: ClassVar[frozenset[str]] = frozenset()  # quantities that mean nothing to it
    sharing: ClassVar[type[FittedSharing]] = FittedSharing  # fitted to its like

    radius_y: float = input_parameter("radius_y")

    def shape(self, radius_x: float | None = None, radius_y: float | None = None) -> Shape:
        """The shape with these radii [m], or the geometry's own."""
        return Point(radius_x or self.radius_x, radius_y or self.radius_y)


@dataclass(frozen=True, kw_only=True)
class LineGeometry(_Bodies):
    """A line contact whose ends are far away: one period of it is solved, and stands for the whole face."""

    name: ClassVar[str] = "line"
    source: ClassVar[str] = ""
    lacks: ClassVar[frozenset[str]] = frozenset({"radius_y", "spin", "spin_torque"})
    sharing: ClassVar[type[FittedSharing]] = LineSharing

    face_width: float = parameter("m", "length of the line that carries the load", above=0.0, most=10.0)

    def shape(self, radius_x: float | None = None, radius_y: float | None = None) -> Shape:
        """The shape with this radius [m], or the geometry's own."""
        return Line(radius_x or self.radius_x, self.face_width)


@dataclass(frozen=True, kw_only=True)
class RollerGeometry(_Bodies):
    """A line contact with ends."""

    name: ClassVar[str] = "roller"
    source: ClassVar[str] = ""
    lacks: ClassVar[frozenset[str]] = frozenset({"radius_y"})
    sharing: ClassVar[type[FittedSharing]] = LineSharing

    face_width: float = parameter("m", "length of the roller, ends included", above=0.0, most=10.0, shapes_arrays=True)
    profile: Rounded | Logarithmic

    def shape(self, radius_x: float | None = None, radius_y: float | None = None) -> Shape:
        """The shape with this radius [m], or the geometry's own."""
        return Roller(radius_x or self.radius_x, self.face_width, self.profile)


Geometry = PointGeometry | LineGeometry | RollerGeometry
GEOMETRIES: tuple[type, ...] = (PointGeometry, LineGeometry, RollerGeometry)
