"""One block: an interval over which one set of contact solutions holds, because the geometry changes only a little.

Mixed lubrication drives tribofilm and wear, from a full film to where solids carry all of the load. A dry contact does
without entrainment, and where `control.driver` asks for it. `sampling` has the instants of both.
"""

import math
from dataclasses import replace

import numpy as np

from ..laws.stress import OF_STRESS
from ..laws.tribofilm import DOSES
from ..scene import Case, Scene
from ..state import Below, Body, ContactState, RangeFlag
from ..state.below import nothing_below
from ..state.trends import RATES_FOLLOWED
from ..surfaces.patches import on_grid, patch_nodes, widened
from . import damage
from .accumulator import Accumulator
from .growth_and_wear import followed, stable_time, with_exposure
from .instant import solve_instant
from .resting import conformed, scar_time
from .sampling import blocks_per_pass, jumps_of, likeness, rest_of_a_pass, sample_dry, sample_mixed
from .subsurface import is_whole, of_a_pass, outputs_of_stress, passed

_MEMORY = {"dry": 0.5, "mixed": 0.75}  # of the filter of outputs, per block
# variance of the noise of heights per block over that of independent blocks: mixed fitted to the roughness of case A's
# ball, as `python -m benchmarks.surfaces.evolution control` shows; dry to its tribofilm, tests/convergence
_ALIKE = {"dry": 0.25, "mixed": 0.5}
_CREEP = 0.01  # of the other body's speed: of a slower body a block samples only a piece of the track
_SHARE_STEP = 0.05  # change of contact_load_ratio in one block, at most
_SHORTEST = 0.05  # of control.longest: no block is shorter for wear or pits; a flag says where wear asks for it
_LONGER = 2.0  # a block may be so much longer than the one before
_EDGE = 3  # rows and columns at the edge that the scar must not reach
_WIDEST = 4  # times the scene's rows
# of the depth that Hertz's contact flattens: a moving body whose wear has a higher first wave along x has a scar made
# at rest or at a creep; faster motion alone has made less than a fifth of it, also where wear is heavy
_UNEVEN = 0.02


def is_due(case: Case, state: ContactState) -> bool:
    """Return True if geometry or inputs have changed so far that the contact has to be solved again."""
    used_up = state.change >= 0.999 * case.scene.control.change or state.held >= state.hold
    other_law = state.law != law_of(case.scene)
    return state.solved_for is None or used_up or other_law or case.differs_from(state.solved_for)


def law_of(scene: Scene) -> str:
    """Return what a stored exposure means: the tribofilm law and its dose."""
    return f"{scene.tribofilm.name}, {scene.tribofilm.dose}"


def solve_block(case: Case, state: ContactState) -> ContactState:
    """Solve the contact for one block; time stands still. Return the state with exposures and outputs."""
    same = state.solved_for is not None and not case.differs_from(state.solved_for)
    state = replace(state, settling=0.0)
    if not same:
        state = replace(state, trends=state.trends.restarted(), held=0.0)
    return finished(case, *_sampled(case, _wide_enough(case, state), same))


def _sampled(case: Case, state: ContactState, same: bool) -> tuple[ContactState, Accumulator]:
    """Return the state after the instants of a block, and their sums; `same`: the operating point has not changed."""
    sums = Accumulator.before(state)
    if not case.loaded:
        sums.add(case, state, solve_instant(case, state))
        return replace(state, film=None), sums
    if not case.entrained or case.scene.control.driver == "dry":
        return sample_dry(case, state, sums, same), sums
    state = sample_mixed(case, state, sums, same)
    return rest_of_a_pass(case, state, sums, same), sums


def _wide_enough(case: Case, state: ContactState) -> ContactState:
    """Return the state with more rows if the scar has reached the edge of the patches.

    Rows are no help to a body at rest whose scar has reached the ends of the grid along x as well.
    """
    rows = state.rows
    if not _worn_at_the_edge(case, state) or rows >= _WIDEST * case.scene.rows or _worn_at_the_ends(case, state):
        return state
    more = 8 * math.ceil(rows / 64)  # an eighth on either side
    first, second = (widened(body, more) for body in state.bodies)
    return replace(state, bodies=(first, second), below=damage.widened(state.below, rows, more), film=None)


def _worn_at_the_edge(case: Case, state: ContactState) -> bool:
    if case.shape.along_face:
        return False  # there is no edge, or it lies beyond the roller's ends
    rows = [*range(_EDGE), *range(-_EDGE, 0)]
    return any(body.wear[rows].max() > 1e-3 * body.wear.max() for body in state.bodies)


def _worn_at_the_ends(case: Case, state: ContactState) -> bool:
    """Return True if the scar of a body at rest has reached the ends of the grid along x.

    Its pressure tells: wear may also be a groove from earlier motion, which goes on beyond the ends.
    """
    scars = [
        on_grid(state.bodies[side.body].pressure, patch_nodes(case.scene, state.bodies[side.body], state.window))
        for side in case.sides
        if not side.moves
    ]
    return any(scar[:, [*range(_EDGE), *range(-_EDGE, 0)]].max() > 1e-3 * scar.max() for scar in scars)


def _scar_moves(case: Case, state: ContactState) -> bool:
    """Return True if a moving body carries a scar made at rest, which its patch repeats all along the track."""
    if not case.loaded:
        return False
    least = _UNEVEN * 0.5 * case.hertz.a**2 / case.shape.radius_x
    along = [state.bodies[side.body].wear.mean(axis=0) for side in case.sides if side.moves]
    return any(2.0 * abs(np.fft.rfft(wear, norm="forward")[1]) > least for wear in along)


def finished(case: Case, state: ContactState, sums: Accumulator, blocks: int = 1) -> ContactState:
    """Return the state with a block's results: exposure of the surfaces, outputs, limits of the next block."""
    driver = sums.driver
    kind = "dry" if driver == "dry" else "mixed"
    below, stresses = _below(case, state, sums) if blocks else (state.below, {})
    first, second = (with_exposure(case, side, state, sums, _ALIKE[kind]) for side in case.sides)
    bodies = conformed(case, state, (first, second), sums.fluid / sums.count)
    surfaces = {k: v for pair in zip(case.sides, bodies, strict=True) for k, v in followed(case, *pair).items()}
    state = replace(state, bodies=bodies, below=below)
    sums.flags = sums.all_flags | _flags_of_motion(case, state, driver)
    seen, spread = _observed(sums, surfaces, likeness(case, sums.count, driver))
    trends = state.trends.followed(seen, spread, _MEMORY[kind], _lag(case.scene, driver))
    smooth, count = trends.values(), f"blocks_{driver}"
    smooth["friction_force"] = smooth["friction_solid"] + smooth["friction_fluid"]
    outputs = replace(
        state.outputs,
        **smooth,
        **stresses,
        **{count: getattr(state.outputs, count) + blocks},
        **sums.slopes(case),
        friction_coefficient=abs(smooth["friction_force"]) / case.op.load if case.loaded else 0.0,
        range_flags=int(sums.flags),
        iterations=sums.iterations,
        unconverged=sums.share_unconverged,
    )
    state = replace(
        state,
        law=law_of(case.scene),
        solved_for=case.op,
        change=0.0,
        outputs=outputs,
        trends=trends,
    )
    return replace(state, hold=_longest(case, state, state.held), held=0.0)


def _below(case: Case, state: ContactState, sums: Accumulator) -> tuple[Below | None, dict[str, float]]:
    """Return what lies below the surfaces after a block, and the outputs of stress that are new.

    A pass counts once it is over.
    """
    below, scene = state.below, case.scene
    if not scene.stress.samples:
        return below, {}
    if not case.loaded:
        return damage.at_rest(below) if below is not None else None, dict.fromkeys(OF_STRESS, 0.0)
    same = state.solved_for is not None and not case.differs_from(state.solved_for)
    tractions = of_a_pass(case, state, sums.tractions, same)
    below = below or nothing_below(scene.depths.size, state.rows, scene.film.points - 1)
    below = damage.with_tractions(below, tractions)
    if not is_whole(case, tractions):
        return below, {}
    seen = passed(case, state.rows, tractions)
    return damage.with_cycles(case, below, seen), outputs_of_stress(case, state.rows, seen)


def _observed(sums: Accumulator, surfaces: dict[str, float], alike: float) -> tuple[dict[str, float], dict[str, float]]:
    """Return means and standard deviations of what the trends follow, by name; `alike`: as for `Accumulator.spread`."""
    seen, spread = sums.means(), sums.spread(alike)
    share = seen["contact_load_ratio"]
    scatter = spread["contact_load_ratio"] / share if share > 0.0 else 0.0  # wear is in proportion to it
    rates = {name: surfaces[name] * scatter for name in RATES_FOLLOWED}
    return seen | surfaces, spread | rates


def _lag(scene: Scene, driver: str) -> float:
    """Return by how many blocks the exposure of the surfaces is late, on average.

    It is half a block by Euler's steps, and half a pass where the dose is that of a whole pass.
    """
    if not DOSES[scene.tribofilm.dose].whole_pass:
        return 0.5
    return 0.5 + 0.5 * blocks_per_pass(scene, driver)


def _stable_time(case: Case, bodies: tuple[Body, Body]) -> float:
    return min(stable_time(case, *pair) for pair in zip(case.sides, bodies, strict=True))


def _longest(case: Case, state: ContactState, before: float) -> float:
    """Return the longest time [s] until the next block, whatever its change.

    Wear stays stable, the regime and the block's length (`before`: of the last one [s]) change little by little.
    """
    control = case.scene.control
    limits = [control.longest]
    if case.loaded:
        soon = min(_stable_time(case, state.bodies), damage.pit_time(case, state))
        limits += [max(soon, _SHORTEST * control.longest)]
        limits += [scar_time(case, *pair) for pair in zip(case.sides, state.bodies, strict=True)]
        if before > 0.0:
            step = abs(state.trends.slope_of("contact_load_ratio"))
            limits += [before * min(_LONGER, _SHARE_STEP / max(step, 1e-6))]
    return min(limits)


def _flags_of_motion(case: Case, state: ContactState, driver: str) -> RangeFlag:
    """Return what the speeds and the scar make less sure."""
    flags = RangeFlag(0)
    slow, fast = sorted(abs(speed) for speed in case.speeds)
    jumping = driver == "dry" or any(any(jumps_of(case, side.body)) and abs(side.speed) == slow for side in case.sides)
    if case.loaded and 0.0 < slow < (_CREEP if jumping else 0.9) * fast:
        flags |= RangeFlag.SLOW_BODY
    if case.loaded and _stable_time(case, state.bodies) < _SHORTEST * case.scene.control.longest:
        flags |= RangeFlag.STIFF_WEAR
    if _worn_at_the_edge(case, state) or _worn_at_the_ends(case, state) or _scar_moves(case, state):
        flags |= RangeFlag.DOMAIN_EDGE
    return flags
