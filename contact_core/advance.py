"""The door to both levels: an operating point is checked and bound once, and the level takes the step.

A level is a package with `advance`, `warm_up` and `errors_of`; a scene's `film.model` names it.
"""

from contextlib import suppress
from dataclasses import replace
from typing import Protocol

from . import corrections, deterministic
from .errors import ContactError, OperatingPointError
from .film import Deterministic, Regression
from .scene import Case, OperatingPoint, Scene
from .state import ContactState, Error, Outputs, initial_state

_LONGEST_STEP = 1e9  # s: a longer one is a mistake, and would never end
_POINTS = 33  # nodes along an axis: enough for each stage of a contact, too few to cost time
_SPEED = 0.1  # m/s: speed of one body, for scenes in which nothing slides


class Level(Protocol):
    """A level."""

    def advance(self, case: Case, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
        """Return the state and outputs after `dt` [s]."""

    def warm_up(self, case: Case, state: ContactState) -> None:
        """Load what the first steps need, by solving once."""

    def errors_of(self, scene: Scene, state: ContactState) -> dict[str, Error]:
        """Return the errors of the outputs of a state."""


LEVELS: dict[str, Level] = {Deterministic.name: deterministic, Regression.name: corrections}


def advance(scene: Scene, op: OperatingPoint, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
    """Return the state and outputs after `dt` [s] under a held operating point; `state` stays as it is.

    dt = 0 evaluates the contact without moving time. Outputs hold at the end of the step; a wear rate is the step's
    volume divided by it.

    Raises
    ------
    OperatingPointError
        For inputs that cannot be used.
    ConvergenceError
        If the contact has no solution.

    """
    case = Case.bind(scene, op)
    case.check_tribofilm()
    if not 0.0 <= dt <= _LONGEST_STEP:
        raise OperatingPointError(f"The step dt = {dt!r} s must be at least 0 and at most {_LONGEST_STEP:g} s.")
    return LEVELS[scene.film.name].advance(case, state, dt)


def uncertainty(scene: Scene, state: ContactState) -> dict[str, Error]:
    """Return the errors of the outputs of a state by name: half widths (95 %), each in the unit of its output.

    Each is apart by its causes (time steps, sampling, grid, iteration, fitted curves, cut inlet) and, by
    `Error.together`, one number. `scene` is that of the last step, at its level.
    """
    return LEVELS[scene.film.name].errors_of(scene, state)


def warm_up(scene: Scene) -> None:
    """Load the packages and compiled kernels that the first steps of a scene need. Starts no thread of its own.

    The scene is solved once on a coarse grid. What only a hard instant needs is loaded when one comes, in a few
    milliseconds. Nothing is kept that changes an answer, and a contact that cannot be solved is left to its own first
    step.
    """
    film = replace(scene.film, points=min(_POINTS, scene.film.points))
    first, second = (surface.coarsened(film.spacing) for surface in (scene.surface_1, scene.surface_2))
    coarse = replace(scene, film=film, surface_1=first, surface_2=second)
    point = coarse.operation.point
    if point.entrainment_speed == 0.0 or not point.slides:
        point = replace(point, speed_1=_SPEED, speed_2=0.0)
    with suppress(ContactError):
        LEVELS[scene.film.name].warm_up(Case.bind(coarse, point), initial_state(coarse))
