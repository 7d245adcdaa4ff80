"""Conjugate gradients on the faces of a dry contact, and how the face changes: one window of one grid, see `dry`.

Faces and projected gradients: Moré & Toraldo, SIAM J. Optim. 1 (1991) 93, doi:10.1137/0801008.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .arrays import Array
from .compiled import jit
from .half_space import Convolution, HalfSpace

States = NDArray[np.int8]

# a pressure is 0, between its bounds, or at its cap; or the node is shut, as its cap is 0
_LOW, _FREE, _HIGH, _SHUT = range(4)
_EARLY = 3.0  # the face changes once the error on it is below this many times its violation of bounds and gaps
_EARLIEST = 0.01  # least value of that factor, which falls when changes do not help
_MISSES = 3  # useless changes in a row, after which each has to lower the energy
_HUGE = 10.0  # loads: pressures so far out of bounds give a direction only
_STALL = 20  # iterations without progress after which rounding is cleared away


class Part(NamedTuple):
    """Solution on one window."""

    pressure: Array
    gap: Array
    datum: float
    error: float
    iterations: int


class Contact:
    """A dry contact on one window: energy, bounds, load."""

    def __init__(
        self,
        half_space: HalfSpace,
        inverse: Convolution,
        gap: Array,
        cap: Array,
        load: float,
        soft: Array | None = None,
    ) -> None:
        self.half_space, self.inverse = half_space, inverse
        self.gap, self.cap, self.load, self.soft = gap, cap, load, soft
        # pressure that closes the gap of a node alone
        self.give = 1.0 / (float(self.half_space.near[0, 0]) + (0.0 if soft is None else float(soft.mean())))

    def bent(self, p: Array) -> Array:
        """Return by how much nodes give way under a pressure."""
        bent = self.half_space.deform(p)
        return bent if self.soft is None else bent + self.soft * p

    def solve(self, start: Array, tolerance: float, iterations: int) -> Part:
        """Run conjugate gradients on one face after another."""
        p = np.clip(start, 0.0, self.cap)
        if not p.any():  # a contact smaller than the spacing starts at the node that touches first
            p.flat[np.argmin(np.where(self.cap > 0.0, self.gap, np.inf))] = 1.0
        p, g = self.allowed(p)
        faces = _Faces(self, p, g)
        state, r, t = np.empty(p.shape, np.int8), np.empty_like(p), np.zeros_like(p)
        _place(p, self.cap, state)
        fresh, product, best, best_n, cleared, n = True, 1.0, np.inf, 0, 0, 0
        while True:
            n += 1
            datum = _datum(g, state)
            overlap, excess = _residual(p, g, self.cap, state, datum, r)
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
                p, g = faces.change(p, g, state, datum, wrong)
                _place(p, self.cap, state)
                fresh = True
                continue
            _turn(t, z, 0.0 if fresh else product / old)
            fresh = False
            _move(p, g, r, t, self.bent(t))
        if excess > 0.0:
            p, g = self.allowed(np.clip(p, 0.0, self.cap))
        return Part(p, g - datum, datum, error, n)

    def press(self, r: Array) -> Array:
        """Return the approximate pressure that causes a gap."""
        nx = r.shape[1]
        self.inverse.field[:, :nx] = r
        return self.inverse.run()[:, :nx].copy()

    def allowed(self, p: Array) -> tuple[Array, Array]:
        """Bring a pressure within its bounds and to the load; return it and its gap."""
        if not _scale(p, self.cap, self.load):
            p = _project(p, self.cap, self.load)
        return p, self.gap + self.bent(p)

    def downhill(self, p: Array, g: Array, datum: float) -> tuple[Array, Array]:
        """Return pressure and gap after a step along the projected gradient that lowers the energy."""
        step = self.give
        for _ in range(2):
            q = _project(p - step * (g - datum), self.cap, self.load)
            gq = self.gap + self.bent(q)
            down, curve = _descent(p, g, q, gq, datum)
            if down >= curve:
                return q, gq
            part = max(down / curve, 0.0)
            step *= part
        return p + part * (q - p), g + part * (gq - g)


class _Faces:
    """Changes of the face."""

    def __init__(self, contact: Contact, p: Array, g: Array) -> None:
        self.contact = contact
        self.p, self.g = p.copy(), g.copy()  # at the start of the face
        self.early, self.least, self.misses, self.safe = _EARLY, np.inf, 0, False

    def change(self, p: Array, g: Array, state: States, datum: float, wrong: float) -> tuple[Array, Array]:
        """Return the pressure on the next face, and its gap.

        `wrong`: violation of bounds and of the signs of gaps on this face, in loads.
        """
        if wrong < 0.9 * self.least:
            self.least, self.misses = wrong, 0
        else:
            self.misses += 1
            self.early = max(0.25 * self.early, _EARLIEST)
        self.safe = self.safe or self.misses > _MISSES
        contact = self.contact
        if self.safe:
            p, g = self._lower(p, g, state, datum)
        elif wrong > _HUGE:
            p, g = contact.downhill(self.p, self.g, datum)
        else:
            p, g = contact.allowed(_bound(p, g, contact.cap, state, datum, contact.give))
        self.p, self.g = p.copy(), g.copy()
        return p, g

    def _lower(self, p: Array, g: Array, state: States, datum: float) -> tuple[Array, Array]:
        """Step toward p as far as the energy falls, else along the projected gradient."""
        contact = self.contact
        for part in (1.0, 0.25, 0.0625):
            toward = self.p + part * (p - self.p)
            q, gq = contact.allowed(_bound(toward, g, contact.cap, state, datum, part * contact.give))
            down, curve = _descent(self.p, self.g, q, gq, datum)
            if down > 0.5 * curve:
                return q, gq
        return contact.downhill(self.p, self.g, datum)


@jit
def _place(p, cap, state):  # type: ignore[no-untyped-def]
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            if cap[j, i] <= 0.0:
                state[j, i] = _SHUT
            elif p[j, i] <= 0.0:
                state[j, i] = _LOW
            else:
                state[j, i] = _HIGH if p[j, i] >= cap[j, i] else _FREE


@jit
def _datum(g, state):  # type: ignore[no-untyped-def]
    """Return the gap at which the bodies touch.

    It is the mean over the face, or lies between the gaps of nodes that must be shut and of those that must be open.
    """
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


@jit
def _residual(p, g, cap, state, datum, r):  # type: ignore[no-untyped-def]
    """Put the gap on the face into r; return the overlap off the face and the excess of bounds on it."""
    overlap, excess = 0.0, 0.0
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            r[j, i] = 0.0
            if state[j, i] == _FREE:
                r[j, i] = g[j, i] - datum
                excess += max(-p[j, i], 0.0) + max(p[j, i] - cap[j, i], 0.0)
            elif state[j, i] == _LOW:
                overlap += max(datum - g[j, i], 0.0)
            elif state[j, i] == _HIGH:
                overlap += max(g[j, i] - datum, 0.0)
    return overlap, excess


@jit
def _restrict(z, r, state):  # type: ignore[no-untyped-def]
    """Subtract from z its mean on the face, zero it off the face; return sum |z| and sum z r."""
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


@jit
def _turn(t, z, ratio):  # type: ignore[no-untyped-def]
    for j in range(z.shape[0]):
        for i in range(z.shape[1]):
            t[j, i] = z[j, i] + ratio * t[j, i]


@jit
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


@jit
def _bound(p, g, cap, state, datum, give):  # type: ignore[no-untyped-def]
    """Return p within its bounds, with a first pressure on nodes that join the face."""
    q = np.empty_like(p)
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            x, above = p[j, i], g[j, i] - datum
            if (state[j, i] == _LOW and above < 0.0) or (state[j, i] == _HIGH and above > 0.0):
                x -= give * above
            q[j, i] = min(max(x, 0.0), cap[j, i])
    return q


@jit
def _scale(p, cap, load):  # type: ignore[no-untyped-def]
    """Scale the pressures below their caps to the load; return False if that is impossible."""
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


@jit
def _clipped_sum(y, cap, shift):  # type: ignore[no-untyped-def]
    total = 0.0
    for j in range(y.shape[0]):
        for i in range(y.shape[1]):
            total += min(max(y[j, i] + shift, 0.0), cap[j, i])
    return total


@jit
def _project(y, cap, load):  # type: ignore[no-untyped-def]
    """Return the pressure nearest to y within the bounds and of sum `load`: y shifted and clipped, by bisection."""
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


@jit
def _descent(p, g, q, gq, datum):  # type: ignore[no-untyped-def]
    """Return first and second derivative of the energy from p to q: (-slope, curvature)."""
    down, curve = 0.0, 0.0
    for j in range(p.shape[0]):
        for i in range(p.shape[1]):
            d = q[j, i] - p[j, i]
            down -= d * (g[j, i] - datum)
            curve += d * (gq[j, i] - g[j, i])
    return down, curve
