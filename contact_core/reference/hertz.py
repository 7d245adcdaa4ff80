"""Dry contact of smooth elastic bodies: Hertz."""

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import ClassVar, Protocol

import numpy as np
import scipy  # its parts are loaded at their first use

from ..kernels.arrays import Array, Mask

Nodes = tuple[Array, Array]  # pressures over the largest [n, 1], their weights in the mean over the contact [n]

_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(10)
_FINE, _FINE_WEIGHTS = np.polynomial.legendre.leggauss(16)


def _ellipse_nodes() -> Nodes:
    """Return Gauss nodes of the mean over an ellipse.

    The pressure is proportional to t at the distance sqrt(1 - t^2) from the centre, the area dA to t dt.
    """
    t = 0.5 + 0.5 * _GAUSS[:, None]
    return t, t[:, 0] * _WEIGHTS


def _strip_nodes() -> Nodes:
    """Return Gauss nodes of the mean over a strip.

    The pressure is proportional to cos(s) at x = a sin(s), the area dA to cos(s) ds.
    """
    cosine = np.cos(0.25 * math.pi * (1.0 + _GAUSS))
    return cosine[:, None], 0.25 * math.pi * cosine * _WEIGHTS


class Conductors(Protocol):
    """Two bodies that conduct the heat of a contact away, as `laws.heat`."""

    def conductances(self, radius: Array, speeds: tuple[Array, Array], *, hottest: bool = False) -> tuple[Array, Array]:
        """Return heat flux per mean rise [W/(m2 K)] into each body, even source on a circle of `radius` [m].

        `hottest`: mean flux per largest rise, under a source spread like Hertz's pressure.
        """

    def strip_conductances(
        self, a: Array, b: float, speeds: tuple[Array, Array], *, hottest: bool = False
    ) -> tuple[Array, Array]:
        """Return the same for a strip of half width a and half length b [m]."""


@dataclass(frozen=True)
class Hertz:
    """Dry contact of smooth elastic bodies on an ellipse."""

    mean_share: ClassVar[float] = 2.0 / 3.0  # mean pressure over the largest
    chord_share: ClassVar[float] = 0.25 * math.pi  # mean of `chords`
    pressure_nodes: ClassVar[Nodes] = _ellipse_nodes()  # for means over the contact of functions of the pressure

    a: float  # half width along x [m]
    b: float  # half width along y [m]
    pressure_max: float  # [Pa]
    approach: float  # of points far away [m]

    @cached_property
    def area(self) -> float:
        """Contact area [m2]."""
        return math.pi * self.a * self.b

    @property
    def pressure_mean(self) -> float:
        """Mean pressure over the contact area [Pa]."""
        return self.mean_share * self.pressure_max

    def inside(self, x: Array, y: Array, share: float) -> Mask:
        """Return the nodes within `share` of the half widths, [ny, nx], at x [nx], y [ny] about the centre [m]."""
        within: Mask = (x[None, :] / self.a) ** 2 + (y[:, None] / self.b) ** 2 < share**2
        return within

    def gap(self, x: Array, y: Array, reduced_modulus: float) -> Array:
        """Return the gap [m] around the contact, [ny, nx], at x [nx], y [ny] about its centre [m]; 0 within.

        reduced_modulus E' = 2 / sum (1 - v^2)/E [Pa]. The integral over confocal ellipses, by Gauss's rule.
        Source: Johnson, Contact Mechanics, 1985, doi:10.1017/CBO9781139171731, section 3.5.
        """
        along, across = (x[None, :] / self.a) ** 2, (y[:, None] / self.a) ** 2
        b_2 = (self.b / self.a) ** 2
        half = 0.5 * (along + across - 1.0 - b_2)
        apart = np.sqrt(np.maximum(half**2 + along * b_2 + across - b_2, 0.0))
        end = np.arcsinh(np.sqrt(np.maximum(half + apart, 0.0)))
        total = np.zeros_like(end)
        for node, weight in zip(_FINE, _FINE_WEIGHTS, strict=True):
            sinh_2 = np.sinh(0.5 * (1.0 + node) * end) ** 2
            total += weight * (along / (1.0 + sinh_2) + across / (b_2 + sinh_2) - 1.0) / np.sqrt(1.0 + sinh_2 / b_2)
        return np.asarray(self.pressure_max * self.a / reduced_modulus * end * total)

    def chords(self, y: Array) -> Array:
        """Return the length along x of the contact's rows at y [m] over 2 a."""
        return np.sqrt(np.maximum(1.0 - (y / self.b) ** 2, 0.0))

    @cached_property
    def lever_share(self) -> float:
        """Mean distance from the centre, weighted with the pressure, over b."""
        if self.a == self.b:
            return 3.0 * math.pi / 16.0
        return 0.75 * float(scipy.special.elliprg(0.0, 1.0, (self.a / self.b) ** 2))

    @cached_property
    def turn_share(self) -> float:
        """Sliding speed over spin b at which sliding friction equals its value without spin.

        For friction in proportion to pressure at any speed, extrapolated from slow sliding: 1 / mean of b x^2 / r^3.
        """
        slim = (self.a / self.b) ** 2
        return 2.0 / (slim * float(scipy.special.elliprd(0.0, 1.0, slim)))

    def conductances(
        self, bodies: Conductors, areas: Array, speeds: tuple[Array, Array], *, hottest: bool = False
    ) -> tuple[Array, Array]:
        """Return heat flux per mean rise [W/(m2 K)] into each of the bodies under an even source that holds still.

        The source covers `areas` [m2]; speeds [m/s]. It stands on a circle as large as the ellipse. `hottest`: mean
        flux per largest rise, under a source spread like Hertz's pressure; fast bodies pass it along the ellipse's a.
        """
        if hottest:
            shorter = math.sqrt(self.b / self.a)
            speeds = (shorter * speeds[0], shorter * speeds[1])
        return bodies.conductances(np.sqrt(areas / math.pi), speeds, hottest=hottest)

    def growth(self, times: float) -> tuple[float, float]:
        """Return the factors on a and the pressure, and on b, under `times` the load."""
        root = times ** (1 / 3)
        return root, root

    def approach_beyond(self, distance: float) -> float:
        """Return the part of the approach [m] from beyond a distance [m] of the contact: 0 for a point."""
        return 0.0

    def approach_at(self, times: float) -> float:
        """Return the approach [m] under `times` this load."""
        root = times ** (1 / 3)
        return self.approach * root * root


@dataclass(frozen=True)
class HertzLine(Hertz):
    """Dry contact of smooth cylinders with parallel axes: a strip of half width a and half length b."""

    mean_share: ClassVar[float] = 0.25 * math.pi
    chord_share: ClassVar[float] = 1.0
    pressure_nodes: ClassVar[Nodes] = _strip_nodes()

    @cached_property
    def area(self) -> float:
        return 4.0 * self.a * self.b

    def inside(self, x: Array, y: Array, share: float) -> Mask:
        """Return the nodes within `share` of the half widths, [ny, nx], at x [nx], y [ny] about the centre [m]."""
        within: Mask = (np.abs(x) < share * self.a)[None, :] & (np.abs(y) < share * self.b)[:, None]
        return within

    def gap(self, x: Array, y: Array, reduced_modulus: float) -> Array:
        """Return the gap [m] beside a strip without ends, [ny, nx], as `Hertz.gap`."""
        along = np.maximum(np.abs(x) / self.a, 1.0)
        row = along * np.sqrt(along**2 - 1.0) - np.arccosh(along)
        return np.tile(2.0 * self.pressure_max * self.a / reduced_modulus * row, (y.size, 1))

    def chords(self, y: Array) -> Array:
        return np.where(np.abs(y) < self.b, 1.0, 0.0)

    @cached_property
    def lever_share(self) -> float:
        """Mean distance from the centre over b, for a strip much longer than wide."""
        return 0.5

    @cached_property
    def turn_share(self) -> float:
        """The ratio of a point, for a strip much longer than wide: the part within it slides with the others."""
        return 1.0

    def conductances(
        self, bodies: Conductors, areas: Array, speeds: tuple[Array, Array], *, hottest: bool = False
    ) -> tuple[Array, Array]:
        """Return the same as `Hertz.conductances` for a source on the strip."""
        return bodies.strip_conductances(0.25 * areas / self.b, self.b, speeds, hottest=hottest)

    def growth(self, times: float) -> tuple[float, float]:
        return math.sqrt(times), 1.0

    def approach_beyond(self, distance: float) -> float:
        """Return the part of the approach [m] of an endless line from a distance [m] up to its length."""
        return self.approach * math.log(2.0 * self.b / distance) / (math.log(4.0 * self.b / self.a) + 0.5)

    def approach_at(self, times: float) -> float:
        """Return the approach [m] under `times` this load: the logarithm of `hertz_line` falls with a."""
        if times == 0.0:
            return 0.0
        slower = math.log(times) / (2.0 * math.log(4.0 * self.b / self.a) + 1.0)
        return self.approach * times * (1.0 - slower)


def hertz_point(load: float, radius_x: float, radius_y: float, reduced_modulus: float) -> Hertz:
    """Return Hertz's point contact, circular or elliptical.

    Circle: a^3 = 3 W R / (2 E'), p_H = 3 W / (2 pi a^2), delta = a^2 / R. Ellipse: long^3 = 6 W E / [pi k^2 E' (1 / R_x
    + 1 / R_y)], short = k long, p_H = 3 W / (2 pi a b), delta = 2 p_H short K / E', K and E being the complete elliptic
    integrals for e^2 = 1 - k^2; k follows from R_large / R_small = (E / k^2 - K) / (K - E).

    load [N] > 0, radii of combined curvature [m], reduced_modulus E' = 2 / sum (1 - v^2)/E [Pa].
    Source: Johnson, Contact Mechanics, 1985, doi:10.1017/CBO9781139171731, section 4.2.
    """
    if radius_x == radius_y:
        a = (1.5 * load * radius_x / reduced_modulus) ** (1 / 3)
        return Hertz(a, a, 1.5 * load / (np.pi * a * a), a * a / radius_x)
    small, large = sorted((radius_x, radius_y))
    k, ellipk, ellipe = _ellipse(large / small)
    curvature = 0.5 * (1.0 / small + 1.0 / large)
    long = (3.0 * load * ellipe / (np.pi * k * k * reduced_modulus * curvature)) ** (1 / 3)
    short = k * long
    pressure = 1.5 * load / (np.pi * long * short)
    approach = 2.0 * pressure * short * ellipk / reduced_modulus
    a, b = (short, long) if radius_x == small else (long, short)
    return Hertz(float(a), float(b), float(pressure), float(approach))


@lru_cache(maxsize=64)
def _ellipse(ratio: float) -> tuple[float, float, float]:
    """Return k, K and E of Hertz's ellipse, for a ratio > 1 of the radii.

    k: short over long half width; K, E: complete elliptic integrals of its eccentricity.
    """
    special = scipy.special

    def mismatch(log_ratio: float) -> float:
        k2 = np.exp(2.0 * log_ratio)  # (short half width / long half width)^2
        return float(special.elliprd(0.0, 1.0, k2) / special.elliprd(0.0, k2, 1.0) - ratio)

    # Carlson's integrals, because E/k^2 - K and K - E lose their digits near the circle
    k = float(np.exp(scipy.optimize.brentq(mismatch, np.log(1e-12), 0.0, xtol=1e-15)))
    return k, float(special.elliprf(0.0, k * k, 1.0)), 2.0 * float(special.elliprg(0.0, k * k, 1.0))


def hertz_line(load: float, radius: float, length: float, reduced_modulus: float) -> HertzLine:
    """Return Hertz's line contact under a load [N] > 0 that is spread evenly over a length [m].

    With the load per length w: a^2 = 8 w R / (pi E'), p_H = 2 w / (pi a).

    radius of combined curvature [m], reduced_modulus E' = 2 / sum (1 - v^2)/E [Pa]. The approach is that of points far
    below the middle of the length, 2 w / (pi E') [2 ln(2 length / a) + 1] with the load per length w, up to terms of
    (a / length)^2: what half spaces yield there under Hertz's pressure. A line without end has none.
    Source: Johnson, Contact Mechanics, 1985, doi:10.1017/CBO9781139171731, section 4.2; approach: Lundberg, Forsch.
    Ing.-Wes. 10 (1939) 201.
    """
    per_length = load / length
    a = math.sqrt(8.0 * per_length * radius / (math.pi * reduced_modulus))
    approach = 2.0 * per_length / (math.pi * reduced_modulus) * (2.0 * math.log(2.0 * length / a) + 1.0)
    return HertzLine(a, 0.5 * length, 2.0 * per_length / (math.pi * a), approach)
