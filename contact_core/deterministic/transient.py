"""Consecutive instants in time: bodies that move on and a film that remembers, begins or opens."""

import math
from collections.abc import Sequence
from dataclasses import replace

from ..errors import FilmTooWideError, OperatingPointError
from ..scene import Case, OperatingPoint, Scene
from ..state import ContactState
from ..surfaces.patches import moved_nodes, rolled, yielded
from .instant import ContactFields, Transient, solve, solve_instant

_ITERATIONS = 200  # of an instant, at most
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


def longest_instant(case: Case) -> float:
    """Return the longest time [s] of an instant of a march, infinite at rest."""
    fastest = max(case.rough_speed, case.fastest / _SMOOTH_STEP)
    return case.scene.film.spacing / fastest if fastest > 0.0 else math.inf


def follow(
    case: Case,
    state: ContactState,
    dt: float,
    steps: Sequence[float],
    *,
    order: int = 1,
    iterations: int = _ITERATIONS,
) -> tuple[ContactState, ContactFields]:
    """Solve the instant `dt` [s] after that of a state, in which the bodies have moved along +x by `steps` [m]."""
    before, state = state, rolled(case.scene, state, steps)
    if state.film is None or not case.loaded:
        return begin(case, state)
    moved = moved_nodes(case.scene, before, state)
    try:
        fields = solve_instant(case, state, Transient(dt, moved, iterations, order=order, thorough=True))
    except FilmTooWideError as error:
        if not case.entrained:  # nothing would bring the oil back
            raise
        return _open(case, state, str(error))
    return after(case, state, fields), fields


def begin(case: Case, state: ContactState) -> tuple[ContactState, ContactFields]:
    """Solve an instant without a film before it."""
    if not case.loaded:
        return _open(case, state, "")
    try:
        fields = solve_instant(case, state)
    except FilmTooWideError as error:
        return _open(case, state, str(error))
    return after(case, state, fields), fields


def after(case: Case, state: ContactState, fields: ContactFields) -> ContactState:
    """Return the state with the film of an instant, and its plastic overlap pressed into the bodies."""
    return yielded(case.scene, replace(state, film=fields.film), fields.overlap)


def _open(case: Case, state: ContactState, why: str) -> tuple[ContactState, ContactFields]:
    """Return bodies apart, and why if there is a load."""
    fields = solve_instant(case.unloaded(), state)
    return replace(state, film=None), replace(fields, converged=not why, shortfall=why)
