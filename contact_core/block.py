"""One block: the moving surfaces are solved at a few instants; between blocks the geometry changes a little.

Who drives it is `control.driver`. Mixed lubrication has a memory, so its instants are a march, a node apart, that goes
on from block to block. In near rolling the bodies would meet the same asperities of each other all the way, so the
smoother one jumps under the march (an additive golden-ratio sequence, of low discrepancy); the oil, which follows the
rougher one, stays where it is. Dry contact has no memory: a few instants at offsets of both bodies, again of low
discrepancy, sample it.

Where the solids carry more than `control.dry_above` of the load, a dry contact stands for the mixed one: its solids
carry the same share, under oil that carries the rest like smooth bodies. A mixed march measures that share anew every
few blocks.
"""

import math
from contextlib import suppress
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .contact import Transient, solve
from .errors import ConvergenceError
from .evolution import (
    across_track,
    roughness_now,
    sliding_on_track,
    speeds_of,
    stable_time,
    track_length,
    track_rows,
    wear_rate,
    wear_speed,
)
from .film.instant import FilmState
from .following import follow, rough_speed
from .laws.tribofilm import thickness
from .patches import moved_nodes, rolled, widened, yielded
from .scene import OperatingPoint, Scene
from .shapes import Line
from .state import Body, ContactState, Outputs, RangeFlag
from .surfaces import groove_free
from .sweep import Sweep

Array = NDArray[np.float64]

# transient steps after a new start before the march is sampled: about one passage of the oil in near rolling, in
# proportion more where the faster body runs ahead of the oil
_SETTLING = 80  # at least
_PASSAGE = 1.8  # of half the contact's length
_MOST_SETTLING = 400
_AHEAD = 1.1  # the faster body's speed over the entrainment speed, up to which that is near rolling
_ITERATIONS = 150  # at most, of one transient step; a warm one needs about 16, over rough lines up to 100
_DRY_BLOCKS = 5  # driven dry before the share of the solids is measured again
_DRY_PASS = 8  # dry instants that stand for one pass of a surface point through the contact
_MANY_MISSED = 0.1  # share of unconverged solutions that raises a flag
_CLEAR = 3.0  # formula film over rms roughness, from which on a dry contact is no start
_GOLDEN = 0.7548776662466927  # of the additive sequence R2, of low discrepancy in the plane
_MEMORY = {"dry": 0.5, "mixed": 0.75}  # of the filter of outputs, per block
# how far the noise of blocks cancels, against that of independent ones: fitted to the roughness of case A's ball, which
# `benchmarks/surfaces/evolution.py control` judges
_ALIKE = {"dry": 0.1, "mixed": 0.5}
_SMOOTHER = 0.25  # up to this share of the other's roughness a body jumps under the sampled film
_CREEP = 0.01  # below this share of the other's speed a body does not show a block its track in any way
_CALMING = 24  # transient steps after a jump of a rougher one, or from a dry contact of the right share
_SHARE_STEP = 0.05  # change of contact_load_ratio in one block, at most
# what a march tells stays true of the dry contact that takes its share
_OF_FILM = RangeFlag.INLET_UNRESOLVED | RangeFlag.NOT_CONVERGED
_SMOOTH_STEP = 4.0  # nodes that smooth bodies move on by in an instant of a march, at most
_SHORTEST = 0.05  # of control.longest: no block need be shorter to keep wear stable; a flag says where it should
_LONGER = 2.0  # a block may be so much longer than the one before
_EDGE = 3  # rows at the edge into which the scar may not come
_WIDEST = 4  # times the scene's rows


def is_due(scene: Scene, op: OperatingPoint, state: ContactState) -> bool:
    """Whether geometry or inputs have moved so far that the contact has to be solved again."""
    used_up = state.change >= 0.999 * scene.control.change or state.held >= state.hold
    other_law = state.law != _law(scene)
    return state.solved_for is None or used_up or other_law or has_moved(scene, op, state.solved_for)


def is_marching(scene: Scene, op: OperatingPoint, state: ContactState) -> bool:
    """Whether the film follows inputs that change, instant by instant, instead of blocks."""
    asked = scene.control.inputs == "transient" and scene.control.driver != "dry" and op.load > 0.0
    if not asked or state.solved_for is None:
        return False
    return state.settling > 0.0 or has_moved(scene, op, state.solved_for)


def instant_time(scene: Scene, op: OperatingPoint) -> float:
    """Longest time [s] of an instant of such a march, infinite at rest."""
    fastest = max(rough_speed(scene, op), max(abs(speed) for speed in speeds_of(op)) / _SMOOTH_STEP)
    return scene.film.spacing / fastest if fastest > 0.0 else math.inf


def solve_instant(scene: Scene, op: OperatingPoint, state: ContactState, dt: float) -> ContactState:
    """Solve the contact `dt` [s] later, the bodies moved on; store what the surfaces feel there and what it gives."""
    since = state.solved_for
    if since is None or has_moved(scene, op, since):
        fastest = max(abs(speed) for speed in speeds_of(op))
        passage = _settling_instants(scene, op) * scene.film.spacing / fastest if fastest > 0.0 else math.inf
        state, since = replace(state, settling=passage, share=1.0, dry_blocks_left=0), op
    steps = [speed * dt for speed in speeds_of(op)]
    passes = (abs(steps[0]) / scene.film.domain, abs(steps[1]) / scene.film.domain)
    state, fields = follow(scene, op, state, dt, steps)
    sweep = Sweep.before(state)
    sweep.add(scene, op, state, fields, passes)
    before = state.outputs.unconverged
    state = _stored(scene, op, replace(state, trends=state.trends.restarted()), sweep, blocks=0)
    state = replace(state, outputs=_remembering(state.outputs, before))
    left = max(state.settling - dt, 0.0)
    hold = dt + min(instant_time(scene, op), left)
    return replace(state, solved_for=since, settling=left, hold=hold)


def _remembering(outputs: Outputs, before: float) -> Outputs:
    """Outputs of an instant that still say if those before it missed the tolerance, each half as loud as the next."""
    missed = 0.5 * (outputs.unconverged + before)
    flag = RangeFlag.NOT_CONVERGED if missed > _MANY_MISSED else RangeFlag(0)
    return replace(outputs, unconverged=missed, range_flags=outputs.range_flags | flag)


def solve_block(scene: Scene, op: OperatingPoint, state: ContactState) -> ContactState:
    """Solve the contact for one block; time stands still. Store what the surfaces feel and what the contact gives."""
    same = state.solved_for is not None and not has_moved(scene, op, state.solved_for)
    state = replace(state, settling=0.0)
    if not same:
        state = replace(state, dry_blocks_left=0, share=1.0, trends=state.trends.restarted(), held=0.0)
    state = _wide_enough(scene, state)
    sweep = Sweep.before(state)
    if op.load == 0.0:
        sweep.add(scene, op, state, solve(scene, op, state))
        return _stored(scene, op, replace(state, film=None, share=1.0), sweep)
    driver = scene.control.driver
    if op.entrainment_speed == 0.0 or driver == "dry":
        state = replace(state, share=1.0)
    elif driver == "mixed" or state.dry_blocks_left == 0:
        state = sweep_mixed(scene, op, state, sweep, same)
        found = sweep.means()["contact_load_ratio"]
        if driver == "mixed" or found <= scene.control.dry_above or sweep.fallbacks:
            return _stored(scene, op, replace(state, share=1.0), sweep)
        share = found if state.share == 1.0 else 0.5 * (found + state.share)  # one measurement scatters
        state = replace(state, share=share, dry_blocks_left=_DRY_BLOCKS, film=None)
        sweep, measured = Sweep.before(state), sweep
        sweep.flags, sweep.iterations = measured.all_flags & _OF_FILM, measured.iterations
    else:  # what made the share less sure still does
        sweep.flags = RangeFlag(state.outputs.range_flags) & _OF_FILM
    return _stored(scene, op, sweep_dry(scene, op, state, sweep), sweep)


def _law(scene: Scene) -> str:
    """What the stored exposure means."""
    return f"{scene.tribofilm.name}, {scene.tribofilm.dose}"


def has_moved(scene: Scene, op: OperatingPoint, old: OperatingPoint) -> bool:
    """Whether an input is further from the solved one than the scene tolerates; temperature counts by its viscosity."""
    if op == old:
        return False
    viscosity = scene.lubricant.viscosity
    eta, eta_old = (float(viscosity(np.zeros(1), t)[0]) for t in (op.inlet_temperature, old.inlet_temperature))
    fastest = max(abs(op.speed_1), abs(op.speed_2), abs(old.speed_1), abs(old.speed_2))
    now_then_scale = (
        (op.load, old.load, max(op.load, old.load)),
        (op.entrainment_speed, old.entrainment_speed, fastest),
        (op.sliding_speed, old.sliding_speed, max(abs(op.sliding_speed), abs(old.sliding_speed))),
        (op.spin, old.spin, max(abs(op.spin), abs(old.spin))),
        (eta, eta_old, max(eta, eta_old)),
        *((now, then, max(now, then)) for now, then in zip(scene.radii(op), scene.radii(old), strict=True)),
    )
    for name in ("load", "speed_1", "speed_2", "entrainment_speed", "sliding_speed", "spin"):
        if (getattr(op, name) == 0.0) != (getattr(old, name) == 0.0):
            return True
    return any(abs(now - then) > scene.control.input_change * scale for now, then, scale in now_then_scale)


def _wide_enough(scene: Scene, state: ContactState) -> ContactState:
    """The state with more rows if the scar has reached the edge of the patches."""
    rows = state.rows
    if not _worn_at_the_edge(scene, state) or rows >= _WIDEST * scene.rows:
        return state
    more = 8 * math.ceil(rows / 64)  # an eighth on either side
    first, second = (widened(body, more) for body in state.bodies)
    return replace(state, bodies=(first, second), film=None)


def _worn_at_the_edge(scene: Scene, state: ContactState) -> bool:
    if isinstance(scene.shape(), Line):
        return False  # there is none, or it lies beyond the roller's ends
    rows = [*range(_EDGE), *range(-_EDGE, 0)]
    return any(body.wear[rows].max() > 1e-3 * body.wear.max() for body in state.bodies)


def sweep_dry(scene: Scene, op: OperatingPoint, state: ContactState, sweep: Sweep) -> ContactState:
    """Add the instants of a dry block to `sweep`; return the state after them."""
    jumps = _dry_jumps(scene, op)
    for _ in range(scene.control.dry_instants):
        state = rolled(scene, state, jumps)
        fields = solve(scene, op, state, dry=True, solid_share=state.share)
        sweep.add(scene, op, state, fields, (1.0 / _DRY_PASS, 1.0 / _DRY_PASS))
        state = yielded(scene, replace(state, film=None), fields.overlap)
    return state


def _dry_jumps(scene: Scene, op: OperatingPoint) -> list[float]:
    """How far [m] the moving bodies jump from instant to instant.

    The first one by a golden ratio of the patch. What the other one is behind, in whole nodes, shares no factor with
    the patch's: after as many instants as the patch has nodes, each point has met every other once.
    """
    columns = scene.film.points - 1
    behind = next(k for k in range(round(0.382 * columns), columns + 1) if math.gcd(k, columns) == 1)
    first = _GOLDEN * scene.film.domain
    second = first - behind * scene.film.spacing
    return [jump * (speed != 0.0) for jump, speed in zip((first, second), speeds_of(op), strict=True)]


def sweep_mixed(
    scene: Scene, op: OperatingPoint, state: ContactState, sweep: Sweep, same: bool, *, jumping: bool = True
) -> ContactState:
    """Add the instants of a mixed block to `sweep`; return the state after them.

    `same`: the march goes on, at the same operating point. `jumping` False: all bodies roll on as they are.
    """
    dt = scene.film.spacing / max(abs(speed) for speed in speeds_of(op))
    steps = [speed * dt for speed in speeds_of(op)]
    passes = (abs(steps[0]) / scene.film.domain, abs(steps[1]) / scene.film.domain)
    rougher = 0 if scene.surface_1.rq > scene.surface_2.rq else 1
    jumps = _jumps(scene, op, 1 - rougher, _SMOOTHER if jumping else -1.0)
    passage = unsampled = _settling_instants(scene, op)
    if state.film is None:
        state = replace(state, film=_first_film(scene, op, state))
        unsampled = passage if state.share == 1.0 else _CALMING
    elif same and (any(jumps) or not jumping):
        unsampled = 0
    elif same:
        state, unsampled = rolled(scene, state, _jumps(scene, op, 1 - rougher, 1.0)), _CALMING
    length = (scene.surface_1, scene.surface_2)[rougher].correlation_length / scene.film.spacing
    stride = max(1, round((0.5 * length) ** 2))  # instants in which oil between asperities gets used to a jump
    for k in range(-unsampled, _mixed_instants(scene)):
        before = state
        jump_now = k % stride == 0
        state = rolled(scene, state, [step + jump * jump_now for step, jump in zip(steps, jumps, strict=True)])
        moved = moved_nodes(scene, before, state)
        settled = 2 * k >= -unsampled  # enough to tell which points are touched, and how warm they are
        fields = solve(scene, op, state, Transient(dt, moved, _ITERATIONS, heated=settled))
        if k >= 0:
            sweep.add(scene, op, state, fields, passes)
        elif settled:
            sweep.touch(scene, op, state, fields, passes)
        state = yielded(scene, replace(state, film=fields.film), fields.overlap)
    return state


def _first_film(scene: Scene, op: OperatingPoint, state: ContactState) -> FilmState:
    """The film that a march begins with: the steady one where smooth bodies' film clears the roughness by far, else
    that of a dry contact, whose solids carry the share that was measured.
    """
    oil = scene.lubricant.viscosity, op.inlet_temperature
    film = scene.shape(op).smooth(op.load, op.entrainment_speed, *oil, scene.solids.reduced_modulus).film
    if film > _CLEAR * math.hypot(scene.surface_1.rq, scene.surface_2.rq) and state.share == 1.0:
        with suppress(ConvergenceError):
            return solve(scene, op, state).film
    return solve(scene, op, state, dry=True, solid_share=state.share).film


def _settling_instants(scene: Scene, op: OperatingPoint) -> int:
    """Instants, a node of the faster body apart, until the film has settled."""
    fastest, entrained = max(abs(speed) for speed in speeds_of(op)), abs(op.entrainment_speed)
    across = max(_SETTLING, math.ceil(_PASSAGE * scene.hertz_at(op).a / scene.film.spacing))
    if fastest <= _AHEAD * entrained:
        return across
    return min(math.ceil(across * fastest / entrained), _MOST_SETTLING) if entrained > 0.0 else _MOST_SETTLING


def _mixed_instants(scene: Scene) -> int:
    """Sampled instants of a mixed block: by default an eighth of a pass, whatever the grid."""
    return scene.control.mixed_instants or math.ceil((scene.film.points - 1) / 8)


def _jumps(scene: Scene, op: OperatingPoint, i: int, most: float) -> list[float]:
    """How far [m] the bodies jump: body `i`, if it moves and its roughness is at most `most` times the other's."""
    rq = (scene.surface_1.rq, scene.surface_2.rq)
    jumping = speeds_of(op)[i] != 0.0 and rq[i] <= most * rq[1 - i]
    return [scene.film.domain * _GOLDEN * (jumping and k == i) for k in (0, 1)]


def feeling(scene: Scene, op: OperatingPoint, state: ContactState, sweep: Sweep, i: int, alike: float) -> Body:
    """A body with what the block makes it feel: mean pressure over its track, abrasion by that, and exposure per test
    time by the dose that the constants of the tribofilm law were fitted with.
    """
    body, law = state.bodies[i], scene.tribofilm
    # a moving point spends patch / track of its time in reach of the contact, a resting one all of it
    reach = scene.film.domain / track_length(scene, i) if speeds_of(op)[i] != 0.0 else 1.0
    exposure = sweep.exposures[i] / sweep.count
    if law.dose == "clock" and speeds_of(op)[i] != 0.0:
        exposure = (sweep.since[i] < 1.0).astype(np.float64)
    elif law.dose == "contact_length" and op.load > 0.0:
        exposure = exposure * scene.film.domain / (2.0 * scene.hertz_at(op).a)
    elif law.dose == "residence":
        exposure = exposure * reach
    if not op.slides or op.load == 0.0:  # nothing rubs in pure rolling, at rest or apart
        exposure = np.zeros_like(exposure)
    pressure = sweep.pressures[i] / sweep.count * reach
    abrasion = law.abrasion(pressure, sliding_on_track(scene, op, state.rows), across_track(scene, state.rows))
    after = replace(body, pressure=pressure, exposure=exposure, abrasion=abrasion, since=sweep.since[i])
    # two blocks that sample the same wear differ by their noise
    track = track_rows(scene, state.rows, 2.0 / 3.0)
    films = thickness(body.growth, body.removal)
    change = wear_speed(scene, op, after, i, films)[track] - wear_speed(scene, op, body, i, films)[track]
    noise = alike * 0.5 * float(np.var(groove_free(change))) * state.held**2
    return replace(after, noise=body.noise + noise)


def _lag(scene: Scene, driver: str) -> float:
    """By how many blocks what the surfaces feel is late, on average: half a block by Euler's steps, and half a pass
    where the dose is that of a whole pass.
    """
    if scene.tribofilm.dose != "clock":
        return 0.5
    if driver == "dry":
        return 0.5 + 0.5 * _DRY_PASS / scene.control.dry_instants
    return 0.5 + 0.5 * (scene.film.points - 1) / _mixed_instants(scene)


def _stable_time(scene: Scene, op: OperatingPoint, state: ContactState) -> float:
    return min(stable_time(scene, op, body, i) for i, body in enumerate(state.bodies))


def _longest(scene: Scene, op: OperatingPoint, state: ContactState, before: float) -> float:
    """Longest time [s] until the next block, whatever its change: wear stays stable, the regime and the block's length
    (`before`: of the last one [s]) change little by little.
    """
    limits = [scene.control.longest]
    if op.load > 0.0:
        limits += [max(_stable_time(scene, op, state), _SHORTEST * scene.control.longest)]
        if before > 0.0:
            step = abs(state.trends.slope_of("contact_load_ratio"))
            limits += [before * min(_LONGER, _SHARE_STEP / max(step, 1e-6))]
    return min(limits)


def _flags_of_motion(scene: Scene, op: OperatingPoint, state: ContactState, driver: str) -> RangeFlag:
    """What the speeds and the scar make less sure."""
    flags = RangeFlag(0)
    slow, fast = sorted(abs(speed) for speed in speeds_of(op))
    jumping = driver == "dry" or any(
        any(_jumps(scene, op, k, _SMOOTHER)) and abs(speeds_of(op)[k]) == slow for k in (0, 1)
    )
    if op.load > 0.0 and 0.0 < slow < (_CREEP if jumping else 0.9) * fast:
        flags |= RangeFlag.SLOW_BODY
    if op.load > 0.0 and _stable_time(scene, op, state) < _SHORTEST * scene.control.longest:
        flags |= RangeFlag.STIFF_WEAR
    if _worn_at_the_edge(scene, state):
        flags |= RangeFlag.DOMAIN_EDGE
    return flags


def _stored(scene: Scene, op: OperatingPoint, state: ContactState, sweep: Sweep, blocks: int = 1) -> ContactState:
    """The state with a block's results: exposure of the surfaces, outputs, and what decides about the next block."""
    driver = "fallback" if 2 * sweep.fallbacks > sweep.count else "mixed" if sweep.mixed else "dry"
    sweep.flags = sweep.all_flags | _flags_of_motion(scene, op, state, driver)
    alike = _ALIKE["dry" if driver == "dry" else "mixed"]
    bodies = (feeling(scene, op, state, sweep, 0, alike), feeling(scene, op, state, sweep, 1, alike))
    seen, spread = sweep.means(), sweep.spread(apart=driver == "dry")
    state = replace(state, bodies=bodies)
    share = seen["contact_load_ratio"]
    scatter = spread["contact_load_ratio"] / share if share > 0.0 else 0.0  # wear is in proportion to it
    for i, body in enumerate(bodies):
        seen[f"wear_depth_{i + 1}_rate"] = wear_rate(scene, op, body, i)
        spread[f"wear_depth_{i + 1}_rate"] = seen[f"wear_depth_{i + 1}_rate"] * scatter
        film = thickness(body.growth, body.removal)[track_rows(scene, state.rows)]
        seen |= {f"roughness_{i + 1}": roughness_now(scene, body, i), f"tribofilm_{i + 1}": float(film.mean())}
    trends = state.trends.followed(seen, spread, _MEMORY["dry" if driver == "dry" else "mixed"], _lag(scene, driver))
    smooth, count = trends.values(), f"blocks_{driver}"
    outputs = replace(
        state.outputs,
        **smooth,
        **{count: getattr(state.outputs, count) + blocks},
        **sweep.slopes(scene, op),
        friction_coefficient=abs(smooth["friction_force"]) / op.load if op.load > 0.0 else 0.0,
        range_flags=int(sweep.flags),
        iterations=sweep.iterations,
        unconverged=sweep.missed / sweep.count,
    )
    left = max(state.dry_blocks_left - 1, 0) if driver == "dry" else 0
    state = replace(
        state, law=_law(scene), solved_for=op, change=0.0, dry_blocks_left=left, outputs=outputs, trends=trends
    )
    return replace(state, hold=_longest(scene, op, state, state.held), held=0.0)
