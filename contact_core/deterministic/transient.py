"""Consecutive instants in time: bodies that move on and a film that remembers, begins or opens."""

import math
from collections.abc import Sequence
from dataclasses import replace

from ..errors import FilmTooWideError, OperatingPointError
from ..film import Deterministic
from ..kernels.arrays import Array
from ..scene import Case, OperatingPoint, Scene
from ..state import ContactState
from ..surfaces.patches import facing_films, on_patches, patch_nodes
from .instant import ContactFields, Transient, sliding_node_speed, solve, solve_instant

Found = tuple[ContactState, ContactFields]

_ITERATIONS = 200  # of an instant, at most
_ON_NODE = 1e-9  # of a node
_SMOOTH_STEP = 4.0  # nodes that smooth bodies move on by in an instant of a march, at most


def parted(scene: Scene, op: OperatingPoint, state: ContactState, gap: float) -> ContactState:
    """Return the state with smooth shapes `gap` [m] apart and oil between them: the start of a squeeze.

    Raises OperatingPointError if the rough bodies would touch.
    """
    touching = solve(scene, replace(op, load=0.0), state)
    least = touching.film.rigid_gap
    if not gap >= least:
        raise OperatingPointError(f"gap = {gap:g} m is too small: the rough bodies touch at {least:.3g} m. Use more.")
    film = replace(touching.film, mass=touching.gap + (gap - least), rigid_gap=gap)
    return replace(state, film=film, solved_for=None)


def node_speed(case: Case) -> float:
    """Return the speed [m/s] of what moves on by a node at most in an instant, 0 if nothing has to.

    That are rough bodies, and the oil on those that move: further than a node, fitted flow does not carry it over.
    Where bodies slide past each other it is more.
    """
    oil = abs(case.op.entrainment_speed)
    return max(case.rough_speed, oil, sliding_node_speed(case)) if case.rough_speed > 0.0 else 0.0


def longest_instant(case: Case) -> float:
    """Return the longest time [s] of an instant of a march, infinite at rest."""
    fastest = max(node_speed(case), case.fastest / _SMOOTH_STEP)
    return case.scene.film.spacing / fastest if fastest > 0.0 else math.inf


def follow(
    case: Case,
    state: ContactState,
    dt: float,
    steps: Sequence[float],
    *,
    order: int = 1,
    iterations: int = _ITERATIONS,
) -> Found:
    """Solve the instant `dt` [s] after that of a state, in which the bodies have moved along +x by `steps` [m]."""
    if state.film is None or not case.loaded:
        return begin(case, rolled(case.scene, state, steps))
    try:
        return next_instant(case, state, steps, Transient(dt, 0, iterations, order=order, thorough=True))
    except FilmTooWideError as error:
        if not case.entrained:  # nothing would bring the oil back
            raise
        return _open(case, rolled(case.scene, state, steps), str(error))


def next_instant(case: Case, state: ContactState, steps: Sequence[float], transient: Transient) -> Found:
    """Solve an instant after that of a state with a film; the bodies have moved along +x by `steps` [m].

    Where the oil is carried over, the nodes of the contact move on with it. The ways in `transient` are filled in here.
    """
    level, rougher = case.scene.film, case.scene.rougher
    spacing, columns = level.spacing, level.points - 1
    carried = transient.order == 1 and isinstance(level, Deterministic) and level.flux == "fitted"
    way = case.op.entrainment_speed * transient.dt if carried else 0.0
    oil = round((state.window + way) / spacing)  # nodes that it moves along; by the rest the nodes move with it
    oil = oil if oil * way > 0.0 else 0  # a node half way to the next stays where rounding alone would move it
    window = state.window + way - oil * spacing
    window = 0.0 if abs(window) < _ON_NODE * spacing else window  # rounding moves no node
    before = patch_nodes(case.scene, state.bodies[rougher], state.window)
    shifted, state = (window - state.window) / spacing, rolled(case.scene, replace(state, window=window), steps)
    moved = patch_nodes(case.scene, state.bodies[rougher], window) - before
    moved = (moved + columns // 2) % columns - columns // 2
    ways = replace(transient, moved=moved, shifted=shifted, rolled=oil)
    fields = solve_instant(case, state, ways)
    return _after(case.scene, state, fields), fields


def dry_instant(case: Case, state: ContactState, steps: Sequence[float]) -> Found:
    """Solve a dry instant; the bodies have moved along +x by `steps` [m]."""
    state = rolled(case.scene, state, steps)
    fields = solve_instant(case, state, dry=True)
    return replace(_after(case.scene, state, fields), film=None), fields


def begin(case: Case, state: ContactState) -> Found:
    """Solve an instant without a film before it."""
    if not case.loaded:
        return _open(case, state, "")
    try:
        fields = solve_instant(case, state)
    except FilmTooWideError as error:
        return _open(case, state, str(error))
    return _after(case.scene, state, fields), fields


def _open(case: Case, state: ContactState, why: str) -> Found:
    """Return bodies apart, and why if there is a load."""
    fields = solve_instant(case.unloaded(), state)
    return replace(state, film=None), replace(fields, converged=not why, shortfall=why)


def _after(scene: Scene, state: ContactState, fields: ContactFields) -> ContactState:
    """Return the state with the film of an instant, and the bodies yielded."""
    return yielded(scene, replace(state, film=fields.film), fields.overlap)


def yielded(scene: Scene, state: ContactState, overlap: Array) -> ContactState:
    """Return the state after the overlap has been pressed into both bodies permanently, as plasticity shares it."""
    if not overlap.any():
        return state
    films, before = facing_films(scene, state)
    shares = scene.plasticity.shares(*films, before, overlap)
    first, second = (
        replace(body, plastic=body.plastic + pressed)
        for body, pressed in zip(state.bodies, on_patches(scene, state, shares), strict=True)
    )
    return replace(state, bodies=(first, second))


def rolled(scene: Scene, state: ContactState, steps: Sequence[float]) -> ContactState:
    """Return the state after both bodies have moved along +x, each by its step [m]."""
    first, second = (
        replace(body, offset=(body.offset + step) % scene.film.domain)
        for body, step in zip(state.bodies, steps, strict=True)
    )
    return replace(state, bodies=(first, second))
