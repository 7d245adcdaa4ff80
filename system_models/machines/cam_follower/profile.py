"""The cam: lift over its angle, radius of curvature, contour, and the stations where contacts are solved."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from contact_core.kernels.arrays import Array
from contact_core.quantities import parameter

_ANGLES = 2001  # at which the profile is checked
_WITHIN = 33  # angles of a station at which the travel of the contact is summed


def _fixed(unit: str, text: str, **limits: Any) -> Any:
    """Declare a number that an FMU keeps: the contacts are built for it."""
    return parameter(unit, text, shapes_arrays=True, **limits)


class Lift(NamedTuple):
    """Lift of the follower and its derivatives by the angle of the cam."""

    lift: Array  # s [m]
    slope: Array  # s' [m]
    lift_second: Array  # s'' [m per rad2]: second derivative of the lift


class Station(NamedTuple):
    """An angle of the cam that stands for a range of angles."""

    angle: float  # from the nose [rad]
    lift: float  # s [m]
    slope: float  # s' [m]: distance of the contact from the axis of the cam, along the face of the follower
    lift_second: float  # s'' [m per rad2]: second derivative of the lift, no curvature
    radius_x: float  # of the cam [m]
    travel: float  # mean of |s''| over its angles [m]: travel of the contact along the face, per angle
    weight: float  # share of a turn


@dataclass(frozen=True, kw_only=True)
class CamProfile:
    """A base circle r and a symmetric event of the follower, s = L (1 + c_2 x^2 + c_p x^p + c_q x^q), x = |angle| / B.

    The coefficients make s, s' and s'' zero at the ends of the event, so that speed and acceleration have no jump. The
    contour is the envelope of the flat face at the distance h = r + s from the axis. Its radius of curvature is
    h + h'' = r + s + s'', which must be positive: a flat face cannot follow a hollow cam.
    """

    base_radius: float = _fixed("m", "r, radius of the base circle", above=0.0, most=1.0)
    lift: float = _fixed("m", "L, largest lift", above=0.0, most=1.0)
    half_event: float = _fixed("rad", "B, angle of the cam from the start of the lift to the nose", least=0.1, most=3.1)
    power_p: int = _fixed("", "p, first high power of the lift", least=4, most=100, default=8)
    power_q: int = _fixed("", "q, second high power of the lift", least=5, most=200, default=16)

    def wrong(self) -> Iterator[str]:
        """Yield a sentence for each contradiction."""
        if self.power_q <= self.power_p:
            yield f"lobe.power_q = {self.power_q} must be above lobe.power_p = {self.power_p}."
            return
        event = self.at(np.linspace(0.0, self.half_event, _ANGLES))
        least = float((event.lift + event.lift_second).min())
        if self.base_radius + least <= 0.0:
            yield (
                f"lobe.base_radius = {self.base_radius:g} m leaves the cam hollow, where a flat follower cannot "
                f"touch it. Use more than {-least:g} m, a smaller lift, or a longer event."
            )

    @cached_property
    def _coefficients(self) -> tuple[float, float, float]:
        p, q = self.power_p, self.power_q
        return (-p * q / ((p - 2) * (q - 2)), 2 * q / ((p - 2) * (q - p)), -2 * p / ((q - 2) * (q - p)))

    def at(self, angle: Array) -> Lift:
        """Return the lift and its first two derivatives at angles [rad] from the nose, within half a turn."""
        x, sign = np.abs(angle) / self.half_event, np.sign(angle)
        within, x = x < 1.0, np.minimum(x, 1.0)
        lift, slope, second = np.ones_like(x), np.zeros_like(x), np.zeros_like(x)
        for c, n in zip(self._coefficients, (2, self.power_p, self.power_q), strict=True):
            lift += c * x**n
            slope += c * n * x ** (n - 1)
            second += c * n * (n - 1) * x ** (n - 2)
        scale = np.where(within, self.lift, 0.0)
        return Lift(scale * lift, scale * sign * slope / self.half_event, scale * second / self.half_event**2)

    def radius(self, angle: Array) -> Array:
        """Return the radius of curvature r + s + s'' [m] of the contour."""
        found = self.at(angle)
        return self.base_radius + found.lift + found.lift_second

    def stations(self, count: int) -> tuple[Station, ...]:
        """Return `count` stations in the middles of equal parts of the event, and one for the base circle."""
        angles = self.half_event * (2.0 * (np.arange(count) + 0.5) / count - 1.0)
        found, radius = self.at(angles), self.radius(angles)
        event, part = self.half_event / math.pi, 2.0 * self.half_event / count
        fine = angles[:, None] + part * np.linspace(-0.5, 0.5, _WITHIN)
        travel = np.abs(np.diff(self.at(fine).slope)).sum(axis=1) / part
        rows = zip(angles, *found, radius, travel, np.full(count, event / count), strict=True)
        rest = Station(math.pi, 0.0, 0.0, 0.0, self.base_radius, 0.0, 1.0 - event)
        return (*(Station(*map(float, row)) for row in rows), rest)
