"""Radii, speeds and tracks of contacts along the path of contact.

Positions are distances [m] from T1, numbers or arrays. Speeds of rotation [rad/s] are positive as the gears turn; the
surface speeds are relative to the contact.
"""

import math
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from contact_core.errors import SceneError
from contact_core.kernels.arrays import Array

from .geometry import SpurGearPair

Numbers = TypeVar("Numbers", float, Array)

_ALIKE = 1e-9  # of the path: distances below it are rounding


def radius(pair: SpurGearPair, position: Numbers) -> Numbers:
    """Return the combined radius of curvature [m] of two involutes whose own radii are the distances to T1 and T2.

    R = s (T - s) / T, s being the position on the path and T its length between the base circles.
    """
    return position * (pair.line_length - position) / pair.line_length


def surface_speeds(pair: SpurGearPair, position: Numbers, speed_1: float, speed_2: float) -> tuple[Numbers, Numbers]:
    """Return surface speeds [m/s] of pinion and wheel that turn at speed_1 and speed_2 [rad/s].

    u_1 = omega_1 s, u_2 = omega_2 (T - s).
    """
    return speed_1 * position, speed_2 * (pair.line_length - position)


def track_lengths(pair: SpurGearPair, position: Numbers) -> tuple[Numbers, Numbers]:
    """Return the track lengths [m] of flank points of pinion and wheel: surface speed times the turn of the gear.

    A point touches the other gear once a turn, so this is the travel between two passes of it, whatever the speed.
    """
    return 2.0 * math.pi * position, 2.0 * math.pi * (pair.line_length - position)


def named_points(pair: SpurGearPair) -> dict[str, float]:
    """Return A, B, C, D and E with their positions [m], in the order in which the contact passes them."""
    points = {
        "A": pair.start, "B": pair.single_start, "C": pair.pitch_point, "D": pair.single_end, "E": pair.end,
    }  # fmt: skip
    return dict(sorted(points.items(), key=lambda point: point[1]))


@dataclass(frozen=True)
class Stations:
    """Positions where contacts are solved, and the parts of the path that they stand for; arrays [n] from A to E."""

    position: Array  # [m]
    stretch: Array  # [m]; all together the path of contact


def steps(pair: SpurGearPair) -> Array:
    """Return A, E, and every position [m] between them where pairs of teeth come or go, or where sliding reverses."""
    inside = range(1, math.ceil(pair.contact_ratio))
    found = sorted(
        [pair.pitch_point]
        + [pair.start + i * pair.base_pitch for i in inside]
        + [pair.end - i * pair.base_pitch for i in inside]
    )
    near = _ALIKE * (pair.end - pair.start)
    edges = [pair.start]
    for edge in found:
        if edges[-1] + near < edge < pair.end - near:
            edges.append(edge)
    return np.array([*edges, pair.end])


def stations_of(pair: SpurGearPair, count: int) -> Stations:
    """Return `count` stations in the middles of stretches that end at A, B, C, D and E.

    The load of a pair of teeth jumps at B and D, and sliding turns round at C. A station there would have two loads, or
    none of the friction of its surroundings; a stretch across would mix them. Between these points the stretches are
    equal, their number so that the longest is as short as can be. Sums over stations are then the midpoint rule on
    smooth pieces: exact for linear integrands, such as of a constant coefficient of friction under rigid sharing,
    and of second order else. Raises SceneError if there are fewer stations than pieces.
    """
    edges = steps(pair)
    lengths = np.diff(edges)
    if count < len(lengths):
        raise SceneError(f"stations = {count} must be at least {len(lengths)}: one between any two of A, B, C, D, E.")
    numbers = np.ones(len(lengths), dtype=int)
    for _ in range(count - len(lengths)):
        numbers[np.argmax(np.round(lengths / numbers / (_ALIKE * lengths.sum())))] += 1  # equal ones in order
    pieces = [low + length * (np.arange(n) + 0.5) / n for low, length, n in zip(edges, lengths, numbers, strict=False)]
    return Stations(np.concatenate(pieces), np.repeat(lengths / numbers, numbers))
