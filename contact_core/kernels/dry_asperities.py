"""Frictionless dry contact of rough bodies with asperities that are too short for the grid.

The pressure minimises the elastic energy p K p / 2 + gap p + sum phi(p) under 0 <= p <= cap and sum p = load, where
-phi'(p) = depth ln(stress / p), at least 0, is the gap that the asperities hold open under p (`mixed.asperities`).
A surface that gives way adds the integral of its depth. Both are convex, so Newton's method with a line search finds
the minimum. Conjugate gradients, which keep the load, solve for its steps; they are preconditioned by the stiffness of
each node alone.
"""

import numpy as np

from .arrays import Array, Mask
from .dry import solve_dry
from .half_space import HalfSpace
from .mixed.asperities import REACH
from .surface_give import SurfaceGive

_START_TOLERANCE = 1e-2  # of the contact without asperities
_SPREAD = 2.0  # depths by which the bodies of the start are further apart than those of that contact
_INNER = 0.03  # residual of a Newton step, relative
_NEAR = 1e-3  # change of pressure over the load, below which steps are taken in full: rounding hides the energy
_INNER_ITERATIONS = 200
_HALVINGS = 12
_LEAST = 1e-250  # of the stress, below which a pressure holds bodies no further apart
_FAINT = 1e-3  # of the largest pressure, below which a node of a light contact counts as open
_FALL = 0.9  # largest part of a pressure that one step takes away where the asperities do not bend


def solve_dry_asperities(
    half_space: HalfSpace,
    gap: Array,
    cap: Array,
    load: float,
    start: Array,
    asperities: tuple[float, float],
    tolerance: float,
    iterations: int,
    give: SurfaceGive | None = None,
) -> tuple[Array, float, bool, int]:
    """Return pressure [ny, nx], rigid gap, convergence and iterations.

    `asperities` are stress and depth, `give` is that of the surface on top of the half space; the other arguments are
    those of `dry.dry_solution`. The error counts the change of pressure that would close the gap of each node by
    itself.
    """
    stress, depth = asperities
    soft, change, error = half_space.near[0, 0], np.inf, np.inf
    hard, rigid, _, spent = solve_dry(half_space, gap, cap, load, start, _START_TOLERANCE, iterations)
    apart = rigid + gap + half_space.deform(hard)
    p = np.minimum(0.5 * hard + stress * np.exp(-np.clip(apart / depth + _SPREAD, 0.0, 600.0)), cap)
    p = _loaded(p, cap, load)
    deformed = gap + half_space.deform(p)
    while spent < iterations:
        free, bend = p < cap, np.where(p < stress, depth / np.maximum(p, 1e-300), 0.0)
        curve = bend if give is None else bend + give.slope_at(p)
        pull = deformed - _held_open(p, stress, depth)  # -rigid where the balance holds
        if give is not None:
            pull += give.at(p)
        rigid = -float((pull * p)[free].sum() / p[free].sum())
        free |= pull + rigid > 0.0  # what is at its cap and opens
        error = float((np.abs(pull + rigid) / (soft + curve))[free].sum()) / load
        if error < tolerance:
            break
        step, count = _newton_step(half_space, pull, curve, free)
        spent += count
        if count == 0:  # rounding
            break
        energy, part = _energy(p, deformed + gap, stress, depth, give), 1.0
        for _ in range(_HALVINGS):
            with np.errstate(over="ignore"):
                lower = np.where(bend > 0.0, p * np.exp(np.minimum(part * step / np.maximum(p, 1e-300), 0.0)), 0.0)
            lower = np.maximum(lower, np.where(bend > 0.0, 0.0, np.maximum(p + part * step, (1.0 - _FALL) * p)))
            trial = _loaded(np.minimum(np.where(step > 0.0, p + part * step, lower), cap), cap, load)
            moved = gap + half_space.deform(trial)
            change = float(np.abs(trial - p).sum()) / load
            if change < _NEAR or _energy(trial, moved + gap, stress, depth, give) <= energy:
                break
            part *= 0.5
        p, deformed = trial, moved
    open_below = min(stress * np.exp(-REACH), _FAINT * float(p.max()))  # a light contact is fainter than that all over
    return _loaded(np.where(p > open_below, p, 0.0), cap, load), rigid, error < tolerance, spent


def _held_open(p: Array, stress: float, depth: float) -> Array:
    return depth * np.log(np.maximum(stress / np.maximum(p, _LEAST * stress), 1.0))


def _energy(p: Array, twice: Array, stress: float, depth: float, give: SurfaceGive | None) -> float:
    """Return p K p / 2 + gap p + sum phi(p), that of `give` included; `twice` is K p + 2 gap."""
    below = np.minimum(p, stress)
    phi = depth * below * (np.log(np.maximum(below, 1e-300) / stress) - 1.0)
    energy = float((0.5 * twice * p).sum() + phi.sum())
    return energy if give is None else energy + give.energy(p)


def _loaded(p: Array, cap: Array, load: float) -> Array:
    """Return pressures scaled to a load within their caps."""
    for _ in range(50):
        below = p < cap
        part, capped = float(p[below].sum()), float(p[~below].sum())
        scale = (load - capped) / part if part > 0.0 else 1.0
        if abs(scale - 1.0) < 1e-13:
            break
        p = np.where(below, np.minimum(p * scale, cap), p) if scale > 0.0 else p * (load / float(p.sum()))
    return p


def _newton_step(half_space: HalfSpace, pull: Array, bend: Array, free: Mask) -> tuple[Array, int]:
    """Return the step d of sum 0 with (K + bend) d + pull + constant = 0 on the free nodes, and iterations."""
    own = free / (half_space.near[0, 0] + bend)
    total = float(own.sum())

    def preconditioned(r: Array) -> Array:
        z = own * r
        return z - own * (float(z.sum()) / total)

    step, r = np.zeros_like(pull), -pull
    z = preconditioned(r)
    d, product = z.copy(), float((r * z).sum())
    first = product
    n = 0
    while n < _INNER_ITERATIONS and product > _INNER**2 * first and product > 0.0:
        n += 1
        q = half_space.deform(d) + bend * d
        length = product / float((d * q).sum())
        step += length * d
        r -= length * q
        z = preconditioned(r)
        product, before = float((r * z).sum()), product
        d = z + (product / before) * d
    return step, n
