"""The fields of a scene, and the geometry and grid that follow from them."""

import hashlib
import json
import math
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Any

from ..arrays import Array
from ..film import Deterministic, Regression
from ..film.instant import Grid
from ..laws.base import BoundaryFriction, Fatigue, Heat, Oxide, Plasticity, Scuffing, Stress, Tribofilm, Wear
from ..laws.fatigue import NoFatigue
from ..laws.oxide import NoOxide
from ..laws.scuffing import NoScuffing
from ..laws.stress import NoStress
from ..reference import Hertz
from ..shapes import Geometry, Shape
from .intervals import Interval
from .operation import OperatingPoint, Operation
from .records import Control, Lubricant, Solids
from .self_affine import SelfAffine
from .surface import Surface
from .toml import unbuild

ROOM = 2.4  # side of the grid over the half width of Hertz's contact, at least


@dataclass(frozen=True)
class SceneFields:
    """One contact: geometry, surfaces, materials and a law in every slot."""

    name: str
    description: str
    geometry: Geometry
    solids: Solids
    surface_1: Surface | SelfAffine
    surface_2: Surface | SelfAffine
    lubricant: Lubricant
    plasticity: Plasticity
    boundary_friction: BoundaryFriction
    heat: Heat
    tribofilm: Tribofilm
    wear: Wear
    film: Deterministic | Regression
    control: Control
    operation: Operation
    oxide: Oxide = field(default=NoOxide())
    stress: Stress = field(default=NoStress())
    fatigue: Fatigue = field(default=NoFatigue())
    scuffing: Scuffing = field(default=NoScuffing())
    intervals: tuple[Interval, ...] = ()  # of what is assumed

    def to_dict(self) -> dict[str, Any]:
        """Return nested tables, from which `Scene.from_dict` makes an equal scene, bit for bit."""
        return unbuild(self)

    def shape(self, op: OperatingPoint | None = None) -> Shape:
        """Return the undeformed bodies at an operating point, or at the scene's own radii."""
        if op is None or op.radius_x is op.radius_y is None:
            return self._own_shape
        return self.geometry.shape(op.radius_x, op.radius_y)

    @cached_property
    def _own_shape(self) -> Shape:
        return self.geometry.shape()

    def radii(self, op: OperatingPoint) -> tuple[float, ...]:
        """Return the combined radii of curvature [m] along x and, for points, along y at an operating point."""
        return tuple(value for _, value in self.shape(op).radii)

    def hertz(self, load: float) -> Hertz:
        """Return Hertz's contact of the smooth, dry bodies at a load [N] above zero."""
        return self.shape().hertz(load, self.solids.reduced_modulus)

    def hertz_at(self, op: OperatingPoint) -> Hertz:
        """Return Hertz's contact of the smooth, dry bodies at an operating point with a load."""
        return self.shape(op).hertz(op.load, self.solids.reduced_modulus)

    @cached_property
    def unit_hertz(self) -> Hertz:
        """Hertz's contact at 1 N; `Hertz.growth` gives it at other loads."""
        return self.hertz(1.0)

    def unit_hertz_at(self, op: OperatingPoint) -> Hertz:
        """Return Hertz's contact at 1 N and the radii of an operating point."""
        if op.radius_x is op.radius_y is None:
            return self.unit_hertz
        return _unit_hertz(self.shape(op), self.solids.reduced_modulus)

    @cached_property
    def rows(self) -> int:
        """Rows of nodes that the contact has along y before a scar makes them more."""
        return self.geometry.rows(self.film, self.surface_1.smooth and self.surface_2.smooth)

    @property
    def period(self) -> int:
        """Rows of nodes after which the surfaces repeat along y; along x they repeat after film.domain."""
        return self.rows if self._own_shape.periodic else self.rows - 1

    @property
    def patch_size(self) -> tuple[float, float]:
        """Lengths [m] along y and x after which the surfaces repeat, as asked for.

        On the grid that along y is a whole number of nodes: files are stretched as generated waves are.
        """
        return self.film.width or self.period * self.film.spacing, self.film.domain

    @cached_property
    def depths(self) -> Array:
        """Depths [m] below the surfaces at which stresses are sampled."""
        return self.stress.depths(self.film.spacing, self.hertz(self.operation.load).a)

    @property
    def repeats(self) -> float:
        """Number of times the grid lies in the contact, side by side along y."""
        return self.geometry.repeats(self.rows * self.film.spacing)

    @property
    def rougher(self) -> int:
        """Index of the rougher body: 0 of body 1, 1 of body 2; 1 if they are alike."""
        return 0 if self.surface_1.rms > self.surface_2.rms else 1

    @property
    def track_lengths(self) -> tuple[float, float]:
        """Travel [m] of a surface point of body 1 and 2 between two passes."""
        return self.geometry.track_length_1, self.geometry.track_length_2

    def grid(self, rows: int) -> Grid:
        """Return the nodes of the contact with `rows` of them along y."""
        film = self.film
        return Grid.centred(rows, film.points, film.spacing, periodic=self._own_shape.periodic, repeats=self.repeats)

    @property
    def room(self) -> tuple[float, float]:
        """Largest half widths [m] of Hertz's contact along x and y that the grid has room for."""
        across = (self.rows - 1) * self.film.spacing / ROOM if self.geometry.bounded_across else math.inf
        return self.film.domain / ROOM, across

    def has_room(self, hertz: Hertz) -> bool:
        """Return True if the grid has room for Hertz's contact."""
        return all(half <= room for half, room in zip((hertz.a, hertz.b), self.room, strict=True))

    @property
    def largest_load(self) -> float:
        """Largest load [N] that the scene's grid has to hold."""
        operation = self.operation
        return max(operation.largest_load, operation.load, *(step.load or 0.0 for step in operation.steps))

    def digest(self) -> str:
        """Return the fingerprint of what a stored state depends on: shape, surfaces and grid."""
        return self._digest

    @cached_property
    def _digest(self) -> str:
        table = self.to_dict()
        parts = {key: table[key] for key in ("geometry", "surface_1", "surface_2")}
        for surface in (parts["surface_1"], parts["surface_2"]):
            surface.get("heights", {}).pop("file", None)  # wherever they lie
        parts["grid"] = [self.film.points, self.film.domain, self.rows]
        if self.stress.samples:
            parts["depths"] = self.depths.tolist()
        return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()[:16]


@lru_cache(maxsize=64)
def _unit_hertz(shape: Shape, reduced_modulus: float) -> Hertz:
    return shape.hertz(1.0, reduced_modulus)
