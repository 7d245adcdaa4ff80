"""A contact whose load, speeds and radii change while it runs: consecutive instants in time.

The mixed instants of a block at constant inputs are a march, too, that of `sampling` by the steps of `transient`.

The film remembers (squeeze term), at every speed and at rest. Both bodies move on with their speeds, no rough one, and
no oil on it, by more than a node from instant to instant. `run_cycle` applies the exposure of one sampled cycle, such
as the mesh of a tooth, to many.
"""

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..errors import OperatingPointError
from ..kernels.arrays import Array
from ..scene import Case, OperatingPoint, Scene, Side
from ..state import Body, ContactState, flag_of_scuffing
from .accumulator import Accumulator
from .growth_and_wear import area_of_node, film_removal, oxidation, solid_speed, steel_in, with_exposure
from .instant import ContactFields
from .observed import observed
from .rolling import beyond_grid
from .transient import begin, follow, node_speed

Duty = Callable[[float], OperatingPoint]

_ROUNDING = 1e-6  # of a node: a step may be longer than a node by so much


@dataclass(frozen=True)
class Moment:
    """One instant of a march.

    Attributes
    ----------
    time
        Time [s].
    case
        Scene and operating point, bound.
    state
        That from which the next instant follows; its outputs stand as they were before the march.
    fields
        Pressure, gap and shear by node; `route` says if the contact is open, or dry.
    outputs
        Outputs of the instant by their names, in SI.

    """

    time: float  # [s]
    case: Case
    state: ContactState  # from which the next one follows; its outputs stand as they were before the march
    fields: ContactFields  # `route` says if the contact is open, or dry
    outputs: dict[str, float]  # by the names of `quantities.OUTPUTS`

    @property
    def op(self) -> OperatingPoint:
        """The operating point, with the bulk temperatures of both bodies."""
        return self.case.op


def march(scene: Scene, state: ContactState, duty: Duty, times: Sequence[float], *, order: int = 1) -> Iterator[Moment]:
    """Yield the instants of a duty: that at times[0], then all up to times[-1], each following from the one before.

    The first instant is the film of `state` where it has one, else a steady film, or a dry contact at rest. Without a
    load, and where a film would be too wide for the grid, the contact is open, says so (`fields.route`,
    `fields.shortfall`) and forgets its film; the next load begins anew.

    Parameters
    ----------
    duty : the operating point at a time [s].
    times : increasing [s]; between two of them, rough bodies make as many instants as keep them from moving on by more
        than a node, and from sliding past each other by more than half a correlation length.
    order : of the squeeze term in time; 2 where no roughness moves, since oil between moving asperities would be lost.

    Raises
    ------
    OperatingPointError
        For values that cannot be used.
    FilmTooWideError
        For bodies at rest whose film is too wide, since nothing would bring the oil back.

    """
    if len(times) < 1 or any(not late > early for early, late in itertools.pairwise(times)):
        raise OperatingPointError(f"times = {list(times)!r} s must increase.")
    if order not in (1, 2):
        raise OperatingPointError(f"order = {order!r} of the squeeze term must be 1 or 2.")

    def bound(time: float) -> Case:
        return Case.bind(scene, duty(time), state.temperatures)

    case = bound(times[0])
    if state.film is None or not case.loaded:
        state, fields = begin(case, state)
        yield _moment(float(times[0]), case, state, fields)
    for early, late in itertools.pairwise(times):
        count = _instants(bound(early), bound(late), late - early)
        for k in range(1, count + 1):
            before, case = case, bound(early + (late - early) * k / count)
            if order == 2 and case.rough_speed > 0.0:
                raise OperatingPointError("order = 2 is for smooth bodies and roughness at rest. Use order = 1.")
            dt = (late - early) / count
            steps = [0.5 * (then + now) * dt for then, now in zip(before.speeds, case.speeds, strict=True)]
            state, fields = follow(case, state, dt, steps, order=order)
            yield _moment(early + (late - early) * k / count, case, state, fields)


def _instants(early: Case, late: Case, dt: float) -> int:
    """Return into how many instants a time [s] is cut; no rough body, and no oil on it, moves by more than a node."""
    fastest = max(node_speed(early), node_speed(late))
    return max(1, math.ceil(fastest * dt / early.scene.film.spacing - _ROUNDING))


def _moment(time: float, case: Case, state: ContactState, fields: ContactFields) -> Moment:
    seen = observed(case, fields)
    force = seen["friction_force"]
    seen |= {
        "rolling_resistance": seen["rolling_resistance"] + beyond_grid(case, case.grid(fields.y.size)),
        "friction_fluid": force - seen["friction_solid"],
        "friction_coefficient": abs(force) / case.op.load if case.loaded else 0.0,
        "power_loss": fields.friction.power,
    }
    return Moment(time, case, state, fields, seen)


@dataclass
class _Integrals:
    """Integrals over the time of a cycle, of one body: fields lie on its patch, [rows, nx - 1]."""

    exposure: Array
    abrasion: Array
    wear: Array  # of the solid itself [m]
    growing: Array  # oxide on bare solids [m]
    rubbing: Array  # off it [m]
    area: float = 0.0  # time by the area of a node [m2 s]
    worn: float = 0.0  # of the whole track [m3]
    cycles: float = 0.0
    warmth: float = 0.0  # temperature of the surface [K s]

    @staticmethod
    def zero(body: Body) -> "_Integrals":
        """Return the integrals at the beginning."""
        exposure, abrasion, wear, growing, rubbing = np.zeros((5, *body.wear.shape))
        return _Integrals(exposure, abrasion, wear, growing, rubbing)

    def add(self, moment: Moment, side: Side, body: Body, film: Array, dt: float) -> None:
        """Add one instant of `dt` [s] of a body with its exposure, worn under a tribofilm [m]."""
        worn = dt * solid_speed(moment.case, side, body, film, body.oxide)
        self.exposure += body.exposure * dt
        self.abrasion += film_removal(moment.case, side, body) * dt
        self.wear += worn
        self.area += area_of_node(moment.case, side) * dt
        if moment.case.scene.oxide.grows:
            growing, rubbing = oxidation(moment.case, side, body, film)
            self.growing += growing * dt
            self.rubbing += rubbing * dt
        self.worn += float(worn.sum()) * area_of_node(moment.case, side)
        self.cycles += abs(side.speed) * dt / side.track_length
        self.warmth += (side.temperature + moment.outputs["flash_temperature_rise"]) * dt


def run_cycle(
    scene: Scene, state: ContactState, duty: Duty, times: Sequence[float], repeats: float = 1.0, *, order: int = 1
) -> tuple[ContactState, list[Moment]]:
    """Return the state after `repeats` >= 0 cycles of a duty like the one that `march` samples here, and its instants.

    Tribofilm and wear integrate the mean of the sampled cycle, so that `repeats` should change the surfaces no more
    than a block may (`control.change`). The film and the places of the bodies are those at the end of the sampled
    cycle, where the next may begin. The state's outputs are means over time.
    """
    if not (math.isfinite(repeats) and repeats >= 0.0):
        raise OperatingPointError(f"repeats = {repeats!r} must be a number of cycles, at least 0.")
    moments = list(march(scene, state, duty, times, order=order))
    bodies, sums = list(state.bodies), [_Integrals.zero(body) for body in state.bodies]
    films = [body.tribofilm for body in state.bodies]
    means: dict[str, Any] = {}
    last = float(times[0])
    for moment in moments:
        dt, case, last = moment.time - last, moment.case, moment.time
        if dt == 0.0:
            continue
        here = replace(moment.state, bodies=_placed(bodies, moment.state))
        block = Accumulator.before(here)
        passes = [abs(speed) * dt / scene.film.domain for speed in case.speeds]
        block.add(case, here, moment.fields, (passes[0], passes[1]))
        for i, side in enumerate(case.sides):
            bodies[i] = with_exposure(case, side, here, block, 0.0)
            sums[i].add(moment, side, bodies[i], films[i], dt)
        for name, value in moment.outputs.items():
            means[name] = means.get(name, 0.0) + value * dt / (times[-1] - times[0])
    after = tuple(
        _evolved(scene, *pair, repeats, times[-1] - times[0])
        for pair in zip(_placed(bodies, moments[-1].state), sums, strict=True)
    )
    risk = flag_of_scuffing(max(moment.outputs["scuffing_ratio"] for moment in moments))
    state = replace(
        moments[-1].state,
        time=state.time + repeats * (times[-1] - times[0]),
        bodies=(after[0], after[1]),
        solved_for=None,
        outputs=replace(state.outputs, **means, range_flags=state.outputs.range_flags | int(risk)),
    )
    return state, moments


def _placed(bodies: Sequence[Body], state: ContactState) -> tuple[Body, Body]:
    """Return bodies at the places of those of a state, and pressed in as deep."""
    first, second = (
        replace(body, offset=now.offset, plastic=now.plastic) for body, now in zip(bodies, state.bodies, strict=True)
    )
    return first, second


def _evolved(scene: Scene, body: Body, sums: _Integrals, repeats: float, period: float) -> Body:
    """Return a body after `repeats` times the integrals over a period [s]."""
    law, warm = scene.tribofilm, sums.warmth / period
    dose = np.minimum(sums.exposure, law.most_exposure * period) * repeats, sums.abrasion * repeats
    growth, removal = law.evolve(body.growth, body.removal, *dose, warm)
    oxide, rubbed = scene.oxide.evolve(body.oxide, sums.growing * repeats, sums.rubbing * repeats)
    lost = steel_in(scene, rubbed)
    return replace(
        body,
        growth=growth,
        removal=removal,
        formed=body.formed + law.formed(body.growth, body.removal, growth, *dose, warm),
        oxide=oxide,
        wear=body.wear + repeats * sums.wear + lost,
        worn=body.worn + repeats * sums.worn + float(lost.sum()) * sums.area / period,
        cycles=body.cycles + repeats * sums.cycles,
    )
