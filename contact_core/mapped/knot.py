"""A solved contact: where it lies, and what the deterministic level says of it."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from .. import deterministic, regression
from ..correction import CORRECTED
from ..errors import ContactError
from ..regression.contact import MeanContact, evaluate
from ..regression.surfaces import Means, tribofilms_of
from ..scene import Case, OperatingPoint, Scene
from ..state import ContactState, Mean, RangeFlag, initial_state
from .fitting import Samples
from .query import coordinates

UNSURE = RangeFlag.NOT_CONVERGED | RangeFlag.FALLBACK | RangeFlag.DOMAIN_EDGE  # of blocks that judge nothing
Three = tuple[float, float, float]
_LEAST = 1e-6  # half width: a smaller one tells nothing


@dataclass(frozen=True)
class Knot:
    """One deterministic block on surfaces that the regression level has rubbed; or why there is none."""

    number: int
    point: OperatingPoint
    means: Means | None = None  # of the surfaces
    found: Three = (0.0, 0.0, 0.0)  # friction_coefficient, h_c [m], contact_load_ratio
    errors: Three = (0.0, 0.0, 0.0)  # half widths (95 %) that the block states: relative, of W_c absolute
    shared: Three = (0.0, 0.0, 0.0)  # parts of them that all blocks share: grid and iteration
    scatter: Three = (0.0, 0.0, 0.0)  # part that each block has for itself: the few instants at which it is solved
    flags: int = 0
    refused: str = ""  # why there is no block

    @property
    def counts(self) -> bool:
        """True if the block judges a map: it has converged, without a fallback, on a grid that has room for it."""
        return not self.refused and not RangeFlag(self.flags) & UNSURE and min(self.found[:2]) > 0.0

    def to_dict(self) -> dict[str, Any]:
        """Return the numbers as JSON has them."""
        return asdict(self)

    @staticmethod
    def from_dict(table: dict[str, Any]) -> "Knot":
        """Return the knot that `to_dict` wrote."""
        means = table["means"] and tuple(Mean(**mean) for mean in table["means"])
        threes = {name: tuple(table[name]) for name in ("found", "errors", "shared", "scatter")}
        return Knot(**table | threes | {"point": OperatingPoint(**table["point"]), "means": means})


def solve(scene: Scene, number: int, point: OperatingPoint, before: OperatingPoint, rubbed: float) -> Knot:
    """Return the block at an operating point, on fresh surfaces that have rubbed at another one for some time [s]."""
    fast, deep = scene.at_level("regression"), scene.at_level("deterministic")
    try:
        state = initial_state(scene)
        if rubbed > 0.0:
            state, _ = regression.advance(Case.bind(fast, before), state, rubbed)
        state, _ = regression.advance(Case.bind(fast, point), state, 0.0)
        block = Case.bind(deep, point)
        after, _ = deterministic.advance(block, state, 0.0)
    except ContactError as error:
        return Knot(number, point, refused=str(error))
    assert state.means is not None
    return _solved(number, point, state.means, block, after)


def _solved(number: int, point: OperatingPoint, means: Means, block: Case, after: ContactState) -> Knot:
    """Return the knot of a state that a block has just made."""
    out, causes = after.outputs, deterministic.errors_of(block.scene, after)
    force, film, load = (causes[name] for name in ("friction_force", "h_c", "contact_load_ratio"))
    relative = (
        force.scaled(1.0 / abs(out.friction_force) if out.friction_force != 0.0 else 0.0),
        film.scaled(1.0 / out.h_c),
        load,
    )
    return Knot(
        number,
        point,
        means,
        found=_three(getattr(out, name) for name in CORRECTED),
        errors=_three(getattr(out, name) for name in CORRECTED.values()),
        shared=_three(math.hypot(error.grid, error.iteration) for error in relative),
        scatter=_three(error.sampling for error in relative),
        flags=out.range_flags,
    )


def _three(values: Iterable[float]) -> Three:
    first, second, third = map(float, values)
    return first, second, third


def contact_of(scene: Scene, knot: Knot) -> tuple[Case, MeanContact]:
    """Return the case of a knot and its contact at the regression level."""
    assert knot.means is not None
    case = Case.bind(scene.at_level("regression"), knot.point)
    return case, evaluate(case, tribofilms_of(knot.means))


def samples_of(scene: Scene, knots: Sequence[Knot]) -> Samples:
    """Return knots that count as samples for a fit."""
    rows = []
    for knot in knots:
        case, contact = contact_of(scene, knot)
        point = knot.point
        friction = abs(contact.solid + contact.fluid) / point.load
        rows.append(
            (
                coordinates(case, contact),
                abs(point.sliding_speed) / max(abs(point.entrainment_speed), 1e-9),
                (
                    np.log(knot.found[0] / friction),
                    np.log(knot.found[1] / contact.gap),
                    knot.found[2] - contact.load_ratio,
                ),
                contact.load_ratio,
                np.maximum(knot.shared, _LEAST),
                knot.scatter,
            )
        )
    return Samples(*(np.array(part, dtype=np.float64) for part in zip(*rows, strict=True)))
