"""What a process loads before its first step, so that those forked from it need not."""

from contextlib import suppress
from dataclasses import replace

from ..advance import advance
from ..deterministic.instant import Transient, solve
from ..errors import ContactError
from ..film import Regression
from ..scene import Scene
from ..state import initial_state

_POINTS = 25  # nodes along an axis: enough for each stage of a contact, too few to cost time
_ITERATIONS = 40
_SPEED = 0.1  # m/s: of one body, where the scene lets nothing slide


def warm_up(scene: Scene) -> None:
    """Load the packages and compiled kernels that the first steps of a scene need. Starts no thread of its own.

    By solving the scene on a coarse grid: a dry instant and a mixed one after it; at the fast level one evaluation.
    What only a hard instant needs is loaded when one comes, in a few milliseconds. Nothing is remembered that changes
    an answer, and a contact that cannot be solved is left to its own first step.
    """
    coarse = _coarse(scene)
    point, state = coarse.operation.point, initial_state(coarse)
    if point.entrainment_speed == 0.0 or not point.slides:
        point = replace(point, speed_1=_SPEED, speed_2=0.0)
    with suppress(ContactError):
        if isinstance(coarse.film, Regression):
            advance(coarse, point, state, 0.0)
            return
        state = replace(state, film=solve(coarse, point, state, dry=True).film)
        dt = coarse.film.spacing / abs(point.entrainment_speed)
        solve(coarse, point, state, Transient(dt, 1, _ITERATIONS))


def _coarse(scene: Scene) -> Scene:
    """The scene on few nodes, its roughness no finer than them."""
    film = replace(scene.film, points=min(_POINTS, scene.film.points))
    first, second = (
        replace(surface, correlation_length=max(surface.correlation_length, film.spacing))
        for surface in (scene.surface_1, scene.surface_2)
    )
    return replace(scene, film=film, surface_1=first, surface_2=second)
