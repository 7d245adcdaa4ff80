"""Tribofilm and wear of one body: exposure by the instants of a block, then growth and wear in closed form."""

import math
from dataclasses import replace

import numpy as np

from ..kernels.arrays import Array
from ..laws.tribofilm import DOSES, Passes, thickness
from ..scene import Case, Scene, Side
from ..state import Body, ContactState
from ..surfaces.patches import across_track, middle_rows, surface_now, track_rows
from ..surfaces.roughness import groove_free, rms_roughness
from .accumulator import Accumulator


def with_exposure(case: Case, side: Side, state: ContactState, sums: Accumulator, alike: float) -> Body:
    """Return a body with the mean pressure over its track, the abrasion by it, and the exposure per test time.

    `alike` is the variance of the noise per block over that of independent blocks.
    """
    scene, i, body = case.scene, side.body, state.bodies[side.body]
    law, film = scene.tribofilm, scene.film
    # a moving point spends patch / track of its time in reach of the contact, a resting one all of it
    reach = film.domain / side.track_length if side.moves else 1.0
    passes = Passes(
        since=sums.since[i],
        peak=sums.peaks[i],
        moves=side.moves,
        reach=reach,
        domain=film.domain,
        contact_length=2.0 * case.hertz.a if case.loaded else None,
    )
    exposure = DOSES[law.dose].on_patch(sums.exposures[i] / sums.count, passes)
    if not case.op.slides or not case.loaded:  # nothing rubs in pure rolling, at rest or apart
        exposure = np.zeros_like(exposure)
    pressure = sums.pressures[i] / sums.count * reach
    abrasion = law.abrasion(pressure, sliding_on_track(case, state.rows), across_track(scene, state.rows))
    after = replace(body, pressure=pressure, exposure=exposure, abrasion=abrasion)
    after = replace(after, since=sums.since[i], peak=sums.peaks[i])
    return replace(after, noise=body.noise + _noise(case, side, state, after, alike)) if side.moves else after


def _noise(case: Case, side: Side, state: ContactState, after: Body, alike: float) -> float:
    """Return the variance of the heights [m2] that the last block has made by sampling wear and tribofilm.

    Two blocks that sample the same differ by their noise.
    """
    body = state.bodies[side.body]
    middle = middle_rows(case.scene, state.rows)

    def made(block: Body) -> Array:
        worn = state.held * wear_speed(case, side, block, body.tribofilm)
        return thickness(*_grown(case, side, block, state.held, 0.0)) - worn

    return alike * 0.5 * float(np.var(groove_free(made(after)[middle] - made(body)[middle])))


def _grown(case: Case, side: Side, body: Body, step: float, flash: float) -> tuple[Array, Array]:
    """Return growth and removal of a body's tribofilm [m] after `step` [s] of its last exposure."""
    return case.scene.tribofilm.evolve(body.growth, body.removal, *_dose(case, side, body, step, flash))


def _dose(case: Case, side: Side, body: Body, step: float, flash: float) -> tuple[Array, Array, float]:
    """Return exposure and abrasion in `step` [s], and the temperature of the surface [K]."""
    exposed = np.minimum(body.exposure, case.scene.tribofilm.most_exposure) * step
    return exposed, film_removal(case, side, body) * step, side.temperature + flash


def evolved(case: Case, side: Side, body: Body, step: float, flash: float) -> Body:
    """Return a body after `step` [s] of its last exposure; `flash` [K] above its bulk temperature."""
    law = case.scene.tribofilm
    growth, removal = _grown(case, side, body, step, flash)
    film = 0.5 * (thickness(growth, removal) + body.tribofilm)
    oxide, halfway, lost = oxidised(case, side, body, film, step)
    worn = step * solid_speed(case, side, body, film, halfway) + lost
    return replace(
        body,
        growth=growth,
        removal=removal,
        formed=body.formed + law.formed(body.growth, body.removal, growth, *_dose(case, side, body, step, flash)),
        oxide=oxide,
        wear=body.wear + worn,
        worn=body.worn + float(worn.sum()) * area_of_node(case, side),
        cycles=body.cycles + abs(side.speed) * step / side.track_length,
    )


def film_removal(case: Case, side: Side, body: Body) -> Array:
    """Return the rate [1/s] at which rubbing takes tribofilm, by its own law and by that of wear."""
    scene = case.scene
    if not scene.wear.wears_film:
        return body.abrasion
    speeds, hardness = wearing_speeds(case, body.wear.shape[0]), scene.plasticity.under(1.0)
    by_wear = scene.wear.film_removal(body.pressure, speeds, side.body, hardness, scene.tribofilm.full_thickness)
    rate: Array = body.abrasion + by_wear
    return rate


def oxidised(case: Case, side: Side, body: Body, film: Array, step: float) -> tuple[Array, Array, Array]:
    """Return the oxide [m] after `step` [s] and after half of it, and the steel lost with what was rubbed off [m].

    `film` [m] is the tribofilm meanwhile. A fresh oxide grows within a second: half the step says more than the mean of
    both ends.
    """
    law = case.scene.oxide
    if not law.grows:
        return body.oxide, body.oxide, np.zeros_like(film)
    growing, rubbing = oxidation(case, side, body, film)
    oxide, rubbed = law.evolve(body.oxide, growing * step, rubbing * step)
    halfway, _ = law.evolve(body.oxide, growing * (0.5 * step), rubbing * (0.5 * step))
    return oxide, halfway, steel_in(case.scene, rubbed)


def oxidation(case: Case, side: Side, body: Body, film: Array) -> tuple[Array, Array]:
    """Return the rates [m/s] at which a bare solid oxidises under a tribofilm [m], and at which oxide is rubbed off."""
    law = case.scene.oxide
    left_open = law.left_open(film)
    sliding = sliding_on_track(case, film.shape[0])
    return law.growth(side.temperature) * left_open, law.removal(body.pressure, sliding) * left_open


def steel_in(scene: Scene, oxide: Array) -> Array:
    """Return the depth of steel [m] in an oxide [m]; nothing is lost where nothing wears."""
    lost: Array = oxide * (scene.wear.wears / scene.oxide.volume_ratio)
    return lost


def wear_speed(case: Case, side: Side, body: Body, film: Array) -> Array:
    """Return the wear depth per second [m/s] of a patch under a tribofilm [m], that of its oxide included."""
    speed = solid_speed(case, side, body, film, body.oxide)
    if not case.scene.oxide.grows:
        return speed
    growing, rubbing = oxidation(case, side, body, film)
    return speed + steel_in(case.scene, np.where(body.oxide > 0.0, rubbing, np.minimum(growing, rubbing)))


def solid_speed(case: Case, side: Side, body: Body, film: Array, oxide: Array) -> Array:
    """Return the depth per second [m/s] that the solid itself wears under a tribofilm [m] and beside an oxide [m]."""
    scene, full = case.scene, case.scene.tribofilm.full_thickness
    speeds = wearing_speeds(case, film.shape[0])
    speed = scene.wear.rate(body.pressure, film / full, speeds, side.body, scene.plasticity.hardness, full)
    return speed * (1.0 - scene.oxide.cover(oxide)) if scene.oxide.grows else speed


def wearing_speeds(case: Case, rows: int) -> tuple[float | Array, float]:
    """Return the speeds [m/s] of both surfaces as a law of wear takes them."""
    return (sliding_on_track(case, rows), 0.0) if case.scene.wear.of_sliding else case.speeds


def sliding_on_track(case: Case, rows: int) -> float | Array:
    """Return the sliding speed [m/s]; with spin that of each row [rows, 1], mean over its part of the contact."""
    op = case.op
    if op.spin == 0.0 or not case.loaded:
        return op.sliding_speed
    hertz, y = case.hertz, case.grid(rows).y[:, None]
    # mean |x| over a row under Hertz's pressure is 4 / (3 pi) of its length on either side
    along = 4.0 / (3.0 * math.pi) * hertz.a * hertz.chords(y)
    return np.hypot(op.sliding_speed - op.spin * y, op.spin * along)


def area_of_node(case: Case, side: Side) -> float:
    """Return the area [m2] that one node of the patch represents: the patch repeats along a moving body's track."""
    film = case.scene.film
    return film.spacing**2 * case.scene.repeats * (side.track_length / film.domain if side.moves else 1.0)


def followed(case: Case, side: Side, body: Body) -> dict[str, float]:
    """Return what the trends follow of a body: roughness, mean tribofilm and the mean speed [m/s] of its wear."""
    now = surface_now(case.scene, body, side.body)
    k = side.body + 1
    return {
        f"wear_depth_{k}_rate": float(wear_speed(case, side, body, body.tribofilm)[now.track].mean()),
        f"roughness_{k}": rms_roughness(now.roughness, now.middle),
        f"tribofilm_{k}": float(body.tribofilm[now.track].mean()),
    }


def wear_volume_rate(case: Case, side: Side, body: Body) -> float:
    """Return the volume [m3/s] that a body loses now."""
    speed = wear_speed(case, side, body, body.tribofilm)
    return float(speed.sum()) * area_of_node(case, side)


def stable_time(case: Case, side: Side, body: Body) -> float:
    """Return the longest time [s] between two solutions for which wear smooths the shortest waves.

    A wave of wear of amplitude w and wave number q changes the pressure by E* q w / 2 while it is in contact, so it
    decays at the rate K |v| d E* q / (2 H), d being the share of time a point is in contact. Euler's steps are stable
    below twice the time of that decay; beyond, they make new waves.
    """
    scene = case.scene
    if not scene.wear.wears or not side.moves:  # of bodies at rest see `resting`
        return math.inf
    track = track_rows(scene, body.wear.shape[0])
    full, film = scene.tribofilm.full_thickness, body.tribofilm[track]
    if not scene.wear.wears_film:  # linear in the film
        film = film.mean(keepdims=True)
    width = 2.0 * case.hertz.a
    duty = min(width / side.track_length, 1.0)
    shortest = math.sqrt(2.0) * math.pi / scene.film.spacing
    stiffness = 0.25 * scene.solids.reduced_modulus * shortest
    slide = scene.wear.slide(case.speeds, side.body)
    coefficient = float(scene.wear.coefficient(film / full, full).mean())
    decay = coefficient * slide * duty * stiffness / scene.plasticity.hardness
    # a point that a block samples in only part of its passes gets more in those
    return 2.0 / decay / max(1.0, scene.film.domain / width) if decay > 0.0 else math.inf
