"""Undeformed shapes of the smooth bodies: their gap, Hertz's contact, and the film that formulas give them.

Loads are those of the whole contact [N]; a line's and a roller's lie on its face. x runs along entrainment.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from .reference import (
    Hertz,
    SmoothContact,
    SmoothLine,
    hertz_line,
    hertz_point,
    line_film,
    nvm_film,
    rolling_line,
    rolling_point,
)

Array = NDArray[np.float64]
Viscosity = Callable[[Array, float], Array]  # [Pa s] at pressures [Pa] and a temperature [K]

_DEEPEST = 0.1  # drop of an edge, in radii: no deformation reaches that far


@dataclass(frozen=True)
class Point:
    """Parabolic along both axes: a circular or elliptical point contact."""

    periodic: ClassVar[bool] = False
    power: ClassVar[float] = 1 / 3  # of load and radii in Hertz's half widths
    order: ClassVar[int] = 2  # of the size in the area that carries the load

    radius_x: float  # of combined curvature [m]
    radius_y: float

    @property
    def circular(self) -> bool:
        """Whether it is that of a ball."""
        return self.radius_x == self.radius_y

    @property
    def side_resistance(self) -> float:
        """To side flow of starved films, see `reference.supplied_film`: 3 for circles. For ellipses fitted to solved
        films: within 3 % for radius_y / radius_x up to 20, within 11 % down to 0.2.
        """
        ratio = self.radius_y / self.radius_x
        return float(min(3.0 * ratio ** (0.35 if ratio > 1.0 else 0.2), 15.0))

    @property
    def opening(self) -> float:
        """Gap at a distance d before Hertz's contact, over (d / a)^1.5 a^2 / radius_x: it goes with p_H a."""
        return 0.6 * self.softness(self.hertz(1.0, 1.0), 1.0)

    def gap(self, x: Array, y: Array, unit: float) -> Array:
        """Gap [ny, nx] of the touching bodies in unit^2 / radius_x at x [nx], y [ny] in `unit` [m]."""
        radius_2: Array = x[None, :] ** 2 + self.radius_x / self.radius_y * y[:, None] ** 2
        return 0.5 * radius_2

    def hertz(self, load: float, reduced_modulus: float) -> Hertz:
        """Hertz's contact of the dry bodies."""
        return hertz_point(load, self.radius_x, self.radius_y, reduced_modulus)

    def softness(self, hertz: Hertz, reduced_modulus: float) -> float:
        """Pi radius_x p_H / (E' a): what the half space gives in Hertz's units; 1 for a circle."""
        if self.circular:
            return 1.0
        return np.pi * self.radius_x * hertz.pressure_max / (reduced_modulus * hertz.a)

    def depths(self, film: float, a: float, b: float) -> tuple[float, float]:
        """A film [m] over the depth of Hertz's contact of half widths a and b [m], along x and along y."""
        return film * self.radius_x / (a * a), film * self.radius_y / (b * b)

    def carried(self, hertz: Hertz, size: float, depth: float) -> float:
        """Load over p_H a^n l^(2 - n), n = `order` and l = `size` [m], of a grid that is `depth` [m] deep."""
        return 2.0 * np.pi / 3.0 * (hertz.b / hertz.a)

    def smooth(
        self, load: float, speed: float, viscosity: Viscosity, temperature: float, reduced_modulus: float
    ) -> SmoothContact:
        """The smooth contact in the terms of film formulas, at an entrainment speed [m/s]."""
        return SmoothContact.of(load, speed, viscosity, temperature, self.radius_x, self.radius_y, reduced_modulus)

    def film(
        self, load: float, speed: float, viscosity: float, pressure_coefficient: float, reduced_modulus: float
    ) -> float:
        """Central film [m] of the smooth bodies by a formula of all regimes, of plain numbers: no record to make."""
        x, y = self.radius_x, self.radius_y
        return nvm_film(load, speed, viscosity, pressure_coefficient, x, y, reduced_modulus)

    def rolling(self, load: float, speed: float, viscosity: float, reduced_modulus: float) -> float:
        """Rolling resistance [N] of the smooth bodies for an entrainment speed [m/s] and a load [N] above zero."""
        return rolling_point(load, speed, viscosity, self.radius_x, self.radius_y, reduced_modulus)


@dataclass(frozen=True)
class Line:
    """A cylinder without ends: a line contact that repeats itself across. Methods as in `Point`."""

    periodic: ClassVar[bool] = True
    power: ClassVar[float] = 1 / 2
    order: ClassVar[int] = 1
    side_resistance: ClassVar[float] = np.inf
    circular: ClassVar[bool] = False
    opening: ClassVar[float] = 2.0 * np.sqrt(2.0) / 3.0

    radius_x: float  # of combined curvature [m]
    length: float  # of the face that carries the load [m]

    def gap(self, x: Array, y: Array, unit: float) -> Array:
        """Gap of the touching bodies, the same in all rows."""
        return np.tile(0.5 * x**2, (y.size, 1))

    def hertz(self, load: float, reduced_modulus: float) -> Hertz:
        """Hertz's contact of the dry bodies."""
        return hertz_line(load, self.radius_x, self.length, reduced_modulus)

    def softness(self, hertz: Hertz, reduced_modulus: float) -> float:
        """What the half space gives in Hertz's units."""
        return 0.25 * np.pi

    def depths(self, film: float, a: float, b: float) -> tuple[float, float]:
        """As of a point; a line is as deep all along y."""
        return film * self.radius_x / (a * a), 0.0

    def carried(self, hertz: Hertz, size: float, depth: float) -> float:
        """Load of a grid in these units."""
        return 0.5 * np.pi * depth / size

    def smooth(
        self, load: float, speed: float, viscosity: Viscosity, temperature: float, reduced_modulus: float
    ) -> SmoothLine:
        """The smooth contact in the terms of film formulas."""
        return SmoothLine.of(load / self.length, speed, viscosity, temperature, self.radius_x, reduced_modulus)

    def film(
        self, load: float, speed: float, viscosity: float, pressure_coefficient: float, reduced_modulus: float
    ) -> float:
        """Central film [m] of the smooth bodies."""
        return line_film(load / self.length, speed, viscosity, pressure_coefficient, self.radius_x, reduced_modulus)

    def rolling(self, load: float, speed: float, viscosity: float, reduced_modulus: float) -> float:
        """Rolling resistance [N] of the smooth bodies for an entrainment speed [m/s] and a load [N] above zero."""
        return self.length * rolling_line(load / self.length, speed, viscosity, self.radius_x, reduced_modulus)


class Profile(Protocol):
    """How the ends of a roller are taken back; a law of `laws.profile`."""

    def drop(self, y: Array, length: float) -> Array:
        """Material taken away [m] at y [m] from the middle of a face of a length [m]; inf beyond its ends."""


@dataclass(frozen=True)
class Roller(Line):
    """A cylinder with ends. Methods as in `Point`; formulas and Hertz's contact are those of a line as long."""

    periodic: ClassVar[bool] = False
    side_resistance: ClassVar[float] = 15.0  # as of a wide ellipse

    profile: Profile

    def gap(self, x: Array, y: Array, unit: float) -> Array:
        """Gap of the touching bodies."""
        drop = np.minimum(self.profile.drop(y * unit, self.length), _DEEPEST * self.radius_x)
        return 0.5 * x[None, :] ** 2 + drop[:, None] * (self.radius_x / unit**2)

    def carried(self, hertz: Hertz, size: float, depth: float) -> float:
        """Load of a grid in these units; all of the roller is on it."""
        return 0.5 * np.pi * self.length / size


Shape = Point | Line | Roller
