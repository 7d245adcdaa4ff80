"""Balls in classes of contacts: a few contacts stand for all balls on a race, each for those that carry about its load.

Loads and numbers of balls of the classes are nodes and weights of Gauss' quadrature for the sum over the balls, in the
variable Q^(1/3) in which the ellipses grow, and weighted with it, as rolling resistance grows about so. With K classes
sum count Q^(p/3) is that of the balls for p = 1, 2 ... 2 K: from two classes on that of the loads, of spin friction
Q^(4/3), from three on of differential sliding Q^(5/3). Counts need not be whole. A ball without load is in no class of
the inner race; on the outer one, which it only leaves as the shaft stops, it keeps almost none, and so its class.
Other differences from ball to ball, such as spin, are averaged in each class with positive weights, the squares of
Lagrange's polynomials: exact for quantities that are equal or proportional to Q^(1/3).

Nodes and means are Ritz values and squared Ritz vectors of Lanczos' method. All goes continuously with the loads: each
ball is a tiny cloud of balls, so that there are enough of them for any number of classes, also where all loads are
equal; then all classes carry that load.
"""

import math
from dataclasses import dataclass

import numpy as np

from contact_core.arrays import Array

from .geometry import BallBearingGeometry, Race
from .kinematics import SLIDE_COULOMB, Motion

_CLOUD = 1e-4  # half width of a ball's cloud over its Q^(1/3)
_LEAST = 1e-9  # least load of a ball on the outer race over the largest one
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
    """Return the balls [Z] with these loads [N] on a race in `levels` classes."""
    least = _LEAST * float(loads.max()) if race.name == "outer" else 0.0
    load, count, weights = gathered(np.maximum(loads, least), levels)
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


def gathered(loads: Array, levels: int) -> tuple[Array, Array, Array]:
    """Return loads [N] and counts of `levels` classes, and the weights [levels, Z] of the balls in means over each."""
    size = np.cbrt(loads)
    total = float(size.sum())
    if total == 0.0:
        return np.zeros(levels), np.zeros(levels), np.full((levels, loads.size), 1.0 / loads.size)
    cloud = 1.0 + _CLOUD * (2.0 * np.arange(levels) + 1.0 - levels) / levels
    points = np.outer(cloud, size).ravel()
    values, vectors, start = _ritz(points, np.sqrt(np.tile(size, levels) / (levels * total)), levels)
    weights = (vectors**2).reshape(levels, loads.size, levels).sum(axis=0).T
    return values**3, total * start**2 / values, weights


def _ritz(diagonal: Array, start: Array, steps: int) -> tuple[Array, Array, Array]:
    """Return Ritz values, Ritz vectors of a diagonal matrix by Lanczos' steps from a unit vector, its parts in them."""
    basis, matrix = np.zeros((diagonal.size, steps)), np.zeros((steps, steps))
    basis[:, 0] = start
    for k in range(steps):
        image = diagonal * basis[:, k]
        matrix[k, k] = basis[:, k] @ image
        if k + 1 < steps:
            for _ in range(2):  # orthogonal to rounding
                image = image - basis @ (basis.T @ image)
            matrix[k, k + 1] = matrix[k + 1, k] = np.linalg.norm(image)
            basis[:, k + 1] = image / matrix[k + 1, k]
    values, vectors = np.linalg.eigh(matrix)
    return values, basis @ vectors, vectors[0]


def track_lengths(geometry: BallBearingGeometry, race: Race, count: Array, motion: Motion) -> list[tuple[float, float]]:
    """Return the track lengths [m] of ball and ring in the contact of each load class.

    For the balls' `count` [levels] at a design load; the speed does not matter, as all of them grow with it.

    - Ball: its axis keeps its direction in it, so that one circle touches the race once a turn, in the class's part of
      the turns. A ball that tumbles spreads the wear over its surface. Inner and outer contacts of a ball on one
      circle, as under a radial load, wear it together; their films do not know of each other.
    - Inner ring: each of its points touches all balls wherever they are, `count` of them in this class each turn
      relative to the cage. The depths of all classes add up; each class has the tribofilm of its own passes only.
    - Outer ring: it stands still under a load that does too. Each of its points touches all balls, always with the load
      of its place: the classes are places, and their depths do not add up.

    Wear of a design load holds for others as far as the counts of its classes do. Counts below 0.01 are taken as that.
    """
    balls = np.maximum(count, _FEWEST)
    around = 2.0 * math.pi * race.track
    circle = float(motion.ball_track.mean())
    ring = around / balls if race.name == "inner" else np.full(balls.size, around / geometry.balls)
    return [(circle * geometry.balls / n, way) for n, way in zip(balls.tolist(), ring.tolist(), strict=True)]
