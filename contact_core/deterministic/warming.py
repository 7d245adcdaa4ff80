"""Loading of packages and compiled kernels before the first step at the deterministic level."""

from dataclasses import replace

from ..scene import Case
from ..state import ContactState
from .instant import Transient, solve_instant
from .sampling import first_film
from .transient import next_instant

_ITERATIONS = 40


def warm_up(case: Case, state: ContactState) -> None:
    """Solve a dry instant, the film with which a march begins, and a mixed instant after it."""
    solve_instant(case, state, dry=True)
    state = replace(state, film=first_film(case, state))
    node = case.scene.film.spacing  # both bodies move on by it, as the oil does
    next_instant(case, state, [node, node], Transient(node / abs(case.op.entrainment_speed), 1, _ITERATIONS))
