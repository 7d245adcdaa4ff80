"""Smallest sphere around points in five dimensions, and what it tells of histories of stress.

The sphere is the largest value of a concave function of weights u >= 0 with the sum 1 of the points x,
sum u |x - c|^2 with c = sum u x: a lower bound of the squared radius for any weights, and the squared radius at the
best ones. Weights are sought on at most six points, as in Wolfe's method for the nearest point of a polytope: take in
the farthest point, go to the sphere through all points taken in, and drop those whose weights would be negative on the
way there. That ends after finitely many steps.

A deviator s is the point (sqrt(3)/2 s_xx, (s_yy - s_zz)/2, s_yz, s_xz, s_xy), whose distance from the origin is
sqrt(J2), J2 = s:s / 2.

Source of the method: Wolfe, Math. Program. 11 (1976) 128, doi:10.1007/BF01580381; for spheres derived here.
"""

import numpy as np

from .compiled import jit

PRECISION = 1e-9  # largest relative excess of the radius over that of the smallest sphere
_CLOSE = 2.0 * PRECISION  # the same of the squared radius
_FLAT = 1e-13  # squared distance from the plane of the others, relative, of a point that counts as lying in it
_DIMENSIONS = 5
_MOST = 1000  # points taken in, at most


@jit
def smallest_sphere(x, centre, taken, u):  # type: ignore[no-untyped-def]
    """Find the smallest sphere around points x [n, 5]; write its `centre` [5] and return its radius.

    The sphere holds all points; it is larger than the smallest one by less than PRECISION, relative. `taken` [7] and
    `u` [7]: work space.
    """
    first = _farthest(x, x[0])[0]
    second, widest = _farthest(x, x[first])
    taken[0], taken[1] = first, second
    u[0] = u[1] = 0.5
    count = 2
    for k in range(_DIMENSIONS):
        centre[k] = 0.5 * (x[first, k] + x[second, k])
    if widest == 0.0:
        return 0.0
    farthest = 0.0
    for _ in range(_MOST):
        far, farthest = _farthest(x, centre)
        bound = 0.0
        for i in range(count):
            bound += u[i] * _squared(x[taken[i]], centre)
        if farthest <= bound * (1.0 + _CLOSE):
            break
        taken[count], u[count] = far, 0.0
        count = _rest(x, centre, taken, u, count + 1)
    return np.sqrt(farthest)


@jit
def _squared(a, b):  # type: ignore[no-untyped-def]
    found = 0.0
    for k in range(_DIMENSIONS):
        found += (a[k] - b[k]) ** 2
    return found


@jit
def _farthest(x, centre):  # type: ignore[no-untyped-def]
    """Return the number of the point that is farthest from the centre, and its squared distance."""
    far, distance = 0, -1.0
    for i in range(x.shape[0]):
        found = _squared(x[i], centre)
        if found > distance:
            far, distance = i, found
    return far, distance


@jit
def _rest(x, centre, taken, u, count):  # type: ignore[no-untyped-def]
    """Move weights and centre to the smallest sphere around the points taken in, drop those without weight, count.

    While a point lies in the plane of others, weights change and the centre rests, until one of them has none.
    """
    factor, shift = np.empty((6, 6)), np.empty(7)
    while count > 1:
        flat = _ways(x, taken, count, factor, shift)
        if flat:  # `shift` adds up to 0 and leaves the centre: follow it the way the function rises
            rise = 0.0
            for i in range(count):
                rise += shift[i] * _squared(x[taken[i]], centre)
            if rise < 0.0:
                for i in range(count):
                    shift[i] = -shift[i]
        else:  # to the weights in `shift`
            for i in range(count):
                shift[i] -= u[i]
        step, left = 1.0 if not flat else np.inf, -1
        for i in range(count):
            if shift[i] < 0.0 and u[i] + step * shift[i] <= 0.0:
                step, left = -u[i] / shift[i], i
        for i in range(count):
            u[i] += step * shift[i]
        if left >= 0:
            count -= 1
            for i in range(left, count):
                taken[i], u[i] = taken[i + 1], u[i + 1]
        for k in range(_DIMENSIONS):
            centre[k] = 0.0
        total = 0.0
        for i in range(count):
            total += u[i]
        for i in range(count):
            u[i] /= total
            for k in range(_DIMENSIONS):
                centre[k] += u[i] * x[taken[i], k]
        if left < 0:
            break
    return count


@jit
def _ways(x, taken, count, factor, shift):  # type: ignore[no-untyped-def]
    """Write the weights of the centre of the sphere through points, and return False.

    If a point lies in the plane of those before it, write instead weights with the sum 0 that leave the centre where it
    is, and return True.
    """
    start, size = x[taken[0]], count - 1
    for i in range(size):  # Cholesky factor of the products of the edges from the first point
        a = x[taken[i + 1]]
        for j in range(i + 1):
            b = x[taken[j + 1]]
            product = 0.0
            for k in range(_DIMENSIONS):
                product += (a[k] - start[k]) * (b[k] - start[k])
            for k in range(j):
                product -= factor[i, k] * factor[j, k]
            if j < i:
                factor[i, j] = product / factor[j, j]
        if i >= _DIMENSIONS or product <= _FLAT * _squared(a, start):
            for j in range(count):
                shift[j] = 0.0
            shift[i + 1] = 1.0
            total = 1.0
            for j in range(i - 1, -1, -1):
                part = factor[i, j]
                for k in range(j + 1, i):
                    part += factor[k, j] * shift[k + 1]
                shift[j + 1] = -part / factor[j, j]
                total += shift[j + 1]
            shift[0] = -total
            return True
        factor[i, i] = np.sqrt(product)
    for i in range(size):
        part = 0.5 * _squared(x[taken[i + 1]], start)
        for k in range(i):
            part -= factor[i, k] * shift[k + 1]
        shift[i + 1] = part / factor[i, i]
    total = 0.0
    for i in range(size - 1, -1, -1):
        part = shift[i + 1]
        for k in range(i + 1, size):
            part -= factor[k, i] * shift[k + 1]
        shift[i + 1] = part / factor[i, i]
        total += shift[i + 1]
    shift[0] = 1.0 - total
    return False


@jit
def cycles(history, unloaded, slope, shear, hydrostatic, dang_van):  # type: ignore[no-untyped-def]
    """Measure the stress history [n, 6, m] of m points, into arrays [m]: see `load_cycle.cycle_of`."""
    n = history.shape[0]
    x, mean = np.empty((n + 1, _DIMENSIONS)), np.empty(n + 1)
    centre, taken, u = np.empty(_DIMENSIONS), np.empty(7, np.int64), np.empty(7)
    for point in range(history.shape[2]):
        highest = -np.inf
        for i in range(n + 1):
            if i < n:
                xx, yy, zz = history[i, 0, point], history[i, 1, point], history[i, 2, point]
                x[i, 2], x[i, 3], x[i, 4] = history[i, 3, point], history[i, 4, point], history[i, 5, point]
            else:
                xx, yy, zz = unloaded[0], unloaded[1], unloaded[2]
                x[i, 2], x[i, 3], x[i, 4] = unloaded[3], unloaded[4], unloaded[5]
            mean[i] = (xx + yy + zz) / 3.0
            x[i, 0], x[i, 1] = np.sqrt(0.75) * (xx - mean[i]), 0.5 * (yy - zz)
            highest = max(highest, mean[i])
        shear[point], hydrostatic[point] = smallest_sphere(x, centre, taken, u), highest
        worst = -np.inf
        for i in range(n + 1):
            if np.sqrt(_squared(x[i], centre)) + slope * mean[i] > worst:  # no largest shear is above sqrt(J2)
                worst = max(worst, _largest_shear(x[i], centre) + slope * mean[i])
        dang_van[point] = worst


@jit
def _largest_shear(x, centre):  # type: ignore[no-untyped-def]
    """Return half the difference of the largest and the smallest principal value of the deviator x - centre.

    It is sqrt(J2) cos(angle - 30 deg) with cos(3 angle) = sqrt(27)/2 J3 / J2^(3/2).
    """
    size = np.sqrt(_squared(x, centre))
    if size == 0.0:
        return 0.0
    xx = 2.0 / np.sqrt(3.0) * (x[0] - centre[0]) / size
    half = (x[1] - centre[1]) / size
    yy, zz = half - 0.5 * xx, -half - 0.5 * xx
    yz, xz, xy = (x[2] - centre[2]) / size, (x[3] - centre[3]) / size, (x[4] - centre[4]) / size
    third = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
    return size * np.cos(np.arccos(min(max(0.5 * np.sqrt(27.0) * third, -1.0), 1.0)) / 3.0 - np.pi / 6.0)
