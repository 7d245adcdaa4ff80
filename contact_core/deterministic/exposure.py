"""What a block of instants does to the surface points: pressure, exposure and abrasion per test time."""

from dataclasses import replace

import numpy as np

from ..laws.tribofilm import DOSES, Passes
from ..scene import Case, Side
from ..state import Body, ContactState
from ..surfaces.roughness import groove_free
from ..surfaces.track import MIDDLE, across_track, track_rows
from .accumulator import Accumulator
from .growth_and_wear import sliding_on_track, wear_speed


def with_exposure(case: Case, side: Side, state: ContactState, sums: Accumulator, alike: float) -> Body:
    """Return a body with the mean pressure over its track, the abrasion by it, and the exposure per test time.

    `alike` says how far the noise of blocks cancels, against that of independent ones.
    """
    scene, i, body = case.scene, side.index, state.bodies[side.index]
    law, film = scene.tribofilm, scene.film
    # a moving point spends patch / track of its time in reach of the contact, a resting one all of it
    reach = film.domain / side.track_length if side.moves else 1.0
    passes = Passes(
        since=sums.since[i],
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
    after = replace(body, pressure=pressure, exposure=exposure, abrasion=abrasion, since=sums.since[i])
    return replace(after, noise=body.noise + _noise(case, side, state, after, alike))


def _noise(case: Case, side: Side, state: ContactState, after: Body, alike: float) -> float:
    """Return the variance of the wear depth [m2] that the last block has made by sampling.

    Two blocks that sample the same wear differ by their noise.
    """
    body = state.bodies[side.index]
    track = track_rows(case.scene, state.rows, MIDDLE)
    film = body.tribofilm
    change = wear_speed(case, side, after, film)[track] - wear_speed(case, side, body, film)[track]
    return alike * 0.5 * float(np.var(groove_free(change))) * state.held**2
