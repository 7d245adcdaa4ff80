"""The regression level corrected by deterministic blocks where its errors exceed the accuracy.

A step is that of the regression level. If its friction or film is less sure at the end than `control.accuracy` (10 %
where a scene asks for none), the contact is solved there for one block on patches brought up to date, the state keeps
what it deviates by (`kriging`), and the step is taken again from its beginning. A place near one that is solved is not
solved again: what is left of the error is stated, and `RangeFlag.UNSURE` raised.
"""

from typing import Any

import numpy as np

from .. import deterministic, regression
from ..errors import ContactError
from ..kernels.arrays import Array
from ..regression.contact import MeanContact, Stated, evaluate
from ..regression.surfaces import Tribofilms
from ..scene import Case
from ..state import ContactState, Outputs, RangeFlag, Solved, changed, flag_of_errors
from .correction import CORRECTED, UNSURE, Deviation, Three, corrected
from .kriging import ABSOLUTE, CORRELATIONS, Conditioned, Conditioner, Knots, knots, nearness, place
from .places import Place

ACCURACY = 0.1  # of a scene that asks for none
MOST = 64  # blocks that a state keeps
_NEAR = 0.9  # correlation with a solved place, from which on another block would tell nothing new
_ASKED = ("error_friction", "error_film")
_PLACE = len(Place._fields)
_NOWHERE = np.empty((0, _PLACE + 2 * len(CORRECTED)))


def advance(case: Case, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
    """Return the state and outputs after `dt` [s], with one deterministic block at most."""
    corrector = _Corrector(case, state.solved)
    after, outputs = regression.advance(case, state, dt, corrector.contact)
    if corrector.asks:
        solved, counted = _block(case, after, corrector)
        state = changed(state, solved=solved, outputs=changed(state.outputs, **counted))
        corrector = _Corrector(case, solved)
        after, outputs = regression.advance(case, state, dt, corrector.contact)
    outputs = corrector.flagged(outputs)
    return changed(after, outputs=outputs), outputs


class _Corrector:
    """Corrects the contacts of a step, and keeps what the regression level says of the last one."""

    def __init__(self, case: Case, solved: Solved | None) -> None:
        self.rows = solved.rows if solved is not None else _NOWHERE
        self.raw: dict[str, Any] = {}
        self.place = Place(*(np.nan,) * _PLACE)
        self.told: dict[str, Any] = {}
        self._conditioner = _conditioner(solved) if solved is not None else None
        control = case.scene.control
        self._accuracy = ACCURACY if control.accuracy is None else control.accuracy
        self._flagged = _ASKED if control.accuracy is None else tuple(CORRECTED.values())

    def contact(self, case: Case, tribofilms: Tribofilms) -> MeanContact:
        """Return the contact of a case under tribofilms, corrected."""
        self.raw = {}
        return corrected(self, case, evaluate(case, tribofilms))

    def at(self, case: Case, contact: MeanContact, stated: Three) -> tuple[Deviation, Stated] | None:
        """Return what a contact deviates by, and the errors that are left; None without friction or a solved block."""
        force = contact.solid + contact.fluid
        if force == 0.0:
            return None
        self.raw = dict(zip(CORRECTED.values(), stated, strict=True)) | {
            "friction_coefficient": abs(force) / case.op.load,
            "friction_force": force,
            "friction_solid": contact.solid,
            "h_c": contact.gap,
            "lambda_ratio": contact.gap / contact.sigma,
            "contact_load_ratio": contact.load_ratio,
        }
        self.place, self.told = place(self.raw, case.op.load, case.speeds, case.pressed), self.raw
        if self._conditioner is None:
            return None
        found = self._conditioner.at(_OWN, np.array([self.place], np.float64))
        values = Conditioned(found.mean[0], found.left[0]).of(self.raw)
        self.told = self.raw | {name: float(value) for name, value in values.items()}
        friction, film = (self.told[name] / self.raw[name] for name in ("friction_coefficient", "h_c"))
        wide, thick, carried = (self.told[error] for error in CORRECTED.values())
        return Deviation(friction, film, self.told[ABSOLUTE]), Stated(wide, thick, carried, trust=1.0)

    @property
    def asks(self) -> bool:
        """True if a block would make friction or film surer, and they are not sure enough."""
        if not self.raw or max(self.told[name] for name in _ASKED) <= self._accuracy or len(self.rows) >= MOST:
            return False
        here = np.array([self.place], np.float64)
        near = nearness(CORRELATIONS["friction_coefficient"], here, self.rows[:, :_PLACE])
        return bool(np.isfinite(here).all() and not (near > _NEAR).any())

    def flagged(self, outputs: Outputs) -> Outputs:
        """Return the outputs, flagged as unsure where the errors that are left are above the accuracy."""
        if not self.raw:
            return outputs
        flag = flag_of_errors({name: self.told[name] for name in self._flagged}, self._accuracy)
        return changed(outputs, range_flags=outputs.range_flags & ~int(RangeFlag.UNSURE) | int(flag))


_OWN = np.array([""], object)  # all solutions of a state are of its one pair of surfaces


def _conditioner(solved: Solved) -> Conditioner:
    """Return the solutions of a state, solved for; made once and kept with them."""
    kept: Conditioner | None = vars(solved).get("_conditioner")
    if kept is None:
        places, off, own = np.split(solved.rows, [_PLACE, _PLACE + len(CORRECTED)], axis=1)
        kept = Conditioner(Knots(np.full(len(places), "", object), places, off, own))
        vars(solved)["_conditioner"] = kept
    return kept


def _block(case: Case, state: ContactState, corrector: _Corrector) -> tuple[Solved, dict[str, Any]]:
    """Return the solutions with that of a state, and the counters of blocks.

    One that fails or has not converged tells nothing but that its place is tried.
    """
    try:
        found: Outputs | None = deterministic.advance(deep(case), state, 0.0)[1]
    except ContactError:
        found = None
    solved = vars(found) if found is not None and not RangeFlag(found.range_flags) & UNSURE else None
    knot = knots([""], [corrector.place], [corrector.raw], [solved])
    row: Array = np.concatenate([knot.places, knot.off, knot.own], axis=1)
    names = ("blocks_dry", "blocks_mixed", "blocks_fallback")
    counted = {name: getattr(found, name) for name in names} if found is not None else {}
    return Solved(np.vstack([corrector.rows, row])), counted


def deep(case: Case) -> Case:
    """Return the case at the deterministic level."""
    return Case(case.scene.at_level("deterministic"), case.op)
