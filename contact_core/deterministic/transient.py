"""One instant after another: bodies that move on and a film that remembers, or begins, or opens."""

from collections.abc import Sequence
from dataclasses import replace

from ..errors import FilmTooWideError, OperatingPointError
from ..scene import OperatingPoint, Scene
from ..state import ContactState
from ..surfaces.patches import moved_nodes, rolled, yielded
from .instant import ContactFields, Transient, solve

_ITERATIONS = 200  # of an instant, at most


def parted(case: Case, state: ContactState, gap: float) -> ContactState:
    """The state with bodies whose smooth shapes are `gap` [m] apart, oil between them: where squeezing may begin.

    Raises OperatingPointError if they would touch.
    """
    touching = solve(case.scene, replace(case.op, load=0.0), state)
    least = touching.film.rigid_gap
    if not gap >= least:
        raise OperatingPointError(f"gap = {gap:g} m is too small: the rough bodies touch at {least:.3g} m. Use more.")
    film = replace(touching.film, mass=touching.gap + (gap - least), rigid_gap=gap)
    return replace(state, film=film, solved_for=None)


def follow(
    case: Case,
    state: ContactState,
    dt: float,
    steps: Sequence[float],
    *,
    order: int = 1,
    iterations: int = _ITERATIONS,
) -> tuple[ContactState, ContactFields]:
    """The instant `dt` [s] after that of a state, in which the bodies have moved along +x by `steps` [m]."""
    before, state = state, rolled(case.scene, state, steps)
    if state.film is None or not case.loaded:
        return begin(case, state)
    moved = moved_nodes(case.scene, before, state)
    try:
        fields = solve(case, state, Transient(dt, moved, iterations, order=order, thorough=True))
    except FilmTooWideError as error:
        if not case.entrained:  # nothing would bring the oil back
            raise
        return _open(case, state, str(error))
    return yielded(case.scene, replace(state, film=fields.film), fields.overlap), fields


def begin(case: Case, state: ContactState) -> tuple[ContactState, ContactFields]:
    """An instant without a film before it."""
    if not case.loaded:
        return _open(case, state, "")
    try:
        fields = solve(case, state)
    except FilmTooWideError as error:
        return _open(case, state, str(error))
    return yielded(case.scene, replace(state, film=fields.film), fields.overlap), fields


def _open(case: Case, state: ContactState, why: str) -> tuple[ContactState, ContactFields]:
    """Bodies apart, and why if there is a load."""
    fields = solve(case.scene, replace(case.op, load=0.0), state)
    return replace(state, film=None), replace(fields, converged=not why, shortfall=why)


def rough_speed(case: Case) -> float:
    """Speed [m/s] of the faster rough body, 0 of smooth ones."""
    pairs = ((case.scene.surface_1, case.op.speed_1), (case.scene.surface_2, case.op.speed_2))
    return max((abs(speed) for surface, speed in pairs if surface.rq > 0.0), default=0.0)
