"""What C functions return: a number, or a struct with a member for each number that is known at run time only."""

import ast
import functools
import re
from typing import Any

from . import code
from .units import KEYWORDS, Unit, matched, unique
from .values import UNARY, Num, leaves, replaced

_ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth")


@functools.cache
def part_names(node: ast.AST) -> list[str]:
    """Return names for the parts of a tuple that a function returns: its own names for them, else ordinals."""
    found = [
        each.value.elts for each in ast.walk(node) if isinstance(each, ast.Return) and isinstance(each.value, ast.Tuple)
    ]
    own = [each.id if isinstance(each, ast.Name) else "" for each in found[-1]] if found else []
    if len(set(own)) < len(own):  # one name twice says nothing
        own = []
    return [*(name or _ordinal(i) for i, name in enumerate(own)), *map(_ordinal, range(len(own), len(_ORDINALS)))]


def _ordinal(place: int) -> str:
    return _ORDINALS[place] if place < len(_ORDINALS) else f"part_{place + 1}"


def fields_of(template: Any, names: list[str]) -> list[str]:
    """Return names for the numbers at run time of what a function returns; `names` are those of its parts."""
    found: list[str] = []
    for leaf, _ in leaves(template):
        place, *rest = leaf.split("_")
        own = leaf
        if place.isdigit():
            first = names[int(place)] if int(place) < len(names) else _ordinal(int(place))
            own = "_".join([first, *(str(int(part) + 1) for part in rest)])
        found.append(unique(re.sub(r"\W+", "_", own).strip("_") or "value", KEYWORDS.union(found)))
    return found


def holes_in(template: Any) -> list[Num]:
    """Return the numbers that a function returns."""
    return [] if template is None else [number for _, number in leaves(template) if not number.text]


def wanted_fields(template: Any, names: list[str]) -> list[str]:
    """Return their names."""
    return [name for name, (_, each) in zip(fields_of(template, names), leaves(template), strict=True) if not each.text]


def filled(template: Any, numbers: list[Num]) -> Any:
    """Return a result with these numbers in it."""
    given = iter(numbers)
    return replaced(template, lambda hole: hole if hole.text else next(given))


def distinct(value: Any) -> list[Num]:
    """Return the numbers at run time of a value, each once."""
    return list({number.text: number for _, number in leaves(value)}.values())


def forwarded(unit: Unit, template: Any, parameters: list[Num]) -> list[int | str] | None:
    """Return where the numbers that a function returns come from if it computes none of them, else None."""
    places = {parameter.text: place for place, parameter in enumerate(parameters)}
    found: list[int | str] = []
    wanted = [not number.text for _, number in leaves(template)]
    for number, want in zip(matched(unit.returned[-1], template), wanted, strict=True):
        if not want:
            continue
        if number.text in places:
            found.append(places[number.text])
        elif number.binds >= UNARY and not code.names_in(number.text):
            found.append(number.text)
        else:
            return None
    return found


def handed_on(template: Any, returned: list[Any], parameters: list[Num], mark: str) -> Any:
    """Return a result with a mark and a place for each member that is the same parameter wherever it returns."""
    places = {parameter.text: place for place, parameter in enumerate(parameters)}
    columns = zip(*(matched(value, template) for value in returned), strict=True)
    texts = iter([{number.text for number in column} for column in columns])

    def marked(hole: Num) -> Num:
        text, *others = next(texts)
        return hole if others or text not in places else Num(f"{mark}{places[text]}", hole.kind)

    return replaced(template, marked)
