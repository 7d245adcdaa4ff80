"""Equilibrium of the inner ring under its loads: five degrees of freedom, balls with inertia.

Source: Jones, J. Basic Eng. 82 (1960) 309, doi:10.1115/1.3662587, with choices of our own: the balls' inertia is that
of one speed of orbit, the cage's, and their gyroscopic moments are those of outer race control, held by friction on
that race; for these forces, both equilibria, of the balls and of the ring, are the minimum of one convex energy (see
`kernels`), and the forces follow from the equilibrium before until they stay.

Not in it: rings that bend, the shoulders at which a groove ends, friction forces other than the gyroscopic ones,
weight, the change of curvatures with the contact angles.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from contact_core.arrays import Array

from .geometry import BallBearingGeometry
from .kernels import BALANCED, cage, settle

_CENTRING = 1e-2  # N/m: holds the ring where no ball does, such as in its clearance


class RingLoads(NamedTuple):
    """Loads of the shaft on the inner ring [N, N m]; x is the axis, moments are about the centre of its grooves."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    moment_y: float = 0.0
    moment_z: float = 0.0


@dataclass(frozen=True)
class Equilibrium:
    """The bearing at rest in a frame that turns with the cage; arrays [balls], ball 1 first."""

    displacement: tuple[float, float, float]  # of the inner ring along x, y, z [m]
    tilt: tuple[float, float]  # about y, z [rad]
    azimuth: Array  # from y towards z [rad]
    load_inner: Array  # [N]
    load_outer: Array
    angle_inner: Array  # contact angles [rad]; that of the outer race where a ball does not touch the inner one
    angle_outer: Array
    rolling: Array  # [balls, 7], as `kernels.rolling` returns it
    cage: float  # speed of the cage over that of the inner ring
    residual: float  # largest force left over, over the largest force there is, at least 1 N
    steps: int  # of Newton's method
    start: tuple[float, ...]  # where the search for the next equilibrium may start

    @property
    def converged(self) -> bool:
        """True if the forces balance."""
        return self.residual <= BALANCED


def solve(
    geometry: BallBearingGeometry,
    loads: RingLoads,
    speed: float,
    start: tuple[float, ...] | None = None,
    first_ball: float = 0.0,
    tilt_stiffness: float = 0.0,
) -> Equilibrium:
    """Return the equilibrium at an angular speed [rad/s] of the inner ring; ball 1 is at azimuth `first_ball` [rad].

    Sum of Q_j n_j + F = 0 and the same for the moments, Q = K delta^1.5, K being Hertz's stiffness of a ball on a race:
    by Newton's method.

    tilt_stiffness: of the shaft against tilt of the ring [N m/rad]. `start` of an equilibrium nearby saves time; the
    answer is the same to rounding.
    """
    count, arm = geometry.balls, geometry.groove_centre_radius
    fixed = _fixed(geometry)
    azimuth: Array = np.array([first_ball + 2.0 * math.pi * j / count for j in range(count)])
    known = np.zeros(5 + 2 * count) if start is None else np.array(start)
    ring, inertia, balls = known[:5].copy(), known[5:].reshape(count, 2).copy(), fixed.balls.copy()
    forces = np.array([loads.x, loads.y, loads.z, loads.moment_y / arm, loads.moment_z / arm])
    found = np.empty((count, 11))
    centring = _CENTRING + np.array([0.0, 0.0, 0.0, *2 * [tilt_stiffness / arm**2]])
    left, largest, steps = settle(
        ring,
        balls,
        inertia,
        np.stack([np.cos(azimuth), np.sin(azimuth)], axis=1),
        fixed.centre,
        fixed.springs,
        forces,
        centring,
        fixed.holds,
        geometry.ratio,
        fixed.idle,
        fixed.masses,
        speed,
        found,
    )
    x, y, z, tilt_y, tilt_z = ring.tolist()
    return Equilibrium(
        (x, y, z),
        (tilt_y / arm, tilt_z / arm),
        azimuth,
        found[:, 0],
        found[:, 1],
        found[:, 2],
        found[:, 3],
        found[:, 4:],
        cage(found, fixed.idle),
        left / largest,
        steps,
        (x, y, z, tilt_y, tilt_z, *inertia.ravel().tolist()),
    )


class _Fixed(NamedTuple):
    """Numbers of a geometry that the kernels need."""

    centre: Array
    springs: Array
    holds: Array
    masses: Array
    idle: float
    balls: Array  # where their seats are looked for first


@lru_cache(maxsize=64)
def _fixed(geometry: BallBearingGeometry) -> _Fixed:
    inner, outer, ball = geometry.inner, geometry.outer, geometry.ball_diameter
    reach_inner, reach_outer = inner.groove - 0.5 * ball, outer.groove - 0.5 * ball
    direction = np.array([math.sin(geometry.contact_angle), math.cos(geometry.contact_angle)])
    return _Fixed(
        centre=np.array(geometry.groove_centre),
        springs=np.array([outer.stiffness, reach_outer, inner.stiffness, reach_inner]),
        holds=np.array([inner.spin_lever, outer.spin_lever]),
        masses=np.array([0.5 * geometry.mass * geometry.pitch_diameter, 0.2 * geometry.mass * ball]),
        idle=0.5 * (1.0 - geometry.ratio * math.cos(geometry.free_angle)),
        balls=np.tile(reach_outer * direction, (geometry.balls, 1)),
    )
