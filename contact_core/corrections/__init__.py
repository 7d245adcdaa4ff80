"""The regression level with what corrects its friction, h_c and W_c: nothing, deterministic blocks, or a map.

    correction  what any correction says of a contact, and all that follows from it
    places   where a contact lies among others
    kriging  what solved contacts say about the deviations elsewhere: closed form
    blocks   steps corrected by deterministic blocks where they are not sure enough
    map      the record of a map: arrays of numbers, its file, the scene that it belongs to
    query    what a map says of a contact: plain arithmetic on numbers
    by_map   steps corrected by the map of a scene
    fitting  a map from solved contacts: sparse polynomials, half widths by histories left out
    knot     histories of contacts at the deterministic and the regression level

A correction is a value of `film.correction`; each has a step, with the errors that are left.
"""

from collections.abc import Callable

from .. import deterministic, regression
from ..regression import errors_of as errors_of  # a correction states its errors in the outputs
from ..regression.surfaces import regression_film
from ..scene import Case
from ..state import ContactState, Outputs
from . import blocks, by_map

Step = Callable[[Case, ContactState, float], tuple[ContactState, Outputs]]

STEPS: dict[str, Step] = {"none": regression.advance, "blocks": blocks.advance, "map": by_map.advance}


def advance(case: Case, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
    """Return the state and outputs after `dt` [s], as `film.correction` says."""
    return STEPS[regression_film(case.scene).correction](case, state, dt)


def warm_up(case: Case, state: ContactState) -> None:
    """Load what the first steps need."""
    regression.warm_up(case, state)
    if regression_film(case.scene).correction == "blocks":
        deterministic.warm_up(blocks.deep(case), state)
