"""Frictionless contact of rough, elastic-perfectly-plastic bodies without a fluid.

The pressure makes the elastic energy p K p / 2 + gap p least under 0 <= p <= cap and sum p = load. The nodes strictly
between their bounds are a face. On a face conjugate gradients run, preconditioned by the inverse of the half space on a
periodic plane; then the face changes: pressures beyond a bound go to it, and nodes whose gap has the wrong sign leave
theirs. Faces and projected gradients are those of Moré & Toraldo, SIAM J. Optim. 1 (1991) 93, doi:10.1137/0801008, the
preconditioner that of Vollebregt, J. Comput. Phys. 257 (2014) 333, doi:10.1016/j.jcp.2013.10.005. Coarse grids give the
start, and the transforms span only the window that holds the contact. On a half space that is periodic along y windows
span all rows, and coarse grids of odd numbers of rows two periods.
"""

from collections.abc import Sequence
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
import scipy
from numba import njit
from numpy.typing import NDArray

from .half_space import Convolution, HalfSpace

Array = NDArray[np.float64]
States = NDArray[np.int8]
Window = tuple[int, int, int, int]  # first row, end of rows, first column, end of columns

# a pressure is 0, between its bounds, or at its cap; or the node is shut, as its cap is 0
_LOW, _FREE, _HIGH, _SHUT = range(4)
_COARSEST = 33  # nodes along the longer side of the first grid
_COARSE_TOLERANCE = 3e-3
_MARGIN = 1  # cells around the contact on a coarse grid in which that on the next may lie
_EARLY = 3.0  # the face changes once the error on it is below this many times what is wrong with it,
_EARLIEST = 0.01  # down to which that number falls when changes do not help
_MISSES = 3  # changes in a row that do not help, after which each has to lower the energy
_HUGE = 10.0  # loads: pressures so far out of bounds say nothing but the direction
_STALL = 20  # iterations without progress after which rounding is cleared away


class DrySolution(NamedTuple):
    """A dry contact in the units of the call; arrays [ny, nx]."""

    pressure: Array
    gap: Array  # deformed: 0 in contact, above 0 beside it, below 0 where the pressure is at its cap
    rigid: float  # what the undeformed gap and the deformation lack to `gap`
    converged: bool
    iterations: int  # on the grid itself
    error: float  # estimate of sum |p - exact p| / load


def solve_dry(
    half_space: HalfSpace, gap: Array, cap: Array, load: float, start: Array, tolerance: float, iterations: int
) -> tuple[Array, float, bool, int]:
    """Pressure, rigid gap, whether it converged, and iterations of `dry_solution`."""
    found = dry_solution(half_space, gap, cap, load, start, tolerance, iterations)
    return found.pressure, found.rigid, found.converged, found.iterations


def dry_solution(
    half_space: HalfSpace, gap: Array, cap: Array, load: float, start: Array, tolerance: float, iterations: int
) -> DrySolution:
    """Pressure [ny, nx] that carries `load` (its sum) with 0 <= p <= cap, and the gap that goes with it.

    gap [ny, nx] is that of the undeformed bodies up to a constant; start is any pressure of about the right place. The
    caps must carry more than the load. `tolerance` is the largest error of the pressure, sum |p - exact p| / load.
    """
    lowest = float(gap.min())
    grids = _grids(gap - lowest, cap, load, half_space.periodic)
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
        h = grids[0].gap + half_space.deform(p) - part.level
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
    return DrySolution(p, h, -part.level - lowest, error < tolerance and met, done, error)


class _Grid(NamedTuple):
    """A contact on a grid whose cells are 1, 2, 4 ... nodes wide."""

    gap: Array
    cap: Array
    load: float
    lowest: Array  # least gap of the nodes in each cell


def _grids(gap: Array, cap: Array, load: float, periodic: bool) -> list[_Grid]:
    """The grid and ever coarser ones."""
    grids = [_Grid(gap, cap, load, gap)]
    while True:
        gap, cap, load, lowest = grids[-1]
        ny, nx = gap.shape
        if max(ny, nx) <= _COARSEST or min(nx if periodic else ny, nx) <= _COARSEST // 4:
            return grids
        coarse = _halved(cap, _mean, periodic)
        load *= 0.5 if periodic and ny % 2 else 0.25
        coarse *= max(1.01 * load / coarse.sum(), 1.0)  # cells that stick out of the grid took some of it
        grids.append(_Grid(_halved(gap, _mean, periodic), coarse, load, _halved(lowest, np.minimum, periodic)))


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
    """A window that should hold the contact, and a pressure to begin with."""
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
    """A window around `ends`, of lengths that are fast to transform; of all rows if they repeat."""
    found: list[int] = []
    for first, end, n, whole in ((ends[0], ends[1], shape[0], periodic), (ends[2], ends[3], shape[1], False)):
        length = 2 * scipy.fft.next_fast_len((end - first + 1) // 2)
        if length >= n or whole:
            found += [0, n]
        else:
            at = min(max((first + end - length) // 2, 0), n - length)
            found += [at, at + length]
    return found[0], found[1], found[2], found[3]


def _ends(chosen: NDArray[np.bool_]) -> Window:
    """The window that just holds all chosen nodes."""
    rows, columns = np.flatnonzero(chosen.any(axis=1)), np.flatnonzero(chosen.any(axis=0))
    return int(rows[0]), int(rows[-1]) + 1, int(columns[0]), int(columns[-1]) + 1


def _cut(a, window):  # type: ignore[no-untyped-def]
    return a[window[0] : window[1], window[2] : window[3]]


class _Part(NamedTuple):
    """What `_Contact.solve` finds."""

    pressure: Array
    gap: Array
    level: float
    error: float
    iterations: int


# by the half space of the whole grid, then by shape and cell width of a part: its half space (None: the same), inverse
_OPERATORS: WeakKeyDictionary[HalfSpace, dict[tuple[int, int, int], tuple[HalfSpace | None, Convolution]]]
_OPERATORS = WeakKeyDictionary()


def _contact(half_space: HalfSpace, grid: _Grid, window: Window, width: int) -> "_Contact":
    """A window of a grid whose cells are `width` nodes of the half space wide; operators are kept for the next call."""
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
    return _Contact(deformed or half_space, inverse, gap, cap, grid.load)


def _periodic_inverse(half_space: HalfSpace) -> Convolution:
    """The inverse of the half space on the smallest periodic plane; its kernel falls like 1 / r^3."""
    ny, nx = half_space.shape
    spectrum = half_space.spectrum(half_space.plane(ny, nx))
    spectrum[0, 0] = spectrum[0, 1]  # the mean belongs to the load
    return Convolution(ny, 1.0 / np.maximum(spectrum, 1e-3 * spectrum.max()), half_space.library)


class _Contact:
    """A dry contact on one window: energy, bounds, load."""

    def __init__(self, half_space: HalfSpace, inverse: Convolution, gap: Array, cap: Array, load: float) -> None:
        self.half_space, self.inverse = half_space, inverse
        self.gap, self.cap, self.load = gap, cap, load
        self.give = 1.0 / float(self.half_space.near[0, 0])  # pressure that closes the gap of a node alone

    def solve(self, start: Array, tolerance: float, iterations: int) -> _Part:
        """Conjugate gradients on ever better faces."""
        p = np.clip(start, 0.0, self.cap)
        if not p.any():  # a contact smaller than the spacing begins at the node that touches first
            p.flat[np.argmin(np.where(self.cap > 0.0, self.gap, np.inf))] = 1.0
        p, g = self.allowed(p)
        faces = _Faces(self, p, g)
        state, r, t = np.empty(p.shape, np.int8), np.empty_like(p), np.zeros_like(p)
        _place(p, self.cap, state)
        fresh, product, best, best_n, cleared, n = True, 1.0, np.inf, 0, 0, 0
        while True:
            n += 1
            level = _level(g, state)
            overlap, excess = _residual(p, g, self.cap, state, level, r)
            z = self.press(r)
            old = product
            size, product = _restrict(z, r, state)
            wrong = (self.give * overlap + excess) / self.load
            error = size / self.load + wrong
            if error < best:
                best, best_n = error, n
            if error < tolerance or n >= iterations or n - best_n > 2 * _STALL:
                break
            stalled = n - best_n >= _STALL and cleared != best_n
            if not fresh and (size <= faces.early * wrong * self.load or stalled):
                cleared = best_n if stalled else cleared
                p, g = faces.change(p, g, state, level, wrong)
                _place(p, self.cap, state)
                fresh = True
                continue
            _turn(t, z, 0.0 if fresh else product / old)
            fresh = False
            _move(p, g, r, t, self.half_space.deform(t))
        if excess > 0.0:
            p, g = self.allowed(np.clip(p, 0.0, self.cap))
        return _Part(p, g - level, level, error, n)

    def press(self, r: Array) -> Array:
        """Approximate pressure behind a gap."""
        nx = r.shape[1]
        self.inverse.field[:, :nx] = r
        return self.inverse.run()[:, :nx].copy()

    def allowed(self, p: Array) -> tuple[Array, Array]:
        """A pressure within the bounds made to carry the load, and its gap."""
        if not _scale(p, self.cap, self.load):
            p = _project(p, self.cap, self.load)
        return p, self.gap + self.half_space.deform(p)

    def downhill(self, p: Array, g: Array, level: float) -> tuple[Array, Array]:
        """A step along the projected gradient that lowers the energy."""
        step = self.give
        for _ in range(2):
            q = _project(p - step * (g - level), self.cap, self.load)
            gq = self.gap + self.half_space.deform(q)
            down, curve = _descent(p, g, q, gq, level)
            if down >= curve:
                return q, gq
            part = max(down / curve, 0.0)
            step *= part
        return p + part * (q - p), g + part * (gq - g)


class _Faces:
    """When and how the face changes."""

    def __init__(self, contact: _Contact, p: Array, g: Array) -> None:
        self.contact = contact
        self.p, self.g = p.copy(), g.copy()  # where the face was entered
        self.early, self.least, self.misses, self.safe = _EARLY, np.inf, 0, False

    def change(self, p: Array, g: Array, state: States, level: float, wrong: float) -> tuple[Array, Array]:
        """The pressure on the next face, and its gap; `wrong` is what bounds and gaps of this face lack, in loads."""
        if wrong < 0.9 * self.least:
            self.least, self.misses = wrong, 0
        else:
            self.misses += 1
            self.early = max(0.25 * self.early, _EARLIEST)
        self.safe = self.safe or self.misses > _MISSES
        contact = self.contact
        if self.safe:
            p, g = self._lower(p, g, state, level)
        elif wrong > _HUGE:
            p, g = contact.downhill(self.p, self.g, level)
        else:
            p, g = contact.allowed(_bound(p, g, contact.cap, state, level, contact.give))
        self.p, self.g = p.copy(), g.copy()
        return p, g

    def _lower(self, p: Array, g: Array, state: States, level: float) -> tuple[Array, Array]:
        """Toward p as far as the energy falls, else along the projected gradient."""
        contact = self.contact
        for part in (1.0, 0.25, 0.0625):
            toward = self.p + part * (p - self.p)
            q, gq = contact.allowed(_bound(toward, g, contact.cap, state, level, part * contact.give))
            down, curve = _descent(self.p, self.g, q, gq, level)
            if down > 0.5 * curve:
                return q, gq
        return contact.downhill(self.p, self.g, level)


@njit(cache=True, nogil=True)
def _place(p, cap, state):  # type: ignore[no-untyped-def]
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            if cap[j, i] <= 0.0:
                state[j, i] = _SHUT
            elif p[j, i] <= 0.0:
                state[j, i] = _LOW
            else:
                state[j, i] = _HIGH if p[j, i] >= cap[j, i] else _FREE


@njit(cache=True, nogil=True)
def _level(g, state):  # type: ignore[no-untyped-def]
    """Gap at which the bodies touch: the mean over the face, or between what must be shut and what must be open."""
    total, count, shut, opened = 0.0, 0, -np.inf, np.inf
    for j in range(g.shape[0]):
        for i in range(g.shape[1]):
            if state[j, i] == _FREE:
                total += g[j, i]
                count += 1
            elif state[j, i] == _LOW:
                opened = min(opened, g[j, i])
            elif state[j, i] == _HIGH:
                shut = max(shut, g[j, i])
    if count > 0:
        return total / count
    if shut == -np.inf:
        return opened
    return 0.5 * (shut + opened) if opened < np.inf else shut


@njit(cache=True, nogil=True)
def _residual(p, g, cap, state, level, r):  # type: ignore[no-untyped-def]
    """Put the gap on the face into r. Returns the overlap off the face and the pressure beyond bounds on it."""
    overlap, excess = 0.0, 0.0
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            r[j, i] = 0.0
            if state[j, i] == _FREE:
                r[j, i] = g[j, i] - level
                excess += max(-p[j, i], 0.0) + max(p[j, i] - cap[j, i], 0.0)
            elif state[j, i] == _LOW:
                overlap += max(level - g[j, i], 0.0)
            elif state[j, i] == _HIGH:
                overlap += max(g[j, i] - level, 0.0)
    return overlap, excess


@njit(cache=True, nogil=True)
def _restrict(z, r, state):  # type: ignore[no-untyped-def]
    """Take its mean on the face from z, and zero it off the face. Returns sum |z| and sum z r."""
    total, count = 0.0, 0
    for j in range(z.shape[0]):
        for i in range(z.shape[1]):
            if state[j, i] == _FREE:
                total += z[j, i]
                count += 1
    mean, size, product = total / max(count, 1), 0.0, 0.0
    for j in range(z.shape[0]):
        for i in range(z.shape[1]):
            z[j, i] = z[j, i] - mean if state[j, i] == _FREE else 0.0
            size += abs(z[j, i])
            product += z[j, i] * r[j, i]
    return size, product


@njit(cache=True, nogil=True)
def _turn(t, z, ratio):  # type: ignore[no-untyped-def]
    for j in range(z.shape[0]):
        for i in range(z.shape[1]):
            t[j, i] = z[j, i] + ratio * t[j, i]


@njit(cache=True, nogil=True)
def _move(p, g, r, t, bent):  # type: ignore[no-untyped-def]
    """Step along -t to the least energy; `bent` is the deformation by t."""
    down, curve = 0.0, 0.0
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            down += r[j, i] * t[j, i]
            curve += bent[j, i] * t[j, i]
    step = down / curve if curve > 0.0 else 0.0
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            p[j, i] -= step * t[j, i]
            g[j, i] -= step * bent[j, i]


@njit(cache=True, nogil=True)
def _bound(p, g, cap, state, level, give):  # type: ignore[no-untyped-def]
    """Within bounds, and a first pressure for nodes that come to the face."""
    q = np.empty_like(p)
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            x, above = p[j, i], g[j, i] - level
            if (state[j, i] == _LOW and above < 0.0) or (state[j, i] == _HIGH and above > 0.0):
                x -= give * above
            q[j, i] = min(max(x, 0.0), cap[j, i])
    return q


@njit(cache=True, nogil=True)
def _scale(p, cap, load):  # type: ignore[no-untyped-def]
    """Scale what is below its cap to meet the load; False if that cannot be."""
    for _ in range(50):  # scaling may push further nodes to the cap
        free, held = 0.0, 0.0
        for j in range(p.shape[0]):
            for i in range(p.shape[1]):
                if p[j, i] < cap[j, i]:
                    free += p[j, i]
                else:
                    held += p[j, i]
        if abs(free + held - load) <= 1e-14 * load:
            return True
        if held >= load or free <= 0.0:
            return False
        factor = (load - held) / free
        for j in range(p.shape[0]):
            for i in range(p.shape[1]):
                if p[j, i] < cap[j, i]:
                    p[j, i] = min(p[j, i] * factor, cap[j, i])
    return False


@njit(cache=True, nogil=True)
def _clipped_sum(y, cap, shift):  # type: ignore[no-untyped-def]
    total = 0.0
    for j in range(y.shape[0]):
        for i in range(y.shape[1]):
            total += min(max(y[j, i] + shift, 0.0), cap[j, i])
    return total


@njit(cache=True, nogil=True)
def _project(y, cap, load):  # type: ignore[no-untyped-def]
    """Nearest pressure to y that is within bounds and carries the load: y shifted and clipped, by bisection."""
    low, high = np.inf, -np.inf
    for j in range(y.shape[0]):
        for i in range(y.shape[1]):
            low = min(low, -y[j, i])
            if cap[j, i] > 0.0:
                high = max(high, min(cap[j, i], load) - y[j, i])
    for _ in range(200):
        shift = 0.5 * (low + high)
        if not low < shift < high:
            break
        if _clipped_sum(y, cap, shift) < load:
            low = shift
        else:
            high = shift
    less, more = _clipped_sum(y, cap, low), _clipped_sum(y, cap, high)
    share = min(max((load - less) / (more - less), 0.0), 1.0) if more > less else 1.0
    q = np.empty_like(y)
    for j in range(y.shape[0]):
        for i in range(y.shape[1]):
            a, b = min(max(y[j, i] + low, 0.0), cap[j, i]), min(max(y[j, i] + high, 0.0), cap[j, i])
            q[j, i] = min(max(a + share * (b - a), 0.0), cap[j, i])
    return q


@njit(cache=True, nogil=True)
def _descent(p, g, q, gq, level):  # type: ignore[no-untyped-def]
    """First and second derivative of the energy from p to q: (-slope, curvature)."""
    down, curve = 0.0, 0.0
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            d = q[j, i] - p[j, i]
            down -= d * (g[j, i] - level)
            curve += d * (gq[j, i] - g[j, i])
    return down, curve
