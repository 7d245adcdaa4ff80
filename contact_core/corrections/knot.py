"""Solved contacts: histories of rubbing at the deterministic level, beside the same ones at the regression level.

A map is to say what the deterministic level has along a run. Its surfaces are what its own wear and tribofilm make of
them, and no patch made from track means is like them. So both levels live through the same history, and a knot is what
the one finds while the other believes the surfaces to be so. On the way the history looks at other operating points.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from .. import deterministic, regression
from ..errors import ContactError
from ..regression.contact import MeanContact, evaluate
from ..regression.surfaces import Means, tribofilms_of
from ..scene import Case, OperatingPoint, Scene
from ..state import ContactState, Mean, RangeFlag, initial_state
from .correction import CORRECTED, UNSURE, Three
from .fitting import Samples, TooFewError
from .query import coordinates

_LEAST = 1e-6  # half width: a smaller one tells nothing
# least instants of a block elsewhere, which settles many times as long: mixed ones over the nodes along x, dry ones
_MIXED, _DRY = 0.375, 9
_MOST = 200  # blocks of one history
_FEWEST = 64  # intervals along x that a coarser grid has, at least


class Plan(NamedTuple):
    """A history: rubbing at one operating point, and looks at others on the way."""

    rubbing: OperatingPoint
    times: tuple[float, ...]  # at which it is looked at [s], from 0 on
    elsewhere: tuple[tuple[int, OperatingPoint], ...]  # after which of these, and where else


@dataclass(frozen=True)
class Knot:
    """What the deterministic level says of a contact, and the surfaces that the regression level has there."""

    point: OperatingPoint
    means: Means  # of the surfaces
    found: Three = (0.0, 0.0, 0.0)  # friction_coefficient, h_c [m], contact_load_ratio
    errors: Three = (0.0, 0.0, 0.0)  # half widths (95 %) that the block states: relative, of W_c absolute
    shared: Three = (0.0, 0.0, 0.0)  # parts of them that all blocks share: grid and iteration
    scatter: Three = (0.0, 0.0, 0.0)  # part that each block has for itself: the few instants at which it is solved
    flags: int = 0

    @property
    def counts(self) -> bool:
        """True if the block judges a map: it has converged, without a fallback, on a grid that has room for it."""
        return not RangeFlag(self.flags) & UNSURE and min(self.found[:2]) > 0.0

    @staticmethod
    def from_dict(table: dict[str, Any]) -> "Knot":
        """Return the knot of its numbers."""
        first, second = (Mean(**mean) for mean in table["means"])
        threes = {name: _three(table[name]) for name in ("found", "errors", "shared", "scatter")}
        return Knot(**table | threes | {"point": OperatingPoint(**table["point"]), "means": (first, second)})


@dataclass(frozen=True)
class History:
    """The knots of one plan."""

    number: int  # of the plan
    fine: bool  # on the grid of the scene; False: on one with half as many intervals
    knots: tuple[Knot, ...]
    refused: tuple[str, ...] = ()  # why there are no more

    def to_dict(self) -> dict[str, Any]:
        """Return the numbers as JSON has them."""
        return asdict(self)

    @staticmethod
    def from_dict(table: dict[str, Any]) -> "History":
        """Return the history that `to_dict` wrote."""
        knots = tuple(map(Knot.from_dict, table["knots"]))
        return History(table["number"], table["fine"], knots, tuple(table["refused"]))


def coarser(scene: Scene) -> Scene | None:
    """Return a scene with half as many intervals along x, None where so few would tell nothing."""
    half, odd = divmod(scene.film.points - 1, 2)
    return None if odd or half < _FEWEST else replace(scene, film=replace(scene.film, points=1 + half))


def solve(scene: Scene, number: int, fine: bool, plan: Plan) -> History:
    """Return the knots of a plan, from fresh surfaces on; `fine`: on the scene's own grid."""
    solved = scene if fine else coarser(scene)
    assert solved is not None
    quick, deep = scene.at_level("regression"), solved.at_level("deterministic")
    rubbing, case = Case.bind(quick, plan.rubbing), Case.bind(deep, plan.rubbing)
    knots: list[Knot] = []
    try:
        believed, state, before = initial_state(quick), initial_state(deep), 0.0
        for k, time in enumerate(plan.times):
            believed, _ = regression.advance(rubbing, believed, time - before)
            state, out = deterministic.advance(case, state, time - before)
            before = time
            assert believed.means is not None
            knots.append(_knot(case, believed.means, state))
            knots += [_elsewhere(deep, point, believed.means, state) for at, point in plan.elsewhere if at == k]
            if out.blocks_mixed + out.blocks_dry > _MOST:
                break
    except ContactError as error:
        return History(number, fine, tuple(knots), (str(error),))
    return History(number, fine, tuple(knots))


def _elsewhere(deep: Scene, point: OperatingPoint, means: Means, state: ContactState) -> Knot:
    """Return a look at another operating point from a state."""
    control = deep.control
    mixed = max(control.mixed_instants, math.ceil(_MIXED * (deep.film.points - 1)))
    control = replace(control, mixed_instants=mixed, dry_instants=max(control.dry_instants, _DRY))
    case = Case.bind(replace(deep, control=control), point)
    return _knot(case, means, deterministic.advance(case, state, 0.0)[0])


def _knot(case: Case, means: Means, after: ContactState) -> Knot:
    """Return the knot of a state that a block has made."""
    out, causes = after.outputs, deterministic.errors_of(case.scene, after)
    force, film, load = (causes[name] for name in ("friction_force", "h_c", "contact_load_ratio"))
    relative = (
        force.scaled(1.0 / abs(out.friction_force) if out.friction_force != 0.0 else 0.0),
        film.scaled(1.0 / out.h_c if out.h_c > 0.0 else 0.0),
        load,
    )
    return Knot(
        case.op,
        means,
        found=_three(getattr(out, name) for name in CORRECTED),
        errors=_three(getattr(out, name) for name in CORRECTED.values()),
        shared=_three(math.hypot(error.grid, error.iteration, error.inlet) for error in relative),
        scatter=_three(error.sampling for error in relative),
        flags=out.range_flags,
    )


def _three(values: Iterable[float]) -> Three:
    first, second, third = map(float, values)
    return first, second, third


def contact_of(scene: Scene, knot: Knot) -> tuple[Case, MeanContact]:
    """Return the case of a knot and its contact at the regression level."""
    case = Case.bind(scene.at_level("regression"), knot.point)
    return case, evaluate(case, tribofilms_of(knot.means), derivatives=False)


def samples_of(scene: Scene, histories: Sequence[History]) -> Samples:
    """Return the knots of histories that count as samples for a fit. Raises TooFewError for none."""
    rows = []
    for history in histories:
        for knot in history.knots:
            if not knot.counts:
                continue
            case, contact = contact_of(scene, knot)
            point = knot.point
            friction = abs(contact.solid + contact.fluid) / point.load
            off = (
                np.log(knot.found[0] / friction),
                np.log(knot.found[1] / contact.gap),
                knot.found[2] - contact.load_ratio,
            )
            rows.append(
                (
                    coordinates(case, contact),
                    abs(point.sliding_speed) / max(abs(point.entrainment_speed), 1e-9),
                    case.shape.radius_x,
                    off,
                    contact.load_ratio,
                    np.maximum(knot.shared, _LEAST),
                    knot.scatter,
                    knot.errors,
                    history.number,
                    float(history.fine),
                )
            )
    if not rows:
        raise TooFewError(0, 0)
    return Samples(*(np.array(part, dtype=np.float64) for part in zip(*rows, strict=True)))
