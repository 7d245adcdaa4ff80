"""The comparisons by name, of comparisons.toml; each is run by the module of its name."""

import difflib
import tomllib
from collections.abc import Sequence
from functools import partial
from importlib import import_module
from importlib.resources import files

from contact_core.errors import ContactError

from .model import Comparison, Kind, Outcome


def _run(name: str) -> Outcome:
    found: Outcome = import_module(f".{name}", __package__).run()
    return found


_TABLES = tomllib.loads((files(__package__) / "comparisons.toml").read_text("utf-8"))
COMPARISONS = {
    name: Comparison(**{**table, "kind": Kind(table["kind"]), "run": partial(_run, name)})
    for name, table in _TABLES.items()
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
