"""Undeformed, smooth bodies: gap, Hertz's contact, film by formula, and their records in a scene.

    base        the Protocols `Shape` and `Geometry`
    point       circular and elliptical point contacts
    line        line contacts without ends
    roller      line contacts with ends
    equations   equations that several shapes share, for documentation

A new shape is one file with a `Shape` and a `Geometry`, and one entry in `GEOMETRIES`.
"""

from .base import Geometry, Shape
from .line import Line, LineGeometry
from .point import Point, PointGeometry
from .roller import Profile, Roller, RollerGeometry

GEOMETRIES: tuple[type[Geometry], ...] = (PointGeometry, LineGeometry, RollerGeometry)
