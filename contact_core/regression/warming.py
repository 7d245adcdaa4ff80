"""Loading of packages and compiled kernels before the first step at the regression level."""

from ..scene import Case
from ..state import ContactState
from .evolution import advance


def warm_up(case: Case, state: ContactState) -> None:
    """Evaluate the contact once."""
    advance(case, state, 0.0)
