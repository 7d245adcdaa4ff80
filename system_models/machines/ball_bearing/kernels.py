"""Balls between two grooves: where they and the inner ring come to rest, and how the balls roll.

In the plane (axial, radial) through the bearing's axis and a ball lie the curvature centre of the outer groove, which
is the origin, the ball's centre and the curvature centre of the inner groove. A contact is a spring that pulls two of
them together once they are further apart than a free length, with the force K s^(3/2) of its stretch s. The energy of
springs and forces that do not depend on the position is convex in all positions together, so that there is one
equilibrium, and Newton's method with a line search on the slope finds it from anywhere.

ring [5]: its displacement along x, y, z and its tilt about y, z times the radius on which the inner groove's centre
lies; forces on the ring likewise. balls [Z, 2]: their centres; pressed [Z, 2]: what else acts on them.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

import contact_core.kernels  # noqa: F401  # decides where compiled kernels are kept
from contact_core.kernels.arrays import Array

_jit = njit(cache=True, nogil=True, error_model="numpy")

_STEPS, _CUTS, _ROUNDS, _STAYS = 200, 60, 200, 2
_EPS = 2.3e-16
_NOTHING = 1e-100  # N: a force below is none, so that no square of one underflows where nothing holds a ball
_STILL = 1e-14  # N: a force on the ring below is none; where nothing holds it, what is left over moves it by 1 pm
BALANCED = 1e-9  # of the largest force, at least of 1 N: more left over is no equilibrium
_UNTOUCHED = 1e-2  # N: less on all inner contacts together hardly drives the cage
_SHARP = 4.0
_ROUNDING = 1e-9  # of the springs' lengths: a smaller stretch is what the search for a ball's rest leaves of it
_GRAZING = 0.1  # least cosine between a ball's axis and the plane of its contact, where no groove reaches any more


class Bearing(NamedTuple):
    """What of a bearing stays while ring and balls come to rest."""

    azimuths: Array  # [Z, 2]: cos, sin of the balls'
    centre: Array  # of the inner groove before the ring moves
    springs: Array  # (stiffness, free length) of the outer, then of the inner contact
    centring: Array  # [5]: stiffness of what else holds the ring
    holds: Array  # lever of spin friction at 1 N [m] of the inner and the outer contact
    masses: Array  # of a ball times pitch radius, and twice its moment of inertia over its diameter
    ratio: float  # of ball to pitch diameter
    idle: float  # speed of the cage, over that of the inner ring, where no ball is driven


@_jit
def pull(x, r, stiffness, free):  # type: ignore[no-untyped-def]
    """Return the force of a spring that reaches over (x, r): size, components, their derivatives xx, xr, rr."""
    length = np.hypot(x, r)
    stretch = length - free
    if stretch <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    root, ex, er = np.sqrt(stretch), x / length, r / length
    force, along = stiffness * stretch * root, 1.5 * stiffness * root
    across = force / length
    steep = along - across
    return force, force * ex, force * er, across + steep * ex * ex, steep * ex * er, across + steep * er * er


@_jit
def _is_far_enough(along, down, part):  # type: ignore[no-untyped-def]
    """Return True if a part of Newton's step may end here: slope `along` after slope `down` at its start."""
    return abs(along) <= -0.5 * down or (along < 0.0 and part == 1.0)


@_jit
def _between(part, along, low, below, high, above):  # type: ignore[no-untyped-def]
    """Return the next part of a step to try, and the parts `low`, `high` between which the slope changes its sign."""
    if along < 0.0:
        low, below = part, along
    else:
        high, above = part, along
    cut = below / (below - above)
    return low + (high - low) * min(max(cut, 0.1), 0.9), low, below, high, above


@_jit
def _at_ball(x, r, cx, cr, bx, br, springs):  # type: ignore[no-untyped-def]
    """Return the derivatives of a ball's energy by its position between the origin and (cx, cr), under b."""
    _, ox, oy, oxx, oxr, orr = pull(x, r, springs[0], springs[1])
    _, ix, iy, ixx, ixr, irr = pull(cx - x, cr - r, springs[2], springs[3])
    return ox - ix - bx, oy - iy - br, oxx + ixx, oxr + ixr, orr + irr


@_jit
def _determinant(xx, xr, rr):  # type: ignore[no-untyped-def]
    """Return the determinant of a symmetric, not negative matrix, at least what rounding leaves of it."""
    return max(xx * rr - xr * xr, _EPS * (xx + rr) ** 2)


@_jit
def _seat_ball(x, r, cx, cr, bx, br, springs):  # type: ignore[no-untyped-def]
    """Return the position of rest of a ball that is near (x, r)."""
    size = springs[1] + springs[3]
    gx, gr, hxx, hxr, hrr = _at_ball(x, r, cx, cr, bx, br, springs)
    norm = np.hypot(gx, gr)
    for _ in range(_STEPS):
        floor = _EPS * size * (hxx + hrr)
        if norm <= max(floor, _NOTHING):
            break
        hxx, hrr = hxx + norm / size, hrr + norm / size  # no step beyond the bearing's size where nothing holds it
        scale = 1.0 / _determinant(hxx, hxr, hrr)
        sx, sr = (hxr * gr - hrr * gx) * scale, (hxr * gx - hxx * gr) * scale
        down, part = gx * sx + gr * sr, 1.0
        low, below, high, above = 0.0, down, 1.0, 0.0
        for _ in range(_CUTS):
            gx, gr, hxx, hxr, hrr = _at_ball(x + part * sx, r + part * sr, cx, cr, bx, br, springs)
            along = gx * sx + gr * sr
            if _is_far_enough(along, down, part):
                break
            part, low, below, high, above = _between(part, along, low, below, high, above)
        x, r = x + part * sx, r + part * sr
        before, norm = norm, np.hypot(gx, gr)
        if norm <= 100.0 * floor and norm > 0.5 * before:
            break
    return x, r


@_jit
def _product(one, other):  # type: ignore[no-untyped-def]
    total = 0.0
    for i in range(one.size):
        total += one[i] * other[i]
    return total


@_jit
def _solved(matrix, right):  # type: ignore[no-untyped-def]
    """Return the solution of a symmetric positive definite system, by Cholesky's factors; overwrites both.

    Pivots that rounding has made too small are raised to what it leaves of the largest entry.
    """
    n, least = right.size, 0.0
    for i in range(n):
        least = max(least, _EPS * matrix[i, i])
    for i in range(n):
        for j in range(i + 1):
            total = matrix[i, j]
            for k in range(j):
                total -= matrix[i, k] * matrix[j, k]
            matrix[i, j] = np.sqrt(max(total, least)) if i == j else total / matrix[j, j]
    for i in range(n):
        for k in range(i):
            right[i] -= matrix[i, k] * right[k]
        right[i] /= matrix[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            right[i] -= matrix[k, i] * right[k]
        right[i] /= matrix[i, i]
    return right


@_jit
def groove_centre(centre, ring, cos, sin):  # type: ignore[no-untyped-def]
    """Return the centre of the inner groove at an azimuth once the ring has moved."""
    return centre[0] + ring[0] + sin * ring[3] - cos * ring[4], centre[1] + cos * ring[1] + sin * ring[2]


@_jit
def _at_ring(ring, balls, pressed, bearing, forces, slope, curvature):  # type: ignore[no-untyped-def]
    """Return the derivatives of the energy by the ring's coordinates, with all balls at rest; moves `balls`."""
    for i in range(5):
        slope[i] = bearing.centring[i] * ring[i] - forces[i]
        curvature[i, :] = 0.0
        curvature[i, i] = bearing.centring[i]
    springs, axial, radial = bearing.springs, np.zeros(5), np.zeros(5)
    axial[0] = 1.0
    for j in range(balls.shape[0]):
        cos, sin = bearing.azimuths[j]
        cx, cr = groove_centre(bearing.centre, ring, cos, sin)
        x, r = _seat_ball(balls[j, 0], balls[j, 1], cx, cr, pressed[j, 0], pressed[j, 1], springs)
        balls[j, 0], balls[j, 1] = x, r
        _, fx, fr, ixx, ixr, irr = pull(cx - x, cr - r, springs[2], springs[3])
        _, _, _, oxx, oxr, orr = pull(x, r, springs[0], springs[1])
        axial[3], axial[4], radial[1], radial[2] = sin, -cos, cos, sin
        for i in range(5):
            slope[i] += fx * axial[i] + fr * radial[i]
        # both springs in series, inner (inner + outer)^-1 outer
        hxx, hxr, hrr = ixx + oxx, ixr + oxr, irr + orr
        if hxx + hrr == 0.0:
            continue
        scale = 1.0 / _determinant(hxx, hxr, hrr)
        a, b = (hrr * oxx - hxr * oxr) * scale, (hrr * oxr - hxr * orr) * scale
        c, d = (hxx * oxr - hxr * oxx) * scale, (hxx * orr - hxr * oxr) * scale
        sxx, sxr, srr = ixx * a + ixr * c, ixx * b + ixr * d, ixr * b + irr * d
        for i in range(5):
            left, right = sxx * axial[i] + sxr * radial[i], sxr * axial[i] + srr * radial[i]
            for k in range(5):
                curvature[i, k] += left * axial[k] + right * radial[k]


@_jit
def seat_ring(ring, balls, pressed, bearing, forces, least):  # type: ignore[no-untyped-def]
    """Move ring and balls to rest; returns the largest force left over, and the steps taken.

    A force below `least` is none.
    """
    size = bearing.springs[1] + bearing.springs[3]
    slope, curvature, trial = np.zeros(5), np.zeros((5, 5)), np.zeros(5)
    _at_ring(ring, balls, pressed, bearing, forces, slope, curvature)
    norm, steps, stays = np.abs(slope).max(), 0, 0
    while norm > _STILL and steps < _STEPS:
        steps += 1
        for i in range(5):
            curvature[i, i] += norm / size
        step = _solved(curvature, -slope)
        down, part = _product(slope, step), 1.0
        low, below, high, above = 0.0, down, 1.0, 0.0
        for cut in range(_CUTS):
            trial[:] = ring + part * step
            _at_ring(trial, balls, pressed, bearing, forces, slope, curvature)
            along = _product(slope, step)
            if _is_far_enough(along, down, part):
                break
            part, low, below, high, above = _between(part, along, low, below, high, above)
            if cut == _CUTS - 2:
                part = 0.0  # back: rounding decides which way is down
        ring[:] = trial
        before, norm = norm, np.abs(slope).max()
        stays = stays + 1 if norm > 0.5 * before else 0
        if part == 0.0 or (norm <= least and stays > _STAYS):  # also where the ring has play, and a force moves it far
            break
    return norm, steps


@_jit
def rolling(inner, outer, held_inner, held_outer, ratio):  # type: ignore[no-untyped-def]
    """Return the rolling of a ball with contact angles `inner`, `outer` [rad], per angular speed of the inner ring.

    ratio: of ball to pitch diameter. held: the resistance of a contact to spin (any unit). The outer ring is at rest.
    Returns orbit, roll, tilt of the axis [rad], and for the inner and the outer contact: rolling of the ball relative
    to the race, spin (of the ball relative to the race, about the contact's normal that points outward).
    """
    free_inner = np.arctan2(np.sin(inner), np.cos(inner) - ratio)  # tilt at which this contact does not spin
    free_outer = np.arctan2(np.sin(outer), np.cos(outer) + ratio)
    if held_inner > held_outer:
        part = 1.0 / (1.0 + (held_outer / held_inner) ** _SHARP)
    elif held_outer > 0.0:
        part = 1.0 - 1.0 / (1.0 + (held_inner / held_outer) ** _SHARP)
    else:
        part = 0.5
    tilt = free_outer + part * (free_inner - free_outer)
    over_inner, over_outer = inner - tilt, outer - tilt
    by_inner = (1.0 - ratio * np.cos(inner)) / max(np.cos(over_inner), _GRAZING)
    by_outer = (1.0 + ratio * np.cos(outer)) / max(np.cos(over_outer), _GRAZING)
    orbit = by_inner / (by_inner + by_outer)
    roll = orbit * by_outer / ratio
    return (
        orbit,
        roll,
        tilt,
        roll * np.cos(over_inner) + (1.0 - orbit) * np.cos(inner),
        roll * np.cos(over_outer) - orbit * np.cos(outer),
        -roll * np.sin(over_inner) - (1.0 - orbit) * np.sin(inner),
        -roll * np.sin(over_outer) + orbit * np.sin(outer),
    )


@_jit
def motions(ring, balls, bearing, found):  # type: ignore[no-untyped-def]
    """Fill `found` [Z, 11]: inner and outer load, their angles, and the results of `rolling`.

    A ball without load on the inner race has there the angle of the outer one; a loose ball, whose place is any, has
    the angle of the line through both grooves' centres.
    """
    springs, holds = bearing.springs, bearing.holds
    least = (_ROUNDING * (springs[1] + springs[3])) ** 1.5
    for j in range(balls.shape[0]):
        x, r = balls[j]
        cx, cr = groove_centre(bearing.centre, ring, bearing.azimuths[j, 0], bearing.azimuths[j, 1])
        inner, outer = pull(cx - x, cr - r, springs[2], springs[3])[0], pull(x, r, springs[0], springs[1])[0]
        inner = inner if inner > springs[2] * least else 0.0
        outer = outer if outer > springs[0] * least else 0.0
        out = np.arctan2(x, r) if outer > 0.0 else np.arctan2(cx, cr)
        into = np.arctan2(cx - x, cr - r) if inner > 0.0 else out
        found[j, 0], found[j, 1], found[j, 2], found[j, 3] = inner, outer, into, out
        rolls = rolling(into, out, holds[0] * inner ** (4.0 / 3.0), holds[1] * outer ** (4.0 / 3.0), bearing.ratio)
        for i in range(7):
            found[j, 4 + i] = rolls[i]


@_jit
def cage(found, idle):  # type: ignore[no-untyped-def]
    """Return the cage's speed over the inner ring's: mean orbit of the driven balls, weighted with their inner load.

    idle: the cage's where no ball is driven.
    """
    total, driven = _UNTOUCHED * idle, _UNTOUCHED
    for j in range(found.shape[0]):
        total += found[j, 0] * found[j, 4]
        driven += found[j, 0]
    return total / driven


@_jit
def settle(ring, balls, inertia, bearing, forces, speed, found):  # type: ignore[no-untyped-def]
    """Bring ring and balls to rest under forces on the ring and the balls' inertia at an angular speed of the ring.

    inertia [Z, 2]: forces of inertia on the balls over speed^2; a first guess, improved in place. Gyroscopic moments
    are those of outer race control, held by friction on that race. Returns the largest force left over, the largest
    force, and Newton's steps.

    A guess, of ring and inertia, that is no number, or out of the bearing, or leads to no balance is left for none.
    """
    springs, masses, ratio = bearing.springs, bearing.masses, bearing.ratio
    size, square, seats, wanted = springs[1] + springs[3], speed * speed, balls.copy(), np.empty_like(inertia)
    if not (np.abs(ring).sum() <= size and np.abs(inertia).sum() < np.inf):
        ring[:] = 0.0
        inertia[:] = 0.0
    left, largest, change, steps, taken = 0.0, 1.0, 0.0, 0, 0
    for _ in range(2):
        before = np.inf
        for _ in range(_ROUNDS):
            pressed = square * inertia
            largest = max(np.abs(forces).max(), np.abs(pressed).max(), 1.0)
            left, taken = seat_ring(ring, balls, pressed, bearing, forces, 1e-10 * largest)
            steps += taken
            motions(ring, balls, bearing, found)
            orbit, change = cage(found, bearing.idle), 0.0
            for j in range(balls.shape[0]):
                # under outer race control the spin's radial part is orbit sin(outer) / ratio
                outer, squared = found[j, 3], orbit * orbit
                gyration = masses[1] * squared * np.sin(outer) / ratio
                x, r = -gyration * np.cos(outer), masses[0] * squared + gyration * np.sin(outer)
                wanted[j, 0], wanted[j, 1] = x, r
                change = max(change, square * np.hypot(x - inertia[j, 0], r - inertia[j, 1]))
            inertia += (1.0 if change < 0.5 * before else 0.5) * (wanted - inertia)
            before = change
            if change <= 1e-13 * largest:
                break
        if max(left, change) <= BALANCED * largest:
            break
        ring[:] = 0.0
        inertia[:] = 0.0
        balls[:] = seats
    return max(left, change), largest, steps
