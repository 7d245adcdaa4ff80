"""One instant after another: bodies that move on and a film that remembers, or begins, or opens."""

from collections.abc import Sequence
from dataclasses import replace

from ..errors import FilmTooWideError, OperatingPointError
from ..scene import OperatingPoint, Scene
from ..state import ContactState
from ..surfaces.patches import moved_nodes, rolled, yielded
from .instant import ContactFields, Transient, solve

_ITERATIONS = 200  # of an instant, at most


def parted(scene: Scene, op: OperatingPoint, state: ContactState, gap: float) -> ContactState:
    """The state with bodies whose smooth shapes are `gap` [m] apart, oil between them: where squeezing may begin.

    Raises OperatingPointError if they would touch.
    """
    touching = solve(scene, replace(op, load=0.0), state)
    least = touching.film.rigid_gap
    if not gap >= least:
        raise OperatingPointError(f"gap = {gap:g} m is too small: the rough bodies touch at {least:.3g} m. Use more.")
    film = replace(touching.film, mass=touching.gap + (gap - least), rigid_gap=gap)
    return replace(state, film=film, solved_for=None)


def follow(
    scene: Scene,
    op: OperatingPoint,
    state: ContactState,
    dt: float,
    steps: Sequence[float],
    *,
    order: int = 1,
    iterations: int = _ITERATIONS,
) -> tuple[ContactState, ContactFields]:
    """The instant `dt` [s] after that of a state, in which the bodies have moved along +x by `steps` [m]."""
    before, state = state, rolled(scene, state, steps)
    if state.film is None or op.load == 0.0:
        return begin(scene, op, state)
    moved = moved_nodes(scene, before, state)
    try:
        fields = solve(scene, op, state, Transient(dt, moved, iterations, order=order, thorough=True))
    except FilmTooWideError as error:
        if op.entrainment_speed == 0.0:  # nothing would bring the oil back
            raise
        return _open(scene, op, state, str(error))
    return yielded(scene, replace(state, film=fields.film), fields.overlap), fields


def begin(scene: Scene, op: OperatingPoint, state: ContactState) -> tuple[ContactState, ContactFields]:
    """An instant without a film before it."""
    if op.load == 0.0:
        return _open(scene, op, state, "")
    try:
        fields = solve(scene, op, state)
    except FilmTooWideError as error:
        return _open(scene, op, state, str(error))
    return yielded(scene, replace(state, film=fields.film), fields.overlap), fields


def _open(scene: Scene, op: OperatingPoint, state: ContactState, why: str) -> tuple[ContactState, ContactFields]:
    """Bodies apart, and why if there is a load."""
    fields = solve(scene, replace(op, load=0.0), state)
    return replace(state, film=None), replace(fields, converged=not why, shortfall=why)


def rough_speed(scene: Scene, op: OperatingPoint) -> float:
    """Speed [m/s] of the faster rough body, 0 of smooth ones."""
    pairs = ((scene.surface_1, op.speed_1), (scene.surface_2, op.speed_2))
    return max((abs(speed) for surface, speed in pairs if surface.rq > 0.0), default=0.0)
