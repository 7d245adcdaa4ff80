"""Balls in classes of contacts: one contact stands for all balls on a race that carry about one load.

Class k of K has the load k/K of the largest one. A ball whose load lies between those of two classes is shared by both,
in the parts that keep its load; below the lowest class a part of it is no ball at all. So each class has a number of
balls that need not be whole, loads and counts go continuously with the load on the bearing, and the sum of count times
load is that of the balls. Sums of another power of the load are approximate: what bends upward with load is too large.
Speeds and spin of a class are means over its balls; sliding is that of its own ellipse.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .geometry import BallBearingGeometry, Race
from .kinematics import SLIDE_COULOMB, Motion

Array = NDArray[np.float64]

_TRACE = 1e-9  # part that each ball has in each class, so that a class without balls moves as they do on average
_FEWEST = 1e-2  # balls that a class has at least where its track is asked for


@dataclass(frozen=True)
class Classes:
    """Classes of a race; arrays [levels], lightest first. Speeds are over the angular speed of the inner ring."""

    load: Array  # [N]
    count: Array  # balls
    entrainment: Array  # [m]
    sliding: Array  # speed of the race less that of the ball, see `kinematics` [m]
    spin: Array  # mean of its size [1]
    radius_x: Array  # of combined curvature at the contact angle there is [m]

    @property
    def ball(self) -> Array:
        """Surface speed of the ball [m]."""
        return self.entrainment - 0.5 * self.sliding

    @property
    def ring(self) -> Array:
        """Surface speed of the ring [m]."""
        return self.entrainment + 0.5 * self.sliding


def classify(geometry: BallBearingGeometry, race: Race, loads: Array, motion: Motion, levels: int) -> Classes:
    """The balls [Z] with these loads [N] on a race in `levels` classes."""
    shares = memberships(loads, levels)
    count = shares.sum(axis=1)
    weights = shares + _TRACE
    weights /= weights.sum(axis=1)[:, None]
    load = loads.max() * np.arange(1, levels + 1) / levels
    width = race.unit.b * np.cbrt(load)
    outward = -1.0 if race.name == "inner" else 1.0
    radius = 0.5 * geometry.ball_diameter * (1.0 + outward * geometry.ratio * np.cos(motion.angle))
    return Classes(
        load,
        count,
        weights @ motion.entrainment,
        SLIDE_COULOMB * (weights @ motion.bend) * width**2,
        weights @ np.abs(motion.spin),
        weights @ radius,
    )


def memberships(loads: Array, levels: int) -> Array:
    """Part of each ball [levels, Z] in each class; all zero without load."""
    largest = loads.max()
    if largest == 0.0:
        return np.zeros((levels, loads.size))
    place = loads / largest * levels
    return np.maximum(1.0 - np.abs(place[None, :] - np.arange(1, levels + 1)[:, None]), 0.0)


def track_lengths(geometry: BallBearingGeometry, race: Race, count: Array, motion: Motion) -> list[tuple[float, float]]:
    """Travel [m] of a point of the ball and of a point of the ring between two passes through a contact of each class.

    For the balls' `count` [levels] at a design load; the speed does not matter, as all of them grow with it.

    - Ball: its axis keeps its direction in it, so that one circle meets the race once a turn, in the class's part of
      the turns. A ball that tumbles spreads the wear over its surface. Inner and outer contacts of a ball on one
      circle, as under a radial load, wear it together; their films do not know of each other.
    - Inner ring: each of its points meets all balls wherever they are, `count` of them in this class each turn
      relative to the cage. The depths of all classes add up; each class has the tribofilm of its own passes only.
    - Outer ring: it stands still under a load that does too. Each of its points meets all balls, always with the load
      of its place: the classes are places, and their depths do not add up.

    Wear of a design load holds for others as far as the counts of its classes do. Counts below 0.01 are taken as that.
    """
    balls = np.maximum(count, _FEWEST)
    around = 2.0 * math.pi * race.track
    circle = float(motion.ball_track.mean())
    ring = around / balls if race.name == "inner" else np.full(balls.size, around / geometry.balls)
    return [(circle * geometry.balls / n, way) for n, way in zip(balls.tolist(), ring.tolist(), strict=True)]
