"""The instants of a block: the moving surfaces are solved at a few places of their tracks.

Mixed lubrication has a memory, so its instants are a march, a node apart, that continues from block to block. In near
rolling the bodies would keep the same asperities in contact throughout, so the smoother one jumps under the march (an
additive golden-ratio sequence, of low discrepancy); the oil, which follows the rougher one, stays where it is. Dry
contact has no memory: a few instants at offsets of both bodies, again of low discrepancy, sample it. Where stresses are
asked for, both bodies move as they do, one pass long, before one of them jumps: a point's history is that of one pass.
"""

import math
from contextlib import suppress
from dataclasses import replace

import numpy as np

from ..errors import ConvergenceError
from ..film.instant import FilmState
from ..progress import tell
from ..scene import Case, Scene
from ..state import ContactState
from .accumulator import Accumulator
from .instant import Transient, instant_time, near_rolling, nodes_per_instant, solve_instant
from .subsurface import begins_anew, is_whole, of_a_pass, pass_goes_on, steps_of_a_pass
from .transient import dry_instant, next_instant, rolled

# way of the oil after a new start before the march is sampled, in halves of the contact's length: in near rolling; in
# proportion more where the faster body runs ahead of the oil
_PASSAGE = 3.0
_MOST_SETTLING = 400  # nodes by which the oil or the faster body moves on while a film settles, at most
_ITERATIONS = 300  # most iterations of one transient step; it needs about 16 from a near film, up to 200 after a jump
_DRY_PASS = 8  # dry instants in one pass of a surface point through the contact
_CLEAR = 3.0  # film by formula over rms roughness above which a dry contact is no start
# correlation of instants a short way apart, and way of the oil over a of Hertz's contact in which it falls to zero
_ALIKE_AT_ONCE, _ALIKE = 0.9, 0.75
_BLOCKS = 20  # whose sampled instants make up a pass: neighbours hold hardly more than one value together
_GOLDEN = 0.7548776662466927  # of the additive sequence R2, of low discrepancy in the plane
_SMOOTHER = 0.25  # up to this share of the other's roughness a body jumps under the sampled film
_CALMING = 24  # nodes of the oil's way after a jump of a rougher one


def sample_dry(case: Case, state: ContactState, sums: Accumulator, same: bool) -> ContactState:
    """Add the instants of a dry block to `sums`; return the state after them. `same`: as for `sample_mixed`."""
    jumps = first = _dry_jumps(case)
    if case.scene.stress.samples:
        jumps = steps_of_a_pass(case)
        first = jumps if pass_goes_on(case, state, same) else first
    count = case.scene.control.dry_instants
    if begins_anew(case, state, same):
        count = max(count, case.scene.stress.instants)
    for k in range(count):
        tell("dry instant", k + 1, count)
        state, fields = dry_instant(case, state, jumps if k else first)
        sums.add(case, state, fields, (1.0 / _DRY_PASS, 1.0 / _DRY_PASS))
    return state


def _dry_jumps(case: Case) -> list[float]:
    """Return how far [m] the moving bodies jump from instant to instant.

    The first one jumps by a golden ratio of the patch. The other one lags by whole nodes that share no factor with the
    patch's: after as many instants as the patch has nodes, each point has met every other once.
    """
    film = case.scene.film
    columns = film.points - 1
    behind = _sharing_no_factor(0.382, columns)
    first = _GOLDEN * film.domain
    second = first - behind * film.spacing
    return [jump * side.moves for jump, side in zip((first, second), case.sides, strict=True)]


def sample_mixed(
    case: Case, state: ContactState, sums: Accumulator, same: bool, *, jumping: bool = True
) -> ContactState:
    """Add the instants of a mixed block to `sums`; return the state after them.

    `same`: the march continues at the same operating point. `jumping` False: all bodies roll on as they are.
    """
    scene = case.scene
    dt = instant_time(case)
    steps = [speed * dt for speed in case.speeds]
    passes = (abs(steps[0]) / scene.film.domain, abs(steps[1]) / scene.film.domain)
    smoother = 1 - scene.rougher
    jumps = jumps_of(case, smoother) if jumping and not scene.stress.samples else [0.0, 0.0]
    unsampled = settling_instants(case)
    if state.film is None:
        state = replace(state, film=first_film(case, state))
    elif same and (any(jumps) or pass_goes_on(case, state, same) or not (jumping and case.sides[smoother].moves)):
        unsampled = 0
    elif same:
        state, unsampled = rolled(scene, state, jumps_of(case, smoother, 1.0)), _instants(case, _CALMING)
    length = case.sides[scene.rougher].surface.length / scene.film.spacing
    stride = max(1, round(length / nodes_per_instant(case)))  # as many jumps on the way on every grid
    sampled = _instants(case, _sampled_nodes(scene))
    passing = _passing(case, stride * dt) if any(jumps) else 1.0
    for k in range(-unsampled, sampled):
        tell("instant", unsampled + k + 1, unsampled + sampled)
        jump_now = k % stride == 0
        moves = [step + jump * jump_now for step, jump in zip(steps, jumps, strict=True)]
        settled = 2 * k >= -unsampled  # enough to tell which points are exposed, and how warm they are
        state, fields = next_instant(case, state, moves, Transient(dt, 0, _ITERATIONS, heated=settled, passing=passing))
        if settled:
            sums.add(case, state, fields, passes, sampled=k >= 0)
    return state


def _passing(case: Case, time: float) -> float:
    """Return the part of the gap's mean square change that is sliding, where the smoother body jumps after a time [s].

    Heights of a correlation length l, d apart, differ by 2 rms^2 (d / l)^2 in the mean square, those of a body that has
    jumped by 2 rms^2. This share of the mean square scales the change of each gap itself: it is the regression
    coefficient of independent Gaussian changes, E[sliding part | whole change]. Instants without a jump take the same
    share, for simplicity.
    """
    rougher, smoother = (case.sides[i].surface for i in (case.scene.rougher, 1 - case.scene.rougher))
    slid = rougher.rms * abs(case.op.sliding_speed) * time / rougher.length
    return slid**2 / (slid**2 + smoother.rms**2) if slid > 0.0 else 0.0


def rest_of_a_pass(case: Case, state: ContactState, sums: Accumulator, same: bool) -> ContactState:
    """Add instants to those of a mixed block that begins anew, until they are a pass; return the state after them."""
    if begins_anew(case, state, same):
        while not is_whole(case, of_a_pass(case, state, sums.tractions, False)):
            state = sample_mixed(case, state, sums, True, jumping=False)
    return state


def first_film(case: Case, state: ContactState) -> FilmState:
    """Return the film that a march begins with.

    It is the steady one where smooth bodies' film clears the roughness by far, else that of a dry contact.
    """
    scene = case.scene
    clear = case.smooth_film > _CLEAR * math.hypot(scene.surface_1.rms, scene.surface_2.rms)
    if clear:
        with suppress(ConvergenceError):
            return solve_instant(case, state).film
    return solve_instant(case, state, dry=True).film


def _instants(case: Case, nodes: float) -> int:
    """Return the instants in which the oil moves by so many nodes."""
    return math.ceil(nodes / nodes_per_instant(case))


def settling_time(case: Case) -> float:
    """Return the time [s] until a film has settled."""
    return settling_instants(case) * instant_time(case)


def settling_instants(case: Case) -> int:
    """Return the instants until the film has settled."""
    fastest, entrained = case.fastest, abs(case.op.entrainment_speed)
    across = math.ceil(_PASSAGE * case.hertz.a / case.scene.film.spacing)
    if not near_rolling(case):
        across = min(math.ceil(across * fastest / entrained), _MOST_SETTLING) if entrained > 0.0 else _MOST_SETTLING
    return _instants(case, across)


def _sampled_nodes(scene: Scene) -> int:
    """Return the way of the oil in a mixed block, in nodes: by default a twentieth of a pass, whatever the grid."""
    return scene.control.mixed_instants or math.ceil((scene.film.points - 1) / _BLOCKS)


def likeness(case: Case, count: int, driver: str) -> float:
    """Return the mean correlation between two instants of a block; dry instants lie far apart.

    The share of the load on the solids: `python -m benchmarks.film.time_step`.
    """
    if driver == "dry" or not case.loaded or count < 2:
        return 0.0
    step = abs(case.op.entrainment_speed) * instant_time(case) / (_ALIKE * case.hertz.a)
    apart = np.arange(1, count)
    return float(_ALIKE_AT_ONCE * ((count - apart) * np.maximum(1.0 - apart * step, 0.0)).sum() / (count - apart).sum())


def blocks_per_pass(scene: Scene, driver: str) -> float:
    """Return how many blocks it takes until the sampled instants make up one pass of a surface point."""
    if driver == "dry":
        return _DRY_PASS / scene.control.dry_instants
    return (scene.film.points - 1) / _sampled_nodes(scene)


def jumps_of(case: Case, index: int, most: float = _SMOOTHER) -> list[float]:
    """Return how far [m] both bodies jump under a sampled film, by whole nodes.

    Only body 1 (`index` 0) or 2 (1) jumps, if it moves and its roughness is at most `most` times the other's.
    """
    side, other = case.sides[index], case.sides[1 - index]
    jumping = side.moves and side.surface.rms <= most * other.surface.rms
    film = case.scene.film
    leap = math.copysign(_sharing_no_factor(_GOLDEN, film.points - 1) * film.spacing, case.op.entrainment_speed)
    return [leap * (jumping and k == index) for k in (0, 1)]


def _sharing_no_factor(part: float, columns: int) -> int:
    """Return the least number from a part of the columns on that shares no factor with them."""
    return next(k for k in range(round(part * columns), 2 * columns + 2) if math.gcd(k, columns) == 1)
