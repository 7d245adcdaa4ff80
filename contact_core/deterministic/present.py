"""The instant that a run is at: of the kind that drives tribofilm and wear in its block."""

from ..scene import Case
from ..state import ContactState
from .instant import solve_instant
from .sampling import instant_time
from .transient import Found, dry_instant, follow


def present_instant(case: Case, state: ContactState) -> Found:
    """Solve the contact at the present time of a run; the state is not changed, and the run goes on as without it.

    With a film: the next instant of its march. In a dry block and without entrainment: a dry one. Else, as without a
    load or after a change of the inputs: a steady one.

    Returns
    -------
    ContactState, ContactFields
        The state gives the places (`Body.offset`) at which the bodies lie in the instant.

    Raises
    ------
    ConvergenceError
        If no solution exists.

    """
    same = state.solved_for is not None and not case.differs_from(state.solved_for)
    dry = case.scene.control.driver == "dry"
    if not case.loaded:
        return state, solve_instant(case, state)
    if not dry and same and state.film is not None and case.fastest > 0.0:
        dt = instant_time(case)
        return follow(case, state, dt, [speed * dt for speed in case.speeds])
    if dry or not case.entrained:
        return dry_instant(case, state, (0.0, 0.0))
    return state, solve_instant(case, state)
