"""What a ball bearing computes with arrays, once more with scalars that are never changed: to be written in C.

`INSTEAD` names the functions that these stand for. They agree to rounding. Balls are in tuples, as in `kernels`.
"""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from . import equilibrium, load_classes, part
from .equilibrium import Equilibrium, RingLoads
from .geometry import BallBearingGeometry, Race
from .kernels import _between, _is_far_enough, _seat_ball, groove_centre, pull, rolling

Row = Any  # a tuple of numbers
Rows = Any  # a tuple of such tuples

_STEPS, _CUTS, _ROUNDS = 200, 60, 200
_EPS = 2.3e-16
_SWEEPS = 30  # of Jacobi's rotations
_AXES = (0, 1, 2, 3, 4)


def solve(
    geometry: BallBearingGeometry,
    loads: RingLoads,
    speed: float,
    start: tuple[float, ...] | None = None,
    first_ball: float = 0.0,
    tilt_stiffness: float = 0.0,
) -> Equilibrium:
    """Return what `equilibrium.solve` returns."""
    count, arm, fixed = geometry.balls, geometry.groove_centre_radius, equilibrium._fixed(geometry)
    azimuth = _azimuths(count, first_ball)
    known = [0.0] * (5 + 2 * count) if start is None else start
    forces = (loads.x, loads.y, loads.z, loads.moment_y / arm, loads.moment_z / arm)
    tilting = 1e-2 + tilt_stiffness / arm**2
    ring, inertia, found, left, largest = settle(
        geometry,
        tuple(known[:5]),
        tuple([(known[5 + 2 * j], known[6 + 2 * j]) for j in range(count)]),
        [(math.cos(a), math.sin(a)) for a in azimuth],
        forces,
        (1e-2, 1e-2, 1e-2, tilting, tilting),
        speed,
    )
    table = np.array(found)
    return Equilibrium(
        (ring[0], ring[1], ring[2]),
        (ring[3] / arm, ring[4] / arm),
        np.array(azimuth),
        table[:, 0],
        table[:, 1],
        table[:, 2],
        table[:, 3],
        table[:, 4:],
        _cage(found, fixed.idle),
        left / largest,
        0,
        (*ring, *[x for pair in inertia for x in pair]),
    )


def _azimuths(count: int, first_ball: float) -> list[float]:
    return [first_ball + 2.0 * math.pi * j / count for j in range(count)]


def settle(
    geometry: BallBearingGeometry, ring: Row, inertia: Rows, azimuths: Rows, forces: Row, centring: Row, speed: float
) -> tuple[Row, Rows, Rows, float, float]:
    """Return ring, inertia and motions at rest, the largest force left over and the largest force."""
    fixed = equilibrium._fixed(geometry)
    square, before, left, largest, change = speed * speed, math.inf, 0.0, 1.0, 0.0
    balls = tuple([(x, r) for x, r in fixed.balls.tolist()])
    found = tuple([tuple([0.0] * 11) for _ in azimuths])
    for _ in range(_ROUNDS):
        pressed = tuple([(square * x, square * r) for x, r in inertia])
        largest = max(_largest(forces), _largest([x for pair in pressed for x in pair]), 1.0)
        ring, balls, left = seat_ring(geometry, ring, balls, pressed, azimuths, forces, centring, 1e-10 * largest)
        found = tuple([_motion(geometry, ring, ball, azimuth) for ball, azimuth in zip(balls, azimuths, strict=True)])
        orbit = _cage(found, fixed.idle)
        wanted = [_wanted(geometry, each[3], orbit) for each in found]
        changes = [square * math.hypot(w[0] - i[0], w[1] - i[1]) for w, i in zip(wanted, inertia, strict=True)]
        change = max(changes)
        part = 1.0 if change < 0.5 * before else 0.5
        inertia = tuple(
            [(i[0] + part * (w[0] - i[0]), i[1] + part * (w[1] - i[1])) for w, i in zip(wanted, inertia, strict=True)]
        )
        before = change
        if change <= 1e-13 * largest:
            break
    return ring, inertia, found, max(left, change), largest


def _largest(values: Any) -> float:
    return max([abs(value) for value in values])


def _wanted(geometry: BallBearingGeometry, outer: float, orbit: float) -> tuple[float, float]:
    """Return the inertia of a ball over speed^2, as `kernels.settle` has it."""
    masses, squared = equilibrium._fixed(geometry).masses, orbit * orbit
    gyration = float(masses[1]) * squared * math.sin(outer) / geometry.ratio
    return -gyration * math.cos(outer), float(masses[0]) * squared + gyration * math.sin(outer)


def _motion(geometry: BallBearingGeometry, ring: Row, ball: Row, azimuth: Row) -> Row:
    """Return a row of `kernels.motions`."""
    fixed = equilibrium._fixed(geometry)
    springs, holds = fixed.springs.tolist(), fixed.holds.tolist()
    x, r = ball
    cx, cr = groove_centre(fixed.centre.tolist(), ring, azimuth[0], azimuth[1])
    inner = pull(cx - x, cr - r, springs[2], springs[3])[0]
    outer = pull(x, r, springs[0], springs[1])[0]
    out = math.atan2(x, r)
    into = math.atan2(cx - x, cr - r) if inner > 0.0 else out
    rolls = rolling(into, out, holds[0] * inner ** (4.0 / 3.0), holds[1] * outer ** (4.0 / 3.0), geometry.ratio)
    return (inner, outer, into, out, *rolls)


def _cage(found: Rows, idle: float) -> float:
    """Return what `kernels.cage` returns."""
    total, driven = 1e-2 * idle, 1e-2
    for each in found:
        total = total + each[0] * each[4]
        driven = driven + each[0]
    return total / driven


def seat_ring(
    geometry: BallBearingGeometry,
    ring: Row,
    balls: Rows,
    pressed: Rows,
    azimuths: Rows,
    forces: Row,
    centring: Row,
    least: float,
) -> tuple[Row, Rows, float]:
    """Return ring and balls at rest, and the largest force left over."""
    springs = equilibrium._fixed(geometry).springs.tolist()
    size = springs[1] + springs[3]
    slope, curvature, balls = _at_ring(geometry, ring, balls, pressed, azimuths, forces, centring)
    norm = _largest(slope)
    for _ in range(_STEPS):
        if norm <= 0.0:
            break
        step = _solved(curvature, slope, norm / size)
        down, part, trial = _product(slope, step), 1.0, ring
        low, below, high, above = 0.0, down, 1.0, 0.0
        for _ in range(_CUTS):
            trial = tuple([r + part * s for r, s in zip(ring, step, strict=True)])
            slope, curvature, balls = _at_ring(geometry, trial, balls, pressed, azimuths, forces, centring)
            along = _product(slope, step)
            if _is_far_enough(along, down, part):
                break
            part, low, below, high, above = _between(part, along, low, below, high, above)
        ring, before, norm = trial, norm, _largest(slope)
        if norm <= least and norm > 0.5 * before:
            break
    return ring, balls, norm


def _product(one: Row, other: Row) -> float:
    return sum([a * b for a, b in zip(one, other, strict=True)])


def _at_ring(
    geometry: BallBearingGeometry, ring: Row, balls: Rows, pressed: Rows, azimuths: Rows, forces: Row, centring: Row
) -> tuple[Row, Rows, Rows]:
    """Return slope and curvature of the energy, and the balls at rest, as `kernels._at_ring`."""
    seats = [
        _at_azimuth(geometry, ring, ball, b, azimuth) for ball, b, azimuth in zip(balls, pressed, azimuths, strict=True)
    ]
    slope = tuple([centring[i] * ring[i] - forces[i] + sum([seat[1][i] for seat in seats]) for i in _AXES])
    curvature = tuple(
        [
            tuple([(centring[i] if i == k else 0.0) + sum([seat[2][i][k] for seat in seats]) for k in _AXES])
            for i in _AXES
        ]
    )
    return slope, curvature, tuple([seat[0] for seat in seats])


def _at_azimuth(
    geometry: BallBearingGeometry, ring: Row, ball: Row, pressed: Row, azimuth: Row
) -> tuple[Row, Row, Rows]:
    """Return a ball at rest, and its parts of slope and curvature."""
    fixed = equilibrium._fixed(geometry)
    springs = fixed.springs.tolist()
    cos, sin = azimuth
    cx, cr = groove_centre(fixed.centre.tolist(), ring, cos, sin)
    x, r = _seat_ball(ball[0], ball[1], cx, cr, pressed[0], pressed[1], springs)
    _, fx, fr, ixx, ixr, irr = pull(cx - x, cr - r, springs[2], springs[3])
    _, _, _, oxx, oxr, orr = pull(x, r, springs[0], springs[1])
    axial, radial = (1.0, 0.0, 0.0, sin, -cos), (0.0, cos, sin, 0.0, 0.0)
    sxx, sxr, srr = _series(ixx, ixr, irr, oxx, oxr, orr)
    slope = tuple([fx * a + fr * b for a, b in zip(axial, radial, strict=True)])
    left = [sxx * a + sxr * b for a, b in zip(axial, radial, strict=True)]
    right = [sxr * a + srr * b for a, b in zip(axial, radial, strict=True)]
    rows = [tuple([m * axial[k] + n * radial[k] for k in _AXES]) for m, n in zip(left, right, strict=True)]
    return (x, r), slope, tuple(rows)


def _series(ixx: float, ixr: float, irr: float, oxx: float, oxr: float, orr: float) -> tuple[float, float, float]:
    """Return the stiffness of both springs in series, inner (inner + outer)^-1 outer."""
    hxx, hxr, hrr = ixx + oxx, ixr + oxr, irr + orr
    if hxx + hrr == 0.0:
        return 0.0, 0.0, 0.0
    scale = 1.0 / max(hxx * hrr - hxr * hxr, _EPS * (hxx + hrr) ** 2)
    a, b = (hrr * oxx - hxr * oxr) * scale, (hrr * oxr - hxr * orr) * scale
    c, d = (hxx * oxr - hxr * oxx) * scale, (hxx * orr - hxr * oxr) * scale
    return ixx * a + ixr * c, ixx * b + ixr * d, ixr * b + irr * d


def _solved(curvature: Rows, slope: Row, more: float) -> Row:
    """Return the solution of (curvature + more) step = -slope by Cholesky's factors, as `kernels._solved`."""
    least = _EPS * max([curvature[i][i] + more for i in _AXES])
    factor: dict[str, float] = {}
    for i in _AXES:
        for j in range(i + 1):
            own = curvature[i][j] + (more if i == j else 0.0)
            total = own - sum([factor[f"l_{i}_{k}"] * factor[f"l_{j}_{k}"] for k in range(j)])
            factor[f"l_{i}_{j}"] = math.sqrt(max(total, least)) if i == j else total / factor[f"l_{j}_{j}"]
    down: list[float] = []
    for i in _AXES:
        rest = -slope[i] - sum([factor[f"l_{i}_{k}"] * down[k] for k in range(i)])
        down = [*down, rest / factor[f"l_{i}_{i}"]]
    found: list[float] = []
    for i in _AXES[::-1]:
        rest = down[i] - sum([factor[f"l_{4 - k}_{i}"] * found[k] for k in range(4 - i)])
        found = [*found, rest / factor[f"l_{i}_{i}"]]
    return tuple(found[::-1])


# load classes


def gathered(loads: Any, levels: int) -> tuple[Any, Any, Any]:
    """Return what `load_classes.gathered` returns."""
    size = [_cube_root(load) for load in loads]
    total = sum(size)
    if total <= 0.0:
        even = [1.0 / len(size)] * len(size)
        return np.array([0.0] * levels), np.array([0.0] * levels), np.array([even] * levels)
    cloud = [1.0 + load_classes._CLOUD * (2.0 * k + 1.0 - levels) / levels for k in range(levels)]
    points = [c * s for c in cloud for s in size]
    start = [math.sqrt(s / (levels * total)) for _ in cloud for s in size]
    basis, diagonal, beside = _lanczos(points, start, levels)
    values, vectors = _eigen(diagonal, beside)
    weights: list[Any] = []
    for vector in vectors:
        all_points = [sum([v * b[p] for v, b in zip(vector, basis, strict=True)]) for p in range(len(points))]
        weights = [
            *weights,
            [sum([all_points[k * len(size) + j] ** 2 for k in range(levels)]) for j in range(len(size))],
        ]
    counts = [total * vector[0] ** 2 / value for vector, value in zip(vectors, values, strict=True)]
    return np.array([value * value * value for value in values]), np.array(counts), np.array(weights)


def _cube_root(x: float) -> float:
    return math.exp(math.log(x) / 3.0) if x > 0.0 else 0.0


def _lanczos(points: Any, start: Any, steps: int) -> tuple[list[Any], list[float], list[float]]:
    """Return the basis, and the diagonal and what is beside it, of Lanczos' steps."""
    basis: list[Any] = [start]
    diagonal: list[float] = []
    beside: list[float] = []
    for k in range(steps):
        image = [p * b for p, b in zip(points, basis[k], strict=True)]
        diagonal = [*diagonal, _product(basis[k], image)]
        if k + 1 < steps:
            for _ in range(2):
                parts = [_product(each, image) for each in basis]
                image = [
                    x - sum([part * each[p] for part, each in zip(parts, basis, strict=True)])
                    for p, x in enumerate(image)
                ]
            norm = math.sqrt(_product(image, image))
            beside = [*beside, norm]
            basis = [*basis, [x / norm for x in image]]
    return basis, diagonal, beside


def _eigen(diagonal: Any, beside: Any) -> tuple[list[float], list[Any]]:
    """Return eigenvalues of a symmetric tridiagonal matrix, the smallest first, and vectors, by Jacobi's rotations."""
    size = len(diagonal)
    matrix = [
        [diagonal[i] if i == j else beside[min(i, j)] if abs(i - j) == 1 else 0.0 for j in range(size)]
        for i in range(size)
    ]
    vectors = [[1.0 if i == j else 0.0 for j in range(size)] for i in range(size)]
    for _ in range(_SWEEPS):
        for p in range(size - 1):
            for q in range(p + 1, size):
                cos, sin = _rotation(matrix[p][p], matrix[q][q], matrix[p][q])
                matrix = _turned(_transposed(_turned(matrix, p, q, cos, sin)), p, q, cos, sin)
                vectors = _turned(vectors, p, q, cos, sin)
    rows = [[matrix[i][i], *vectors[i]] for i in range(size)]
    for last in range(size - 1, 0, -1):
        for i in range(last):
            first, second = _ordered(rows[i], rows[i + 1])
            rows = [*rows[:i], first, second, *rows[i + 2 :]]
    return [row[0] for row in rows], [row[1:] for row in rows]


def _rotation(app: float, aqq: float, apq: float) -> tuple[float, float]:
    """Return cos and sin of the rotation that makes apq vanish."""
    if apq == 0.0:
        return 1.0, 0.0
    theta = (aqq - app) / (2.0 * apq)
    size = 1.0 / (abs(theta) + math.sqrt(theta * theta + 1.0))
    tan = size if theta >= 0.0 else -size
    cos = 1.0 / math.sqrt(tan * tan + 1.0)
    return cos, tan * cos


def _turned(rows: Any, p: int, q: int, cos: float, sin: float) -> Any:
    """Return rows p and q turned."""
    first = [cos * a - sin * b for a, b in zip(rows[p], rows[q], strict=True)]
    second = [sin * a + cos * b for a, b in zip(rows[p], rows[q], strict=True)]
    return [first if i == p else second if i == q else row for i, row in enumerate(rows)]


def _transposed(rows: Any) -> Any:
    return [list(column) for column in zip(*rows, strict=True)]


def _ordered(one: Any, other: Any) -> tuple[Any, Any]:
    if other[0] < one[0]:
        return other, one
    return one, other


def pressure(race: Race, load: float) -> float:
    """Return the largest pressure [Pa] of a contact, which grows with the cube root of its load."""
    return race.unit.pressure_max * _cube_root(load)


INSTEAD: Mapping[Any, Callable[..., Any]] = {
    equilibrium.solve: solve,
    load_classes.gathered: gathered,
    part.pressure: pressure,
}
