"""Frictionless contact of rough, elastic-perfectly-plastic bodies without a fluid.

The pressure minimises the elastic energy p K p / 2 + gap p under 0 <= p <= cap and sum p = load. The nodes strictly
between their bounds are a face. On a face conjugate gradients run, preconditioned by the inverse of the half space on a
periodic plane; then the face changes: pressures beyond a bound are set to it, and nodes whose gap has the wrong sign
leave their bound. Faces and projected gradients are those of Moré & Toraldo, SIAM J. Optim. 1 (1991) 93,
doi:10.1137/0801008, the preconditioner that of Vollebregt, J. Comput. Phys. 257 (2014) 333,
doi:10.1016/j.jcp.2013.10.005. Coarse grids give the start, and the transforms span only the window that holds the
contact. On a half space that is periodic along y windows span all rows, and coarse grids of odd numbers of rows two
periods.
"""

from collections.abc import Sequence
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
import scipy

from .arrays import Array, Mask
from .dry_faces import Contact
from .half_space import Convolution, HalfSpace

Window = tuple[int, int, int, int]  # first row, end of rows, first column, end of columns

_COARSEST = 33  # nodes along the longer side of the first grid
_COARSE_TOLERANCE = 3e-3
_MARGIN = 1  # cells around the contact on a coarse grid in which that on the next may lie


class DrySolution(NamedTuple):
    """A dry contact in the units of the call; arrays [ny, nx]."""

    pressure: Array
    gap: Array  # deformed: 0 in contact, above 0 beside it, below 0 where the pressure is at its cap
    rigid: float  # `gap` less undeformed gap and deformation
    converged: bool
    iterations: int  # on the grid itself
    error: float  # estimate of sum |p - exact p| / load


def solve_dry(
    half_space: HalfSpace, gap: Array, cap: Array, load: float, start: Array, tolerance: float, iterations: int
) -> tuple[Array, float, bool, int]:
    """Return pressure, rigid gap, convergence and iterations of `dry_solution`."""
    found = dry_solution(half_space, gap, cap, load, start, tolerance, iterations)
    return found.pressure, found.rigid, found.converged, found.iterations


def dry_solution(
    half_space: HalfSpace,
    gap: Array,
    cap: Array,
    load: float,
    start: Array,
    tolerance: float,
    iterations: int,
    soft: Array | None = None,
) -> DrySolution:
    """Return the pressure [ny, nx] of sum `load` with 0 <= p <= cap, and its gap.

    gap [ny, nx] is that of the undeformed bodies up to a constant; start is any pressure of about the right place. The
    caps must carry more than the load. `tolerance` is the largest error of the pressure, sum |p - exact p| / load.
    Each node gives way by `soft` [ny, nx] times its own pressure, on top of the half space; None: by nothing.
    """
    lowest = float(gap.min())
    grids = _grids(gap - lowest, cap, load, half_space.periodic, soft)
    window, p = _coarse_solution(half_space, grids, start, iterations)
    done, whole = 0, (0, gap.shape[0], 0, gap.shape[1])
    while True:
        if _cut(cap, window).sum() <= load:
            window = whole
        contact = _contact(half_space, grids[0], window, 1)
        part = contact.solve(_cut(p, window), tolerance, iterations - done)
        done += part.iterations
        p = np.zeros_like(gap)
        _cut(p, window)[:] = part.pressure
        h = grids[0].gap + half_space.deform(p) - part.datum
        if soft is not None:
            h += soft * p
        inside = _cut(h, window)
        drift = contact.give * float(np.abs(inside - part.gap)[part.pressure > 0.0].sum()) / load
        outside = (h < 0.0) & (p <= 0.0) & (cap > 0.0)
        _cut(outside, window)[:] = False
        error = part.error + drift - contact.give * float(h[outside].sum()) / load
        if error < tolerance or done >= iterations or (part.error >= tolerance and not outside.any()):
            break
        if outside.any():
            j0, j1, i0, i1 = _ends(outside)
            ends = (min(j0, window[0]), max(j1, window[1]), min(i0, window[2]), max(i1, window[3]))
            window = _roomy(ends, gap.shape, half_space.periodic)
    met = abs(float(p.sum()) - load) < 1e-10 * load
    return DrySolution(p, h, -part.datum - lowest, error < tolerance and met, done, error)


class _Grid(NamedTuple):
    """A contact on a grid whose cells are 1, 2, 4 ... nodes wide."""

    gap: Array
    cap: Array
    load: float
    lowest: Array  # least gap of the nodes in each cell
    soft: Array | None  # by which a node gives way per pressure of its own; None: by nothing


def _grids(gap: Array, cap: Array, load: float, periodic: bool, soft: Array | None) -> list[_Grid]:
    """Return the grid and coarser ones, each of half the nodes of the one before."""
    grids = [_Grid(gap, cap, load, gap, soft)]
    while True:
        gap, cap, load, lowest, soft = grids[-1]
        ny, nx = gap.shape
        if max(ny, nx) <= _COARSEST or min(nx if periodic else ny, nx) <= _COARSEST // 4:
            return grids
        coarse = _halved(cap, _mean, periodic)
        load *= 0.5 if periodic and ny % 2 else 0.25
        coarse *= max(1.01 * load / coarse.sum(), 1.0)  # cells that stick out of the grid took some of it
        lowest = _halved(lowest, np.minimum, periodic)
        soft = None if soft is None else _halved(soft, _mean, periodic)
        grids.append(_Grid(_halved(gap, _mean, periodic), coarse, load, lowest, soft))


def _mean(a: Array, b: Array) -> Array:
    return 0.5 * (a + b)


def _halved(a: Array, join, periodic: bool) -> Array:  # type: ignore[no-untyped-def]
    if periodic and len(a) % 2:
        a = np.concatenate((a, a))
    ny, nx = a.shape
    if ny % 2 or nx % 2:
        a = np.pad(a, ((0, ny % 2), (0, nx % 2)), mode="edge")
    a = join(a[::2], a[1::2])
    return np.asarray(join(a[:, ::2], a[:, 1::2]))


def _coarse_solution(half_space: HalfSpace, grids: list[_Grid], start: Array, iterations: int) -> tuple[Window, Array]:
    """Return a window that should hold the contact, and a first pressure."""
    shape = grids[0].gap.shape
    depth = len(grids) - 1
    if depth == 0:
        return (0, shape[0], 0, shape[1]), start
    p = start
    for _ in range(depth):
        p = _halved(p, _mean, half_space.periodic)
    window = (0, p.shape[0], 0, p.shape[1])
    for level in range(depth, 0, -1):
        grid = grids[level]
        if _cut(grid.cap, window).sum() > grid.load:
            part = _contact(half_space, grid, window, 2**level).solve(_cut(p, window), _COARSE_TOLERANCE, iterations)
            p = np.zeros_like(grid.gap)
            _cut(p, window)[:] = part.pressure
            deepest = _cut(grid.lowest, window) - _cut(grid.gap, window)  # of a node in a cell, below the cell's mean
            j0, j1, i0, i1 = _ends((part.gap + deepest < 0.0) | (part.pressure > 0.0))
            j, i = window[0], window[2]
            window = (j + j0 - _MARGIN, j + j1 + _MARGIN, i + i0 - _MARGIN, i + i1 + _MARGIN)
        window = _roomy([2 * end for end in window], grids[level - 1].gap.shape, half_space.periodic)
        ny, nx = grids[level - 1].gap.shape
        p = np.repeat(np.repeat(p, 2, axis=0), 2, axis=1)[:ny, :nx]
    return window, p


def _roomy(ends: Sequence[int], shape: tuple[int, ...], periodic: bool) -> Window:
    """Return a window around `ends` with lengths that are fast to transform.

    On a half space that is periodic it holds all rows.
    """
    found: list[int] = []
    for first, end, n, whole in ((ends[0], ends[1], shape[0], periodic), (ends[2], ends[3], shape[1], False)):
        length = 2 * scipy.fft.next_fast_len((end - first + 1) // 2)
        if length >= n or whole:
            found += [0, n]
        else:
            at = min(max((first + end - length) // 2, 0), n - length)
            found += [at, at + length]
    return found[0], found[1], found[2], found[3]


def _ends(chosen: Mask) -> Window:
    """Return the smallest window that holds all chosen nodes."""
    rows, columns = np.flatnonzero(chosen.any(axis=1)), np.flatnonzero(chosen.any(axis=0))
    return int(rows[0]), int(rows[-1]) + 1, int(columns[0]), int(columns[-1]) + 1


def _cut(a, window):  # type: ignore[no-untyped-def]
    return a[window[0] : window[1], window[2] : window[3]]


# by the half space of the whole grid, then by shape and cell width of a part: its half space (None: the same), inverse
_OPERATORS: WeakKeyDictionary[HalfSpace, dict[tuple[int, int, int], tuple[HalfSpace | None, Convolution]]]
_OPERATORS = WeakKeyDictionary()


def _contact(half_space: HalfSpace, grid: _Grid, window: Window, width: int) -> Contact:
    """Return the contact on a window of a grid whose cells are `width` nodes of the half space wide.

    Operators are kept for the next call.
    """
    gap, cap = np.ascontiguousarray(_cut(grid.gap, window)), np.ascontiguousarray(_cut(grid.cap, window))
    store = _OPERATORS.setdefault(half_space, {})
    ny, nx = gap.shape
    key = (ny, nx, width)
    if key not in store:
        if len(store) >= 8:
            store.pop(next(iter(store)))
        same = width == 1 and gap.shape == half_space.shape
        part = half_space if same else half_space.window(ny, nx, width)
        store[key] = (None if same else part, _periodic_inverse(part))
    deformed, inverse = store[key]
    deformed = deformed or half_space
    if grid.soft is None:
        return Contact(deformed, inverse, gap, cap, grid.load)
    soft = np.ascontiguousarray(_cut(grid.soft, window))
    return Contact(deformed, _periodic_inverse(deformed, float(soft.mean())), gap, cap, grid.load, soft)


def _periodic_inverse(half_space: HalfSpace, soft: float = 0.0) -> Convolution:
    """Return the inverse of the half space, with nodes that give way by `soft`, on the smallest periodic plane.

    Its kernel falls like 1 / r^3.
    """
    ny, nx = half_space.shape
    spectrum = half_space.spectrum(half_space.plane(ny, nx)) + soft
    spectrum[0, 0] = spectrum[0, 1]  # the mean belongs to the load
    return Convolution(ny, 1.0 / np.maximum(spectrum, 1e-3 * spectrum.max()), half_space.library)
