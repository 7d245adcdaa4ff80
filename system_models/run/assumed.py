"""The values that a scene has left to defaults, as an attribute of a result."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

from contact_core.scene import Assumed

_MATTER = {  # keys begin so, of what friction and film rest on: in words
    "lubricant.rheology": "rheology",
    "lubricant.viscosity.pressure_coefficient": "pressure coefficient",
    "boundary_friction": "friction of touching solids",
    "surface_1.correlation_length": "correlation lengths",
    "surface_2.correlation_length": "correlation lengths",
}
ATTRIBUTE = "assumed_json"  # of a result: key, value, where it comes from, kind of each


def attribute(assumed: Sequence[Assumed]) -> dict[str, str]:
    """Return them as an attribute."""
    return {ATTRIBUTE: json.dumps([list(each) for each in assumed])}


def stored(attributes: Mapping[str, Any]) -> list[Assumed] | None:
    """Return those of a result by its attributes; None if an older version has made it, which does not say."""
    text = attributes.get(ATTRIBUTE)
    return None if text is None else [Assumed(*each) for each in json.loads(text)]


def not_in_errors(attributes: Mapping[str, Any]) -> list[str]:
    """Return a sentence on what the errors of a result leave out: values that are assumed, and laws that are off."""
    values = stored(attributes) or []
    parts = [
        f"what is {kind} ({', '.join(found)})"
        for kind, found in (
            ("assumed", dict.fromkeys(_MATTER[key] for key in _MATTER if any(_is(key, each) for each in values))),
            ("off", [each.key for each in values if each.kind == "off"]),
        )
        if found
    ]
    return [f"Not in these errors: {' and '.join(parts)}."] if parts else []


def _is(key: str, value: Assumed) -> bool:
    return value.kind == "assumed" and value.key.startswith(key)
