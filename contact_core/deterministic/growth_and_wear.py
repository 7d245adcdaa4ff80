"""What runs on between two solutions: tribofilm and wear of one body in closed form, and how long that may go on."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..laws.tribofilm import thickness
from ..scene import OperatingPoint, Scene
from ..shapes import Line
from ..state import Body
from ..surfaces.patches import bare_heights, contact_grid, heights_of, roughness_of
from ..surfaces.roughness import rms_roughness

Array = NDArray[np.float64]


def speeds_of(op: OperatingPoint) -> tuple[float, float]:
    """Surface speeds [m/s] of body 1 and 2."""
    return op.speed_1, op.speed_2


def track_length(scene: Scene, i: int) -> float:
    """Travel [m] of a point of body 1 (i = 0) or 2 (i = 1) between two passes."""
    return (scene.geometry.track_length_1, scene.geometry.track_length_2)[i]


def evolved(case: Case, body: Body, i: int, step: float, flash: float) -> Body:
    """A body after `step` [s] of what its last solution makes it feel; `flash` [K] above its bulk temperature."""
    law = case.scene.tribofilm
    abraded = body.abrasion * step if law.abrades else body.abrasion
    growth, removal = law.evolve(body.growth, body.removal, body.exposure * step, abraded, case.op.bodies[i] + flash)
    film = 0.5 * (thickness(growth, removal) + thickness(body.growth, body.removal))
    worn = step * wear_speed(case, body, i, film)
    return replace(
        body,
        growth=growth,
        removal=removal,
        wear=body.wear + worn,
        worn=body.worn + float(worn.sum()) * area_of_node(case, i),
        cycles=body.cycles + abs(case.speeds[i]) * step / track_length(case.scene, i),
    )


def wear_speed(case: Case, body: Body, i: int, film: Array) -> Array:
    """Wear depth per second [m/s] of a patch under a tribofilm [m]."""
    cover = film / case.scene.tribofilm.full_thickness
    speeds: tuple[float | Array, float] = case.speeds
    if case.scene.wear.of_sliding:
        speeds = sliding_on_track(case, film.shape[0]), 0.0
    return case.scene.wear.rate(body.pressure, cover, speeds, i, case.scene.plasticity.hardness)


def sliding_on_track(case: Case, rows: int) -> float | Array:
    """Sliding speed [m/s]; with spin that of each row [rows, 1], as a mean over its part of the contact."""
    if case.op.spin == 0.0 or not case.loaded:
        return case.op.sliding_speed
    hertz, y = case.hertz, contact_grid(case.scene, rows).y[:, None]
    # mean |x| over a row under Hertz's pressure is 4 / (3 pi) of its length on either side
    along = 4.0 / (3.0 * math.pi) * hertz.a * hertz.chords(y)
    return np.hypot(case.op.sliding_speed - case.op.spin * y, case.op.spin * along)


def area_of_node(case: Case, i: int) -> float:
    """Area [m2] for which one node of the patch stands: the patch repeats along the track of a moving body."""
    moving = case.speeds[i] != 0.0
    return case.scene.film.spacing**2 * case.scene.repeats * (track_length(case.scene, i) / case.scene.film.domain if moving else 1.0)


def across_track(scene: Scene, rows: int) -> Array | None:
    """|y| / b of each of the patches' rows, [rows, 1], b being that of the reference load and the scene's radii; None
    for a line or a roller, along whose face nothing changes.
    """
    if isinstance(scene.shape(), Line):
        return None
    across: Array = np.abs(contact_grid(scene, rows).y)[:, None] / scene.hertz(scene.operation.load).b
    return across


def track_rows(scene: Scene, rows: int, share: float = 1.0) -> NDArray[np.bool_]:
    """Which of the patches' rows have |y| < share * b, at least the middle one. b is that of the reference load and
    the scene's radii, whatever they are now: a mean over the track does not jump with them.
    """
    b = scene.hertz(scene.operation.load).b
    y = contact_grid(scene, rows).y
    inside: NDArray[np.bool_] = np.abs(y) < max(share * b, 0.51 * scene.film.spacing)
    return inside


def wear_rate(case: Case, body: Body, i: int) -> float:
    """Mean speed [m/s] at which the track wears now."""
    speed = wear_speed(case, body, i, thickness(body.growth, body.removal))
    return float(speed[track_rows(case.scene, body.wear.shape[0])].mean())


def roughness_now(scene: Scene, body: Body, i: int) -> float:
    """Rms roughness [m] of a body over |y| < 2b/3, free of the groove's shape."""
    rows = body.wear.shape[0]
    bare = bare_heights(scene, rows)[i]
    return rms_roughness(roughness_of(bare, heights_of(bare, body)), track_rows(scene, rows, 2.0 / 3.0))


def stable_time(case: Case, body: Body, i: int) -> float:
    """Longest time [s] between two solutions for which wear smooths the shortest waves instead of making new ones.

    A wave of wear of amplitude w and wave number q changes the pressure by E* q w / 2 while it is in contact, so it
    decays at the rate K |v| d E* q / (2 H), d being the share of time a point is in contact. Euler's steps are stable
    below twice the time of that decay.
    """
    if case.scene.wear.name == "none":
        return math.inf
    track = track_rows(case.scene, body.wear.shape[0])
    cover = thickness(body.growth, body.removal)[track].mean(keepdims=True) / case.scene.tribofilm.full_thickness
    width = 2.0 * case.hertz.a
    duty = min(width / track_length(case.scene, i), 1.0) if case.speeds[i] != 0.0 else 1.0
    shortest = math.sqrt(2.0) * math.pi / case.scene.film.spacing
    stiffness = 0.25 * case.scene.solids.reduced_modulus * shortest
    slide = case.scene.wear.slide(case.speeds, i)
    decay = float(case.scene.wear.coefficient(cover).max()) * slide * duty * stiffness / case.scene.plasticity.hardness
    # a point that a block sees in only part of its passes gets the more in those
    return 2.0 / decay / max(1.0, case.scene.film.domain / width) if decay > 0.0 else math.inf
