"""A contact whose load, speeds and radii change while it runs: instants that follow from each other in time.

The film remembers (squeeze term), at every speed and at rest; both bodies move on with their speeds, and no rough one
by more than a node from instant to instant. `run_cycle` takes what the surfaces feel in a sampled cycle, such as the
mesh of a tooth, for that of many.
"""

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import OperatingPointError
from ..laws.tribofilm import thickness
from ..scene import OperatingPoint, Scene
from ..state import Body, ContactState
from .accumulator import Sweep, observed
from .block import feeling
from .growth_and_wear import area_of_node, speeds_of, track_length, wear_speed
from .instant import ContactFields
from .transient import begin, follow, rough_speed

Array = NDArray[np.float64]
Duty = Callable[[float], OperatingPoint]

_ROUNDING = 1e-6  # of a node, by which a step may be longer than that


@dataclass(frozen=True)
class Moment:
    """One instant of a march."""

    time: float  # [s]
    op: OperatingPoint
    state: ContactState  # from which the next one follows; its outputs stand as they were before the march
    fields: ContactFields  # `route` says if the contact is open, or dry
    outputs: dict[str, float]  # by the names of `quantities.OUTPUTS`


def march(scene: Scene, state: ContactState, duty: Duty, times: Sequence[float], *, order: int = 1) -> Iterator[Moment]:
    """Yield the instants of a duty: that at times[0], then all up to times[-1], each following from the one before.

    duty: the operating point at a time [s]. times: increasing; between two of them, rough bodies make as many instants
    as keep them from moving on by more than a node. The first instant is the film of `state` where it has one, else a
    steady film, or a dry contact at rest. Without a load, and where a film would be too wide for the grid, the contact
    is open, says so (`fields.route`, `fields.shortfall`) and forgets its film; the next load begins anew.
    Bodies at rest whose film is too wide raise FilmTooWideError, since nothing would bring the oil back.

    order: of the squeeze term in time. Raises OperatingPointError for values that cannot be used.
    """
    if len(times) < 1 or any(not late > early for early, late in itertools.pairwise(times)):
        raise OperatingPointError(f"times = {list(times)!r} s must increase.")
    if order not in (1, 2):
        raise OperatingPointError(f"order = {order!r} of the squeeze term must be 1 or 2.")
    time, op = float(times[0]), duty(times[0])
    if state.film is None or op.load == 0.0:
        state, fields = begin(scene, op, state)
        yield _moment(scene, time, op, state, fields)
    for early, late in itertools.pairwise(times):
        count = _instants(scene, duty(early), duty(late), late - early)
        for k in range(1, count + 1):
            before, op = op, duty(early + (late - early) * k / count)
            dt = (late - early) / count
            steps = [0.5 * (then + now) * dt for then, now in zip(speeds_of(before), speeds_of(op), strict=True)]
            state, fields = follow(scene, op, state, dt, steps, order=order)
            yield _moment(scene, early + (late - early) * k / count, op, state, fields)


def _instants(scene: Scene, early: OperatingPoint, late: OperatingPoint, dt: float) -> int:
    """Into how many instants a time [s] is cut, so that no rough body moves on by more than a node in one."""
    fastest = max(rough_speed(scene, op) for op in (early, late))
    return max(1, math.ceil(fastest * dt / scene.film.spacing - _ROUNDING))


def _moment(scene: Scene, time: float, op: OperatingPoint, state: ContactState, fields: ContactFields) -> Moment:
    seen = observed(scene, op, fields)
    force = seen["friction_force"]
    seen |= {
        "friction_fluid": force - seen["friction_solid"],
        "friction_coefficient": abs(force) / op.load if op.load > 0.0 else 0.0,
        "power_loss": fields.friction.power,
    }
    return Moment(time, op, state, fields, seen)


@dataclass
class _Felt:
    """What a body feels in a cycle: integrals over time of its patch, [rows, nx - 1]."""

    exposure: Array
    abrasion: Array
    wear: Array  # [m]
    worn: float = 0.0  # of the whole track [m3]
    cycles: float = 0.0
    warmth: float = 0.0  # temperature of the surface [K s]

    @staticmethod
    def nothing(body: Body) -> "_Felt":
        """At the beginning."""
        return _Felt(np.zeros_like(body.wear), np.zeros_like(body.wear), np.zeros_like(body.wear))


def run_cycle(
    scene: Scene, state: ContactState, duty: Duty, times: Sequence[float], repeats: float = 1.0, *, order: int = 1
) -> tuple[ContactState, list[Moment]]:
    """The state after `repeats` >= 0 cycles of a duty like the one that `march` samples here, and its instants.

    Tribofilm and wear feel the mean of the sampled cycle, so that `repeats` should change the surfaces no more than a
    block may (`control.change`). The film and the places of the bodies are those at the end of the sampled one, where
    the next may begin. The state's outputs are means over time.
    """
    if not (math.isfinite(repeats) and repeats >= 0.0):
        raise OperatingPointError(f"repeats = {repeats!r} must be a number of cycles, at least 0.")
    moments = list(march(scene, state, duty, times, order=order))
    bodies, felt = list(state.bodies), [_Felt.nothing(body) for body in state.bodies]
    films = [thickness(body.growth, body.removal) for body in state.bodies]
    means: dict[str, Any] = {}
    last = float(times[0])
    for moment in moments:
        dt, op, last = moment.time - last, moment.op, moment.time
        if dt == 0.0:
            continue
        here = replace(moment.state, bodies=_placed(bodies, moment.state))
        sweep = Sweep.before(here)
        passes = [abs(speed) * dt / scene.film.domain for speed in speeds_of(op)]
        sweep.add(scene, op, here, moment.fields, (passes[0], passes[1]))
        for i in (0, 1):
            bodies[i] = feeling(scene, op, here, sweep, i, 0.0)
            _feel(scene, op, bodies[i], i, films[i], moment, dt, felt[i])
        for name, value in moment.outputs.items():
            means[name] = means.get(name, 0.0) + value * dt / (times[-1] - times[0])
    after = tuple(
        _evolved(scene, body, sums, repeats, times[-1] - times[0])
        for body, sums in zip(_placed(bodies, moments[-1].state), felt, strict=True)
    )
    state = replace(
        moments[-1].state,
        time=state.time + repeats * (times[-1] - times[0]),
        bodies=(after[0], after[1]),
        solved_for=None,
        outputs=replace(state.outputs, **means),
    )
    return state, moments


def _placed(bodies: Sequence[Body], state: ContactState) -> tuple[Body, Body]:
    """Bodies where those of a state are, and pressed in as deep."""
    first, second = (
        replace(body, offset=now.offset, plastic=now.plastic) for body, now in zip(bodies, state.bodies, strict=True)
    )
    return first, second


def _feel(
    case: Case, body: Body, i: int, film: Array, moment: Moment, dt: float, felt: _Felt
) -> None:
    """Add what a body feels in one instant."""
    worn = dt * wear_speed(case, body, i, film)
    felt.exposure += body.exposure * dt
    felt.abrasion += body.abrasion * dt
    felt.wear += worn
    felt.worn += float(worn.sum()) * area_of_node(case, i)
    felt.cycles += abs(case.speeds[i]) * dt / track_length(case.scene, i)
    felt.warmth += (case.op.bodies[i] + moment.outputs["flash_temperature_rise"]) * dt


def _evolved(scene: Scene, body: Body, felt: _Felt, repeats: float, period: float) -> Body:
    """A body after `repeats` times what it has felt in a period [s]."""
    dose = felt.exposure * repeats, felt.abrasion * repeats
    growth, removal = scene.tribofilm.evolve(body.growth, body.removal, *dose, felt.warmth / period)
    return replace(
        body,
        growth=growth,
        removal=removal,
        wear=body.wear + repeats * felt.wear,
        worn=body.worn + repeats * felt.worn,
        cycles=body.cycles + repeats * felt.cycles,
    )
