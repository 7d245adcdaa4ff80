"""What C functions return: a number, or a struct with a member for each number that is known at run time only."""

import ast
import functools
import re
from typing import Any

from . import code
from .units import KEYWORDS, Unit, matched, unique
from .values import UNARY, Num, leaves, numbers, replaced

_GIVEN = "given_"  # stands, with its place, for a member that is always the same one of those that a function takes
_LIKE = "like_"  # stands, with its place, for a member that is always the same as an earlier one
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
    return [] if template is None else [number for number in numbers(template) if not number.text]


def wanted_fields(template: Any, names: list[str]) -> list[str]:
    return [name for name, each in zip(fields_of(template, names), numbers(template), strict=True) if not each.text]


def filled(template: Any, wanted: list[Num]) -> Any:
    """Return a result with these numbers in it."""
    given = iter(wanted)
    return replaced(template, lambda hole: hole if hole.text else next(given))


def distinct(value: Any) -> list[Num]:
    """Return the numbers at run time of a value, each once."""
    return list({number.text: number for number in numbers(value)}.values())


def forwarded(unit: Unit, template: Any, parameters: list[Num]) -> list[int | str] | None:
    """Return where the numbers that a function returns come from if it computes none of them, else None."""
    places = {parameter.text: place for place, parameter in enumerate(parameters)}
    found: list[int | str] = []
    wanted = [not number.text for number in numbers(template)]
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


def handed_on(template: Any, returned: list[Any], parameters: list[Num]) -> Any:
    """Return a result with marks for members that need no return, and their places.

    Those are the same parameter, or the same as an earlier member, wherever a function returns.
    """
    places = {parameter.text: place for place, parameter in enumerate(parameters)}
    columns = zip(*(matched(value, template) for value in returned), strict=True)
    texts = enumerate(tuple((number.text, number.kind) for number in column) for column in columns)
    seen: dict[Any, int] = {}

    def marked(hole: Num) -> Num:
        index, column = next(texts)
        (text, _), *others = set(column)
        if not others and text in places:
            return Num(f"{_GIVEN}{places[text]}", hole.kind)
        first = seen.setdefault(column, index)
        return hole if first == index else Num(f"{_LIKE}{first}", hole.kind)

    return replaced(template, marked)


def given_places(template: Any) -> list[tuple[str, int]]:
    """Return names and places of the parameters that a function hands on."""
    given = [(name, hole.text) for name, hole in leaves(template) if hole.text.startswith(_GIVEN)]
    return [(name, int(text.removeprefix(_GIVEN))) for name, text in given]


def with_given(template: Any, given: list[Num]) -> Any:
    """Return a result with what a caller gave in the places of what a function hands on."""

    def own(hole: Num) -> Num:
        return given[int(hole.text.removeprefix(_GIVEN))] if hole.text.startswith(_GIVEN) else hole

    return replaced(template, own)


def has_alike(template: Any) -> bool:
    """Return True for a result with marks for what is the same as an earlier member."""
    return any(hole.text.startswith(_LIKE) for hole in numbers(template))


def with_alike(value: Any) -> Any:
    """Return a result with earlier members in the places of those that are the same."""
    every = numbers(value)

    def own(hole: Num) -> Num:
        return every[int(hole.text.removeprefix(_LIKE))] if hole.text.startswith(_LIKE) else hole

    return replaced(value, own)


def parameter_of(parameter: Num, sets: bool) -> str:
    """Return the declaration of a parameter; an array that is not set is constant."""
    if "[" not in parameter.kind:
        return f"{code.c_type(parameter.kind)} {parameter.text}"
    return f"{'' if sets else 'const '}{code.c_type(parameter.kind[0])} *{parameter.text}"
