"""The values that a scene has left to defaults, as an attribute of a result."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

from contact_core.scene import Assumed

ATTRIBUTE = "assumed_json"  # of a result: key, value, where it comes from, kind of each


def attribute(assumed: Sequence[Assumed]) -> dict[str, str]:
    """Return them as an attribute."""
    return {ATTRIBUTE: json.dumps([list(each) for each in assumed])}


def stored(attributes: Mapping[str, Any]) -> list[Assumed] | None:
    """Return those of a result by its attributes; None if an older version has made it, which does not say."""
    text = attributes.get(ATTRIBUTE)
    return None if text is None else [Assumed(*each) for each in json.loads(text)]
