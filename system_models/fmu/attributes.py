"""Attributes of variables in modelDescription.xml without which no FMU is coupled: names that differ, and numbers."""

from collections import Counter
from collections.abc import Callable
from typing import Any

from lxml import etree

from .errors import FmuError
from .kinds import KINDS

_READERS: dict[str, tuple[Callable[[str], Any], str]] = {
    "real": (float, "number"),
    "integer": (int, "whole number"),
    "boolean": ({"true": True, "1": True, "false": False, "0": False}.__getitem__, "true or false"),
}


def check(root: etree._Element, fmi3: bool) -> None:
    """Raise FmuError for variables that cannot be told apart, and for a text where a number must be."""
    variables = root.findall("ModelVariables/*")
    names = Counter(each.get("name") for each in [*variables, *root.iterfind("ModelVariables/*/Alias")])
    if twice := [name for name, count in names.items() if name is not None and count > 1]:
        raise FmuError(f"it has {names[twice[0]]} variables called '{twice[0]}', which cannot be told apart.")
    for variable in variables:
        _check_number(variable, variable, "valueReference", "integer")
        for typed in [variable] if fmi3 else variable:
            for name in ("start", "min", "max", "nominal"):
                _check_number(variable, typed, name, KINDS.get(typed.tag, ""))


def _check_number(variable: etree._Element, typed: etree._Element, name: str, kind: str) -> None:
    """Raise FmuError if an attribute, a list of them for an array, is not of its kind."""
    text = typed.get(name)
    if text is None or kind not in _READERS:
        return
    reader, what = _READERS[kind]
    try:
        for word in text.split() if variable.find("Dimension") is not None else [text]:
            reader(word)
    except (KeyError, ValueError):
        raise FmuError(f"its variable '{variable.get('name')}' has {name} = '{text}', which is no {what}.") from None
