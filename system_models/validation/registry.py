"""The table of comparisons, by name."""

import difflib
from collections.abc import Sequence

from contact_core.errors import ContactError

from . import (
    asperity_load,
    base_oils,
    dimple,
    dry_contact,
    film_formulas,
    flash,
    oils,
    optical_films,
    rolling_torques,
    starvation,
    stresses,
    thesis,
    traction,
)
from .model import Comparison, Outcome

COMPARISONS: dict[str, Comparison] = {
    "optical_films": optical_films.COMPARISON,
    "dimple": dimple.COMPARISON,
    "oils": oils.COMPARISON,
    "base_oils": base_oils.COMPARISON,
    "traction": traction.COMPARISON,
    "asperity_load": asperity_load.COMPARISON,
    "rolling_torques": rolling_torques.COMPARISON,
    "film_formulas": film_formulas.COMPARISON,
    "starvation": starvation.COMPARISON,
    "dry_contact": dry_contact.COMPARISON,
    "stresses": stresses.COMPARISON,
    "flash": flash.COMPARISON,
    "thesis": thesis.COMPARISON,
}


def chosen(names: Sequence[str]) -> list[str]:
    """Return the names of comparisons in the table's order, all if none is asked for.

    Raises ContactError for a name that is not in the table.
    """
    for name in names:
        if name not in COMPARISONS:
            near = difflib.get_close_matches(name, COMPARISONS, 1)
            hint = f"Did you mean {near[0]}?" if near else f"Use one of {', '.join(COMPARISONS)}."
            raise ContactError(f"There is no comparison '{name}'. {hint}")
    return [name for name in COMPARISONS if not names or name in names]


def outcome(name: str) -> Outcome:
    """Run a comparison; what the core refuses or cannot solve is an outcome too."""
    try:
        return COMPARISONS[name].run()
    except ContactError as error:
        return Outcome((), failure=str(error))
