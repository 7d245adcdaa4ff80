"""A film that follows changing inputs instant by instant, in place of blocks: control.inputs = "transient"."""

import math
from dataclasses import replace

from ..scene import Case
from ..state import ContactState, Outputs, RangeFlag
from .accumulator import MANY, Accumulator
from .block import finished
from .sampling import settling_time
from .transient import follow, longest_instant


def inputs_change(case: Case, state: ContactState) -> bool:
    """Return True if the inputs change and the film is to follow them."""
    control = case.scene.control
    asked = control.inputs == "transient" and control.driver != "dry" and case.loaded
    if not asked or state.solved_for is None:
        return False
    return state.settling > 0.0 or case.differs_from(state.solved_for)


def solve_instant_of_change(case: Case, state: ContactState, dt: float) -> ContactState:
    """Solve the contact `dt` [s] later, the bodies moved on. Return the state with exposures and outputs."""
    since = state.solved_for
    if since is None or case.differs_from(since):
        passage = settling_time(case) if case.fastest > 0.0 else math.inf
        state, since = replace(state, settling=passage), case.op
    steps = [speed * dt for speed in case.speeds]
    passes = (abs(steps[0]) / case.scene.film.domain, abs(steps[1]) / case.scene.film.domain)
    state, fields = follow(case, state, dt, steps)
    sums = Accumulator.before(state)
    sums.add(case, state, fields, passes)
    before = state.outputs.unconverged
    state = finished(case, replace(state, trends=state.trends.restarted()), sums, blocks=0)
    state = replace(state, outputs=_with_earlier_unconverged(state.outputs, before))
    left = max(state.settling - dt, 0.0)
    hold = dt + min(longest_instant(case), left)
    return replace(state, solved_for=since, settling=left, hold=hold)


def _with_earlier_unconverged(outputs: Outputs, before: float) -> Outputs:
    """Return outputs that still report earlier instants that have not converged, each half as much as the next."""
    unconverged = 0.5 * (outputs.unconverged + before)
    flag = RangeFlag.NOT_CONVERGED if unconverged > MANY else RangeFlag(0)
    return replace(outputs, unconverged=unconverged, range_flags=outputs.range_flags | flag)
